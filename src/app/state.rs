//! All that a picture of the viewer depends on, as plain data: what is in a state file.

use super::camera::Pose;
use super::edit::MaterialEdit;
use super::named;
use crate::scene::{Channel, Geometry, Quality, ToneMap};
use glam::UVec2;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Name and version of the layout of a state file.
pub const SCHEMA: &str = "specula-state/1";

/// Pictures larger than this on a side are refused before memory is asked for.
pub(super) const SIDE_MAX: u32 = 16384;

/// Why a state file cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    #[error("{path}: cannot read: {reason}", path = .path.display())]
    Read { path: PathBuf, reason: String },
    #[error("{path}: {at}: {problem}", path = .path.display())]
    Content { path: PathBuf, at: String, problem: String },
}

/// What is seen and how. The same state gives the same picture, bit by bit on the same adapter, in the window and by
/// `specula render --state`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewerState {
    pub schema: String,
    /// The file of the model; none is open without.
    pub model: Option<PathBuf>,
    /// Of its materials (KHR_materials_variants).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    pub size_px: [u32; 2],
    pub camera: CameraState,
    pub look: Look,
    pub environment: EnvironmentState,
    /// By the index of the material.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub materials: BTreeMap<usize, MaterialEdit>,
    /// Nodes that are not shown, nor what hangs below them, by index.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub hidden_nodes: BTreeSet<usize>,
    /// Factors on the strength of lights, by the index of the light.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub light_factors: BTreeMap<usize, f64>,
    /// Cameras that were put aside, by their number.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub bookmarks: BTreeMap<u8, CameraState>,
}

/// Where the picture is taken from. Without a pose the whole scene is framed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraState {
    pub pose: Option<Pose>,
    /// Vertical, above 0 and below 180.
    pub fov_deg: f64,
    /// Parallel lines stay parallel; the point that is looked at keeps its size.
    pub orthographic: bool,
}

/// How radiance becomes a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Look {
    /// Stops.
    pub exposure_ev: f32,
    #[serde(with = "named")]
    pub tone_map: ToneMap,
    pub background: BackgroundState,
    /// Of the environment in the background, in [0, 1]; 0 is sharp.
    #[serde(default)]
    pub background_blur: f32,
    pub energy_compensation: bool,
    #[serde(with = "named")]
    pub geometry: Geometry,
    #[serde(with = "named")]
    pub quality: Quality,
    #[serde(with = "named")]
    pub debug_view: Option<Channel>,
}

/// What is seen where the scene is not.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BackgroundState {
    /// A panorama of the user's, and dark grey before the built-in ones.
    Auto,
    Transparent,
    Environment,
    /// sRGB in [0, 1].
    Color([f32; 3]),
}

/// The light from around.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvironmentState {
    /// A panorama (.hdr or .exr), or one of neutral, white, black.
    pub source: String,
    /// About +Y.
    pub rotation_deg: f64,
    /// Scale of its radiance, 0 or above.
    pub intensity: f64,
}

impl Default for ViewerState {
    fn default() -> Self {
        Self {
            schema: SCHEMA.into(),
            model: None,
            variant: None,
            size_px: [1280, 800],
            camera: CameraState::default(),
            look: Look::default(),
            environment: EnvironmentState::default(),
            materials: BTreeMap::new(),
            hidden_nodes: BTreeSet::new(),
            light_factors: BTreeMap::new(),
            bookmarks: BTreeMap::new(),
        }
    }
}

impl Default for CameraState {
    fn default() -> Self {
        let fov_deg = crate::scene::framing::DEFAULT_FOV_RAD.to_degrees();
        Self { pose: None, fov_deg, orthographic: false }
    }
}

impl Default for Look {
    fn default() -> Self {
        Self {
            exposure_ev: 0.0,
            tone_map: ToneMap::default(),
            background: BackgroundState::Auto,
            background_blur: 0.0,
            energy_compensation: true,
            geometry: Geometry::default(),
            quality: Quality::default(),
            debug_view: None,
        }
    }
}

impl Default for EnvironmentState {
    fn default() -> Self {
        Self { source: "neutral".into(), rotation_deg: 0.0, intensity: 1.0 }
    }
}

impl ViewerState {
    pub fn size_px(&self) -> UVec2 {
        UVec2::from(self.size_px)
    }

    /// For another model: how to look stays, what of this model was changed goes.
    pub fn for_model(&self, model: &Path) -> Self {
        let camera = CameraState { pose: None, ..self.camera };
        let (look, environment) = (self.look.clone(), self.environment.clone());
        Self { model: Some(model.to_owned()), size_px: self.size_px, camera, look, environment, ..Self::default() }
    }

