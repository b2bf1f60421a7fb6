//! A system as text that reads the same.

use std::collections::{HashMap, HashSet};
use std::fmt::Write;

use stickslip_solver::Direction;

use super::formula::{is_function, name_of};
use super::reader::RESERVED;
use crate::graph::{Binary, Formula, FormulaNode, Graph, Unary, Variable};
use crate::system::{Component, Mode, Next, Rule, System, Trigger};

/// Formulas that are nested deeper get a name.
const DEEPEST: usize = 30;

/// Longer formulas that are used more than once get a name.
const LONGEST: usize = 12;

/// How strongly the parts of a formula are bound, from what is bound least.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Bond {
    Branch,
    Sum,
    Product,
    Sign,
    Power,
    Name,
}

/// A formula as text.
#[derive(Clone)]
struct Printed {
    text: String,
    bond: Bond,
    depth: usize,
}

impl Printed {
    fn name(text: &str) -> Self {
        Self { text: text.to_owned(), bond: Bond::Name, depth: 0 }
    }

    /// The text where `bond` is needed.
    fn within(&self, bond: Bond) -> String {
        if self.bond >= bond { self.text.clone() } else { format!("({})", self.text) }
    }
}

impl System {
    /// The system as text, with its names for formulas. [`System::parse`] reads the same formulas
    /// from it, so that runs are the same bit for bit. Names that no text can have are changed.
    #[must_use]
    pub fn text(&self) -> String {
        match &self.unslid {
            // Modes without formulas between them, or a list of choices at the start, have no text.
            Some(unslid) if !self.slides.is_empty() || self.otherwise.len() > 1 => unslid.text(),
            _ => Printer::new(&self.readable()).print(),
        }
    }
}

impl Graph {
    /// Formulas as text, with these names for the components of the state. What several of them
    /// need may have a name of its own, as a line in front of them.
    ///
    /// ```
    /// use stickslip_expression::{Binary, Graph, Unary};
    ///
    /// let mut graph = Graph::default();
    /// let x = graph.component(0);
    /// let (sine, square) = (graph.unary(Unary::Sin, x), graph.unary(Unary::Square, x));
    /// let product = graph.binary(Binary::Mul, sine, square);
    /// assert_eq!(graph.texts(&[product], &["x".to_owned()]), ["sin(x)*x^2"]);
    /// ```
    #[must_use]
    pub fn texts(&self, formulas: &[Formula], names: &[String]) -> Vec<String> {
        let mut graph = self.clone();
        let start = graph.constant(0.0);
        let component = |name: &String| Component { name: name.clone(), start, discrete: false };
        let slopes = formulas.to_vec();
        let system = System {
            components: names.iter().map(component).collect(),
            modes: vec![Mode { name: String::new(), slopes, rules: Vec::new() }],
            graph,
            ..System::default()
        };
        let printer = Printer::new(&system);
        let named = printer.named.lines().map(str::to_owned);
        named.chain(formulas.iter().map(|&formula| printer.of(formula).text.clone())).collect()
    }
}

struct Printer<'a> {
    system: &'a System,
    printed: Vec<Option<Printed>>,
    /// Lines with names for formulas.
    named: String,
}

impl<'a> Printer<'a> {
    fn new(system: &'a System) -> Self {
        let mut printer =
            Self { system, printed: vec![None; system.graph.len()], named: String::new() };
        printer.formulas();
        printer
    }

    fn formulas(&mut self) {
        let system = self.system;
        let (roots, graph) = (system.moving_formulas(), &system.graph);
        let bounds = system.fixed_formulas();
        let roots = [&roots[..], &bounds[..]].concat();
        let needed = graph.needed(&roots);
        let mut uses = vec![0_usize; needed.len()];
        for root in &roots {
            uses[root.index()] += 1;
        }
        for index in (0..needed.len()).filter(|&index| needed[index]) {
            for operand in graph.nodes()[index].operands() {
                uses[operand.index()] += 1;
            }
        }
        let mut names = self.names();
        let known: HashSet<String> = names.values().cloned().collect();
        let taken = |name: &str| {
            known.contains(name)
                || self.system.components.iter().any(|it| it.name == name)
                || self.system.parameters.iter().any(|it| it.name == name)
        };
        let mut fresh = (1..).map(|k| format!("f{k}")).filter(|name| !taken(name));
        let mut lines = String::new();
        for index in (0..needed.len()).filter(|&index| needed[index]) {
            let node = graph.nodes()[index];
            let mut printed = self.node(node);
            let leaf = matches!(node, FormulaNode::Constant(_) | FormulaNode::Variable(_));
            let shared = uses[index] > 1 && printed.text.chars().count() > LONGEST;
            let name = names.remove(&index);
            if !leaf && (name.is_some() || shared || printed.depth > DEEPEST) {
                let name = name.or_else(|| fresh.next()).unwrap_or_default();
                // Writing to a string does not fail.
                let _ = writeln!(lines, "{name} = {}", printed.text);
                printed = Printed::name(&name);
            }
            self.printed[index] = Some(printed);
        }
        self.named = lines;
    }

