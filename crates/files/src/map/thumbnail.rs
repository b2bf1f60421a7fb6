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
