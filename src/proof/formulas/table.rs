//! The rows of docs/brdf.md. A formula joins by one entry; a test finds every function that is named.

use super::{Formula, Place};
use crate::proof::stress::SPECULAR_LOBE;

const ALBEDO: &str = "src/reference/albedo.rs";
const ATTENUATION: &str = "shaders/light/attenuation.wgsl";
const BRDF: &str = "src/reference/brdf.rs";
const BSDF: &str = "src/reference/bsdf.rs";
const COLOR: &str = "src/reference/color.rs";
const DISTRIBUTION: &str = "src/reference/microfacet/distribution.rs";
const ELLIPSOID: &str = "src/reference/microfacet/ellipsoid.rs";
const FRAMES: &str = "tests/suite/frames.rs";
const FRESNEL: &str = "src/reference/microfacet/fresnel.rs";
const LAWS: &str = "src/reference/laws/tests.rs";
const LECTURE: &str = "src/radiometry/tests/lecture.rs";
const LIGHTS: &str = "src/reference/lights.rs";
const LOBES: &str = "shaders/lighting/lobes.wgsl";
const MASKING: &str = "src/reference/microfacet/masking.rs";
const METALS: &str = "src/reference/microfacet/metals.rs";
const PLANE: &str = "tests/suite/lit_plane.rs";
const QUANTITIES: &str = "src/radiometry/tests/quantities.rs";
const RECTANGLES: &str = "src/radiometry/tests/rectangles.rs";
const SOLID_ANGLE: &str = "src/radiometry/solid_angle.rs";
const SOLID_ANGLES: &str = "src/radiometry/tests/solid_angles.rs";
const TRANSFER: &str = "src/reference/microfacet/transfer.rs";

const fn at(file: &'static str, function: &'static str) -> Place {
    Place { file, function }
}

