//! The normal motion without damping: one universal trajectory, known in closed form.
//!
//! As v² + (4/5) x^{5/2} = 1, time is an incomplete beta function of the compression. Let r be the
//! square root of the time to the nearer end of contact. Then √x/r and (1 − |v|)/r⁵ are analytic
//! functions of r⁵. Their nearest singularity is the far end of contact, 5.7 times as far away as
//! the largest compression. Two short polynomials therefore give them to rounding, and small
//! quantities near either end keep their relative accuracy.

mod meeting;
mod refined_exit;

use crate::exact::moment::{At, Half, Moment, Motion, Spring};
use crate::exact::normal::{ORDER, StickPhase, Trajectory};
use crate::exact::slip::SlipPhase;
use meeting::{crest, meeting};
use refined_exit::refined_exit;
use stickslip_contact::EnergyLedger;

/// Duration of the contact, t_c = (4/5)(5/4)^{2/5} B(2/5, 1/2).
pub const CONTACT_TIME: f64 = 3.21806545971904308453593;

/// The exact duration of the contact minus [`CONTACT_TIME`].
pub const CONTACT_TIME_REST: f64 = 7.5689901148521077495e-17;

/// √(t_c/2), the root coordinate of the largest compression.
pub const MIDDLE_ROOT: f64 = 1.26847653894722134205163;

/// √x at the largest compression, (5/4)^{1/5}.
pub const LARGEST_U: f64 = 1.04563955259127323065299;

/// Coefficients of (√x/r − 1)/r⁵ in powers of r⁵ on 0 ≤ r⁵ ≤ (t_c/2)^{5/2}; the error of √x/r is
/// below 1e-17.
///
/// The polynomial through the 12 Chebyshev nodes of that interval, computed with 50 digits from
/// t = x · ₂F₁(2/5, 1/2; 7/5; (4/5) x^{5/2}).
const U_EXCESS: [f64; 12] = [
    -0.057142857142857142795,
    0.00122448979591836189789,
    -0.0000356714114216326722837,
    4.54801586236941599253e-7,
    -1.94808893874463397402e-8,
    -5.02366900255238573334e-11,
    -1.6773781363857680687e-11,
    -4.66290963988210699364e-13,
    -2.53296056513602286028e-14,
    -1.34951347539162822632e-15,
    -8.86788107720213985134e-18,
    -6.86646992740783468199e-18,
];

/// Coefficients of (1 − |v|)/r⁵ in powers of r⁵, computed as [`U_EXCESS`].
const DEFICIT_OVER_ROOT5: [f64; 12] = [
    0.399999999999999999957,
    -0.0342857142857142819126,
    0.00179591836734688353483,
    -0.0000713428228431084530286,
    0.00000240701846508674371077,
    -7.21946859628434721568e-8,
    1.99737702571495980466e-9,
    -5.1695187211192573343e-11,
    1.2770462258009853509e-12,
    -2.99499082572567646247e-14,
    6.51210217620659304176e-16,
    -9.92195001942052843787e-18,
];

/// Coefficients of the time to the nearer end divided by x, in powers of |v|; the relative error is
/// below 1e-8.
///
/// The polynomial through the 11 Chebyshev nodes of 0 ≤ |v| ≤ 1.
const TIME_OVER_X: [f64; 11] = [
    1.47163759003008026,
    -0.79999948199515546,
    0.588633911801585778,
    -0.479658241799852694,
    0.409162725415945307,
    -0.350067619836438919,
    0.280874738987213145,
    -0.19120397187012126,
    0.0975417790965897812,
    -0.0317389857490199065,
    0.00481755702258528943,
];

/// The normal motion without damping. The root coordinate of a moment is the square root of the
/// time to the nearer end of contact.
#[derive(Clone, Copy, Debug)]
pub struct Undamped;

/// The normal motion at a moment.
#[derive(Clone, Copy, Debug)]
pub struct NormalMotion {
    /// √x, the root of the compression.
    pub u: f64,
    /// v = dx/dt, 1 at the start and −1 at the end of contact.
    pub v: f64,
    /// 1 − |v|, with a relative error near rounding.
    pub deficit: f64,
}

impl NormalMotion {
    /// u − r at root coordinate `r`. It is so small that r and it together have more digits of u
    /// than one number.
    pub fn excess(r: f64) -> f64 {
        let z = r * r * (r * r) * r;
        r * (z * polynomial(&U_EXCESS, z))
    }

    /// The normal motion at `moment`, with relative errors of a few 1e-16 in u and 1 − |v|.
    pub fn at(moment: Moment) -> Self {
        let r = moment.root;
        let z = r * r * (r * r) * r;
        let u = r + Self::excess(r);
        let deficit = z * polynomial(&DEFICIT_OVER_ROOT5, z);
        let speed = 1.0 - deficit;
        let v = match moment.half {
            Half::Compression => speed,
            Half::Decompression => -speed,
        };
        Self { u, v, deficit }
    }
}

