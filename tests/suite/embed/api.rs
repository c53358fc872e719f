//! The surface of the embedding API: it changes on purpose or not at all.

use std::path::Path;

const LIST: &str = "tests/goldens/embedding-api.txt";
const FILES: [&str; 13] = [
    "src/embed/environment.rs",
    "src/embed/mod.rs",
    "src/embed/pick.rs",
    "src/embed/requirements.rs",
    "src/embed/scene.rs",
    "src/gpu/lost.rs",
    "src/renderer.rs",
    "src/renderer/error.rs",
    "src/renderer/host.rs",
    "src/renderer/lifetime.rs",
    "src/renderer/paint.rs",
    "src/renderer/pass_format.rs",
    "src/renderer/pick.rs",
];

/// Every public declaration of a file, without bodies and comments, one a line.
fn declarations(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut lines = text.lines().take_while(|line| *line != "#[cfg(test)]");
    while let Some(line) = lines.next() {
        let is_variant = line.starts_with("    #[error(");
        if !is_variant && !line.trim_start().starts_with("pub ") {
            continue;
        }
        let mut declaration = if is_variant { String::new() } else { line.trim().to_owned() };
        let is_complete = |text: &str| text.ends_with(['{', ';', ',']) && !text.ends_with("(,") && balanced(text);
        while !is_complete(&declaration) {
            let Some(next) = lines.next() else { break };
            declaration = format!("{declaration} {}", next.trim());
        }
        found.push(declaration.trim_end_matches(['{', ';', ',', ' ']).trim().to_owned());
    }
    found
}

/// Whether all brackets are closed, a body's apart.
fn balanced(text: &str) -> bool {
    let inside = text.trim_end_matches('{');
    let count = |c| inside.matches(c).count();
    count('(') == count(')') && count('[') == count(']') && count('{') == count('}')
}

#[test]
fn the_embedding_api_is_the_one_that_is_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut actual = String::new();
    for file in FILES {
        let text = std::fs::read_to_string(root.join(file)).unwrap();
        let declared = declarations(&text);
        assert!(!declared.is_empty(), "{file} declares nothing: is the search broken?");
        actual += &format!("{file}\n");
        declared.iter().for_each(|declaration| actual += &format!("    {declaration}\n"));
    }
    if std::env::var_os("SPECULA_BLESS").is_some() {
        std::fs::write(root.join(LIST), &actual).unwrap();
    }
    let expected = std::fs::read_to_string(root.join(LIST)).unwrap_or_default();
    let differing = actual.lines().zip(expected.lines()).find(|(actual, expected)| actual != expected);
    assert!(
        actual == expected,
        "the API has changed, first at {differing:?}; if that is right: SPECULA_BLESS=1 cargo test embedding_api"
    );
}
