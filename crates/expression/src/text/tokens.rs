//! Words and signs.

use super::TextError;

/// A word, a number or a sign.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Number(f64),
    Name(&'a str),
    /// What stands between quotation marks.
    Label(&'a str),
    Sign(&'static str),
    /// The end of a line, or of the text.
    End,
}

/// A token with its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spanned<'a> {
    pub(super) token: Token<'a>,
    pub(super) offset: usize,
    pub(super) length: usize,
}

/// The longer ones first.
const SIGNS: [&str; 24] = [
    ":=", "->", "<=", ">=", "==", "!=", "**", "+", "-", "*", "/", "^", "(", ")", ",", ":", "=",
    "'", "<", ">", "%", "−", "·", "′",
];

/// Divides a text into tokens. Comments are left out, and lines do not end inside parentheses.
pub(super) fn tokens(text: &str) -> Result<Vec<Spanned<'_>>, TextError> {
    let mut tokens: Vec<Spanned<'_>> = Vec::new();
    let mut depth = 0_usize;
    let mut offset = 0;
    while let Some(first) = text[offset..].chars().next() {
        let rest = &text[offset..];
        let (token, length) = match first {
            '\n' => {
                if depth == 0 {
                    tokens.push(Spanned { token: Token::End, offset, length: 1 });
                }
                offset += 1;
                continue;
            }
            _ if first.is_whitespace() || first == '\u{feff}' => {
                offset += first.len_utf8();
                continue;
            }
            '#' => {
                offset += rest.find('\n').unwrap_or(rest.len());
                continue;
            }
            '"' => label(text, offset)?,
            _ if first.is_ascii_digit() || first == '.' => number(text, offset)?,
            _ if first.is_alphabetic() || first == '_' => {
                let within = |c: char| c.is_alphanumeric() || c == '_';
                let length = rest.find(|c| !within(c)).unwrap_or(rest.len());
                (Token::Name(&rest[..length]), length)
            }
            _ => {
                let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) else {
                    let message = format!("the character {first:?} has no meaning here");
                    return Err(TextError::at(text, offset, message));
                };
                (Token::Sign(plain(sign)), sign.len())
            }
        };
        match token {
            Token::Sign("(") => depth += 1,
            Token::Sign(")") => depth = depth.saturating_sub(1),
            _ => {}
        }
        tokens.push(Spanned { token, offset, length });
        offset += length;
    }
    tokens.push(Spanned { token: Token::End, offset: text.len(), length: 0 });
    Ok(tokens)
}

/// The sign as it is on a keyboard.
fn plain(sign: &'static str) -> &'static str {
    match sign {
        "−" => "-",
        "·" => "*",
        "′" => "'",
        other => other,
    }
}

fn label(text: &str, offset: usize) -> Result<(Token<'_>, usize), TextError> {
    let rest = &text[offset + 1..];
    match rest.find(['"', '\n']) {
        Some(end) if rest[end..].starts_with('"') => Ok((Token::Label(&rest[..end]), end + 2)),
        _ => Err(TextError::at(text, offset, "the label does not end; expected \"".to_owned())),
    }
}

/// A number: digits with at most one point, and perhaps an exponent.
fn number(text: &str, offset: usize) -> Result<(Token<'_>, usize), TextError> {
    let bytes = &text.as_bytes()[offset..];
    let digits = |from: usize| bytes[from..].iter().take_while(|it| it.is_ascii_digit()).count();
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    let written = &text[offset..offset + length];
    let joined = text[offset + length..].chars().next();
    if joined.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '.') {
        let message =
            format!("`{written}` is followed by a letter; expected an operator, as in 2*x");
        return Err(TextError::at(text, offset, message));
    }
    match written.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((Token::Number(value), length)),
        Ok(_) => {
            let message = format!("{written} is too large; expected a number up to 1.7e308");
            Err(TextError::at(text, offset, message))
        }
        Err(_) => Err(TextError::at(text, offset, format!("`{written}` is not a number"))),
    }
}
