//! Words: lowered and raised parts, and numbers as people write them.

use std::fmt::{self, Write};

/// A piece of a text at one height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece<'a> {
    text: &'a str,
    height: Height,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Height {
    Line,
    Lowered,
    Raised,
}

/// The markup of [`super::svg::Words`] as SVG.
pub fn spans(markup: &str, size: f64) -> String {
    let small = 0.72 * size;
    let mut spans = String::new();
    let mut height = 0.0;
    for piece in pieces(markup) {
        let (target, size) = match piece.height {
            Height::Line => (0.0, size),
            Height::Lowered => (0.22 * size, small),
            Height::Raised => (-0.36 * size, small),
        };
        let text = escape(piece.text);
        if target == height && piece.height == Height::Line {
            spans.push_str(&text);
        } else {
            let shift = super::svg::Px(target - height);
            append(
                &mut spans,
                format_args!(
                    r#"<tspan dy="{shift}" font-size="{}">{text}</tspan>"#,
                    super::svg::Px(size)
                ),
            );
        }
        height = target;
    }
    spans
}

/// The markup without heights.
pub fn plain(markup: &str) -> String {
    escape(&pieces(markup).iter().map(|piece| piece.text).collect::<String>())
}

/// `value` with at most `digits` significant digits, as markup.
pub fn number(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if value == 0.0 || (-4..6).contains(&exponent) {
        // Reading the rounded number back drops trailing zeros.
        return minus(&rounded.parse().unwrap_or(value).to_string());
    }
    let mantissa: f64 = mantissa.parse().unwrap_or(value);
    minus(&format!("{mantissa}×10^{{{exponent}}}"))
}

/// `number` with the sign that is as wide as a plus.
pub fn minus(number: &str) -> String {
    number.replace('-', "−")
}

/// Appends to a string.
pub fn append(to: &mut String, text: fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = to.write_fmt(text);
}

fn pieces(markup: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut rest = markup;
    while let Some(place) = rest.find(['_', '^']) {
        let height = if rest[place..].starts_with('_') { Height::Lowered } else { Height::Raised };
        pieces.push(Piece { text: &rest[..place], height: Height::Line });
        let after = &rest[place + 1..];
        let braced = after.strip_prefix('{').and_then(|inner| inner.split_once('}'));
        let (text, remaining) = braced
            .unwrap_or_else(|| after.split_at(after.chars().next().map_or(0, char::len_utf8)));
        pieces.push(Piece { text, height });
        rest = remaining;
    }
    pieces.push(Piece { text: rest, height: Height::Line });
    pieces.retain(|piece| !piece.text.is_empty());
    pieces
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_pieces() {
        assert_eq!(plain("F_t/μ in m β^{2/5} g_n^{6/5}"), "Ft/μ in m β2/5 gn6/5");
        assert_eq!(plain("a<b&c_"), "a&lt;b&amp;c");
        let spans = spans("g_n^{−1}x", 10.0);
        let expected = r#"g<tspan dy="2.2" font-size="7.2">n</tspan><tspan dy="-5.8" font-size="7.2">−1</tspan><tspan dy="3.6" font-size="10">x</tspan>"#;
        assert_eq!(spans, expected);
    }

    #[test]
    fn numbers_as_people_write_them() {
        for (value, expected) in [
            (63.0, "63"),
            (0.5, "0.5"),
            (-0.041652207, "−0.04165"),
            (0.9999999999998, "1"),
            (1e4, "10000"),
            (1e-300, "1×10^{−300}"),
            (-2.5e7, "−2.5×10^{7}"),
            (0.0, "0"),
        ] {
            assert_eq!(number(value, 4), expected);
        }
    }
}
