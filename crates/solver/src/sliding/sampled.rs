//! Sliding systems whose functions cannot be read.

use std::fmt;
use std::sync::OnceLock;

use crate::dynamic::DynamicSystem;
use crate::hybrid::{Guard, HybridSystem, Schedule};
use crate::method::State;
use crate::sliding::control::{self, Row, View};
use crate::sliding::decision::{Cause, condition, decide};
use crate::sliding::sides::{Refusal, SlidingMode, SurfaceSide};
use crate::sliding::{MOST, cause_of, guards_of, start};

/// A system whose field depends on the signs of up to 4 surfaces, and whose functions are black
/// boxes. Its dimension is the length of its state.
///
/// With several surfaces the field has to be affine in the signs: a sum of parts that each depend
/// on one of them. This is checked wherever the solution reaches a surface.
pub trait SwitchedDynamic {
    /// A smooth regime of the system itself, besides its signs.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// The number of surfaces, at most 4.
    fn count(&self) -> usize;

    /// Writes the derivative of the state where the surfaces have these `signs`, each of them +1 or
    /// −1, to `slope`.
    fn field(&self, mode: Self::Mode, signs: &[f64], s: f64, y: &[f64], slope: &mut [f64]);

    /// Writes the functions whose zeros are the surfaces to `values`.
    fn surfaces(&self, mode: Self::Mode, s: f64, y: &[f64], values: &mut [f64]);

    /// Writes the rates of the surfaces' functions, where the state changes with this `slope`, to
    /// `rates`: ∂h/∂s + ∇h·slope.
    ///
    /// The provided version takes differences of fourth order over shorter and shorter times, and
    /// of these the one that differs least from the one before, as far as rounding allows. Where
    /// the functions are polynomials of a degree below 5, also in time, it evaluates them eight
    /// times, and else up to 36 times. With terms of size 1, the error is below 1e-10.
    fn rates(&self, mode: Self::Mode, s: f64, y: &[f64], slope: &[f64], rates: &mut [f64]) {
        let largest = |all: &[f64]| all.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        // A time in which state or time change by their own size.
        let time = (largest(y) / largest(slope)).max(s.abs());
        let mut reach = if time.is_finite() && time > 0.0 { time } else { 1.0 } / 64.0;
        let (mut moved, mut values) = (y.to_vec(), [0.0; MOST]);
        let mut before = [f64::INFINITY; MOST];
        let (mut least, mut most) = ([f64::INFINITY; MOST], [0.0_f64; MOST]);
        rates.fill(f64::NAN);
        for _ in 0..9 {
            let (mut now, mut terms) = ([0.0; MOST], [0.0_f64; MOST]);
            for (far, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
                let by = far * reach;
                for ((moved, y), slope) in moved.iter_mut().zip(y).zip(slope) {
                    *moved = y + by * slope;
                }
                self.surfaces(mode, s + by, &moved, &mut values[..rates.len()]);
                for (i, value) in values.iter().enumerate() {
                    now[i] += weight * value / (12.0 * reach);
                    terms[i] = terms[i].max(value.abs() / reach);
                    most[i] = most[i].max(value.abs());
                }
            }
            let mut settled = true;
            for (i, rate) in rates.iter_mut().enumerate() {
                // Two differences that are rounded alike may agree by chance.
                let noise = 64.0 * f64::EPSILON * most[i] / reach;
                let change = (now[i] - before[i]).abs();
                settled &= change <= 1e-12 * terms[i] || noise >= least[i];
                if change < least[i] && noise < least[i] {
                    (*rate, least[i]) = (now[i], change.max(noise));
                }
            }
            if settled {
                break;
            }
            before = now;
            reach /= 8.0;
        }
    }

    /// The system's own guards.
    fn guards(&self, _mode: Self::Mode) -> &[Guard] {
        &[]
    }

    /// Writes the values of the system's own guards to `values`.
    fn guard_values(&self, _mode: Self::Mode, _s: f64, _y: &[f64], _values: &mut [f64]) {}

    /// As [`DynamicSystem::tolerances`].
    fn tolerances(&self) -> &[(f64, f64)] {
        &[]
    }

    /// Changes the state `y` to the one that follows when one of the system's own guards fires, and
    /// returns the mode that follows.
    fn transition(&self, mode: Self::Mode, _guard: usize, _s: f64, _y: &mut [f64]) -> Self::Mode {
        mode
    }

