//! The normal force of bodies with adhesion, at an overlap, as LAMMPS has it.
//!
//! With the contact radius r in scaled units:
//!
//! ```text
//! DMT   r = √x             F = r³ − F_po               from x = 0 to x = 0
//! JKR   x = r² − c √r      F = r³ − (3/2) c r^{3/2}    from x = 0 to a negative overlap
//! ```
//!
//! Source: LAMMPS, `gran_sub_mod_normal_kernel.h` (commit 07b704c). Its closed form of JKR's radius
//! is the largest root of the same quartic.

use stickslip_model::{ContactEnd, Law, Normal};

/// DMT or JKR.
#[derive(Clone, Copy, Debug)]
pub(super) struct Adhesion {
    /// F_po.
    pub pull_off: f64,
    /// c = (4/3) √F_po in JKR, and the roots of r where x is least and where it is 0.
    c: Option<[f64; 3]>,
    /// The overlap at which a contact ends.
    pub last: f64,
}

impl Adhesion {
    /// The adhesion of `law`, if it has any.
    pub fn new(law: &Law) -> Option<Self> {
        let pull_off = law.pull_off;
        let c = match law.normal {
            Normal::Linear | Normal::Hertz => return None,
            Normal::Dmt => None,
            Normal::Jkr => Some(4.0 / 3.0 * pull_off.sqrt()),
        };
        let c = c.map(|c| [c, (0.25 * c).cbrt(), c.cbrt()]);
        let last = c.map_or(0.0, |[c, ..]| match law.end {
            ContactEnd::Force => -0.25 * c * (0.75 * c).cbrt(),
            ContactEnd::Overlap => -3.0 * (0.25 * c).powf(4.0 / 3.0),
        });
        Some(Self { pull_off, c, last })
    }

    /// The contact radius at the overlap `x`.
    pub fn radius(&self, x: f64) -> f64 {
        let Some([c, least, touch]) = self.c else { return x.sqrt() };
        // u = √r is the largest root of u⁴ − c u − x, which is convex above its least value: from
        // above Newton's steps fall to the root, until rounding stops them.
        let mut u = touch + f64::max(x, 0.0).sqrt().sqrt();
        loop {
            let cube = u * u * u;
            let next = (u - (u * (cube - c) - x) / (4.0 * cube - c)).max(least);
            if next >= u || next.is_nan() {
                return u * u;
            }
            u = next;
        }
    }

    /// The elastic force at a contact radius, and its slope over the overlap.
    pub fn elastic(&self, radius: f64) -> [f64; 2] {
        let root = radius.sqrt();
        let cube = radius * radius * radius;
        match self.c {
            None => [cube - self.pull_off, 1.5 * radius],
            Some([c, ..]) => {
                let slope = radius * (6.0 * radius * root - 4.5 * c) / (4.0 * radius * root - c);
                [cube - 1.5 * c * radius * root, slope * root]
            }
        }
    }
}
