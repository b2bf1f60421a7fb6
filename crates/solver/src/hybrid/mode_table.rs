//! Modes that cannot be copied, by number.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, PoisonError, RwLock};

/// The number of a mode in a [`ModeTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ModeNumber(usize);

/// Modes of a type that cannot be copied, such as a `Vec<bool>`, and their numbers, which can.
///
/// The mode of a system is copied on every step. A system whose modes are larger keeps them in a
/// table, and its mode is a number. Equal modes have one number. Numbers come in the order in which
/// modes are first asked for, so they may differ between runs; modes do not. Each new mode stays in
/// the table until it is dropped.
///
/// ```
/// use stickslip_solver::dynamic::{DynamicStart, DynamicSystem, run_dynamic};
/// use stickslip_solver::{Direction, Dop853, Guard, Options, hybrid::{ModeNumber, ModeTable}};
///
/// /// Rooms of which each has a heater, which is on or off.
/// struct Rooms {
///     heaters: ModeTable<Vec<bool>>,
///     guards: Vec<Guard>,
/// }
///
/// impl Rooms {
///     fn on(&self, mode: ModeNumber) -> std::sync::Arc<Vec<bool>> {
///         self.heaters.get(mode).expect("a number of this table")
///     }
/// }
///
/// impl DynamicSystem for Rooms {
///     type Mode = ModeNumber;
///
///     fn field(&self, mode: ModeNumber, _s: f64, y: &[f64], slope: &mut [f64]) {
///         for ((slope, y), on) in slope.iter_mut().zip(y).zip(&*self.on(mode)) {
///             *slope = if *on { 30.0 - y } else { 10.0 - y };
///         }
///     }
///     fn guards(&self, _mode: ModeNumber) -> &[Guard] {
///         &self.guards
///     }
///     fn guard_values(&self, mode: ModeNumber, _s: f64, y: &[f64], values: &mut [f64]) {
///         for ((value, y), on) in values.iter_mut().zip(y).zip(&*self.on(mode)) {
///             *value = if *on { 21.0 - y } else { y - 19.0 };
///         }
///     }
///     fn transition(&self, mode: ModeNumber, room: usize, _s: f64, _y: &mut [f64]) -> ModeNumber {
///         let mut heaters = self.on(mode).to_vec();
///         heaters[room] = !heaters[room];
///         self.heaters.number(heaters)
///     }
/// }
///
/// let guards = vec![Guard::new(Direction::Below); 3];
/// let rooms = Rooms { heaters: ModeTable::default(), guards };
/// let mode = rooms.heaters.number(vec![true, false, true]);
/// let start = DynamicStart { mode, s: 0.0, state: &[20.0, 20.0, 20.5] };
/// let end = run_dynamic(Dop853, &rooms, start, 0.1, &Options::default(), &mut ())?.finished()?;
/// // The warmest room has arrived at 21 degrees after ln (9.5/9) = 0.054.
/// assert_eq!(*rooms.on(end.mode), [true, false, false]);
/// # Ok::<(), stickslip_solver::RunError>(())
/// ```
#[derive(Debug)]
pub struct ModeTable<M>(RwLock<Numbered<M>>);

#[derive(Debug)]
struct Numbered<M> {
    modes: Vec<Arc<M>>,
    numbers: HashMap<Arc<M>, ModeNumber>,
}

impl<M> Default for ModeTable<M> {
    fn default() -> Self {
        Self(RwLock::new(Numbered { modes: Vec::new(), numbers: HashMap::new() }))
    }
}

impl<M: Eq + Hash> ModeTable<M> {
    /// The number of a mode.
    pub fn number(&self, mode: M) -> ModeNumber {
        // A table is valid after each of its lines, so a thread that panicked leaves it valid.
        let Numbered { modes, numbers } =
            &mut *self.0.write().unwrap_or_else(PoisonError::into_inner);
        let mode = Arc::new(mode);
        *numbers.entry(mode).or_insert_with_key(|mode| {
            modes.push(Arc::clone(mode));
            ModeNumber(modes.len() - 1)
        })
    }

    /// The mode of a number, or `None` if the number comes from another table that has more modes.
    #[must_use]
    pub fn get(&self, number: ModeNumber) -> Option<Arc<M>> {
        let table = self.0.read().unwrap_or_else(PoisonError::into_inner);
        table.modes.get(number.0).cloned()
    }
}
