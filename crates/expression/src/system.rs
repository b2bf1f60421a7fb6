//! What a hybrid system consists of.

use stickslip_solver::{Direction, InvalidValue};

use crate::graph::{Formula, Graph, Variable};

/// A hybrid system: formulas for what changes, and rules for what happens when.
#[derive(Clone, Debug, Default)]
pub struct System {
    /// All formulas.
    pub graph: Graph,
    /// The parameters, which formulas read by their places.
    pub parameters: Vec<Parameter>,
    /// The components of the state, those that only rules change among them.
    pub components: Vec<Component>,
    /// Names of formulas, for readers.
    pub names: Vec<(String, Formula)>,
    /// The modes.
    pub modes: Vec<Mode>,
    /// The first mode.
    pub first: usize,
    /// Formulas of parameters, and the first mode where one is negative, and none before it.
    pub otherwise: Vec<(Formula, usize)>,
    /// Conditions of parameters under which there is a run, decided in this order.
    pub required: Vec<Condition>,
    /// The time at the start.
    pub start: Option<Formula>,
    /// The time at the end.
    pub end: Option<Formula>,
    /// Modes that slide along several surfaces.
    pub slides: Vec<Slide>,
    /// The system before its modes were replaced by those that slide.
    pub unslid: Option<Box<System>>,
    /// Along what the modes of such a system slide.
    pub surfaces: Vec<Vec<Formula>>,
}

/// Where a formula is negative, or where it is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// The formula.
    pub formula: Formula,
    /// Whether the condition holds where it is negative; otherwise where it is 0 or above.
    pub below: bool,
}

impl Condition {
    /// A number that is negative where the condition does not hold, if the formula is `value`. It
    /// changes as the formula does.
    pub(crate) fn room(self, value: f64) -> f64 {
        // A condition that does not hold at 0 is off it by the smallest double.
        if self.below { (-value).next_down() } else { value }
    }
}

/// Modes that slide along the same surfaces: 5ᵏ for each choice of above, below, sliding, released
/// above and released below for the first surface, the second one, and so on; and one more, where
/// the solution does not go on.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide {
    /// The functions whose zeros are the surfaces.
    pub surfaces: Vec<Formula>,
    /// The slopes of all components for each choice of sides: above surfaces whose bits are 1.
    pub corners: Vec<Vec<Formula>>,
    /// The place of the first mode. A run that starts there starts on the sides where its state is.
    pub first: usize,
}

impl System {
    /// What is a number as soon as parameters are: starts, ends and times.
    pub(crate) fn fixed_formulas(&self) -> Vec<Formula> {
        let starts = self.components.iter().map(|component| component.start);
        let mut formulas: Vec<Formula> = starts.chain(self.start).chain(self.end).collect();
        for rule in self.modes.iter().flat_map(|mode| &mode.rules) {
            match &rule.trigger {
                Trigger::When(..) => {}
                Trigger::At(times) => formulas.extend(times),
                Trigger::Every { period, phase } => formulas.extend([period, phase]),
            }
        }
        formulas.extend(self.otherwise.iter().map(|(formula, _)| *formula));
        formulas.extend(self.required.iter().map(|condition| condition.formula));
        formulas
    }

    /// Refuses a parameter on which the first mode depends: runs with several of its values cannot
    /// be compared along a boundary.
    ///
    /// # Errors
    /// [`InvalidValue`] names the parameter.
    pub fn require_one_first_mode(&self, parameter: usize) -> Result<(), InvalidValue> {
        let formulas: Vec<Formula> = self.otherwise.iter().map(|it| it.0).collect();
        let decides = u32::try_from(parameter)
            .is_ok_and(|it| self.graph.reads(&formulas).contains(&Variable::Parameter(it)));
        match self.parameters.get(parameter) {
            Some(Parameter { name, .. }) if decides => {
                let expected = "one on which the first mode does not depend";
                Err(InvalidValue::new("parameter", &**name, expected))
            }
            _ => Ok(()),
        }
    }

    /// What changes during a run.
    pub(crate) fn moving_formulas(&self) -> Vec<Formula> {
        let mut formulas = self.surfaces.concat();
        let slides = self.slides.iter();
        formulas.extend(slides.flat_map(|it| it.corners.iter().chain([&it.surfaces]).flatten()));
        for mode in &self.modes {
            formulas.extend(&mode.slopes);
            for rule in &mode.rules {
                if let Trigger::When(guard, _) = rule.trigger {
                    formulas.push(guard);
                }
                let at_rest = rule.rest.iter().flat_map(|rest| &rest.changes);
                formulas.extend(rule.changes.iter().chain(at_rest).map(|(_, formula)| *formula));
                if let Next::Branch(condition, ..) = rule.next {
                    formulas.push(condition);
                }
            }
        }
        formulas
    }
}

