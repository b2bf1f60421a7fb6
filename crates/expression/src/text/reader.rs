//! What reads a text: its tokens, the place in them, and what names stand for.

use std::collections::HashMap;
use std::ops::Range;

use super::tokens::{Spanned, Token};
use super::{TextError, names};
use crate::graph::{Formula, Variable};
use crate::system::System;

/// Words that no name may be.
#[rustfmt::skip]
pub(super) const RESERVED: [&str; 28] = [
    "parameter", "state", "discrete", "mode", "when", "at", "every", "from", "start", "in", "end",
    "if", "then", "else", "and", "or", "not", "rises", "falls", "crosses", "through", "priority",
    "jumps", "sliding", "on", "requires", "t", "pi",
];

/// The tokens of a statement, without the end of its line.
pub(super) type Statement = Range<usize>;

/// Reads a system from its text.
pub(super) struct Reader<'a> {
    pub(super) text: &'a str,
    pub(super) tokens: Vec<Spanned<'a>>,
    /// The next token.
    pub(super) next: usize,
    /// How deep the formula that is read is nested.
    pub(super) depth: usize,
    pub(super) system: System,
    /// What names stand for here.
    pub(super) formulas: HashMap<&'a str, Formula>,
    /// The derivatives of components, in the mode that is read.
    pub(super) slopes: Vec<Option<Formula>>,
    /// Where the formulas of components at the start are.
    pub(super) starts: Vec<usize>,
    /// Whether a rule is read.
    pub(super) in_rule: bool,
    /// Along what each mode slides, and the tokens that say so.
    pub(super) surfaces: Vec<Vec<(Formula, usize)>>,
    /// Formulas above the modes that have another value in each, because they contain derivatives
    /// along the flow.
    pub(super) by_mode: HashMap<&'a str, Statement>,
    pub(super) components: HashMap<&'a str, usize>,
    pub(super) modes: HashMap<&'a str, usize>,
    /// Where each name is defined, to name it where it is used too early.
    pub(super) defined: HashMap<&'a str, usize>,
}

impl<'a> Reader<'a> {
    pub(super) fn peek(&self) -> &Token<'a> {
        &self.tokens[self.next.min(self.tokens.len() - 1)].token
    }

    /// An error at a token.
    pub(super) fn error_at(&self, token: usize, message: String) -> TextError {
        TextError::at(self.text, self.tokens[token.min(self.tokens.len() - 1)].offset, message)
    }

    /// An error at the next token.
    pub(super) fn error(&self, message: String) -> TextError {
        let Spanned { token, offset, length } = &self.tokens[self.next.min(self.tokens.len() - 1)];
        let found = if *token == Token::End {
            "the line ends here".to_owned()
        } else {
            let found: String = self.text[*offset..offset + length].chars().take(30).collect();
            format!("`{found}` is out of place")
        };
        let message =
            if message.starts_with("expected") { format!("{found}; {message}") } else { message };
        TextError::at(self.text, *offset, message)
    }

    pub(super) fn takes(&mut self, sign: &str) -> bool {
        let takes = matches!(self.peek(), Token::Sign(it) if *it == sign);
        self.next += usize::from(takes);
        takes
    }

    pub(super) fn takes_one(&mut self, signs: &[&'static str]) -> Option<&'static str> {
        signs.iter().copied().find(|sign| self.takes(sign))
    }

    pub(super) fn takes_word(&mut self, word: &str) -> bool {
        let takes = matches!(self.peek(), Token::Name(it) if *it == word);
        self.next += usize::from(takes);
        takes
    }

    pub(super) fn expect(&mut self, sign: &str) -> Result<(), TextError> {
        if self.takes(sign) { Ok(()) } else { Err(self.error(format!("expected {sign}"))) }
    }

    pub(super) fn expect_word(&mut self, word: &str) -> Result<(), TextError> {
        if self.takes_word(word) { Ok(()) } else { Err(self.error(format!("expected `{word}`"))) }
    }

    pub(super) fn expect_end(&self) -> Result<(), TextError> {
        match self.peek() {
            Token::End => Ok(()),
            _ => Err(self.error("expected the end of the line".to_owned())),
        }
    }

    fn line_of(&self, token: usize) -> usize {
        self.text[..self.tokens[token].offset].matches('\n').count() + 1
    }

    /// The line of a definition that comes after a token.
    pub(super) fn defined_below(&self, name: &str, token: usize) -> Option<usize> {
        let place = *self.defined.get(name)?;
        (place > token).then(|| self.line_of(place))
    }

    pub(super) fn expect_name(&mut self, what: &str) -> Result<&'a str, TextError> {
        match *self.peek() {
            Token::Name(name) if !RESERVED.contains(&name) => {
                self.next += 1;
                Ok(name)
            }
            Token::Name(name) => {
                let message = format!("`{name}` has a meaning of its own; expected {what}");
                Err(self.error(message))
            }
            _ => Err(self.error(format!("expected {what}"))),
        }
    }

    /// The number that a formula is.
    pub(super) fn constant(&self, formula: Formula, at: usize) -> Result<f64, TextError> {
        match self.system.graph.value(formula) {
            Some(value) if value.is_finite() => Ok(value),
            Some(value) => {
                Err(self.error_at(at, format!("this is {value}; expected a finite number")))
            }
            None => Err(self.error_at(at, "this depends on a name; expected a number".to_owned())),
        }
    }

    /// Refuses what depends on more than parameters.
    pub(super) fn parameters_alone(&self, formula: Formula, at: usize) -> Result<(), TextError> {
        let read = self.system.graph.reads(&[formula]);
        if read.iter().all(|variable| matches!(variable, Variable::Parameter(_))) {
            return Ok(());
        }
        let message = "this changes during a run; expected numbers and parameters alone";
        Err(self.error_at(at, message.to_owned()))
    }

    /// The component that is the next token.
    pub(super) fn component(&self, name: &str) -> Result<usize, TextError> {
        self.components.get(name).copied().ok_or_else(|| {
            let hint = names::hint(name, self.components.keys().copied());
            self.error(format!("`{name}` is no state{hint}; expected a name after `state`"))
        })
    }

    /// The mode that is the next token.
    pub(super) fn target(&mut self) -> Result<usize, TextError> {
        let at = self.next;
        let name = self.expect_name("the name of a mode")?;
        self.modes.get(name).copied().ok_or_else(|| {
            let hint = names::hint(name, self.modes.keys().copied());
            self.error_at(at, format!("there is no mode `{name}`{hint}"))
        })
    }
}
