//! An X server without a screen, and the program in a window of it.

use crate::support::program;
use serde_json::json;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Longer than any of this takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(240);

/// A running server; it ends with this.
pub(super) struct Screen {
    server: Child,
    display: String,
    /// Where the server keeps what it shows, and where pictures are saved.
    pub(super) folder: TempDir,
}

/// The program in a window; it ends with this.
pub(super) struct Window {
    child: Child,
}

/// Looks until there is something, or for as long as anybody waits.
pub(super) fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let began = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(began.elapsed() < PATIENCE, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

impl Screen {
    /// A server, or `None` (printed) where there is none; under CI=true it must be there.
    pub(super) fn open() -> Option<Self> {
        // Servers that start at the same moment may want the same number, and all but one of them end.
        wait_for("an X server", || match Self::start() {
            Ok(started) => started.map(Some),
            Err(error) => {
                let is_ci = std::env::var_os("CI").is_some_and(|ci| ci == "true");
                assert!(!is_ci, "there is no Xvfb ({error}): scripts/setup.sh window");
                println!("skipped: there is no Xvfb ({error})");
                Some(None)
            }
        })
    }

    /// A server, or `None` if it has ended at once.
    fn start() -> std::io::Result<Option<Self>> {
        let folder = tempfile::tempdir()?;
        // Reset when its last client has gone, it would turn away one that comes at that moment.
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp", "-noreset", "-fbdir"])
            .arg(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number)?;
        let started = Self { server, display: format!(":{}", number.trim()), folder };
        Ok(number.trim().parse::<u32>().is_ok().then_some(started))
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Starts `specula view` in the folder.
    pub(super) fn view(&self, arguments: &[&str]) -> Window {
        let mut command = program();
        command.arg("view").args(arguments).current_dir(self.folder.path());
        command.env("DISPLAY", &self.display).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command.env("XDG_RUNTIME_DIR", self.folder.path()).env("SPECULA_CACHE_DIR", self.path("cache"));
        Window { child: command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap() }
    }

    /// Plays a recording of these events, one a line; without a model if that has no name.
    pub(super) fn play(&self, model: &str, options: &[&str], events: &[String]) -> Window {
        let lines: Vec<String> =
            events.iter().zip(0..).map(|(event, i)| format!(r#"{{"at_s":{i},"event":{event}}}"#)).collect();
        std::fs::write(self.path("events.jsonl"), lines.join("\n")).unwrap();
        let model = Some(model).filter(|model| !model.is_empty());
        self.view(&[model.as_slice(), &["--replay", "events.jsonl"], options].concat())
    }

    /// A model of one triangle and a light: a file beside it is the image of all its textures.
    pub(super) fn write_triangle(&self, name: &str, png: &[u8]) {
        // Positions, coordinates, normals and tangents.
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let (normal, tangent) = ([0.0_f32, 0.0, 1.0], [1.0_f32, 0.0, 0.0, 1.0]);
        let floats = positions.concat().into_iter().chain([0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        let floats = floats.chain([normal; 3].concat()).chain([tangent; 3].concat());
        let bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
        std::fs::write(self.path("corners.bin"), &bytes).unwrap();
        std::fs::write(self.path("image.png"), png).unwrap();
        let views = [(0, 36), (36, 24), (60, 36), (96, 48)]
            .map(|(offset, length)| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length }));
        let accessor =
            |view: usize, kind: &str| json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": kind });
        let mut positions = accessor(0, "VEC3");
        (positions["min"], positions["max"]) = (json!([0, 0, 0]), json!([1, 1, 0]));
        let attributes = json!({ "POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2, "TANGENT": 3 });
        let texture = json!({ "index": 0 });
        let material = json!({
            "pbrMetallicRoughness": { "baseColorTexture": texture, "metallicRoughnessTexture": texture },
            "normalTexture": texture, "occlusionTexture": texture, "emissiveTexture": texture,
        });
        let model = json!({
            "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0, 1] }],
            "nodes": [{ "mesh": 0 }, { "extensions": { "KHR_lights_punctual": { "light": 0 } } }],
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": 2.0 }] } },
            "meshes": [{ "primitives": [{ "attributes": attributes, "material": 0 }] }], "materials": [material],
            "textures": [{ "source": 0 }], "images": [{ "uri": "image.png" }],
            "accessors": [positions, accessor(1, "VEC2"), accessor(2, "VEC3"), accessor(3, "VEC4")],
            "bufferViews": views, "buffers": [{ "uri": "corners.bin", "byteLength": bytes.len() }],
        });
        std::fs::write(self.path(name), model.to_string()).unwrap();
    }

    /// Sends real input; the words are those of xdotool.
    pub(super) fn xdotool(&self, words: &[&str]) -> String {
        let output = Command::new("xdotool").args(words).env("DISPLAY", &self.display).output();
        let output = output.expect("tests of the viewer need xdotool: scripts/setup.sh window");
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }

    /// What the left upper part of the screen shows, as RGB.
    pub(super) fn pixels(&self, width: usize, height: usize) -> Vec<u8> {
        let dump = std::fs::read(self.path("Xvfb_screen0")).unwrap();
        let header = |index: usize| u32::from_be_bytes(dump[4 * index..4 * index + 4].try_into().unwrap()) as usize;
        // XWDFile.h: header size, bits a pixel, bytes a line, number of colours, which take 12 bytes each.
        assert_eq!(header(11), 32, "bits a pixel");
        let (start, stride) = (header(0) + 12 * header(19), header(12));
        let row = |y: usize| &dump[start + y * stride..start + y * stride + 4 * width];
        (0..height).flat_map(|y| row(y).chunks_exact(4).flat_map(|bgrx| [bgrx[2], bgrx[1], bgrx[0]])).collect()
    }

    /// The picture that `render` makes of a state in the folder.
    pub(super) fn render(&self, state: &str) -> image::RgbaImage {
        let mut command = program();
        command.args(["render", "--state", state, "-o", "rendered.png", "--quiet"]).current_dir(self.folder.path());
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        self.picture("rendered.png")
    }

    pub(super) fn picture(&self, name: &str) -> image::RgbaImage {
        image::open(self.path(name)).unwrap().to_rgba8()
    }

    pub(super) fn state(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(self.path(name)).unwrap()).unwrap()
    }

    /// Fails unless a saved picture shows something and is what `render` makes of its state, bit by bit.
    pub(super) fn assert_renders_again(&self, stem: &str) {
        let saved = self.picture(&format!("{stem}.png"));
        let first = *saved.get_pixel(0, 0);
        assert!(saved.pixels().any(|pixel| *pixel != first), "{stem}: the picture is blank");
        let rendered = self.render(&format!("{stem}.json"));
        assert_eq!(saved.dimensions(), rendered.dimensions());
        let differing = saved.pixels().zip(rendered.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "{stem}: pixels of the window that `render --state` makes otherwise");
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

impl Window {
    /// Waits until the program ends by itself, in silence.
    pub(super) fn end(mut self) {
        let status = wait_for("the end of the program", || self.child.try_wait().unwrap());
        let mut said = String::new();
        std::io::Read::read_to_string(self.child.stderr.as_mut().unwrap(), &mut said).unwrap();
        assert_eq!((status.code(), said.as_str()), (Some(0), ""));
    }

    /// Fails when the program has ended.
    pub(super) fn assert_runs(&mut self) {
        if let Some(status) = self.child.try_wait().unwrap() {
            let mut said = String::new();
            std::io::Read::read_to_string(self.child.stderr.as_mut().unwrap(), &mut said).unwrap();
            panic!("the program has ended, {status}: {said}");
        }
    }

    /// Kilobytes of memory that the program holds. Of Linux.
    pub(super) fn resident_kb(&self) -> u64 {
        let status = std::fs::read_to_string(Path::new("/proc").join(self.child.id().to_string()).join("status"));
        let status = status.unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
        line.trim().trim_end_matches(" kB").parse().unwrap()
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
