//! The largest force and the largest elongation during a contact without damping, in closed form.

use stickslip_contact::{Collision, Regime};

/// The largest normal force in scaled units, (5/4)^{3/5}. It is κ times the largest elongation of
/// the spring.
pub const FORCE: f64 = 1.1432626298183158660;

/// The largest |y| during `collision`; `None` with damping, where the largest force has no closed
/// form.
///
/// In slip the spring is at its limit, which is largest in the middle of the contact. In stick it
/// is longest where the velocity vanishes.
///
/// ```
/// use stickslip_model::{Contact, exact};
/// use stickslip_model::limits::largest;
///
/// let collision = exact::collide(Contact::new(18.0, 1.5, 0.0)?)?;
/// let largest = largest::spring(&collision).ok_or("damped")?;
/// assert!((18.0 * largest - largest::FORCE).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn spring(collision: &Collision) -> Option<f64> {
    if collision.contact.damping() > 0.0 {
        return None;
    }
    let kappa = collision.contact.kappa();
    let middle = 0.5 * collision.contact_time;
    let mut largest = 0.0_f64;
    let (mut regime, mut since, mut start) = (collision.start, 0.0, None);
    let mut close = |regime, since: f64, start: Option<(f64, f64)>, time: f64, end: (f64, f64)| {
        let ends = start.map_or(0.0, |(spring, _): (f64, f64)| spring.abs()).max(end.0.abs());
        let inside = match (regime, start) {
            (Regime::Slip, _) if since <= middle && middle <= time => FORCE / kappa,
            (Regime::Stick, Some((spring, velocity))) => {
                let half_turn = kappa.sqrt() * (time - since) >= std::f64::consts::PI;
                if half_turn || (velocity < 0.0) != (end.1 < 0.0) {
                    spring.hypot(velocity / kappa.sqrt())
                } else {
                    0.0
                }
            }
            _ => 0.0,
        };
        largest = largest.max(ends).max(inside);
    };
    for switch in &collision.switches {
        let here = (switch.spring, switch.velocity);
        close(regime, since, start, switch.time, here);
        (regime, since, start) = (switch.to, switch.time, Some(here));
    }
    close(regime, since, start, collision.contact_time, (0.0, collision.final_velocity));
    Some(largest)
}
