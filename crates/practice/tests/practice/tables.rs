//! Tables of ε_t.

use std::fs;
use std::path::Path;

use fastrand::Rng;
use stickslip_model::{Contact, Engine, InvalidValue, Law, exact};
use stickslip_plane::{Range, progress};
use stickslip_practice::tables::{self, RestitutionTable, TableError, TableSettings, TableWindow};
use stickslip_practice::tables::{Keys, TableDocument};

use crate::c_program;

/// A window of every kind of boundary: ends of contact, grazes in stick and in slip, crossings.
fn small(bound: f64) -> TableSettings {
    TableSettings { window: scaled((0.5, 4.5), (0.2, 2.4), 0.0), bound, regions: true }
}

fn scaled(kappa: (f64, f64), psi: (f64, f64), damping: f64) -> TableWindow {
    let [kappa, psi] = [kappa, psi].map(|(low, high)| Range { low, high });
    TableWindow::Scaled { kappa, psi, damping, law: Law::PAPER, tangential_damping: 0.0 }
}

fn made(settings: &TableSettings) -> RestitutionTable {
    tables::run(settings, progress::SILENT).expect("a table")
}

fn exact_eps_t(table: &RestitutionTable, kappa: f64, psi: f64) -> f64 {
    let TableWindow::Scaled { damping, .. } = table.window else { panic!("another window") };
    let contact = Contact::new(kappa, psi, damping).expect("a contact");
    Engine::Exact.collide(contact).expect("a collision").0.eps_t()
}

/// The largest error at random points of a table.
fn largest_error(table: &RestitutionTable, points: u32) -> f64 {
    let mut random = Rng::with_seed(7);
    let mut largest = 0.0_f64;
    for _ in 0..points {
        let [kappa, psi] =
            table.window.sides().map(|side| side.low + (side.high - side.low) * random.f64());
        largest = largest.max((table.eps_t(kappa, psi) - exact_eps_t(table, kappa, psi)).abs());
    }
    largest
}

#[test]
fn errors_are_within_the_bound() {
    for bound in [1e-3, 1e-6] {
        let table = made(&small(bound));
        assert!(table.verification.largest_error <= bound);
        let largest = largest_error(&table, 20_000);
        assert!(largest <= bound && largest > 1e-6 * bound, "{bound:e}: {largest:e}");
        assert_eq!((table.constant_eps_n, table.bound), (Some(1.0), bound));
        assert_eq!(table.eps_n(1.0), 1.0);
    }
}

#[test]
fn a_kink_stays_a_kink() {
    // Where a stick phase comes to graze, the slope of ε_t jumps from −0.26 to −2.81.
    let window = scaled((4.9, 5.1), (0.25, 0.28), 0.0);
    let settings = TableSettings { window, ..TableSettings::default() };
    let table = made(&settings);
    let (kappa, boundary) = (4.982599522946337, 0.26518218756776374);
    let slope = |step: f64| {
        let difference = table.eps_t(kappa, boundary + step) - table.eps_t(kappa, boundary);
        difference / step
    };
    assert!((slope(-1e-5) + 0.2594).abs() < 2e-3, "{}", slope(-1e-5));
    assert!((slope(1e-5) + 2.828).abs() < 2e-3, "{}", slope(1e-5));
}

#[test]
fn with_damping_too() {
    let window = scaled((2.0, 8.0), (0.1, 1.5), 0.3);
    let settings = TableSettings { window, bound: 1e-5, regions: false };
    let table = made(&settings);
    assert!(largest_error(&table, 5_000) <= 1e-5);
    let contact = Contact::new(3.0, 1.0, 0.3).unwrap();
    assert!((table.eps_n(3.0) - exact::collide(contact).unwrap().eps_n).abs() < 1e-14);
    assert!(table.regions.is_empty() && table.region(3.0, 1.0).is_none());
}

#[test]
fn regions_have_the_switches_of_collisions() {
    let table = made(&small(1e-4));
    let mut random = Rng::with_seed(3);
    let mut known = 0;
    for _ in 0..5_000 {
        let kappa = 0.5 + 4.0 * random.f64();
        let psi = 0.2 + 2.2 * random.f64();
        let itinerary = exact::collide(Contact::new(kappa, psi, 0.0).unwrap()).unwrap().itinerary();
        if let Some(region) = table.region(kappa, psi) {
            assert_eq!(table.regions[region], itinerary, "{kappa} {psi}");
            known += 1;
        }
    }
    assert!(known > 4_990, "{known}");
}

