//! A map as a task: everything on which the results depend, and the tiles into which it is divided.

use std::iter;
use std::ops::Range;

use stickslip_model::Engine;
use stickslip_plane::{Grid, Tile};

/// A map, divided into tiles of successive points, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The cells of the map.
    pub grid: Grid,
    /// What computes the collisions.
    pub engine: Engine,
    /// The program with what its results depend on.
    pub program: String,
    /// Everything on which the results depend, one fact per line.
    pub description: String,
    /// The number of points in each tile. The last tile may have fewer.
    pub tile_points: usize,
}

impl Task {
    /// The task to compute the collisions of `grid` with `engine` in this `program`.
    pub fn new(grid: Grid, engine: Engine, program: &str) -> Self {
        // Up to κ = 64 a tile takes one core 0.3 s. Beyond, work grows as √κ.
        let halvings = (0..9).filter(|n| grid.largest_stiffness() > 64.0 * 4.0_f64.powi(*n));
        let tile_points = 32768 >> halvings.count();
        let method = match engine.tolerances() {
            Some(tolerances) => format!(", rtol {:?}, atol {:?}", tolerances.rtol, tolerances.atol),
            None => String::new(),
        };
        // The digits read back as the same numbers, so that equal texts mean equal tasks.
        let description = format!(
            "{}\n{grid}method: {}{method}\npoints a tile: {tile_points}\n",
            Self::beginning(program),
            engine.name(),
        );
        Self { grid, engine, program: program.to_owned(), description, tile_points }
    }

    /// The first line of every description.
    pub fn beginning(program: &str) -> String {
        format!("program: {program}, tiles 2")
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.grid.points()
    }

    /// The number of tiles.
    pub fn tiles(&self) -> usize {
        self.points().div_ceil(self.tile_points)
    }

    /// The points of tile `index`.
    pub fn range(&self, index: usize) -> Range<usize> {
        let start = index * self.tile_points;
        start..(start + self.tile_points).min(self.points())
    }

    /// The points of successive tiles.
    pub fn points_of(&self, tiles: &Range<usize>) -> usize {
        let start = |index: usize| self.points().min(index * self.tile_points);
        start(tiles.end) - start(tiles.start)
    }

    /// The index of the tile that has `point`, and the point's index in it.
    pub fn place(&self, point: usize) -> (usize, usize) {
        (point / self.tile_points, point % self.tile_points)
    }

    /// What the bytes of tile `index` begin with.
    pub fn label(&self, index: usize) -> String {
        format!("{}tile: {index}\n", self.description)
    }

    /// The number of bytes of successive tiles.
    pub fn bytes_of(&self, tiles: &Range<usize>) -> u64 {
        // A label of a tile without the digits of its index, and a checksum.
        let fixed = Tile::length(&self.label(0), 0) - 1;
        let results = Tile::length("", self.points_of(tiles)) - Tile::length("", 0);
        let digits = digits_below(tiles.end) - digits_below(tiles.start);
        (tiles.len() * fixed + results + digits) as u64
    }
}

/// The number of digits of all numbers below `end` together.
fn digits_below(end: usize) -> usize {
    // Each number has a digit, and another one from 10 on, from 100 on, and so forth.
    let steps = iter::successors(Some(10_usize), |step| step.checked_mul(10));
    end + steps.take_while(|step| *step < end).map(|step| end - step).sum::<usize>()
}

/// The first line of one description that differs from its line of the `other` one, and that line.
pub fn difference<'a>(one: &'a str, other: &'a str) -> (&'a str, &'a str) {
    let [mut ones, mut others] = [one, other].map(|text| text.lines().chain(iter::repeat("")));
    let most = one.lines().count().max(other.lines().count());
    let mut lines = ones.by_ref().zip(others.by_ref()).take(most);
    lines.find(|(one, other)| one != other).unwrap_or(("", ""))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use stickslip_plane::{Coordinates, GridAxis, Range as Interval};

    use super::*;
    use crate::input::part::MapPart;

    /// A task of so many points in tiles of `tile_points`.
    fn task(points: usize, tile_points: usize) -> Task {
        let axis = |cells| GridAxis { range: Interval { low: 0.0, high: 1.0 }, cells };
        let coordinates = Coordinates::Psi { damping: 0.0 };
        let grid = Grid::new(axis(points), axis(1), coordinates);
        Task { tile_points, ..Task::new(grid, Engine::Exact, "test") }
    }

    #[test]
    fn the_bytes_of_tiles_are_counted_without_them() {
        for points in [1, 3, 4, 5, 8, 35, 39, 40, 41, 397, 4001] {
            let task = task(points, 4);
            let mut bytes = 0;
            for index in 0..task.tiles() {
                assert_eq!(task.bytes_of(&(0..index)), bytes);
                let points = task.range(index).len();
                assert_eq!(task.points_of(&(index..index + 1)), points);
                let tile = Tile { eps_t: vec![0.5; points], switch_count: vec![2; points] };
                let one = tile.to_bytes(&task.label(index)).len() as u64;
                assert_eq!(task.bytes_of(&(index..index + 1)), one);
                bytes += one;
            }
            assert_eq!(task.bytes_of(&(0..task.tiles())), bytes);
            assert_eq!(task.points_of(&(0..task.tiles())), points);
        }
    }

    proptest! {
        #[test]
        fn parts_have_each_point_once(
            points in prop_oneof![1_usize..3000, 1_usize..=10_000_000_000],
            tile_points in prop_oneof![Just(1), Just(64), 1_usize..=32768],
            count in prop_oneof![1_usize..40, 1_usize..3000],
        ) {
            let task = task(points, tile_points);
            let mut end = 0;
            for number in 1..=count {
                let tiles = MapPart { number, count }.share(task.tiles());
                if !tiles.is_empty() {
                    prop_assert_eq!(task.range(tiles.start).start, end);
                    end = task.range(tiles.end - 1).end;
                    prop_assert_eq!(task.points_of(&tiles), end - task.range(tiles.start).start);
                }
            }
            prop_assert_eq!(end, points);
        }
    }

    #[test]
    fn the_first_line_that_differs() {
        assert_eq!(difference("a\nb\n", "a\nc\n"), ("b", "c"));
        assert_eq!(difference("a\nb\nc\n", "a\nb\n"), ("c", ""));
        assert_eq!(difference("a\n", "a\nb\n"), ("", "b"));
        assert_eq!(difference("a\n", "a\n"), ("", ""));
    }
}
