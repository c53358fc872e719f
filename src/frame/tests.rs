//! Plans of small scenes.

use super::*;
use crate::scene::{AlphaMode, Material, Mesh, Node, Primitive, Scene, View, framing, shapes};
use crate::shader::SceneFeatures;
use glam::{DMat4, DVec3, UVec2};

const OPTIONS: PlanOptions = PlanOptions { samples: 1, culling: Culling::On };

/// A mesh of its own at every place, each with one primitive of a material.
fn scene_of(materials: Vec<Material>, placed: &[(usize, DMat4)]) -> Scene {
    let sphere = |material| Primitive { material, ..shapes::sphere(0.5, 6, 0) };
    Scene {
        nodes: placed
            .iter()
            .enumerate()
            .map(|(mesh, &(_, parent_from_node))| Node { parent_from_node, mesh: Some(mesh), ..Default::default() })
            .collect(),
        roots: (0..placed.len()).collect(),
        meshes: placed.iter().map(|&(material, _)| Mesh { name: None, primitives: vec![sphere(material)] }).collect(),
        materials,
        ..Default::default()
    }
}

/// Looks along -Z from +Z.
fn view() -> View {
    let projection = crate::scene::Projection::Perspective { fov_y_rad: 0.8 };
    let eye = DVec3::new(0.0, 0.0, 10.0);
    let camera = crate::scene::Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, 0.1, 100.0);
    View { camera, ..framing::default_view(&Default::default(), UVec2::splat(128)) }
}

fn plan_of(scene: &Scene, options: PlanOptions) -> (Drawables, FramePlan) {
    let features = SceneFeatures::of(scene);
    let drawables = Drawables::new(scene, features);
    let plan = plan(&drawables, features, &view(), options);
    (drawables, plan)
}

/// The nodes that a draw shows, in its order.
fn nodes(drawables: &Drawables, plan: &FramePlan, draw: &Draw) -> Vec<usize> {
    let visible = &plan.visible[draw.instances.start as usize..draw.instances.end as usize];
    visible.iter().map(|&index| drawables.instances[index as usize].instance.node).collect()
}

fn at(x: f64, z: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(x, 0.0, z))
}

#[test]
fn copies_in_other_meshes_are_one_draw_from_front_to_back() {
    let scene = scene_of(vec![Material::default()], &[(0, at(0.0, -5.0)), (0, at(1.0, 3.0)), (0, at(-1.0, 0.0))]);
    let (drawables, plan) = plan_of(&scene, OPTIONS);
    assert_eq!((drawables.draws.len(), plan.opaque.len()), (1, 1));
    assert_eq!(nodes(&drawables, &plan, &plan.opaque[0]), [1, 2, 0]);
    assert_eq!(drawables.find((2, 0)), Some(&drawables.draws[0]));
}

#[test]
fn what_is_not_in_the_picture_is_not_drawn_and_counted() {
    let places = [(0, at(0.0, 0.0)), (0, at(50.0, 0.0)), (0, at(0.0, 20.0)), (1, at(-80.0, 0.0))];
    let scene = scene_of(vec![Material::default(), Material { metallic: 0.0, ..Default::default() }], &places);
    let (drawables, plan) = plan_of(&scene, OPTIONS);
    assert_eq!(nodes(&drawables, &plan, &plan.opaque[0]), [0]);
    assert_eq!(plan.placements, Culled { all: 4, outside: 3, between_samples: 0, hidden: 0 });
    assert_eq!(plan.drawables, Culled { all: 2, outside: 1, between_samples: 0, hidden: 0 });
    let text = plan.to_string();
    assert!(text.contains("placements: 1 of 4 drawn, 3 outside of the picture, 0 between its samples"), "{text}");
    assert!(text.contains("drawables: 1 of 2 drawn, 1 outside of the picture, 0 between its samples"), "{text}");
    let (_, all) = plan_of(&scene, PlanOptions { culling: Culling::Off, ..OPTIONS });
    assert_eq!((all.placements.drawn(), all.drawables.drawn(), all.visible.len()), (4, 2, 4));
}

#[test]
fn blended_neighbours_of_one_kind_share_a_call_and_depth_decides() {
    let glass = |metallic| Material { alpha_mode: AlphaMode::Blend, metallic, ..Default::default() };
    let places = [(0, at(0.0, 2.0)), (0, at(0.5, -4.0)), (1, at(0.0, -2.0)), (0, at(0.0, -6.0)), (0, at(0.2, 1.0))];
    let scene = scene_of(vec![glass(0.0), glass(1.0)], &places);
    let (drawables, plan) = plan_of(&scene, OPTIONS);
    let order: Vec<Vec<usize>> = plan.blended.iter().map(|draw| nodes(&drawables, &plan, draw)).collect();
    assert_eq!(order, [vec![3, 1], vec![2], vec![4, 0]]);
}

