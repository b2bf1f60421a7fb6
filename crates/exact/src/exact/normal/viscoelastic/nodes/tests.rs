use super::super::Viscoelastic;
use super::*;

/// Between the points the table has the digits of a trajectory of its own.
#[test]
fn the_table_is_as_good_as_a_trajectory() {
    let mut worst = [0.0_f64; 2];
    for interval in 0..INTERVALS {
        let (low, high) = bounds(interval);
        for part in [0.003, 0.11, 0.37, 0.64, 0.83, 0.995] {
            // With 20 binary digits the damping is known without rounding.
            let root = ((low + (high - low) * part) * 8192.0).round() / 8192.0;
            let table = Nodes::of(root);
            let found = table.at(root);
            let expected = Solved::new(root, table.grids[0]).rows(table.grids, table.counts);
            for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
                for lane in 0..4 {
                    let off = (found[lane] - expected[lane].nearest()).abs();
                    // The first row, U and time are relative to their scale, Q and the changes
                    // of V to themselves.
                    let relative = index > 0 && (lane == 1 || lane == 2);
                    let scale = if relative { expected[lane].nearest().abs() } else { 1.0 };
                    let worst = &mut worst[usize::from(relative)];
                    if off > 0.0 && scale > 0.0 {
                        *worst = worst.max(off / scale);
                    }
                }
            }
        }
    }
    assert!(worst[0] < 4e-15 && worst[1] < 1e-14, "{worst:?}");
}

/// What `tests/data/damped_trajectory_bound.py` and PROOFS.md say of the series in use.
#[test]
fn the_premises_of_the_error_bounds_hold() {
    const KEPT: usize = super::super::ORDERS;
    assert_eq!((KEPT, ORDERS, POINTS, INTERVALS), (17, 28, 20, 37));
    // Bounds of |coefficient n| (10 h)ⁿ in U, V, Q and T for a < 1 and from there on, with h half
    // the distance to the next node.
    let most = [[1.6, 30.0, 15.0, 2.2], [5.0, 100.0, 100.0, 6.5]];
    let mut path = Viscoelastic::empty();
    let mut largest = [[0.0_f64; 4]; 2];
    for interval in 0..INTERVALS {
        let (low, high) = bounds(interval);
        for part in [1e-9, 0.2, 0.5, 0.8, 1.0 - 1e-9] {
            let root = low + (high - low) * part;
            let counts = Nodes::of(root).counts;
            path.prepare(root * root);
            let strong = usize::from(path.scale.strong);
            for (half, count) in path.halves.iter().zip(counts) {
                for index in 0..count {
                    let h = 0.5 * (half.grid.place(index + 1) - half.grid.place(index));
                    let widest =
                        if index < half.grid.wide.into() { 0.25 } else { [0.1, 0.125][strong] };
                    assert!(h < widest + 1e-12, "{h}");
                    let state = &half.nodes[index].state;
                    let series = coefficients::<f64, KEPT>(state, &path.scale.strengths);
                    for (n, term) in (1..).zip(&series) {
                        for (lane, most) in largest[strong].iter_mut().enumerate() {
                            *most = most.max(term[lane].abs() * (10.0 * h).powi(n));
                        }
                    }
                }
            }
        }
    }
    for (largest, most) in largest.iter().flatten().zip(most.iter().flatten()) {
        assert!(0.5 * most < *largest && largest < most, "{largest} {most}");
    }
}

/// The table is the one that has been compared with enclosures of the exact motion: this is the
/// digest that `tests/data/damped_trajectory_bound.py` prints, of all coefficients to 50 bits.
#[test]
fn the_table_is_the_one_whose_errors_are_bounded() {
    let mut digest = 0_u64;
    for interval in 0..INTERVALS {
        for coefficient in Nodes::of(bounds(interval).0).powers.iter().flatten().flatten() {
            // The sum with 0 is never −0.
            let rounded = (coefficient * 2.0_f64.powi(50)).round() + 0.0;
            digest = digest.rotate_left(7) ^ rounded.to_bits();
        }
    }
    assert_eq!(digest, 0x91cd_4ffe_d9a1_71bc);
}

/// Writes the table for `tests/data/damped_trajectory_bound.py`: for every interval its number,
/// the wide steps, both counts of nodes and the number of coefficients, and then a line with the
/// coefficients of each number of each row, highest power first.
#[test]
#[ignore = "writes 2 MB"]
fn the_table_as_text() {
    for interval in 0..INTERVALS {
        let Nodes { grids, counts, powers, .. } = Nodes::of(bounds(interval).0);
        println!("table {interval} {} {counts:?} {}", grids[1].wide, powers.len());
        for row in 0..=counts[0] + counts[1] {
            for lane in 0..4 {
                print!("row");
                for power in powers {
                    print!(" {:e}", power[row][lane]);
                }
                println!();
            }
        }
    }
}
