//! The file of a table, schema [`SCHEMA`], and what a reader of it refuses.

use serde::{Deserialize, Serialize};
use stickslip_plane::Range;

use super::chebyshev::{ACROSS, ALONG};
use super::table::{Arrays, NO_REGION, Table};
use super::verification::Verification;

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.table/1";

/// A table as its JSON has it. See [`Table`] for the fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are those of a table")]
pub struct Document {
    /// [`SCHEMA`].
    pub schema: String,
    pub damping: f64,
    pub eps_n: f64,
    pub bound: f64,
    pub kappa: [f64; 2],
    pub psi: [f64; 2],
    pub verification: Verification,
    pub regions: Vec<String>,
    pub arrays: Arrays,
}

/// A document is no table.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DocumentError {
    /// The layout is another one.
    #[error("schema is {0:?}; expected {SCHEMA:?}")]
    Schema(String),
    /// A number is out of its range.
    #[error("{name} = {value:?} is out of range; expected a finite number in an ascending range")]
    Number {
        /// The field.
        name: &'static str,
        /// The first such number.
        value: f64,
    },
    /// An array has another length.
    #[error("{name} has {length} elements; expected {expected}")]
    Length {
        /// The array.
        name: &'static str,
        /// Its length.
        length: usize,
        /// The length that fits the other arrays.
        expected: usize,
    },
    /// An array contradicts another one.
    #[error("{name} contradicts the other arrays at element {index}")]
    Contradiction {
        /// The array.
        name: &'static str,
        /// The first such element.
        index: usize,
    },
}

impl From<&Table> for Document {
    fn from(table: &Table) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            damping: table.damping,
            eps_n: table.eps_n,
            bound: table.bound,
            kappa: table.kappa,
            psi: table.psi,
            verification: table.verification,
            regions: table.regions.clone(),
            arrays: table.arrays().clone(),
        }
    }
}

impl TryFrom<Document> for Table {
    type Error = DocumentError;

    /// The table of a document. Everything is checked that a look-up relies on; that the
    /// coefficients are right is not.
    fn try_from(document: Document) -> Result<Self, DocumentError> {
        let Document { schema, damping, eps_n, bound, kappa, psi, verification, regions, arrays } =
            document;
        if schema != SCHEMA {
            return Err(DocumentError::Schema(schema));
        }
        for (name, value, ok) in [
            ("damping", damping, damping >= 0.0),
            ("eps_n", eps_n, eps_n > 0.0 && eps_n <= 1.0 + 1e-12),
            ("bound", bound, bound > 0.0),
            ("kappa", kappa[0], kappa[0] > 0.0 && kappa[0] < kappa[1]),
            ("psi", psi[0], psi[0] > 0.0 && psi[0] < psi[1]),
            ("kappa", kappa[1], true),
            ("psi", psi[1], true),
        ] {
            require(ok && value.is_finite(), DocumentError::Number { name, value })?;
        }
        arrays.check(kappa, psi, regions.len())?;
        Ok(Self { damping, eps_n, bound, kappa, psi, verification, regions, arrays })
    }
}

fn require(ok: bool, error: DocumentError) -> Result<(), DocumentError> {
    if ok { Ok(()) } else { Err(error) }
}

impl Arrays {
    /// Checks everything that a look-up relies on.
    fn check(&self, kappa: [f64; 2], psi: [f64; 2], regions: usize) -> Result<(), DocumentError> {
        let slabs = self.scales.len();
        let sides = self.strip_stretches.len();
        let with_regions = if regions == 0 { 0 } else { sides };
        for (name, length, expected) in [
            ("scales", slabs, slabs.max(1)),
            ("walls", self.walls.len(), slabs + 1),
            ("slab_stretches", self.slab_stretches.len(), slabs),
            ("first_strips", self.first_strips.len(), slabs + 1),
            ("graphs", self.graphs.len(), ALONG * sides),
            ("first_rows", self.first_rows.len(), sides),
            ("regions", self.regions.len(), with_regions),
            ("rows", self.rows.len(), self.rows.len().next_multiple_of(ACROSS)),
        ] {
            require(length == expected, DocumentError::Length { name, length, expected })?;
        }
        for (name, values) in [
            ("walls", &self.walls),
            ("scales", &self.scales),
            ("graphs", &self.graphs),
            ("rows", &self.rows),
        ] {
            if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
                return Err(DocumentError::Number { name, value });
            }
        }
        let contradiction = |name: &'static str, index: Option<usize>| {
            index.map_or(Ok(()), |index| Err(DocumentError::Contradiction { name, index }))
        };
        contradiction("walls", self.walls.windows(2).position(|pair| pair[0] >= pair[1]))?;
        let ends = [self.walls[0], self.walls[slabs]] == kappa;
        contradiction("walls", (!ends).then_some(0))?;
        // Each slab has a strip and the upper edge.
        let short = |pair: &[u32]| u64::from(pair[1]) < u64::from(pair[0]) + 2;
        contradiction("first_strips", self.first_strips.windows(2).position(short))?;
        let ends = self.first_strips[0] == 0 && self.first_strips[slabs] as usize == sides;
        contradiction("first_strips", (!ends).then_some(0))?;
        let wrong = |pair: &[u32]| pair[1] < pair[0] || (pair[1] - pair[0]) as usize > ALONG;
        contradiction("first_rows", self.first_rows.windows(2).position(wrong))?;
        let beyond = |&row: &u32| row as usize > self.rows.len() / ACROSS;
        contradiction("first_rows", self.first_rows.iter().position(beyond))?;
        let unknown = |&region: &u32| region != NO_REGION && region as usize >= regions;
        contradiction("regions", self.regions.iter().position(unknown))?;
        let mut expected = self.clone();
        let range = |[low, high]: [f64; 2]| Range { low, high };
        let set = expected.set_hints(range(kappa), range(psi)).is_ok();
        let same = |name, same: bool| contradiction(name, (!(set && same)).then_some(0));
        same("slab_keys", self.slab_keys == expected.slab_keys)?;
        same("strip_keys", self.strip_keys == expected.strip_keys)?;
        same("slab_hints", self.slab_hints == expected.slab_hints)?;
        // Of another processor's rounding, bounds of graphs differ in the last digits.
        let count = self.strip_keys.count;
        require(
            self.strip_hints.len() == count * slabs,
            DocumentError::Length {
                name: "strip_hints",
                length: self.strip_hints.len(),
                expected: count * slabs,
            },
        )?;
        let wrong = self.strip_hints.iter().enumerate().position(|(index, &hint)| {
            let slab = index / count;
            let strips = self.first_strips[slab + 1] - self.first_strips[slab] - 1;
            u32::from(hint) >= strips
        });
        contradiction("strip_hints", wrong)
    }
}
