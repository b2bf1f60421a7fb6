//! Overlap, force and energy of DMT and JKR as polynomials of the variable u.

use stickslip_solver::Number;

use crate::general::decay::Jet;
use crate::law::{ContactEnd, Law, Normal};

/// DMT or JKR, in scaled units.
///
/// ```text
/// DMT   x = u²           F = u³ − f              radius u     contact from u = 0 to u = 0
/// JKR   x = u⁴ − c u     F = u⁶ − (3/2) c u³     radius u²    from u³ = c, x = 0
/// ```
///
/// with f = F_po, and c = (4/3) √f in JKR. That contact ends at u³ = (3/4) c, where the force is
/// least, F = −f, or at u³ = c/4, where the overlap is, and F = −(5/9) f.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// f.
    pub pull_off: f64,
    /// c, which DMT does not have.
    c: Option<f64>,
    /// u where the contact ends.
    pub last: f64,
}

impl Shape {
    pub fn new(law: &Law) -> Self {
        let c = (law.normal == Normal::Jkr).then(|| 4.0 / 3.0 * law.pull_off.sqrt());
        let part = if law.end == ContactEnd::Force { 0.75 } else { 0.25 };
        Self { pull_off: law.pull_off, c, last: c.map_or(0.0, |c| (part * c).cbrt()) }
    }

    /// u where the contact starts.
    pub fn first(&self) -> f64 {
        self.c.map_or(0.0, f64::cbrt)
    }

    /// Whether the contact ends at the overlap at which it starts.
    pub fn starts_at_end(&self) -> bool {
        self.c.is_none()
    }

    /// x.
    pub fn overlap(&self, u: f64) -> f64 {
        self.c.map_or(u * u, |c| u * (u * u * u - c))
    }

    /// dx/du, which is dt/ds, and its derivative.
    #[inline(always)]
    pub fn clock<T: Number>(&self, u: T) -> (T, T) {
        match self.c {
            None => (u * 2.0, T::from(2.0)),
            Some(c) => (u * u * u * 4.0 - c, u * u * 12.0),
        }
    }

    /// The elastic force with two derivatives in u.
    #[inline(always)]
    pub fn elastic<T: Number>(&self, u: T) -> Jet<T> {
        let square = u * u;
        match self.c {
            None => Jet(square * u - self.pull_off, square * 3.0, u * 6.0),
            Some(c) => {
                let cube = square * u;
                let bend = u * (cube * 30.0 - 9.0 * c);
                Jet(cube * (cube - 1.5 * c), square * (cube * 6.0 - 4.5 * c), bend)
            }
        }
    }

    /// The power of u in the contact radius.
    pub fn radius_power(&self) -> i32 {
        if self.c.is_none() { 1 } else { 2 }
    }

    /// A power of the contact radius with two derivatives in u. In DMT the power is not negative.
    #[inline(always)]
    pub fn radius<T: Number>(&self, power: i32, u: T) -> Jet<T> {
        let power = power * self.radius_power();
        let [zero, one] = [0.0, 1.0].map(T::from);
        let (k, l) = (f64::from(power), f64::from(power - 1));
        match power {
            0 => Jet(one, zero, zero),
            1 => Jet(u, one, zero),
            2 => Jet(u * u, u * 2.0, T::from(2.0)),
            _ => Jet(u.powi(power), u.powi(power - 1) * k, u.powi(power - 2) * (k * l)),
        }
    }

    /// dx/du times a power of the contact radius, at least its inverse, and the derivative.
    #[inline(always)]
    pub fn clock_by_radius<T: Number>(&self, power: i32, u: T) -> (T, T) {
        if power == -1 && self.c.is_none() {
            return (T::from(2.0), T::from(0.0));
        }
        let (clock, slope) = self.clock(u);
        let Jet(radius, by, _) = self.radius(power, u);
        (clock * radius, slope * radius + clock * by)
    }

    /// The energy of the compression, 0 at u = 0.
    #[inline(always)]
    fn energy<T: Number>(&self, u: T) -> T {
        let square = u * u;
        match self.c {
            None => square * (square * u * 0.4 - self.pull_off),
            Some(c) => {
                let cube = square * u;
                square * square * (cube * (cube * 0.4 - c) + 0.375 * c * c)
            }
        }
    }

    /// The energy of the compression beyond that at the end of contact.
    #[inline(always)]
    pub fn energy_since_end<T: Number>(&self, u: T) -> T {
        self.energy(u) - self.energy(self.last)
    }

    /// The energy of the compression since the bodies touched.
    pub fn energy_since_touch(&self, u: f64) -> f64 {
        self.energy(u) - self.energy(self.first())
    }
}
