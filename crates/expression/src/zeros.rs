//! Zeros from which guards start, found from the formulas.
//!
//! Where every way into a mode makes a guard vanish together with its first derivatives, the guard
//! starts there from a zero of that order. Whether a formula vanishes is decided as for polynomials
//! in what the formulas read and in functions of that; on the zero of the guard that leads into the
//! mode, as for their multiples. What is not found this way can be declared.

mod polynomial;

use stickslip_solver::Direction;

use crate::graph::{Formula, Graph, Variable};
use crate::sliding::several;
use crate::system::{Mode, Rule, System, Trigger};
use polynomial::Polynomial;

/// The highest order that is looked for.
const HIGHEST: u32 = 6;

/// What is known of a component while a system is in a mode.
#[derive(Clone, Copy, PartialEq)]
enum Held {
    /// The mode is not reached.
    Nowhere,
    /// It is always this formula of parameters.
    At(Formula),
    /// It may be anything.
    Free,
}

/// A way into a mode.
struct Entry {
    mode: usize,
    /// The components behind it, as formulas of the state before.
    state: Vec<Formula>,
    /// The time, if it is known.
    time: Option<Formula>,
    /// What vanishes there.
    zero: Option<Formula>,
}

impl System {
    /// The order of the zero from which each guard of each mode starts, as declared or found; 0 for
    /// those that start elsewhere, or that need no declaration.
    pub(crate) fn zero_orders(&self) -> Vec<Vec<u32>> {
        let mut graph = self.graph.clone();
        let entries = self.entries(&mut graph);
        let modes = self.modes.iter().enumerate();
        let slides = self.slide_modes();
        let orders = modes.map(|(place, mode)| {
            let is_slide = slides.contains(&place);
            let ways = || entries.iter().filter(move |entry| entry.mode == place);
            let order = |rule: &Rule| {
                // An edge at the start may act there; its side is that of its first derivative.
                let guard = match rule.trigger {
                    Trigger::When(guard, Direction::Below) if !is_slide => guard,
                    _ => return rule.from_zero,
                };
                let orders = ways().map(|entry| zero_order(&mut graph, mode, guard, entry));
                // A simple zero needs no declaration.
                let least = orders.min().filter(|order| (2..=HIGHEST).contains(order));
                rule.from_zero.max(least.unwrap_or(0))
            };
            mode.rules.iter().map(order).collect()
        });
        orders.collect()
    }

    /// The modes of slides.
    fn slide_modes(&self) -> Vec<usize> {
        let modes = self.slides.iter().flat_map(|it| {
            let count = several::count(it.surfaces.len());
            it.first..it.first + count
        });
        modes.collect()
    }

    /// All ways into modes. A rule that stays and changes nothing is none.
    fn entries(&self, graph: &mut Graph) -> Vec<Entry> {
        let starts: Vec<Formula> = self.components.iter().map(|it| it.start).collect();
        let others = self.otherwise.iter().map(|(_, mode)| *mode);
        let first: Vec<usize> = others.chain([self.first]).collect();
        let time = self.start.unwrap_or_else(|| graph.constant(0.0));
        let held = self.held(graph, &first, &starts);
        let start = |mode| Entry { mode, state: starts.clone(), time: Some(time), zero: None };
        let mut entries: Vec<Entry> = first.into_iter().map(start).collect();
        for (place, mode) in self.modes.iter().enumerate() {
            if held[place].contains(&Held::Nowhere) {
                continue;
            }
            let before = before(graph, &held[place]);
            for rule in mode.rules.iter().filter(|rule| rule.ends_after != 1) {
                let state = behind(graph, &before, &rule.changes);
                let zero = match rule.trigger {
                    Trigger::When(guard, _) => Some(graph.substituted(guard, &before)),
                    _ => None,
                };
                let time = match &rule.trigger {
                    Trigger::At(times) if times.len() == 1 => Some(times[0]),
                    _ => None,
                };
                for mode in rule.next.modes(place).filter(|_| !rule.stays_as_it_is()) {
                    entries.push(Entry { mode, state: state.clone(), time, zero });
                }
                if let Some(rest) = &rule.rest {
                    let state = behind(graph, &state, &rest.changes);
                    entries.push(Entry { mode: rest.next, state, time: None, zero: None });
                }
            }
        }
        entries
    }

