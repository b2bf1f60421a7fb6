//! Whether the parts of a system fit together. Those of a text do; others may be made by hand.

use stickslip_solver::InvalidValue;

use crate::graph::{Formula, Variable};
use crate::sliding::several::count;
use crate::system::{Next, System};

/// Refuses a system whose parts do not fit together.
pub(super) fn require(system: &System) -> Result<(), InvalidValue> {
    let (n, modes) = (system.components.len(), system.modes.len());
    let first = system.otherwise.iter().map(|(_, mode)| *mode).chain([system.first]);
    require_below(modes, first.max().unwrap_or(0), "the first mode")?;
    for slide in &system.slides {
        let k = slide.surfaces.len();
        require_below(5, k, "the number of surfaces")?;
        let last = slide.first.saturating_add(count(k) - 1);
        require_below(modes, last, "the last mode of a slide")?;
        let corners = slide.corners.len();
        if corners != 1 << k || slide.corners.iter().any(|slopes| slopes.len() != n) {
            return broken(
                "the number of fields of a slide",
                corners,
                "one for each choice of sides",
            );
        }
    }
    for mode in &system.modes {
        if mode.slopes.len() != n {
            return broken("the number of slopes", mode.slopes.len(), "one for each component");
        }
        for rule in &mode.rules {
            let (one, other) = match rule.next {
                Next::Stay => (0, 0),
                Next::Mode(mode) => (mode, mode),
                Next::Branch(_, above, below) => (above, below),
                Next::Slide { slide, guard } => {
                    require_below(system.slides.len(), slide, "the slide that follows a rule")?;
                    let guards = 2 * system.slides[slide].surfaces.len();
                    require_below(guards, guard.unwrap_or(0), "the guard of a surface")?;
                    (0, 0)
                }
            };
            require_below(modes, one.max(other), "the mode that follows a rule")?;
            let rest = rule.rest.as_ref();
            require_below(modes, rest.map_or(0, |rest| rest.next), "the mode at rest")?;
            for &(component, _) in rule.changes.iter().chain(rest.iter().flat_map(|it| &it.changes))
            {
                require_below(n, component, "the component that a rule changes")?;
            }
        }
    }
    require_known(system, &system.fixed_formulas(), None)?;
    require_known(system, &system.moving_formulas(), Some(n))
}

/// Refuses formulas of another graph, and those that read what is not there. Fixed formulas have
/// no components, and no time.
fn require_known(
    system: &System,
    formulas: &[Formula],
    components: Option<usize>,
) -> Result<(), InvalidValue> {
    for formula in formulas {
        require_below(system.graph.len(), formula.index(), "a formula")?;
    }
    for variable in system.graph.reads(formulas) {
        match (variable, components) {
            (Variable::Time, Some(_)) => {}
            (Variable::Time, None) => return broken("the time in a start or end", 0, "no time"),
            (Variable::Component(place), n) => {
                require_below(n.unwrap_or(0), place as usize, "a component that a formula reads")?;
            }
            (Variable::Parameter(place), _) => {
                let parameters = system.parameters.len();
                require_below(parameters, place as usize, "a parameter that a formula reads")?;
            }
        }
    }
    Ok(())
}

fn require_below(count: usize, place: usize, what: &'static str) -> Result<(), InvalidValue> {
    if place < count { Ok(()) } else { broken(what, place, "one of those that the system has") }
}

fn broken(what: &'static str, value: usize, expected: &'static str) -> Result<(), InvalidValue> {
    Err(InvalidValue::new(what, value, expected))
}
