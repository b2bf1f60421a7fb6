//! The impact oscillator x″ + cx′ + kx = A cos ωt, x ≤ d, v → −ev, whose orbits with one impact in
//! n periods of the force have a closed form.

use std::f64::consts::{PI, TAU};

use stickslip_expression::System;
use stickslip_orbits::{Guess, Orbit, OrbitError, Orbits, Verdict};
use stickslip_solver::{EmbeddedPair, Options};

pub const TEXT: &str = include_str!("../../../../examples/orbits/oscillator.slip");

/// The closed form at parameters, with n periods of the force.
#[derive(Clone, Copy, Debug)]
pub struct Closed {
    pub k: f64,
    pub c: f64,
    pub d: f64,
    pub a: f64,
    pub w: f64,
    pub e: f64,
    pub n: usize,
}

impl Closed {
    pub const EXAMPLE: Self = Self { k: 1.0, c: 0.1, d: 1.0, a: 1.0, w: 1.0, e: 0.8, n: 1 };

    pub fn parameters(&self) -> [f64; 6] {
        [self.k, self.c, self.d, self.a, self.w, self.e]
    }
    fn period(&self) -> f64 {
        TAU * self.n as f64 / self.w
    }
    fn free(&self, t: f64) -> [f64; 4] {
        let rate = (self.k - self.c * self.c / 4.0).sqrt();
        let (sin, cos) = (rate * t).sin_cos();
        let decay = (-self.c * t / 2.0).exp();
        let half = self.c * sin / (2.0 * rate);
        [cos + half, sin / rate, -self.k * sin / rate, cos - half].map(|it| it * decay)
    }
    pub fn impedance(&self) -> f64 {
        (self.k - self.w * self.w).hypot(self.c * self.w)
    }
    fn pq(&self) -> (f64, f64) {
        let [h11, h12, h21, h22] = self.free(self.period());
        let det = (h11 - 1.0) * (h22 - 1.0) - h12 * h21;
        let (r1, r2) = (self.e * h12, 1.0 + self.e * h22);
        (((h22 - 1.0) * r1 - h12 * r2) / det, ((h11 - 1.0) * r2 - h21 * r1) / det)
    }
    /// The speeds before the impact.
    pub fn speeds(&self) -> Vec<f64> {
        let (p, q) = self.pq();
        let (d, size) = (self.d, self.a / self.impedance());
        let (a, b) = (p * p + (q / self.w).powi(2), -p * d);
        let c = d * d - size * size;
        let root = (b * b - a * c).sqrt();
        if root.is_nan() { Vec::new() } else { vec![(-b + root) / a, (-b - root) / a] }
    }
    /// The phase of the force at the impact.
    pub fn phase(&self, v: f64) -> f64 {
        let (p, q) = self.pq();
        let shift = (self.c * self.w).atan2(self.k - self.w * self.w);
        let phase = (q * v / self.w).atan2(self.d - p * v) + shift;
        (phase + PI).rem_euclid(TAU) - PI
    }
    pub fn trace(&self, v: f64) -> f64 {
        let [h11, h12, _, h22] = self.free(self.period());
        let force = self.a * self.phase(v).cos() - self.k * self.d;
        -self.e * (h11 + h22) + (1.0 + self.e) * h12 * force / v
    }
    pub fn determinant(&self) -> f64 {
        self.e * self.e * (-self.c * self.period()).exp()
    }
    /// The amplitude at which both speeds are one.
    pub fn fold(&self) -> f64 {
        let (p, q) = self.pq();
        self.d * self.impedance() * q.abs() / (self.w * p).hypot(q)
    }
    /// Whether a run from the middle between two impacts, by its events alone, has one impact in
    /// n periods of the force, when the next one is expected.
    pub fn is_followed(&self, orbits: &Orbits, v: f64) -> bool {
        let shift = (self.c * self.w).atan2(self.k - self.w * self.w);
        let (size, phase, half) = (self.a / self.impedance(), self.phase(v), self.period() / 2.0);
        let forced = |t: f64| {
            let (sin, cos) = (self.w * t + phase - shift).sin_cos();
            [size * cos, -self.w * size * sin]
        };
        let [h11, h12, h21, h22] = self.free(half);
        let ([x, u], [later_x, later_u]) = (forced(0.0), forced(half));
        let (x, u) = (self.d - x, -self.e * v - u);
        let turned = (self.w * half + phase + PI).rem_euclid(TAU) - PI;
        let state = [h11 * x + h12 * u + later_x, h21 * x + h22 * u + later_u, turned];
        let times = impacts(orbits, &self.parameters(), (0.0, &state), 2.0 * half);
        matches!(times[..], [time] if (time - half).abs() < 1e-6 * half)
    }
    /// How far the wall is between impacts, at least.
    pub fn room(&self, v: f64) -> f64 {
        let shift = (self.c * self.w).atan2(self.k - self.w * self.w);
        let (size, phase) = (self.a / self.impedance(), self.phase(v));
        let forced = |t: f64| size * (self.w * t + phase - shift).cos();
        let slope = -self.w * size * (phase - shift).sin();
        let (x, u) = (self.d - forced(0.0), -self.e * v - slope);
        let count = 20_000;
        let places = (1..count).map(|k| {
            let t = self.period() * f64::from(k) / f64::from(count);
            let [h11, h12, ..] = self.free(t);
            self.d - (h11 * x + h12 * u + forced(t))
        });
        places.fold(f64::INFINITY, f64::min)
    }
}

