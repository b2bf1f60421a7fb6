//! A damped oscillator, z̈ + c ż + k z = 0, under- and overdamped.

/// The constants of an oscillator.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator {
    /// c.
    pub damping: f64,
    /// k.
    pub stiffness: f64,
    /// c/2.
    pub half: f64,
    /// μ = √|k − c²/4|.
    pub frequency: f64,
    /// Whether it oscillates: k > c²/4.
    pub oscillates: bool,
    /// The slower rate of decay where it does not oscillate.
    pub slow: f64,
    /// A bound on all rates.
    pub fast: f64,
}

/// What follows from a unit velocity at time 0, at a later time.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// S with S(0) = 0 and Ṡ(0) = 1.
    pub s: f64,
    /// Ṡ.
    pub ds: f64,
    /// S̈.
    pub dds: f64,
    /// C = Ṡ + c S, with C(0) = 1 and Ċ(0) = 0. Its rate is −k S.
    pub c: f64,
}

/// Terms of the series of [`Oscillator::position_integral`], below [`NEAR`].
const TERMS: u32 = 18;
/// Times the fastest rate, up to which 1 − C is a series.
const NEAR: f64 = 0.5;

impl Oscillator {
    /// The oscillator with the damping c ≥ 0 and the stiffness k > 0.
    pub fn new(damping: f64, stiffness: f64) -> Self {
        let (half, root) = (0.5 * damping, stiffness.sqrt());
        let square = (root - half) * (root + half);
        let (frequency, oscillates) = (square.abs().sqrt(), square > 0.0);
        let slow = stiffness / (half + frequency);
        let fast = root.max(damping);
        Self { damping, stiffness, half, frequency, oscillates, slow, fast }
    }

    /// The response after a time of 0 or more.
    #[inline]
    pub fn after(&self, time: f64) -> Response {
        let Self { damping, stiffness, half, frequency, slow, .. } = *self;
        if self.oscillates {
            let decay = (-half * time).exp();
            let (sine, cosine) = (frequency * time).sin_cos();
            let s = decay * sine / frequency;
            let (cosine, drag) = (decay * cosine, half * s);
            let ds = cosine - drag;
            return Response { s, ds, dds: -damping * ds - stiffness * s, c: cosine + drag };
        }
        let spread = 2.0 * frequency;
        let decay = (-slow * time).exp();
        let rest = (-spread * time).exp();
        let part = if spread > 0.0 { -(-spread * time).exp_m1() / spread } else { time };
        let lag = slow * part;
        Response {
            s: decay * part,
            ds: decay * (rest - lag),
            dds: decay * (slow * lag - damping * rest),
            c: decay * (1.0 + lag),
        }
    }

    /// ∫ S dt from 0 to `time`, which is (1 − C)/k, accurate relative to itself.
    pub fn position_integral(&self, time: f64, response: &Response) -> f64 {
        let Self { damping, stiffness, fast, oscillates, slow, .. } = *self;
        if time * fast > NEAR {
            let fallen = if oscillates {
                1.0 - response.c
            } else {
                // C = e^{−λt} + λ S.
                -(-slow * time).exp_m1() - slow * response.s
            };
            return fallen / stiffness;
        }
        // P̈ + c Ṗ + k P = 1.
        let (mut before, mut term) = (0.0, 0.5 * time * time);
        let mut sum = term;
        for n in 3..TERMS {
            let n = f64::from(n);
            let next = -(damping * term + stiffness * before * time / (n - 1.0)) * time / n;
            (before, term) = (term, next);
            sum += next;
        }
        sum
    }

    /// The size of the terms of p S + q Ṡ − r S̈ after `time`, and of what rounding of the time
    /// makes of them: the sum has an error of a few times ε of this.
    pub fn size(&self, factors: [f64; 3], time: f64) -> f64 {
        let Self { damping, stiffness, half, frequency, oscillates, slow, .. } = *self;
        let [p, q, r] = factors.map(f64::abs);
        if oscillates {
            let longest = time.min(1.0 / frequency);
            let swing = q * (1.0 + half * longest) + r * damping;
            let turn = (p + r * (half * damping + stiffness)) * longest;
            return (-half * time).exp() * (swing + turn) * (1.0 + frequency * time);
        }
        let spread = 2.0 * frequency * time;
        let part = if spread > 1.0 { 0.5 / frequency } else { time };
        let (rest, lag) = ((-spread).exp() * (1.0 + spread), slow * part);
        let swing = p * part + q * (rest + lag) + r * (damping * rest + slow * lag);
        (-slow * time).exp() * swing * (1.0 + slow * time)
    }

