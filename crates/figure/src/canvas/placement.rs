//! Places of labels in the regions of a map.

/// A map of cells, each with the value of its region.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Number of cells in a row.
    pub columns: usize,
    /// The values of the cells, row by row.
    pub values: &'a [i32],
}

/// A label in the widest part of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// The value of the region.
    pub value: i32,
    /// Column of the cell in the middle of the label.
    pub column: usize,
    /// Row of the cell in the middle of the label.
    pub row: usize,
}

/// One label for each connected region of equal values that has room for it.
///
/// `half_size` is half the width and half the height of a value's label, in cells. A label lies
/// within its region, at the place with the most room around it, in units of its own size.
///
/// Cells connect through edges, not through corners, and not through a neck narrower than a quarter
/// of a label: where two boundaries cross, such a neck joins regions that meet in a point only.
/// Labels on both sides of a neck overlap by a quarter at most.
pub fn place(cells: Cells<'_>, half_size: impl Fn(i32) -> (f64, f64)) -> Vec<Label> {
    /// Half the width of the narrowest neck, in half sizes of a label.
    const NECK: f64 = 0.25;
    let Cells { columns, values } = cells;
    let rows = values.len() / columns;
    let across = clearance(values, (0..rows).map(|row| row * columns), 1, columns);
    let along = clearance(values, 0..columns, columns, rows);
    // Room around a cell in its row and in its column, in half sizes.
    let rooms: Vec<(f64, f64)> = values
        .iter()
        .zip(across.iter().zip(&along))
        .map(|(value, (across, along))| {
            let (half_width, half_height) = half_size(*value);
            (across / half_width, along / half_height)
        })
        .collect();
    let wide: Vec<bool> = rooms.iter().map(|(width, height)| width.min(*height) >= NECK).collect();
    let (regions, count) = regions(cells, &wide);
    // The most room in each region so far, the room that decides between equals, and the place.
    let mut best = vec![((1.0, 0.0), None); count];
    for place in 0..values.len() {
        let (width, height) = rooms[place];
        let Some(region) = regions[place] else { continue };
        let ((most, _), _) = best[region];
        if width.min(height) < most {
            continue;
        }
        let (_, half_height) = half_size(values[place]);
        // The largest box of the label's shape: every row that it covers must be wide enough.
        let mut room = width.min(height);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let within_run = 1..=along[place] as usize;
        for distance in within_run {
            let reach = (distance as f64 - 0.5) / half_height;
            if reach >= room {
                break;
            }
            let narrowest =
                rooms[place - distance * columns].0.min(rooms[place + distance * columns].0);
            room = room.min(reach.max(narrowest));
        }
        let rank = (room, width + height);
        if rank > best[region].0 {
            best[region] = (rank, Some(place));
        }
    }
    let label =
        |place| Label { value: values[place], column: place % columns, row: place / columns };
    best.into_iter().filter_map(|(_, place)| place.map(label)).collect()
}

/// Distance from the middle of every cell to the nearer end of its run of equal values, along lines
/// of `length` cells that begin at `starts`.
fn clearance(
    values: &[i32],
    starts: impl Iterator<Item = usize>,
    stride: usize,
    length: usize,
) -> Vec<f64> {
    let mut clearance = vec![0.0; values.len()];
    for start in starts {
        let cell = |index: usize| start + index * stride;
        let mut begin = 0;
        for end in 1..=length {
            if end == length || values[cell(end)] != values[cell(begin)] {
                for index in begin..end {
                    clearance[cell(index)] = 0.5 + (index - begin).min(end - 1 - index) as f64;
                }
                begin = end;
            }
        }
    }
    clearance
}

