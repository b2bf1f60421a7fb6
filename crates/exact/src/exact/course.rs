//! The normal motion of a contact at any time.

use stickslip_contact::Contact;

use super::moment::{Moment, Motion};
use super::normal::Trajectory;
use super::normal::undamped::Undamped;
use super::normal::viscoelastic::{self, Viscoelastic};

/// The normal motion of a contact at one time, in scaled variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalState {
    /// Compression x.
    pub compression: f64,
    /// Its rate v.
    pub velocity: f64,
    /// Normal force F.
    pub force: f64,
}

/// The normal motion of a contact that obeys the paper's law, a scaled time after its start; before
/// the start and after the end it is that at the start or the end. It does not depend on κ and ψ.
///
/// Errors are a few units of rounding. Cost: 0.1 µs without damping, 0.5 µs with it, and as much as
/// a collision if the thread's last contact had another damping.
///
/// ```
/// use stickslip_contact::Contact;
/// use stickslip_exact::exact;
///
/// let contact = Contact::new(63.0, 0.5, 0.0)?;
/// let middle = exact::normal_state(&contact, 0.5 * exact::CONTACT_TIME);
/// // The largest compression is (5/4)^{2/5}, and F = x^{3/2}.
/// assert!((middle.compression - 1.25_f64.powf(0.4)).abs() < 1e-15);
/// assert!((middle.force - middle.compression.powf(1.5)).abs() < 1e-15);
/// assert!(middle.velocity.abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn normal_state(contact: &Contact, time: f64) -> NormalState {
    if contact.damping() == 0.0 {
        return on(&Undamped, time);
    }
    viscoelastic::with(contact.damping(), |path: &Viscoelastic| on(path, time))
}

fn on<T: Trajectory>(path: &T, time: f64) -> NormalState {
    let unit = path.time_unit();
    let time = time.max(0.0) / unit;
    let motion = path.motion(path.after(&path.at(Moment::START), time, 0.0));
    let [compression, velocity, force] = motion.normal();
    NormalState { compression: compression * unit, velocity, force: force / unit }
}
