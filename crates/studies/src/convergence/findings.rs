//! What the measurements say, in sentences with their numbers.

use stickslip_solver::EmbeddedPair;
use stickslip_solver::method::Order;

use super::Convergence;
use super::collisions::engine;
use super::measure::Formulation;
use super::series::{Control, ErrorRow, ErrorSeries, SeriesScheme, SwitchHandling, fitted};

/// Accuracies whose work is reported.
const TARGETS: [f64; 2] = [1e-6, 1e-10];
/// Steps in a contact that a simulation of many particles may afford.
const FEW_STEPS: f64 = 50.0;
/// A method keeps its order if the fitted order is closer to it than this.
const KEPT: f64 = 0.5;

impl Convergence {
    pub(super) fn findings(&self) -> Vec<String> {
        let mut findings = vec![self.result(), self.measured()];
        for switches in [SwitchHandling::Located, SwitchHandling::AtStepEnds] {
            for coordinates in [Formulation::Regularized, Formulation::PlainTime] {
                findings.push(self.orders_in(switches, coordinates));
            }
        }
        findings.extend(self.few_steps());
        findings.push(self.tolerances());
        findings.extend(TARGETS.map(|target| self.cost(target)));
        findings.extend([0, 1].map(|pair| self.usual_accuracy(pair)));
        findings
    }

    /// The main result.
    pub(super) fn result(&self) -> String {
        let smooth = (Control::Step, SwitchHandling::Located, Formulation::Regularized);
        let fitted = self.both(smooth.0, smooth.1, smooth.2).map(|series| series.velocity);
        let [Some(dopri5), Some(dop853)] = fitted else {
            return "There is no range of steps over which an order can be fitted.".to_owned();
        };
        let orders = EmbeddedPair::ALL.map(EmbeddedPair::order);
        let kept = [dopri5, dop853]
            .iter()
            .zip(orders)
            .all(|(fitted, order)| (fitted.order - order as f64).abs() < KEPT);
        let [five, eight] = orders;
        let located = format!(
            "With switches located, in regularised coordinates, both methods {} their orders, {five} \
             and {eight} (fitted: {:.3} and {:.3})",
            if kept { "keep" } else { "do not quite keep" },
            dopri5.order,
            dop853.order
        );
        let over = [Formulation::Regularized, Formulation::PlainTime]
            .map(|coordinates| self.both(Control::Step, SwitchHandling::AtStepEnds, coordinates));
        let over = over.as_flattened().iter();
        let over = over.flat_map(|series| [series.velocity, series.switch_time]).flatten();
        let range = over.map(|fit| fit.order).fold(None, |range: Option<(f64, f64)>, order| {
            let (low, high) = range.unwrap_or((order, order));
            Some((low.min(order), high.max(order)))
        });
        match range {
            Some((low, high)) => format!(
                "{located}; steps that run over switches leave order {low:.0} to {high:.0} for any \
                 method (fitted: {low:.2} to {high:.2})."
            ),
            None => format!("{located}."),
        }
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
        let error = |row: &ErrorRow| row.errors.velocity.root_mean_square;
        let [_, dop853] =
            self.both(Control::Step, SwitchHandling::Located, Formulation::Regularized);
        let rows = dop853.rows.iter().filter(|row| row.errors.comparable());
        let closest = rows.min_by(|a, b| error(a).total_cmp(&error(b)));
        match closest {
            Some(ErrorRow { value, errors, .. }) if self.is_damped() => format!(
                ", from which dop853 in fixed steps of {value:.4} differs by {:.1e} in the final \
                 velocity and {:.1e} in switch times",
                errors.velocity.root_mean_square, errors.switch_time.root_mean_square
            ),
            _ => String::new(),
        }
    }

    /// Both pairs in fixed steps.
    fn orders_in(&self, switches: SwitchHandling, coordinates: Formulation) -> String {
        let ways = match switches {
            SwitchHandling::Located => "with switches located",
            SwitchHandling::AtStepEnds => "with steps that run over switches",
        };
        let fitted = self.both(Control::Step, switches, coordinates).map(|series| {
            format!(
                "{} {} in the final velocity and {} in switch times",
                series.scheme.pair.name(),
                order(series.velocity.as_ref()),
                order(series.switch_time.as_ref())
            )
        });
        let expected = match (switches, coordinates) {
            (SwitchHandling::Located, Formulation::Regularized) => {
                "The methods have orders 5 and 8: everything is smooth between switches, and steps \
                 end at switches"
            }
            (SwitchHandling::Located, Formulation::PlainTime) if self.is_damped() => {
                "Both are expected to have order 3/2 once steps are shorter than the stick phase with \
                 which contact starts: the force grows as √t there, and the first step errs by \
                 h^(3/2)"
            }
            (SwitchHandling::Located, Formulation::PlainTime) => {
                "Both are expected to have order 5/2: the force x^(3/2) goes as t^(3/2) at both ends \
                 of contact, and steps there err by h^(5/2)"
            }
            (SwitchHandling::AtStepEnds, _) => {
                "No method is expected to have more than 2 and 1: a switch takes effect up to a step \
                 h late, and the force, which is continuous there, is then wrong by O(h) for a time \
                 O(h)"
            }
        };
        format!(
            "In {} {ways} the fitted orders are: {}. {expected}.",
            match coordinates {
                Formulation::Regularized => "regularised coordinates",
                Formulation::PlainTime => "plain time",
            },
            fitted.join("; "),
        )
    }

