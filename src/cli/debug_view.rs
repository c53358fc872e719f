//! `--debug-view`.

use crate::scene::Channel;

/// The channel of a name on the command line.
pub(super) fn parse(name: &str) -> Result<Channel, String> {
    let names = || Channel::named().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
    Channel::by_name(name).ok_or_else(|| format!("expected one of {}", names()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_listed_where_one_is_unknown() {
        assert_eq!(parse("metallic"), Ok(Channel::by_name("metallic").unwrap()));
        assert!(parse("colour").unwrap_err().contains("base-color, metallic"));
    }
}
