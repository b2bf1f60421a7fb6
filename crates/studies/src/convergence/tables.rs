//! The study as tables.

use super::measure::Errors;
use stickslip_solver::Order;

use super::Measurement;
use super::series::{Control, MethodPair, Row, Scheme, Series};
use crate::study::{Cell, Column, Table};

/// The table of fitted orders.
pub const ORDERS: &str = "convergence_orders";
/// The table of measured times, the only one that differs from run to run.
pub const TIMES: &str = "convergence_time";

impl Measurement {
    pub fn tables(&self) -> Vec<Table> {
        vec![
            self.orders(),
            self.errors(Control::Step),
            self.errors(Control::Tolerance),
            self.collisions(),
            self.times(),
        ]
    }

    fn of(&self, control: Control) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(move |series| series.scheme.control == control)
    }

    fn orders(&self) -> Table {
        let rows = self.series.iter().flat_map(|series| {
            let of = |quantity: &str, order: &Option<Order>| {
                order.map(|order| {
                    let mut row = scheme(series.scheme);
                    row.push(Cell::Text(series.scheme.control.name().to_owned()));
                    row.push(Cell::Text(quantity.to_owned()));
                    row.extend([order.order, order.standard_error, order.drift].map(Cell::Number));
                    row.extend([order.coarsest, order.finest].map(Cell::Number));
                    row.push(Cell::Count(order.points as u64));
                    row
                })
            };
            [of("final velocity", &series.velocity), of("switch times", &series.switch_time)]
        });
        let columns = [
            ("control", "what is made finer: the step, or the tolerance"),
            ("quantity", "whose root mean square error is fitted"),
            ("order", "slope of ln error against ln step or ln tolerance"),
            ("standard_error", "of the order, from the scatter about the line"),
            ("drift", "order over the finer half of the points less that over the coarser half"),
            ("coarsest", "step in s or t, or tolerance, at which the fit begins"),
            ("finest", "where it ends"),
            ("points", "how many are fitted"),
        ];
        Table {
            name: ORDERS,
            title: "Fitted orders".to_owned(),
            columns: with_scheme(&columns),
            rows: rows.flatten().collect(),
        }
    }

    fn errors(&self, control: Control) -> Table {
        let (name, value, title) = match control {
            Control::Step => (
                "convergence_steps",
                ("step", "of s in regularised coordinates, of scaled time in plain time"),
                "Errors and work in fixed steps",
            ),
            Control::Tolerance => (
                "convergence_tolerances",
                ("tolerance", "relative and absolute"),
                "Errors and work at tolerances",
            ),
        };
        let columns = [
            value,
            ("failed", "collisions that could not be integrated"),
            ("other_switches", "collisions with other switches than the reference"),
            ("velocity_error", "root mean square error of the final reduced velocity w"),
            ("velocity_error_largest", "the largest"),
            ("switch_time_error", "root mean square error of switch times, in scaled time"),
            ("switch_time_error_largest", "the largest"),
            ("right_hand_sides", "evaluations of the right-hand side a collision"),
        ];
        let rows = self.of(control).flat_map(|series| {
            series.rows.iter().map(|Row { value, errors, .. }| {
                let Errors { failed, other_switches, velocity, switch_time, .. } = errors;
                let mut row = scheme(series.scheme);
                row.push(Cell::Number(*value));
                row.extend([*failed, *other_switches].map(|count| Cell::Count(count as u64)));
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
            columns: with_scheme(&columns),
            rows: rows.collect(),
        }
    }

    /// Evaluations of the right-hand side for each collision that was integrated.
    pub fn work(&self, errors: &Errors) -> f64 {
        errors.right_hand_sides as f64 / (self.references.len() - errors.failed) as f64
    }

    fn collisions(&self) -> Table {
        let columns = [
            ("kappa", "scaled stiffness"),
            ("psi", "reduced impact ratio"),
            ("damping", "scaled damping"),
            ("eps_t", "tangential restitution"),
            ("switch_count", "number of switches"),
            ("itinerary", "one character a phase"),
            ("method", "Dormand–Prince pair at its usual tolerance"),
            ("eps_t_error", "error of the tangential restitution"),
            ("velocity_error", "error of the final reduced velocity w"),
            (
                "switch_time_error",
                "largest error of a switch time; empty if the switches are others",
            ),
            ("right_hand_sides", "evaluations of the right-hand side"),
        ];
        let rows = self.accuracies.iter().flat_map(|accuracy| {
            let (collision, psi) = (&accuracy.reference, accuracy.reference.contact.psi());
            MethodPair::BOTH.iter().zip(&accuracy.pairs).map(move |(pair, errors)| {
                let contact = &collision.contact;
                let numbers = [contact.kappa(), psi, contact.damping(), collision.eps_t()];
                let mut row: Vec<_> = numbers.map(Cell::Number).into();
                row.push(Cell::Count(collision.switches.len() as u64));
                row.push(Cell::Text(collision.itinerary()));
                row.push(Cell::Text(pair.name().to_owned()));
                let time = errors.switch_time.unwrap_or(f64::NAN);
                row.extend([errors.velocity / psi, errors.velocity, time].map(Cell::Number));
                row.push(Cell::Count(errors.right_hand_sides as u64));
                row
            })
        });
        Table {
            name: "convergence_collisions",
            title: "Each collision as `collide` computes it".to_owned(),
            columns: columns.map(column).into(),
            rows: rows.collect(),
        }
    }

    fn times(&self) -> Table {
        let columns = [
            ("control", "what is made finer"),
            ("value", "the step or the tolerance"),
            ("velocity_error", "root mean square error of the final reduced velocity w"),
            ("microseconds", "measured time a collision in µs; not the same in another run"),
        ];
        let rows = self.series.iter().flat_map(|series| {
            series.rows.iter().map(|row| {
                let mut cells = scheme(series.scheme);
                cells.push(Cell::Text(series.scheme.control.name().to_owned()));
                let error = row.errors.velocity.root_mean_square;
                cells.extend([row.value, error, row.microseconds].map(Cell::Number));
                cells
            })
        });
        Table {
            name: TIMES,
            title: "Measured times, not the same in another run".to_owned(),
            columns: with_scheme(&columns),
            rows: rows.collect(),
        }
    }
}

fn column((name, meaning): (&'static str, &'static str)) -> Column {
    Column { name, meaning }
}

fn with_scheme(columns: &[(&'static str, &'static str)]) -> Vec<Column> {
    let scheme = [
        ("method", "Dormand–Prince pair"),
        ("coordinates", "in which the equations are integrated"),
        ("switches", "located, or taking effect where steps happen to end"),
    ];
    scheme.iter().chain(columns).copied().map(column).collect()
}

fn scheme(scheme: Scheme) -> Vec<Cell> {
    scheme.names().map(|name| Cell::Text(name.to_owned())).into()
}