impl Motion for NormalMotion {
    fn normal(&self) -> [f64; 3] {
        [self.u * self.u, self.v, self.u * self.u * self.u]
    }

    fn deficit(&self) -> f64 {
        self.deficit
    }

    fn limit(&self, spring: &Spring) -> f64 {
        self.u * self.u * self.u / spring.kappa
    }

    fn limit_rate(&self, spring: &Spring) -> f64 {
        spring.bend * self.u * self.v
    }

    fn pull(&self, spring: &Spring) -> f64 {
        pull(spring.bend, self.u)
    }
}

/// κL + L̈ = u³ + b (1/(2u) − (7/5) u⁴).
pub fn pull(bend: f64, u: f64) -> f64 {
    u * u * u + bend * (0.5 / u - 1.4 * (u * u) * (u * u))
}

impl Trajectory for Undamped {
    type Motion = NormalMotion;

    const STARTS_IN_SLIP: bool = true;
    const REFINES: bool = true;

    fn motion(&self, moment: Moment) -> NormalMotion {
        NormalMotion::at(moment)
    }

    fn middle(&self) -> [f64; 2] {
        [MIDDLE_ROOT; 2]
    }

    fn restitution(&self) -> f64 {
        1.0
    }

    fn energy(&self) -> EnergyLedger {
        EnergyLedger { normal_initial: 0.5, normal_final: 0.5, ..EnergyLedger::default() }
    }

    fn contact_time(&self) -> f64 {
        CONTACT_TIME
    }

    fn impulse(&self) -> f64 {
        2.0
    }

    fn near_time(&self, at: &At<NormalMotion>) -> f64 {
        at.moment.root * at.moment.root
    }

    fn elapsed(&self, from: &At<NormalMotion>, to: &At<NormalMotion>) -> f64 {
        let (first, last) = (from.moment.root, to.moment.root);
        match (from.moment.half, to.moment.half) {
            (Half::Compression, Half::Compression) => (last - first) * (last + first),
            (Half::Decompression, Half::Decompression) => (first - last) * (first + last),
            _ => self.time_left(from) - self.time_left(to),
        }
    }

    fn time_along_root(&self, at: &At<NormalMotion>) -> [f64; 2] {
        let sign = at.moment.half.sign();
        [sign * 2.0 * at.moment.root, sign * 2.0]
    }

    fn after(&self, from: &At<NormalMotion>, duration: f64, _: f64) -> Moment {
        let time = self.time(from) + duration;
        if time < 0.5 * CONTACT_TIME {
            Moment { half: Half::Compression, root: time.sqrt() }
        } else {
            let left = self.time_left(from) - duration;
            let root = left.max(0.0).sqrt().min(MIDDLE_ROOT);
            Moment { half: Half::Decompression, root }
        }
    }

    fn before(&self, until: &At<NormalMotion>, duration: f64, _: f64) -> Moment {
        let mirrored = Moment { half: until.moment.half.other(), ..until.moment };
        let mirrored = self.after(&At { moment: mirrored, ..*until }, duration, 0.0);
        Moment { half: mirrored.half.other(), ..mirrored }
    }

    fn exit_after_impact(&self, _: &Spring, _: f64) -> Option<Moment> {
        None
    }

    fn above(&self, force: f64, _: f64) -> Option<[Moment; 2]> {
        // The moments are known to 1e-8 only: a slightly larger force is on the safe side.
        let u = (force * (1.0 + 1e-7)).cbrt();
        (u < LARGEST_U).then(|| {
            let root = root_near(u);
            [Half::Compression, Half::Decompression].map(|half| Moment { half, root })
        })
    }

    fn last_time_at(&self, force: f64) -> Option<Moment> {
        // √x is about the root coordinate.
        let root = force.cbrt().min(MIDDLE_ROOT);
        Some(Moment { half: Half::Decompression, root })
    }

    fn turns(&self, spring: &Spring) -> Option<[Moment; 2]> {
        crest(spring)
            .map(|root| [Half::Compression, Half::Decompression].map(|half| Moment { half, root }))
    }

    /// L is least at the end itself.
    fn beyond_end(&self) -> f64 {
        0.0
    }

    fn split(&self) -> Moment {
        Moment { half: Half::Compression, root: MIDDLE_ROOT }
    }

    fn meeting(&self, spring: &Spring, sliding: &SlipPhase, low: Moment, high: Moment) -> Moment {
        meeting(spring, sliding, low, high)
    }

    fn refined_exit(&self, stick: &StickPhase, sign: f64, end: Moment, rate: f64) -> Moment {
        refined_exit(stick, sign, end, rate)
    }

    fn series_radius(&self, at: &At<NormalMotion>) -> f64 {
        self.near_time(at)
    }

