//! Where the user's caches are.

use std::ffi::OsString;
use std::path::PathBuf;

/// The folder of this program's caches on `system` (as [`std::env::consts::OS`] names it) with these environment
/// variables.
pub(super) fn of_user(system: &str, variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let path = |name| variable(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    // The XDG specification has relative paths ignored; a home that is relative is as wrong.
    let absolute = |name| path(name).filter(|path| path.is_absolute());
    path("SPECULA_CACHE_DIR").or_else(|| match system {
        "windows" => Some(absolute("LOCALAPPDATA")?.join("specula").join("cache")),
        "macos" => Some(absolute("HOME")?.join("Library/Caches/specula")),
        _ => {
            let caches = absolute("XDG_CACHE_HOME").or_else(|| Some(absolute("HOME")?.join(".cache")));
            Some(caches?.join("specula"))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_name_the_folder() {
        // Paths that are absolute where the test runs.
        let root = if cfg!(windows) { "C:/u" } else { "/u" };
        type Variables = &'static [(&'static str, &'static str)];
        let cases: [(&str, Variables, Option<&str>); 9] = [
            ("linux", &[("HOME", "")], Some("/.cache/specula")),
            ("linux", &[("HOME", ""), ("XDG_CACHE_HOME", "/x")], Some("/x/specula")),
            ("freebsd", &[("HOME", "")], Some("/.cache/specula")),
            ("macos", &[("HOME", ""), ("XDG_CACHE_HOME", "/x")], Some("/Library/Caches/specula")),
            ("windows", &[("LOCALAPPDATA", "/l"), ("HOME", "")], Some("/l/specula/cache")),
            ("windows", &[("HOME", "")], None),
            ("linux", &[], None),
            ("linux", &[("HOME", ""), ("SPECULA_CACHE_DIR", "/own")], Some("/own")),
            ("windows", &[("SPECULA_CACHE_DIR", "/own")], Some("/own")),
        ];
        for (system, variables, expected) in cases {
            let variable = |name: &str| {
                let (_, value) = variables.iter().find(|(known, _)| *known == name)?;
                Some(OsString::from(format!("{root}{value}")))
            };
            let expected = expected.map(|path| PathBuf::from(format!("{root}{path}")));
            assert_eq!(of_user(system, variable), expected, "{system} {variables:?}");
        }
    }

    #[test]
    fn empty_and_relative_variables_count_as_unset() {
        let variables = |list: &'static [(&str, &str)]| {
            move |name: &str| list.iter().find(|(known, _)| *known == name).map(|(_, value)| OsString::from(value))
        };
        assert_eq!(of_user("linux", variables(&[("SPECULA_CACHE_DIR", ""), ("XDG_CACHE_HOME", "")])), None);
        assert_eq!(of_user("linux", variables(&[("XDG_CACHE_HOME", "caches")])), None);
        assert_eq!(of_user("linux", variables(&[("SPECULA_CACHE_DIR", "here")])), Some(PathBuf::from("here")));
    }
}
