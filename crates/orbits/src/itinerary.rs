//! In which order an orbit goes through modes, and which rule ends each segment.

use stickslip_expression::{InvalidValue, Next, Rule, System, Trigger};

/// So many unknowns are solved for: segments times components and durations.
pub(crate) const MOST_UNKNOWNS: usize = 1200;

/// One segment of an itinerary: a mode, and the rule that ends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Leg {
    /// The mode, by its place in the system.
    pub mode: usize,
    /// The rule that ends the segment, by its place in the mode.
    pub rule: usize,
    /// The mode that follows.
    pub next: usize,
}

impl Leg {
    pub(crate) fn rule(self, system: &System) -> &Rule {
        &system.modes[self.mode].rules[self.rule]
    }

    /// The name of the rule that ends the segment.
    #[must_use]
    pub fn name(self, system: &System) -> String {
        self.rule(system).name(self.rule)
    }
}

/// The places of the rules of this name in a mode, at least one.
///
/// # Errors
/// There is none, or a segment cannot end with it.
pub(crate) fn rules_named(
    system: &System,
    mode: usize,
    name: &str,
) -> Result<Vec<usize>, InvalidValue> {
    let rules = &system.modes[mode].rules;
    let named = (0..rules.len()).filter(|&place| rules[place].name(place) == name);
    let named: Vec<usize> = named.collect();
    if named.is_empty() {
        let known: Vec<_> = rules.iter().enumerate().map(|(place, it)| it.name(place)).collect();
        let known = if known.is_empty() { "no rule".to_owned() } else { known.join(", ") };
        let expected = format!("a rule of mode {}, which has {known}", system.modes[mode].name);
        return Err(InvalidValue::new("itinerary", name, expected));
    }
    for &place in &named {
        let at_times = matches!(rules[place].trigger, Trigger::At(_));
        let expected = "a rule that acts again and again, not at given times";
        InvalidValue::check("itinerary", name, expected, !at_times)?;
        let expected = "a rule that never ends a run";
        InvalidValue::check("itinerary", name, expected, rules[place].ends_after == 0)?;
    }
    Ok(named)
}

/// The modes that may follow a rule of a mode: where its condition is ≥ 0, and where it is not.
pub(crate) fn modes_after(rule: &Rule, mode: usize) -> (usize, usize) {
    match rule.next {
        // Systems with several surfaces are refused.
        Next::Stay | Next::Slide { .. } => (mode, mode),
        Next::Mode(next) => (next, next),
        Next::Branch(_, above, below) => (above, below),
    }
}

/// Refuses an itinerary with too many segments.
pub(crate) fn require_short(legs: usize, components: usize) -> Result<(), InvalidValue> {
    let most = MOST_UNKNOWNS / (components + 1);
    let expected = format!("1 to {most} for a system of {components} components");
    InvalidValue::check("the number of segments", legs, expected, (1..=most).contains(&legs))
}

/// Refuses segments that are not those of a system: their legs, and the states at their starts.
pub(crate) fn require_of(
    system: &System,
    legs: &[Leg],
    states: &[Vec<f64>],
) -> Result<(), InvalidValue> {
    let (n, modes) = (system.components.len(), system.modes.len());
    require_short(legs.len(), n)?;
    for (leg, state) in legs.iter().zip(states) {
        let mode = leg.mode.max(leg.next);
        InvalidValue::check("the mode of a segment", mode, "one of the system", mode < modes)?;
        let known = leg.rule < system.modes[leg.mode].rules.len();
        InvalidValue::check("the rule of a segment", leg.rule, "one of its mode", known)?;
        let (count, expected) = (state.len(), format!("{n} finite numbers"));
        let fits = count == n && state.iter().all(|it| it.is_finite());
        InvalidValue::check("the state of a segment", count, expected, fits)?;
    }
    Ok(())
}
