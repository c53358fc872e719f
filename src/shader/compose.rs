//! `#import` with once-semantics, slots, and errors that name the original file and line.

use super::sources::ShaderSources;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// What fills a slot: a file under `shaders/`, or generated text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Slot {
    File(&'static str),
    Text(String),
}

/// The slots of one module, by name.
pub type Slots = BTreeMap<&'static str, Slot>;

/// WGSL ready for the compiler, with the origin of each of its lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Composed {
    pub text: String,
    /// For each line of `text`: the file (or `<slot>`) and the line number there, from 1.
    origins: Vec<(String, usize)>,
    /// Whether files of it may be others than those that are built in.
    is_changed: bool,
}

/// Why a module could not be made. A fault of this crate, not of its input.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ShaderError {
    #[error("{file}:{line}: imports {target}, which does not exist")]
    UnknownImport { file: String, line: usize, target: String },
    #[error("{file}:{line}: imports {target}, which imports it in turn")]
    CyclicImport { file: String, line: usize, target: String },
    #[error("{file}:{line}: cannot read `{text}` as an import")]
    BadImport { file: String, line: usize, text: String },
    #[error("{file}:{line}: {message}")]
    Wgsl { file: String, line: usize, message: String },
}

/// Resolves all imports of the file `root`. Every file and slot appears once, before its first importer.
pub fn compose(sources: &ShaderSources, root: &str, slots: &Slots) -> Result<Composed, ShaderError> {
    let text = sources.get(root).ok_or_else(|| ShaderError::UnknownImport {
        file: "(root)".into(),
        line: 0,
        target: root.into(),
    })?;
    let mut composer = Composer::new(sources, slots);
    composer.append(root, text)?;
    Ok(Composed { text: composer.text, origins: composer.origins, is_changed: sources.are_changed() })
}

struct Composer<'a> {
    sources: &'a ShaderSources,
    slots: &'a Slots,
    done: HashSet<String>,
    open: Vec<String>,
    text: String,
    origins: Vec<(String, usize)>,
}

impl<'a> Composer<'a> {
    fn new(sources: &'a ShaderSources, slots: &'a Slots) -> Self {
        Self { sources, slots, done: HashSet::new(), open: Vec::new(), text: String::new(), origins: Vec::new() }
    }

    fn append(&mut self, name: &str, text: &str) -> Result<(), ShaderError> {
        self.open.push(name.to_owned());
        // Imports may stand anywhere, so they are resolved before the file's own lines are written.
        for (index, line) in text.lines().enumerate() {
            if line.trim_start().starts_with("#import") {
                self.import(name, index + 1, line)?;
            }
        }
        for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("#import")) {
            self.text.push_str(line);
            self.text.push('\n');
            self.origins.push((name.to_owned(), index + 1));
        }
        self.open.pop();
        self.done.insert(name.to_owned());
        Ok(())
    }

    fn import(&mut self, file: &str, line: usize, directive: &str) -> Result<(), ShaderError> {
        let argument = directive.trim_start().trim_start_matches("#import").trim();
        let (name, text) = self.resolve(argument, file, line)?;
        if self.open.contains(&name) {
            return Err(ShaderError::CyclicImport { file: file.into(), line, target: name });
        }
        if self.done.contains(&name) { Ok(()) } else { self.append(&name, &text) }
    }

    /// The name and the text behind `"path"` or `<slot>`.
    fn resolve(&self, argument: &str, file: &str, line: usize) -> Result<(String, String), ShaderError> {
        let unknown = |target: &str| ShaderError::UnknownImport { file: file.into(), line, target: target.into() };
        if let Some(path) = argument.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
            return self.file(path).ok_or_else(|| unknown(path));
        }
        if let Some(slot) = argument.strip_prefix('<').and_then(|rest| rest.strip_suffix('>')) {
            return match self.slots.get(slot).ok_or_else(|| unknown(argument))? {
                Slot::File(path) => self.file(path).ok_or_else(|| unknown(path)),
                Slot::Text(text) => Ok((argument.to_owned(), text.clone())),
            };
        }
        Err(ShaderError::BadImport { file: file.into(), line, text: argument.into() })
    }

    fn file(&self, path: &str) -> Option<(String, String)> {
        Some((path.to_owned(), self.sources.get(path)?.to_owned()))
    }
}

impl Composed {
    /// The file or `<slot>` that line `line` of the text came from, and its number there; both count from 1.
    pub fn origin(&self, line: usize) -> Option<(&str, usize)> {
        let (file, line) = self.origins.get(line.checked_sub(1)?)?;
        Some((file, *line))
    }

    /// The files and `<slot>`s that the text consists of.
    pub fn files(&self) -> BTreeSet<&str> {
        self.origins.iter().map(|(file, _)| file.as_str()).collect()
    }

    /// Parses the text; an error names the file and line that it came from.
    pub fn parse(&self) -> Result<naga::Module, ShaderError> {
        let module = naga::front::wgsl::parse_str(&self.text).map_err(|error| {
            let message = error.emit_to_string(&self.text);
            self.error_at(error.location(&self.text), message.lines().next().unwrap_or_default().to_owned())
        })?;
        // wgpu does the same, and tells no line: whoever works on a shader wants to know it.
        if self.is_changed {
            self.validate(&module)?;
        }
        Ok(module)
    }