    /// The times at which a [clock](Guard::clock) among the system's own guards fires.
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// As [`DynamicSystem::rest`], where the switches of one of the system's own guards accumulate.
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &mut [f64],
    ) -> Option<Self::Mode> {
        None
    }

    /// As [`DynamicSystem::transition_condition`], for one of the system's own guards.
    fn transition_condition(&self, _mode: Self::Mode, _guard: usize, _s: f64, _y: &[f64]) -> f64 {
        f64::NAN
    }
}

/// Two fields on both sides of a surface, as closures: the field above the surface, the field below
/// it, and the surface's function.
///
/// ```
/// use stickslip_solver::sliding::{SampledFilippov, TwoFields};
/// use stickslip_solver::{Dop853, Options};
/// use stickslip_solver::dynamic::{DynamicStart, run_dynamic};
///
/// // Relay feedback: x′ = −1 for x > 0 and 1 for x < 0. It is at rest at 0 from then on.
/// let relay = SampledFilippov::new(TwoFields(
///     |_time, _x: &[f64], slope: &mut [f64]| slope[0] = -1.0,
///     |_time, _x: &[f64], slope: &mut [f64]| slope[0] = 1.0,
///     |_time, x: &[f64]| x[0],
/// ));
/// let start = DynamicStart { mode: relay.mode((), 0.0, &[0.75])?, s: 0.0, state: &[0.75] };
/// let mut switches = Vec::new();
/// let end = run_dynamic(Dop853, &relay, start, 2.0, &Options::default(), &mut switches)?;
/// assert!(switches.len() == 1 && (switches[0].s - 0.75).abs() < 1e-14);
/// assert!(end.state[0].abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TwoFields<A, B, H>(pub A, pub B, pub H);

impl<A, B, H> SwitchedDynamic for TwoFields<A, B, H>
where
    A: Fn(f64, &[f64], &mut [f64]),
    B: Fn(f64, &[f64], &mut [f64]),
    H: Fn(f64, &[f64]) -> f64,
{
    type Mode = ();

    fn count(&self) -> usize {
        1
    }

    fn field(&self, (): (), signs: &[f64], s: f64, y: &[f64], slope: &mut [f64]) {
        if signs[0] > 0.0 { self.0(s, y, slope) } else { self.1(s, y, slope) }
    }

    fn surfaces(&self, (): (), s: f64, y: &[f64], values: &mut [f64]) {
        values[0] = self.2(s, y);
    }
}

/// A [`SwitchedDynamic`] system as a hybrid system, which slides along its surfaces where they
/// attract it.
///
/// It is a [`DynamicSystem`], and for a fixed dimension `N` also a [`HybridSystem`], with at most
/// `G` guards, which the caller of a run has to name. Guards 2i and 2i + 1 belong to surface i, as
/// in [`Filippov`](crate::sliding::Filippov), and the system's own guards follow.
#[derive(Debug)]
pub struct SampledFilippov<S> {
    /// The switched system.
    pub system: S,
    guards: OnceLock<Box<Guards>>,
}

/// The guards of some modes, and of modes that were entered later: modes may be many, but few lists
/// differ.
#[derive(Debug)]
struct Guards {
    guards: Vec<Guard>,
    next: OnceLock<Box<Guards>>,
}

/// A black box in one of its own modes.
struct Sampling<'a, S: SwitchedDynamic>(&'a S, S::Mode);

impl<S: SwitchedDynamic> View<f64> for Sampling<'_, S> {
    fn field(&self, signs: &[f64], s: f64, y: &[f64], slope: &mut [f64]) {
        self.0.field(self.1, signs, s, y, slope);
    }

    fn surfaces(&self, s: f64, y: &[f64]) -> Row<f64> {
        let mut values = [0.0; MOST];
        self.0.surfaces(self.1, s, y, &mut values[..self.0.count()]);
        values
    }

    fn rates(&self, s: f64, y: &[f64], slope: &[f64]) -> Row<f64> {
        let mut rates = [0.0; MOST];
        self.0.rates(self.1, s, y, slope, &mut rates[..self.0.count()]);
        rates
    }
}

impl<S: SwitchedDynamic> SampledFilippov<S> {
    /// The hybrid system of a switched system.
    ///
    /// # Panics
    /// If it has more than 4 surfaces.
    pub fn new(system: S) -> Self {
        let count = system.count();
        assert!(count <= MOST, "{count} surfaces are more than {MOST}");
        Self { system, guards: OnceLock::new() }
    }

