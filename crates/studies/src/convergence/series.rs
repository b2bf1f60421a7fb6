//! The errors of each way to integrate, over steps or tolerances.

use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use stickslip_model::Collision;
use stickslip_solver::method::{Order, fit_order};
use stickslip_solver::{EmbeddedPair, Options, StepSize};

use super::measure::{Errors, Formulation, LocationSettings, Spread, measure};

/// Steps in an octave.
const PER_OCTAVE: i32 = 4;
/// Tolerances in a decade.
const PER_DECADE: i32 = 4;
/// The coarsest step for collisions up to a stiffness of 64. For stiffer collisions it is shorter,
/// so that about as many steps fit into a swing.
const COARSEST: f64 = 0.25;
/// The time after which a contact has failed, because steps are too coarse for its end. Without
/// damping a contact lasts 3.22 in scaled time and 2.62 in s, and less with damping.
const LONGEST: f64 = 16.0;
/// Steps after which a contact in adaptive steps has failed, for collisions up to a stiffness of
/// 64; they take up to 2500.
const MOST_STEPS: f64 = 20_000.0;
/// Quick measurements are repeated for this long, at most three times; the shortest time counts.
const QUICK: Duration = Duration::from_millis(5);

/// Whether switches are located, which ends steps there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SwitchHandling {
    /// A switch ends the step in which it is.
    Located,
    /// A switch takes effect where a step happens to end.
    AtStepEnds,
}

/// What decides how fine the steps are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// The size of the steps.
    Step,
    /// The tolerance of a step.
    Tolerance,
}

/// A way to integrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeriesScheme {
    /// The method.
    pub pair: EmbeddedPair,
    /// The variables.
    pub coordinates: Formulation,
    /// What happens to switches.
    pub switches: SwitchHandling,
    /// What decides how fine the steps are.
    pub control: Control,
}

/// The errors of a scheme at one step or tolerance.
#[derive(Clone, Copy, Debug)]
pub struct ErrorRow {
    /// The step, in s or t, or the tolerance, relative and absolute.
    pub value: f64,
    /// The errors over all collisions.
    pub errors: Errors,
    /// The measured time per collision.
    pub microseconds: f64,
}

/// The steps or tolerances to which `order` was fitted.
pub fn fitted(order: &Order) -> RangeInclusive<f64> {
    order.finest * (1.0 - 1e-9)..=order.coarsest * (1.0 + 1e-9)
}

/// The errors of a scheme from coarse to fine.
#[derive(Clone, Debug)]
pub struct ErrorSeries {
    /// The way to integrate.
    pub scheme: SeriesScheme,
    /// The errors at each step or tolerance.
    pub rows: Vec<ErrorRow>,
    /// The order of the error of the final velocity, where there is a range to fit.
    pub velocity: Option<Order>,
    /// The order of the error of switch times, where there is a range to fit.
    pub switch_time: Option<Order>,
}

impl Control {
    /// The name of what decides, as files have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Tolerance => "tolerance",
        }
    }
}

impl SeriesScheme {
    /// All schemes that are compared. Without located switches no error estimate could control the
    /// steps.
    pub(super) fn all() -> Vec<Self> {
        let ways = [
            (Control::Step, SwitchHandling::Located),
            (Control::Step, SwitchHandling::AtStepEnds),
            (Control::Tolerance, SwitchHandling::Located),
        ];
        let mut schemes = Vec::new();
        for (control, switches) in ways {
            for coordinates in [Formulation::Regularized, Formulation::PlainTime] {
                let pairs = EmbeddedPair::ALL;
                schemes.extend(pairs.map(|pair| Self { pair, coordinates, switches, control }));
            }
        }
        schemes
    }

    /// The names of the method, of the coordinates and of what happens to switches.
    pub fn names(self) -> [&'static str; 3] {
        let coordinates = match self.coordinates {
            Formulation::Regularized => "regularised",
            Formulation::PlainTime => "plain time",
        };
        let switches = match self.switches {
            SwitchHandling::Located => "located",
            SwitchHandling::AtStepEnds => "at step ends",
        };
        [self.pair.name(), coordinates, switches]
    }

