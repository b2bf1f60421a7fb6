//! What the measurements say, a sentence with its numbers each.

use super::measure::Coordinates;
use stickslip_solver::Order;

use super::Measurement;
use super::collisions::engine;
use super::series::{Control, MethodPair, Row, Scheme, Series, Switches};

/// Accuracies whose work is told.
const TARGETS: [f64; 2] = [1e-6, 1e-10];
/// Steps in a contact that a simulation of many particles may afford.
const FEW_STEPS: f64 = 50.0;

impl Measurement {
    pub fn findings(&self) -> Vec<String> {
        let mut findings = vec![self.measured()];
        for switches in [Switches::Located, Switches::AtStepEnds] {
            for variables in [Coordinates::Regularized, Coordinates::PlainTime] {
                findings.push(self.orders_in(switches, variables));
            }
        }
        findings.extend(self.few_steps());
        findings.push(self.tolerances());
        findings.extend(TARGETS.map(|target| self.cost(target)));
        findings.extend([0, 1].map(|pair| self.usual_accuracy(pair)));
        findings
    }

    fn measured(&self) -> String {
        let counts = self.references.iter().map(|collision| collision.switches.len());
        let (fewest, most) = (counts.clone().min().unwrap_or(0), counts.max().unwrap_or(0));
        let collisions = match self.references.len() {
            1 => "one collision".to_owned(),
            count => format!("{count} collisions"),
        };
        let switches =
            if fewest == most { fewest.to_string() } else { format!("{fewest} to {most}") };
        format!(
            "Errors are those of {collisions} with {switches} switches, against {}{}.",
            self.reference(),
            self.agreement()
        )
    }

    /// How closely the reference is met, where it is a calculation of the same kind.
    fn agreement(&self) -> String {
        let error = |row: &Row| row.errors.velocity.root_mean_square;
        let [_, dop853] = self.both(Control::Step, Switches::Located, Coordinates::Regularized);
        let rows = dop853.rows.iter().filter(|row| row.errors.comparable());
        let closest = rows.min_by(|a, b| error(a).total_cmp(&error(b)));
        match closest {
            Some(Row { value, errors, .. }) if self.is_damped() => format!(
                ", from which dop853 in fixed steps of {value:.4} differs by {:.1e} in the final \
                 velocity and {:.1e} in switch times",
                errors.velocity.root_mean_square, errors.switch_time.root_mean_square
            ),
            _ => String::new(),
        }
    }

    /// Both pairs in fixed steps.
    fn orders_in(&self, switches: Switches, variables: Coordinates) -> String {
        let ways = match switches {
            Switches::Located => "with switches located",
            Switches::AtStepEnds => "with steps that run over switches",
        };
        let found = self.both(Control::Step, switches, variables).map(|series| {
            format!(
                "{} {} in the final velocity and {} in switch times",
                series.scheme.pair.name(),
                order(series.velocity.as_ref()),
                order(series.switch_time.as_ref())
            )
        });
        let expected = match (switches, variables) {
            (Switches::Located, Coordinates::Regularized) => {
                "expected are the 5 and 8 of the methods: everything is smooth between switches, \
                 and these end steps"
            }
            (Switches::Located, Coordinates::PlainTime) if self.is_damped() => {
                "expected is 3/2 of both once steps are shorter than the stick phase with which \
                 contact starts: the force grows as √t there, so that the first step errs by \
                 h^(3/2)"
            }
            (Switches::Located, Coordinates::PlainTime) => {
                "expected is 5/2 of both: the force x^(3/2) goes as t^(3/2) at both ends of \
                 contact, and steps there err by h^(5/2)"
            }
            (Switches::AtStepEnds, _) => {
                "expected are at most 2 and 1 of any method: a switch takes effect up to a step h late, \
                 and the force, which is continuous there, is then wrong by O(h) for a time O(h)"
            }
        };
        format!(
            "In {} {ways} the orders are: {}; {expected}.",
            match variables {
                Coordinates::Regularized => "regularised coordinates",
                Coordinates::PlainTime => "plain time",
            },
            found.join("; "),
        )
    }

    /// Steps over switches that are not very short.
    fn few_steps(&self) -> Option<String> {
        let contact_time = self.references.first()?.contact_time;
        let [_, series] = self.both(Control::Step, Switches::AtStepEnds, Coordinates::PlainTime);
        let Row { value, errors, .. } =
            series.rows.iter().find(|row| row.value <= contact_time / FEW_STEPS)?;
        Some(format!(
            "With {:.0} steps of {} a contact that run over switches in plain time, {} of {} collisions \
             have other switches than they should, and the final velocity is off by {:.1e}, at \
             worst {:.1e}.",
            contact_time / value,
            series.scheme.pair.name(),
            errors.other_switches + errors.failed,
            self.references.len(),
            errors.velocity.root_mean_square,
            errors.velocity.largest,
        ))
    }

