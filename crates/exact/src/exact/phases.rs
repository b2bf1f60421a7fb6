//! The phases of a collision, one after the other.

use stickslip_contact::Contact;

use super::moment::Moment;
use super::normal::Trajectory;
use super::normal::undamped::Undamped;
use super::normal::viscoelastic::{self, Viscoelastic};
use super::slide::Slide;
use super::slip::SlipPhase;
use super::swing::Swing;

/// A phase at its start.
#[expect(clippy::large_enum_variant, reason = "one is alive at a time, and a box would allocate")]
pub enum Phase<'t, T: Trajectory> {
    /// Coulomb sliding.
    Slip(SlipPhase),
    /// The spring follows.
    Stick(Swing<'t, T>),
}

impl<'t, T: Trajectory> Phase<'t, T> {
    /// The phase with which a contact starts.
    pub fn first(slide: &Slide<'t, T>, psi: f64) -> Self {
        if T::STARTS_IN_SLIP {
            Self::Slip(SlipPhase::new(slide.path.impulse(), &slide.path.at(Moment::START), psi))
        } else {
            Self::Stick(Swing::at_impact(slide, psi))
        }
    }
}

/// A question about a collision that is answered for every kind of normal motion.
pub trait Task {
    /// The answer.
    type Output;

    /// Answers the question for `contact`, whose slip phases `slide` describes.
    fn run<T: Trajectory>(self, slide: &Slide<T>, contact: &Contact) -> Self::Output;
}

/// Answers `task` with the normal motion of `contact`.
pub fn with_trajectory<K: Task>(contact: &Contact, task: K) -> K::Output {
    let kappa = contact.kappa();
    if contact.damping() == 0.0 {
        return task.run(&Slide::new(&Undamped, kappa), contact);
    }
    viscoelastic::with(contact.damping(), |path: &Viscoelastic| {
        let unit = path.time_unit();
        task.run(&Slide::new(path, kappa * (unit * unit)), contact)
    })
}
