//! A headless Chromium that is driven by the DevTools protocol over a pipe, as a person would: by its pointer and keys.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

/// What its window is, in pixels.
const WINDOW_PX: (u32, u32) = (1280, 900);

/// The browser's program, or `None` (printed) where there is none: `scripts/test.sh` installs it under CI=true where it may.
pub(crate) fn chromium() -> Option<PathBuf> {
    let named = std::env::var_os("SPECULA_CHROMIUM").map(PathBuf::from);
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()).collect();
    let found = folders.iter().flat_map(|folder| names.map(|name| folder.join(name))).find(|path| path.is_file());
    let program = named.or(found);
    if program.is_none() {
        println!("skipped: no Chromium; apt-get install chromium, or set SPECULA_CHROMIUM");
    }
    program
}

/// A page that is open in a browser of its own.
pub(crate) struct Browser {
    process: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
    session: Option<String>,
    next: u64,
    /// All that the browser said on its own, in order.
    pub(crate) events: Vec<Value>,
    profile: tempfile::TempDir,
}

impl Browser {
    /// Opens a file.
    pub(crate) fn open(program: &Path, page: &Path) -> Self {
        let profile = tempfile::tempdir().unwrap();
        // The browser reads requests from descriptor 3 and answers on 4. After two minutes it is stopped, so that no test hangs.
        let script = "exec timeout 120 \"$@\" 3<&0 4>&1 </dev/null >\"$LOG\" 2>&1";
        let window = format!("--window-size={},{}", WINDOW_PX.0, WINDOW_PX.1);
        let mut process = Command::new("sh")
            .args(["-c", script, "sh"])
            .arg(program)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--hide-scrollbars"])
            .args(["--no-first-run", "--force-color-profile=srgb", "--force-device-scale-factor=1", &window])
            .arg(format!("--user-data-dir={}", profile.path().join("profile").display()))
            .env("LOG", profile.path().join("log"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (requests, answers) = (process.stdin.take().unwrap(), BufReader::new(process.stdout.take().unwrap()));
        let (session, next, events) = (None, 1, Vec::new());
        let mut browser = Self { process, requests, answers, session, next, events, profile };
        browser.attach(page);
        browser
    }

    fn attach(&mut self, page: &Path) {
        let target = self.call("Target.createTarget", &json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        self.session = Some(self.call("Target.attachToTarget", &attach)["sessionId"].as_str().unwrap().to_owned());
        for domain in ["Page", "Runtime", "Network", "Log"] {
            self.call(&format!("{domain}.enable"), &json!({}));
        }
        let (width, height) = WINDOW_PX;
        let metrics = json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.call("Emulation.setDeviceMetricsOverride", &metrics);
        let answer = self.call("Page.navigate", &json!({"url": format!("file://{}", page.display())}));
        assert!(answer.get("errorText").is_none(), "{answer}");
        self.wait_for("location.protocol === 'file:' && document.readyState === 'complete'");
    }

    /// Calls a method and waits for its answer.
    pub(crate) fn call(&mut self, method: &str, parameters: &Value) -> Value {
        let id = self.next;
        self.next += 1;
        let mut request = json!({"id": id, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            request["sessionId"] = session.as_str().into();
        }
        self.requests.write_all(format!("{request}\0").as_bytes()).unwrap();
        loop {
            let mut bytes = Vec::new();
            self.answers.read_until(0, &mut bytes).unwrap();
            assert!(bytes.pop() == Some(0), "the browser has gone: {}", self.log());
            let message: Value = serde_json::from_slice(&bytes).unwrap();
            if message["id"] == id {
                assert!(message.get("error").is_none(), "{method}: {message}");
                return message["result"].clone();
            }
            self.events.push(message);
        }
    }

    fn log(&self) -> String {
        std::fs::read_to_string(self.profile.path().join("log")).unwrap_or_default()
    }

    /// The value of an expression in the page.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let answer = self.call("Runtime.evaluate", &json!({"expression": expression, "returnByValue": true}));
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    pub(crate) fn text(&mut self, expression: &str) -> String {
        self.value(expression).as_str().unwrap_or_default().to_owned()
    }

    pub(crate) fn wait_for(&mut self, expression: &str) {
        for _ in 0..200 {
            if self.value(expression) == true {
                return;
            }
            std::thread::sleep(Duration::from_millis(25));
        }
        panic!("never became true: {expression}");
    }

    /// A place in an element, in its width and height, as a place in the window; scrolls there.
    pub(crate) fn place(&mut self, selector: &str, x: f64, y: f64) -> (f64, f64) {
        let element = format!("document.querySelector({})", Value::from(selector));
        let rectangle = self.value(&format!(
            "{element}.scrollIntoView({{block: 'center'}}), (r => [r.x, r.y, r.width, r.height])({element}.getBoundingClientRect())"
        ));
        let [left, top, width, height] = [0, 1, 2, 3].map(|i| rectangle[i].as_f64().unwrap());
        assert!(width > 0.0 && height > 0.0, "{selector} is not to be seen");
        (left + x * width, top + y * height)
    }

    /// Presses, moves or releases the left button, or moves without it.
    pub(crate) fn pointer(&mut self, kind: &str, (x, y): (f64, f64)) {
        let button = if kind == "mouseMoved" { "none" } else { "left" };
        let event = json!({"type": kind, "x": x, "y": y, "button": button, "clickCount": 1});
        self.call("Input.dispatchMouseEvent", &event);
    }

    pub(crate) fn click(&mut self, selector: &str) {
        let at = self.place(selector, 0.5, 0.5);
        self.pointer("mousePressed", at);
        self.pointer("mouseReleased", at);
    }

    pub(crate) fn wheel(&mut self, (x, y): (f64, f64), down: f64) {
        let event = json!({"type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": down});
        self.call("Input.dispatchMouseEvent", &event);
    }

    pub(crate) fn key(&mut self, key: &str) {
        let mut event = json!({"type": "keyDown", "key": key});
        if key.len() == 1 {
            event["text"] = key.into();
        }
        self.call("Input.dispatchKeyEvent", &event);
        event["type"] = "keyUp".into();
        self.call("Input.dispatchKeyEvent", &event);
    }

    /// What the window shows; kept as `target/report-page/NAME.png`, for a person to look at.
    pub(crate) fn screenshot(&mut self, name: &str) -> image::RgbaImage {
        let answer = self.call("Page.captureScreenshot", &json!({"format": "png"}));
        let bytes = STANDARD.decode(answer["data"].as_str().unwrap()).unwrap();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/report-page");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(format!("{name}.png")), &bytes).unwrap();
        image::load_from_memory(&bytes).unwrap().to_rgba8()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Without its pipe the browser ends, and its guard with it.
        let _ = self.requests.write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        let _ = self.process.wait();
    }
}
