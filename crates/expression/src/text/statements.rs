//! Statements: what a system declares, its modes and their rules.

use std::collections::{HashMap, HashSet};

use super::condition::Truth;
use super::formula::is_function;
use super::reader::{RESERVED, Reader, Statement};
use super::tokens::{Token, tokens};
use super::{TextError, names};
use crate::graph::{Binary, Formula, FormulaNode, Unary, Variable};
use crate::system::{Component, Condition, Mode, Parameter, Rule, System};

/// The slopes of all modes together have at most as many entries.
const MOST_SLOPES: usize = 10_000_000;

/// The statements of a mode.
struct Section<'a> {
    name: &'a str,
    statements: Vec<Statement>,
}

/// What a statement of a mode, or above the modes, is.
enum Kind<'a> {
    /// The derivative of a component.
    Slope(&'a str),
    /// A name for a formula.
    Name(&'a str),
    /// What happens when, and the changes that follow.
    Rule,
    /// A new value, which belongs to the rule above.
    Change,
    /// The mode at rest, which belongs to the rule above.
    Rest,
    /// Along what the mode slides.
    Surface,
}

impl System {
    /// Reads a system from its text. `docs/systems.md` describes the language.
    ///
    /// # Errors
    /// [`TextError`] with the place of the first mistake.
    pub fn parse(text: &str) -> Result<Self, TextError> {
        let tokens = tokens(text)?;
        let reader = Reader {
            text,
            tokens,
            next: 0,
            depth: 0,
            system: Self::default(),
            formulas: HashMap::new(),
            slopes: Vec::new(),
            starts: Vec::new(),
            in_rule: false,
            surfaces: Vec::new(),
            by_mode: HashMap::new(),
            components: HashMap::new(),
            modes: HashMap::new(),
            defined: HashMap::new(),
        };
        reader.read()
    }
}

impl<'a> Reader<'a> {
    /// The statements of the text.
    fn statements(&self) -> Vec<Statement> {
        let mut statements = Vec::new();
        let mut from = 0;
        for (place, token) in self.tokens.iter().enumerate() {
            if token.token == Token::End {
                if place > from {
                    statements.push(from..place);
                }
                from = place + 1;
            }
        }
        statements
    }

    fn read(mut self) -> Result<System, TextError> {
        let mut sections = vec![Section { name: "", statements: Vec::new() }];
        let mut ends = Vec::new();
        for statement in self.statements() {
            self.next = statement.start;
            let (first, second) = (self.peek().clone(), self.second());
            let sign = |signs: &[&str]| matches!(second, Token::Sign(it) if signs.contains(&it));
            if sign(&["=", ":=", "'"]) {
                if let (Token::Name(name), true) = (&first, sign(&["="])) {
                    self.defined.entry(name).or_insert(statement.start);
                }
                if first == Token::Name("end") {
                    ends.push(statement);
                    continue;
                }
                let last = sections.len() - 1;
                sections[last].statements.push(statement);
                continue;
            }
            match first {
                Token::Name("parameter" | "state" | "discrete") => self.declarations()?,
                Token::Name("mode") => {
                    self.next += 1;
                    let at = self.next;
                    let name = self.expect_name("the name of a mode")?;
                    self.expect_end()?;
                    if self.modes.insert(name, sections.len() - 1).is_some() {
                        return Err(self.error_at(at, format!("there are two modes `{name}`")));
                    }
                    sections.push(Section { name, statements: Vec::new() });
                }
                Token::Name("start" | "requires") => ends.push(statement),
                Token::Name("when" | "at" | "every" | "rest" | "sliding") => {
                    let last = sections.len() - 1;
                    sections[last].statements.push(statement);
                }
                Token::Name("end") => {
                    return Err(self.error("expected = behind `end`, as in `end = 10`".to_owned()));
                }
                Token::Name(name) => {
                    let words = ["parameter", "state", "discrete", "mode", "start", "when", "at"];
                    let words = words.into_iter().chain(["every", "end", "rest", "sliding"]);
                    let words = words.chain(["requires"]);
                    let hint = names::hint(name, words);
                    let message = format!(
                        "`{name}` begins no statement{hint}; expected a word such as `state` or \
                         `when`, or a name with = or ' or := behind it"
                    );
                    return Err(self.error(message));
                }
                _ => return Err(self.error("expected a statement".to_owned())),
            }
        }
        self.sections(sections)?;
        for statement in ends {
            self.next = statement.start;
            self.bound()?;
        }
        let Some(first) = self.surfaces.iter().flatten().map(|it| it.1).next() else {
            return Ok(self.system);
        };
        let formulas = |it: &Vec<(Formula, usize)>| it.iter().map(|it| it.0).collect();
        let surfaces: Vec<Vec<Formula>> = self.surfaces.iter().map(formulas).collect();
        let sliding = std::mem::take(&mut self.system).sliding(&surfaces);
        sliding.map_err(|wrong| self.error_at(first, wrong.to_string()))
    }

    fn second(&self) -> Token<'a> {
        self.tokens.get(self.next + 1).map_or(Token::End, |it| it.token.clone())
    }

    /// `parameter a = 1 in 0:2, b = 3`, `state x = a`, `discrete n = 0`.
    fn declarations(&mut self) -> Result<(), TextError> {
        let Token::Name(kind) = self.peek().clone() else { return Ok(()) };
        self.next += 1;
        loop {
            let at = self.next;
            let name = self.expect_name("a name")?;
            self.free(name, at)?;
            self.expect("=")?;
            let from = self.next;
            let variable = if kind == "parameter" {
                let formula = self.number()?;
                let value = self.constant(formula, from)?;
                let range = self.range(value)?;
                let index = short(self.system.parameters.len());
                self.system.parameters.push(Parameter { name: name.to_owned(), value, range });
                Variable::Parameter(index)
            } else {
                self.skip_formula();
                let index = self.system.components.len();
                let discrete = kind == "discrete";
                let start = self.system.graph.constant(0.0);
                self.system.components.push(Component { name: name.to_owned(), start, discrete });
                self.starts.push(from);
                let zero = self.system.graph.constant(0.0);
                self.slopes.push(discrete.then_some(zero));
                self.components.insert(name, index);
                Variable::Component(short(index))
            };
            let variable = self.system.graph.variable(variable);
            self.formulas.insert(name, variable);
            if !self.takes(",") {
                return self.expect_end();
            }
        }
    }

    /// Goes to the end of a formula, which is read later.
    fn skip_formula(&mut self) {
        let mut depth = 0_usize;
        loop {
            match self.peek() {
                Token::End => return,
                Token::Sign(",") if depth == 0 => return,
                Token::Sign("(") => depth += 1,
                Token::Sign(")") => depth = depth.saturating_sub(1),
                _ => {}
            }
            self.next += 1;
        }
    }

    /// Reads what components are at the start. Names may stand there for formulas of parameters.
    fn starts(&mut self) -> Result<(), TextError> {
        for (component, from) in std::mem::take(&mut self.starts).into_iter().enumerate() {
            self.next = from;
            let start = self.number()?;
            self.parameters_alone(start, from)?;
            if !matches!(self.peek(), Token::Sign(",")) {
                self.expect_end()?;
            }
            self.system.components[component].start = start;
        }
        Ok(())
    }

    fn range(&mut self, value: f64) -> Result<Option<(f64, f64)>, TextError> {
        if !self.takes_word("in") {
            return Ok(None);
        }
        let at = self.next;
        let low = self.number()?;
        let low = self.constant(low, at)?;
        self.expect(":")?;
        let from = self.next;
        let high = self.number()?;
        let high = self.constant(high, from)?;
        if low < high && (low..=high).contains(&value) {
            return Ok(Some((low, high)));
        }
        let message = format!("the range {low}:{high} does not contain {value}; expected low:high");
        Err(self.error_at(at, message))
    }

    /// Refuses a name that already has a meaning.
    fn free(&self, name: &str, at: usize) -> Result<(), TextError> {
        let message = if is_function(name) {
            format!("`{name}` is a function; expected another name")
        } else if self.formulas.contains_key(name) || self.by_mode.contains_key(name) {
            format!("`{name}` is already defined")
        } else {
            return Ok(());
        };
        Err(self.error_at(at, message))
    }

    fn kind(&mut self, statement: &Statement) -> Result<Kind<'a>, TextError> {
        self.next = statement.start;
        let (first, second) = (self.peek().clone(), self.second());
        match (first, second) {
            (Token::Name(name), Token::Sign("'")) => Ok(Kind::Slope(name)),
            (Token::Name(name), Token::Sign("=")) if RESERVED.contains(&name) => {
                Err(self.error(format!("`{name}` has a meaning of its own; expected another name")))
            }
            (Token::Name(name), Token::Sign("=")) => Ok(Kind::Name(name)),
            (Token::Name(_), Token::Sign(":=")) => Ok(Kind::Change),
            (Token::Name("rest"), Token::Sign("->")) => Ok(Kind::Rest),
            (Token::Name("sliding"), _) => Ok(Kind::Surface),
            (Token::Name(_), _) => Ok(Kind::Rule),
            _ => Err(self.error("expected a name".to_owned())),
        }
    }

    /// Whether a statement contains a derivative along the flow.
    fn depends_on_mode(&self, statement: &Statement) -> bool {
        let tokens = &self.tokens[statement.start + 2..statement.end];
        tokens.iter().any(|it| match it.token {
            Token::Sign("'") => true,
            Token::Name(name) => self.by_mode.contains_key(name),
            _ => false,
        })
    }

    /// Reads the statements above the modes, and the modes.
    fn sections(&mut self, mut sections: Vec<Section<'a>>) -> Result<(), TextError> {
        let shared = std::mem::take(&mut sections[0].statements);
        if sections.len() == 1 {
            sections.push(Section { name: "main", statements: Vec::new() });
            self.modes.insert("main", 0);
        }
        if (sections.len() - 1).saturating_mul(self.slopes.len()) > MOST_SLOPES {
            let message = format!("modes times components are more than {MOST_SLOPES}");
            return Err(TextError::at(self.text, 0, message));
        }
        // What is the same in all modes is read once.
        let (mut equations, mut rules, mut after_rule) = (Vec::new(), Vec::new(), false);
        let mut surfaces = Vec::new();
        for statement in shared {
            match self.kind(&statement)? {
                Kind::Name(name) if self.depends_on_mode(&statement) => {
                    self.free(name, statement.start)?;
                    self.by_mode.insert(name, statement);
                }
                Kind::Slope(_) if self.depends_on_mode(&statement) => equations.push(statement),
                Kind::Surface => surfaces.push(statement),
                Kind::Change | Kind::Rest if !after_rule => {
                    return Err(self.error("expected a rule (`when`, `at`) above this".to_owned()));
                }
                Kind::Rule | Kind::Change | Kind::Rest => {
                    rules.push(statement);
                    after_rule = true;
                    continue;
                }
                Kind::Name(name) => self.name(name)?,
                Kind::Slope(name) => {
                    self.slope(name)?;
                }
            }
            after_rule = false;
        }
        self.starts()?;
        let common = self.slopes.clone();
        for mut section in sections.drain(1..) {
            self.slopes.clone_from(&common);
            let is_surface = |it: &Statement| self.tokens[it.start].token == Token::Name("sliding");
            if !section.statements.iter().any(is_surface) {
                section.statements.extend(surfaces.clone());
            }
            self.mode(&section, &equations, &rules)?;
        }
        Ok(())
    }

    /// `name = …`
    fn name(&mut self, name: &'a str) -> Result<(), TextError> {
        self.free(name, self.next)?;
        self.next += 2;
        let formula = self.number()?;
        self.expect_end()?;
        self.formulas.insert(name, formula);
        self.system.names.push((name.to_owned(), formula));
        Ok(())
    }

    /// `name' = …`
    fn slope(&mut self, name: &str) -> Result<usize, TextError> {
        let component = self.component(name)?;
        if self.system.components[component].discrete {
            let message = format!("`{name}` is discrete: only rules change it");
            return Err(self.error(message));
        }
        self.next += 2;
        self.expect("=")?;
        let formula = self.number()?;
        self.expect_end()?;
        self.slopes[component] = Some(formula);
        Ok(component)
    }

    fn mode(
        &mut self,
        section: &Section<'a>,
        equations: &[Statement],
        shared: &[Statement],
    ) -> Result<(), TextError> {
        let mut own = HashSet::new();
        let mut surfaces = Vec::new();
        let (mut local, mut rules) = (Vec::new(), shared.to_vec());
        let mut after_rule = false;
        for statement in &section.statements {
            match self.kind(statement)? {
                Kind::Name(name) => {
                    self.name(name)?;
                    local.push(name);
                }
                Kind::Slope(name) => {
                    let at = self.next;
                    if !own.insert(self.slope(name)?) {
                        let message = format!("`{name}` has two equations in this mode");
                        return Err(self.error_at(at, message));
                    }
                }
                Kind::Surface => self.surface(&mut surfaces)?,
                Kind::Change | Kind::Rest if !after_rule => {
                    return Err(self.error("expected a rule (`when`, `at`) above this".to_owned()));
                }
                Kind::Change | Kind::Rule | Kind::Rest => {
                    after_rule = true;
                    rules.push(statement.clone());
                    continue;
                }
            }
            after_rule = false;
        }
        for statement in equations {
            if let Kind::Slope(name) = self.kind(statement)?
                && !own.contains(&self.component(name)?)
            {
                self.slope(name)?;
            }
        }
        let mut read = Vec::new();
        self.in_rule = true;
        for statement in rules {
            self.next = statement.start;
            if let Token::Name("when" | "at" | "every") = self.peek() {
                read.push(self.rule()?);
            } else if let Some(rule) = read.last_mut()
                && self.second() == Token::Sign("->")
            {
                self.next += 1;
                self.rest(rule)?;
            } else if let Some(rule) = read.last_mut() {
                self.change(rule)?;
            }
        }
        self.in_rule = false;
        read.iter_mut().for_each(Rule::note_once);
        if self.system.modes.is_empty() {
            // Mistakes in formulas that no mode uses.
            let formulas: Vec<_> =
                self.by_mode.iter().map(|(name, it)| (*name, it.start)).collect();
            for (name, at) in formulas {
                self.in_mode(name, at)?;
            }
        }
        let missing = self.slopes.iter().position(Option::is_none);
        if let Some(missing) = missing {
            let (mode, name) = (section.name, &self.system.components[missing].name);
            let message =
                format!("mode `{mode}` has no equation for `{name}`; expected {name}' = …");
            let place = self.tokens.iter().position(|it| it.token == Token::Name(mode));
            return Err(self.error_at(place.unwrap_or(self.tokens.len() - 1), message));
        }
        let slopes = self.slopes.iter().copied().flatten().collect();
        self.system.modes.push(Mode { name: section.name.to_owned(), slopes, rules: read });
        self.surfaces.push(surfaces);
        for name in local.into_iter().chain(self.by_mode.keys().copied()) {
            self.formulas.remove(name);
        }
        Ok(())
    }

    /// `sliding on v = belt, w = belt`
    fn surface(&mut self, surfaces: &mut Vec<(Formula, usize)>) -> Result<(), TextError> {
        self.next += 1;
        self.expect_word("on")?;
        loop {
            let at = self.next;
            let left = self.number()?;
            self.expect("=")?;
            let right = self.number()?;
            let graph = &mut self.system.graph;
            let surface = graph.binary(Binary::Sub, left, right);
            let opposite = graph.unary(Unary::Neg, surface);
            let reads = graph.reads(&[surface]);
            let message = if reads.iter().all(|it| matches!(it, Variable::Parameter(_))) {
                "the surface is made of numbers alone; expected one with a state"
            } else if surfaces.iter().any(|(known, _)| [surface, opposite].contains(known)) {
                "the mode slides along this surface already"
            } else {
                surfaces.push((surface, at));
                if !self.takes(",") {
                    return self.expect_end();
                }
                continue;
            };
            return Err(self.error_at(at, message.to_owned()));
        }
    }

    /// `requires condition, condition`
    fn requirements(&mut self) -> Result<(), TextError> {
        loop {
            let at = self.next;
            let (formula, below) = match self.truth()? {
                Truth::Negative(formula) => (formula, true),
                Truth::NotNegative(formula) => (formula, false),
            };
            self.parameters_alone(formula, at)?;
            if self.system.graph.reads(&[formula]).is_empty() {
                let message = "the condition never changes; expected one with a parameter";
                return Err(self.error_at(at, message.to_owned()));
            }
            self.require(Condition { formula, below });
            if !self.takes(",") {
                return self.expect_end();
            }
        }
    }

    /// Adds a condition, as several if it holds where all of several do: their common boundary has
    /// corners.
    fn require(&mut self, condition: Condition) {
        let Condition { formula, below } = condition;
        let joint = if below { Binary::Max } else { Binary::Min };
        let graph = &self.system.graph;
        let is = |formula, number: f64| graph.value(formula) == Some(number);
        match graph.node(formula) {
            FormulaNode::Binary(function, a, b) if function == joint => {
                self.require(Condition { formula: a, below });
                self.require(Condition { formula: b, below });
            }
            // What is 0 or above, beside what is negative.
            FormulaNode::Select(formula, yes, no) if below && is(yes, -1.0) && is(no, 1.0) => {
                self.require(Condition { formula, below: false });
            }
            _ => self.system.required.push(condition),
        }
    }

    /// `start in mode at 0`, `start if condition in one else other`, `end = 10`.
    fn bound(&mut self) -> Result<(), TextError> {
        if self.takes_word("end") {
            self.expect("=")?;
            let at = self.next;
            let end = self.number()?;
            self.parameters_alone(end, at)?;
            self.system.end = Some(end);
        } else if self.takes_word("requires") {
            return self.requirements();
        } else {
            self.next += 1;
            let at = self.next;
            let condition = if self.takes_word("if") { Some(self.truth()?) } else { None };
            if self.takes_word("in") {
                self.system.first = self.target()?;
            }
            if let Some(condition) = condition {
                self.expect_word("else")?;
                let other = self.target()?;
                let formula = match condition {
                    Truth::NotNegative(formula) => {
                        self.system.otherwise = vec![(formula, other)];
                        formula
                    }
                    Truth::Negative(formula) => {
                        self.system.otherwise = vec![(formula, self.system.first)];
                        self.system.first = other;
                        formula
                    }
                };
                self.parameters_alone(formula, at + 1)?;
            }
            if self.takes_word("at") {
                let at = self.next;
                let start = self.number()?;
                self.parameters_alone(start, at)?;
                self.system.start = Some(start);
            }
        }
        self.expect_end()
    }
}

/// A place as formulas have it. There are fewer than 2³² components.
fn short(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}