#[test]
fn culling_does_not_change_the_order_of_what_stays() {
    let spread = |i: usize| ((i as f64 * 2.399).sin() * 30.0, (i as f64 * 1.234).cos() * 12.0);
    let places: Vec<(usize, DMat4)> = (0..600).map(|i| (i % 3, at(spread(i).0, spread(i).1))).collect();
    let blended = Material { alpha_mode: AlphaMode::Blend, ..Default::default() };
    let scene = scene_of(vec![Material::default(), Material { metallic: 0.0, ..Default::default() }, blended], &places);
    let (drawables, culled) = plan_of(&scene, OPTIONS);
    let (_, all) = plan_of(&scene, PlanOptions { culling: Culling::Off, ..OPTIONS });
    let order = |plan: &FramePlan| -> Vec<usize> {
        plan.opaque.iter().chain(&plan.blended).flat_map(|draw| nodes(&drawables, plan, draw)).collect()
    };
    let kept = order(&culled);
    assert!(kept.len() > 50 && kept.len() < 400, "{}", kept.len());
    let of_all: Vec<usize> = order(&all).into_iter().filter(|node| kept.contains(node)).collect();
    assert_eq!(kept, of_all);
}

#[test]
fn a_planner_that_has_planned_before_plans_the_same() {
    let places: Vec<(usize, DMat4)> = (0..50).map(|i| (i % 2, at(i as f64 - 25.0, 0.0))).collect();
    let scene = scene_of(vec![Material::default(), Material { metallic: 0.0, ..Default::default() }], &places);
    let features = SceneFeatures::of(&scene);
    let drawables = Drawables::new(&scene, features);
    let (mut planner, mut kept) = (Planner::default(), FramePlan::default());
    for turn in 0..8 {
        let mut view = view();
        view.camera.world_from_view *= DMat4::from_rotation_y(0.3 * f64::from(turn));
        view.energy_compensation = turn % 4 < 2;
        let other = planner.plan(&drawables, features, &view, OPTIONS, &mut kept);
        assert_eq!(other, turn % 2 == 0, "pipelines change with the view's choice of shaders only");
        assert_eq!(kept, plan(&drawables, features, &view, OPTIONS));
    }
}

/// Small balls in a large one, which is the first.
fn balls_in_a_ball(material: Material) -> Scene {
    let inside = (0..100).map(|i| {
        let [x, y, z] = [i % 5, i / 5 % 5, i / 25].map(|step| 0.5 * f64::from(step) - 1.0);
        (1, DMat4::from_translation(DVec3::new(x, y, z)) * DMat4::from_scale(DVec3::splat(0.1)))
    });
    let around = (0, DMat4::from_scale(DVec3::splat(6.0)));
    scene_of(vec![material, Material::default()], &std::iter::once(around).chain(inside).collect::<Vec<_>>())
}

fn hidden(scene: &Scene, view: &View, options: PlanOptions) -> u32 {
    let features = SceneFeatures::of(scene);
    let mut drawables = Drawables::new(scene, features);
    drawables.find_occluders(scene);
    plan(&drawables, features, view, options).placements.hidden
}

#[test]
fn what_is_inside_of_something_opaque_is_hidden() {
    let opaque = balls_in_a_ball(Material::default());
    assert_eq!(hidden(&opaque, &view(), OPTIONS), 100);
    assert_eq!(hidden(&opaque, &view(), PlanOptions { culling: Culling::NotHidden, ..OPTIONS }), 0);
    // The edges of hidden triangles are seen in the wireframe, and what is hidden counts as overdraw.
    for channel in [crate::scene::Channel::Wireframe, crate::scene::Channel::Overdraw] {
        assert_eq!(hidden(&opaque, &View { channel: Some(channel), ..view() }, OPTIONS), 0);
    }
    for alpha_mode in [AlphaMode::Blend, AlphaMode::Mask { cutoff: 0.5 }] {
        assert_eq!(hidden(&balls_in_a_ball(Material { alpha_mode, ..Default::default() }), &view(), OPTIONS), 0);
    }
    // From the inside its triangles face away; those of a double-sided one hide nothing before them.
    let mut inside = view();
    inside.camera.world_from_view.w_axis.z = 1.5;
    assert_eq!(hidden(&opaque, &inside, OPTIONS), 0);
    let both = balls_in_a_ball(Material { double_sided: true, ..Default::default() });
    assert_eq!((hidden(&both, &view(), OPTIONS), hidden(&both, &inside, OPTIONS)), (100, 0));
}