    /// The names that readers gave to formulas: those that are not ambiguous.
    fn names(&self) -> HashMap<usize, String> {
        let mut formulas = HashMap::<&str, HashSet<Formula>>::new();
        for (name, formula) in &self.system.names {
            formulas.entry(name).or_default().insert(*formula);
        }
        let plain = |name: &str| !RESERVED.contains(&name) && !is_function(name);
        let mut names = HashMap::new();
        for (name, formula) in self.system.names.iter().rev() {
            if plain(name) && formulas[name.as_str()].len() == 1 {
                names.insert(formula.index(), name.clone());
            }
        }
        names
    }

    fn of(&self, formula: Formula) -> &Printed {
        self.printed[formula.index()].as_ref().expect("operands come before what needs them")
    }

    fn node(&self, node: FormulaNode) -> Printed {
        let depth = node.operands().map(|it| self.of(it).depth + 1).max().unwrap_or(0);
        let (text, bond) = match node {
            FormulaNode::Constant(bits) => return constant(f64::from_bits(bits)),
            FormulaNode::Variable(Variable::Time) => return Printed::name("t"),
            FormulaNode::Variable(Variable::Component(index)) => {
                return Printed::name(&self.system.components[index as usize].name);
            }
            FormulaNode::Variable(Variable::Parameter(index)) => {
                return Printed::name(&self.system.parameters[index as usize].name);
            }
            FormulaNode::Unary(Unary::Neg, a) => {
                (format!("-{}", self.of(a).within(Bond::Power)), Bond::Sign)
            }
            FormulaNode::Unary(Unary::Square, a) => {
                (format!("{}^2", self.of(a).within(Bond::Name)), Bond::Power)
            }
            FormulaNode::Unary(function, a) => {
                (format!("{}({})", name_of(function), self.of(a).text), Bond::Name)
            }
            FormulaNode::Binary(function, a, b) => self.binary(function, a, b),
            FormulaNode::Power(a, n) => {
                (format!("{}^{n}", self.of(a).within(Bond::Name)), Bond::Power)
            }
            FormulaNode::RealPower(a, n) => {
                let n = constant(f64::from_bits(n)).text;
                (format!("{}^{n}", self.of(a).within(Bond::Name)), Bond::Power)
            }
            FormulaNode::Select(condition, yes, no) => {
                let [condition, yes, no] = [condition, yes, no].map(|it| self.of(it));
                let condition = condition.within(Bond::Sum);
                let text = format!("if {condition} >= 0 then {} else {}", yes.text, no.text);
                (text, Bond::Branch)
            }
        };
        Printed { text, bond, depth }
    }

    fn binary(&self, function: Binary, a: Formula, b: Formula) -> (String, Bond) {
        let (a, b) = (self.of(a), self.of(b));
        let joined = |sign: &str, left: Bond, right: Bond, bond: Bond| {
            (format!("{} {sign} {}", a.within(left), b.within(right)), bond)
        };
        match function {
            Binary::Add => joined("+", Bond::Sum, Bond::Product, Bond::Sum),
            Binary::Sub => joined("-", Bond::Sum, Bond::Product, Bond::Sum),
            Binary::Mul => {
                let text = format!("{}*{}", a.within(Bond::Product), b.within(Bond::Sign));
                (text, Bond::Product)
            }
            Binary::Div => {
                let text = format!("{}/{}", a.within(Bond::Product), b.within(Bond::Sign));
                (text, Bond::Product)
            }
            Binary::Min => (format!("min({}, {})", a.text, b.text), Bond::Name),
            Binary::Max => (format!("max({}, {})", a.text, b.text), Bond::Name),
            Binary::Atan2 => (format!("atan2({}, {})", a.text, b.text), Bond::Name),
        }
    }

    fn print(&self) -> String {
        let system = self.system;
        let mut text = String::new();
        let _ = self.write(system, &mut text);
        text
    }

