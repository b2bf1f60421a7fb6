//! A map at the resolution of a picture.

use std::io;

use stickslip_plane::{GridAxis, Tile};

use super::results::Stored;

/// The size (columns and rows) of a picture of the map with all of its tiles `stored`, and the
/// results of its pixels, row by row from the lower edge.
///
/// A pixel shows the cell at its centre. There are at most `most` × `most` pixels, and not more
/// than the map has cells. One tile at a time is in memory.
///
/// # Errors
/// A tile cannot be read.
pub fn read(stored: &impl Stored, most: usize) -> io::Result<((usize, usize), Tile)> {
    let grid = stored.task().grid;
    let [columns, rows] = [grid.columns, grid.rows].map(|axis| centres(axis, most));
    let size = (columns.len(), rows.len());
    let mut thumbnail = Tile { eps_t: Vec::new(), switch_count: Vec::new() };
    let mut current: Option<(usize, Tile)> = None;
    for row in rows {
        for column in &columns {
            let (index, offset) = stored.task().place(grid.point(*column, row));
            let tile = match current.take() {
                Some((read, tile)) if read == index => tile,
                _ => stored.read(index)?,
            };
            thumbnail.eps_t.push(tile.eps_t[offset]);
            thumbnail.switch_count.push(tile.switch_count[offset]);
            current = Some((index, tile));
        }
    }
    Ok((size, thumbnail))
}

/// The cells that contain the centres of at most `most` pixels of equal width.
fn centres(axis: GridAxis, most: usize) -> Vec<usize> {
    let pixels = axis.cells.min(most);
    (0..pixels).map(|pixel| (2 * pixel + 1) * axis.cells / (2 * pixels)).collect()
}

#[cfg(test)]
mod tests {
    use stickslip_model::Engine;
    use stickslip_plane::{Coordinates, Grid, Range};

    use super::super::task::Task;
    use super::super::tiles::Tiles;
    use super::*;

    #[test]
    fn every_pixel_shows_the_cell_at_its_centre() {
        let axis = |cells| GridAxis { range: Range { low: 0.0, high: 1.0 }, cells };
        assert_eq!(centres(axis(6), 10), [0, 1, 2, 3, 4, 5]);
        assert_eq!(centres(axis(6), 3), [1, 3, 5]);
        assert_eq!(centres(axis(7), 3), [1, 3, 5]);
        assert_eq!(centres(axis(10_000_000_000), 1), [5_000_000_000]);

        // Both results of a point are its number. Tiles end in the middle of rows.
        let coordinates = Coordinates::Psi { damping: 0.0 };
        let grid = Grid::new(axis(7), axis(5), coordinates);
        let task = Task { tile_points: 4, ..Task::new(grid, Engine::Exact, "test") };
        let directory = tempfile::tempdir().unwrap();
        let tiles = Tiles::open(&directory.path().join("map.npz"), task, None).unwrap();
        for index in 0..9 {
            let points = tiles.task().range(index);
            let eps_t = points.clone().map(|point| point as f64).collect();
            let switch_count = points.map(|point| i32::try_from(point).unwrap()).collect();
            tiles.keep(index, &Tile { eps_t, switch_count }).unwrap();
        }
        let (size, thumbnail) = read(&tiles, 3).unwrap();
        assert_eq!(size, (3, 3));
        assert_eq!(thumbnail.switch_count, [1, 3, 5, 15, 17, 19, 29, 31, 33]);
        assert_eq!(thumbnail.eps_t[8], 33.0);
        let (_, all) = read(&tiles, 100).unwrap();
        assert_eq!(all.switch_count, (0..35).collect::<Vec<_>>());
    }
}
