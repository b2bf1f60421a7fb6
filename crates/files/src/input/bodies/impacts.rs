//! Rows of a CSV file that change the bodies of a JSON file.

use std::path::Path;

use csv::ByteRecord;
use stickslip_model::Law;
use stickslip_model::spheres::Encounter;
use stickslip_model::spheres::quantity::PhysicalQuantity;

use super::file::{File, Slot};
use super::velocities::{QUANTITIES, Velocities, VelocitiesError};
use crate::error::FileError;
use crate::input::number::{self, SYNTAX};
use crate::input::parameter;
use crate::input::recipe::quoted;
use crate::input::rows::{Reading, names};

/// How the rows of a CSV file make impacts of the bodies in a JSON file.
#[derive(Clone)]
pub struct ImpactReading {
    /// The file, whose numbers change from row to row.
    file: File,
    law: Law,
    /// The columns of numbers of the file.
    columns: Vec<Column>,
    /// Velocities that are used instead of the motions.
    velocities: Option<Velocities<Source>>,
}

#[derive(Clone)]
struct Column {
    index: usize,
    name: String,
    slot: Slot,
}

/// Where a velocity comes from.
#[derive(Clone, Copy)]
enum Source {
    Value(f64),
    Column { index: usize, quantity: &'static PhysicalQuantity },
}

/// The options of the velocities, as [`QUANTITIES`].
const OPTIONS: [&str; 4] = ["--normal", "--tangential", "--speed", "--angle"];

/// Names that columns of bodies may have by mistake. Each of them would change nothing.
const MISTAKEN: [&str; 21] = [
    "alpha",
    "angle",
    "angle_deg",
    "angle_degrees",
    "damping",
    "kappa",
    "law",
    "mass",
    "mu",
    "normal",
    "normal_velocity",
    "psi",
    "radius",
    "ratio",
    "speed",
    "speed_mm_per_s",
    "spin",
    "tangential",
    "tangential_damping",
    "tangential_velocity",
    "velocity",
];

impl ImpactReading {
    /// The bodies in the JSON file at `path`, under a law.
    ///
    /// # Errors
    /// [`FileError::Input`]: the file cannot be read, is not JSON, or has other fields than bodies.
    pub fn of_file(path: &Path, law: Law) -> Result<Self, FileError> {
        super::read(path, |file| {
            file.require_two()?;
            Ok(Self { file, law, columns: Vec::new(), velocities: None })
        })
    }

    /// The number of spheres: one beside a wall, otherwise two.
    pub fn spheres(&self) -> usize {
        self.file.spheres()
    }

    /// The reading with the columns of `header`, where options give velocities and `results` are
    /// the names of the columns of results.
    ///
    /// # Errors
    /// What is wrong with the columns, or with the file if no column mends it, and what is
    /// expected.
    pub fn with_columns(
        mut self,
        header: &ByteRecord,
        options: [Option<f64>; 4],
        results: &[&str],
    ) -> Result<Self, String> {
        let names = names(header, results, "normal_m_per_s,tangential_m_per_s")?;
        let numbers = self.file.numbers();
        for (index, name) in names.iter().enumerate() {
            if let Some((name, slot)) = numbers.iter().find(|(known, _)| known.as_bytes() == *name)
            {
                self.columns.push(Column { index, name: name.clone(), slot: *slot });
            } else {
                require_foreign(&String::from_utf8_lossy(name), &numbers)?;
            }
        }
        let place = |quantity: &PhysicalQuantity| {
            names.iter().position(|it| *it == quantity.name.as_bytes())
        };
        self.velocities = velocities(place, options)?;
        let moving = self.columns.iter().find(|column| column.slot.unit().is_some());
        if let (Some(_), Some(Column { name, .. })) = (self.velocities, moving) {
            return Err(format!(
                "velocities of the surfaces and the column {name} are both given; expected \
                 velocities, or motions of the bodies"
            ));
        }
        self.require_usable()?;
        Ok(self)
    }