    /// From ẋ = v, v̇ = −F and xḞ = (3/2) F v.
    fn force_series(&self, at: &At<NormalMotion>) -> [f64; ORDER] {
        let numbered = || (0_u8..).map(f64::from).enumerate();
        let NormalMotion { u, v: speed, .. } = at.motion;
        let [mut x, mut v, mut f] = [[0.0; ORDER]; 3];
        x[0] = u * u;
        v[0] = speed;
        f[0] = u * u * u;
        for (n, order) in numbered().take(ORDER - 1) {
            x[n + 1] = v[n] / (order + 1.0);
            v[n + 1] = -f[n] / (order + 1.0);
            // (n + 1) x₀ F_{n+1} = (3/2) Σ_j F_j v_{n−j} − Σ_j j F_j x_{n+1−j}
            let terms = numbered().take(n + 1);
            let sum: f64 =
                terms.map(|(j, power)| f[j] * (1.5 * v[n - j] - power * x[n + 1 - j])).sum();
            f[n + 1] = sum / ((order + 1.0) * x[0]);
        }
        f
    }
}

/// The root coordinate at which √x = `u`; its error is 1e-8 of the time to the nearer end.
fn root_near(u: f64) -> f64 {
    let speed = speed_at(u);
    let ratio = TIME_OVER_X.iter().rev().fold(0.0, |sum, coefficient| sum * speed + coefficient);
    (u * ratio.sqrt()).min(MIDDLE_ROOT)
}

/// |v| at √x = `u`, with an error of 1e-16/|v|.
fn speed_at(u: f64) -> f64 {
    (1.0 - 0.8 * u * (u * u) * (u * u)).max(0.0).sqrt()
}

/// The value of a polynomial. Even and odd powers are summed separately: two short dependency
/// chains instead of a long one.
fn polynomial(c: &[f64; 12], z: f64) -> f64 {
    let z2 = z * z;
    let even = ((((c[10] * z2 + c[8]) * z2 + c[6]) * z2 + c[4]) * z2 + c[2]) * z2 + c[0];
    let odd = ((((c[11] * z2 + c[9]) * z2 + c[7]) * z2 + c[5]) * z2 + c[3]) * z2 + c[1];
    odd * z + even
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of the compression with evenly spread roots, and with roots that go to 0.
    fn moments() -> impl Iterator<Item = Moment> {
        let spread = (0..=1000).map(|i| f64::from(i) / 1000.0);
        let small = (1..60).map(|i| 0.5_f64.powi(i));
        spread.chain(small).map(|part| Moment { half: Half::Compression, root: part * MIDDLE_ROOT })
    }

    #[test]
    fn energy_is_conserved() {
        for moment in moments() {
            let NormalMotion { u, v, deficit } = NormalMotion::at(moment);
            // v² + (4/5)u⁵ = 1, relative to 1 − v
            let potential = 0.8 * u * (u * u) * (u * u);
            assert!((deficit * (1.0 + v) - potential).abs() <= 1.5e-15 * potential, "{moment:?}");
        }
    }

    #[test]
    fn compression_obeys_newtons_law() {
        // 1 − v = ∫ x^{3/2} dt = ∫ 2r u³ dr, by Gauss's rule with three points on 200 pieces.
        let nodes = [(-0.6_f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)];
        let half_piece = 0.5 * MIDDLE_ROOT / 200.0;
        let mut sum = 0.0;
        for piece in 0..200 {
            let middle = f64::from(2 * piece + 1) * half_piece;
            for (node, weight) in nodes {
                let root = middle + node * half_piece;
                let u = NormalMotion::at(Moment { half: Half::Compression, root }).u;
                sum += weight * half_piece * 2.0 * root * u * u * u;
            }
            let root = middle + half_piece;
            let deficit = NormalMotion::at(Moment { half: Half::Compression, root }).deficit;
            assert!((sum - deficit).abs() < 2e-14, "{root}: {sum} {deficit}");
        }
    }

    #[test]
    fn largest_compression_is_the_closed_form() {
        for half in [Half::Compression, Half::Decompression] {
            let normal = NormalMotion::at(Moment { half, root: MIDDLE_ROOT });
            assert!((normal.u - LARGEST_U).abs() < 3e-16);
            assert!((normal.u * normal.u - 1.09336207394327805637).abs() < 5e-16);
            assert!(normal.v.abs() < 1e-15);
        }
        assert!((2.0 * MIDDLE_ROOT * MIDDLE_ROOT - CONTACT_TIME).abs() < 1e-15);
    }

    #[test]
    fn moments_move_both_ways() {
        for moment in moments() {
            let from = Undamped.at(moment);
            for duration in [1e-9, 0.1, 1.7, 3.0] {
                let later = Undamped.at(Undamped.after(&from, duration, 0.0));
                let passed = Undamped.time(&later) - Undamped.time(&from);
                let ended = later.moment == Moment::END;
                assert!((passed - duration).abs() < 1e-15 || ended);
                if !ended {
                    assert!((Undamped.elapsed(&from, &later) - duration).abs() < 1e-15);
                    let back = Undamped.at(Undamped.before(&later, duration, 0.0));
                    assert!((Undamped.time(&back) - Undamped.time(&from)).abs() < 2e-15);
                }
            }
            let near = root_near(from.motion.u);
            assert!((near - moment.root).abs() <= 1e-8 * moment.root, "{moment:?}");
        }
    }
}
