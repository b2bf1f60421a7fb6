//! Sliding systems that are written once, generic in their numbers.

use std::fmt;

use crate::hybrid::{Guard, ReadableSystem, Schedule};
use crate::method::State;
use crate::sensitivity::{Differentiable, Variation, along};
use crate::sliding::control::{self, Row, View};
use crate::sliding::decision::{Cause, condition, decide};
use crate::sliding::sides::{Refusal, SlidingMode, SurfaceSide};
use crate::sliding::{MOST, cause_of, guards_of, start};
use stickslip_number::{Dual, Number};

/// A system of `N` components whose field depends on the signs of `K` ≤ 4 surfaces, whose formulas
/// the solver can read. It has `G` guards: two for each surface, which [`Filippov`] provides, and
/// then its own ones. Whatever it says about guards below 2 `K` is ignored.
///
/// With several surfaces the field has to be affine in the signs: a sum of parts that each depend
/// on one of them. This is checked wherever the solution reaches a surface.
pub trait Switched<const N: usize, const K: usize, const G: usize> {
    /// A smooth regime of the system itself, besides its signs.
    type Mode: Copy + PartialEq + fmt::Debug;

    /// The derivative of the state where the surfaces have these `signs`, each of them +1 or −1.
    /// The sign is never 0: the field along a surface is a sum of fields beside it.
    fn field<T: Number>(&self, mode: Self::Mode, signs: &[T; K], s: T, y: &[T; N]) -> [T; N];

    /// The functions whose zeros are the surfaces. They may depend on time, and need not be smooth
    /// anywhere but near their zeros.
    fn surfaces<T: Number>(&self, mode: Self::Mode, s: T, y: &[T; N]) -> [T; K];

    /// The system's own guards.
    fn guards(&self, _mode: Self::Mode) -> [Guard; G] {
        [Guard::OFF; G]
    }

    /// The values of the system's own guards.
    fn guard_values<T: Number>(&self, _mode: Self::Mode, _s: T, _y: &[T; N]) -> [T; G] {
        [T::from(1.0); G]
    }

    /// The mode that follows when one of the system's own guards fires.
    fn next(&self, mode: Self::Mode, _guard: usize, _s: f64, _y: &State<N>) -> Self::Mode {
        mode
    }

    /// The state that follows when one of the system's own guards fires.
    fn reset<T: Number>(&self, _mode: Self::Mode, _guard: usize, _s: T, y: &[T; N]) -> [T; N] {
        *y
    }

    /// The times at which a [clock](Guard::clock) among the system's own guards fires.
    fn schedule(&self, _mode: Self::Mode, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    /// As [`HybridSystem::rest`](crate::HybridSystem::rest), where the switches of one of the
    /// system's own guards accumulate.
    fn rest(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &State<N>,
    ) -> Option<(Self::Mode, State<N>)> {
        None
    }

    /// As [`HybridSystem::transition_condition`](crate::HybridSystem::transition_condition), for
    /// one of the system's own guards.
    fn transition_condition(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _s: f64,
        _y: &State<N>,
    ) -> f64 {
        f64::NAN
    }
}

/// A [`Switched`] system as a hybrid system, which slides along its surfaces where they attract it.
///
/// Guards 2i and 2i + 1 belong to surface i. On a side, guard 2i is the distance of the surface's
/// function from zero, and the other one is off. While the state slides, they are 1 − λ and 1 + λ
/// with the multiplier λ of the surface. The system's own guards follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filippov<S, const K: usize, const G: usize>(pub S);

/// A readable system in one of its own modes.
struct Reading<'a, S, Mode, const N: usize, const K: usize, const G: usize>(&'a S, Mode);

/// The components of a state of the dimension N, which a caller with a state of that dimension has.
fn array<T: Number, const N: usize>(y: &[T]) -> [T; N] {
    std::array::from_fn(|i| y[i])
}

fn row<T: Number, const K: usize>(values: [T; K]) -> Row<T> {
    std::array::from_fn(|i| if i < K { values[i] } else { T::from(0.0) })
}

impl<S, T, const N: usize, const K: usize, const G: usize> View<T>
    for Reading<'_, S, S::Mode, N, K, G>