    /// Error against tolerance.
    fn tolerances(&self) -> String {
        let all = [Coordinates::Regularized, Coordinates::PlainTime].map(|variables| {
            self.both(Control::Tolerance, Switches::Located, variables).map(|series| {
                let Some(fit) = series.velocity else {
                    return format!("{} no range to fit", name(series));
                };
                let range = fit.finest * (1.0 - 1e-9)..=fit.coarsest * (1.0 + 1e-9);
                let fitted = series.rows.iter().filter(|row| range.contains(&row.value));
                let ratios = fitted.map(|row| row.errors.velocity.root_mean_square / row.value);
                let (least, most) = ratios.fold((f64::INFINITY, 0.0), |(least, most), ratio| {
                    (f64::min(least, ratio), f64::max(most, ratio))
                });
                format!(
                    "{} {least:.2} to {most:.2} times the tolerance from {:.0e} to {:.0e}, \
                     exponent {:.3} ± {:.3}",
                    name(series),
                    fit.coarsest,
                    fit.finest,
                    fit.order,
                    fit.standard_error
                )
            })
        });
        let all: Vec<_> = all.into_iter().flatten().collect();
        format!("At a tolerance the final velocity is off by: {}.", all.join("; "))
    }

    /// Work for an accuracy.
    fn cost(&self, target: f64) -> String {
        let ways = [
            (Control::Tolerance, Switches::Located, Coordinates::Regularized),
            (Control::Tolerance, Switches::Located, Coordinates::PlainTime),
            (Control::Step, Switches::AtStepEnds, Coordinates::PlainTime),
        ];
        let costs = ways.into_iter().flat_map(|(control, switches, variables)| {
            self.both(control, switches, variables).map(|series| {
                let enough = series.rows.iter().filter(|row| {
                    row.errors.comparable() && row.errors.velocity.root_mean_square <= target
                });
                let least = enough.map(|row| self.work(&row.errors)).min_by(f64::total_cmp);
                let over = match switches {
                    Switches::Located => "",
                    Switches::AtStepEnds => " over switches",
                };
                match least {
                    Some(work) => format!("{}{over} {work:.0}", name(series)),
                    None => format!("{}{over} more than were tried", name(series)),
                }
            })
        });
        format!(
            "For a final velocity to {target:.0e}, right-hand sides a collision: {}.",
            costs.collect::<Vec<_>>().join("; ")
        )
    }

    /// A pair as `collide` uses it.
    fn usual_accuracy(&self, pair: usize) -> String {
        let errors = self.accuracies.iter().map(|accuracy| accuracy.pairs[pair]);
        let eps_t = self
            .accuracies
            .iter()
            .map(|accuracy| accuracy.pairs[pair].velocity / accuracy.reference.contact.psi());
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let others = errors.clone().filter(|errors| errors.switch_time.is_none()).count();
        let tolerance = engine(MethodPair::BOTH[pair]).tolerances().map_or(0.0, |t| t.rtol);
        format!(
            "`collide --method {}`, tolerance {tolerance:e}: largest error of ε_t {:.1e}, of the final \
             velocity {:.1e}, of a switch time {:.1e}; {others} of {} collisions with other switches.",
            MethodPair::BOTH[pair].name(),
            largest(&mut eps_t.into_iter()),
            largest(&mut errors.clone().map(|errors| errors.velocity)),
            largest(&mut errors.filter_map(|errors| errors.switch_time)),
            self.accuracies.len()
        )
    }

    /// The series of both pairs.
    fn both(&self, control: Control, switches: Switches, variables: Coordinates) -> [&Series; 2] {
        let of = |pair| {
            let scheme = Scheme { pair, coordinates: variables, switches, control };
            // All schemes are measured.
            self.series.iter().find(|series| series.scheme == scheme).unwrap()
        };
        MethodPair::BOTH.map(of)
    }
}

fn name(series: &Series) -> String {
    let [pair, coordinates, _] = series.scheme.names();
    format!("{pair} {coordinates}")
}

fn order(order: Option<&Order>) -> String {
    match order {
        Some(Order { order, standard_error, drift, coarsest, finest, .. }) => format!(
            "{order:.3} ± {standard_error:.3} (steps {coarsest:.2e} to {finest:.2e}, drift {drift:+.2})"
        ),
        None => "without a range to fit".to_owned(),
    }
}
