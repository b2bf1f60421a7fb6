//! Maps when nothing goes wrong.

use std::fs;

use stickslip_model::spheres::{BodyPair, Material, Surface};
use stickslip_model::{Collider, Contact, exact};

use crate::{Workspace, npz, rows, version_in_maps};

/// The centre of a cell: LO + (HI − LO)·((index + ½)/cells).
fn centre(low: f64, high: f64, index: u32, cells: u32) -> f64 {
    low + (high - low) * ((f64::from(index) + 0.5) / f64::from(cells))
}

#[test]
fn every_cell_is_the_collision_at_its_centre() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:70 --psi 0.1:2.9 --size 7x5 --damping 0.01 --out m.npz";
    // Without a method it is the exact solution.
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    let exact = npz(&workspace.path("m.npz"));
    assert_eq!(exact[5].1.fields(), ["exact"]);
    let (exact, counts) = (exact[2].1.doubles(), exact[3].1.integers());
    let ran = workspace.run(&format!("{line} --method dop853"));
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    assert_eq!(workspace.names(), ["m.npz"]);
    let map = npz(&workspace.path("m.npz"));
    let shapes: Vec<_> =
        map.iter().map(|(name, array)| (name.as_str(), array.shape.as_str())).collect();
    let expected = [
        ("kappa", "7,"),
        ("psi", "5,"),
        ("eps_t", "5, 7"),
        ("switch_count", "5, 7"),
        ("damping", ""),
        ("rtol", ""),
        ("atol", ""),
        ("method", ""),
        ("version", ""),
    ];
    assert_eq!(shapes, expected);
    let facts: Vec<_> = map[4..].iter().flat_map(|(_, array)| array.fields()).collect();
    assert_eq!(facts, ["0.01", "4e-13", "4e-13", "dop853", &version_in_maps()]);
    let [kappa, psi, eps_t] = [0, 1, 2].map(|array| map[array].1.doubles());
    let switch_count = map[3].1.integers();
    for (row, psi) in (0..).zip(psi) {
        assert_eq!(psi, centre(0.1, 2.9, row, 5));
        for (column, kappa) in (0..).zip(&kappa) {
            assert_eq!(*kappa, centre(0.0, 70.0, column, 7));
            let contact = Contact::new(*kappa, psi, 0.01).unwrap();
            let collision = Collider::default().collide(contact).unwrap();
            let point = (7 * row + column) as usize;
            assert_eq!(eps_t[point], collision.eps_t(), "{contact:?}");
            assert_eq!(usize::try_from(switch_count[point]), Ok(collision.switches.len()));
            let solved = stickslip_model::exact::collide(contact).unwrap();
            assert_eq!(exact[point], solved.eps_t(), "{contact:?}");
            assert_eq!(usize::try_from(counts[point]), Ok(solved.switches.len()));
        }
    }
}

#[test]
fn a_table_says_the_same_as_arrays() {
    let workspace = Workspace::new();
    for window in ["--psi 0:2 --method exact", "--ratio 0:3.5 --mu 0.3 --alpha 1/3 --rtol 1e-11"] {
        let line = format!("map --kappa 1:70 {window} --size 30x20 --out");
        for name in ["m.npz", "m.csv"] {
            let ran = workspace.run(&format!("{line} {name}"));
            assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line} {name}");
        }
        let map = npz(&workspace.path("m.npz"));
        let table = rows(&workspace.read("m.csv"));
        assert_eq!(table[0], map.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>());
        assert_eq!(table.len(), 601);
        for (column, (name, array)) in map.iter().enumerate() {
            let elements = array.fields();
            for (point, fields) in table[1..].iter().enumerate() {
                let index = match array.shape.as_str() {
                    "30," => point % 30,
                    "20," => point / 30,
                    "" => 0,
                    _ => point,
                };
                assert_eq!(fields[column], elements[index], "{name}");
            }
        }
    }
}

