//! The study as tables.

use stickslip_solver::EmbeddedPair;

use super::Convergence;
use super::measure::Errors;
use super::series::{Control, ErrorRow, ErrorSeries, SeriesScheme};
use crate::study::{Cell, StudyColumn, StudyTable};

/// The table of fitted orders.
pub const ORDERS: &str = "convergence_orders";
/// The table of measured times, the only one that differs from run to run.
pub const TIMES: &str = "convergence_time";

impl Convergence {
    pub(super) fn tables(&self) -> Vec<StudyTable> {
        vec![
            self.orders(),
            self.errors(Control::Step),
            self.errors(Control::Tolerance),
            self.collisions(),
            self.times(),
        ]
    }

    fn of(&self, control: Control) -> impl Iterator<Item = &ErrorSeries> {
        self.series.iter().filter(move |series| series.scheme.control == control)
    }

    fn orders(&self) -> StudyTable {
        let mut rows = Vec::new();
        for series in &self.series {
            let orders =
                [("final velocity", series.velocity), ("switch times", series.switch_time)];
            for (quantity, order) in orders {
                let Some(order) = order else { continue };
                let mut row = scheme(series.scheme);
                row.extend([series.scheme.control.name(), quantity].map(Cell::from));
                row.extend([order.order, order.standard_error, order.drift].map(Cell::Number));
                row.extend([order.coarsest, order.finest].map(Cell::Number));
                row.push(order.points.into());
                rows.push(row);
            }
        }
        StudyTable {
            name: ORDERS,
            title: "Fitted orders".to_owned(),
            columns: [&SCHEME[..], &FITTED].concat(),
            rows,
        }
    }

    fn errors(&self, control: Control) -> StudyTable {
        let (name, value, title) = match control {
            Control::Step => (
                "convergence_steps",
                StudyColumn::new(
                    "step",
                    "of s in regularised coordinates, of scaled time in plain time",
                ),
                "Errors and work in fixed steps",
            ),
            Control::Tolerance => (
                "convergence_tolerances",
                StudyColumn::new("tolerance", "relative and absolute"),
                "Errors and work at tolerances",
            ),
        };
        let rows = self.of(control).flat_map(|series| {
            series.rows.iter().map(|ErrorRow { value, errors, .. }| {
                let Errors { failed, other_switches, velocity, switch_time, .. } = errors;
                let mut row = scheme(series.scheme);
                row.push(Cell::Number(*value));
                row.extend([*failed, *other_switches].map(Cell::Count));
                for spread in [velocity, switch_time] {
                    row.extend([spread.root_mean_square, spread.largest].map(Cell::Number));
                }
                row.push(Cell::Number(self.work(errors)));
                row
            })
        });
        StudyTable {
            name,
            title: title.to_owned(),
            columns: [&SCHEME[..], &[value], &ERRORS].concat(),
            rows: rows.collect(),
        }
    }

    /// Evaluations of the right-hand side for each collision that was integrated.
    pub fn work(&self, errors: &Errors) -> f64 {
        errors.right_hand_sides as f64 / (self.references.len() - errors.failed) as f64
    }

    fn collisions(&self) -> StudyTable {
        let rows = self.accuracies.iter().flat_map(|accuracy| {
            let collision = &accuracy.reference;
            EmbeddedPair::ALL.iter().zip(&accuracy.pairs).map(move |(pair, errors)| {
                let contact = &collision.contact;
                let numbers =
                    [contact.kappa(), contact.psi(), contact.damping(), collision.eps_t()];
                let mut row: Vec<_> = numbers.map(Cell::Number).into();
                row.push(collision.switches.len().into());
                row.push(collision.itinerary().into());
                row.push(pair.name().into());
                let time = errors.switch_time.unwrap_or(f64::NAN);
                row.extend([errors.eps_t, errors.velocity, time].map(Cell::Number));
                row.push(errors.right_hand_sides.into());
                row
            })
        });
        StudyTable {
            name: "convergence_collisions",
            title: "Each collision as `collide` computes it".to_owned(),
            columns: COLLISIONS.to_vec(),
            rows: rows.collect(),
        }
    }