#[test]
fn edges_belong_to_the_table_and_nothing_else_has_a_value() {
    let table = made(&small(1e-4));
    let [(k0, k1), (p0, p1)] = table.window.sides().map(|side| (side.low, side.high));
    for (kappa, psi) in [(k0, p0), (k1, p1), (k0, p1), (k1, p0), (2.0, p1), (2.0, p0), (k0, 1.0)] {
        let error = (table.eps_t(kappa, psi) - exact_eps_t(&table, kappa, psi)).abs();
        assert!(error <= 1e-4, "{kappa} {psi}: {error:e}");
    }
    // Boundaries, walls and a vertex themselves.
    for (kappa, psi) in [(1.0, 2.0), (1.568459250641868, 1.0), (0.5701023788418932, 2.0)] {
        let error = (table.eps_t(kappa, psi) - exact_eps_t(&table, kappa, psi)).abs();
        assert!(error <= 1e-4, "{kappa} {psi}: {error:e}");
    }
    for &kappa in &table.arrays().walls {
        assert!((table.eps_t(kappa, 0.9) - exact_eps_t(&table, kappa, 0.9)).abs() <= 1e-4);
    }
    let (nan, infinity) = (f64::NAN, f64::INFINITY);
    let beyond = [0.0, -0.0, -1.0, nan, -nan, infinity, -infinity, 5e-324, f64::MAX];
    for value in beyond.into_iter().chain([k0.next_down(), k1.next_up()]) {
        assert!(table.eps_t(value, 1.0).is_nan() && table.region(value, 1.0).is_none());
        assert!(table.eps_n(value).is_nan());
    }
    for value in beyond.into_iter().chain([p0.next_down(), p1.next_up()]) {
        assert!(table.eps_t(1.0, value).is_nan() && table.region(1.0, value).is_none());
    }
}

#[test]
fn threads_change_no_bit() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| made(&small(1e-4)))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn a_document_makes_the_same_table() {
    let table = made(&small(1e-4));
    let text = serde_json::to_string(&TableDocument::from(&table)).unwrap();
    let document: TableDocument = serde_json::from_str(&text).unwrap();
    assert_eq!(RestitutionTable::try_from(document), Ok(table));
}

#[test]
fn a_document_with_fewer_keys_is_readable() {
    let table = made(&small(1e-4));
    let mut document = TableDocument::from(&table);
    // Two keys of y become one, whose hint is that of the lower.
    let arrays = &mut document.arrays;
    let keys = arrays.strip_keys;
    let [first, last] = [keys.first, keys.first + keys.count as u64 - 1];
    let pairs: Vec<usize> = (first / 2..=last / 2)
        .map(|pair| usize::try_from((2 * pair).saturating_sub(first)).expect("few keys"))
        .collect();
    arrays.strip_keys = Keys { shift: keys.shift + 1, first: first / 2, count: pairs.len() };
    let slabs = arrays.strip_hints.chunks(keys.count);
    arrays.strip_hints = slabs.flat_map(|hints| pairs.iter().map(|&key| hints[key])).collect();
    let read = RestitutionTable::try_from(document).expect("a table");
    let [kappa, psi] = table.window.sides();
    for k in 0..2000 {
        let (i, j) = (f64::from(k % 40) / 39.0, f64::from(k / 40) / 49.0);
        let at = [kappa.low + (kappa.high - kappa.low) * i, psi.low + (psi.high - psi.low) * j];
        assert_eq!(read.eps_t(at[0], at[1]), table.eps_t(at[0], at[1]), "{at:?}");
    }
}

#[test]
fn documents_that_contradict_themselves_are_refused() {
    let document = TableDocument::from(&made(&small(1e-3)));
    let refused = |change: &dyn Fn(&mut TableDocument)| {
        let mut changed = document.clone();
        change(&mut changed);
        let error = RestitutionTable::try_from(changed).expect_err("a contradiction");
        assert!(!error.to_string().is_empty());
    };
    refused(&|it| it.schema = "stickslip.table/0".to_owned());
    for (kappa, psi) in [
        ((0.0, 4.5), (0.2, 2.4)),
        ((0.5, 4.5), (0.2, f64::NAN)),
        ((0.5, f64::INFINITY), (0.2, 2.4)),
        ((0.5, 4.5), (2.4, 0.2)),
        ((0.5, 5.0), (0.2, 2.4)),
    ] {
        refused(&|it| it.window = scaled(kappa, psi, 0.0));
    }
    refused(&|it| it.window = scaled((0.5, 4.5), (0.2, 2.4), -1.0));
    refused(&|it| it.constant_eps_n = Some(-1.0));
    refused(&|it| it.constant_eps_n = None);
    refused(&|it| it.arrays.normals = vec![0.0; 8]);
    refused(&|it| it.arrays.scales.clear());
    refused(&|it| it.arrays.walls.swap(1, 2));
    refused(&|it| it.arrays.walls[3] = f64::NAN);
    refused(&|it| it.arrays.rows[0] = f64::INFINITY);
    refused(&|it| it.arrays.rows.truncate(24));
    refused(&|it| it.arrays.graphs.push(0.0));
    refused(&|it| it.arrays.first_strips[1] = 1);
    refused(&|it| *it.arrays.first_strips.last_mut().unwrap() += 1);
    refused(&|it| it.arrays.first_rows[2] = u32::MAX);
    refused(&|it| it.arrays.slab_hints[0] = 9);
    refused(&|it| it.arrays.slab_keys.first += 1);
    refused(&|it| it.arrays.strip_hints[0] = 5000);
    refused(&|it| it.arrays.strip_hints.clear());
    refused(&|it| it.arrays.regions[0] = 1000);
    refused(&|it| it.regions.clear());
}

