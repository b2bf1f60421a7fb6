//! What is read off a contact as a hybrid system, whatever its equations are.

use stickslip_solver::State;

use super::{ContactMode, STATE};
use crate::contact::Contact;

/// A contact with the components and modes of [`general`](crate::general): one of any law, or one
/// with adhesion.
pub trait ContactSystem: Copy {
    /// The parameters of the contact.
    fn contact(&self) -> Contact;

    /// The same system, with an event at every reversal of the tangential velocity.
    #[must_use]
    fn with_reversals(self) -> Self;

    /// The mode in which the contact starts.
    fn first(&self) -> ContactMode;

    /// The state at the start of contact, or soon after it.
    fn start(&self) -> State<STATE>;

    /// The state at a time before that of [`Self::start`].
    fn state_before_start(&self, _time: f64) -> State<STATE> {
        self.start()
    }

    /// Reduced tangential velocity w.
    fn velocity(&self, y: &State<STATE>) -> f64;

    /// Rate v of the overlap.
    fn compression_rate(&self, y: &State<STATE>) -> f64;

    /// Overlap x.
    fn overlap(&self, mode: ContactMode, y: &State<STATE>) -> f64;

    /// Energy of the compression, 0 where the bodies touch.
    fn compression_energy(&self, y: &State<STATE>) -> f64;

    /// How long the overlap goes on after the force has ended in the state `y`: where the force is
    /// limited, nothing pushes any more.
    fn flight(&self, _mode: ContactMode, _y: &State<STATE>) -> f64 {
        0.0
    }

    /// How fast time grows with s.
    fn clock_rate(&self, y: &State<STATE>) -> f64;

    /// Tangential energy that the dashpot has taken in stick.
    fn taken_by_dashpot(&self, y: &State<STATE>) -> f64;

    /// Scaled normal force F.
    fn normal_force(&self, mode: ContactMode, y: &State<STATE>) -> f64;

    /// Coulomb's limit of the tangential force.
    fn limit(&self, mode: ContactMode, y: &State<STATE>) -> f64;

    /// The tangential force Q against the motion, in units of μ times the scaled normal force.
    fn tangential_force(&self, mode: ContactMode, y: &State<STATE>) -> f64;

    /// The tangential force over κ: the elongation of a spring of this stiffness. With κ = 0 the
    /// force itself.
    fn spring(&self, mode: ContactMode, y: &State<STATE>) -> f64 {
        self.tangential_force(mode, y) / self.contact().force_unit()
    }

    /// The guard of a slip that is missing behind a contact that ends in the state `y`, and how
    /// long that slip lasts.
    fn last_slip(&self, _mode: ContactMode, _y: &State<STATE>) -> Option<(usize, f64)> {
        None
    }
}
