//! Rules: what happens when, and where the run goes on.

use stickslip_solver::Direction;

use super::TextError;
use super::condition::Truth;
use super::reader::Reader;
use super::tokens::Token;
use crate::graph::{Binary, Variable};
use crate::system::{Next, RestRule, Rule, Trigger};

impl Reader<'_> {
    /// `when …`, `at …` or `every …`, up to the end of its line.
    pub(super) fn rule(&mut self) -> Result<Rule, TextError> {
        let at = self.next;
        let trigger = if self.takes_word("when") {
            self.condition()?
        } else if self.takes_word("at") {
            let mut times = Vec::new();
            loop {
                let at = self.next;
                let time = self.number()?;
                self.parameters_alone(time, at)?;
                times.push(time);
                if !self.takes(",") {
                    break Trigger::At(times);
                }
            }
        } else {
            self.next += 1;
            let at = self.next;
            let period = self.number()?;
            self.parameters_alone(period, at)?;
            let at = self.next;
            let phase = if self.takes_word("from") {
                let phase = self.number()?;
                self.parameters_alone(phase, at)?;
                phase
            } else {
                self.system.graph.constant(0.0)
            };
            Trigger::Every { period, phase }
        };
        if let Trigger::When(guard, _) = trigger {
            let read = self.system.graph.reads(&[guard]);
            if read.iter().all(|it| matches!(it, Variable::Parameter(_))) {
                let message = "the condition never changes; expected one with a state or t";
                return Err(self.error_at(at + 1, message.to_owned()));
            }
        }
        let mut rule = Rule::new(trigger);
        loop {
            match self.peek().clone() {
                Token::Label(label) => {
                    self.next += 1;
                    rule.label = Some(label.to_owned());
                }
                Token::Name("priority") => {
                    self.next += 1;
                    let at = self.next;
                    let formula = self.number()?;
                    let value = self.constant(formula, at)?;
                    if value.fract() != 0.0 || !(-128.0..=127.0).contains(&value) {
                        let message = format!("the priority is {value}; expected −128 to 127");
                        return Err(self.error_at(at, message));
                    }
                    // The value is an integer in range.
                    #[expect(clippy::cast_possible_truncation)]
                    let priority = value as i8;
                    rule.priority = priority;
                }
                Token::Name("end") => {
                    self.next += 1;
                    self.expect_word("after")?;
                    rule.ends_after = self.count()?;
                }
                Token::Name("from") => {
                    self.next += 1;
                    self.expect_word("zero")?;
                    rule.from_zero = self.count()?;
                }
                Token::Name("jumps") => {
                    self.next += 1;
                    rule.sees_jumps = true;
                }
                Token::Sign("->") => {
                    self.next += 1;
                    if self.takes_word("end") {
                        rule.ends_after = 1;
                    } else {
                        rule.next = Next::Mode(self.target()?);
                    }
                }
                Token::Name("if") => {
                    self.next += 1;
                    rule.next = self.branch()?;
                }
                Token::End => return Ok(rule),
                _ => {
                    let message = "expected a label, ->, `if`, `priority`, `jumps`, `end after`, \
                                   `from zero` or the end of the line";
                    return Err(self.error(message.to_owned()));
                }
            }
        }
    }

    /// A count, 1 or above.
    fn count(&mut self) -> Result<u32, TextError> {
        let at = self.next;
        let formula = self.number()?;
        let value = self.constant(formula, at)?;
        if value.fract() != 0.0 || !(1.0..=1e9).contains(&value) {
            return Err(self.error_at(at, format!("this is {value}; expected a count from 1")));
        }
        // The value is an integer in range.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        Ok(value as u32)
    }

    /// `x < 1`, `x rises through 1`, `x falls through 1`, `x crosses 1`.
    fn condition(&mut self) -> Result<Trigger, TextError> {
        let edges = [
            ("rises", Direction::Rising),
            ("falls", Direction::Falling),
            ("crosses", Direction::Either),
        ];
        let from = self.next;
        let is_edge = |token: &Token<'_>| matches!(token, Token::Name(name) if edges.iter().any(|(word, _)| word == name));
        let line = self.tokens[from..].iter().take_while(|it| it.token != Token::End);
        if !line.clone().any(|it| is_edge(&it.token)) {
            let truth = self.truth()?;
            return Ok(Trigger::When(self.guard_of(truth), Direction::Below));
        }
        let left = self.number()?;
        let edge = edges.into_iter().find(|(word, _)| self.takes_word(word));
        let Some((word, direction)) = edge else {
            return Err(self.error("expected `rises`, `falls` or `crosses`".to_owned()));
        };
        if word != "crosses" {
            self.expect_word("through")?;
        }
        let right = self.number()?;
        let guard = self.system.graph.binary(Binary::Sub, left, right);
        Ok(Trigger::When(guard, direction))
    }

    /// `if … -> a else -> b`
    fn branch(&mut self) -> Result<Next, TextError> {
        let truth = self.truth()?;
        self.expect("->")?;
        let yes = self.target()?;
        self.expect_word("else")?;
        self.expect("->")?;
        let no = self.target()?;
        Ok(match truth {
            Truth::NotNegative(formula) => Next::Branch(formula, yes, no),
            Truth::Negative(formula) => {
                // The sign of zero does not matter: −0 counts as 0.
                Next::Branch(formula, no, yes)
            }
        })
    }

    /// `rest -> mode`
    pub(super) fn rest(&mut self, rule: &mut Rule) -> Result<(), TextError> {
        let at = self.next - 1;
        if rule.rest.is_some() || rule.next != Next::Stay {
            let message = "expected one `rest`, under a rule that stays in its mode";
            return Err(self.error_at(at, message.to_owned()));
        }
        self.expect("->")?;
        rule.rest = Some(RestRule { next: self.target()?, changes: Vec::new() });
        self.expect_end()
    }

    /// `x := …`
    pub(super) fn change(&mut self, rule: &mut Rule) -> Result<(), TextError> {
        let Token::Name(name) = self.peek().clone() else { return Ok(()) };
        let component = self.component(name)?;
        let changes = rule.rest.as_mut().map_or(&mut rule.changes, |rest| &mut rest.changes);
        if changes.iter().any(|(other, _)| *other == component) {
            return Err(self.error(format!("`{name}` gets two values at one event")));
        }
        self.next += 2;
        let formula = self.number()?;
        self.expect_end()?;
        changes.push((component, formula));
        Ok(())
    }
}
