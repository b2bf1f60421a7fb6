//! How far an integrated collision is from other switches.
//!
//! A guard that does not fire is nearest to doing so at its minima, and at the end of contact. A
//! guard that fires is as far from not doing so as it would fall below 0 if its phase went on,
//! which the normal motion of the rest of the run tells.

use stickslip_solver::{Dense, HybridSystem, Observer, State, SwitchEvent};

use crate::laws::phase::{END, GUARDS, OTHER_SIDE, Phase, Regime, SAME_SIDE};
use crate::laws::regularized::Regularized;
use crate::laws::regularized::components::{STATE, T, U};

/// The least margin of a run that it observes. It is for contacts with damping.
pub struct Nearest {
    system: Regularized,
    omega: f64,
    /// The least margin so far, as a velocity.
    least: f64,
    /// Time at which the phase began.
    since: f64,
    /// Phases that a guard has ended, and that would not be over yet without it.
    prolonged: Vec<Prolonged>,
}

/// A phase beyond its end.
struct Prolonged {
    regime: Regime,
    /// The side of the spring at the end.
    side: f64,
    /// Time, rate of compression, elongation and velocity at the end.
    end: [f64; 4],
    /// The end in s.
    s: f64,
    /// The slope of the guard at the end as a velocity by s, and a bound of its bend afterwards.
    slope: f64,
    bend: f64,
    /// How far below 0 the guard comes, as a velocity.
    depth: f64,
}

impl Nearest {
    /// Nothing has been observed yet. A margin above ψ, at which the contact starts, does not
    /// count.
    pub fn new(system: Regularized) -> Self {
        let (omega, least) = (system.contact().kappa().sqrt(), system.contact().psi());
        Self { system, omega, least, since: 0.0, prolonged: Vec::new() }
    }

    /// The least margin, as a velocity.
    pub fn velocity(&self) -> f64 {
        self.least
    }

    /// How much velocity a unit of the guards of `phase` is: a gap of the spring counts √κ times,
    /// as in the norm √(w² + κy²).
    fn unit(&self, phase: Phase, y: &State<STATE>) -> f64 {
        match phase.regime {
            Regime::Stick => 1.0 / self.omega,
            Regime::Slip => 1.0 / (2.0 * y[U] * self.omega * self.omega),
        }
    }

    fn rates(&self, phase: Phase, y: &State<STATE>) -> [f64; GUARDS] {
        self.system.guard_rates(phase, 0.0, y)
    }

    fn values(&self, phase: Phase, y: &State<STATE>) -> [f64; GUARDS] {
        HybridSystem::guard_values(&self.system, phase, 0.0, y)
    }

    /// The slope of the guard that ended a phase at `event`, and a bound of its bend afterwards.
    fn slope_and_bend(&self, event: &SwitchEvent<Phase, STATE>) -> (f64, f64) {
        /// Part of the scale of s on which a difference is taken.
        const REACH: f64 = 1e-5;
        let (phase, y) = (event.from, &event.before);
        let reach = REACH / (1.0 + self.system.contact().damping());
        let ahead = y + HybridSystem::field(&self.system, phase, 0.0, y) * reach;
        let [slope, after] = [y, &ahead].map(|y| self.rates(phase, y)[event.guard]);
        let mut bend = 2.0 * ((after - slope) / reach).abs();
        if phase.regime == Regime::Stick {
            // On the rest of its swing the spring bends as much as at its amplitude.
            let (u, v) = (y[U], self.system.compression_rate(y).abs());
            let elongation = self.system.spring(phase, y);
            let speed = self.system.velocity(y).hypot(self.omega * elongation);
            bend += self.omega * self.omega * speed * (2.0 * v + 4.0 * u * u * self.omega);
        }
        (slope.abs(), bend)
    }

