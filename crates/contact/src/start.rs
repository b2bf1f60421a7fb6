//! How near a contact is to starting otherwise.

use crate::adhesive::AdhesiveContact;
use crate::contact::Contact;
use crate::general::GeneralContact;

impl Contact {
    /// How badly the start of contact is conditioned: `None` unless the dashpot exceeds the limit
    /// there and turns the spring over at once
    /// ([`Beginning::Overturned`](crate::general::Beginning::Overturned)).
    ///
    /// In steps, the force is turned over only when the overlap is so many times that of the first
    /// step in contact. Where this is not small beside the ratio of the largest overlap to the
    /// first, a particle code is far from the limit of small steps that is computed here.
    ///
    /// ```
    /// use stickslip_contact::{Contact, presets};
    ///
    /// let law = presets::find("granular/hertz/tsuji/mindlin").ok_or("no such law")?.law;
    /// let contact = Contact::new(3.0, 0.5, 0.3)?.with_law(law, 4.0)?;
    /// assert_eq!(contact.start_layer(), Some(81.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn start_layer(&self) -> Option<f64> {
        match self {
            _ if self.obeys_paper() => None,
            _ if self.law().normal.is_adhesive() => AdhesiveContact::new(*self).start_layer(),
            _ => GeneralContact::new(*self).start_layer(),
        }
    }

    /// How near the contact is to starting otherwise: 1 − the ratio of the tangential force to its
    /// limit at the start, above 0 if it starts in stick. `None` if one of the two grows faster, so
    /// that no other start is near, and with the paper's law.
    ///
    /// κ, ψ or the tangential damping changes the start if it changes by about this part. With a
    /// history of force and without damping, the ratio after i steps in contact is that of the
    /// limit of small steps times 1 + 3/(4i). A particle code is far from the limit where it takes
    /// fewer than some 1/|`start_margin`| steps in contact.
    ///
    /// ```
    /// use stickslip_contact::{Contact, presets};
    ///
    /// // A history of force starts with the ratio (2/3)κψ.
    /// let law = presets::find("granular/hertz/tsuji/mindlin/force").ok_or("no such law")?.law;
    /// let margin = |psi| Contact::new(2.0, psi, 0.0)?.with_law(law, 0.0).map(|it| it.start_margin());
    /// assert!((margin(0.745)?.ok_or("none")? - 1.0 / 150.0).abs() < 1e-15);
    /// assert!(margin(0.755)?.ok_or("none")? < 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn start_margin(&self) -> Option<f64> {
        match self {
            _ if self.obeys_paper() => None,
            _ if self.law().normal.is_adhesive() => AdhesiveContact::new(*self).start_margin(),
            _ => GeneralContact::new(*self).beginning_margins()[0],
        }
    }
}
