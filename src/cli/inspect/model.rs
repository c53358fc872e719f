//! What a model holds.

use super::InspectArgs;
use super::gather::light_labels;
use super::report::pretty;
use crate::cli::error::CliError;
use crate::cli::subject::Loaded;
use crate::import::SUPPORTED_EXTENSIONS;
use crate::scene::{
    AlphaMode, Disney, LightInWorld, LightKind, Material, MetalFresnel, Primitive, Projection, Scene, Topology,
};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The model as text or, if asked for, as JSON.
pub(super) fn describe(args: &InspectArgs, loaded: &Loaded) -> Result<String, CliError> {
    let report = summary(args, loaded);
    if args.json { pretty(&report) } else { Ok(text(&report)) }
}

fn summary(args: &InspectArgs, loaded: &Loaded) -> Value {
    let scene = &loaded.scene;
    let (used, ignored): (Vec<&String>, Vec<&String>) =
        loaded.extensions_used.iter().partition(|name| SUPPORTED_EXTENSIONS.contains(&name.as_str()));
    let bounds = scene.bounds();
    let bounds = (!bounds.is_empty()).then(|| {
        json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array(), "size": (bounds.max - bounds.min).to_array() })
    });
    json!({
        "schema": "specula-inspect-model/1",
        "specula": env!("CARGO_PKG_VERSION"),
        "model": args.subject.model().display().to_string(),
        "scene": { "index": loaded.scene_index, "name": scene.name, "of": loaded.scene_names },
        "variants": loaded.variant_names,
        "counts": counts(scene),
        "bounds_m": bounds,
        "materials": scene.materials.iter().map(|of| material(scene, of)).collect::<Vec<_>>(),
        "textures": scene.textures.iter().map(|texture| {
            let image = &scene.images[texture.image];
            json!({ "image": texture.image, "name": image.name, "size_px": [image.width, image.height] })
        }).collect::<Vec<_>>(),
        "lights": light_labels(scene).into_iter().zip(scene.lights_in_world()).map(light).collect::<Vec<_>>(),
        "cameras": scene.cameras_in_world().iter().map(|camera| json!({
            "name": camera.name,
            "projection": match camera.projection {
                Projection::Perspective { fov_y_rad } => json!({ "fov_y_deg": fov_y_rad.to_degrees() }),
                Projection::Orthographic { height_m } => json!({ "height_m": height_m }),
            },
            "position_in_world": camera.position_in_world().to_array(),
            "forward_in_world": camera.forward_in_world().to_array(),
        })).collect::<Vec<_>>(),
        "extensions_used": used,
        "extensions_ignored": ignored,
        "warnings": loaded.warnings,
    })
}

fn counts(scene: &Scene) -> Value {
    let shapes = |primitive: &Primitive, topology: Topology| match primitive.topology == topology {
        true => primitive.indices.len() / topology.indices_per_shape(),
        false => 0,
    };
    let instances = scene.instances();
    let drawn = |topology: Topology| -> usize {
        let primitives = instances.iter().flat_map(|instance| &scene.meshes[instance.mesh].primitives);
        primitives.map(|primitive| shapes(primitive, topology)).sum()
    };
    let primitives = || scene.meshes.iter().flat_map(|mesh| &mesh.primitives);
    json!({
        "nodes": scene.nodes.len(),
        "meshes": scene.meshes.len(),
        "primitives": primitives().count(),
        "vertices": primitives().map(|primitive| primitive.positions.len()).sum::<usize>(),
        "instances": instances.len(),
        "triangles_drawn": drawn(Topology::Triangles),
        "lines_drawn": drawn(Topology::Lines),
        "points_drawn": drawn(Topology::Points),
        "images": scene.images.len(),
    })
}

