//! Which files a model consists of.

use super::error::{Fault, ImportError, Notes};
use super::limits::{Budget, Limits};
use super::resources::Resources;
use super::{container, document, read_file};
use std::path::{Path, PathBuf};

/// The file of a model and those that it refers to as buffers or images, each once, in the order of the document.
///
/// # Errors
/// When the model cannot be read, or refers to what an import would refuse.
pub fn model_files(path: &Path) -> Result<Vec<PathBuf>, ImportError> {
    let list = || -> Result<Vec<PathBuf>, Fault> {
        let limit = Limits::default().decoded_bytes;
        let bytes = read_file(path, limit)?;
        let mut notes = Notes::default();
        let container = container::split(&bytes, &mut notes)?;
        let root = document::parse(container.json, container.json_offset, &mut notes)?.root;
        let budget = Budget::new(limit);
        let resources = Resources::new(path.parent(), &budget);
        let buffers = root.buffers.iter().enumerate().map(|(i, buffer)| (buffer.uri.as_deref(), ("buffers", i)));
        let images = root.images.iter().enumerate().map(|(i, image)| (image.uri.as_deref(), ("images", i)));
        let mut files = vec![path.to_owned()];
        for (uri, (kind, index)) in buffers.chain(images) {
            let Some(uri) = uri else { continue };
            let file = resources.file(uri, &format!("/{kind}/{index}/uri"))?;
            files.extend(file.filter(|file| !files.contains(file)));
        }
        Ok(files)
    };
    list().map_err(|fault| fault.in_file(&path.display().to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_is_named_once() {
        let folder = tempfile::tempdir().unwrap();
        let model = folder.path().join("model.gltf");
        let json = r#"{"asset": {"version": "2.0"},
            "buffers": [{"uri": "a%20b.bin", "byteLength": 1}, {"uri": "data:;base64,AA==", "byteLength": 1}],
            "images": [{"uri": "t.png"}, {"uri": "t.png"}]}"#;
        std::fs::write(&model, json).unwrap();
        assert!(model_files(&model).unwrap_err().to_string().contains("/buffers/0/uri"));
        for name in ["a b.bin", "t.png"] {
            std::fs::write(folder.path().join(name), [0]).unwrap();
        }
        let files = model_files(&model).unwrap();
        let names: Vec<_> = files.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(names, ["model.gltf", "a b.bin", "t.png"]);
    }
}
