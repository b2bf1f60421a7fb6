use rayon::ThreadPoolBuilder;
use stickslip_model::{CollisionError, Contact, Engine, Tolerances};
use stickslip_plane::sweep::{FailureCount, NO_COUNT, NO_EPS_T, compute, point};
use stickslip_plane::{Coordinates, Grid, GridAxis, Range, Tile};

fn grid(kappa: (f64, f64), psi: (f64, f64), damping: f64) -> Grid {
    let axis = |(low, high), cells| GridAxis { range: Range { low, high }, cells };
    let coordinates = Coordinates::Psi { damping };
    Grid::new(axis(kappa, 12), axis(psi, 7), coordinates)
}

fn bits(tile: &Tile) -> (Vec<u64>, &[i32]) {
    (tile.eps_t.iter().map(|eps_t| eps_t.to_bits()).collect(), &tile.switch_count)
}

#[test]
fn points_are_single_collisions() {
    for (damping, engine) in [
        (0.0, Engine::Exact),
        (0.0, Engine::Dopri5(Tolerances::DOPRI5)),
        (0.1, Engine::Auto),
        (0.1, Engine::Dop853(Tolerances::DOP853)),
    ] {
        let grid = grid((0.0, 70.0), (0.0, 2.9), damping);
        let tile = compute(&grid, engine, 0..grid.points());
        assert_eq!((tile.eps_t.len(), tile.switch_count.len()), (84, 84));
        for index in 0..grid.points() {
            let (column, row) = grid.cell(index);
            let (kappa, psi) = (grid.columns.centre(column), grid.rows.centre(row));
            let contact = Contact::new(kappa, psi, damping).unwrap();
            let (collision, _) = engine.collide(contact).unwrap();
            assert_eq!(tile.eps_t[index].to_bits(), collision.eps_t().to_bits());
            let count = i32::try_from(collision.switches.len()).unwrap();
            assert_eq!(tile.switch_count[index], count);
            assert_eq!(point(&grid, engine, index), Ok((collision.eps_t(), count)));
        }
    }
}

#[test]
fn the_number_of_threads_and_the_order_of_tiles_change_nothing() {
    let grid = grid((0.0, 70.0), (0.0, 2.9), 0.1);
    let whole = compute(&grid, Engine::Auto, 0..grid.points());
    for threads in [1, 2, 7] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let again = pool.install(|| compute(&grid, Engine::Auto, 0..grid.points()));
        assert_eq!(bits(&again), bits(&whole), "{threads} threads");
    }
    let later = compute(&grid, Engine::Auto, 30..84);
    let earlier = compute(&grid, Engine::Auto, 0..30);
    let parts = Tile {
        eps_t: [earlier.eps_t, later.eps_t].concat(),
        switch_count: [earlier.switch_count, later.switch_count].concat(),
    };
    assert_eq!(bits(&parts), bits(&whole));
}

#[test]
fn points_without_a_result_are_counted_and_the_first_has_its_reason() {
    // The exact solution is for κ up to 1e16: half of the columns are beyond it.
    let grid = grid((0.0, 2e16), (3.0, 4.0), 0.0);
    let engine = Engine::Exact;
    let mut failures = FailureCount::default();
    for start in [0, 42] {
        let tile = compute(&grid, engine, start..start + 42);
        for (eps_t, count) in tile.eps_t.iter().zip(&tile.switch_count) {
            assert_eq!(*count == NO_COUNT, eps_t.to_bits() == NO_EPS_T.to_bits());
        }
        failures.add(start, &tile);
    }
    let failed = failures.failed(&grid, engine).unwrap();
    assert_eq!(failed.points, 42);
    assert_eq!((failed.kappa, failed.psi), (grid.columns.centre(6), grid.rows.centre(0)));
    assert_eq!(Err(failed.error.clone()), point(&grid, engine, 6));
    assert!(matches!(failed.error, CollisionError::Exact(_)), "{failed}");
    assert!(failed.to_string().starts_with("kappa = 1.08"), "{failed}");
}

#[test]
fn a_grid_with_all_results_has_no_failure() {
    let grid = grid((0.0, 20.0), (0.0, 2.0), 0.0);
    let mut failures = FailureCount::default();
    failures.add(0, &compute(&grid, Engine::Exact, 0..grid.points()));
    assert_eq!(failures.failed(&grid, Engine::Exact), None);
}

#[test]
fn a_parameter_that_no_collision_can_have_is_named() {
    let grid = grid((0.0, 20.0), (0.0, 2.0), -1.0);
    let error = point(&grid, Engine::Auto, 0).unwrap_err();
    assert!(
        matches!(error, CollisionError::Parameter(ref it) if it.value == (-1.0).into()),
        "{error}"
    );
    let mut failures = FailureCount::default();
    failures.add(0, &compute(&grid, Engine::Auto, 0..grid.points()));
    assert_eq!(failures.failed(&grid, Engine::Auto).unwrap().points, grid.points());
}

/// A grid without columns has no points, and one with more than there are numbers has the most.
#[test]
fn a_point_that_a_grid_does_not_have_is_refused() {
    let mut grid = grid((0.0, 70.0), (0.0, 2.9), 0.0);
    let outside = point(&grid, Engine::Exact, grid.points());
    let expected = "point = 84 is out of range; expected a point of a map of 84";
    assert_eq!(outside.unwrap_err().to_string(), expected);
    grid.columns.cells = 0;
    assert_eq!((grid.points(), grid.cell(5)), (0, (0, 5)));
    let outside = point(&grid, Engine::Exact, 0);
    assert_eq!(
        outside.unwrap_err().to_string(),
        "point = 0 is out of range; expected a point of a map of 0"
    );
    grid.columns.cells = usize::MAX;
    assert_eq!(grid.points(), usize::MAX);
}

#[test]
fn bytes_of_any_length_are_a_tile_or_none() {
    for points in [0, 1, usize::MAX / 12, usize::MAX] {
        for length in [0, 1, 15, 16, 17] {
            assert_eq!(Tile::from_bytes(&vec![0; length], "", points), None, "{points} {length}");
        }
    }
}