    fn times(&self) -> StudyTable {
        let rows = self.series.iter().flat_map(|series| {
            series.rows.iter().map(|row| {
                let mut cells = scheme(series.scheme);
                cells.push(series.scheme.control.name().into());
                let error = row.errors.velocity.root_mean_square;
                cells.extend([row.value, error, row.microseconds].map(Cell::Number));
                cells
            })
        });
        StudyTable {
            name: TIMES,
            title: "Measured times, not the same in another run".to_owned(),
            columns: [&SCHEME[..], &MEASURED_TIME].concat(),
            rows: rows.collect(),
        }
    }
}

/// The columns of [`scheme`].
const SCHEME: [StudyColumn; 3] = [
    StudyColumn::headed("method", "method", "Dormand–Prince pair"),
    StudyColumn::headed(
        "coordinates",
        "coordinates",
        "coordinates in which the equations are integrated",
    ),
    StudyColumn::headed(
        "switches",
        "switches",
        "located, or taking effect where steps happen to end",
    ),
];

fn scheme(scheme: SeriesScheme) -> Vec<Cell> {
    scheme.names().map(Cell::from).into()
}

const FITTED: [StudyColumn; 8] = [
    StudyColumn::headed("control", "made finer", "what is made finer: the step, or the tolerance"),
    StudyColumn::headed(
        "quantity",
        "error of",
        "the quantity whose root mean square error is fitted",
    ),
    StudyColumn::headed("order", "order", "slope of ln error against ln step or ln tolerance"),
    StudyColumn::headed(
        "standard_error",
        "std. error",
        "standard error of the order, from the scatter about the line",
    ),
    StudyColumn::headed(
        "drift",
        "drift",
        "order over the finer half of the points minus that over the coarser half",
    ),
    StudyColumn::headed(
        "coarsest",
        "coarsest",
        "step in s or t, or tolerance, at which the fit begins",
    ),
    StudyColumn::headed("finest", "finest", "step in s or t, or tolerance, at which the fit ends"),
    StudyColumn::headed("points", "points", "number of fitted points"),
];

const ERRORS: [StudyColumn; 7] = [
    StudyColumn::new("failed", "collisions that could not be integrated"),
    StudyColumn::new("other_switches", "collisions with other switches than the reference"),
    StudyColumn::new("velocity_error", "root mean square error of the final reduced velocity w"),
    StudyColumn::new("velocity_error_largest", "largest error of the final reduced velocity w"),
    StudyColumn::new("switch_time_error", "root mean square error of switch times, in scaled time"),
    StudyColumn::new("switch_time_error_largest", "largest error of a switch time"),
    StudyColumn::new("right_hand_sides", "evaluations of the right-hand side per collision"),
];

const COLLISIONS: [StudyColumn; 11] = [
    StudyColumn::new("kappa", "scaled stiffness"),
    StudyColumn::new("psi", "reduced impact ratio"),
    StudyColumn::new("damping", "scaled damping"),
    StudyColumn::new("eps_t", "tangential restitution"),
    StudyColumn::new("switch_count", "number of switches"),
    StudyColumn::new("itinerary", "the phases, one character for each"),
    StudyColumn::new("method", "Dormand–Prince pair at its usual tolerance"),
    StudyColumn::new("eps_t_error", "error of the tangential restitution"),
    StudyColumn::new("velocity_error", "error of the final reduced velocity w"),
    StudyColumn::new(
        "switch_time_error",
        "largest error of a switch time; empty if the switches are others",
    ),
    StudyColumn::new("right_hand_sides", "evaluations of the right-hand side"),
];

const MEASURED_TIME: [StudyColumn; 4] = [
    StudyColumn::new("control", "what is made finer: the step, or the tolerance"),
    StudyColumn::new("value", "the step or the tolerance"),
    StudyColumn::new("velocity_error", "root mean square error of the final reduced velocity w"),
    StudyColumn::new(
        "microseconds",
        "measured time per collision in µs; not the same in another run",
    ),
];
