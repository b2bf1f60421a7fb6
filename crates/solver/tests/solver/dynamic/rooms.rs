//! Thermostats, of any number.

use stickslip_solver::dynamic::ReadableDynamic;
use stickslip_solver::{Direction, Guard, Number};

/// Rooms that are heated towards 3 below 1, and cool towards 0 above 2; temperatures, and then
/// whether they are heated.
pub struct Rooms {
    guards: Vec<Guard>,
    reads: Vec<usize>,
}

impl Rooms {
    /// `n` rooms.
    pub fn new(n: usize) -> Self {
        Self { guards: vec![Guard::new(Direction::Falling); 2 * n], reads: (0..n).collect() }
    }

    /// All of `n` rooms at 0 and heated.
    pub fn cold(n: usize) -> Vec<f64> {
        (0..2 * n).map(|i| if i < n { 0.0 } else { 1.0 }).collect()
    }
}

impl ReadableDynamic for Rooms {
    type Mode = ();

    fn field<T: Number>(&self, (): (), _: T, y: &[T], slope: &mut [T]) {
        let n = y.len() / 2;
        for room in 0..n {
            let rate = 1.0 + room as f64 / n as f64;
            slope[room] = (y[n + room] * 3.0 - y[room]) * rate;
            slope[n + room] = T::from(0.0);
        }
    }
    fn guards(&self, (): ()) -> &[Guard] {
        &self.guards
    }
    fn reads(&self, (): ()) -> &[usize] {
        &self.reads
    }
    fn guard_values<T: Number>(&self, (): (), _: T, y: &[T], values: &mut [T]) {
        let n = y.len() / 2;
        for room in 0..n {
            (values[room], values[n + room]) = (-y[room] + 2.0, y[room] - 1.0);
        }
    }
    fn transition(&self, (): (), guard: usize, _: f64, y: &mut [f64]) {
        let n = y.len() / 2;
        y[n + guard % n] = if guard < n { 0.0 } else { 1.0 };
    }
}
