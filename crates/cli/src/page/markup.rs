//! Texts with markup as HTML.

use std::fmt::Write;

use askama::filters::{Html, escape};
use stickslip_figure::markup::{Piece, PieceStyle, pieces};

/// `text` as HTML, with subscripts, superscripts and code set as such.
pub fn markup(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for Piece { text, style } in pieces(text) {
        let tag = match style {
            PieceStyle::Plain => None,
            PieceStyle::Lowered => Some("sub"),
            PieceStyle::Raised => Some("sup"),
            PieceStyle::Code => Some("code"),
        };
        let text = escaped(text);
        // Writing to a string cannot fail.
        let _ = match tag {
            Some(tag) => write!(html, "<{tag}>{text}</{tag}>"),
            None => write!(html, "{}", with_powers(&text)),
        };
    }
    html
}

/// `text` with numbers such as 2e-13 as 2×10⁻¹³, which is the notation of tables and pictures.
fn with_powers(text: &str) -> String {
    let mut parts = text.split('e');
    let mut html = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (sign, digits) = part.strip_prefix('-').map_or(("", part), |digits| ("−", digits));
        let end = digits.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(digits.len());
        let (exponent, rest) = digits.split_at(end);
        let is_number = html.ends_with(|letter: char| letter.is_ascii_digit());
        // Writing to a string cannot fail.
        let _ = if is_number && !exponent.is_empty() {
            write!(html, "×10<sup>{sign}{exponent}</sup>{rest}")
        } else {
            write!(html, "e{part}")
        };
    }
    html
}

/// `text` with the characters escaped that mean something in HTML.
fn escaped(text: &str) -> String {
    // Escaping cannot fail.
    escape(text, Html).map(|escaped| escaped.to_string()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::markup;

    #[test]
    fn markup_is_set_and_everything_else_escaped() {
        assert_eq!(markup("g_t/g_n < 2μ/α"), "g<sub>t</sub>/g<sub>n</sub> &#60; 2μ/α");
        assert_eq!(markup("β^{−2/5}, ε_t^C"), "β<sup>−2/5</sup>, ε<sub>t</sub><sup>C</sup>");
        assert_eq!(
            markup("`collide --psi <P>` a_b"),
            "<code>collide --psi &#60;P&#62;</code> a<sub>b</sub>"
        );
        assert_eq!(
            markup("within 8.3e-13, to 1e8 steps; `1e-3`; e5 eels, 2e"),
            "within 8.3×10<sup>−13</sup>, to 1×10<sup>8</sup> steps; <code>1e-3</code>; e5 eels, 2e"
        );
    }
}