    /// Goes on with the phases that are over to the state `y` at `s`, where the spring's limit is
    /// `limit`.
    fn prolong(&mut self, s: f64, y: &State<STATE>, limit: f64) {
        let (time, v) = (self.since + y[T], self.system.compression_rate(y));
        let limit_rate = self.system.limit_rate(y);
        let (omega, least) = (self.omega, &mut self.least);
        self.prolonged.retain_mut(|phase| {
            let [since, v0, elongation, velocity] = phase.end;
            let below = match phase.regime {
                Regime::Stick => {
                    let (sin, cos) = (omega * (time - since)).sin_cos();
                    phase.side * (omega * elongation * cos + velocity * sin) - omega * limit
                }
                // s w − v is constant.
                Regime::Slip => limit_rate - (phase.side * velocity + v - v0),
            };
            let length = (s - phase.s).min(phase.slope / phase.bend);
            let at_least = length * (phase.slope - 0.5 * phase.bend * length);
            let falls = below.max(at_least) > phase.depth;
            phase.depth = phase.depth.max(below).max(at_least);
            if !falls {
                *least = least.min(phase.depth);
            }
            // A guard that is below all margins so far is not the nearest one.
            falls && phase.depth < *least
        });
    }

    /// The least value of `guard` inside a step on which it falls and then rises.
    fn minimum(&self, phase: Phase, step: &Dense<STATE>, guard: usize) -> f64 {
        let rate = |theta: f64| self.rates(phase, &step.at(theta))[guard];
        let [mut low, mut high] = [0.0, 1.0].map(|theta| (theta, rate(theta)));
        // Regula falsi, which halves the value at the end that stays. The guard is flat here: half
        // of the digits of θ suffice.
        for _ in 0..30 {
            if high.0 - low.0 < 1e-9 || high.1 - low.1 <= 0.0 {
                break;
            }
            let theta = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let value = rate(theta);
            if value < 0.0 {
                low = (theta, value);
                high.1 *= 0.5;
            } else {
                high = (theta, value);
                low.1 *= 0.5;
            }
            if value == 0.0 {
                break;
            }
        }
        let y = step.at(if -low.1 < high.1 { low.0 } else { high.0 });
        self.values(phase, &y)[guard].abs() * self.unit(phase, &y)
    }
}

impl Observer<Phase, STATE> for Nearest {
    const WANTS_SEGMENTS: bool = true;

    fn on_segment(&mut self, phase: Phase, step: &Dense<STATE>) {
        let [before, after] = [0.0, 1.0].map(|theta| self.rates(phase, &step.at(theta)));
        for guard in [SAME_SIDE, OTHER_SIDE] {
            if before[guard] < 0.0 && after[guard] > 0.0 {
                self.least = self.least.min(self.minimum(phase, step, guard));
            }
        }
        let y = step.at(1.0);
        let limit = self.system.normal_force(&y) / self.system.contact().kappa();
        self.prolong(step.start() + step.size(), &y, limit);
    }

    fn on_switch(&mut self, event: &SwitchEvent<Phase, STATE>) {
        if event.guard != END {
            let (phase, y) = (event.from, &event.before);
            let elongation = self.system.spring(phase, y);
            self.since += y[T];
            let end =
                [self.since, self.system.compression_rate(y), elongation, self.system.velocity(y)];
            let (slope, bend) = self.slope_and_bend(event);
            let unit = self.unit(phase, y);
            self.prolonged.push(Prolonged {
                regime: phase.regime,
                side: elongation.signum(),
                end,
                s: event.s,
                slope: slope * unit,
                bend: bend * unit,
                depth: 0.0,
            });
        }
    }

    fn on_end(&mut self, phase: Phase, s: f64, y: &State<STATE>) {
        self.prolong(s, y, 0.0);
        let at_end = match phase.regime {
            Regime::Slip => self.values(phase, y)[SAME_SIDE].abs() * self.unit(phase, y),
            // The last slip is too short for the integrator.
            Regime::Stick => self.omega * self.system.spring(phase, y).abs(),
        };
        let depths = self.prolonged.iter().map(|phase| phase.depth);
        self.least = depths.fold(self.least.min(at_end), f64::min);
    }
}
