//! The markup of all texts: subscripts, superscripts and code.
//!
//! A subscript follows `_` and a superscript follows `^`. Either is a word of letters and digits,
//! or a text in braces or parentheses, which are not shown. Code stands between back quotes.
//! Captions on a page and words in a picture use the same markup.

use std::fmt::{self, Write};

use super::shape::Px;

/// A piece of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece<'a> {
    /// The characters of the piece.
    pub text: &'a str,
    /// How the characters are set.
    pub style: PieceStyle,
}

/// How a piece of a text is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceStyle {
    /// On the line.
    Plain,
    /// As a subscript.
    Lowered,
    /// As a superscript.
    Raised,
    /// As code.
    Code,
}

/// The pieces of `markup`, none of them empty.
///
/// ```
/// use stickslip_figure::markup::{PieceStyle, pieces};
///
/// let [g, n, power] = pieces("g_n^{6/5}")[..] else { panic!("three pieces") };
/// assert_eq!((g.text, n.text, power.text), ("g", "n", "6/5"));
/// assert_eq!((n.style, power.style), (PieceStyle::Lowered, PieceStyle::Raised));
/// ```
pub fn pieces(markup: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    for (index, part) in markup.split('`').enumerate() {
        if index % 2 == 1 {
            pieces.push(Piece { text: part, style: PieceStyle::Code });
        } else {
            heights(&mut pieces, part);
        }
    }
    pieces.retain(|piece| !piece.text.is_empty());
    pieces
}

/// The characters of `markup` without its marks.
pub fn plain(markup: &str) -> String {
    pieces(markup).iter().map(|piece| piece.text).collect()
}

/// Adds the pieces of `rest`, which has no code.
fn heights<'a>(pieces: &mut Vec<Piece<'a>>, mut rest: &'a str) {
    while let Some(place) = rest.find(['_', '^']) {
        let lowered = rest[place..].starts_with('_');
        let style = if lowered { PieceStyle::Lowered } else { PieceStyle::Raised };
        pieces.push(Piece { text: &rest[..place], style: PieceStyle::Plain });
        let after = &rest[place + 1..];
        let within = |open, close| after.strip_prefix(open)?.split_once(close);
        let enclosed = within('{', '}').or_else(|| within('(', ')'));
        let (text, remaining) = enclosed.unwrap_or_else(|| {
            after.split_at(after.find(|c: char| !c.is_alphanumeric()).unwrap_or(after.len()))
        });
        pieces.push(Piece { text, style });
        rest = remaining;
    }
    pieces.push(Piece { text: rest, style: PieceStyle::Plain });
}

/// `markup` as SVG, for words of font size `size`.
pub(crate) fn spans(markup: &str, size: f64) -> String {
    let small = 0.72 * size;
    let mut spans = String::new();
    let mut height = 0.0;
    for piece in pieces(markup) {
        let (target, size) = match piece.style {
            PieceStyle::Plain | PieceStyle::Code => (0.0, size),
            PieceStyle::Lowered => (0.22 * size, small),
            PieceStyle::Raised => (-0.36 * size, small),
        };
        let text = escaped(piece.text);
        if target == height && target == 0.0 {
            spans.push_str(&text);
        } else {
            let shift = Px(target - height);
            let size = Px(size);
            append(
                &mut spans,
                format_args!(r#"<tspan dy="{shift}" font-size="{size}">{text}</tspan>"#),
            );
        }
        height = target;
    }
    spans
}

/// `text` with escapes for the characters that have a meaning in XML.
pub(crate) fn escaped(text: &str) -> String {
    // XML has no control characters.
    let allowed = |c: &char| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    let text: String = text.chars().filter(allowed).collect();
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// Appends formatted text to a string.
pub(crate) fn append(to: &mut String, text: fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = to.write_fmt(text);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_pieces() {
        assert_eq!(plain("F_t/μ in m β^{2/5} g_n^{6/5}"), "Ft/μ in m β2/5 gn6/5");
        assert_eq!(escaped(&plain("a<b&c_")), "a&lt;b&amp;c");
        assert_eq!(escaped("a\u{0}\u{1b}b\u{ffff}"), "ab");
        let spans = spans("g_n^{−1}x", 10.0);
        let expected = r#"g<tspan dy="2.2" font-size="7.2">n</tspan><tspan dy="-5.8" font-size="7.2">−1</tspan><tspan dy="3.6" font-size="10">x</tspan>"#;
        assert_eq!(spans, expected);
    }

    #[test]
    fn words_and_enclosed_texts_are_lowered_and_raised() {
        let set = |markup| {
            let piece = |piece: Piece<'_>| match piece.style {
                PieceStyle::Plain => piece.text.to_owned(),
                PieceStyle::Lowered => format!("[{}]", piece.text),
                PieceStyle::Raised => format!("⟨{}⟩", piece.text),
                PieceStyle::Code => format!("|{}|", piece.text),
            };
            pieces(markup).into_iter().map(piece).collect::<String>()
        };
        assert_eq!(set("g_t/g_n < 2μ/α"), "g[t]/g[n] < 2μ/α");
        assert_eq!(set("β^{−2/5}, ε_t^C"), "β⟨−2/5⟩, ε[t]⟨C⟩");
        assert_eq!(set("h^(5/2) at w_0(t)"), "h⟨5/2⟩ at w[0](t)");
        assert_eq!(set("`collide --psi <P>` a_b"), "|collide --psi <P>| a[b]");
        assert_eq!(set("w_final."), "w[final].");
    }
}
