//! Windows divided into cells: the collision of each cell, and the names of its coordinates.

use std::fmt;

use stickslip_model::spheres::BodyPair;
use stickslip_model::{Contact, InvalidValue, Law, Reduction};

use crate::chart::Range;

/// An interval divided into cells of equal width.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GridAxis {
    /// The interval.
    pub range: Range,
    /// Number of cells, at least 1.
    pub cells: usize,
}

impl GridAxis {
    /// Centre of cell `index`: low + (high − low)·((index + ½)/cells).
    ///
    /// Collisions are computed at centres, so that an interval may begin at 0, where there is no
    /// collision.
    pub fn centre(&self, index: usize) -> f64 {
        let Range { low, high } = self.range;
        low + (high - low) * ((index as f64 + 0.5) / self.cells as f64)
    }
}

/// A window divided into cells, with a collision at the centre of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Grid {
    /// The axis along a row.
    pub columns: GridAxis,
    /// The axis along a column.
    pub rows: GridAxis,
    /// What the two axes mean.
    pub coordinates: Coordinates,
    /// The contact law of all collisions.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_paper"))]
    pub law: Law,
    /// The tangential damping of all collisions.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_zero"))]
    pub tangential_damping: f64,
}

#[cfg(feature = "serde")]
fn is_paper(law: &Law) -> bool {
    *law == Law::PAPER
}

#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// What the axes of a grid mean: columns first, rows second.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Coordinates {
    /// κ and ψ.
    Psi {
        /// Scaled damping of all collisions.
        damping: f64,
    },
    /// κ and g_t/g_n.
    Ratio {
        /// Friction and inertia, which reduce the ratio to ψ.
        reduction: Reduction,
        /// Scaled damping of all collisions.
        damping: f64,
    },
    /// Normal and tangential velocity of the surfaces at the contact.
    Velocities {
        /// The two bodies that collide.
        pair: BodyPair,
    },
}

/// A coordinate or parameter of a collision, which is stored with its results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Scaled stiffness κ.
    Kappa,
    /// Reduced impact ratio ψ.
    Psi,
    /// Impact ratio g_t/g_n.
    Ratio,
    /// Normal velocity g_n.
    Normal,
    /// Tangential velocity g_t.
    Tangential,
    /// Scaled damping a.
    Damping,
}

/// The part of a grid over which a quantity varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The quantity depends on the column alone.
    Columns,
    /// The quantity depends on the row alone.
    Rows,
    /// The quantity depends on both, and has a value for each point.
    Points,
}

impl Grid {
    /// A window of collisions that obey the paper's law.
    pub fn new(columns: GridAxis, rows: GridAxis, coordinates: Coordinates) -> Self {
        Self { columns, rows, coordinates, law: Law::PAPER, tangential_damping: 0.0 }
    }

    /// Number of points, one for each cell; the largest number if there are more.
    pub fn points(&self) -> usize {
        self.columns.cells.saturating_mul(self.rows.cells)
    }

    /// Column and row of a point. Points are counted row by row. A grid without columns has no
    /// points, and all are said to be in its first row.
    pub fn cell(&self, point: usize) -> (usize, usize) {
        let cells = self.columns.cells.max(1);
        (point % cells, point / cells)
    }

    /// The point of a cell: the inverse of [`Self::cell`].
    pub fn point(&self, column: usize, row: usize) -> usize {
        row * self.columns.cells + column
    }

    /// The collision at the centre of a cell.
    ///
    /// # Errors
    /// [`InvalidValue`]: no collision has the parameters of this cell.
    pub fn contact(&self, column: usize, row: usize) -> Result<Contact, InvalidValue> {
        let [kappa, psi, damping] = self.parameters(column, row)?;
        let contact = Contact::new(kappa, psi, damping)?;
        let mut law = self.law;
        if let Coordinates::Velocities { pair } = self.coordinates {
            let normal = self.columns.centre(column);
            law.friction.decay *= normal;
            law.pull_off = pair.impact(normal, self.rows.centre(row))?.contact.law().pull_off;
        }
        let contact = contact.with_law(law, self.tangential_damping)?;
        let friction = match self.coordinates {
            Coordinates::Psi { .. } => return Ok(contact),
            Coordinates::Ratio { reduction, .. } => reduction.mu,
            Coordinates::Velocities { pair } => pair.surface.friction,
        };
        Ok(if friction > 0.0 { contact } else { contact.without_friction() })
    }