    /// The mode in which a run starts from `y`.
    ///
    /// # Errors
    /// A [`Refusal`] if `y` lies on surfaces from which the solution does not go on, or goes on in
    /// several ways; [`Self::mode_from`] chooses one of these.
    pub fn mode(&self, own: S::Mode, s: f64, y: &[f64]) -> Result<SlidingMode<S::Mode>, Refusal> {
        start(&Sampling(&self.system, own), own, s, y, &[None; MOST][..self.system.count()])
    }

    /// As [`Self::mode`], with the sides that the solution keeps where it could go on in several
    /// ways; surfaces beyond the end of the list have no given side.
    ///
    /// # Errors
    /// A [`Refusal`] if the solution does not go on.
    pub fn mode_from(
        &self,
        own: S::Mode,
        sides: &[SurfaceSide],
        s: f64,
        y: &[f64],
    ) -> Result<SlidingMode<S::Mode>, Refusal> {
        let mut given = [None; MOST];
        given.iter_mut().zip(sides).for_each(|(given, side)| *given = Some(*side));
        start(&Sampling(&self.system, own), own, s, y, &given[..self.system.count()])
    }

    /// The place of a guard among the system's own ones, if it is one.
    fn own_guard(&self, guard: usize) -> Option<usize> {
        guard.checked_sub(2 * self.system.count())
    }

    fn field_of(&self, mode: SlidingMode<S::Mode>, s: f64, y: &[f64], slope: &mut [f64]) {
        let sliding = mode.surfaces.sliding().count();
        let mut fields = vec![0.0; if sliding > 0 { (sliding + 1) * y.len() } else { 0 }];
        let view = Sampling(&self.system, mode.own);
        control::field(&view, &mode.surfaces, (s, y), &mut fields, slope);
    }

    fn guards_of(&self, mode: SlidingMode<S::Mode>) -> Vec<Guard> {
        let count = self.system.count();
        let mut guards = guards_of(&mode.surfaces).as_flattened()[..2 * count].to_vec();
        guards.extend_from_slice(self.system.guards(mode.own));
        if mode.refusal().is_some() {
            guards.fill(Guard::OFF);
        }
        guards
    }

    fn values_of(&self, mode: SlidingMode<S::Mode>, s: f64, y: &[f64], values: &mut [f64]) {
        let count = self.system.count();
        if count == 0 {
            return self.system.guard_values(mode.own, s, y, values);
        }
        let mut fields = vec![0.0; (mode.surfaces.sliding().count() + 1) * y.len()];
        let view = Sampling(&self.system, mode.own);
        let surfaces = control::guards(&view, &mode.surfaces, (s, y), &mut fields);
        values[..2 * count].copy_from_slice(&surfaces.as_flattened()[..2 * count]);
        self.system.guard_values(mode.own, s, y, &mut values[2 * count..]);
    }

    /// The system's own mode behind a guard that fires, and what it says about the surfaces; `None`
    /// if an own guard changes nothing.
    fn moved(
        &self,
        mode: SlidingMode<S::Mode>,
        guard: usize,
        s: f64,
        y: &mut [f64],
    ) -> Option<(S::Mode, Cause<'static>)> {
        let cause =
            cause_of(&mode.surfaces, guard, || Sampling(&self.system, mode.own).surfaces(s, y));
        let Some(guard) = self.own_guard(guard) else {
            return Some((mode.own, cause));
        };
        let before = y.to_vec();
        let own = self.system.transition(mode.own, guard, s, y);
        (own != mode.own || before != y).then_some((own, cause))
    }

    fn switched(
        &self,
        mode: SlidingMode<S::Mode>,
        guard: usize,
        s: f64,
        y: &mut [f64],
    ) -> SlidingMode<S::Mode> {
        match self.moved(mode, guard, s, y) {
            Some(moved) => self.decided(mode, s, y, moved),
            None => mode,
        }
    }

