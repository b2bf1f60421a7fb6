use stickslip_model::Reduction;
use stickslip_model::spheres::{BodyPair, Material, Surface};
use stickslip_plane::{Coordinates, Extent, Grid, GridAxis, Quantity, Range};

fn axis(low: f64, high: f64, cells: usize) -> GridAxis {
    GridAxis { range: Range { low, high }, cells }
}

/// 5 × 3 cells of each kind of coordinates.
fn grids() -> [Grid; 3] {
    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e8, damping_time_s: 1e-6 };
    let pair = BodyPair::equal_spheres(0.02, &steel, &surface).unwrap();
    let reduction = Reduction { mu: 0.4, alpha: 2.0 / 7.0 };
    [
        Coordinates::Psi { damping: 0.1 },
        Coordinates::Ratio { reduction, damping: 0.1 },
        Coordinates::Velocities { pair },
    ]
    .map(|coordinates| Grid::new(axis(1.0, 6.0, 5), axis(0.5, 2.0, 3), coordinates))
}

#[test]
fn centres_are_in_the_middle_of_cells_of_equal_width() {
    let axis = axis(0.0, 70.0, 40);
    assert_eq!(axis.centre(0), 0.875);
    assert_eq!(axis.centre(39), 69.125);
    for index in 1..40 {
        assert!((axis.centre(index) - axis.centre(index - 1) - 1.75).abs() < 1e-13);
    }
    assert_eq!(GridAxis { cells: 1, ..axis }.centre(0), 35.0);
}

#[test]
fn points_are_counted_row_by_row_and_cells_are_their_inverse() {
    let grid = grids()[0];
    assert_eq!(grid.points(), 15);
    assert_eq!((grid.cell(0), grid.cell(4), grid.cell(5)), ((0, 0), (4, 0), (0, 1)));
    for point in 0..grid.points() {
        let (column, row) = grid.cell(point);
        assert!(column < 5 && row < 3);
        assert_eq!(grid.point(column, row), point);
    }
}

#[test]
fn contacts_have_the_coordinates_of_their_centres() {
    for grid in grids() {
        for point in 0..grid.points() {
            let (column, row) = grid.cell(point);
            let (x, y) = (1.5 + column as f64, 0.75 + 0.5 * row as f64);
            let contact = grid.contact(column, row).unwrap();
            let [kappa, psi, damping] = match grid.coordinates {
                Coordinates::Psi { damping } => [x, y, damping],
                Coordinates::Ratio { reduction, damping } => [x, reduction.psi(y), damping],
                Coordinates::Velocities { pair } => {
                    let contact = pair.impact(x, y).unwrap().contact;
                    [contact.kappa(), contact.psi(), contact.damping()]
                }
            };
            assert_eq!([contact.kappa(), contact.psi(), contact.damping()], [kappa, psi, damping]);
            let [across, along] = grid.axes().map(|axis| grid.value(axis, column, row));
            assert_eq!([across, along], [x, y]);
            assert_eq!(grid.value(Quantity::Psi, column, row), psi);
        }
    }
}

#[test]
fn quantities_vary_over_their_extent_alone() {
    for grid in grids() {
        assert!(grid.axes().iter().all(|axis| grid.quantities().contains(axis)));
        for &quantity in grid.quantities() {
            let value = |column, row| grid.value(quantity, column, row);
            let (across, along) = (value(1, 0) != value(0, 0), value(0, 1) != value(0, 0));
            let expected = match (across, along) {
                (true, true) => Extent::Points,
                (false, true) => Extent::Rows,
                (_, false) => Extent::Columns,
            };
            assert_eq!(grid.extent(quantity), expected, "{quantity:?} of {grid}");
        }
    }
}

#[test]
fn the_largest_stiffness_is_that_of_no_other_cell() {
    for grid in grids() {
        let kappas = (0..grid.points()).map(|point| {
            let (column, row) = grid.cell(point);
            grid.value(Quantity::Kappa, column, row)
        });
        assert_eq!(grid.largest_stiffness(), kappas.fold(0.0, f64::max));
    }
}

#[test]
fn a_cell_without_a_collision_has_no_value() {
    let grid = Grid { coordinates: Coordinates::Psi { damping: -1.0 }, ..grids()[0] };
    assert_eq!(grid.contact(0, 0).unwrap_err().value, (-1.0).into());
    let grid = Grid { columns: axis(-2.0, -1.0, 1), ..grids()[2] };
    assert!(grid.value(Quantity::Kappa, 0, 0).is_nan());
    assert_eq!(grid.value(Quantity::Normal, 0, 0), -1.5);
}

#[test]
fn grids_that_differ_read_differently() {
    let [psi, ratio, velocities] = grids();
    let nearly = Range { high: 6.0_f64.next_up(), low: 1.0 };
    let others = [
        ratio,
        velocities,
        Grid { rows: axis(0.5, 2.0, 4), ..psi },
        Grid { columns: GridAxis { range: nearly, cells: 5 }, ..psi },
        Grid { coordinates: Coordinates::Psi { damping: 0.2 }, ..psi },
    ];
    let text = psi.to_string();
    assert_eq!(
        text,
        "columns: 5, kappa from 1.0 to 6.0\nrows: 3, psi from 0.5 to 2.0\ndamping: 0.1\n"
    );
    assert!(others.iter().all(|other| other.to_string() != text));
}
