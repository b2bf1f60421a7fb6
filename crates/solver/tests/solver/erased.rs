//! Runs along systems and observers of any type as runs along one type.
//!
//! The solver is compiled anew for each type of system and of observer that it runs along, which
//! takes seconds. Here it is compiled once for each method and dimension, for systems that can be
//! read and for black boxes; modes are numbered, and behind a system's guards are others that are
//! off. The functions have the names, the arguments and the results of those of the solver, and
//! call them. They take no account of a step that a system has of its own
//! ([`HybridSystem::step`]), as weighted ones have.

mod dynamic;
mod modes;
mod system;

use stickslip_solver::margin::{Margin, Margins, NearMiss};
use stickslip_solver::{
    Dop853, EmbeddedPair, HybridSystem, Method, Observer, Options, Recorder, Run, RunError, Start,
    State,
};

pub use dynamic::{run_dynamic, run_dynamic_backwards};
use modes::Modes;
use system::{Erased, Numbered, Told, Watching};

use crate::runs::{Wave, at, ball};

/// How many guards an erased system has.
const FEW: usize = 8;
const MANY: usize = 64;

struct Guards<const G: usize>;

impl<const G: usize> Guards<G> {
    const ARE_FEW: bool = G <= FEW;
}

/// Calls a function with an erased system of the type `S`.
macro_rules! with_system {
    ($system:ident => $call:expr) => {
        if S::READABLE {
            if Guards::<G>::ARE_FEW {
                let $system = &Erased::<N, FEW, true>($system);
                $call
            } else {
                let $system = &Erased::<N, MANY, true>($system);
                $call
            }
        } else if Guards::<G>::ARE_FEW {
            let $system = &Erased::<N, FEW, false>($system);
            $call
        } else {
            let $system = &Erased::<N, MANY, false>($system);
            $call
        }
    };
}

/// Calls a function with an erased observer of the type `O`.
macro_rules! with_observer {
    ($observer:ident => $call:expr) => {
        if O::WANTS_SEGMENTS {
            let $observer = &mut Watching::<N, true>($observer);
            $call
        } else {
            let $observer = &mut Watching::<N, false>($observer);
            $call
        }
    };
}

/// Calls a function with an erased system, start and observer, and gives the end its mode back.
macro_rules! with_numbers {
    ($system:ident, $start:ident, $observer:ident => $call:expr) => {{
        let modes = &Modes::default();
        let ($system, $start) = (&Numbered::<_, _, G> { system: $system, modes }, modes.start($start));
        let $observer = &mut Told { observer: $observer, modes };
        let run = with_system!($system => with_observer!($observer => $call));
        run.map(|run| modes.end(run))
    }};
}

/// As [`stickslip_solver::run`].
pub fn run<M: Method, S, O, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    with_numbers!(system, start, observer => {
        stickslip_solver::run(method, system, start, end, options, observer)
    })
}

/// As [`stickslip_solver::run_backwards`].
pub fn run_backwards<M: Method, S, O, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    with_numbers!(system, start, observer => {
        stickslip_solver::run_backwards(method, system, start, end, options, observer)
    })
}

/// As [`stickslip_solver::run_with`].
pub fn run_with<S, O, const N: usize, const G: usize>(
    pair: EmbeddedPair,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<S::Mode, N>, RunError>
where
    S: HybridSystem<N, G>,
    O: Observer<S::Mode, N>,
{
    with_numbers!(system, start, observer => {
        stickslip_solver::run_with(pair, system, start, end, options, observer)
    })
}

/// As [`stickslip_solver::integrate`].
pub fn integrate<M: Method, O: Observer<(), N>, const N: usize>(
    method: M,
    field: impl Fn(f64, &State<N>) -> State<N>,
    s: f64,
    y: State<N>,
    end: f64,
    options: &Options,
    observer: &mut O,
) -> Result<Run<(), N>, RunError> {
    let field: &dyn Fn(f64, &State<N>) -> State<N> = &field;
    stickslip_solver::integrate(method, field, s, y, end, options, observer)
}

/// As [`stickslip_solver::margin::margins`].
pub fn margins<M: Method, S: HybridSystem<N, G>, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
) -> Result<Margins, RunError> {
    let modes = &Modes::default();
    let (system, start) = (&Numbered::<_, _, G> { system, modes }, modes.start(start));
    with_system!(system => stickslip_solver::margin::margins(method, system, start, end, options))
}

/// As [`stickslip_solver::margin::margin`].
pub fn margin<M: Method, S: HybridSystem<N, G>, const N: usize, const G: usize>(
    method: M,
    system: &S,
    start: Start<S::Mode, N>,
    end: f64,
    options: &Options,
    margin: &Margin,
) -> Result<Option<NearMiss>, RunError> {
    let modes = &Modes::default();
    let (system, start) = (&Numbered::<_, _, G> { system, modes }, modes.start(start));
    with_system!(system => stickslip_solver::margin::margin(method, system, start, end, options, margin))
}

/// A run without the number of evaluations of guards: of several they may be a few more than of
/// one, though the others are off.
pub fn but_guards<Mode, const N: usize>(
    run: Result<Run<Mode, N>, RunError>,
) -> Result<Run<Mode, N>, RunError> {
    run.map(|mut run| {
        run.statistics.guards = 0;
        run
    })
}

/// What these functions return and report is what those of the solver do with the types themselves.
#[test]
fn erased_types_change_no_bit() {
    let options = Options::default();
    let (mut itself, mut erased) = (Recorder::default(), Recorder::default());
    let start = at(0.0, [1.0, 0.0]);
    let one = stickslip_solver::run(Dop853, &ball(), start, 3.0, &options, &mut itself);
    let other = run(Dop853, &ball(), start, 3.0, &options, &mut erased);
    assert_eq!(but_guards(other), but_guards(one));
    assert!(!itself.switches.is_empty());
    assert_eq!(erased.switches, itself.switches);
    for s in [0.0, 0.3, 1.7, 3.0] {
        assert_eq!(erased.trajectory.at(s), itself.trajectory.at(s));
    }

    let (mut itself, mut erased) = (Vec::new(), Vec::new());
    let start = at(1.0, [1.0]);
    let one = stickslip_solver::run_backwards(Dop853, &Wave, start, 0.0, &options, &mut itself);
    let other = run_backwards(Dop853, &Wave, start, 0.0, &options, &mut erased);
    assert_eq!(but_guards(other), but_guards(one));
    assert!(!itself.is_empty());
    assert_eq!(erased, itself);
}
