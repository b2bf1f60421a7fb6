//! Random systems with relays, held to what defines a solution.
//!
//! At any time, the slope of a solution is M y + b + d cos ωt + R λ with signs λ: λⱼ = ±1 off the
//! surface j, on its side, and |λⱼ| ≤ 1 on it. As R has independent columns here, λ follows from
//! the slope. If −N R is a P-matrix, with the normals N, then only one solution is so.

use super::Relays;
use stickslip_solver::sliding::{Filippov, Refusal, SampledFilippov, SlidingMode, SurfaceSide};
use stickslip_solver::{Dop853, HybridSystem, Options, Outcome, Recorder, RunError, Start, State};

use crate::erased::run;

/// The time over which slopes are taken.
const REACH: f64 = 1e-4;

fn system<const N: usize, const K: usize>(
    random: &mut fastrand::Rng,
    dominant: bool,
) -> Relays<N, K> {
    let mut number = |size: f64| size * (2.0 * random.f64() - 1.0);
    let mut system = Relays::<N, K>::NONE;
    for i in 0..N {
        system.matrix[i] = std::array::from_fn(|_| number(1.0));
        system.matrix[i][i] -= 1.0;
        system.constant[i] = number(0.5);
        system.drive[i] = number(1.5);
        system.relays[i] = std::array::from_fn(|j| {
            let along = if i == j { -1.0 } else { 0.0 };
            if dominant { along + number(0.2) } else { along + number(1.5) }
        });
    }
    for j in 0..K {
        system.normals[j] = std::array::from_fn(|i| {
            let along = if i == j { 1.0 } else { 0.0 };
            along + number(if dominant { 0.1 } else { 0.7 })
        });
        system.offsets[j] = number(0.3);
        system.waves[j] = number(0.4);
    }
    system.frequency = 1.0 + number(0.8);
    system
}

/// What came of a run.
#[derive(Debug, Default)]
struct Seen {
    runs: usize,
    switches: usize,
    places: usize,
    together: usize,
    accumulations: usize,
    refusals: Vec<Refusal>,
    worst: f64,
}

/// Follows a system and checks λ at many places.
fn follow<S, const N: usize, const K: usize, const G: usize>(
    relays: &Relays<N, K>,
    system: &S,
    start: Start<S::Mode, N>,
    random: &mut fastrand::Rng,
    seen: &mut Seen,
) where
    S: HybridSystem<N, G, Mode = SlidingMode<()>>,
{
    const END: f64 = 15.0;
    let mut recorder = Recorder::default();
    let options = Options { max_switches: 5000, ..Options::with_tolerance(1e-11) };
    let ended = run::<_, _, _, N, G>(Dop853, system, start, END, &options, &mut recorder);
    let events = &recorder.switches;
    seen.runs += 1;
    seen.switches += events.len();
    let end = match ended {
        Ok(run) => {
            match run.outcome {
                Outcome::ReachedEnd => {}
                Outcome::Zeno { .. } => seen.accumulations += 1,
                outcome => panic!("{outcome:?} {events:?}"),
            }
            run.s
        }
        Err(RunError::Field { s, .. }) => {
            let refusal = events.last().and_then(|event| event.to.refusal());
            seen.refusals.push(refusal.unwrap_or(Refusal::NotFinite));
            s
        }
        Err(error) => panic!("{error:?} {:?}", events.last()),
    };
    let together = |mode: SlidingMode<()>| {
        mode.sides().iter().filter(|side| **side == SurfaceSide::Sliding).count()
    };
    seen.together += events.iter().filter(|event| together(event.to) > 1).count();
    for _ in 0..200 {
        let s = end * random.f64();
        let near = events.iter().any(|event| (event.s - s).abs() < 2.0 * REACH);
        if near || s < 2.0 * REACH || s > end - 2.0 * REACH {
            continue;
        }
        seen.places += 1;
        let at = |s: f64| recorder.trajectory.at(s).unwrap().1;
        let y = at(s);
        let slope = (at(s - 2.0 * REACH) - at(s - REACH) * 8.0 + at(s + REACH) * 8.0
            - at(s + 2.0 * REACH))
            / (12.0 * REACH);
        let matrix = nalgebra::SMatrix::<f64, N, N>::from_fn(|i, j| relays.matrix[i][j]);
        let wave = (relays.frequency * s).cos();
        let smooth = matrix * y + State::from(relays.constant) + State::from(relays.drive) * wave;
        let columns = nalgebra::SMatrix::<f64, N, K>::from_fn(|i, j| relays.relays[i][j]);
        let (left, right) = (columns.transpose() * columns, columns.transpose() * (slope - smooth));
        let inverse = nalgebra::DMatrix::from_fn(K, K, |i, j| left[(i, j)]).try_inverse().unwrap();
        let right = nalgebra::DVector::from_fn(K, |i, _| right[i]);
        let lambda = inverse * right;
        for j in 0..K {
            let h = (0..N).map(|i| relays.normals[j][i] * y[i]).sum::<f64>()
                + relays.waves[j] * s.sin()
                + relays.offsets[j];
            let error = if h.abs() > 1e-7 {
                (lambda[j] - h.signum()).abs()
            } else {
                (lambda[j].abs() - 1.0).max(0.0)
            };
            seen.worst = seen.worst.max(error);
            // Some of the systems grow without bound.
            assert!(
                error < 1e-4 + 1e-8 * slope.amax(),
                "surface {j} at {s}: h = {h:e}, λ = {lambda} {events:?}"
            );
        }
    }
}

fn random_systems<const N: usize, const K: usize, const G: usize>(
    seed: u64,
    count: usize,
    dominant: bool,
) -> Seen {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut seen = Seen::default();
    for _ in 0..count {
        let relays = system::<N, K>(&mut random, dominant);
        let state = State::from_fn(|_, _| 4.0 * random.f64() - 2.0);
        let readable = Filippov::<_, K, G>(relays.clone());
        let start = Start { mode: readable.mode((), 0.0, &state).unwrap(), s: 0.0, state };
        follow::<_, N, K, G>(&relays, &readable, start, &mut random, &mut seen);
        let sampled = SampledFilippov::new(relays.clone());
        follow::<_, N, K, G>(&relays, &sampled, start, &mut random, &mut seen);
    }
    seen
}

/// Systems whose solutions are unique: nothing is refused.
#[test]
fn unique_solutions_are_found() {
    let all = [
        random_systems::<2, 1, 2>(1, 100, true),
        random_systems::<3, 2, 4>(2, 100, true),
        random_systems::<4, 3, 6>(3, 60, true),
        random_systems::<4, 4, 8>(4, 60, true),
    ];
    for seen in all {
        assert!(seen.refusals.is_empty() && seen.accumulations == 0, "{seen:?}");
    }
}

/// Systems whose solutions may be several, accumulate, or end: what is found is a solution.
#[test]
fn what_is_found_is_a_solution() {
    let all = [
        random_systems::<2, 1, 2>(5, 100, false),
        random_systems::<2, 2, 4>(6, 100, false),
        random_systems::<3, 2, 4>(7, 100, false),
        random_systems::<4, 3, 6>(8, 60, false),
    ];
    for seen in all {
        assert!(seen.refusals.len() < seen.runs / 2, "{seen:?}");
    }
}