    /// As a file holds it.
    pub fn to_json(&self) -> String {
        // Plain data with text for keys: nothing in it can fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// The state of a file.
    ///
    /// # Errors
    /// When it cannot be read, is not a state of this version, or holds a number out of its range.
    pub fn read(path: &Path) -> Result<Self, StateError> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| StateError::Read { path: path.to_owned(), reason: error.to_string() })?;
        let content = |at: String, problem: String| StateError::Content { path: path.to_owned(), at, problem };
        let mut deserializer = serde_json::Deserializer::from_str(&text);
        let state: Self = serde_path_to_error::deserialize(&mut deserializer)
            .map_err(|error| content(error.path().to_string(), error.inner().to_string()))?;
        state.check().map_err(|(at, problem)| content(at.into(), problem.into()))?;
        Ok(state)
    }

    /// The place of the first value out of its range, and what it should be.
    fn check(&self) -> Result<(), (&'static str, &'static str)> {
        let is_factor = |factor: f64| factor >= 0.0 && factor.is_finite();
        let cameras = || self.bookmarks.values().chain([&self.camera]);
        let checks = [
            (self.schema == SCHEMA, "schema", "expected specula-state/1"),
            (
                self.size_px.iter().all(|side| (1..=SIDE_MAX).contains(side)),
                "size_px",
                "expected sides from 1 to 16384",
            ),
            (self.look.exposure_ev.is_finite(), "look.exposure_ev", "expected a finite number"),
            ((0.0..=1.0).contains(&self.look.background_blur), "look.background_blur", "expected a number from 0 to 1"),
            (
                cameras().all(|camera| camera.fov_deg > 0.0 && camera.fov_deg < 180.0),
                "camera.fov_deg",
                "expected degrees between 0 and 180",
            ),
            (
                cameras().all(|camera| camera.pose.is_none_or(|pose| pose.is_valid())),
                "camera.pose",
                "expected finite numbers and a distance above 0",
            ),
            (self.environment.rotation_deg.is_finite(), "environment.rotation_deg", "expected a finite number"),
            (is_factor(self.environment.intensity), "environment.intensity", "expected a number from 0 up"),
            (self.light_factors.values().copied().all(is_factor), "light_factors", "expected numbers from 0 up"),
            (
                self.materials.values().all(MaterialEdit::is_valid),
                "materials",
                "expected parameters within the ranges of glTF and Disney",
            ),
        ];
        checks.into_iter().find(|(holds, ..)| !holds).map_or(Ok(()), |(_, at, problem)| Err((at, problem)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::camera::Orbit;

    fn written(state: &str) -> Result<ViewerState, StateError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        std::fs::write(&path, state).unwrap();
        ViewerState::read(&path)
    }

    fn state() -> ViewerState {
        // Numbers that need all their digits.
        let orbit = Orbit {
            target: [0.1 + 0.2, -1e-9, 1.0 / 3.0],
            theta_rad: 2.0_f64.sqrt(),
            phi_rad: 1.1,
            distance_m: 1e6 / 7.0,
        };
        let camera = CameraState { pose: Some(Pose::Orbit(orbit)), ..CameraState::default() };
        ViewerState {
            model: Some("a model.glb".into()),
            camera,
            materials: [(3, MaterialEdit::of(&Default::default()))].into(),
            hidden_nodes: [1, 7].into(),
            light_factors: [(0, 1.0 / 3.0)].into(),
            bookmarks: [(2, CameraState { pose: Some(Pose::File(1)), ..camera })].into(),
            look: Look { debug_view: Channel::by_name("normal"), exposure_ev: 0.1 + 1.0 / 3.0, ..Look::default() },
            ..ViewerState::default()
        }
    }

    #[test]
    fn states_are_read_to_the_bit() {
        assert_eq!(written(&state().to_json()).unwrap(), state());
        assert_eq!(written(&ViewerState::default().to_json()).unwrap(), ViewerState::default());
    }

    #[test]
    fn mistakes_are_named_with_their_place() {
        let json = state().to_json();
        for (from, to, problem) in [
            ("specula-state/1", "specula-state/9", "schema: expected specula-state/1"),
            ("\"fov_deg\": 35.0", "\"fov_deg\": 180.0", "camera.fov_deg: expected degrees between 0 and 180"),
            ("\"phi_rad\": 1.1", "\"phi_rad\": 4", "camera.pose: expected finite numbers"),
            (
                "\"neutral\",\n    \"background\"",
                "\"film\",\n    \"background\"",
                "look.tone_map: `film` is none of neutral, aces",
            ),
            ("\"normal\"", "\"normals\"", "look.debug_view: `normals` is none of none, base-color"),
            ("\"metallic\": 1.0", "\"metallic\": 1.5", "materials: expected parameters within"),
            ("\"ior\"", "\"index\"", "materials.3"),
            ("\"intensity\": 1.0", "\"intensity\": -1.0", "environment.intensity: expected a number from 0 up"),
        ] {
            assert!(json.contains(from), "{from} is not in {json}");
            let error = written(&json.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(error.contains(problem) && !error.contains('\n'), "{to}: {error}");
        }
        assert!(ViewerState::read(Path::new("no/such.json")).unwrap_err().to_string().contains("cannot read"));
    }
}