    fn validate(&self, module: &naga::Module) -> Result<(), ShaderError> {
        let (flags, capabilities) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        let valid = naga::valid::Validator::new(flags, capabilities).validate(module);
        valid.map(drop).map_err(|error| {
            let reasons =
                std::iter::successors(Some(error.as_inner() as &dyn std::error::Error), |error| error.source());
            let message = reasons.map(ToString::to_string).collect::<Vec<_>>().join(": ");
            // Around the fault there may be the function, and what that is in.
            let span = error
                .spans()
                .map(|(span, _)| span)
                .min_by_key(|span| span.to_range().map_or(usize::MAX, |at| at.len()));
            self.error_at(span.map(|span| span.location(&self.text)), message)
        })
    }

    fn error_at(&self, location: Option<naga::SourceLocation>, message: String) -> ShaderError {
        let at = location.map_or(0, |location| location.line_number as usize);
        let (file, line) = self.origin(at).unwrap_or(("(composed)", at));
        ShaderError::Wgsl { file: file.to_owned(), line, message }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text_slots(slots: &[(&'static str, &str)]) -> Slots {
        slots.iter().map(|(name, text)| (*name, Slot::Text((*text).to_owned()))).collect()
    }

    #[test]
    fn a_file_is_imported_once_and_before_its_importer() {
        let slots = text_slots(&[("tone_map", "fn tone_map(x: vec3f) -> vec3f { return x; }"), ("types", "")]);
        let slots: Slots = slots.into_iter().chain([("encode", Slot::File("color/encode_srgb.wgsl"))]).collect();
        let composed = compose(&ShaderSources::default(), "color/encode_srgb.wgsl", &slots).unwrap();
        assert_eq!(composed.text.matches("fn srgb_from_linear").count(), 1);
        assert!(composed.text.find("fn srgb_from_linear") < composed.text.find("fn encode"));
    }

    #[test]
    fn unknown_and_malformed_imports_are_errors_with_their_line() {
        let slots = text_slots(&[("material", "\n#import \"no/such.wgsl\"")]);
        let sources = ShaderSources::default();
        let composer = |text: &str| Composer::new(&sources, &slots).append("here.wgsl", text).unwrap_err().to_string();
        assert_eq!(composer("#import <material>"), "<material>:2: imports no/such.wgsl, which does not exist");
        assert_eq!(composer("\n\n#import <nothing>"), "here.wgsl:3: imports <nothing>, which does not exist");
        assert_eq!(composer("#import bare"), "here.wgsl:1: cannot read `bare` as an import");
    }

    #[test]
    fn a_cycle_is_an_error() {
        let slots = text_slots(&[("a", "#import <b>"), ("b", "#import <a>")]);
        let sources = ShaderSources::default();
        let error = Composer::new(&sources, &slots).append("root.wgsl", "#import <a>").unwrap_err();
        assert!(matches!(error, ShaderError::CyclicImport { .. }), "{error}");
    }

    #[test]
    fn a_replaced_file_is_what_importers_get() {
        let mut sources = ShaderSources::default();
        sources.insert("color/srgb.wgsl", "fn srgb_from_linear(linear: vec3f) -> vec3f { return linear; }".into());
        let composed = compose(&sources, "color/encode_srgb.wgsl", &Slots::new()).unwrap();
        assert!(composed.text.contains("return linear;") && !composed.text.contains("1.055"));
        assert_eq!(composed.files(), BTreeSet::from(["color/encode_srgb.wgsl", "color/srgb.wgsl"]));
        assert_eq!(composed.origin(1), Some(("color/srgb.wgsl", 1)));
    }

    #[test]
    fn what_is_not_valid_in_a_replaced_file_has_its_line_too() {
        let mut sources = ShaderSources::default();
        let text = "fn srgb_from_linear(linear: vec3f) -> vec3f {\n    let x = linear.x;\n    return x;\n}";
        sources.insert("color/srgb.wgsl", text.into());
        let composed = compose(&sources, "color/encode_srgb.wgsl", &Slots::new()).unwrap();
        let error = composed.parse().unwrap_err().to_string();
        assert!(error.starts_with("color/srgb.wgsl:3: ") || error.starts_with("color/srgb.wgsl:2: "), "{error}");
        assert!(error.contains("srgb_from_linear") && !error.contains('\n'), "{error}");
    }

    #[test]
    fn an_error_in_wgsl_names_the_original_line() {
        let types = "struct A { x: f32 }\nfn broken() -> f32 { return nonsense; }";
        let slots = text_slots(&[("types", types), ("backdrop", ""), ("target", "")]);
        let composed = compose(&ShaderSources::default(), "pass/background.wgsl", &slots).unwrap();
        let error = composed.parse().unwrap_err().to_string();
        assert!(error.starts_with("<types>:2: "), "{error}");
    }
}