pub fn orbits() -> Orbits {
    Orbits::new(&System::parse(TEXT).expect("a system")).expect("orbits")
}

/// When a run from a state has an event of its first rule, within a time.
pub fn impacts(
    orbits: &Orbits,
    parameters: &[f64],
    (s, state): (f64, &[f64]),
    time: f64,
) -> Vec<f64> {
    let run = orbits.system().with(parameters).expect("values");
    let run = run.starting(None, Some(s), Some(state)).expect("a start");
    let options = Options { max_switches: 12, ..Options::with_tolerance(1e-12) };
    let mut events = Vec::new();
    let _ = run.events(EmbeddedPair::Dop853, s + time, &options, &mut events).expect("a run");
    events.iter().filter(|event| event.guard == 0).map(|event| event.s).collect()
}

/// The orbit with this speed, searched for beside it.
pub fn near(orbits: &Orbits, closed: &Closed, v: f64, aside: f64) -> Result<Orbit, OrbitError> {
    let phase = closed.phase(v);
    let state = [closed.d, -closed.e * v * (1.0 + aside), phase + aside];
    let mut itinerary = vec!["phase"; closed.n];
    itinerary.push("impact");
    let mut durations = vec![TAU / closed.w; itinerary.len()];
    durations[0] = (PI - phase) / closed.w;
    durations[itinerary.len() - 1] = (phase + PI) / closed.w;
    let (state, durations) = (Some(&state[..]), Some(&durations[..]));
    let guess = Guess { state, itinerary: &itinerary, durations, ..Guess::default() };
    orbits.find(&closed.parameters(), &guess)
}

#[test]
fn the_reference_at_unit_frequency() {
    let orbits = orbits();
    let guess = Guess { itinerary: &["impact", "phase"], ..Guess::default() };
    let orbit = orbits.find(&orbits.system().values(), &guess).expect("an orbit");
    let v = orbit.segments[0].end[1];
    assert!((v - 1.695732937595).abs() < 1e-12, "{v}");
    assert!((orbit.segments[0].end[2] - 0.075952164938).abs() < 1e-12);
    assert!((orbit.period - TAU).abs() < 1e-13);
    let multipliers = orbit.multipliers.as_ref().expect("no graze");
    assert_eq!(multipliers.len(), 2);
    // The trace and the determinant have more digits.
    let [trace, determinant] = [-1.168590628683_f64, 0.341432378298];
    let exact = [trace / 2.0, (determinant - trace * trace / 4.0).sqrt()];
    assert!((exact[0] + 0.58429531).abs() < 1e-8 && (exact[1] - 0.00560035).abs() < 1e-8);
    assert!((multipliers[0][0] - exact[0]).abs() < 1e-12, "{multipliers:?}");
    assert!((multipliers[0][1] - exact[1]).abs() < 1e-10, "{multipliers:?}");
    assert_eq!(orbit.verdict, Verdict::Admissible);
}

