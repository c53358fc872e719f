//! A folder with a model, its texture and a suite, and the program that runs on it.

use crate::support::program;
use serde_json::{Value, json};
use specula::scene::shapes;
use std::path::{Path, PathBuf};
use std::process::Output;
use tempfile::TempDir;

/// What of the model is to be broken.
pub(super) struct Model {
    pub(super) perceptual_roughness: f64,
    pub(super) base_color: [f64; 4],
    pub(super) textured: bool,
    /// Of a point light in front of the sphere, in candela; none is no light.
    pub(super) light_cd: Option<f64>,
}

impl Default for Model {
    fn default() -> Self {
        Self { perceptual_roughness: 0.3, base_color: [1.0; 4], textured: true, light_cd: Some(20.0) }
    }
}

/// `s.toml`, `model.gltf` and what belongs to them in a folder of their own.
pub(super) struct Fixture {
    folder: TempDir,
}

/// Thresholds as a team would have them.
pub(super) const THRESHOLDS: &str = "thresholds = [\"flip.mean <= 0.004\", \"max-abs <= 24 @ 0.05%\"]";

/// One case of 96 x 96 pixels, of 2.5 cm each.
pub(super) const CASE: &str = "[[case]]\nname = \"sphere\"\nmodel = \"model.gltf\"\nsize = \"96x96\"\northo = 2.4\n\
                               eye = [0, 0, 3]\nlook-at = [0, 0, 0]\n";

impl Fixture {
    /// A sphere and a suite with one case, which llvmpipe may bless.
    pub(super) fn new() -> Self {
        let fixture = Self { folder: tempfile::tempdir().unwrap() };
        fixture.texture(|x, y| [if (x / 8 + y / 8) % 2 == 0 { 220 } else { 40 }, 120, 60]);
        fixture.model(&Model::default());
        fixture.suite(CASE);
        fixture
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(super) fn texture(&self, color: impl Fn(u32, u32) -> [u8; 3]) {
        image::RgbImage::from_fn(64, 64, |x, y| image::Rgb(color(x, y))).save(self.path("texture.png")).unwrap();
    }

    /// Writes the cases behind the head of the suite.
    pub(super) fn suite(&self, cases: &str) {
        self.write("s.toml", &format!("[suite]\nbless = [\"*\"]\n\n[defaults]\n{THRESHOLDS}\n\n{cases}"));
    }

    pub(super) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub(super) fn model(&self, model: &Model) {
        let sphere = shapes::sphere(1.0, 24, 0);
        let normals = sphere.normals.as_ref().unwrap();
        let uvs = sphere.uvs[0].iter().flat_map(|uv| uv.to_array());
        let parts = [
            sphere.indices.iter().copied().flat_map(u32::to_le_bytes).collect(),
            numbers(sphere.positions.iter().flat_map(|position| position.to_array())),
            numbers(normals.iter().flat_map(|normal| normal.to_array())),
            numbers(uvs),
        ];
        std::fs::write(self.path("model.bin"), parts.concat()).unwrap();
        let document = document(model, &parts, (sphere.indices.len(), sphere.positions.len()));
        self.write("model.gltf", &document.to_string());
    }

    /// Runs `specula COMMAND s.toml ARGUMENTS`.
    pub(super) fn run(&self, command: &str, arguments: &[&str]) -> Ran {
        let output = program().arg(command).arg(self.path("s.toml")).args(arguments).output().unwrap();
        Ran::of(output, &self.path("s.out"))
    }

    /// A run that makes the goldens.
    pub(super) fn bless(&self) -> Ran {
        self.run("test", &["--update", "all"]).expect(0)
    }

    pub(super) fn golden(&self, id: &str) -> PathBuf {
        self.path("s.goldens/any").join(format!("{id}.png"))
    }
}

fn numbers(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}

/// The glTF document; `parts` are indices, positions, normals and texture coordinates.
fn document(model: &Model, parts: &[Vec<u8>; 4], (indices, vertices): (usize, usize)) -> Value {
    let mut end = 0;
    let view = |part: &Vec<u8>| {
        end += part.len();
        json!({"buffer": 0, "byteOffset": end - part.len(), "byteLength": part.len()})
    };
    let views: Vec<Value> = parts.iter().map(view).collect();
    let mut surface = json!({"baseColorFactor": model.base_color, "metallicFactor": 0.0,
                             "roughnessFactor": model.perceptual_roughness});
    if model.textured {
        surface["baseColorTexture"] = json!({"index": 0});
    }
    let mut document = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}], "scene": 0,
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1, "NORMAL": 2, "TEXCOORD_0": 3},
                                    "indices": 0, "material": 0}]}],
        "materials": [{"name": "ball", "pbrMetallicRoughness": surface}],
        "textures": [{"source": 0}], "images": [{"uri": "texture.png"}],
        "buffers": [{"uri": "model.bin", "byteLength": end}],
        "bufferViews": views,
        "accessors": [
            {"bufferView": 0, "componentType": 5125, "count": indices, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": vertices, "type": "VEC3",
             "min": [-1, -1, -1], "max": [1, 1, 1]},
            {"bufferView": 2, "componentType": 5126, "count": vertices, "type": "VEC3"},
            {"bufferView": 3, "componentType": 5126, "count": vertices, "type": "VEC2"},
        ],
    });
    if let Some(intensity) = model.light_cd {
        document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
        document["extensions"] =
            json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": intensity}]}});
        document["nodes"][0]["children"] = json!([1]);
        let light = json!({"translation": [2, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}});
        document["nodes"].as_array_mut().unwrap().push(light);
    }
    document
}

/// What a run has said and left.
pub(super) struct Ran {
    pub(super) code: Option<i32>,
    pub(super) stdout: String,
    pub(super) stderr: String,
    /// Null where there is none.
    pub(super) report: Value,
}

impl Ran {
    fn of(output: Output, out: &Path) -> Self {
        let report = std::fs::read(out.join("report.json")).ok();
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
            report: report.map_or(Value::Null, |bytes| serde_json::from_slice(&bytes).unwrap()),
        }
    }

    pub(super) fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}{}", self.stdout, self.stderr);
        self
    }

    /// The report of a case.
    pub(super) fn case(&self, id: &str) -> &Value {
        let cases = self.report["cases"].as_array().unwrap();
        cases.iter().find(|case| case["id"] == id).unwrap_or_else(|| panic!("{id} is not in {}", self.report))
    }

    /// Names of the conditions that do not hold.
    pub(super) fn broken(&self, id: &str) -> Vec<&str> {
        let metrics = self.case(id)["metrics"].as_array().unwrap();
        metrics.iter().filter(|metric| metric["holds"] == false).filter_map(|metric| metric["name"].as_str()).collect()
    }
}
