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
            None => write!(html, "{text}"),
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
    }
}