#[test]
fn a_ratio_is_reduced_to_psi_as_for_one_collision() {
    let workspace = Workspace::new();
    let line = "map --kappa 17:19 --ratio 1:2 --size 1x1 --method exact --out m.csv";
    assert_eq!(workspace.run(line).code, 0);
    let line = "collide --kappa 18 --ratio 1.5 --method exact --format json";
    let point: serde_json::Value = serde_json::from_str(&workspace.run(line).stdout).unwrap();
    let number = |value: &serde_json::Value| format!("{:?}", value.as_f64().unwrap());
    let expected = [
        ("kappa", "18.0".to_owned()),
        ("psi", number(&point["parameters"]["psi"])),
        ("ratio", "1.5".to_owned()),
        ("eps_t", number(&point["eps_t"])),
        ("switch_count", point["switch_count"].to_string()),
        ("mu", "0.4".to_owned()),
        ("alpha", format!("{:?}", 2.0 / 7.0)),
        ("damping", "0.0".to_owned()),
        ("method", "exact".to_owned()),
        ("version", version_in_maps()),
    ];
    let table = rows(&workspace.read("m.csv"));
    assert_eq!(table.len(), 2);
    assert_eq!(table[0], expected.each_ref().map(|(name, _)| (*name).to_owned()));
    assert_eq!(table[1], expected.map(|(_, field)| field));
}

#[test]
fn both_engines_agree() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:70 --psi 0:2.9 --size 60x40";
    assert_eq!(workspace.run(&format!("{line} --out integrated.npz")).code, 0);
    assert_eq!(workspace.run(&format!("{line} --method exact --out exact.npz")).code, 0);
    let [one, two] = ["integrated.npz", "exact.npz"].map(|name| npz(&workspace.path(name)));
    assert_eq!(one[3].1.integers(), two[3].1.integers());
    let psi = one[1].1.doubles();
    for (point, (one, two)) in one[2].1.doubles().iter().zip(two[2].1.doubles()).enumerate() {
        // At 1000 × 1000 points 2.2e-13 was measured.
        assert!(psi[point / 60] * (one - two).abs() < 4e-13, "{point}: {one} {two}");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    // There are several tiles, and the last is not full.
    for (options, extension) in [
        ("--size 70x61 --kappa 900:2000 --psi 0:3", "npz"),
        ("--size 301x203 --kappa 0:70 --ratio 0:4 --method exact", "csv"),
        ("--size 50x40 --kappa 0:70 --psi 0:3 --damping 0.1 --method dopri5", "npz"),
    ] {
        let workspace = Workspace::new();
        let mut first = None;
        for threads in ["--threads 1", "--threads 2", "--threads 4", ""] {
            let ran = workspace.run(&format!("map {options} {threads} --out m.{extension}"));
            assert_eq!(ran.code, 0, "{options}: {}", ran.stderr);
            let bytes = fs::read(workspace.path(&format!("m.{extension}"))).unwrap();
            assert!(first.get_or_insert_with(|| bytes.clone()) == &bytes, "{options} {threads}");
        }
    }
}

#[test]
fn a_map_of_one_column_is_a_line() {
    let workspace = Workspace::new();
    let line = "map --kappa 18:18.000001 --psi 0:2 --size 1x5 --method exact --out m.npz";
    assert_eq!(workspace.run(line).code, 0);
    let map = npz(&workspace.path("m.npz"));
    assert_eq!(map[2].1.shape, "5, 1");
    let expected = map[1].1.doubles().into_iter().map(|psi| {
        let contact = Contact::new(map[0].1.doubles()[0], psi, 0.0).unwrap();
        exact::collide(contact).unwrap().eps_t()
    });
    assert_eq!(map[2].1.doubles(), expected.collect::<Vec<_>>());
}

