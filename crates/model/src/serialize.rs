//! Results as JSON objects, with the names and the order in which the program prints them.
//!
//! This file has the types whose objects differ from their fields; other types derive `Serialize`.

use serde::de::{self, Deserialize, Deserializer};
use serde::ser::{Serialize, SerializeStruct, Serializer};
use stickslip_contact::{Contact, Law, Normal};

use crate::engines::{Engine, Tolerances};
use crate::spheres::Vector3;
use crate::spheres::encounter::{Encounter, Motion};
use crate::spheres::outcome::EnergyAccount;
use crate::spheres::report::ImpactReport;

/// `name`, and for an integrator `rtol` and `atol`.
impl Serialize for Engine {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let tolerances = self.tolerances();
        let fields = if tolerances.is_some() { 3 } else { 1 };
        let mut object = serializer.serialize_struct("Engine", fields)?;
        object.serialize_field("name", self.name())?;
        if let Some(tolerances) = tolerances {
            object.serialize_field("rtol", &tolerances.rtol)?;
            object.serialize_field("atol", &tolerances.atol)?;
        }
        object.end()
    }
}

/// The object that [`Engine`] serialises as.
#[derive(serde::Deserialize)]
struct EngineFields {
    name: String,
    rtol: Option<f64>,
    atol: Option<f64>,
}

impl<'de> Deserialize<'de> for Engine {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let EngineFields { name, rtol, atol } = EngineFields::deserialize(deserializer)?;
        let tolerances = rtol.zip(atol).map(|(rtol, atol)| Tolerances { rtol, atol });
        match (name.as_str(), tolerances) {
            ("dop853", Some(tolerances)) => Ok(Self::Dop853(tolerances)),
            ("dopri5", Some(tolerances)) => Ok(Self::Dopri5(tolerances)),
            ("exact", None) => Ok(Self::Exact),
            ("auto", None) => Ok(Self::Auto),
            _ => Err(de::Error::custom(
                "not an engine; expected dop853 or dopri5 with rtol and atol, or exact or auto",
            )),
        }
    }
}

/// The geometry of the contact and its velocities.
impl Serialize for Encounter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Encounter", 5)?;
        object.serialize_field("point_m", &components(&self.contact_point_m))?;
        object.serialize_field("normal", &components(&self.normal))?;
        object.serialize_field("tangent", &self.tangent.as_ref().map(components))?;
        object.serialize_field("normal_m_per_s", &self.normal_m_per_s)?;
        object.serialize_field("tangential_m_per_s", &self.tangential_m_per_s)?;
        object.end()
    }
}

/// Position, velocity and spin, as arrays.
impl Serialize for Motion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Motion", 3)?;
        object.serialize_field("position_m", &components(&self.position_m))?;
        object.serialize_field("velocity_m_per_s", &components(&self.velocity_m_per_s))?;
        object.serialize_field("spin_rad_per_s", &components(&self.spin_rad_per_s))?;
        object.end()
    }
}

/// The entries in J without the unit in their names, and what they leave unexplained.
impl Serialize for EnergyAccount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("EnergyAccount", 9)?;
        object.serialize_field("kinetic_before", &self.kinetic_before_j)?;
        object.serialize_field("kinetic_after", &self.kinetic_after_j)?;
        object.serialize_field("work_of_wall", &self.work_of_wall_j)?;
        object.serialize_field("sliding", &self.sliding_j)?;
        object.serialize_field("damping", &self.damping_j)?;
        object.serialize_field("tangential_damping", &self.tangential_damping_j)?;
        object.serialize_field("spring_left", &self.spring_left_j)?;
        object.serialize_field("compression_left", &self.compression_left_j)?;
        object.serialize_field("unbalanced", &self.unbalanced_j())?;
        object.end()
    }
}

/// Schema "stickslip.impact/1" without `schema`, `method` and `statistics`.
impl Serialize for ImpactReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let outcome = &self.outcome;
        let spheres: Vec<_> = self.spheres().iter().map(MotionAfter).collect();
        let mut object = serializer.serialize_struct("ImpactReport", 15)?;
        object.serialize_field("parameters", &ScaledParameters(self))?;
        object.serialize_field("contact", &self.encounter)?;
        // What bodies that stay together do not have is null.
        if outcome.adheres {
            object.serialize_field("adheres", &true)?;
        } else {
            object.skip_field("adheres")?;
        }
        object.serialize_field("eps_n", &outcome.eps_n)?;
        object.serialize_field("eps_t", &outcome.eps_t)?;
        object.serialize_field("contact_time_s", &outcome.contact_time_s)?;
        object.serialize_field("switch_count", &outcome.switches.len())?;
        object.serialize_field("reversals", &self.reversals())?;
        object.serialize_field("itinerary", &self.itinerary())?;
        object.serialize_field("spheres", &spheres)?;
        object.serialize_field("impulse_n_s", &components(&outcome.impulse_n_s))?;
        object.serialize_field("switches", &outcome.switches[..])?;
        object.serialize_field("energy_j", &outcome.energy)?;
        object.serialize_field("observed", &outcome.observed)?;
        object.serialize_field("comparison", &self.comparison)?;
        object.end()
    }
}

/// The scaled parameters of an impact, and the units that lead back to SI.
struct ScaledParameters<'a>(&'a ImpactReport);

impl Serialize for ScaledParameters<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let impact = &self.0.encounter.impact;
        let (pair, contact): (_, &Contact) = (&impact.pair, &impact.contact);
        let mut object = serializer.serialize_struct("ScaledParameters", 12)?;
        object.serialize_field("kappa", &contact.kappa())?;
        object.serialize_field("psi", &self.0.psi())?;
        object.serialize_field("damping", &contact.damping())?;
        object.serialize_field("alpha", &pair.alpha)?;
        object.serialize_field("effective_mass_kg", &pair.effective_mass_kg)?;
        object.serialize_field("effective_radius_m", &pair.effective_radius_m)?;
        if pair.law.normal == Normal::Linear {
            object.serialize_field("elastic_constant_n_per_m", &pair.elastic_constant)?;
        } else {
            object.serialize_field("elastic_constant_n_per_m1_5", &pair.elastic_constant)?;
        }
        if pair.law != Law::PAPER {
            object.serialize_field("tangential_damping", &contact.tangential_damping())?;
            let Law { friction, pull_off, .. } = contact.law();
            object.serialize_field("law", &Law { friction, pull_off, ..pair.law })?;
        }
        object.serialize_field("time_unit_s", &impact.time_unit_s)?;
        object.serialize_field("length_unit_m", &impact.length_unit_m())?;
        object.serialize_field("force_unit_n", &impact.force_unit_n())?;
        object.end()
    }
}

/// The motion of a sphere after the contact. Its position is that at impact and is left out.
struct MotionAfter<'a>(&'a Motion);

impl Serialize for MotionAfter<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("MotionAfter", 2)?;
        object.serialize_field("velocity_m_per_s", &components(&self.0.velocity_m_per_s))?;
        object.serialize_field("spin_rad_per_s", &components(&self.0.spin_rad_per_s))?;
        object.end()
    }
}

fn components(vector: &Vector3<f64>) -> [f64; 3] {
    (*vector).into()
}