    /// Refuses bodies that no row makes right.
    fn require_usable(&self) -> Result<(), String> {
        let mut file = self.file.clone();
        for column in &self.columns {
            // A number that is in the range of every quantity, as far as that is possible.
            let ranged = |value: &f64| match column.slot.quantity() {
                Some(quantity) => quantity.check(*value).is_ok(),
                None => true,
            };
            let value = [0.0, 0.25].into_iter().find(ranged).unwrap_or(1.0);
            file.set(&column.slot, value);
        }
        let wrong = |reason| format!("with these columns the bodies are wrong: {reason}");
        let bodies = file.resolve(self.law).map_err(wrong)?;
        if self.velocities.is_none() && bodies.lacks_motion() {
            return Err(
                "the file of the bodies lacks a motion; expected columns normal_m_per_s and \
                        tangential_m_per_s, or speed_m_per_s and angle_rad, or motions"
                    .to_owned(),
            );
        }
        Ok(())
    }
}

impl Reading for ImpactReading {
    type Case = Encounter;

    fn read(&mut self, fields: &ByteRecord) -> Result<Encounter, String> {
        for Column { index, name, slot } in &self.columns {
            let text = String::from_utf8_lossy(&fields[*index]);
            let value = match slot.quantity() {
                Some(quantity) => parameter::quantity(quantity, &text),
                None => number::parse(&text).map_err(|problem| {
                    let unit = slot.unit().unwrap_or_default();
                    format!("{problem}; expected a finite number, {unit}, {SYNTAX}")
                }),
            };
            let value =
                value.map_err(|problem| format!("{name} = {}: {problem}", quoted(&text)))?;
            self.file.set(slot, value);
        }
        let value = |source: Source| match source {
            Source::Value(value) => Ok(value),
            Source::Column { index, quantity } => {
                let text = String::from_utf8_lossy(&fields[index]);
                parameter::quantity(quantity, &text)
                    .map_err(|problem| format!("{} = {}: {problem}", quantity.name, quoted(&text)))
            }
        };
        let velocities = self.velocities.map(|it| it.try_map(value)).transpose()?;
        self.file.resolve(self.law)?.encounter(velocities)
    }
}

/// The velocities that columns and options give.
fn velocities(
    place: impl Fn(&PhysicalQuantity) -> Option<usize>,
    options: [Option<f64>; 4],
) -> Result<Option<Velocities<Source>>, String> {
    let mut given = [None; 4];
    for (number, quantity) in QUANTITIES.into_iter().enumerate() {
        given[number] = match (place(quantity), options[number]) {
            (Some(_), Some(_)) => {
                let (name, option) = (quantity.name, OPTIONS[number]);
                return Err(format!(
                    "the column {name} and {option} are both given; expected one of them"
                ));
            }
            (Some(index), None) => Some(Source::Column { index, quantity }),
            (None, value) => value.map(Source::Value),
        };
    }
    Velocities::new(given).map_err(|error| match error {
        VelocitiesError::Both => "normal and tangential velocity, and speed and angle are given; \
                                  expected one of both pairs, as columns or options"
            .to_owned(),
        VelocitiesError::Half { given, missing } => format!(
            "{} is given without {}; expected both, each as a column or an option ({})",
            QUANTITIES[given].name, QUANTITIES[missing].name, OPTIONS[missing]
        ),
    })
}

/// Refuses the name of a column that looks as if it should change the bodies.
fn require_foreign(name: &str, known: &[(String, Slot)]) -> Result<(), String> {
    let lower = name.to_ascii_lowercase();
    let first = lower.split(['.', '[']).next().unwrap_or(&lower);
    let ours = |(name, slot): &(String, Slot)| {
        let own = name.rsplit('.').next().unwrap_or(name);
        let last = lower.rsplit('.').next().unwrap_or(&lower);
        last == own || (slot.unit().is_some() && own.split('[').next() == last.split('[').next())
    };
    if QUANTITIES.iter().any(|quantity| quantity.name == name) {
        return Ok(());
    }
    let velocity = QUANTITIES.iter().any(|quantity| quantity.name == lower);
    let object = ["sphere", "spheres", "wall", "surface", "material"].contains(&first);
    if !(velocity || object || MISTAKEN.contains(&lower.as_str()) || known.iter().any(ours)) {
        return Ok(());
    }
    let names = known.iter().map(|(name, _)| name.as_str());
    let names: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.name).chain(names).collect();
    Err(format!(
        "column {name} is not a number of these bodies; expected another name, or one of {}",
        names.join(", ")
    ))
}