    /// Steps over switches that are not very short.
    fn few_steps(&self) -> Option<String> {
        let contact_time = self.references.first()?.contact_time;
        let [_, series] =
            self.both(Control::Step, SwitchHandling::AtStepEnds, Formulation::PlainTime);
        let ErrorRow { value, errors, .. } =
            series.rows.iter().find(|row| row.value <= contact_time / FEW_STEPS)?;
        Some(format!(
            "With {:.0} steps of {} per contact that run over switches in plain time, {} of {} \
             collisions have other switches than they should. The final velocity is off by {:.1e}, \
             and by {:.1e} at worst.",
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
        let all = [Formulation::Regularized, Formulation::PlainTime].map(|coordinates| {
            self.both(Control::Tolerance, SwitchHandling::Located, coordinates).map(|series| {
                let Some(fit) = series.velocity else {
                    return format!("{} without a range to fit", name(series));
                };
                let range = fitted(&fit);
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
        format!(
            "In adaptive steps at a tolerance the final velocity is off by: {}.",
            all.as_flattened().join("; ")
        )
    }

    /// Work for an accuracy.
    fn cost(&self, target: f64) -> String {
        let ways = [
            (Control::Tolerance, SwitchHandling::Located, Formulation::Regularized),
            (Control::Tolerance, SwitchHandling::Located, Formulation::PlainTime),
            (Control::Step, SwitchHandling::AtStepEnds, Formulation::PlainTime),
        ];
        let costs = ways.map(|(control, switches, coordinates)| {
            self.both(control, switches, coordinates).map(|series| {
                let enough = series.rows.iter().filter(|row| {
                    row.errors.comparable() && row.errors.velocity.root_mean_square <= target
                });
                let least = enough.map(|row| self.work(&row.errors)).min_by(f64::total_cmp);
                let over = match switches {
                    SwitchHandling::Located => "",
                    SwitchHandling::AtStepEnds => " over switches",
                };
                match least {
                    Some(work) => format!("{}{over} {work:.0}", name(series)),
                    None => format!("{}{over} more than were tried", name(series)),
                }
            })
        });
        format!(
            "A final velocity to {target:.0e} takes so many evaluations of the right-hand side per \
             collision: {}.",
            costs.as_flattened().join("; ")
        )
    }

    /// A pair as `collide` uses it.
    fn usual_accuracy(&self, pair: usize) -> String {
        let errors = || self.accuracies.iter().map(|accuracy| accuracy.pairs[pair]);
        let eps_t = errors().map(|errors| errors.eps_t).fold(0.0, f64::max);
        let velocity = errors().map(|errors| errors.velocity).fold(0.0, f64::max);
        let switch_time = errors().filter_map(|errors| errors.switch_time).fold(0.0, f64::max);
        let others = errors().filter(|errors| errors.switch_time.is_none()).count();
        let tolerance = engine(EmbeddedPair::ALL[pair]).tolerances().map_or(0.0, |t| t.rtol);
        format!(
            "The largest errors of `collide --method {}`, tolerance {tolerance:e}, are {eps_t:.1e} in \
             ε_t, {velocity:.1e} in the final velocity and {switch_time:.1e} in a switch time; \
             {others} of {} collisions have other switches.",
            EmbeddedPair::ALL[pair].name(),
            self.accuracies.len()
        )
    }

    /// The series of both pairs.
    fn both(
        &self,
        control: Control,
        switches: SwitchHandling,
        coordinates: Formulation,
    ) -> [&ErrorSeries; 2] {
        EmbeddedPair::ALL.map(|pair| {
            let scheme = SeriesScheme { pair, coordinates, switches, control };
            // All schemes are measured.
            self.series.iter().find(|series| series.scheme == scheme).unwrap()
        })
    }
}

fn name(series: &ErrorSeries) -> String {
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
