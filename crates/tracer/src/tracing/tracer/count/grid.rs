//! Places of a window that are divided where regions are narrow.

use std::collections::HashMap;

use crate::regions::arrangement::union::DisjointSets;
use crate::tracing::tracer::count::Count;

/// The number of places along a side before any is divided.
const COARSEST: usize = 32;

/// A square of the window. The label of its middle counts for the square.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// How often the places of the coarsest grid were divided.
    pub level: u32,
    /// The column and the row on the grid of this level.
    pub column: usize,
    pub row: usize,
    /// The index of the place in the grid.
    index: usize,
}

impl Place {
    /// The number of places of this level along a side of the window.
    pub fn side(&self) -> usize {
        COARSEST << self.level
    }
}

/// A place as the grid stores it.
#[derive(Clone, Copy, Debug, Default)]
struct Square {
    /// The number of the label; `None` where the run failed.
    label: Option<usize>,
    /// Whether it is in a square of four places with one label.
    wide: bool,
    /// The index of the first of the four parts into which it was divided.
    parts: Option<usize>,
}

/// The places of a window.
pub(super) struct Grid {
    squares: Vec<Square>,
    /// The places that are not divided, without those whose label is not known yet.
    leaves: Vec<Place>,
}

/// The places beside and above a place, and those diagonal to it.
const SIDES: [[isize; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
const DIAGONALS: [[isize; 2]; 4] = [[1, 1], [-1, 1], [-1, -1], [1, -1]];

impl Grid {
    pub fn new() -> Self {
        Self { squares: vec![Square::default(); COARSEST * COARSEST], leaves: Vec::new() }
    }

    /// The places of the coarsest grid.
    pub fn coarsest(&self) -> Vec<Place> {
        (0..self.squares.len())
            .map(|index| {
                let (column, row) = (index / COARSEST, index % COARSEST);
                Place { level: 0, column, row, index }
            })
            .collect()
    }

    /// The number of places whose label was computed.
    pub fn places(&self) -> usize {
        self.squares.len()
    }

    /// Gives new places the numbers of their labels.
    pub fn label(&mut self, places: &[Place], labels: &[Option<usize>]) {
        for (place, &label) in places.iter().zip(labels) {
            self.squares[place.index].label = label;
        }
        self.leaves.extend_from_slice(places);
    }

    /// The places of the finest grid that are in no square of four places with one label.
    pub fn narrow(&mut self, places: &[Place]) -> Vec<Place> {
        let mut narrow = Vec::new();
        for place in places {
            let Some(label) = self.squares[place.index].label else { continue };
            let alike = |[x, y]: [isize; 2]| {
                self.beside(place, [x, y])
                    .is_some_and(|other| self.squares[other].label == Some(label))
            };
            let in_square = |[x, y]: [isize; 2]| alike([x, 0]) && alike([0, y]) && alike([x, y]);
            if DIAGONALS.into_iter().any(in_square) {
                self.squares[place.index].wide = true;
            } else {
                narrow.push(*place);
            }
        }
        narrow
    }

    /// Divides places into four each, which are returned.
    pub fn divide(&mut self, places: &[Place]) -> Vec<Place> {
        let mut parts = Vec::with_capacity(4 * places.len());
        for place in places {
            let first = self.squares.len();
            self.squares[place.index].parts = Some(first);
            self.squares.extend([Square::default(); 4]);
            parts.extend([0, 1, 2, 3].map(|part| Place {
                level: place.level + 1,
                column: 2 * place.column + part / 2,
                row: 2 * place.row + part % 2,
                index: first + part,
            }));
        }
        let squares = &self.squares;
        self.leaves.retain(|place| squares[place.index].parts.is_none());
        parts
    }

    /// The numbers of regions and curves, if the grid has so many different `labels`.
    pub fn count(&self, labels: usize) -> Count {
        let mut sets = DisjointSets::new(self.squares.len());
        let alike = |place: &Place, other: usize| {
            self.squares[other].parts.is_none()
                && self.squares[other].label.is_some()
                && self.squares[other].label == self.squares[place.index].label
        };
        for place in &self.leaves {
            for step in SIDES.into_iter().chain(DIAGONALS) {
                if let Some(other) = self.beside(place, step).filter(|&other| alike(place, other)) {
                    sets.unite(place.index, other);
                }
            }
        }
        let mut is_region = vec![false; self.squares.len()];
        let mut has_region = vec![false; labels];
        for place in &self.leaves {
            let Square { label: Some(label), wide: true, .. } = self.squares[place.index] else {
                continue;
            };
            is_region[sets.least(place.index)] = true;
            has_region[label] = true;
        }
        // In sides of places: a smaller place beside a larger one has a part of its side.
        let mut contacts: HashMap<[usize; 2], f64> = HashMap::new();
        for place in &self.leaves {
            for (direction, step) in SIDES.into_iter().enumerate() {
                let Some((level, other)) = self.found(place, step) else { continue };
                // Places of one size are neighbours of each other.
                let counts = direction < 2 || level < place.level;
                let pair = [place.index, other].map(|index| sets.least(index));
                if counts && pair[0] != pair[1] && pair.iter().all(|&region| is_region[region]) {
                    let part = f64::from(place.level - level).exp2().recip();
                    *contacts.entry([pair[0].min(pair[1]), pair[0].max(pair[1])]).or_default() +=
                        part;
                }
            }
        }
        let narrow = has_region.iter().filter(|&&has| !has).count();
        let regions = is_region.iter().filter(|&&is| is).count();
        let curves = contacts.values().filter(|&&sides| sides > 1.0).count();
        Count { regions: regions + narrow, curves: curves + narrow }
    }

    /// The index of the place of this level or a coarser one that is one step away, whether it is
    /// divided or not.
    fn beside(&self, place: &Place, step: [isize; 2]) -> Option<usize> {
        self.found(place, step).map(|(_, index)| index)
    }

    /// The level and the index of the place one step away.
    fn found(&self, place: &Place, [x, y]: [isize; 2]) -> Option<(u32, usize)> {
        let column = place.column.checked_add_signed(x).filter(|&at| at < place.side())?;
        let row = place.row.checked_add_signed(y).filter(|&at| at < place.side())?;
        let mut index = (column >> place.level) * COARSEST + (row >> place.level);
        for level in 0..place.level {
            let Some(first) = self.squares[index].parts else { return Some((level, index)) };
            let finer = place.level - level - 1;
            index = first + 2 * ((column >> finer) & 1) + ((row >> finer) & 1);
        }
        Some((place.level, index))
    }
}