    /// The steps or tolerances, from coarse to fine.
    pub(super) fn values(self, references: &[Collision]) -> Vec<f64> {
        if self.control == Control::Tolerance {
            let powers = PER_DECADE..=15 * PER_DECADE;
            return powers.map(|i| 0.1_f64.powf(f64::from(i) / f64::from(PER_DECADE))).collect();
        }
        let coarsest = coarsest(references);
        let at_rounding_early =
            (EmbeddedPair::Dop853, Formulation::Regularized, SwitchHandling::Located);
        let early = (self.pair, self.coordinates, self.switches) == at_rounding_early;
        let octaves = if early { 6 } else { 10 };
        (0..=octaves * PER_OCTAVE)
            .map(|i| coarsest * 0.5_f64.powf(f64::from(i) / f64::from(PER_OCTAVE)))
            .collect()
    }

    fn switching(self, value: f64, coarsest: f64) -> LocationSettings {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "up to 1e9")]
        let max_steps = match self.control {
            Control::Step => LONGEST / value,
            Control::Tolerance => MOST_STEPS * COARSEST / coarsest,
        } as usize;
        let options = Options { max_steps, ..Options::default() };
        match (self.switches, self.control) {
            (SwitchHandling::AtStepEnds, _) => {
                LocationSettings::AtStepEnds { step_size: value, max_steps }
            }
            (SwitchHandling::Located, Control::Step) => LocationSettings::Located {
                options: Options { step_size: StepSize::Fixed(value), ..options },
            },
            (SwitchHandling::Located, Control::Tolerance) => LocationSettings::Located {
                options: Options { rtol: value, atol: value, first_step: Some(0.1), ..options },
            },
        }
    }

    /// The least factor that the steps or tolerances of a fit span.
    fn span(self) -> f64 {
        match self.control {
            Control::Step => 4.0,
            Control::Tolerance => 1e3,
        }
    }
}

/// The coarsest step of a study of the collisions of `references`.
fn coarsest(references: &[Collision]) -> f64 {
    let stiffest = references.iter().fold(0.0, |most: f64, c| most.max(c.contact.kappa()));
    let mut coarsest = COARSEST;
    while coarsest * stiffest.sqrt() > 8.0 * COARSEST {
        coarsest *= 0.5;
    }
    coarsest
}

impl ErrorRow {
    pub(super) fn measure(scheme: SeriesScheme, value: f64, references: &[Collision]) -> Self {
        let switching = scheme.switching(value, coarsest(references));
        let once = || measure(scheme.pair, references, scheme.coordinates, &switching);
        let start = Instant::now();
        let errors = once();
        let mut shortest = start.elapsed();
        for _ in 1..3 {
            if start.elapsed() < QUICK {
                let again = Instant::now();
                once();
                shortest = shortest.min(again.elapsed());
            }
        }
        let microseconds = 1e6 * shortest.as_secs_f64() / references.len() as f64;
        Self { value, errors, microseconds }
    }

    fn json(&self, control: Control) -> Value {
        let Self { value, errors, .. } = self;
        json!({
            (control.name()): value,
            "failed": errors.failed,
            "other_switches": errors.other_switches,
            "velocity_error": errors.velocity,
            "switch_time_error": errors.switch_time,
            "right_hand_sides": errors.right_hand_sides,
        })
    }
}

impl ErrorSeries {
    pub(super) fn new(scheme: SeriesScheme, rows: Vec<ErrorRow>) -> Self {
        let fit = |error: fn(&Errors) -> Spread| {
            let errors = rows.iter().map(|ErrorRow { value, errors, .. }| {
                let error = error(errors).root_mean_square;
                (*value, if errors.comparable() { error } else { f64::NAN })
            });
            fit_order(&errors.collect::<Vec<_>>(), scheme.span())
        };
        let (velocity, switch_time) = (fit(|e| e.velocity), fit(|e| e.switch_time));
        Self { scheme, rows, velocity, switch_time }
    }

    pub(super) fn json(&self) -> Value {
        let order = |order: &Option<Order>| {
            order.map(|order| {
                json!({
                    "order": order.order,
                    "standard_error": order.standard_error,
                    "drift": order.drift,
                    "coarsest": order.coarsest,
                    "finest": order.finest,
                    "points": order.points,
                })
            })
        };
        let control = self.scheme.control;
        let [method, coordinates, switches] = self.scheme.names();
        json!({
            "method": method,
            "coordinates": coordinates,
            "switches": switches,
            "control": control.name(),
            "velocity_order": order(&self.velocity),
            "switch_time_order": order(&self.switch_time),
            "rows": self.rows.iter().map(|row| row.json(control)).collect::<Vec<_>>(),
        })
    }
}
