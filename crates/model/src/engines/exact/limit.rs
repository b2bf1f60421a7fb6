//! The limit L of the spring along the normal motion, and where the spring can keep up with it.

use super::trajectory::{Half, LARGEST_U, MIDDLE_ROOT, Moment, NormalMotion, speed_at};

/// The largest value of h.
#[derive(Clone, Copy, Debug)]
pub struct Crest {
    /// Its root coordinate, in either half.
    pub root: f64,
    /// h there.
    pub height: f64,
}

impl Crest {
    /// Solves dh/dt = 0, that is u⁴/b + 1/2 = (7/5) u⁵, for b u > 1 at the largest compression.
    pub fn new(kappa: f64, bend: f64) -> Self {
        let scale = kappa / 1.5;
        // From the zero to the largest u the function is concave and falls, so Newton's steps
        // from the right approach the zero from one side.
        let mut u = LARGEST_U;
        for _ in 0..60 {
            let u3 = u * u * u;
            let step =
                (scale * u3 * u + 0.5 - 1.4 * u3 * u * u) / (4.0 * scale * u3 - 7.0 * u3 * u);
            u -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        let mut moment = Moment::near_compression(Half::Compression, u);
        // One Newton step in time, by dv/dt = −u³.
        let error = NormalMotion::at(moment).v - speed_at(u);
        moment.root = (moment.root + error / (2.0 * moment.root * u * u * u)).min(MIDDLE_ROOT);
        let NormalMotion { u, v, deficit } = NormalMotion::at(moment);
        Self { root: moment.root, height: deficit + bend * u * v }
    }
}

/// κL + d²L/dt² = u³ + b (1/(2u) − (7/5) u⁴), what drives the spring and its limit apart.
///
/// In slip it is −dg/dt; in stick D = L ∓ y obeys D̈ + κD = this.
pub fn pull(bend: f64, u: f64) -> f64 {
    u * u * u + bend * (0.5 / u - 1.4 * (u * u) * (u * u))
}
