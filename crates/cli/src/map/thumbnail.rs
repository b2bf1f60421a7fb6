//! A map at the resolution of a picture.

use std::io;

use crate::map::plane::{Axis, Plane};
use crate::map::tile::Tile;
use crate::map::tiles::Tiles;

/// Points of a map that stand for the pixels of a picture of its window, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Thumbnail {
    /// Number of pixels in a row.
    pub columns: usize,
    /// Number of rows; the first lies at the lower end of the axis.
    pub rows: usize,
    /// Tangential restitution; NaN where it could not be computed.
    pub eps_t: Vec<f64>,
    /// Number of switches; −1 where it could not be computed.
    pub switch_count: Vec<i32>,
}

impl Thumbnail {
    /// Columns and rows.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows)
    }

    /// Takes for each pixel the cell at its centre, of at most `most` × `most` pixels and never
    /// more than the map has cells. One tile at a time is in memory.
    ///
    /// # Errors
    /// A tile cannot be read.
    pub fn read(plane: &Plane, tiles: &Tiles, most: usize) -> io::Result<Self> {
        let [columns, rows] = [plane.columns, plane.rows].map(|axis| centres(axis, most));
        let mut thumbnail = Self {
            columns: columns.len(),
            rows: rows.len(),
            eps_t: Vec::with_capacity(columns.len() * rows.len()),
            switch_count: Vec::with_capacity(columns.len() * rows.len()),
        };
        let mut current: Option<(usize, Tile)> = None;
        for row in rows {
            for column in &columns {
                let (index, offset) = tiles.task().place(plane.point(*column, row));
                let tile = match current.take() {
                    Some((read, tile)) if read == index => tile,
                    _ => tiles.read(index)?,
                };
                thumbnail.eps_t.push(tile.eps_t[offset]);
                thumbnail.switch_count.push(tile.switch_count[offset]);
                current = Some((index, tile));
            }
        }
        Ok(thumbnail)
    }
}

/// The cells that hold the centres of at most `most` pixels of equal width.
fn centres(axis: Axis, most: usize) -> Vec<usize> {
    let pixels = axis.cells.min(most);
    (0..pixels).map(|pixel| (2 * pixel + 1) * axis.cells / (2 * pixels)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::plane::Coordinates;
    use crate::map::tiles::Task;
    use crate::range::Range;

    #[test]
    fn every_pixel_shows_the_cell_at_its_centre() {
        let axis = |cells| Axis { range: Range { low: 0.0, high: 1.0 }, cells };
        assert_eq!(centres(axis(6), 10), [0, 1, 2, 3, 4, 5]);
        assert_eq!(centres(axis(6), 3), [1, 3, 5]);
        assert_eq!(centres(axis(7), 3), [1, 3, 5]);
        assert_eq!(centres(axis(10_000_000_000), 1), [5_000_000_000]);

        // The results of a point are its number; tiles end in the middle of rows.
        let coordinates = Coordinates::Psi { damping: 0.0 };
        let plane = Plane { columns: axis(7), rows: axis(5), coordinates };
        let task = Task { description: String::new(), points: 35, tile_points: 4 };
        let directory = tempfile::tempdir().unwrap();
        let tiles = Tiles::open(&directory.path().join("map.npz"), task).unwrap();
        for index in 0..9 {
            let points = tiles.task().range(index);
            let eps_t = points.clone().map(|point| point as f64).collect();
            let switch_count = points.map(|point| i32::try_from(point).unwrap()).collect();
            tiles.keep(index, &Tile { eps_t, switch_count }).unwrap();
        }
        let thumbnail = Thumbnail::read(&plane, &tiles, 3).unwrap();
        assert_eq!((thumbnail.columns, thumbnail.rows), (3, 3));
        assert_eq!(thumbnail.switch_count, [1, 3, 5, 15, 17, 19, 29, 31, 33]);
        assert_eq!(thumbnail.eps_t[8], 33.0);
        let all = Thumbnail::read(&plane, &tiles, 100).unwrap();
        assert_eq!(all.switch_count, (0..35).collect::<Vec<_>>());
    }
}
