//! The study as tables.

use stickslip_solver::EmbeddedPair;

use super::Convergence;
use super::measure::Errors;
use super::series::{Control, ErrorRow, ErrorSeries, Scheme};
use crate::study::{Cell, Column, Table};

/// The table of fitted orders.
pub const ORDERS: &str = "convergence_orders";
/// The table of measured times, the only one that differs from run to run.
pub const TIMES: &str = "convergence_time";

impl Convergence {
    pub(super) fn tables(&self) -> Vec<Table> {
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

    fn orders(&self) -> Table {
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
        Table {
            name: ORDERS,
            title: "Fitted orders".to_owned(),
            columns: [&SCHEME[..], &FITTED].concat(),
            rows,
        }
    }

    fn errors(&self, control: Control) -> Table {
        let (name, value, title) = match control {
            Control::Step => (
                "convergence_steps",
                Column::new(
                    "step",
                    "of s in regularised coordinates, of scaled time in plain time",
                ),
                "Errors and work in fixed steps",
            ),
            Control::Tolerance => (
                "convergence_tolerances",
                Column::new("tolerance", "relative and absolute"),
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
        Table {
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

    fn collisions(&self) -> Table {
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
        Table {
            name: "convergence_collisions",
            title: "Each collision as `collide` computes it".to_owned(),
            columns: COLLISIONS.to_vec(),
            rows: rows.collect(),
        }
    }

    fn times(&self) -> Table {
        let rows = self.series.iter().flat_map(|series| {
            series.rows.iter().map(|row| {
                let mut cells = scheme(series.scheme);
                cells.push(series.scheme.control.name().into());
                let error = row.errors.velocity.root_mean_square;
                cells.extend([row.value, error, row.microseconds].map(Cell::Number));
                cells
            })
        });
        Table {
            name: TIMES,
            title: "Measured times, not the same in another run".to_owned(),
            columns: [&SCHEME[..], &MEASURED_TIME].concat(),
            rows: rows.collect(),
        }
    }
}

/// The columns of [`scheme`].
const SCHEME: [Column; 3] = [
    Column::headed("method", "method", "Dormand–Prince pair"),
    Column::headed(
        "coordinates",
        "coordinates",
        "coordinates in which the equations are integrated",
    ),
    Column::headed("switches", "switches", "located, or taking effect where steps happen to end"),
];

fn scheme(scheme: Scheme) -> Vec<Cell> {
    scheme.names().map(Cell::from).into()
}

const FITTED: [Column; 8] = [
    Column::headed("control", "made finer", "what is made finer: the step, or the tolerance"),
    Column::headed("quantity", "error of", "the quantity whose root mean square error is fitted"),
    Column::headed("order", "order", "slope of ln error against ln step or ln tolerance"),
    Column::headed(
        "standard_error",
        "std. error",
        "standard error of the order, from the scatter about the line",
    ),
    Column::headed(
        "drift",
        "drift",
        "order over the finer half of the points minus that over the coarser half",
    ),
    Column::headed("coarsest", "coarsest", "step in s or t, or tolerance, at which the fit begins"),
    Column::headed("finest", "finest", "step in s or t, or tolerance, at which the fit ends"),
    Column::headed("points", "points", "number of fitted points"),
];

const ERRORS: [Column; 7] = [
    Column::new("failed", "collisions that could not be integrated"),
    Column::new("other_switches", "collisions with other switches than the reference"),
    Column::new("velocity_error", "root mean square error of the final reduced velocity w"),
    Column::new("velocity_error_largest", "largest error of the final reduced velocity w"),
    Column::new("switch_time_error", "root mean square error of switch times, in scaled time"),
    Column::new("switch_time_error_largest", "largest error of a switch time"),
    Column::new("right_hand_sides", "evaluations of the right-hand side per collision"),
];

const COLLISIONS: [Column; 11] = [
    Column::new("kappa", "scaled stiffness"),
    Column::new("psi", "reduced impact ratio"),
    Column::new("damping", "scaled damping"),
    Column::new("eps_t", "tangential restitution"),
    Column::new("switch_count", "number of switches"),
    Column::new("itinerary", "the phases, one character for each"),
    Column::new("method", "Dormand–Prince pair at its usual tolerance"),
    Column::new("eps_t_error", "error of the tangential restitution"),
    Column::new("velocity_error", "error of the final reduced velocity w"),
    Column::new(
        "switch_time_error",
        "largest error of a switch time; empty if the switches are others",
    ),
    Column::new("right_hand_sides", "evaluations of the right-hand side"),
];

const MEASURED_TIME: [Column; 4] = [
    Column::new("control", "what is made finer: the step, or the tolerance"),
    Column::new("value", "the step or the tolerance"),
    Column::new("velocity_error", "root mean square error of the final reduced velocity w"),
    Column::new("microseconds", "measured time per collision in µs; not the same in another run"),
];
