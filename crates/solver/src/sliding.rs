//! Sliding: systems whose field jumps on surfaces, along which the solution may slide.
//!
//! A surface is where a function h(s, y) is zero. Above it, where h > 0, the field is f₁, below it
//! f₂. Let aᵢ be the rate of h along fᵢ on the surface, ∂h/∂s + ∇h·fᵢ. Then the solution
//!
//! | where | goes on |
//! |---|---|
//! | a₁ and a₂ have one sign | across the surface |
//! | a₁ < 0 < a₂ | along the surface, with the field (a₂ f₁ − a₁ f₂)/(a₂ − a₁) |
//! | a₁ > 0 > a₂ | on either side: it is not unique |
//!
//! (Filippov, *Differential Equations with Discontinuous Righthand Sides*, 1988, §4). Sliding ends
//! where a₁ = 0, towards h > 0, or where a₂ = 0, towards h < 0. On up to four surfaces at once, the
//! multipliers λ of the equivalent control solve as many linear equations (Utkin, *Sliding Modes in
//! Control and Optimization*, 1992, chapter 2); with one surface, the field is the one above.
//!
//! A [`Switched`] system states its field for given signs, and its surfaces. [`Filippov`] makes an
//! ordinary hybrid system of it, so that [`run`](crate::run),
//! [`margins`](fn@crate::margin::margins), [`sensitivities`](fn@crate::sensitivity::sensitivities)
//! and all else can be had of it.
//!
//! ```
//! use stickslip_solver::{Dop853, Number, Options, Start, State, run};
//! use stickslip_solver::sliding::{Filippov, SurfaceSide, Switched};
//!
//! /// A mass of 1 on a spring of stiffness 1 and on a belt of velocity 0.5, with friction 0.8.
//! struct Belt;
//!
//! // Two components, one surface, two guards for it.
//! impl Switched<2, 1, 2> for Belt {
//!     type Mode = ();
//!
//!     fn field<T: Number>(&self, (): (), signs: &[T; 1], _time: T, y: &[T; 2]) -> [T; 2] {
//!         [y[1], -y[0] - signs[0] * 0.8]
//!     }
//!     fn surfaces<T: Number>(&self, (): (), _time: T, y: &[T; 2]) -> [T; 1] {
//!         [y[1] - 0.5]
//!     }
//! }
//!
//! let belt = Filippov(Belt);
//! let state = State::from([-0.3, 0.5]);
//! let start = Start { mode: belt.mode((), 0.0, &state)?, s: 0.0, state };
//! assert_eq!(start.mode.sides(), [SurfaceSide::Sliding]);
//! let mut switches = Vec::new();
//! let end = run(Dop853, &belt, start, 3.0, &Options::default(), &mut switches)?.finished()?;
//! // It is carried until the spring pulls as strongly as friction, at 0.8.
//! assert!((switches[0].s - 2.2).abs() < 1e-12 && switches[0].to.sides() == [SurfaceSide::Below]);
//! // Then it swings about 0.8, with a velocity of 0.5 at first.
//! assert!((end.state[0] - 0.8 - 0.5 * 0.8_f64.sin()).abs() < 1e-10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is decided, and what is refused
//!
//! How the solution goes on is decided wherever it reaches surfaces, leaves them, or is moved by
//! the system's own guards, for all surfaces on which it lies then. Where it could go on in several
//! ways, it keeps its sides, and [`SlidingMode::is_unique`] says so; a start needs
//! [`Filippov::mode_from`]. Where it cannot keep them, where the equations for the multipliers are
//! singular, or where the field is not affine in the signs, the mode that follows is a [`Refusal`],
//! and the run ends with [`RunError::Field`](crate::RunError::Field). The same error ends a run
//! that slides to where it ceases to be attracted to several surfaces.
//!
//! A run cannot go backwards through a surface along which it slides: how long it has been there
//! is not known. Nor does it go backwards through other surfaces: it is refused.
//!
//! # Accuracy
//!
//! Switches are as accurate as others. The exact sliding field is tangential to all functions of
//! the surfaces everywhere near them. So a state leaves the surface by no more than the errors of
//! the steps, which are below the tolerance and add up, but do not grow; where a surface's function
//! is linear in time and state, it leaves it by rounding alone. Where it begins and ends to slide,
//! the state is moved onto the surface, along the difference of the fields.
//!
//! A step that slides along k surfaces evaluates k + 1 fields for each one of another step.
//!
//! The field is not stabilised: a term that pulls the state back would change the field and need a
//! rate of its own.
//!
//! # Why this is a system and not a part of the engine
//!
//! On a surface, a solution has a field, a domain and a place where it ends: all that makes a mode.
//! So events, margins, sensitivities and atlases need to know nothing of sliding, and what makes
//! them better makes sliding better.
//!
//! [`SampledFilippov`] does the same with a [`SwitchedDynamic`] system, whose functions cannot be
//! read and whose dimension and surfaces may be known at run time only.

mod control;
mod decision;
mod readable;
mod sampled;
mod sides;

pub use readable::{Filippov, Switched};
pub use sampled::{SampledFilippov, SwitchedDynamic, TwoFields};
pub use sides::{Refusal, SlidingMode, SurfaceSide};

use crate::hybrid::{Direction, Guard};
use crate::sliding::control::{Row, View};
use crate::sliding::decision::{Cause, decide};
use crate::sliding::sides::Sides;

/// The largest number of surfaces.
const MOST: usize = 4;

/// The two guards of each surface.
fn guards_of(surfaces: &Sides) -> [[Guard; 2]; MOST] {
    std::array::from_fn(|i| {
        let [first, second] = surfaces.zeros[i];
        let guard = |zero: u8| Guard::new(Direction::Below).from_zero(zero.into());
        let slides = surfaces.sides[i] == SurfaceSide::Sliding;
        [guard(first), if slides { guard(second) } else { Guard::OFF }]
    })
}

/// What a guard that has fired implies for the surfaces, whose functions have these values there.
fn cause_of(surfaces: &Sides, guard: usize, values: impl Fn() -> Row<f64>) -> Cause<'static> {
    let surface = guard / 2;
    if surface >= surfaces.count {
        Cause::Moved(values())
    } else if surfaces.sides[surface] != SurfaceSide::Sliding {
        Cause::Arrived(surface)
    } else {
        Cause::Released(
            surface,
            if guard.is_multiple_of(2) { SurfaceSide::Above } else { SurfaceSide::Below },
        )
    }
}

/// The mode in which a run starts. Where the solution could go on in several ways, it keeps to the
/// sides that are `given`.
fn start<Mode>(
    view: &impl View<f64>,
    own: Mode,
    s: f64,
    y: &[f64],
    given: &[Option<SurfaceSide>],
) -> Result<SlidingMode<Mode>, Refusal> {
    let values = view.surfaces(s, y);
    let sides = Sides::new(given.len(), values.map(SurfaceSide::of));
    let surfaces = decide(view, &sides, Cause::Start(given), s, &mut y.to_vec());
    match surfaces.refusal {
        Some(refusal) => Err(refusal),
        None => Ok(SlidingMode { own, surfaces }),
    }
}
