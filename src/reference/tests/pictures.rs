//! Whole pictures whose answer is known.

use super::*;

/// The default material with some fields changed.
macro_rules! material {
    ($($field:ident: $value:expr),*) => {{
        let mut material = Material::default();
        $(material.$field = $value;)*
        material
    }};
}

/// The mean over the pixels that are wholly inside a centred disc of `radius` of the half picture.
fn disc_mean(image: &RadianceImage, radius: f64) -> DVec3 {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for y in 0..image.height {
        for x in 0..image.width {
            let half = 0.5 * f64::from(image.width);
            let offset = DVec2::new(f64::from(x) + 0.5 - half, f64::from(y) + 0.5 - half);
            if offset.length() < radius * half {
                sum += texel(image, x, y).truncate();
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn white_spheres_vanish_in_a_constant_environment() {
    // Nothing can be seen of a body that reflects all light, whatever its perceptual roughness: the white furnace.
    for (metallic, perceptual_roughness) in [(1.0, 0.05), (1.0, 0.4), (1.0, 1.0), (0.0, 0.1), (0.0, 1.0), (0.5, 0.6)] {
        let material = material!(metallic: metallic, perceptual_roughness: perceptual_roughness);
        let mut scene = scene_of(sphere(32), material);
        scene.environment = Some(Environment::new(EnvironmentImage::constant(Vec3::new(0.5, 1.0, 2.0))));
        let mut view = view();
        view.size_px = UVec2::splat(16);
        view.background = Background::Environment;
        let image = render(&scene, &view, &options(256));
        let mean = disc_mean(&image, 0.7) / DVec3::new(0.5, 1.0, 2.0);
        // Measured 2.9e-4 with 256 samples; margin 2.
        assert!((mean - 1.0).abs().max_element() < 6e-4, "{metallic} {perceptual_roughness}: {mean}");
    }
}

#[test]
fn a_rough_metal_in_a_constant_environment_has_its_analytic_albedo() {
    let base_color = Vec4::new(0.9, 0.5, 0.2, 1.0);
    let material = material!(base_color: base_color, perceptual_roughness: 0.7);
    let mut scene = scene_of(square(0.0, 0), material);
    scene.environment = Some(Environment::new(EnvironmentImage::constant(Vec3::ONE)));
    let mut view = view();
    view.energy_compensation = false;
    view.size_px = UVec2::splat(8);
    let eye = DVec3::new(3.0, 0.0, 2.0);
    view.camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, Projection::Perspective { fov_y_rad: 0.01 }, 0.1, 9.0);
    let mean = disc_mean(&render(&scene, &view, &options(1024)), 1.0);
    let expected = albedo::dfg(0.7, eye.normalize().z).with_fresnel(base_color.truncate().as_dvec3(), 1.0);
    // Measured 7e-5; margin 3.
    assert!((mean - expected).abs().max_element() < 2e-4, "{mean} instead of {expected}");
}

#[test]
fn a_diffuse_sphere_under_a_point_light_follows_lambert() {
    // Without a specular lobe the dielectric is Lambert's: base colour / pi * E cos.
    let material = material!(base_color: Vec4::new(0.8, 0.4, 0.2, 1.0),
        metallic: 0.0,
        specular: 0.0,
        perceptual_roughness: 1.0);
    let mut scene = scene_of(sphere(256), material);
    let light = DVec3::new(3.0, 2.0, 4.0);
    add_light(&mut scene, LightKind::Point { range_m: Some(10.0) }, 50.0, light);
    let view = view();
    let image = render(&scene, &view, &options(64));
    for (x, y) in [(32, 32), (40, 25), (45, 32), (30, 20), (22, 40)] {
        let (origin, direction) = view.camera.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), view.size_px);
        let half_b = origin.dot(direction);
        let point = origin + direction * (-half_b - (half_b * half_b - origin.length_squared() + 1.0).sqrt());
        let to_light = light - point;
        let (d, cos) = (to_light.length(), point.dot(to_light.normalize()).max(0.0));
        let illuminance = 50.0 / (d * d) * (1.0 - (d / 10.0).powi(4)) * cos;
        let expected = DVec3::new(0.8, 0.4, 0.2) / PI * illuminance;
        let actual = texel(&image, x, y);
        // Measured 2.4e-4: 64 samples, and the curvature of the sphere over a pixel. Margin 3.
        assert!((actual.truncate() - expected).length() < 7e-4 * expected.length(), "{actual} instead of {expected}");
        assert_eq!(actual.w, 1.0);
    }
}

#[test]
fn blended_layers_composite_front_to_back_and_masked_ones_are_holes() {
    let layer = |color: [f32; 4], alpha_mode| {
        material!(base_color: Vec4::from_array(color),
        unlit: true,
        alpha_mode: alpha_mode)
    };
    let mut scene = scene_of(square(0.0, 0), layer([1.0, 0.0, 0.0, 0.25], AlphaMode::Blend));
    scene.materials.push(layer([0.0, 1.0, 0.0, 0.5], AlphaMode::Blend));
    scene.materials.push(layer([0.0, 0.0, 1.0, 0.4], AlphaMode::Mask { cutoff: 0.5 }));
    scene.meshes[0].primitives.extend([square(-0.2, 1), square(-0.1, 2)]);
    let center = texel(&render(&scene, &view(), &options(2)), 32, 32);
    assert!((center - glam::DVec4::new(0.25, 0.375, 0.0, 0.625)).length() < 1e-6, "{center}");

    scene.materials[2].alpha_mode = AlphaMode::Mask { cutoff: 0.3 };
    let center = texel(&render(&scene, &view(), &options(2)), 32, 32);
    assert!((center - glam::DVec4::new(0.25, 0.0, 0.75, 1.0)).length() < 1e-6, "{center}");
}

#[test]
fn the_picture_does_not_depend_on_the_number_of_threads() {
    let mut scene = scene_of(sphere(12), material!(perceptual_roughness: 0.3));
    let texels = (0..32).map(|i| Vec3::splat(i as f32 * 0.1)).collect();
    scene.environment = Some(Environment::new(EnvironmentImage { width: 8, height: 4, texels }));
    let with_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| render(&scene, &view(), &options(3)))
    };
    assert_eq!(with_threads(1), with_threads(3));
}

