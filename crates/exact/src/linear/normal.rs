//! The normal motion: a damped oscillator that starts at x = 0 with the rate 1.

use stickslip_contact::{Contact, ContactEnd};

use super::oscillator::Oscillator;

/// Times at which the force vanishes are centres: with S(z) = sin(νz)/ν, p = a/2 and the time left
/// z until F = 0,
///
/// ```text
/// F = e^{−pt} S(z)     dF/dt = −e^{−pt} (p S(z) + cos νz)     v = e^{−pt} S(z − τ)
/// ```
///
/// where τ, half of the time of that zero, is the time of greatest compression. For a ≥ 2 sines are
/// hyperbolic.
#[derive(Clone, Copy, Debug)]
pub struct Normal {
    /// The oscillator.
    pub oscillator: Oscillator,
    /// The time at which the force vanishes.
    pub force_ends: f64,
    /// The time between that and the end of contact.
    pub rest: f64,
    /// Whether the normal force attracts in the rest.
    pub attracts: bool,
    /// The time of greatest compression.
    crest: f64,
}

/// A time of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// The time since the start of contact.
    pub time: f64,
    /// The time until the force vanishes; negative behind that.
    pub left: f64,
}

/// Parts of a contact between which the sign of the normal force changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The force repels.
    Main,
    /// The force attracts.
    Tail,
}

/// The normal motion at a moment.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// The limit L = |F|.
    pub limit: f64,
    /// dL/dt.
    pub slope: f64,
    /// −∫ L dt, apart from a constant.
    pub rate: f64,
}

impl Stage {
    /// The sign of the normal force.
    pub fn sign(self) -> f64 {
        if self == Self::Tail { -1.0 } else { 1.0 }
    }
}

impl Moment {
    /// The moment after a part of a phase that began at this one. `left` is the time until the
    /// force vanishes there.
    pub fn after(&self, place: Place) -> Self {
        Self { time: self.time + place.since, left: place.left }
    }
}

/// A moment of a phase: both times are accurate relative to themselves.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// The time since the phase began.
    pub since: f64,
    /// The time until the force vanishes; negative behind that.
    pub left: f64,
}

impl Normal {
    pub fn new(contact: &Contact) -> Self {
        let a = contact.damping();
        let oscillator = Oscillator::new(a, 1.0);
        let Oscillator { half, frequency, oscillates, .. } = oscillator;
        let crest = match (oscillates, frequency > 0.0) {
            (true, _) => frequency.atan2(half) / frequency,
            (false, true) => frequency.asinh() / frequency,
            (false, false) => 1.0,
        };
        let law = contact.law();
        let attracts = a > 0.0 && law.end == ContactEnd::Overlap && !law.limit_damping;
        let rest = match law.end {
            ContactEnd::Overlap if attracts => 2.0 * half.asin() / frequency,
            // Nothing pushes any more: x = a e^{−aτ} and v = −e^{−aτ}.
            ContactEnd::Overlap => a,
            ContactEnd::Force => 0.0,
        };
        Self { oscillator, force_ends: 2.0 * crest, rest, attracts, crest }
    }

    /// The start of contact.
    pub fn start(&self) -> Moment {
        Moment { time: 0.0, left: self.force_ends }
    }

    /// The moment at which the force vanishes.
    pub fn zero(&self) -> Moment {
        Moment { time: self.force_ends, left: 0.0 }
    }

    /// How long a phase may last that begins at `moment` in `stage`.
    pub fn longest(&self, moment: &Moment, stage: Stage) -> f64 {
        match stage {
            Stage::Main => moment.left,
            Stage::Tail => moment.left + self.rest,
        }
    }

    /// S and its derivative.
    fn swing(&self, z: f64) -> (f64, f64) {
        let Oscillator { frequency, oscillates, .. } = self.oscillator;
        if frequency == 0.0 {
            return (z, 1.0);
        }
        let angle = frequency * z;
        let (sine, cosine) =
            if oscillates { angle.sin_cos() } else { (angle.sinh(), angle.cosh()) };
        (sine / frequency, cosine)
    }

    /// The limit and its slope.
    #[inline]
    pub fn limit(&self, stage: Stage, moment: &Moment) -> (f64, f64) {
        let p = self.oscillator.half;
        let decay = stage.sign() * (-p * moment.time).exp();
        let (sine, cosine) = self.swing(moment.left);
        (decay * sine, -decay * (p * sine + cosine))
    }