/// All formulas, group by group.
pub const FORMULAS: &[(&str, &[Formula])] = &[
    (
        "Radiometry",
        &[
            Formula {
                name: "Irradiance and exitance",
                equation: "E = dPhi / dA",
                rust: at("src/radiometry/algebra.rs", "incident_on"),
                wgsl: None,
                laws: &[at(LECTURE, "fifty_watts_on_two_square_meters")],
                stress: None,
            },
            Formula {
                name: "Exitance from radiance",
                equation: "M = integral of L(theta) cos(theta) d omega",
                rust: at("src/radiometry/emission.rs", "exitance"),
                wgsl: None,
                laws: &[at(LECTURE, "a_small_source_that_is_brightest_ahead")],
                stress: None,
            },
            Formula {
                name: "Irradiance from a point light of known flux",
                equation: "E = Phi cos(theta) / (4 pi r^2)",
                rust: at("src/radiometry/algebra.rs", "irradiance_at"),
                wgsl: None,
                laws: &[at(LECTURE, "a_point_light_of_known_flux"), at(QUANTITIES, "lamberts_cosine_law")],
                stress: None,
            },
            Formula {
                name: "Irradiance from a rectangle, quadrature",
                equation: "E = integral of L cos(theta) cos(theta') / r^2 dA",
                rust: at("src/radiometry/irradiance.rs", "by_quadrature"),
                wgsl: None,
                laws: &[at(RECTANGLES, "lamberts_polygon_formula_agrees_with_quadrature")],
                stress: None,
            },
            Formula {
                name: "Irradiance from a rectangle, closed form",
                equation: "E = L / 2 sum of gamma_i (n . n_i)",
                rust: at("src/radiometry/irradiance.rs", "from_rectangle"),
                wgsl: None,
                laws: &[
                    at(RECTANGLES, "lamberts_polygon_formula_agrees_with_quadrature"),
                    at(RECTANGLES, "closed_forms_of_view_factors"),
                ],
                stress: None,
            },
            Formula {
                name: "Radiance along a ray",
                equation: "L = d^2 Phi / (dA cos(theta) d omega), constant",
                rust: at("src/radiometry/irradiance.rs", "etendue"),
                wgsl: None,
                laws: &[at(RECTANGLES, "radiance_is_constant_along_a_ray")],
                stress: None,
            },
            Formula {
                name: "Solid angle of a disc",
                equation: "omega = 2 pi (1 - d / sqrt(d^2 + r^2))",
                rust: at(SOLID_ANGLE, "disc"),
                wgsl: None,
                laws: &[at(SOLID_ANGLES, "cones_discs_and_spheres")],
                stress: None,
            },
            Formula {
                name: "Solid angle of a sphere",
                equation: "omega = 2 pi (1 - sqrt(1 - (r/d)^2))",
                rust: at(SOLID_ANGLE, "sphere"),
                wgsl: None,
                laws: &[at(SOLID_ANGLES, "cones_discs_and_spheres")],
                stress: None,
            },
            Formula {
                name: "Solid angle of a triangle",
                equation: "tan(omega/2) = a.(b x c) / (abc + (a.b) c + (b.c) a + (c.a) b)",
                rust: at(SOLID_ANGLE, "triangle"),
                wgsl: None,
                laws: &[at(SOLID_ANGLES, "triangles_tile_and_turn")],
                stress: None,
            },
            Formula {
                name: "Solid angle of a rectangle",
                equation: "the sum over two triangles",
                rust: at(SOLID_ANGLE, "rectangle"),
                wgsl: None,
                laws: &[at(SOLID_ANGLES, "rectangles_on_and_off_the_axis")],
                stress: None,
            },
        ],
    ),
    (
        "Light",
        &[
            Formula {
                name: "Reflectance equation: point, spot and directional lights",
                equation: "L_o(v) = sum of f(l, v) E(l) n.l",
                rust: at(LIGHTS, "incidence"),
                wgsl: Some(at("shaders/lighting/punctual.wgsl", "punctual_radiance")),
                laws: &[
                    at(PLANE, "a_plane_is_lit_as_the_model_says"),
                    at(FRAMES, "a_sphere_under_a_point_light_is_the_references"),
                ],
                stress: None,
            },
            Formula {
                name: "Reflectance equation: environment",
                equation: "L_o(v) = integral of f(l, v) L_i(l) n.l dl",
                rust: at("src/reference/integrator.rs", "radiance"),
                wgsl: Some(at("shaders/lighting/environment.wgsl", "environment_radiance")),
                laws: &[
                    at("src/reference/integrator.rs", "the_estimate_is_the_integral"),
                    at(FRAMES, "a_white_furnace_returns_all_light"),
                ],
                stress: None,
            },
            Formula {
                name: "Inverse square law with range",
                equation: "1/d^2 clamp(1 - (d/range)^4, 0, 1)",
                rust: at(LIGHTS, "range_window"),
                wgsl: Some(at(ATTENUATION, "distance_attenuation")),
                laws: &[at(LIGHTS, "light_falls_with_the_square_of_the_distance_and_ends_at_its_range")],
                stress: None,
            },
            Formula {
                name: "Spot cone",
                equation: "clamp((cos - cos_outer) / (cos_inner - cos_outer), 0, 1)^2",
                rust: at(LIGHTS, "spot_cone"),
                wgsl: Some(at(ATTENUATION, "spot_attenuation")),
                laws: &[at(LIGHTS, "a_spot_is_full_inside_its_inner_cone_and_dark_outside_its_outer_one")],
                stress: None,
            },
            Formula {
                name: "Irradiance by spherical harmonics",
                equation: "E(n) / pi = sum of c_k Y_k(n), degree 2",
                rust: at("src/bake/irradiance.rs", "irradiance_over_pi"),
                wgsl: Some(at("shaders/light/irradiance_sh.wgsl", "irradiance_over_pi_sh")),
                laws: &[at("src/bake/irradiance.rs", "a_cosine_lobe_of_light_has_the_closed_form")],
                stress: None,
            },
        ],
    ),
    (
        "Microfacets: distribution of normals D",
        &[
            Formula {
                name: "GGX",
                equation: "alpha^2 / (pi ((n.h)^2 (alpha^2 - 1) + 1)^2)",
                rust: at(BRDF, "D_GGX"),
                wgsl: Some(at("shaders/brdf/d_ggx.wgsl", "D_GGX")),
                laws: &[
                    at(BRDF, "facets_project_onto_the_surface_they_make_up"),
                    at(LAWS, "what_a_view_sees_of_the_facets_is_the_surface"),
                ],
                stress: None,
            },
            Formula {
                name: "GGX, anisotropic",
                equation: "1 / (pi a_x a_y ((t.h/a_x)^2 + (b.h/a_y)^2 + (n.h)^2)^2)",
                rust: at(DISTRIBUTION, "D_GGX_anisotropic"),
                wgsl: Some(at("shaders/brdf/d_ggx_anisotropic.wgsl", "D_GGX_anisotropic")),
                laws: &[
                    at(DISTRIBUTION, "equal_alphas_are_isotropic"),
                    at(LAWS, "facets_of_every_distribution_cover_their_surface"),
                ],
                stress: None,
            },
            Formula {
                name: "Ellipsoid, A = R S",
                equation: "det(A) / (pi length(A^-1 n) length(A^T m)^4)",
                rust: at(ELLIPSOID, "D"),
                wgsl: None,
                laws: &[
                    at(ELLIPSOID, "without_a_lean_it_is_anisotropic_ggx"),
                    at(LAWS, "facets_of_every_distribution_cover_their_surface"),
                ],
                stress: None,
            },
        ],
    ),
    (
        "Microfacets: geometry G",
        &[
            Formula {
                name: "Smith's Lambda for GGX",
                equation: "(sqrt(1 + alpha^2 tan^2) - 1) / 2",
                rust: at(BRDF, "Lambda_GGX"),
                wgsl: None,
                laws: &[at(BRDF, "visible_facets_project_onto_the_surface_seen")],
                stress: None,
            },
            Formula {
                name: "Height-correlated Smith",
                equation: "V = 1 / ((1 + Lambda(v) + Lambda(l)) 4 n.v n.l)",
                rust: at(BRDF, "V_SmithGGXCorrelated"),
                wgsl: Some(at("shaders/brdf/v_smith_ggx_correlated.wgsl", "V_SmithGGXCorrelated")),
                laws: &[at(BRDF, "masking_and_shadowing_are_bounded_and_symmetric")],
                stress: None,
            },
            Formula {
                name: "Height-correlated Smith, anisotropic",
                equation: "the same, with Lambda along each direction",
                rust: at(MASKING, "V_SmithGGXCorrelated_anisotropic"),
                wgsl: Some(at(
                    "shaders/brdf/v_smith_ggx_correlated_anisotropic.wgsl",
                    "V_SmithGGXCorrelated_anisotropic",
                )),
                laws: &[at(MASKING, "the_functions_are_the_models")],
                stress: None,
            },
            Formula {
                name: "Separable Smith",
                equation: "V = G1(v) G1(l) / (4 n.v n.l)",
                rust: at(MASKING, "V_SmithGGX_separable"),
                wgsl: Some(at("shaders/brdf/v_smith_ggx_separable.wgsl", "V_SmithGGX_separable")),
                laws: &[
                    at(MASKING, "the_functions_are_the_models"),
                    at(LAWS, "geometry_models_lose_what_the_documentation_says"),
                ],
                stress: None,
            },
            Formula {
                name: "Schlick: k = alpha / 2, (r + 1)^2 / 8 or ((r + 1) / 2)^2",
                equation: "G1(x) = n.x / (n.x (1 - k) + k)",
                rust: at(MASKING, "V_Schlick"),
                wgsl: Some(at("shaders/brdf/v_schlick.wgsl", "V_Schlick")),
                laws: &[
                    at(MASKING, "schlick_with_half_of_alpha_meets_separable_smith_at_alpha_1"),
                    at(LAWS, "geometry_models_lose_what_the_documentation_says"),
                ],
                stress: None,
            },
        ],
    ),
    (
        "Fresnel F",
        &[
            Formula {
                name: "Schlick",
                equation: "F0 + (F90 - F0) (1 - v.h)^5",
                rust: at(BRDF, "F_Schlick"),
                wgsl: Some(at("shaders/brdf/f_schlick.wgsl", "F_Schlick")),
                laws: &[
                    at(BRDF, "schlicks_average_is_the_average_of_schlick"),
                    at(METALS, "approximations_are_as_far_off_as_documented"),
                ],
                stress: None,
            },
            Formula {
                name: "Schlick-Lazanyi",
                equation: "Schlick - a v.h (1 - v.h)^6",
                rust: at(FRESNEL, "F_Lazanyi"),
                wgsl: Some(at("shaders/brdf/f_lazanyi.wgsl", "F_Lazanyi")),
                laws: &[
                    at(METALS, "the_table_holds_what_the_fit_finds"),
                    at(METALS, "approximations_are_as_far_off_as_documented"),
                ],
                stress: None,
            },
            Formula {
                name: "F82-tint",
                equation: "the same, with a from F at v.h = 1/7",
                rust: at(FRESNEL, "F_F82"),
                wgsl: None,
                laws: &[at(METALS, "approximations_are_as_far_off_as_documented")],
                stress: None,
            },
            Formula {
                name: "Exact, dielectric",
                equation: "(r_s^2 + r_p^2) / 2 from the index of refraction",
                rust: at(FRESNEL, "F_dielectric"),
                wgsl: None,
                laws: &[at(FRESNEL, "the_exact_equations_agree_with_each_other_and_with_known_points")],
                stress: None,
            },
            Formula {
                name: "Exact, conductor",
                equation: "(R_s + R_p) / 2 from the complex index",
                rust: at(FRESNEL, "F_conductor"),
                wgsl: Some(at("shaders/brdf/f_conductor.wgsl", "F_conductor")),
                laws: &[
                    at(FRESNEL, "the_exact_equations_agree_with_each_other_and_with_known_points"),
                    at(METALS, "metals_have_their_known_colours"),
                ],
                stress: None,
            },
        ],
    ),
    (
        "Transfer functions",
        &[
            Formula {
                name: "Perceptual roughness",
                equation: "alpha = perceptual_roughness^2",
                rust: at(BRDF, "alpha_from_perceptual_roughness"),
                wgsl: Some(at(LOBES, "make_lobes")),
                laws: &[at(PLANE, "a_plane_is_lit_as_the_model_says")],
                stress: None,
            },
            Formula {
                name: "Glossiness",
                equation: "alpha = (1 - glossiness)^2",
                rust: at(TRANSFER, "alpha"),
                wgsl: None,
                laws: &[at(TRANSFER, "glossiness_runs_the_other_way")],
                stress: None,
            },
        ],
    ),
    (
        "Lobes",
        &[
            Formula {
                name: "Lambert",
                equation: "rho / pi",
                rust: at(BRDF, "Fd_Lambert"),
                wgsl: Some(at("shaders/brdf/fd_lambert.wgsl", "Fd_Lambert")),
                laws: &[at("src/reference/tests/pictures.rs", "a_diffuse_sphere_under_a_point_light_follows_lambert")],
                stress: None,
            },
            Formula {
                name: "Lambert below an interface",
                equation: "rho / pi (1 - E_s(v)) (1 - E_s(l)) / (1 - E_s,avg)",
                rust: at(BRDF, "Fd_Coupled"),
                wgsl: Some(at(LOBES, "evaluate_lobes")),
                laws: &[at(BSDF, "a_white_dielectric_reflects_all_light"), at(BSDF, "light_and_view_can_be_exchanged")],
                stress: None,
            },
            Formula {
                name: "Albedo of the specular lobe",
                equation: "E_s = F0 scale + F90 bias + F_ms (1 - E)",
                rust: at(ALBEDO, "with_fresnel"),
                wgsl: Some(at("shaders/lobe/albedo.wgsl", "E_specular")),
                laws: &[
                    at(ALBEDO, "albedos_match_closed_forms_and_an_independent_integrator"),
                    at(ALBEDO, "nothing_reflects_more_than_it_receives_and_grazing_light_is_all_reflected"),
                ],
                stress: None,
            },
            Formula {
                name: "Multiple scattering",
                equation: "F_ms = F_avg^2 e / (1 - F_avg (1 - e)), e = E_avg (1 + 0.7 (1 - E_avg))",
                rust: at(BRDF, "F_multiscatter"),
                wgsl: Some(at("shaders/lobe/multiscatter_kulla_conty.wgsl", "F_multiscatter")),
                laws: &[
                    at(BSDF, "a_white_metal_reflects_all_light_with_compensation_and_loses_it_without"),
                    at(BSDF, "coloured_rough_metals_lose_at_every_bounce"),
                    at(BRDF, "facets_give_back_no_more_light_than_met_them"),
                ],
                stress: None,
            },
            Formula {
                name: "Cook-Torrance",
                equation: "f_s = D V F",
                rust: at("src/reference/microfacet/mod.rs", "evaluate"),
                wgsl: Some(at(LOBES, "evaluate_lobes")),
                laws: &[
                    at("src/reference/microfacet/mod.rs", "the_default_combination_is_the_lobe_of_the_renderer"),
                    at(LAWS, "combinations_obey_the_laws"),
                ],
                stress: Some(&SPECULAR_LOBE),
            },
            Formula {
                name: "All lobes of a material",
                equation: "f = D V F + f_ms + f_d",
                rust: at(BSDF, "evaluate"),
                wgsl: Some(at(LOBES, "evaluate_lobes")),
                laws: &[at(BSDF, "light_and_view_can_be_exchanged"), at(FRAMES, "a_white_furnace_returns_all_light")],
                stress: None,
            },
        ],
    ),
    (
        "Disney BRDF (Burley 2012)",
        &[
            Formula {
                name: "Diffuse with retro-reflection",
                equation: "(1 + (F_D90 - 1) (1 - NoL)^5) (1 + (F_D90 - 1) (1 - NoV)^5) / pi, F_D90 = 1/2 + 2 LoH^2 r",
                rust: at("src/reference/disney.rs", "Fd_Burley"),
                wgsl: Some(at("shaders/brdf/fd_burley.wgsl", "Fd_Burley")),
                laws: &[at("tests/suite/disney.rs", "in_a_furnace_every_material_returns_its_albedo")],
                stress: None,
            },
            Formula {
                name: "Subsurface",
                equation: "1.25 (F_ss (1 / (NoL + NoV) - 1/2) + 1/2) / pi",
                rust: at("src/reference/disney.rs", "Fd_Subsurface"),
                wgsl: Some(at("shaders/brdf/fd_subsurface.wgsl", "Fd_Subsurface")),
                laws: &[at("tests/suite/disney.rs", "in_a_furnace_every_material_returns_its_albedo")],
                stress: None,
            },
            Formula {
                name: "GTR1 of the clearcoat",
                equation: "D = (a^2 - 1) / (pi ln a^2 (1 + (a^2 - 1) NoH^2))",
                rust: at("src/reference/disney.rs", "D_GTR1"),
                wgsl: Some(at("shaders/brdf/d_gtr1.wgsl", "D_GTR1")),
                laws: &[at("src/reference/disney.rs", "facets_project_onto_the_surface_they_make_up")],
                stress: None,
            },
            Formula {
                name: "Masking",
                equation: "G1 = 2 NoX / (NoX + sqrt(a^2 + NoX^2 - a^2 NoX^2))",
                rust: at("src/reference/disney.rs", "G1_SmithGGX"),
                wgsl: Some(at("shaders/brdf/g1_smith_ggx.wgsl", "G1_SmithGGX")),
                laws: &[at("src/reference/disney.rs", "without_anisotropy_the_lobe_is_ggx")],
                stress: None,
            },
            Formula {
                name: "Sum of all lobes",
                equation: "((1 - m)(base f_d + sheen) + D F G + 0.25 clearcoat D_r F_r G_r)",
                rust: at("src/reference/disney/bsdf.rs", "evaluate"),
                wgsl: Some(at("shaders/lighting/disney.wgsl", "evaluate_lobes")),
                laws: &[at("tests/suite/disney.rs", "in_a_furnace_every_material_returns_its_albedo")],
                stress: None,
            },
        ],
    ),
    (
        "Display",
        &[
            Formula {
                name: "sRGB",
                equation: "1.055 x^(1/2.4) - 0.055",
                rust: at("src/math/color.rs", "srgb_from_linear"),
                wgsl: Some(at("shaders/color/srgb.wgsl", "srgb_from_linear")),
                laws: &[at("src/math/color.rs", "srgb_round_trips_every_8_bit_code")],
                stress: None,
            },
            Formula {
                name: "Khronos PBR Neutral",
                equation: "1 - room^2 / (peak + room - start) above the start",
                rust: at(COLOR, "neutral"),
                wgsl: Some(at("shaders/color/tone_map_neutral.wgsl", "tone_map")),
                laws: &[at(COLOR, "neutral_keeps_base_colours")],
                stress: None,
            },
            Formula {
                name: "ACES",
                equation: "Hill's fit of RRT and ODT",
                rust: at(COLOR, "aces"),
                wgsl: Some(at("shaders/color/tone_map_aces.wgsl", "tone_map")),
                laws: &[at(COLOR, "published_points_of_the_curves")],
                stress: None,
            },
            Formula {
                name: "AgX",
                equation: "Sobotka's curve in Wrensch's fit",
                rust: at(COLOR, "agx"),
                wgsl: Some(at("shaders/color/tone_map_agx.wgsl", "tone_map")),
                laws: &[at(COLOR, "published_points_of_the_curves")],
                stress: None,
            },
            Formula {
                name: "Reinhard",
                equation: "x / (1 + x)",
                rust: at(COLOR, "reinhard"),
                wgsl: Some(at("shaders/color/tone_map_reinhard.wgsl", "tone_map")),
                laws: &[at(COLOR, "greys_rise_monotonically_from_black_to_white")],
                stress: None,
            },
        ],
    ),
];