#[test]
fn a_mirror_shows_the_environment_where_it_is() {
    // A mirror at 45 degrees shows a camera that looks along -Z what lies toward +X: the panorama's centre.
    let mut texels = vec![Vec3::ZERO; 16 * 8];
    for (x, y) in [(7, 3), (8, 3), (7, 4), (8, 4)] {
        texels[y * 16 + x] = Vec3::ONE;
    }
    let environment = Environment::new(EnvironmentImage { width: 16, height: 8, texels });
    let mut scene = scene_of(square(0.0, 0), material!(perceptual_roughness: 0.0));
    scene.environment = Some(environment);
    scene.nodes[0].parent_from_node = DMat4::from_rotation_y(PI / 4.0);
    let seen = texel(&render(&scene, &view(), &options(64)), 32, 32);
    assert!((seen.x - 1.0).abs() < 0.02, "{seen}");
    scene.nodes[0].parent_from_node = DMat4::from_rotation_y(-PI / 4.0);
    let seen = texel(&render(&scene, &view(), &options(64)), 32, 32);
    assert!(seen.x < 0.02, "{seen}");
}

#[test]
fn normal_maps_tilt_toward_the_tangent() {
    // A texture that points toward +u everywhere; on the sphere u runs to the right, on its mirror image to the left.
    let pixels = Pixels::Rgba8(vec![255, 128, 128, 255].into());
    let mut material = material!(metallic: 0.0, specular: 0.0);
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::IDENTITY };
    material.set_texture(TextureSlot::Normal, Some(texture));
    let mut scene = scene_of(sphere(64), material);
    scene.images.push(Image { name: None, width: 1, height: 1, pixels });
    scene.textures.push(Texture { image: 0, sampler: Sampler::default() });
    let normal = |scene: &Scene| {
        let world = surface::World::new(scene, &view());
        let ray = geometry::Ray { origin: DVec3::Z * 3.0, direction: DVec3::NEG_Z, t_min: 0.0, t_max: 9.0 };
        world.surface(&world.layers(&ray)[0].hit).normal_in_world
    };
    // Code 128 is 1/255, not 0: a known bias of 8-bit normal maps.
    assert!((normal(&scene) - DVec3::new(1.0, 0.004, 0.004).normalize()).length() < 2e-3, "{}", normal(&scene));
    scene.nodes[0].parent_from_node = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    assert!(normal(&scene).x < -0.99, "{}", normal(&scene));

    // v runs down in the picture, the bitangent up (glTF: +Y of the map is up).
    scene.nodes[0].parent_from_node = DMat4::IDENTITY;
    scene.images[0].pixels = Pixels::Rgba8(vec![128, 255, 128, 255].into());
    assert!(normal(&scene).y > 0.99, "{}", normal(&scene));
    scene.nodes[0].parent_from_node = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    assert!(normal(&scene).y > 0.99, "mirrored: {}", normal(&scene));
}

#[test]
fn the_back_of_a_double_sided_surface_is_lit_from_behind() {
    let mut scene = scene_of(square(0.0, 0), material!(metallic: 0.0, specular: 0.0));
    scene.materials[0].double_sided = true;
    scene.nodes[0].parent_from_node = DMat4::from_rotation_y(PI);
    add_light(&mut scene, LightKind::Point { range_m: None }, PI, DVec3::Z);
    let center = texel(&render(&scene, &view(), &options(4)), 32, 32);
    assert!((center.x - 1.0).abs() < 0.01, "{center}");
}

#[test]
fn points_and_lines_without_normals_show_their_base_colour() {
    let mut primitive = square(0.0, 0);
    primitive.normals = None;
    primitive.topology = Topology::Lines;
    primitive.positions = vec![Vec3::new(-2.0, 0.0, 0.0), Vec3::new(2.0, 0.0, 0.0)];
    primitive.indices = vec![0, 1];
    let scene = scene_of(primitive, material!(base_color: Vec4::new(0.2, 0.4, 0.6, 1.0)));
    let image = render(&scene, &view(), &options(64));
    // The line runs between two rows of pixels and covers half of each.
    let (above, below, away) = (texel(&image, 20, 31), texel(&image, 20, 32), texel(&image, 20, 33));
    for half in [above, below] {
        assert!((half - glam::DVec4::new(0.1, 0.2, 0.3, 0.5)).length() < 0.02, "{half}");
    }
    assert_eq!(away, glam::DVec4::ZERO);
}
