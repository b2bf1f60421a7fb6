//! The file of a table, schema [`SCHEMA`], and what a reader of it refuses.

use serde::{Deserialize, Serialize};
use stickslip_model::InvalidValue;
use stickslip_plane::Range;

use super::TableError;
use super::chebyshev::{ACROSS, ALONG};
use super::settings::TableWindow;
use super::table::{Arrays, NO_REGION, RestitutionTable, TableVerification};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.table/1";

/// What numbers are expected to be.
const ASCENDING: &str = "a finite number in an ascending range";

/// A table as its JSON has it. See [`RestitutionTable`] for the fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the fields are those of a table")]
pub struct TableDocument {
    /// [`SCHEMA`].
    pub schema: String,
    pub window: TableWindow,
    pub constant_eps_n: Option<f64>,
    pub bound: f64,
    pub verification: TableVerification,
    pub regions: Vec<String>,
    pub arrays: Arrays,
}

impl From<&RestitutionTable> for TableDocument {
    fn from(table: &RestitutionTable) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            window: table.window,
            constant_eps_n: table.constant_eps_n,
            bound: table.bound,
            verification: table.verification,
            regions: table.regions.clone(),
            arrays: table.arrays().clone(),
        }
    }
}

impl TryFrom<TableDocument> for RestitutionTable {
    type Error = TableError;

    /// The table of a document. Everything is checked that a look-up relies on; that the
    /// coefficients are right is not.
    fn try_from(document: TableDocument) -> Result<Self, TableError> {
        let TableDocument { schema, window, constant_eps_n, bound, verification, regions, arrays } =
            document;
        if schema != SCHEMA {
            return Err(InvalidValue::new("schema", &*schema, format!("{SCHEMA:?}")).into());
        }
        let (damping, tangential_damping) = match window {
            TableWindow::Scaled { damping, tangential_damping, .. } => {
                (damping, tangential_damping)
            }
            TableWindow::Velocities { pair, .. } => {
                (pair.surface.damping_time_s, pair.tangential_damping_ratio)
            }
        };
        let eps_n = constant_eps_n.unwrap_or(1.0);
        let sides @ [x, y] = window.sides();
        let [x_name, y_name] = window.names();
        for (name, value, ok) in [
            ("damping", damping, damping >= 0.0),
            ("tangential_damping", tangential_damping, tangential_damping >= 0.0),
            ("constant_eps_n", eps_n, eps_n > 0.0 && eps_n <= 1.0 + 1e-12),
            ("bound", bound, bound > 0.0),
            (x_name, x.low, x.low > 0.0 && x.low < x.high),
            (y_name, y.low, y.low > 0.0 && y.low < y.high),
            (x_name, x.high, true),
            (y_name, y.high, true),
        ] {
            InvalidValue::check(name, value, ASCENDING, ok && value.is_finite())?;
        }
        let is_scaled = matches!(window, TableWindow::Scaled { .. });
        if constant_eps_n.is_some() != is_scaled {
            return Err(TableError::Contradiction { name: "constant_eps_n", index: 0 });
        }
        arrays.check(sides, regions.len(), is_scaled)?;
        Ok(Self { window, constant_eps_n, bound, verification, regions, sides, arrays })
    }
}

fn require_length(name: &str, length: usize, expected: usize) -> Result<(), InvalidValue> {
    if length == expected {
        return Ok(());
    }
    Err(InvalidValue::new(format!("the length of {name}"), length, expected.to_string()))
}

impl Arrays {
    /// Checks everything that a look-up relies on.
    fn check(&self, [x, y]: [Range; 2], regions: usize, is_scaled: bool) -> Result<(), TableError> {
        let slabs = self.scales.len();
        let normals = if is_scaled { 0 } else { ALONG * slabs };
        let sides = self.strip_stretches.len();
        let with_regions = if regions == 0 { 0 } else { sides };
        for (name, length, expected) in [
            ("scales", slabs, slabs.max(1)),
            ("walls", self.walls.len(), slabs + 1),
            ("slab_stretches", self.slab_stretches.len(), slabs),
            ("normals", self.normals.len(), normals),
            ("first_strips", self.first_strips.len(), slabs + 1),
            ("graphs", self.graphs.len(), ALONG * sides),
            ("first_rows", self.first_rows.len(), sides),
            ("regions", self.regions.len(), with_regions),
            ("rows", self.rows.len(), self.rows.len().next_multiple_of(ACROSS)),
        ] {
            require_length(name, length, expected)?;
        }
        for (name, values) in [
            ("walls", &self.walls),
            ("scales", &self.scales),
            ("normals", &self.normals),
            ("graphs", &self.graphs),
            ("rows", &self.rows),
        ] {
            for &value in values {
                InvalidValue::check(name, value, ASCENDING, value.is_finite())?;
            }
        }
        let contradiction = |name: &'static str, index: Option<usize>| {
            index.map_or(Ok(()), |index| Err(TableError::Contradiction { name, index }))
        };
        contradiction("walls", self.walls.windows(2).position(|pair| pair[0] >= pair[1]))?;
        let ends = [self.walls[0], self.walls[slabs]] == [x.low, x.high];
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
        let set = expected.restore_hints([x, y]).is_ok();
        let same = |name, same: bool| contradiction(name, (!(set && same)).then_some(0));
        same("slab_keys", self.slab_keys == expected.slab_keys)?;
        same("strip_keys", self.strip_keys == expected.strip_keys)?;
        same("slab_hints", self.slab_hints == expected.slab_hints)?;
        // Of another processor's rounding, bounds of graphs differ in the last digits.
        let count = self.strip_keys.count;
        require_length("strip_hints", self.strip_hints.len(), count * slabs)?;
        let wrong = self.strip_hints.iter().enumerate().position(|(index, &hint)| {
            let slab = index / count;
            let strips = self.first_strips[slab + 1] - self.first_strips[slab] - 1;
            u32::from(hint) >= strips
        });
        contradiction("strip_hints", wrong)
    }
}