    /// The quantities along a row and along a column.
    pub fn axes(&self) -> [Quantity; 2] {
        match self.coordinates {
            Coordinates::Psi { .. } => [Quantity::Kappa, Quantity::Psi],
            Coordinates::Ratio { .. } => [Quantity::Kappa, Quantity::Ratio],
            Coordinates::Velocities { .. } => [Quantity::Normal, Quantity::Tangential],
        }
    }

    /// The quantities that are stored with the results, in this order.
    pub fn quantities(&self) -> &'static [Quantity] {
        use Quantity::{Damping, Kappa, Normal, Psi, Ratio, Tangential};
        match self.coordinates {
            Coordinates::Psi { .. } => &[Kappa, Psi],
            Coordinates::Ratio { .. } => &[Kappa, Psi, Ratio],
            Coordinates::Velocities { .. } => &[Normal, Tangential, Kappa, Psi, Damping],
        }
    }

    /// The value of `quantity` at the centre of a cell; NaN where there is no collision.
    pub fn value(&self, quantity: Quantity, column: usize, row: usize) -> f64 {
        let parameter = |index: usize| self.parameters(column, row).map_or(f64::NAN, |p| p[index]);
        match quantity {
            Quantity::Kappa => parameter(0),
            Quantity::Psi => parameter(1),
            Quantity::Damping => parameter(2),
            Quantity::Normal => self.columns.centre(column),
            Quantity::Ratio | Quantity::Tangential => self.rows.centre(row),
        }
    }

    /// The part of the grid over which `quantity` varies.
    pub fn extent(&self, quantity: Quantity) -> Extent {
        match (quantity, self.coordinates) {
            (Quantity::Psi, Coordinates::Velocities { .. }) => Extent::Points,
            (Quantity::Kappa | Quantity::Damping | Quantity::Normal, _) => Extent::Columns,
            (Quantity::Psi | Quantity::Ratio | Quantity::Tangential, _) => Extent::Rows,
        }
    }

    /// The largest κ in the grid, as far as it can be computed; 0 if the grid has no cells.
    pub fn largest_stiffness(&self) -> f64 {
        if self.points() == 0 {
            return 0.0;
        }
        let corners = [(0, 0), (self.columns.cells - 1, self.rows.cells - 1)];
        corners
            .into_iter()
            .map(|(column, row)| self.value(Quantity::Kappa, column, row))
            .fold(0.0, f64::max)
    }

    /// κ, ψ and the damping at the centre of a cell.
    fn parameters(&self, column: usize, row: usize) -> Result<[f64; 3], InvalidValue> {
        let (x, y) = (self.columns.centre(column), self.rows.centre(row));
        match self.coordinates {
            Coordinates::Psi { damping } => Ok([x, y, damping]),
            Coordinates::Ratio { reduction, damping } => Ok([x, reduction.psi(y), damping]),
            Coordinates::Velocities { pair } => {
                let contact = pair.impact(x, y)?.contact;
                Ok([contact.kappa(), contact.psi(), contact.damping()])
            }
        }
    }
}

/// One fact per line, with all digits, so that grids that differ read differently.
impl fmt::Display for Grid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y] = self.axes().map(Quantity::name);
        for (name, quantity, GridAxis { range: Range { low, high }, cells }) in
            [("columns", x, self.columns), ("rows", y, self.rows)]
        {
            writeln!(f, "{name}: {cells}, {quantity} from {low:?} to {high:?}")?;
        }
        if self.law != Law::PAPER {
            writeln!(f, "law: {:?}\ntangential damping: {:?}", self.law, self.tangential_damping)?;
        }
        match self.coordinates {
            Coordinates::Psi { damping } => writeln!(f, "damping: {damping:?}"),
            Coordinates::Ratio { reduction: Reduction { mu, alpha }, damping } => {
                writeln!(f, "damping: {damping:?}\nmu: {mu:?}\nalpha: {alpha:?}")
            }
            Coordinates::Velocities { pair } => writeln!(f, "bodies: {pair:?}"),
        }
    }
}

impl Quantity {
    /// The name of the quantity's array or column in a file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kappa => "kappa",
            Self::Psi => "psi",
            Self::Ratio => "ratio",
            Self::Normal => "normal_m_per_s",
            Self::Tangential => "tangential_m_per_s",
            Self::Damping => "damping",
        }
    }
}