    /// A bound on all values of p S + q Ṡ − r S̈ after `time`; infinite where there are no swings.
    pub fn amplitude(&self, [p, q, r]: [f64; 3], time: f64) -> f64 {
        let Self { damping, stiffness, half, frequency, oscillates, .. } = *self;
        if !oscillates {
            return f64::INFINITY;
        }
        // e^{−ct/2} times a sum of sine and cosine.
        let cosine = q + damping * r;
        let sine = (p + stiffness * r - half * cosine) / frequency;
        (-half * time).exp() * cosine.hypot(sine)
    }

    /// How often a value that starts at `position` with `velocity` and is `now` after `time` has
    /// changed its sign.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of half swings, which the range of κ bounds"
    )]
    pub fn sign_changes(&self, position: f64, velocity: f64, now: f64, time: f64) -> usize {
        let changed = position * now < 0.0 || (position < 0.0) != (now < 0.0);
        if !self.oscillates {
            return usize::from(changed);
        }
        let sine = (velocity + self.half * position) / self.frequency;
        let start = 0.5 - sine.atan2(position) / std::f64::consts::PI;
        let end = start + self.frequency * time / std::f64::consts::PI;
        let count = (end.floor() - start.floor()).max(0.0) as usize;
        // Rounding may have counted a zero at one of the ends.
        match (count.is_multiple_of(2), changed) {
            (true, true) | (false, false) if end - end.floor() < 0.5 && count > 0 => count - 1,
            (true, true) | (false, false) => count + 1,
            _ => count,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Under-, critically and overdamped.
    const CASES: [(f64, f64); 6] =
        [(0.0, 1.0), (0.3, 7.0), (2.0, 1.0), (2.0, 0.999_999), (9.0, 2.0), (1e4, 1e-2)];

    #[test]
    fn responses_compose() {
        for (damping, stiffness) in CASES {
            let oscillator = Oscillator::new(damping, stiffness);
            for (one, two) in [(0.1, 0.7), (1e-5, 2.0), (3.0, 0.4)] {
                let [first, second, both] = [one, two, one + two].map(|t| oscillator.after(t));
                // The state after both times is that after the second from the state after the
                // first.
                let s = first.s * second.c + first.ds * second.s;
                assert!((s - both.s).abs() < 1e-14 * (1.0 + both.s.abs()), "{damping} {stiffness}");
                let c = first.c * second.c - stiffness * first.s * second.s;
                assert!((c - both.c).abs() < 1e-14 * (1.0 + both.c.abs()), "{damping} {stiffness}");
            }
        }
    }

    #[test]
    fn the_integral_has_no_seam() {
        for (damping, stiffness) in CASES {
            let oscillator = Oscillator::new(damping, stiffness);
            let edge = NEAR / oscillator.fast;
            let at = |time: f64| oscillator.position_integral(time, &oscillator.after(time));
            let [below, above] = [edge * (1.0 - 1e-15), edge * (1.0 + 1e-15)].map(at);
            assert!((below - above).abs() < 2e-14 * above, "{damping} {stiffness}");
            assert!((at(1e-8) / 0.5e-16 - 1.0).abs() < damping.max(1.0) * 1e-8);
        }
    }

    #[test]
    fn sign_changes_are_counted() {
        let oscillator = Oscillator::new(0.0, 4.0);
        for (time, count) in [(0.1, 0), (0.8, 1), (2.4, 2), (3.2, 2)] {
            let now = (2.0_f64 * time).cos();
            assert_eq!(oscillator.sign_changes(1.0, 0.0, now, time), count);
        }
    }
}
