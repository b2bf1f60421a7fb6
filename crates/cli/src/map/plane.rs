//! The plane of a map: which collision belongs to which cell, and what its coordinates are called.

use std::fmt;

use stickslip_model::{Contact, InvalidParameter};

use crate::range::Range;

/// An interval cut into cells of equal width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The interval.
    pub range: Range,
    /// Number of cells.
    pub cells: usize,
}

impl Axis {
    /// Centre of cell `index`: LO + (HI − LO)·((index + ½)/cells).
    ///
    /// Centres let an interval begin at 0, where there is no collision.
    pub fn centre(&self, index: usize) -> f64 {
        let Range { low, high } = self.range;
        low + (high - low) * ((index as f64 + 0.5) / self.cells as f64)
    }
}

/// A window cut into cells, and what its axes mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The axis along a row.
    pub columns: Axis,
    /// The axis along a column.
    pub rows: Axis,
    /// What both mean.
    pub coordinates: Coordinates,
}

/// What the axes of a plane mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    /// κ and ψ.
    Psi {
        /// Scaled damping of all collisions.
        damping: f64,
    },
    /// κ and g_t/g_n.
    Ratio {
        /// Coefficient of friction.
        mu: f64,
        /// Tangential inertia.
        alpha: f64,
        /// Scaled damping of all collisions.
        damping: f64,
    },
}

/// A coordinate or parameter that is stored with the results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Scaled stiffness κ.
    Kappa,
    /// Reduced impact ratio ψ.
    Psi,
    /// Impact ratio g_t/g_n.
    Ratio,
}

/// On what a quantity depends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// On the column alone.
    Columns,
    /// On the row alone.
    Rows,
}

impl Plane {
    /// Number of points.
    pub fn points(&self) -> usize {
        self.columns.cells * self.rows.cells
    }

    /// Column and row of a point; points are counted row by row.
    pub fn cell(&self, point: usize) -> (usize, usize) {
        (point % self.columns.cells, point / self.columns.cells)
    }

    /// The point of a cell: the inverse of [`Self::cell`].
    pub fn point(&self, column: usize, row: usize) -> usize {
        row * self.columns.cells + column
    }

    /// The collision at the centre of a cell.
    ///
    /// # Errors
    /// [`InvalidParameter`]: the centre has left the range of numbers.
    pub fn contact(&self, column: usize, row: usize) -> Result<Contact, InvalidParameter> {
        let damping = match self.coordinates {
            Coordinates::Psi { damping } | Coordinates::Ratio { damping, .. } => damping,
        };
        let [kappa, psi] = [Quantity::Kappa, Quantity::Psi].map(|q| self.value(q, column, row));
        Contact::new(kappa, psi, damping)
    }

    /// What is stored with the results, in this order.
    pub fn quantities(&self) -> &'static [Quantity] {
        match self.coordinates {
            Coordinates::Psi { .. } => &[Quantity::Kappa, Quantity::Psi],
            Coordinates::Ratio { .. } => &[Quantity::Kappa, Quantity::Psi, Quantity::Ratio],
        }
    }

    /// The value of `quantity` at the centre of a cell.
    pub fn value(&self, quantity: Quantity, column: usize, row: usize) -> f64 {
        match (quantity, self.coordinates) {
            (Quantity::Kappa, _) => self.columns.centre(column),
            (Quantity::Psi, Coordinates::Ratio { mu, alpha, .. }) => {
                self.rows.centre(row) * alpha / mu
            }
            (Quantity::Psi | Quantity::Ratio, _) => self.rows.centre(row),
        }
    }

    /// κ where it is largest, as far as it can be computed.
    pub fn largest_stiffness(&self) -> f64 {
        let corners = [(0, 0), (self.columns.cells - 1, self.rows.cells - 1)];
        corners
            .into_iter()
            .map(|(column, row)| self.value(Quantity::Kappa, column, row))
            .fold(0.0, f64::max)
    }
}

/// One fact a line, with all digits: planes that differ read differently.
impl fmt::Display for Plane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = match self.coordinates {
            Coordinates::Psi { .. } => Quantity::Psi,
            Coordinates::Ratio { .. } => Quantity::Ratio,
        };
        let axes = [("columns", Quantity::Kappa, self.columns), ("rows", rows, self.rows)];
        for (name, quantity, Axis { range: Range { low, high }, cells }) in axes {
            let quantity = quantity.name();
            writeln!(f, "{name}: {cells}, {quantity} from {low:?} to {high:?}")?;
        }
        match self.coordinates {
            Coordinates::Psi { damping } => writeln!(f, "damping: {damping:?}"),
            Coordinates::Ratio { mu, alpha, damping } => {
                writeln!(f, "damping: {damping:?}\nmu: {mu:?}\nalpha: {alpha:?}")
            }
        }
    }
}

impl Quantity {
    /// Name of the array or column.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kappa => "kappa",
            Self::Psi => "psi",
            Self::Ratio => "ratio",
        }
    }

    /// On what the quantity depends.
    pub fn extent(self) -> Extent {
        match self {
            Self::Kappa => Extent::Columns,
            Self::Psi | Self::Ratio => Extent::Rows,
        }
    }
}
