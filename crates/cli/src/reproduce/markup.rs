//! Captions and findings as HTML.

/// `text` with `<`, `>`, `&` and `"` escaped, what follows `_` and `^` lowered and raised, and what
/// stands between back quotes set as code.
///
/// Lowered and raised is a word, or what stands in braces or parentheses.
pub fn html(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for (index, part) in text.split('`').enumerate() {
        if index % 2 == 1 {
            element(&mut html, "code", part);
        } else {
            heights(&mut html, part);
        }
    }
    html
}

/// `text` with the characters escaped that mean something in HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn heights(html: &mut String, mut rest: &str) {
    while let Some(place) = rest.find(['_', '^']) {
        let name = if rest[place..].starts_with('_') { "sub" } else { "sup" };
        html.push_str(&escaped(&rest[..place]));
        let after = &rest[place + 1..];
        let within = |open, close| after.strip_prefix(open)?.split_once(close);
        let enclosed = within('{', '}').or_else(|| within('(', ')'));
        let (inside, remaining) = enclosed.unwrap_or_else(|| {
            after.split_at(after.find(|c: char| !c.is_alphanumeric()).unwrap_or(after.len()))
        });
        element(html, name, inside);
        rest = remaining;
    }
    html.push_str(&escaped(rest));
}

fn element(html: &mut String, name: &str, text: &str) {
    for part in ["<", name, ">", &escaped(text), "</", name, ">"] {
        html.push_str(part);
    }
}

#[cfg(test)]
mod tests {
    use super::html;

    #[test]
    fn words_are_lowered_and_raised() {
        assert_eq!(html("g_t/g_n < 2μ/α"), "g<sub>t</sub>/g<sub>n</sub> &lt; 2μ/α");
        assert_eq!(html("β^{−2/5}, ε_t^C"), "β<sup>−2/5</sup>, ε<sub>t</sub><sup>C</sup>");
        assert_eq!(html("h^(5/2) at w_0(t)"), "h<sup>5/2</sup> at w<sub>0</sub>(t)");
        assert_eq!(
            html("`collide --psi <P>` a_b"),
            "<code>collide --psi &lt;P&gt;</code> a<sub>b</sub>"
        );
        assert_eq!(html("w_final."), "w<sub>final</sub>.");
    }
}
