//! Maps at the resolution of a picture.

use std::io;
use std::ops::Range;

use stickslip_files::FileError;
use stickslip_files::map::{Stored, Task, Tiles, thumbnail};
use stickslip_model::Engine;
use stickslip_plane::{Coordinates, Grid, GridAxis, Range as Interval, Tile};

/// A task of so many columns and rows.
fn task(columns: usize, rows: usize, tile_points: usize) -> Task {
    let axis = |cells| GridAxis { range: Interval { low: 0.0, high: 1.0 }, cells };
    let grid = Grid::new(axis(columns), axis(rows), Coordinates::Psi { damping: 0.0 });
    Task { tile_points, ..Task::new(grid, Engine::Exact, "test") }
}

/// A map whose results are the numbers of the points, without a file.
struct Numbered(Task);

impl Stored for Numbered {
    fn task(&self) -> &Task {
        &self.0
    }

    fn tiles(&self) -> Range<usize> {
        0..self.0.tiles()
    }

    fn read(&self, index: usize) -> io::Result<Tile> {
        let points = self.0.range(index);
        let eps_t: Vec<f64> = points.map(|point| point as f64).collect();
        Ok(Tile { switch_count: vec![0; eps_t.len()], eps_t })
    }

    fn unreadable(&self, error: &io::Error) -> FileError {
        unreachable!("every tile can be read: {error}")
    }
}

#[test]
fn every_pixel_shows_the_cell_at_its_centre() {
    let centres = |cells, most| {
        let (size, thumbnail) = thumbnail::read(&Numbered(task(cells, 1, 32_768)), most).unwrap();
        assert_eq!(size, (thumbnail.eps_t.len(), 1));
        thumbnail.eps_t
    };
    assert_eq!(centres(6, 10), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(centres(6, 3), [1.0, 3.0, 5.0]);
    assert_eq!(centres(7, 3), [1.0, 3.0, 5.0]);
    assert_eq!(centres(10_000_000_000, 1), [5e9]);

    // Both results of a point are its number. Tiles end in the middle of rows.
    let task = task(7, 5, 4);
    let directory = tempfile::tempdir().unwrap();
    let tiles = Tiles::open(&directory.path().join("map.npz"), task, None).unwrap();
    for index in 0..9 {
        let points = tiles.task().range(index);
        let eps_t = points.clone().map(|point| point as f64).collect();
        let switch_count = points.map(|point| i32::try_from(point).unwrap()).collect();
        tiles.keep(index, &Tile { eps_t, switch_count }).unwrap();
    }
    let (size, thumbnail) = thumbnail::read(&tiles, 3).unwrap();
    assert_eq!(size, (3, 3));
    assert_eq!(thumbnail.switch_count, [1, 3, 5, 15, 17, 19, 29, 31, 33]);
    assert_eq!(thumbnail.eps_t[8], 33.0);
    let (_, all) = thumbnail::read(&tiles, 100).unwrap();
    assert_eq!(all.switch_count, (0..35).collect::<Vec<_>>());
}
