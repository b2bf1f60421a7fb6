//! A text in its usual form: blanks and indentation, and nothing else.

use std::fmt::Write;

use super::TextError;
use super::tokens::{Spanned, Token, tokens};

/// The text of a system with usual blanks and indentation. Comments, empty lines and the order of
/// statements stay, and what it means stays too.
///
/// ```
/// let text = "state x=1   # a height\nmode fall\nx'=-2*(x-1)^2\nwhen x<0->end\n";
/// let formatted = stickslip_expression::format(text)?;
/// assert_eq!(
///     formatted,
///     "state x = 1  # a height\nmode fall\n  x' = -2*(x - 1)^2\n  when x < 0 -> end\n"
/// );
/// # Ok::<(), stickslip_expression::TextError>(())
/// ```
///
/// # Errors
/// [`TextError`] if the text contains what is no word or sign of the language.
pub fn format(text: &str) -> Result<String, TextError> {
    let tokens = tokens(text)?;
    let mut lines: Vec<(String, Option<&str>)> = Vec::new();
    let (mut in_mode, mut in_rule, mut rest) = (false, false, &tokens[..]);
    let (mut from, mut empty) = (0, 0);
    for line in text.split_inclusive('\n') {
        let to = from + line.len();
        let count = rest.iter().take_while(|it| it.offset < to).count();
        let (here, later) = rest.split_at(count);
        rest = later;
        let words: Vec<&Spanned<'_>> = here.iter().filter(|it| it.token != Token::End).collect();
        let comment = comment(line, from, words.last().copied());
        if words.is_empty() && comment.is_none() {
            empty += 1;
            from = to;
            continue;
        }
        // Several empty lines are one.
        if empty > 0 && !lines.is_empty() {
            lines.push((String::new(), None));
        }
        empty = 0;
        let first = words.first().map(|it| &it.token);
        let second = words.get(1).map(|it| &it.token);
        match first {
            Some(Token::Name("mode")) => (in_mode, in_rule) = (true, false),
            Some(Token::Name("parameter" | "state" | "discrete" | "start" | "requires")) => {
                (in_mode, in_rule) = (false, false);
            }
            Some(Token::Name("end")) if second == Some(&Token::Sign("=")) => {
                (in_mode, in_rule) = (false, false);
            }
            Some(Token::Name("when" | "at" | "every")) => in_rule = true,
            Some(Token::Name("rest")) if second == Some(&Token::Sign("->")) => {}
            _ if second == Some(&Token::Sign(":=")) || first.is_none() => {}
            _ => in_rule = false,
        }
        let is_rule = matches!(first, Some(Token::Name("when" | "at" | "every")));
        let is_mode = matches!(first, Some(Token::Name("mode")));
        let depth = usize::from(in_mode && !is_mode) + usize::from(in_rule && !is_rule);
        let mut code = "  ".repeat(depth);
        words_of(text, &words, &mut code);
        lines.push((code, comment));
        from = to;
    }
    Ok(aligned(&lines))
}

/// The lines of a text. Comments of neighbouring lines begin in one column.
fn aligned(lines: &[(String, Option<&str>)]) -> String {
    let mut text = String::new();
    let beside = |line: &(String, Option<&str>)| line.1.is_some() && !line.0.trim().is_empty();
    for block in lines.chunk_by(|one, other| beside(one) && beside(other)) {
        let width = block.iter().map(|(code, _)| code.chars().count()).max().unwrap_or(0);
        for line in block {
            match line {
                (code, Some(comment)) if beside(line) => {
                    // Writing to a string does not fail.
                    let _ = write!(text, "{code:width$}  {comment}");
                }
                (code, comment) => {
                    text.push_str(code);
                    text.push_str(comment.unwrap_or(""));
                }
            }
            text.push('\n');
        }
    }
    text
}

/// The comment of a line, which begins behind its last word.
fn comment<'a>(line: &'a str, from: usize, last: Option<&Spanned<'_>>) -> Option<&'a str> {
    let behind = last.map_or(0, |it| it.offset + it.length - from);
    let rest = line.get(behind..)?;
    rest.find('#').map(|place| rest[place..].trim_end())
}

/// Writes words and signs with blanks between them where they belong.
fn words_of(text: &str, words: &[&Spanned<'_>], formatted: &mut String) {
    let mut before: Option<&Token<'_>> = None;
    // Whether a sign here is one of a number, and not of a sum.
    let mut leads = true;
    for word in words {
        let token = &word.token;
        let tight_before = matches!(token, Token::Sign(")" | "," | "'" | "^" | "*" | "/" | ":"));
        let is_call = *token == Token::Sign("(")
            && matches!(before, Some(Token::Name(name)) if super::formula::is_function(name));
        let tight_after = match before {
            // A sign that leads belongs to what follows.
            None | Some(Token::Sign("(" | "^" | "*" | "/" | ":" | "leads")) => true,
            _ => false,
        };
        if !(tight_before || is_call || tight_after) {
            formatted.push(' ');
        }
        let written = &text[word.offset..word.offset + word.length];
        match token {
            Token::Sign(sign) => formatted.push_str(sign),
            _ => formatted.push_str(written),
        }
        let is_sign = matches!(token, Token::Sign("+" | "-"));
        before = Some(if is_sign && leads { &Token::Sign("leads") } else { token });
        leads = match token {
            Token::Sign(")" | "'") | Token::Number(_) | Token::Label(_) => false,
            Token::Sign(_) | Token::End => true,
            Token::Name(name) => {
                super::reader::RESERVED.contains(name) && !matches!(*name, "t" | "pi")
            }
        };
    }
}