where
    S: Switched<N, K, G>,
    T: Number,
{
    fn field(&self, signs: &[T], s: T, y: &[T], slope: &mut [T]) {
        slope.copy_from_slice(&self.0.field(self.1, &array(signs), s, &array(y)));
    }

    fn surfaces(&self, s: T, y: &[T]) -> Row<T> {
        row(self.0.surfaces(self.1, s, &array(y)))
    }

    fn rates(&self, s: T, y: &[T], slope: &[T]) -> Row<T> {
        let along = std::array::from_fn(|i| Dual { value: y[i], slope: slope[i] });
        let s = Dual { value: s, slope: T::from(1.0) };
        row(self.0.surfaces(self.1, s, &along).map(|value| value.slope))
    }
}

impl<S, const K: usize, const G: usize> Filippov<S, K, G> {
    /// The mode in which a run starts from `y`.
    ///
    /// # Errors
    /// A [`Refusal`] if `y` lies on surfaces from which the solution does not go on, or goes on in
    /// several ways; [`Self::mode_from`] chooses one of these.
    pub fn mode<const N: usize>(
        &self,
        own: S::Mode,
        s: f64,
        y: &State<N>,
    ) -> Result<SlidingMode<S::Mode>, Refusal>
    where
        S: Switched<N, K, G>,
    {
        start(&Reading::<S, _, N, K, G>(&self.0, own), own, s, y.as_slice(), &[None; K])
    }

    /// As [`Self::mode`], with the sides that the solution keeps where it could go on in several
    /// ways.
    ///
    /// # Errors
    /// A [`Refusal`] if the solution does not go on.
    pub fn mode_from<const N: usize>(
        &self,
        own: S::Mode,
        sides: [SurfaceSide; K],
        s: f64,
        y: &State<N>,
    ) -> Result<SlidingMode<S::Mode>, Refusal>
    where
        S: Switched<N, K, G>,
    {
        let sides = sides.map(Some);
        start(&Reading::<S, _, N, K, G>(&self.0, own), own, s, y.as_slice(), &sides)
    }