/// A number that is the same during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value unless another one is given.
    pub value: f64,
    /// The values of interest, from the lower to the upper one.
    pub range: Option<(f64, f64)>,
}

/// A component of the state.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name.
    pub name: String,
    /// Its value at the start, made of parameters.
    pub start: Formula,
    /// Whether only rules change it.
    pub discrete: bool,
}

/// A smooth regime.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Its name.
    pub name: String,
    /// The derivative of each component.
    pub slopes: Vec<Formula>,
    /// What happens when.
    pub rules: Vec<Rule>,
}

/// What happens at an event.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// When it happens.
    pub trigger: Trigger,
    /// What it is called.
    pub label: Option<String>,
    /// Of rules at one instant, those of higher priority act first.
    pub priority: i8,
    /// Whether it also acts where another rule carries its guard across zero.
    pub sees_jumps: bool,
    /// The run ends when the rule acts for so many times; 0 means never.
    pub ends_after: u32,
    /// The order of a zero from which the guard starts, where rounding may hide it; 0 otherwise.
    pub from_zero: u32,
    /// New values of components, made of the state before the event.
    pub changes: Vec<(usize, Formula)>,
    /// Where the run goes on.
    pub next: Next,
    /// How the run goes on where events of the rule accumulate; otherwise it ends there.
    pub rest: Option<RestRule>,
}

/// How a run goes on behind a place where events accumulate.
#[derive(Clone, Debug, PartialEq)]
pub struct RestRule {
    /// The mode that follows.
    pub next: usize,
    /// New values of components, made of the state behind the last event.
    pub changes: Vec<(usize, Formula)>,
}

impl Rule {
    /// A rule that leaves everything as it is acts where its condition begins to hold: it would act
    /// without end as long as the condition holds.
    pub(crate) fn note_once(&mut self) {
        let idle = self.stays_as_it_is() && self.rest.is_none() && self.ends_after != 1;
        if let Trigger::When(_, direction @ Direction::Below) = &mut self.trigger
            && idle
        {
            *direction = Direction::Falling;
        }
    }

    /// Whether the rule leaves everything as it is.
    pub(crate) fn stays_as_it_is(&self) -> bool {
        self.next == Next::Stay && self.changes.is_empty()
    }

    /// A rule that changes nothing.
    #[must_use]
    pub fn new(trigger: Trigger) -> Self {
        Self {
            trigger,
            label: None,
            priority: 0,
            sees_jumps: false,
            ends_after: 0,
            from_zero: 0,
            changes: Vec::new(),
            next: Next::Stay,
            rest: None,
        }
    }

    /// The label, or else a name from the `place` of the rule in its mode.
    #[must_use]
    pub fn name(&self, place: usize) -> String {
        let kind = match self.trigger {
            Trigger::When(..) => "when",
            Trigger::At(_) => "at",
            Trigger::Every { .. } => "every",
        };
        self.label.clone().unwrap_or_else(|| format!("{kind} {}", place + 1))
    }
}

/// When a rule acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Trigger {
    /// Where a formula becomes negative or crosses zero.
    When(Formula, Direction),
    /// At these times, made of parameters.
    At(Vec<Formula>),
    /// At phase + k·period for all integers k, made of parameters.
    Every {
        /// The period.
        period: Formula,
        /// The phase.
        phase: Formula,
    },
}

/// Where a run goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// In the same mode.
    Stay,
    /// In this mode.
    Mode(usize),
    /// In the second mode where the formula is ≥ 0, and in the third where it is negative.
    Branch(Formula, usize, usize),
    /// In that mode of a slide in which the solution goes on.
    Slide {
        /// The place of the slide.
        slide: usize,
        /// The surface i that is reached, or left upwards, as 2i, or left downwards, as 2i + 1;
        /// none if the rule is another one.
        guard: Option<usize>,
    },
}

impl Next {
    /// The modes to which a rule of the mode at `place` leads, without those of slides.
    pub(crate) fn modes(&self, place: usize) -> impl Iterator<Item = usize> + use<> {
        let modes = match *self {
            Self::Stay => [Some(place), None],
            Self::Mode(next) => [Some(next), None],
            Self::Branch(_, one, other) => [Some(one), Some(other)],
            // They are many, and entered in any state.
            Self::Slide { .. } => [None, None],
        };
        modes.into_iter().flatten()
    }
}