    /// What is known of the components in each mode.
    fn held(&self, graph: &mut Graph, first: &[usize], starts: &[Formula]) -> Vec<Vec<Held>> {
        let mut held = vec![vec![Held::Nowhere; self.components.len()]; self.modes.len()];
        // The modes of slides are entered in any state.
        let mut open = self.slide_modes();
        for &mode in &open {
            held[mode].fill(Held::Free);
        }
        for &mode in first {
            self.enter(graph, &mut held[mode], mode, starts);
            open.push(mode);
        }
        while let Some(place) = open.pop() {
            let before = before(graph, &held[place]);
            for rule in &self.modes[place].rules {
                let state = behind(graph, &before, &rule.changes);
                for next in rule.next.modes(place) {
                    if self.enter(graph, &mut held[next], next, &state) {
                        open.push(next);
                    }
                }
                if let Some(rest) = &rule.rest {
                    let state = behind(graph, &state, &rest.changes);
                    if self.enter(graph, &mut held[rest.next], rest.next, &state) {
                        open.push(rest.next);
                    }
                }
            }
        }
        held
    }

    /// Adds a way into a mode to what is known there; whether that is less now.
    fn enter(&self, graph: &Graph, held: &mut [Held], mode: usize, state: &[Formula]) -> bool {
        let mut less = false;
        for ((held, &slope), &formula) in held.iter_mut().zip(&self.modes[mode].slopes).zip(state) {
            let fixed = || {
                let read = graph.reads(&[formula]);
                read.iter().all(|it| matches!(it, Variable::Parameter(_)))
            };
            let now = match *held {
                Held::Free => Held::Free,
                _ if graph.value(slope) != Some(0.0) || !fixed() => Held::Free,
                Held::At(other) if other != formula => Held::Free,
                _ => Held::At(formula),
            };
            less |= now != *held;
            *held = now;
        }
        less
    }
}

/// The components in a mode, those that are known as their formulas.
fn before(graph: &mut Graph, held: &[Held]) -> Vec<Formula> {
    let component = |(place, held): (usize, &Held)| match held {
        Held::At(formula) => *formula,
        _ => graph.component_at(place),
    };
    held.iter().enumerate().map(component).collect()
}

/// The components behind changes.
fn behind(graph: &mut Graph, before: &[Formula], changes: &[(usize, Formula)]) -> Vec<Formula> {
    let mut state = before.to_vec();
    for &(place, formula) in changes {
        state[place] = graph.substituted(formula, before);
    }
    state
}

/// Whether a formula is zero wherever another one is, as a multiple of it.
pub(crate) fn vanishes_with(graph: &Graph, formula: Formula, other: Formula) -> bool {
    let [formula, other] = [formula, other].map(|it| Polynomial::of(graph, it));
    let (Some(formula), Some(other)) = (formula, other) else { return false };
    formula.is_zero() || formula.is_multiple_of(&other)
}

/// How many derivatives of a guard, itself among them, vanish behind a way into its mode.
fn zero_order(graph: &mut Graph, mode: &Mode, guard: Formula, entry: &Entry) -> u32 {
    let zero = entry.zero.and_then(|zero| Polynomial::of(graph, zero));
    let mut formula = guard;
    for order in 0..=HIGHEST {
        let mut there = graph.substituted(formula, &entry.state);
        if let Some(time) = entry.time {
            there = graph.at_time(there, time);
        }
        let vanishes = Polynomial::of(graph, there).is_some_and(|it| match &zero {
            Some(zero) => it.is_zero() || it.is_multiple_of(zero),
            None => it.is_zero(),
        });
        if !vanishes {
            return order;
        }
        formula = graph.rate(formula, &mode.slopes);
    }
    HIGHEST + 1
}
