//! As much of Rust's syntax as tells what the code of a file names.

use std::collections::BTreeSet;

/// A name that a file uses.
#[derive(Clone, Debug)]
pub struct Used {
    /// The name in the file; `*` for all of what is at the path.
    pub name: String,
    /// The path to it.
    pub path: Vec<String>,
    /// Whether it is seen outside too.
    pub public: bool,
}

/// Whether a character is part of a name.
pub fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The code of a source: comments are left out, and texts are empty.
pub fn code(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let raw = raw_text(rest).filter(|_| !code.ends_with(is_word));
        let end = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(end) = raw {
            code.push_str("\"\"");
            end
        } else if next == '"' {
            code.push_str("\"\"");
            1 + closing(&rest[1..], '"')
        } else if let Some(end) = character(rest) {
            code.push('0');
            end
        } else {
            code.push(next);
            next.len_utf8()
        };
        rest = &rest[end..];
    }
    code
}

/// The length of a raw text that begins here.
fn raw_text(rest: &str) -> Option<usize> {
    let marks = rest.strip_prefix('b').unwrap_or(rest).strip_prefix('r')?;
    let hashes = marks.len() - marks.trim_start_matches('#').len();
    let begin = rest.len() - marks.len() + hashes + 1;
    marks[hashes..].starts_with('"').then_some(())?;
    let end = format!("\"{}", "#".repeat(hashes));
    Some(begin + rest[begin..].find(&end)? + end.len())
}

/// The length of a character that begins here. A lifetime is none.
fn character(rest: &str) -> Option<usize> {
    let inside = rest.strip_prefix('\'')?;
    let first = inside.chars().next()?;
    if first == '\\' {
        return Some(1 + closing(inside, '\''));
    }
    inside[first.len_utf8()..].starts_with('\'').then_some(2 + first.len_utf8())
}

/// The length up to and with the `quote` that ends a text.
fn closing(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (index, c) in rest.char_indices() {
        if c == quote && !escaped {
            return index + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    rest.len()
}

/// Code without what is compiled for tests only.
pub fn without_tests(code: &str) -> String {
    const MARK: &str = "#[cfg(test)]";
    let mut kept = String::new();
    let mut rest = code;
    while let Some(begin) = rest.find(MARK) {
        kept.push_str(&rest[..begin]);
        rest = &rest[begin + MARK.len()..];
        let end = rest.find(['{', ';']).unwrap_or(rest.len());
        let block = rest[end..].starts_with('{');
        let end = if block { end + block_length(&rest[end..]) } else { end + 1 };
        rest = rest.get(end..).unwrap_or_default();
    }
    kept + rest
}

/// The length of the block with which code begins.
fn block_length(code: &str) -> usize {
    let mut depth = 0_usize;
    for (index, c) in code.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return index + 1;
        }
    }
    code.len()
}

/// What code uses by `use`, and the rest of the code.
pub fn uses(code: &str) -> (Vec<Used>, String) {
    let (mut uses, mut kept) = (Vec::new(), String::new());
    let mut rest = code;
    while let Some(begin) = next_use(rest) {
        let before = rest[..begin].trim_end();
        let visibility = before.rsplit(['\n', ';', '}', '{']).next().unwrap_or_default();
        let public = visibility.trim_start().starts_with("pub");
        kept.push_str(&rest[..begin]);
        let end = begin + rest[begin..].find(';').unwrap_or(rest.len() - begin);
        tree(&rest[begin + "use ".len()..end], &[], public, &mut uses);
        rest = rest.get(end + 1..).unwrap_or_default();
    }
    (uses, kept + rest)
}

/// Where the next `use` begins.
fn next_use(code: &str) -> Option<usize> {
    code.match_indices("use ")
        .map(|(index, _)| index)
        .find(|&index| !code[..index].ends_with(is_word))
}

/// Adds the names of a tree of `use` below `prefix`.
fn tree(text: &str, prefix: &[String], public: bool, uses: &mut Vec<Used>) {
    let text = text.trim();
    let path = |text: &str| {
        let names = text.split("::").map(str::trim).filter(|name| !name.is_empty());
        [prefix, &names.map(str::to_owned).collect::<Vec<_>>()[..]].concat()
    };
    if let Some((head, inner)) = text.split_once('{') {
        let prefix = path(head);
        let inner = inner.trim_end().strip_suffix('}').unwrap_or(inner);
        let (mut depth, mut begin) = (0_usize, 0);
        for (index, c) in inner.char_indices().chain([(inner.len(), ',')]) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    tree(&inner[begin..index], &prefix, public, uses);
                    begin = index + 1;
                }
                _ => {}
            }
        }
        return;
    }
    let (text, other) =
        text.split_once(" as ").map_or((text, None), |(text, name)| (text, Some(name)));
    let mut path = path(text);
    path.pop_if(|last| last == "self");
    let Some(last) = path.last().cloned() else { return };
    let name = other.map_or(last.clone(), |name| name.trim().to_owned());
    if last == "*" {
        path.pop();
    }
    uses.push(Used { name, path, public });
}

/// The names of the items that code defines.
pub fn defined(code: &str) -> BTreeSet<String> {
    const ITEMS: [&str; 8] =
        ["fn", "struct", "enum", "trait", "type", "const", "static", "macro_rules!"];
    let mut words = code.split_whitespace().peekable();
    let mut defined = BTreeSet::new();
    while let Some(word) = words.next() {
        let item = word.trim_start_matches(|c| !is_word(c));
        if ITEMS.contains(&item)
            && let Some(name) = words.peek()
        {
            let end = name.find(|c| !is_word(c)).unwrap_or(name.len());
            defined.insert(name[..end].to_owned());
        }
    }
    defined
}