/// The index of the connected region of every cell that is `wide`, and the number of regions.
fn regions(Cells { columns, values }: Cells<'_>, wide: &[bool]) -> (Vec<Option<usize>>, usize) {
    let mut regions = vec![None; values.len()];
    let mut count = 0;
    let mut waiting = Vec::new();
    for seed in 0..values.len() {
        if !wide[seed] || regions[seed].is_some() {
            continue;
        }
        regions[seed] = Some(count);
        waiting.push(seed);
        while let Some(cell) = waiting.pop() {
            let column = cell % columns;
            let neighbours = [
                (column > 0).then(|| cell - 1),
                (column + 1 < columns).then_some(cell + 1),
                cell.checked_sub(columns),
                Some(cell + columns).filter(|&below| below < values.len()),
            ];
            for next in neighbours.into_iter().flatten() {
                if wide[next] && regions[next].is_none() && values[next] == values[cell] {
                    regions[next] = Some(count);
                    waiting.push(next);
                }
            }
        }
        count += 1;
    }
    (regions, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells drawn as lines of digits.
    fn labels(drawing: &[&str], half_size: (f64, f64)) -> Vec<(i32, usize, usize)> {
        let digit = |c: char| i32::try_from(c.to_digit(10).unwrap()).unwrap();
        let values: Vec<_> = drawing.iter().flat_map(|line| line.chars().map(digit)).collect();
        let cells = Cells { columns: drawing[0].len(), values: &values };
        place(cells, |_| half_size).iter().map(|l| (l.value, l.column, l.row)).collect()
    }

    #[test]
    fn in_the_middle_of_a_rectangle() {
        assert_eq!(labels(&["000000000"; 3], (0.5, 0.5)), [(0, 4, 1)]);
        assert_eq!(labels(&["000"; 7], (0.5, 0.5)), [(0, 1, 3)]);
    }

    #[test]
    fn in_the_broad_part_and_not_in_a_hole() {
        let bent = [
            "0000000001", //
            "0000000001", //
            "0001111111", //
            "0001111111", //
            "0001111111", //
        ];
        // The leg of the bend, and the middle of the block.
        assert_eq!(labels(&bent, (1.0, 1.0)), [(0, 1, 2), (1, 6, 3)]);
        let ring = ["0000000", "0111110", "0122210", "0122210", "0122210", "0111110", "0000000"];
        assert_eq!(labels(&ring, (1.0, 1.0)), [(2, 3, 3)]);
        let rings = labels(&ring, (0.5, 0.5));
        assert_eq!(rings.iter().map(|label| label.0).collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn each_region_for_itself_and_none_without_room() {
        let apart = ["00010001", "00010001", "00010011", "00010111"];
        assert_eq!(labels(&apart, (1.5, 1.5)), [(0, 1, 1)]);
        let columns: Vec<_> = labels(&apart, (0.5, 1.5)).iter().map(|label| label.1).collect();
        assert_eq!(columns, [1, 3, 5, 7]);
        // Through a corner nothing connects.
        assert_eq!(labels(&["01", "10"], (0.5, 0.5)).len(), 4);
        assert_eq!(labels(&["01", "10"], (0.6, 0.5)), []);
    }

    #[test]
    fn a_neck_divides() {
        let dumbbell = ["00000100000", "00000100000", "00000000000", "00000100000", "00000100000"];
        let zeros = |half_size| {
            let labels = labels(&dumbbell, half_size).into_iter();
            labels.filter(|label| label.0 == 0).collect::<Vec<_>>()
        };
        assert_eq!(zeros((2.5, 2.5)), [(0, 2, 2), (0, 8, 2)]);
        // For smaller labels it is not a neck.
        assert_eq!(zeros((1.5, 1.5)).len(), 1);
    }

    #[test]
    fn every_box_lies_within_its_region() {
        let (columns, rows, half_size) = (90_usize, 70_usize, (4.2, 2.6));
        // Wavy rings around a corner.
        #[allow(clippy::cast_possible_truncation)]
        let value = |cell: usize| {
            let (column, row) = ((cell % columns) as f64, (cell / columns) as f64);
            (column.hypot(row) / 13.0 + (0.2 * column).sin()).floor() as i32
        };
        let values: Vec<_> = (0..columns * rows).map(value).collect();
        let labels = place(Cells { columns, values: &values }, |_| half_size);
        assert!(labels.len() >= 8, "{}", labels.len());
        for label in &labels {
            for (cell, value) in values.iter().enumerate() {
                let across = (cell % columns).abs_diff(label.column) as f64 - 0.5;
                let along = (cell / columns).abs_diff(label.row) as f64 - 0.5;
                let covered = across < half_size.0 && along < half_size.1;
                assert!(!covered || *value == label.value, "{label:?} covers {cell}");
            }
            let (left, top) = (label.column as f64 + 0.5, label.row as f64 + 0.5);
            assert!(left >= half_size.0 && left + half_size.0 <= columns as f64);
            assert!(top >= half_size.1 && top + half_size.1 <= rows as f64);
        }
    }
}