#[test]
fn a_map_of_two_bodies_in_the_plane_of_their_velocities() {
    let workspace = Workspace::new();
    let file = fs::read_to_string("../../examples/steel_pair.json").unwrap();
    workspace.write("pair.json", file.replace("\"damping_time_s\": 0", "\"damping_time_s\": 1e-7"));
    let line = "map --bodies pair.json --normal 0:200 --tangential 0:100 --size 4x3 \
                --method dop853 --out";
    for name in ["m.npz", "m.csv"] {
        let ran = workspace.run(&format!("{line} {name}"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    }
    let table = rows(&workspace.read("m.csv"));
    assert_eq!(
        table[0].join(","),
        "normal_m_per_s,tangential_m_per_s,kappa,psi,damping,eps_t,switch_count,\
         mu,alpha,effective_mass_kg,elastic_constant_n_per_m1_5,tangential_stiffness_kg_per_s2,\
         damping_time_s,rtol,atol,method,version"
    );
    let map = npz(&workspace.path("m.npz"));
    let arrays: Vec<_> =
        map.iter().map(|(_, array)| (array.shape.as_str(), array.fields().len())).collect();
    let expected =
        [("4,", 4), ("3,", 3), ("4,", 4), ("3, 4", 12), ("4,", 4), ("3, 4", 12), ("3, 4", 12)];
    assert_eq!(arrays[..7], expected);
    assert_eq!(arrays[7..], [("", 1); 10]);
    assert_eq!(map.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>(), table[0]);

    let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
    let surface =
        Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 1e-7 };
    let pair = BodyPair::equal_spheres(0.02, &steel, &surface).unwrap();
    let facts =
        [0.4, pair.alpha, pair.effective_mass_kg, pair.elastic_constant, 1e12, 1e-7, 4e-13, 4e-13];
    let facts = facts.map(|value| format!("{value:?}")).into_iter();
    let facts: Vec<_> = facts.chain(["dop853".to_owned(), version_in_maps()]).collect();
    for row in &table[1..] {
        assert_eq!(row[7..], facts);
    }
    for ((_, array), fact) in map[7..].iter().zip(&facts) {
        assert_eq!(array.fields(), std::slice::from_ref(fact));
    }
    for (point, row) in (0..).zip(&table[1..]) {
        let (normal, tangential) =
            (centre(0.0, 200.0, point % 4, 4), centre(0.0, 100.0, point / 4, 3));
        let contact = pair.impact(normal, tangential).unwrap().contact;
        let collision = Collider::default().collide(contact).unwrap();
        let expected = [
            normal,
            tangential,
            contact.kappa(),
            contact.psi(),
            contact.damping(),
            collision.eps_t(),
        ];
        assert_eq!(row[..6], expected.map(|value| format!("{value:?}")));
        assert_eq!(row[6], collision.switches.len().to_string());
    }
}

#[test]
fn a_picture_alone_is_enough() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:20 --psi 0:2 --size 9x7";
    let ran = workspace.run(&format!("{line} --out m.csv --plot both.svg"));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(ran.said, "63 points computed by the exact solution; wrote m.csv, both.svg\n");
    let ran = workspace.run(&format!("{line} --plot alone.svg"));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(ran.said, "63 points computed by the exact solution; wrote alone.svg\n");
    assert!(workspace.read("alone.svg") == workspace.read("both.svg"));
    assert_eq!(workspace.names(), ["alone.svg", "both.svg", "m.csv"]);
    // Below the range of ψ there is no collision.
    let ran = workspace.run("map --kappa 1:2 --psi 0:1e-120 --size 2x2 --plot none.svg");
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("4 of 4 points could not be computed and are grey in none.svg"));
    let ran = workspace.run(line);
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("--out"), "{}", ran.stderr);
    let ran = workspace.run(&format!("{line} --part 1/2 --plot m.svg"));
    assert_eq!(ran.code, 2);
}

#[test]
fn the_environment_does_not_name_too_many_threads() {
    for (threads, code) in [("1", 0), ("", 0), ("0", 2), ("1025", 2), ("many", 2)] {
        let workspace = Workspace::new();
        let out = workspace.path("m.csv");
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("stickslip"));
        command.args("map --kappa 0:20 --psi 0:2 --size 2x2 --out".split(' ')).arg(out);
        let output = command.env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{threads}");
        let stderr = String::from_utf8(output.stderr).unwrap();
        let expected = "expected a whole number from 1 to 1024";
        assert_eq!(stderr.contains(expected), code == 2, "{stderr}");
    }
}