/// Every parameter that the material's model has.
fn parameters(material: &Material) -> Map<String, Value> {
    let color = material.base_color;
    let mut parameters = Map::new();
    let mut set = |name: &str, value: Value| parameters.insert(name.into(), value);
    set("base_color", json!(color.to_array()));
    set("metallic", json!(material.metallic));
    set("perceptual_roughness", json!(material.perceptual_roughness));
    set("emissive_nits", json!(material.emissive_nits.to_array()));
    if material.disney.is_none() {
        set("ior", json!(material.ior));
        set("specular", json!(material.specular));
        set("specular_color", json!(material.specular_color.to_array()));
    }
    if material.anisotropy_strength > 0.0 {
        set("anisotropy_strength", json!(material.anisotropy_strength));
        set("anisotropy_rotation_deg", json!(material.anisotropy_rotation_rad.to_degrees()));
    }
    for (name, mut disney) in Disney::NAMES.into_iter().zip(std::iter::repeat(material.disney)) {
        if let Some(value) = disney.as_mut().and_then(|disney| disney.parameter_mut(name)) {
            set(&format!("disney.{name}"), json!(*value));
        }
    }
    parameters
}

/// Every parameter, and the textures.
fn material(scene: &Scene, material: &Material) -> Value {
    let textures = material.textures().map(|(slot, texture)| {
        let image = &scene.images[scene.textures[texture.texture].image];
        let value = json!({
            "texture": texture.texture,
            "image": image.name,
            "size_px": [image.width, image.height],
            "uv_set": texture.uv_set,
        });
        (slot.name().to_owned(), value)
    });
    let users = scene.meshes.iter().flat_map(|mesh| &mesh.primitives);
    json!({
        "name": material.name,
        "model": if material.unlit { "unlit" } else if material.disney.is_some() { "disney" } else { "standard" },
        "alpha_mode": match material.alpha_mode {
            AlphaMode::Opaque => json!("opaque"),
            AlphaMode::Mask { cutoff } => json!({ "mask": cutoff }),
            AlphaMode::Blend => json!("blend"),
        },
        "double_sided": material.double_sided,
        "metal_fresnel": match material.metal_fresnel {
            MetalFresnel::Schlick => "schlick",
            MetalFresnel::Lazanyi { .. } => "lazanyi",
            MetalFresnel::Conductor { .. } => "conductor",
        },
        "parameters": parameters(material),
        "textures": textures.collect::<Map<String, Value>>(),
        "primitives": users.filter(|primitive| std::ptr::eq(&scene.materials[primitive.material], material)).count(),
    })
}

fn light((label, light): (String, LightInWorld)) -> Value {
    let cone = match light.kind {
        LightKind::Spot { inner_cone_rad, outer_cone_rad, .. } => {
            Some([inner_cone_rad.to_degrees(), outer_cone_rad.to_degrees()])
        }
        _ => None,
    };
    let range_m = match light.kind {
        LightKind::Point { range_m } | LightKind::Spot { range_m, .. } => range_m,
        LightKind::Directional => None,
    };
    json!({
        "label": label,
        "unit": if light.kind == LightKind::Directional { "lx" } else { "cd" },
        "intensity": light.intensity.to_array(),
        "position_in_world": (light.kind != LightKind::Directional).then(|| light.position_in_world.to_array()),
        "direction_in_world": match light.kind {
            LightKind::Point { .. } => None,
            _ => Some(light.direction_in_world.to_array()),
        },
        "range_m": range_m,
        "cone_deg": cone,
    })
}

