//! What all our plots share: the page, its colours, and text that stays text.

/// Dark violet over teal to yellow-green: even steps of lightness, told apart without red or green.
const RAMP: [[f64; 3]; 5] =
    [[68.0, 1.0, 84.0], [59.0, 82.0, 139.0], [33.0, 145.0, 140.0], [84.0, 190.0, 80.0], [214.0, 190.0, 20.0]];

/// A white page with what is drawn on it.
pub(super) fn document(width: f64, height: f64, body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{body}</svg>\n"
    )
}

/// Colour of the ramp at a place in [0, 1].
pub(super) fn ramp(t: f64) -> String {
    let position = t.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let index = (position as usize).min(RAMP.len() - 2);
    let f = position - index as f64;
    let channel = |i: usize| (RAMP[index][i] + (RAMP[index + 1][i] - RAMP[index][i]) * f).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}

/// Names come from files of strangers.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_break_out_of_their_text() {
        assert_eq!(escape("<a> & b"), "&lt;a&gt; &amp; b");
    }

    #[test]
    fn the_ramp_ends_where_it_should() {
        assert_eq!((ramp(0.0).as_str(), ramp(1.0).as_str()), ("#440154", "#d6be14"));
    }
}
