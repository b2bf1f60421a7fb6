//! A first mode that parameters choose, as an event at the start.

use super::RuleOrder;
use crate::system::{Mode, Next, Rule, System, Trigger};

/// The system with a mode in front of the first ones, whose rule `start` leads to one of them by
/// the condition: so the condition has a margin, as that of every transition. `None` if there are
/// several conditions, rules at given times, which would not count at the start, or sides of
/// several surfaces to be decided there.
pub(super) fn chosen(system: &System, mut order: RuleOrder) -> Option<(System, RuleOrder)> {
    let &[(condition, other)] = &system.otherwise[..] else { return None };
    let is_clock = |rule: &Rule| !matches!(rule.trigger, Trigger::When(..));
    let is_decided = |mode: usize| system.slides.iter().any(|slide| slide.first == mode);
    let has_clocks = system.modes.iter().flat_map(|mode| &mode.rules).any(is_clock);
    if has_clocks || is_decided(system.first) || is_decided(other) {
        return None;
    }
    let mut chosen = system.clone();
    let graph = &mut chosen.graph;
    let (zero, start) = (graph.constant(0.0), system.start);
    let start = start.unwrap_or(zero);
    let mut rule = Rule::new(Trigger::At(vec![start]));
    rule.next = Next::Branch(condition, system.first, other);
    let slopes = vec![zero; system.components.len()];
    chosen.modes.push(Mode { name: "start".to_owned(), slopes, rules: vec![rule] });
    (chosen.first, chosen.otherwise) = (system.modes.len(), Vec::new());
    let mut name = "start".to_owned();
    while order.names.contains(&name) {
        name.push('_');
    }
    order.places.push(vec![order.names.len()]);
    order.names.push(name);
    Some((chosen, order))
}
