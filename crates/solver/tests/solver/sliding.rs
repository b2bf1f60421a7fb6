//! Sliding along surfaces, against closed forms and exact references.
//!
//! | module | content |
//! |---|---|
//! | `one_surface` | relays, dry friction, surfaces that move, starts on a surface |
//! | `several_surfaces` | masses on a belt, three and four surfaces, what is refused |
//! | `grazing` | the onset of sliding of an oscillator, by margins and by multipliers |
//! | `own_events` | clocks and rest of a system that slides |
//! | `random` | random piecewise-linear systems, against their exact inclusion |

mod grazing;
mod one_surface;
mod own_events;
mod random;
mod several_surfaces;

use stickslip_solver::sliding::{
    Filippov, Refusal, SampledFilippov, SlidingMode, SurfaceSide, Switched, SwitchedDynamic,
};
use stickslip_solver::{Dop853, Number, Options, Run, RunError, Start, State, SwitchEvent};

use crate::erased::run;

/// y′ = M y + b + d cos ωt + R λ, with the signs λ of the surfaces n·y + c + w sin t.
#[derive(Clone, Debug)]
#[expect(clippy::struct_field_names, reason = "its field has relays")]
pub struct Relays<const N: usize, const K: usize> {
    pub matrix: [[f64; N]; N],
    pub constant: [f64; N],
    pub drive: [f64; N],
    pub frequency: f64,
    pub relays: [[f64; K]; N],
    pub normals: [[f64; N]; K],
    pub offsets: [f64; K],
    pub waves: [f64; K],
}

impl<const N: usize, const K: usize> Relays<N, K> {
    /// Nothing moves, and no surface exists.
    pub const NONE: Self = Self {
        matrix: [[0.0; N]; N],
        constant: [0.0; N],
        drive: [0.0; N],
        frequency: 1.0,
        relays: [[0.0; K]; N],
        normals: [[0.0; N]; K],
        offsets: [0.0; K],
        waves: [0.0; K],
    };
}

fn dot<T: Number>(row: &[f64], of: &[T]) -> T {
    row.iter().zip(of).fold(T::from(0.0), |sum, (a, x)| sum + *x * *a)
}

impl<const N: usize, const K: usize, const G: usize> Switched<N, K, G> for Relays<N, K> {
    type Mode = ();

    fn field<T: Number>(&self, (): (), signs: &[T; K], s: T, y: &[T; N]) -> [T; N] {
        let wave = (s * self.frequency).cos();
        std::array::from_fn(|i| {
            dot(&self.matrix[i], y)
                + dot(&self.relays[i], signs)
                + wave * self.drive[i]
                + self.constant[i]
        })
    }

    fn surfaces<T: Number>(&self, (): (), s: T, y: &[T; N]) -> [T; K] {
        std::array::from_fn(|i| {
            dot(&self.normals[i], y) + s.sin() * self.waves[i] + self.offsets[i]
        })
    }
}

/// As a black box.
impl<const N: usize, const K: usize> SwitchedDynamic for Relays<N, K> {
    type Mode = ();

    fn count(&self) -> usize {
        K
    }
    fn field(&self, (): (), signs: &[f64], s: f64, y: &[f64], slope: &mut [f64]) {
        let (signs, y) = (signs.try_into().unwrap(), y.try_into().unwrap());
        slope.copy_from_slice(&Switched::<N, K, 0>::field(self, (), signs, s, y));
    }
    fn surfaces(&self, (): (), s: f64, y: &[f64], values: &mut [f64]) {
        values.copy_from_slice(&Switched::<N, K, 0>::surfaces(self, (), s, y.try_into().unwrap()));
    }
}

pub type Event<const N: usize> = SwitchEvent<SlidingMode<()>, N>;

/// A run of a system that can be read, with the defaults of the solver but for the tolerance.
pub fn ran<S: Switched<N, K, G, Mode = ()>, const N: usize, const K: usize, const G: usize>(
    system: &Filippov<S, K, G>,
    mode: SlidingMode<()>,
    (s, y): (f64, [f64; N]),
    end: f64,
) -> (Result<Run<SlidingMode<()>, N>, RunError>, Vec<Event<N>>) {
    let start = Start { mode, s, state: State::from(y) };
    let mut events = Vec::new();
    let options = Options::with_tolerance(1e-12);
    (run::<_, _, _, N, G>(Dop853, system, start, end, &options, &mut events), events)
}

/// The same run of the system as a black box.
pub fn sampled<const N: usize, const K: usize, const G: usize>(
    system: &Relays<N, K>,
    (s, y): (f64, [f64; N]),
    end: f64,
) -> (Result<Run<SlidingMode<()>, N>, RunError>, Vec<Event<N>>) {
    let system = SampledFilippov::new(system.clone());
    let start = Start { mode: system.mode((), s, &y).unwrap(), s, state: State::from(y) };
    let mut events = Vec::new();
    let options = Options::with_tolerance(1e-12);
    (run::<_, _, _, N, G>(Dop853, &system, start, end, &options, &mut events), events)
}

/// The switches of a run from a state that needs no choice, both as a system that can be read and
/// as a black box, and its end.
pub fn switches<const N: usize, const K: usize, const G: usize>(
    system: &Relays<N, K>,
    y: [f64; N],
    end: f64,
) -> (Vec<(f64, Vec<SurfaceSide>)>, State<N>) {
    let readable = Filippov::<_, K, G>(system.clone());
    let mode = readable.mode((), 0.0, &State::from(y)).unwrap();
    let (ended, events) = ran::<_, N, K, G>(&readable, mode, (0.0, y), end);
    let ended = ended.unwrap().finished().unwrap();
    let (sampled, others) = sampled::<N, K, G>(system, (0.0, y), end);
    let sampled = sampled.unwrap().finished().unwrap();
    assert_eq!(events.len(), others.len(), "{events:?} {others:?}");
    for (one, other) in events.iter().zip(&others) {
        assert!((one.s - other.s).abs() < 1e-9 && one.to.sides() == other.to.sides());
    }
    assert!((ended.state - sampled.state).amax() < 1e-9 * (1.0 + ended.state.amax()));
    (events.iter().map(|event| (event.s, event.to.sides().to_vec())).collect(), ended.state)
}

/// Why the last switch of a run was refused.
pub fn refused<const N: usize>(
    (ended, events): (Result<Run<SlidingMode<()>, N>, RunError>, Vec<Event<N>>),
) -> Refusal {
    assert!(matches!(ended, Err(RunError::Field { .. })), "{ended:?}");
    events.last().unwrap().to.refusal().unwrap()
}

/// The zero of a function that changes its sign between two places.
pub fn zero(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    assert!(f(a).signum() != f(b).signum(), "{} {}", f(a), f(b));
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if f(middle).signum() == f(a).signum() { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}