    /// The motion at a moment.
    pub fn at(&self, stage: Stage, moment: &Moment) -> Motion {
        let (limit, slope) = self.limit(stage, moment);
        let decay = stage.sign() * (-self.oscillator.half * moment.time).exp();
        Motion { limit, slope, rate: decay * self.swing(moment.left - self.crest).0 }
    }

    /// The place in a phase from `start` at which A L + B dL/dt vanishes, if there is one in its
    /// stage: there is at most one, since L and dL/dt alternate.
    pub fn zero_of(&self, a: f64, b: f64, start: &Moment, stage: Stage) -> Option<Place> {
        let Oscillator { frequency, oscillates, half, .. } = self.oscillator;
        // With the formula above: tan(νz)/ν = B/(A − pB).
        let rest = a - half * b;
        let left = if oscillates {
            let angle = (b * frequency).atan2(rest);
            let angle = if angle <= 0.0 { angle + std::f64::consts::PI } else { angle };
            match stage {
                Stage::Main => angle / frequency,
                Stage::Tail => (angle - std::f64::consts::PI) / frequency,
            }
        } else if frequency > 0.0 {
            (b * frequency / rest).atanh() / frequency
        } else {
            b / rest
        };
        let since = start.left - left;
        let inside = since > 0.0 && since < self.longest(start, stage);
        (inside && (stage == Stage::Tail || left > 0.0)).then_some(Place { since, left })
    }

    /// The coefficient of normal restitution.
    pub fn restitution(&self) -> f64 {
        let Oscillator { damping, half, .. } = self.oscillator;
        if self.attracts {
            (-half * (self.force_ends + self.rest)).exp()
        } else {
            (-damping * self.crest).exp()
        }
    }

    /// The energy that damping takes, and that in the compression at the end, in units of m g_n².
    pub fn energy(&self, end: ContactEnd) -> (f64, f64) {
        let a = self.oscillator.damping;
        let kept = self.restitution();
        let lost = match end {
            _ if self.attracts => -0.5 * (-a * (self.force_ends + self.rest)).exp_m1(),
            _ => -0.5 * (-2.0 * a * self.crest).exp_m1(),
        };
        // At F = 0 the overlap is a times the rate.
        let compression = if self.attracts { 0.0 } else { 0.5 * a * a * kept * kept };
        match end {
            ContactEnd::Force => (lost - compression, compression),
            ContactEnd::Overlap => (lost, 0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip_contact::{Damping, Law, Normal as Elastic};

    fn normal(damping: f64) -> Normal {
        let law = Law { normal: Elastic::Linear, damping: Damping::Linear, ..Law::PAPER };
        let contact = Contact::new(1.0, 1.0, damping).unwrap();
        Normal::new(&contact.with_law(law, 0.0).unwrap())
    }

    #[test]
    fn the_motion_starts_and_ends_as_it_must() {
        for damping in [0.0, 1e-9, 0.5, 1.9, 2.0 - 1e-9, 2.0, 2.0 + 1e-9, 7.0, 1e4] {
            let normal = normal(damping);
            let start = normal.at(Stage::Main, &normal.start());
            let scale = 1.0 + damping * damping;
            assert!((start.limit - damping).abs() < 1e-13 * scale, "{damping}");
            assert!((start.slope - (1.0 - damping * damping)).abs() < 1e-13 * scale, "{damping}");
            assert!((start.rate - 1.0).abs() < 1e-12, "{damping} {start:?}");
            let end = normal.at(Stage::Main, &normal.zero());
            assert_eq!(end.limit, 0.0);
            assert!((end.rate + normal.restitution()).abs() < 1e-13, "{damping}");
            let (lost, left) = normal.energy(ContactEnd::Force);
            let kept = 0.5 * end.rate * end.rate;
            assert!((lost + left + kept - 0.5).abs() < 1e-13, "{damping}");
        }
    }

    #[test]
    fn its_rates_are_those_of_the_oscillator() {
        for damping in [0.0, 0.5, 1.99, 2.0, 3.0, 40.0] {
            let normal = normal(damping);
            let early = Moment { time: 0.1, left: normal.force_ends - 0.1 };
            let motion = normal.at(Stage::Main, &early);
            let response = normal.oscillator.after(0.1);
            let rate = response.ds;
            let limit = response.s + damping * rate;
            assert!((motion.limit - limit).abs() < 1e-13 * (1.0 + damping), "{damping}");
            assert!((motion.rate - rate).abs() < 1e-12, "{damping}");
            assert!((motion.slope - rate + damping * limit).abs() < 1e-12 * (1.0 + damping));
        }
    }
}