/// The same for people: one paragraph a kind, one line a thing.
fn text(report: &Value) -> String {
    let mut text = format!("{}\n", plain(&report["model"]));
    let mut line = |head: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "  {head:12} {value}");
    };
    line("scene", format!("{} of {}", plain(&report["scene"]["index"]), list(&report["scene"]["of"])));
    if report["variants"] != json!([]) {
        line("variants", list(&report["variants"]));
    }
    let counts = report["counts"].as_object().into_iter().flatten().filter(|(_, count)| **count != json!(0));
    line(
        "holds",
        counts.map(|(name, count)| format!("{count} {}", name.replace('_', " "))).collect::<Vec<_>>().join(", "),
    );
    let bounds = &report["bounds_m"];
    line(
        "bounds, m",
        if bounds.is_null() {
            "none".into()
        } else {
            format!("{} to {}, size {}", list(&bounds["min"]), list(&bounds["max"]), list(&bounds["size"]))
        },
    );
    line(
        "extensions",
        format!("used: {}; ignored: {}", list(&report["extensions_used"]), list(&report["extensions_ignored"])),
    );
    for (title, key) in [("materials", "materials"), ("lights", "lights"), ("cameras", "cameras")] {
        let things = report[key].as_array().map_or(&[][..], Vec::as_slice);
        if !things.is_empty() {
            let _ = writeln!(text, "\n{title}");
        }
        for (index, thing) in things.iter().enumerate() {
            let _ = match key {
                "materials" => writeln!(text, "  {index:3} {}", of_material(thing)),
                // Their labels count them.
                "lights" => writeln!(text, "  {}", of_thing(thing)),
                _ => writeln!(text, "  {index:3} {}", of_thing(thing)),
            };
        }
    }
    for (index, warning) in report["warnings"].as_array().into_iter().flatten().enumerate() {
        let _ = writeln!(text, "{}  {}", if index == 0 { "\nwarnings\n" } else { "" }, plain(warning));
    }
    text
}

/// Name and kind, the parameters that are not those of glTF's default, and the textures.
fn of_material(material: &Value) -> String {
    let default = parameters(&Material::default());
    let kind = match &material["alpha_mode"] {
        Value::Object(mask) => format!("masked at {}", mask.values().map(plain).collect::<String>()),
        mode => plain(mode),
    };
    let sides = if material["double_sided"] == json!(true) { ", double-sided" } else { "" };
    let fresnel = match plain(&material["metal_fresnel"]).as_str() {
        "schlick" => String::new(),
        other => format!(", {other} Fresnel"),
    };
    let set = material["parameters"].as_object().into_iter().flatten().filter(|(name, value)| {
        ["base_color", "metallic", "perceptual_roughness"].contains(&name.as_str())
            || default.get(*name) != Some(*value)
    });
    let set: Vec<String> = set.map(|(name, value)| format!("{name} {}", one_or_list(value))).collect();
    let textures = material["textures"].as_object().into_iter().flatten();
    let textures = textures.map(|(slot, texture)| format!("{slot} {}", size(texture))).collect::<Vec<_>>().join(", ");
    let textures = if textures.is_empty() { textures } else { format!("; textures: {textures}") };
    let (name, model) = (material["name"].as_str().unwrap_or("unnamed"), plain(&material["model"]));
    format!("{name}: {model}, {kind}{sides}{fresnel}; {}{textures}", set.join(", "))
}

fn size(texture: &Value) -> String {
    let side = |index: usize| plain(&texture["size_px"][index]);
    format!("{} x {}", side(0), side(1))
}

/// Name first, then what else there is, without what is absent.
fn of_thing(thing: &Value) -> String {
    let name = thing.get("label").or(thing.get("name")).map_or_else(String::new, plain);
    let fields = thing.as_object().into_iter().flatten();
    let rest = fields.filter(|(key, value)| !value.is_null() && *key != "label" && *key != "name");
    let rest = rest.map(|(key, value)| match value {
        Value::Object(inner) => inner.iter().map(|(key, value)| format!("{key} {}", plain(value))).collect(),
        _ => format!("{key} {}", one_or_list(value)),
    });
    format!("{name}: {}", rest.collect::<Vec<_>>().join(", "))
}

fn one_or_list(value: &Value) -> String {
    if value.is_array() { list(value) } else { plain(value) }
}

fn list(value: &Value) -> String {
    let values: Vec<String> = value.as_array().into_iter().flatten().map(plain).collect();
    if values.is_empty() { "none".into() } else { values.join(" ") }
}

/// Strings without quotes, numbers with four digits, `-` for nothing.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            // The sum takes the sign from -0.
            format!("{}", (number * 1e4).round() / 1e4 + 0.0)
        }
        Value::Null => "-".into(),
        other => other.to_string(),
    }
}
