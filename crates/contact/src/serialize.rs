//! Results as JSON objects, with the names and the order in which the program prints them.
//!
//! This file has the types whose objects differ from their fields; other types derive `Serialize`.

use serde::ser::{Serialize, SerializeStruct, Serializer};

use crate::phase::Side;
use crate::result::Collision;

/// 1 or −1.
impl Serialize for Side {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_i8(match self {
            Self::Positive => 1,
            Self::Negative => -1,
        })
    }
}

/// The contact as `parameters`, and the results, computed ones included.
impl Serialize for Collision {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Collision", 13)?;
        object.serialize_field("parameters", &self.contact)?;
        // Restitutions of bodies that stay together are null.
        if self.adheres {
            object.serialize_field("adheres", &true)?;
        } else {
            object.skip_field("adheres")?;
        }
        object.serialize_field("eps_n", &self.eps_n)?;
        object.serialize_field("eps_t", &self.eps_t())?;
        object.serialize_field("w_final", &self.final_velocity)?;
        object.serialize_field("contact_time", &self.contact_time)?;
        object.serialize_field("switch_count", &self.switches.len())?;
        object.serialize_field("reversals", &self.reversals)?;
        object.serialize_field("itinerary", &self.itinerary())?;
        match self.contact.start_layer() {
            Some(layer) => object.serialize_field("start_layer", &layer)?,
            None => object.skip_field("start_layer")?,
        }
        match self.contact.start_margin() {
            Some(margin) => object.serialize_field("start_margin", &margin)?,
            None => object.skip_field("start_margin")?,
        }
        object.serialize_field("switches", &self.switches[..])?;
        object.serialize_field("energy", &self.energy)?;
        object.end()
    }
}
