//! The node tree: transforms, what hangs on the nodes, and which of them are in the chosen scene.

use super::choice::Choice;
use super::error::{Fault, Notes};
use super::extensions::{self, NodeLight};
use super::references::within;
use crate::scene::Node;
use glam::{DMat4, DQuat, DVec3, DVec4};
use gltf::json::{self, Root};

/// All nodes of the document; a forest, or an error.
pub(super) fn import(root: &Root, light_count: usize, notes: &mut Notes) -> Result<Vec<Node>, Fault> {
    let nodes: Vec<Node> = root
        .nodes
        .iter()
        .enumerate()
        .map(|(n, json)| convert(json, n, light_count, notes))
        .collect::<Result<_, _>>()?;
    check_forest(&nodes)?;
    Ok(nodes)
}

fn convert(json: &json::Node, n: usize, light_count: usize, notes: &mut Notes) -> Result<Node, Fault> {
    let here = format!("/nodes/{n}");
    let raw = json.extensions.as_ref().map(|raw| &raw.others);
    let light = match extensions::find::<NodeLight>(raw, "KHR_lights_punctual", &here)? {
        Some(NodeLight { light }) => {
            let pointer = format_args!("{here}/extensions/KHR_lights_punctual/light");
            Some(within(light, light_count, "extensions/KHR_lights_punctual/lights", pointer)?)
        }
        None => None,
    };
    Ok(Node {
        name: json.name.clone(),
        parent_from_node: transform(json, &here, notes)?,
        children: json.children.iter().flatten().map(|child| child.value()).collect(),
        mesh: json.mesh.map(|mesh| mesh.value()),
        // Its data are read when there are accessors.
        node_from_objects: None,
        camera: json.camera.map(|camera| camera.value()),
        light,
    })
}

fn transform(json: &json::Node, here: &str, notes: &mut Notes) -> Result<DMat4, Fault> {
    let wide = |values: [f32; 3]| DVec3::from_array(values.map(f64::from));
    if let Some(matrix) = json.matrix {
        if json.translation.is_some() || json.rotation.is_some() || json.scale.is_some() {
            notes.add(here, "the node has a matrix and also translation, rotation or scale; the matrix counts");
        }
        let mut matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if !matrix.is_finite() {
            return Err(Fault::at(format_args!("{here}/matrix"), "has a number that is too large"));
        }
        if matrix.row(3) != DVec4::W {
            notes.add(format_args!("{here}/matrix"), "the last row is not 0 0 0 1 and counts as that");
            matrix.x_axis.w = 0.0;
            matrix.y_axis.w = 0.0;
            matrix.z_axis.w = 0.0;
            matrix.w_axis.w = 1.0;
        }
        return Ok(matrix);
    }
    let translation = json.translation.map_or(DVec3::ZERO, wide);
    let scale = json.scale.map_or(DVec3::ONE, wide);
    let rotation = json.rotation.map_or(DQuat::IDENTITY, |rotation| DQuat::from_array(rotation.0.map(f64::from)));
    for (name, finite) in
        [("translation", translation.is_finite()), ("rotation", rotation.is_finite()), ("scale", scale.is_finite())]
    {
        if !finite {
            return Err(Fault::at(format_args!("{here}/{name}"), "has a number that is too large"));
        }
    }
    // Quantised animation tools leave quaternions a little off; far off is an error of the file.
    let length = rotation.length();
    if (length - 1.0).abs() > 1e-2 {
        notes.add(
            format_args!("{here}/rotation"),
            format!("the quaternion has length {length:.3}, not 1, and is normalised"),
        );
    }
    let rotation = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
    Ok(DMat4::from_scale_rotation_translation(scale, rotation, translation))
}

/// Each node has at most one parent, and following children comes to an end (glTF 2.0, 3.5.2).
fn check_forest(nodes: &[Node]) -> Result<(), Fault> {
    let mut parents = vec![None; nodes.len()];
    for (n, node) in nodes.iter().enumerate() {
        for (c, &child) in node.children.iter().enumerate() {
            if let Some(other) = parents[child].replace(n) {
                let problem = format!("makes /nodes/{child} the child of two parents, the other is /nodes/{other}");
                return Err(Fault::at(format_args!("/nodes/{n}/children/{c}"), problem));
            }
        }
    }
    // With one parent at most, what cannot be reached from a node without parents is on or below a cycle.
    let mut reached = vec![false; nodes.len()];
    let mut pending: Vec<usize> = (0..nodes.len()).filter(|&n| parents[n].is_none()).collect();
    while let Some(n) = pending.pop() {
        reached[n] = true;
        pending.extend(&nodes[n].children);
    }
    match reached.iter().position(|&reached| !reached) {
        Some(n) => Err(Fault::at(format_args!("/nodes/{n}"), "is part of a cycle or hangs on one")),
        None => Ok(()),
    }
}

/// A scene of the document: its number, if the document has any, its name and its root nodes.
#[derive(Debug)]
pub(super) struct ChosenScene {
    pub(super) index: Option<usize>,
    pub(super) name: Option<String>,
    pub(super) roots: Vec<usize>,
}

/// The wanted scene; without a wish the default one, or the first, or all root nodes when there are no scenes.
pub(super) fn choose_scene(
    root: &Root,
    nodes: &[Node],
    choice: Option<&Choice>,
    notes: &mut Notes,
) -> Result<ChosenScene, Fault> {
    let names: Vec<Option<&str>> = root.scenes.iter().map(|scene| scene.name.as_deref()).collect();
    let index = match choice {
        Some(choice) => choice.find("scene", &names, "/scenes")?,
        None => root.scene.map_or(0, |scene| scene.value()),
    };
    let mut is_child = vec![false; nodes.len()];
    nodes.iter().flat_map(|node| &node.children).for_each(|&child| is_child[child] = true);
    let Some(scene) = root.scenes.get(index) else {
        let roots = (0..nodes.len()).filter(|&n| !is_child[n]).collect();
        return Ok(ChosenScene { index: None, name: None, roots });
    };
    let mut roots = Vec::with_capacity(scene.nodes.len());
    let mut listed = vec![false; nodes.len()];
    for (entry, node) in scene.nodes.iter().enumerate() {
        let pointer = format_args!("/scenes/{index}/nodes/{entry}");
        let node = node.value();
        if is_child[node] {
            return Err(Fault::at(pointer, format!("lists /nodes/{node}, which is the child of another node")));
        }
        if std::mem::replace(&mut listed[node], true) {
            notes.add(pointer, format!("lists /nodes/{node} again; once is enough"));
            continue;
        }
        roots.push(node);
    }
    Ok(ChosenScene { index: Some(index), name: scene.name.clone(), roots })
}