    /// The system's own mode and the state behind a guard that fires, and what it says about the
    /// surfaces; `None` if an own guard changes nothing.
    fn moved<const N: usize>(
        &self,
        mode: SlidingMode<S::Mode>,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> Option<(S::Mode, State<N>, Cause<'static>)>
    where
        S: Switched<N, K, G>,
    {
        let before = &y.data.0[0];
        let cause = cause_of(&mode.surfaces, guard, || row(self.0.surfaces(mode.own, s, before)));
        if guard < 2 * K {
            return Some((mode.own, *y, cause));
        }
        let after = self.0.reset(mode.own, guard, s, before).into();
        let own = self.0.next(mode.own, guard, s, y);
        (own != mode.own || after != *y).then_some((own, after, cause))
    }

    /// How the solution goes on in the system's own mode from a state.
    fn decided<const N: usize>(
        &self,
        mode: SlidingMode<S::Mode>,
        s: f64,
        (own, mut after, cause): (S::Mode, State<N>, Cause<'static>),
    ) -> (SlidingMode<S::Mode>, State<N>)
    where
        S: Switched<N, K, G>,
    {
        let view = Reading::<S, _, N, K, G>(&self.0, own);
        let surfaces = decide(&view, &mode.surfaces, cause, s, after.as_mut_slice());
        (SlidingMode { own, surfaces }, after)
    }

    /// The field in a mode, in numbers of any kind.
    fn field_of<T: Number, const N: usize>(
        &self,
        mode: SlidingMode<S::Mode>,
        s: T,
        y: &[T; N],
    ) -> [T; N]
    where
        S: Switched<N, K, G>,
    {
        let (mut slope, mut fields) = ([T::from(0.0); N], [[T::from(0.0); N]; MOST + 1]);
        let view = Reading::<S, _, N, K, G>(&self.0, mode.own);
        control::field(&view, &mode.surfaces, (s, y), fields.as_flattened_mut(), &mut slope);
        slope
    }

    /// The guards in a mode, in numbers of any kind.
    fn guards_in<T: Number, const N: usize>(
        &self,
        mode: SlidingMode<S::Mode>,
        s: T,
        y: &[T; N],
    ) -> [T; G]
    where
        S: Switched<N, K, G>,
    {
        let mut fields = [[T::from(0.0); N]; MOST + 1];
        let view = Reading::<S, _, N, K, G>(&self.0, mode.own);
        let surfaces = control::guards(&view, &mode.surfaces, (s, y), fields.as_flattened_mut());
        let own = self.0.guard_values(mode.own, s, y);
        std::array::from_fn(|i| if i < 2 * K { surfaces[i / 2][i % 2] } else { own[i] })
    }
}

impl<S, const N: usize, const K: usize, const G: usize> ReadableSystem<N, G> for Filippov<S, K, G>
where
    S: Switched<N, K, G>,
{
    type Mode = SlidingMode<S::Mode>;

    fn field<T: Number>(&self, mode: Self::Mode, s: T, y: &[T; N]) -> [T; N] {
        self.field_of(mode, s, y)
    }

    fn guards(&self, mode: Self::Mode) -> [Guard; G] {
        const { assert!(K <= MOST, "there may be 4 surfaces") };
        const { assert!(G >= 2 * K, "each surface has two guards") };
        let (surfaces, own) = (guards_of(&mode.surfaces), self.0.guards(mode.own));
        if mode.refusal().is_some() {
            return [Guard::OFF; G];
        }
        std::array::from_fn(|i| if i < 2 * K { surfaces[i / 2][i % 2] } else { own[i] })
    }

    fn guard_values<T: Number>(&self, mode: Self::Mode, s: T, y: &[T; N]) -> [T; G] {
        self.guards_in(mode, s, y)
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
        let moved = self.moved(mode, guard, s, y);
        moved.map_or((mode, *y), |moved| self.decided(mode, s, moved))
    }

    fn schedule(&self, mode: Self::Mode, guard: usize) -> Schedule<'_> {
        if guard < 2 * K { Schedule::NEVER } else { self.0.schedule(mode.own, guard) }
    }

    fn rest(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
    ) -> Option<(Self::Mode, State<N>)> {
        let own = (guard >= 2 * K).then(|| self.0.rest(mode.own, guard, s, y));
        let (own, after) = own.flatten()?;
        let cause = Cause::Moved(row(self.0.surfaces(mode.own, s, &y.data.0[0])));
        Some(self.decided(mode, s, (own, after, cause)))
    }

    fn transition_condition(&self, mode: Self::Mode, guard: usize, s: f64, y: &State<N>) -> f64 {
        if guard >= 2 * K {
            let branches = self.0.transition_condition(mode.own, guard, s, y);
            if !branches.is_nan() {
                return branches;
            }
        }
        let Some((own, after, cause)) = self.moved(mode, guard, s, y) else { return f64::NAN };
        let view = Reading::<S, _, N, K, G>(&self.0, own);
        condition(&view, &mode.surfaces, cause, s, after.as_slice())
    }
}

/// Derivatives with respect to what the state starts from. A parameter is a component of the state
/// whose slope is 0.
///
/// While the state slides, its changes stay tangential to the surface: those across it vanish where
/// it begins to slide.
impl<S, const N: usize, const K: usize, const G: usize> Differentiable<N, G> for Filippov<S, K, G>
where
    S: Switched<N, K, G>,
{
    fn field_change(&self, mode: Self::Mode, s: f64, y: &State<N>, by: &Variation<N>) -> State<N> {
        let (s, y) = along(s, y, by);
        self.field_of(mode, s, &y).map(|slope| slope.eps).into()
    }

    fn guard_changes(&self, mode: Self::Mode, s: f64, y: &State<N>, by: &Variation<N>) -> [f64; G] {
        let (s, y) = along(s, y, by);
        self.guards_in(mode, s, &y).map(|value| value.eps)
    }

    fn transition_change(
        &self,
        mode: Self::Mode,
        guard: usize,
        s: f64,
        y: &State<N>,
        by: &Variation<N>,
    ) -> State<N> {
        // On a surface, to move onto it changes nothing.
        let (s, y) = along(s, y, by);
        let after = if guard < 2 * K { y } else { self.0.reset(mode.own, guard, s, &y) };
        after.map(|y| y.eps).into()
    }
}
