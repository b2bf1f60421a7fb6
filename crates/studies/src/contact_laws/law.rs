//! One law over the window.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use stickslip_model::history::History;
use stickslip_model::{Collision, CollisionFailure, Contact, Engine, SpringEnergy};
use stickslip_plane::GridAxis;

use super::settings::{ContactLawSettings, Named};
use crate::error::StudyError;

/// What was computed of one law.
#[derive(Clone, Debug)]
pub struct LawOnPlane {
    /// The law with its names.
    pub named: Named,
    /// ε_t, row by row from the lower edge.
    pub eps_t: Vec<f64>,
    /// ε_t minus ε_t of the paper's law at the same parameters.
    pub difference: Vec<f64>,
    /// The numbers of switches.
    pub switches: Vec<i32>,
    /// What the collisions have in common without damping.
    pub undamped: Kinds,
    /// What the collisions have in common with damping.
    pub damped: Kinds,
    /// The standard impact.
    pub standard: (Collision, History),
}

/// The kinds of collisions of a law in the window.
#[derive(Clone, Debug, Default)]
pub struct Kinds {
    /// The characters of their first phases.
    pub starts: BTreeSet<char>,
    /// Whether some have an even number of switches, and whether some have an odd one.
    pub parities: BTreeSet<usize>,
    /// The largest |ε_t|, with its κ and ψ.
    pub largest: (f64, [f64; 2]),
    /// How many collisions there are.
    pub collisions: usize,
    /// How many of them have more tangential kinetic energy after the contact than before.
    pub gaining: usize,
}

impl LawOnPlane {
    pub(super) fn new(settings: &ContactLawSettings, named: &Named) -> Result<Self, StudyError> {
        let (mut undamped, mut damped) = (Kinds::default(), Kinds::default());
        let points = settings.cells * settings.cells;
        let [mut eps_t, mut difference] = [const { Vec::new() }; 2];
        let mut switches = Vec::with_capacity(points);
        let [columns, rows] =
            [settings.kappa, settings.psi].map(|range| GridAxis { range, cells: settings.cells });
        for point in 0..points {
            let at = (columns.centre(point % settings.cells), rows.centre(point / settings.cells));
            let contact = |damped| settings.contact(named, at, damped);
            undamped.add(&collide(contact(false)?)?);
            let found = collide(contact(true)?)?;
            damped.add(&found);
            let paper = Contact::new(at.0, at.1, found.contact.damping())?;
            let paper = collide(paper)?;
            eps_t.push(found.eps_t());
            difference.push(found.eps_t() - paper.eps_t());
            switches.push(i32::try_from(found.switches.len()).unwrap_or(i32::MAX));
        }
        let contact = settings.contact(named, settings.standard, true)?;
        let standard = Engine::Auto
            .followed(contact)
            .map(|(collision, _, history)| (collision, history))
            .map_err(|source| CollisionFailure::new(&contact, source))?;
        let named = named.clone();
        Ok(Self { named, eps_t, difference, switches, undamped, damped, standard })
    }

    /// What becomes of the energy in the spring.
    pub fn spring(&self) -> SpringEnergy {
        self.named.law.spring_energy()
    }

    pub(super) fn json(&self) -> Value {
        json!({
            "names": self.named.names,
            "law": self.named.law,
            "equations": self.named.law.equations(),
            "spring_energy": self.spring().to_string(),
            "undamped": self.undamped.json(),
            "damped": self.damped.json(),
            "standard": {
                "eps_n": self.standard.0.eps_n,
                "eps_t": self.standard.0.eps_t(),
                "itinerary": self.standard.0.itinerary(),
            },
            "eps_t": self.eps_t,
            "switch_count": self.switches,
        })
    }
}

impl Kinds {
    fn add(&mut self, collision: &Collision) {
        let eps_t = collision.eps_t().abs();
        self.starts.extend(collision.itinerary().chars().next());
        self.parities.insert(collision.switches.len() % 2);
        if eps_t > self.largest.0 {
            let contact = &collision.contact;
            self.largest = (eps_t, [contact.kappa(), contact.psi()]);
        }
        self.collisions += 1;
        self.gaining += usize::from(eps_t > 1.0);
    }

    /// The parity of the numbers of switches.
    pub fn parity(&self) -> &'static str {
        match (self.parities.contains(&0), self.parities.contains(&1)) {
            (true, false) => "even",
            (false, true) => "odd",
            _ => "both",
        }
    }

    /// The regimes of the first phases.
    pub fn starts(&self) -> String {
        let names = self.starts.iter().map(|first| match first {
            'o' => "stick",
            '+' => "slip +",
            _ => "slip −",
        });
        names.collect::<Vec<_>>().join(", ")
    }

    fn json(&self) -> Value {
        let (eps_t, [kappa, psi]) = self.largest;
        json!({
            "starts": self.starts,
            "parity": self.parity(),
            "largest_eps_t": { "size": eps_t, "kappa": kappa, "psi": psi },
            "collisions": self.collisions,
            "gaining": self.gaining,
        })
    }
}

fn collide(contact: Contact) -> Result<Collision, StudyError> {
    let (collision, _) =
        Engine::Auto.collide(contact).map_err(|source| CollisionFailure::new(&contact, source))?;
    Ok(collision)
}