#[test]
fn what_cannot_be_is_refused_with_numbers() {
    let refused = |change: fn(&mut TableSettings)| {
        let mut settings = small(1e-4);
        change(&mut settings);
        tables::run(&settings, progress::SILENT).expect_err("no table")
    };
    let bound = |value| TableError::from(InvalidValue::new("bound", value, "1e-12 to 1e-3"));
    assert_eq!(refused(|it| it.bound = 1e-13), bound(1e-13));
    assert_eq!(refused(|it| it.bound = 0.1), bound(0.1));
    assert!(refused(|it| it.bound = f64::NAN).to_string().contains("1e-12 to 1e-3"));
    let empty = refused(|it| it.window = scaled((3.0, 3.0), (0.2, 2.4), 0.0));
    assert!(matches!(empty, TableError::Settings(InvalidValue { name, .. }) if name == "kappa"));
    let negative = refused(|it| it.window = scaled((0.5, 4.5), (-1.0, 2.4), 0.0));
    assert!(matches!(negative, TableError::Settings(_)));
    let negative = refused(|it| it.window = scaled((0.5, 4.5), (0.2, 2.4), -0.1));
    assert!(matches!(negative, TableError::Settings(_)));
    let narrow = refused(|it| it.window = scaled((3.0, 3.0 + 1e-8), (0.2, 2.4), 0.0));
    assert!(matches!(narrow, TableError::Atlas(_)), "{narrow}");
}

#[test]
fn prefixes_that_begin_no_name_are_refused() {
    let table = made(&small(1e-3));
    for prefix in ["", "1a", "_a", "a-b", "a b", "é", "a\n", "*/"] {
        assert!(table.c_header(prefix).is_err(), "{prefix:?}");
    }
}

/// Bits of ε_t and the region at points, as a C program prints them that includes the header.
const PROGRAM: &str = r#"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include "first.h"
#include "second.h"
int main(void)
{
    double kappa, psi;
    while (scanf("%lf %lf", &kappa, &psi) == 2) {
        double value = first_eps_t(kappa, psi);
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        printf("%" PRIx64 " %d %d\n", value == value ? bits : 0, first_region(kappa, psi),
               second_eps_t(kappa, psi) == value);
    }
    return FIRST_EPS_N == 1.0 && first_itineraries[0][0] != '\0' ? 0 : 3;
}
"#;

/// The header compiles without a warning, and its results have the bits of the table. Nothing is
/// compared where there is no C compiler.
#[test]
fn the_header_for_c_has_the_same_bits() {
    if !c_program::can_be_compiled() {
        return;
    }
    let settings = TableSettings { window: scaled((0.9, 4.5), (0.2, 2.4), 0.0), ..small(1e-6) };
    let table = made(&settings);
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("table_header");
    fs::create_dir_all(&directory).unwrap();
    for prefix in ["first", "second"] {
        fs::write(directory.join(prefix).with_extension("h"), table.c_header(prefix).unwrap())
            .unwrap();
    }
    fs::write(directory.join("main.c"), PROGRAM).unwrap();
    let mut points = vec![(0.9, 0.2), (4.5, 2.4), (0.5, 1.0), (2.0, 3.0), (2.0, 2.0), (2.0, 0.2)];
    let mut random = Rng::with_seed(1);
    points.extend((0..5_000).map(|_| (0.9 + 3.6 * random.f64(), 0.2 + 2.2 * random.f64())));
    points.extend(table.arrays().walls.iter().map(|&wall| (wall, 1.0)));
    let lines: Vec<_> = points.iter().map(|(kappa, psi)| format!("{kappa:?} {psi:?}\n")).collect();
    fs::write(directory.join("points.txt"), lines.concat() + "nan nan\ninf 1\n-1 1\n1 -inf\n")
        .unwrap();
    let printed = |options: &[&str]| c_program::printed(&directory, options);
    let one_by_one = printed(&["-DFIRST_ONE_BY_ONE", "-DSECOND_ONE_BY_ONE"]);
    let printed = printed(&[]);
    assert_eq!(printed, one_by_one);
    let region = |kappa, psi| table.region(kappa, psi).map_or(-1, |it| i64::try_from(it).unwrap());
    let expected = points.iter().map(|&(kappa, psi)| {
        let value = table.eps_t(kappa, psi);
        let bits = if value.is_nan() { 0 } else { value.to_bits() };
        format!("{bits:x} {} {}\n", region(kappa, psi), i32::from(!value.is_nan()))
    });
    let expected = expected.collect::<String>() + &"0 -1 0\n".repeat(4);
    for (k, (printed, expected)) in printed.lines().zip(expected.lines()).enumerate() {
        assert_eq!(printed, expected, "{:?}", points.get(k));
    }
    assert_eq!(printed.len(), expected.len());
}
