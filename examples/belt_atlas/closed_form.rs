//! The belt without an integrator: every phase is a sum of sines.
//!
//! Roots are found in steps. A bound of the second derivative proves that no step passes a root.
//! The boundary beside a point is found by Newton's method. No code is shared with the solver or
//! the tracer.

use std::f64::consts::FRAC_PI_2;

use stickslip::tracer::Point;

use super::{BELT, Belt, OBSERVED, POSITION};

/// The function offset + slope·t + Σ a sin(ωt + φ).
#[derive(Clone, Copy)]
struct Sines {
    offset: f64,
    slope: f64,
    /// Amplitude a, frequency ω and phase φ.
    waves: [[f64; 3]; 2],
}

impl Sines {
    /// The value at the time `t`.
    fn at(&self, t: f64) -> f64 {
        let waves = self.waves.map(|[a, omega, phase]| a * (omega * t + phase).sin());
        self.offset + self.slope * t + waves.iter().sum::<f64>()
    }

    /// The derivative.
    fn rate(&self) -> Self {
        let waves = self.waves.map(|[a, omega, phase]| [a * omega, omega, phase + FRAC_PI_2]);
        Self { offset: self.slope, slope: 0.0, waves }
    }

    /// The function with the opposite sign.
    fn reflected(&self) -> Self {
        let waves = self.waves.map(|[a, omega, phase]| [-a, omega, phase]);
        Self { offset: -self.offset, slope: -self.slope, waves }
    }

    /// A bound of the function. It must be a second or higher derivative, without offset and slope.
    fn bound(&self) -> f64 {
        self.waves.iter().map(|[a, ..]| a.abs()).sum()
    }

    /// The first zero after `start`, where the function is positive, or rises from a zero of this
    /// order; `None` if there is none before the end of the run.
    fn falls(&self, start: f64, order: i32) -> Option<f64> {
        let (rate, second) = (self.rate(), self.rate().rate());
        // By Taylor's formula the function is positive up to twice this time after the start.
        let opening = match order {
            0 => 0.0,
            1 => rate.at(start) / second.bound(),
            _ => 1.5 * second.at(start) / second.rate().bound(),
        };
        let (mut t, most) = (start + opening, second.bound());
        while t < OBSERVED {
            let (value, slope) = (self.at(t), rate.at(t));
            // The zero of the lower bound value + slope·τ − most·τ²/2.
            let step = 2.0 * value / ((slope * slope + 2.0 * most * value).sqrt() - slope);
            if value <= 0.0 || step < 1e-15 * t {
                return Some(t);
            }
            t += step;
        }
        None
    }
}

/// A phase, with its guard: u in slip and −w in stick.
#[derive(Clone, Copy)]
struct Phase {
    start: f64,
    slips: bool,
    guard: Sines,
}

impl Phase {
    /// The time at which the guard fires. In slip it starts from a double zero.
    fn end(&self) -> Option<f64> {
        self.guard.falls(self.start, if self.slips { 2 } else { 0 })
    }

    /// The time of the minimum of the guard that is nearest to zero.
    fn touch(&self) -> Option<f64> {
        let rate = self.guard.rate();
        let mut rises = self.slips || rate.at(self.start) > 0.0;
        let (mut t, mut order) = (self.start, i32::from(self.slips));
        let mut nearest: Option<f64> = None;
        while let Some(extremum) = if rises { rate } else { rate.reflected() }.falls(t, order) {
            let size = |t: f64| self.guard.at(t).abs();
            if !rises && nearest.is_none_or(|nearest| size(extremum) < size(nearest)) {
                nearest = Some(extremum);
            }
            (t, order, rises) = (extremum, 1, !rises);
        }
        nearest
    }
}

impl Belt {
    /// The stick phase that begins at `start` with the excess `excess` of the load.
    fn stick(&self, start: f64, excess: f64) -> Phase {
        let wave = [self.amplitude, self.frequency, FRAC_PI_2];
        let mut guard = Sines { offset: 0.0, slope: -BELT, waves: [wave, [0.0, 1.0, 0.0]] };
        guard.offset = -excess - guard.at(start);
        Phase { start, slips: false, guard }
    }

    /// The slip phase that begins at `start`.
    fn slip(&self, start: f64) -> Phase {
        let Self { frequency, amplitude } = *self;
        let forced = amplitude * frequency / (1.0 - frequency * frequency);
        let (sine, cosine) = (frequency * start).sin_cos();
        // u = v + a sin τ − b cos τ + forced·sin Ωt with τ = t − start and u = u′ = 0 at the start.
        let (a, b) = (-forced * frequency * cosine, BELT + forced * sine);
        let own = [a.hypot(b), 1.0, -start - b.atan2(a)];
        let guard = Sines { offset: BELT, slope: 0.0, waves: [own, [forced, frequency, 0.0]] };
        Phase { start, slips: true, guard }
    }

    /// The phases of a run.
    fn phases(&self) -> impl Iterator<Item = Phase> {
        let first = self.stick(0.0, POSITION - self.amplitude - 1.0);
        std::iter::successors(Some(first), |phase| {
            let end = phase.end()?;
            // The excess w is u′ where a slip ends.
            Some(if phase.slips {
                self.stick(end, phase.guard.rate().at(end))
            } else {
                self.slip(end)
            })
        })
    }

    /// The number of switches before the end of the run.
    pub fn switches(&self) -> usize {
        self.phases().count() - 1
    }

    /// Whether the load falls to −1 while the mass sticks.
    pub fn overtakes(&self) -> bool {
        let phases: Vec<Phase> = self.phases().collect();
        let ends = phases.iter().skip(1).map(|next| next.start).chain([OBSERVED]);
        phases.iter().zip(ends).filter(|(phase, _)| !phase.slips).any(|(phase, end)| {
            let mut above = phase.guard.reflected();
            above.offset += 2.0;
            above.falls(phase.start, 0).is_some_and(|fall| fall < end)
        })
    }

    /// The value of the guard after this number of switches, at the end of the run or at its
    /// minimum nearest to zero, with the time since the phase began.
    fn margin(&self, switches: usize, at_end: bool) -> Option<(f64, f64)> {
        let phase = self.phases().nth(switches)?;
        let place = if at_end { OBSERVED } else { phase.touch()? };
        Some((phase.guard.at(place), place - phase.start))
    }
}

/// The distance of `point` from a boundary along `normal`, by Newton's method. `None` if the phase
/// is shorter than 0.02, so that its sines cancel.
pub fn distance(point: &Point, normal: &Point, switches: usize, at_end: bool) -> Option<f64> {
    const REACH: f64 = 1e-10;
    let margin = |away: f64| {
        let place = point + normal * away;
        let belt = Belt { frequency: place.x, amplitude: place.y };
        belt.margin(switches, at_end)
    };
    let mut away = 0.0;
    for _ in 0..10 {
        let (here, lasts) = margin(away)?;
        if lasts < 0.02 {
            return None;
        }
        let step = 2.0 * REACH * here / (margin(away + REACH)?.0 - margin(away - REACH)?.0);
        away -= step;
        if step.abs() < 1e-11 {
            return Some(away);
        }
    }
    panic!("Newton's method does not converge at {point:?}")
}
