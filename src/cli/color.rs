//! Colours as people write them.

/// Red, green and blue of `#rrggbb`.
pub(super) fn srgb8_from_hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    // A sign would pass for a digit.
    let digits = digits.bytes().all(|byte| byte.is_ascii_hexdigit()).then_some(digits)?;
    let [_, r, g, b] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
    Some([r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_colours_parse() {
        assert_eq!(srgb8_from_hex("#ff8001"), Some([255, 128, 1]));
        for bad in ["ff8001", "#ff800", "#ff80011", "#gg8001", "#+f8001", "#é8001", ""] {
            assert_eq!(srgb8_from_hex(bad), None, "{bad}");
        }
    }
}