#[test]
fn random_parameters_have_the_orbits_of_the_closed_form() {
    random_sets(54, 150);
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn thousand_parameters_have_the_orbits_of_the_closed_form() {
    random_sets(55, 1000);
}

/// Compares so many sets of parameters that have an orbit.
fn random_sets(seed: u64, count: usize) {
    let orbits = orbits();
    let mut random = fastrand::Rng::with_seed(seed);
    let (mut sets, mut compared, mut admissible, mut worst) = (0, 0, 0, [0.0_f64; 3]);
    while sets < count {
        let before = compared;
        let mut draw = |low: f64, high: f64| low + (high - low) * random.f64();
        let closed = Closed {
            k: draw(0.5, 2.0),
            c: draw(0.02, 0.6),
            d: draw(0.2, 1.5),
            a: draw(0.1, 3.0),
            w: draw(0.4, 3.0),
            e: draw(0.3, 1.0),
            n: random.usize(1..4),
        };
        for v in closed.speeds() {
            let room = closed.room(v);
            if v < 0.01 || room.abs() < 1e-7 || (closed.phase(v).abs() - PI).abs() < 0.01 {
                continue;
            }
            let orbit = near(&orbits, &closed, v, 1e-4);
            let orbit = orbit.unwrap_or_else(|error| panic!("{closed:?} {v}: {error}"));
            let end = &orbit.segments.last().expect("segments").end;
            if (end[1] - v).abs() > 1e-6 {
                // Another orbit with the same itinerary.
                continue;
            }
            compared += 1;
            let [one, other] = orbit.multipliers.clone().expect("no graze")[..] else {
                panic!("two multipliers")
            };
            let trace = one[0] + other[0];
            let determinant = one[0] * other[0] - one[1] * other[1];
            let size = orbit.largest_multiplier().max(1.0);
            for (worst, error) in worst.iter_mut().zip([
                (end[1] - v).abs() / v,
                (trace - closed.trace(v)).abs() / size,
                (determinant - closed.determinant()).abs() / size,
            ]) {
                *worst = worst.max(error);
            }
            match orbit.verdict {
                Verdict::Admissible => assert!(room > 0.0, "{closed:?} {v}: room {room}"),
                Verdict::Virtual(_) => assert!(room < 0.0, "{closed:?} {v}: room {room}"),
                Verdict::Undecided(ref reason) => panic!("{closed:?} {v}: {reason}"),
            }
            assert_eq!(orbit.is_admissible(), closed.is_followed(&orbits, v), "{closed:?} {v}");
            admissible += usize::from(orbit.is_admissible());
        }
        sets += usize::from(compared > before);
    }
    println!("{sets} sets, {compared} orbits, {admissible} admissible, errors {worst:?}");
    assert!(4 * admissible > count && 4 * (compared - admissible) > count);
    assert!(worst.iter().all(|error| *error < 1e-9), "{worst:?}");
}

/// Beside the graze the impact has a small speed. An orbit whose speed is negative has hit the wall
/// just before, and is not followed, however near that is.
#[test]
fn grazing_impacts_have_the_side_of_their_speed() {
    let orbits = orbits();
    let mut decided = 0;
    for w in [0.8, 1.2] {
        for part in [-1e-3, -1e-5, -1e-6, -1e-7, -1e-9, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3] {
            let closed = Closed { w, ..Closed::EXAMPLE };
            let closed = Closed { a: closed.impedance() * (1.0 + part), ..closed };
            let speeds = closed.speeds().into_iter().filter(|v| v.abs() < 0.01);
            for v in speeds {
                let Ok(orbit) = near(&orbits, &closed, v, 0.0) else { continue };
                let own = orbit.segments.last().expect("segments").end[1];
                if (own - v).abs() > 1e-3 * v.abs() {
                    continue;
                }
                match orbit.verdict {
                    Verdict::Admissible => assert!(v > 0.0, "{w} {part} {v}"),
                    Verdict::Virtual(_) => assert!(v < 0.0, "{w} {part} {v}: {:?}", orbit.verdict),
                    Verdict::Undecided(_) => continue,
                }
                decided += 1;
            }
        }
    }
    assert!(decided >= 14, "{decided}");
}