    /// How the solution goes on in the system's own mode.
    fn decided(
        &self,
        mode: SlidingMode<S::Mode>,
        s: f64,
        y: &mut [f64],
        (own, cause): (S::Mode, Cause<'static>),
    ) -> SlidingMode<S::Mode> {
        let surfaces = match self.system.count() {
            0 => mode.surfaces,
            _ => decide(&Sampling(&self.system, own), &mode.surfaces, cause, s, y),
        };
        SlidingMode { own, surfaces }
    }

    fn rested(
        &self,
        mode: SlidingMode<S::Mode>,
        guard: usize,
        s: f64,
        y: &mut [f64],
    ) -> Option<SlidingMode<S::Mode>> {
        let guard = self.own_guard(guard)?;
        let cause = Cause::Moved(Sampling(&self.system, mode.own).surfaces(s, y));
        let own = self.system.rest(mode.own, guard, s, y)?;
        Some(self.decided(mode, s, y, (own, cause)))
    }

    fn condition_of(&self, mode: SlidingMode<S::Mode>, guard: usize, s: f64, y: &[f64]) -> f64 {
        if let Some(guard) = self.own_guard(guard) {
            let own = self.system.transition_condition(mode.own, guard, s, y);
            if !own.is_nan() {
                return own;
            }
        }
        let mut after = y.to_vec();
        match self.moved(mode, guard, s, &mut after) {
            Some((own, cause)) if self.system.count() > 0 => {
                condition(&Sampling(&self.system, own), &mode.surfaces, cause, s, &after)
            }
            _ => f64::NAN,
        }
    }

    fn schedule_of(&self, mode: SlidingMode<S::Mode>, guard: usize) -> Schedule<'_> {
        self.own_guard(guard).map_or(Schedule::NEVER, |own| self.system.schedule(mode.own, own))
    }
}

impl<S: SwitchedDynamic> DynamicSystem for SampledFilippov<S> {
    type Mode = SlidingMode<S::Mode>;

    fn field(&self, mode: Self::Mode, s: f64, y: &[f64], slope: &mut [f64]) {
        self.field_of(mode, s, y, slope);
    }

    fn tolerances(&self) -> &[(f64, f64)] {
        self.system.tolerances()
    }

    fn guards(&self, mode: Self::Mode) -> &[Guard] {
        if self.system.count() == 0 {
            return self.system.guards(mode.own);
        }
        let guards = self.guards_of(mode);
        let mut place = &self.guards;
        loop {
            let new = || Box::new(Guards { guards: guards.clone(), next: OnceLock::new() });
            let known = place.get_or_init(new);
            if known.guards == guards {
                return &known.guards;
            }
            place = &known.next;
        }
    }

    fn guard_values(&self, mode: Self::Mode, s: f64, y: &[f64], values: &mut [f64]) {
        self.values_of(mode, s, y, values);
    }

    fn transition(&self, mode: Self::Mode, guard: usize, s: f64, y: &mut [f64]) -> Self::Mode {
        self.switched(mode, guard, s, y)
    }

    fn schedule(&self, mode: Self::Mode, guard: usize) -> Schedule<'_> {
        self.schedule_of(mode, guard)
    }

    fn rest(&self, mode: Self::Mode, guard: usize, s: f64, y: &mut [f64]) -> Option<Self::Mode> {
        self.rested(mode, guard, s, y)
    }

    fn transition_condition(&self, mode: Self::Mode, guard: usize, s: f64, y: &[f64]) -> f64 {
        self.condition_of(mode, guard, s, y)
    }
}

impl<S: SwitchedDynamic, const N: usize, const G: usize> HybridSystem<N, G> for SampledFilippov<S> {
    type Mode = SlidingMode<S::Mode>;

    fn field(&self, mode: Self::Mode, s: f64, y: &State<N>) -> State<N> {
        let mut slope: State<N> = State::zeros();
        self.field_of(mode, s, y.as_slice(), slope.as_mut_slice());
        slope
    }

    fn guards(&self, mode: Self::Mode) -> [Guard; G] {
        let guards = self.guards_of(mode);
        assert!(guards.len() <= G, "the system has {} guards", guards.len());
        std::array::from_fn(|i| guards.get(i).copied().unwrap_or(Guard::OFF))
    }

    fn guard_values(&self, mode: Self::Mode, s: f64, y: &State<N>) -> [f64; G] {
        let mut values = [1.0; G];
        let count = 2 * self.system.count() + self.system.guards(mode.own).len();
        self.values_of(mode, s, y.as_slice(), &mut values[..count]);
        values
    }

    fn settle(&self, mode: Self::Mode, _y: &State<N>) -> Self::Mode {
        mode.settled()
    }

    fn transition(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> (Self::Mode, State<N>) {
        let mut after = *y;
        let mode = self.switched(mode, guard, s, after.as_mut_slice());
        (mode, after)
    }

    fn transition_condition(&self, mode: Self::Mode, guard: usize, s: f64, y: &State<N>) -> f64 {
        self.condition_of(mode, guard, s, y.as_slice())
    }

    fn schedule(&self, mode: Self::Mode, guard: usize) -> Schedule<'_> {
        self.schedule_of(mode, guard)
    }

    fn rest(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> Option<(Self::Mode, State<N>)> {
        let mut after = *y;
        let mode = self.rested(mode, guard, s, after.as_mut_slice())?;
        Some((mode, after))
    }
}