    fn write(&self, system: &System, text: &mut String) -> std::fmt::Result {
        let of = |formula: Formula| &self.of(formula).text;
        let sum = |formula: Formula| self.of(formula).within(Bond::Sum);
        for parameter in &system.parameters {
            let value = constant(parameter.value).text;
            write!(text, "parameter {} = {value}", parameter.name)?;
            if let Some((low, high)) = parameter.range {
                write!(text, " in {}:{}", constant(low).text, constant(high).text)?;
            }
            writeln!(text)?;
        }
        for component in &system.components {
            let kind = if component.discrete { "discrete" } else { "state" };
            writeln!(text, "{kind} {} = {}", component.name, of(component.start))?;
        }
        if !self.named.is_empty() {
            write!(text, "\n{}", self.named)?;
        }
        for (place, mode) in system.modes.iter().enumerate() {
            writeln!(text, "\nmode {}", mode.name)?;
            for &surface in system.surfaces.get(place).into_iter().flatten() {
                writeln!(text, "  sliding on {} = 0", sum(surface))?;
            }
            for (component, &slope) in system.components.iter().zip(&mode.slopes) {
                if !component.discrete {
                    writeln!(text, "  {}' = {}", component.name, of(slope))?;
                }
            }
            for rule in &mode.rules {
                self.rule(rule, text)?;
            }
        }
        writeln!(text)?;
        for condition in &system.required {
            let sign = if condition.below { "<" } else { ">=" };
            writeln!(text, "requires {} {sign} 0", sum(condition.formula))?;
        }
        if let Some(first) = system.modes.get(system.first) {
            match system.otherwise.first() {
                Some(&(formula, other)) => {
                    let (condition, other) = (sum(formula), &system.modes[other].name);
                    write!(text, "start if {condition} >= 0 in {} else {other}", first.name)?;
                }
                None => write!(text, "start in {}", first.name)?,
            }
            if let Some(start) = system.start {
                write!(text, " at {}", of(start))?;
            }
            writeln!(text)?;
        }
        if let Some(end) = system.end {
            writeln!(text, "end = {}", of(end))?;
        }
        Ok(())
    }

    fn rule(&self, rule: &Rule, text: &mut String) -> std::fmt::Result {
        let of = |formula: Formula| &self.of(formula).text;
        let sum = |formula: Formula| self.of(formula).within(Bond::Sum);
        match &rule.trigger {
            Trigger::When(guard, direction) => {
                let sign = match direction {
                    Direction::Falling => "falls through 0",
                    Direction::Rising => "rises through 0",
                    Direction::Either => "crosses 0",
                    _ => "< 0",
                };
                write!(text, "  when {} {sign}", sum(*guard))?;
            }
            Trigger::At(times) => {
                let times: Vec<&str> = times.iter().map(|&it| of(it).as_str()).collect();
                write!(text, "  at {}", times.join(", "))?;
            }
            Trigger::Every { period, phase } => {
                write!(text, "  every {} from {}", of(*period), of(*phase))?;
            }
        }
        if let Some(label) = &rule.label {
            let label: String = label.chars().filter(|c| !c.is_control() && *c != '"').collect();
            write!(text, " \"{label}\"")?;
        }
        if rule.priority != 0 {
            write!(text, " priority {}", rule.priority)?;
        }
        if rule.sees_jumps {
            write!(text, " jumps")?;
        }
        let name = |mode: usize| &self.system.modes[mode].name;
        match rule.next {
            // With slides, the text is that of the system before.
            Next::Stay | Next::Slide { .. } => {}
            Next::Mode(mode) => write!(text, " -> {}", name(mode))?,
            Next::Branch(condition, above, below) => {
                let (condition, above, below) = (sum(condition), name(above), name(below));
                write!(text, " if {condition} >= 0 -> {above} else -> {below}")?;
            }
        }
        match rule.ends_after {
            0 => {}
            1 => write!(text, " -> end")?,
            count => write!(text, " end after {count}")?,
        }
        if rule.from_zero > 0 {
            write!(text, " from zero {}", rule.from_zero)?;
        }
        writeln!(text)?;
        let change = |text: &mut String, &(component, formula): &(usize, Formula)| {
            writeln!(text, "    {} := {}", self.system.components[component].name, of(formula))
        };
        rule.changes.iter().try_for_each(|it| change(text, it))?;
        if let Some(rest) = &rule.rest {
            writeln!(text, "    rest -> {}", name(rest.next))?;
            rest.changes.iter().try_for_each(|it| change(text, it))?;
        }
        Ok(())
    }
}

/// A number with all its digits.
fn constant(x: f64) -> Printed {
    let (text, bond) = match x {
        _ if x.is_nan() => ("(0/0)".to_owned(), Bond::Name),
        f64::INFINITY => ("(1/0)".to_owned(), Bond::Name),
        f64::NEG_INFINITY => ("(-1/0)".to_owned(), Bond::Name),
        _ => (format!("{x:?}"), if x.is_sign_negative() { Bond::Sign } else { Bond::Name }),
    };
    // A number such as 2.0 reads as 2.
    let text = text.strip_suffix(".0").map_or(text.clone(), str::to_owned);
    Printed { text, bond, depth: 0 }
}
