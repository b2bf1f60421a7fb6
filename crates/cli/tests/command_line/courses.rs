//! Courses in time.

use std::fs;

use serde_json::Value;
use stickslip_model::{Collider, Contact, presets};

use crate::impact::example;
use crate::{Workspace, rows};

/// The numbers of a column; an empty field is NaN.
fn column(table: &[Vec<String>], name: &str) -> Vec<f64> {
    let place = table[0].iter().position(|it| it == name).unwrap();
    table[1..].iter().map(|row| row[place].parse().unwrap_or(f64::NAN)).collect()
}

fn close(one: f64, other: f64, scale: f64) {
    assert!((one - other).abs() <= 1e-9 * scale, "{one} and {other}");
}

#[test]
fn a_scaled_course_has_every_switch_and_even_times() {
    for (law, damping) in [("paper", "0"), ("paper", "0.3"), ("gran/hertz/history", "0.3")] {
        let workspace = Workspace::new();
        let given = format!("collide --kappa 63 --psi 0.5 --damping {damping} --law {law}");
        let line = format!("{given} --course c.csv --points 51 --format json");
        let ran = workspace.run(&line);
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
        // The course changes nothing that is printed but the count of work.
        let object: Value = serde_json::from_str(&ran.stdout).unwrap();
        let alone = workspace.run(&format!("{given} --format json")).stdout;
        let alone: Value = serde_json::from_str(&alone).unwrap();
        assert_eq!(object["switches"], alone["switches"]);
        let table = rows(&workspace.read("c.csv"));
        let (time, switch) = (column(&table, "time"), column(&table, "switch"));
        let switches = object["switches"].as_array().unwrap();
        assert_eq!(time.len(), 51 + switches.len());
        assert!(time.is_sorted_by(|one, next| one < next));
        let duration = object["contact_time"].as_f64().unwrap();
        let even = (0..51).map(|index| duration * f64::from(index) / 50.0);
        let plain = time.iter().zip(&switch).filter(|(_, switch)| switch.is_nan());
        plain.zip(even).for_each(|((time, _), even)| close(*time, even, 1.0));
        let marked = (0..time.len()).filter(|row| !switch[*row].is_nan());
        for (row, found) in marked.zip(switches) {
            for (name, key) in [("time", "time"), ("velocity", "velocity"), ("spring", "spring")] {
                close(column(&table, name)[row], found[key].as_f64().unwrap(), 1.0);
            }
            assert_eq!(table[row + 1][1], found["to"].as_str().unwrap());
            assert_eq!(table[row + 1][2], found["side"].to_string());
        }
        // Against the library, and friction's bound.
        let law = presets::find(law).unwrap().law;
        let contact = Contact::new(63.0, 0.5, damping.parse().unwrap()).unwrap();
        let history = Collider::default().history(contact.with_law(law, 0.0).unwrap()).unwrap();
        let [force, pull] = ["normal_force", "tangential_force"].map(|name| column(&table, name));
        for row in 1..time.len() - 1 {
            let at = history.at(time[row]).unwrap();
            close(column(&table, "compression")[row], at.compression, 1.0);
            assert!(pull[row].abs() <= force[row].abs() * (1.0 + 1e-9) + 1e-12);
        }
    }
}

#[test]
fn a_course_in_si_units_meets_the_switches_of_the_impact() {
    for (bodies, options) in [
        ("glass_on_wall.json", ""),
        ("glass_on_wall.json", "--method exact"),
        ("hooke_spheres.json", "--law gran/hooke/history"),
    ] {
        let workspace = Workspace::new();
        workspace.write("bodies.json", fs::read(example(bodies)).unwrap());
        let line = format!("impact bodies.json {options} --course c.csv --format json");
        let ran = workspace.run(&line);
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
        let object: Value = serde_json::from_str(&ran.stdout).unwrap();
        let table = rows(&workspace.read("c.csv"));
        let switches = object["switches"].as_array().unwrap();
        assert_eq!(table.len(), 1001 + switches.len());
        let switch = column(&table, "switch");
        let marked: Vec<_> = (0..switch.len()).filter(|row| !switch[*row].is_nan()).collect();
        assert_eq!(marked.len(), switches.len());
        for name in
            ["time_s", "velocity_m_per_s", "normal_force_n", "tangential_force_n", "spring_m"]
        {
            let numbers = column(&table, name);
            let scale = numbers.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            for (row, found) in marked.iter().zip(switches) {
                match found[name].as_f64() {
                    Some(value) => close(numbers[*row], value, scale),
                    None => assert!(numbers[*row].is_nan()),
                }
            }
        }
        // The impulse is the integral of the force, by the trapezoidal rule over unequal steps.
        let (time, force) = (column(&table, "time_s"), column(&table, "normal_force_n"));
        let steps = time.windows(2).zip(force.windows(2));
        let impulse: f64 = steps.map(|(t, f)| 0.5 * (f[0] + f[1]) * (t[1] - t[0])).sum();
        let vector = |value: &Value| [0, 1, 2].map(|axis| value[axis].as_f64().unwrap());
        let (whole, normal) =
            (vector(&object["impulse_n_s"]), vector(&object["contact"]["normal"]));
        let along: f64 = whole.iter().zip(normal).map(|(one, other)| one * other).sum();
        assert!((impulse / along - 1.0).abs() < 1e-4, "{impulse} and {along}");
        let velocity = column(&table, "normal_velocity_m_per_s");
        let expected = object["contact"]["normal_m_per_s"].as_f64().unwrap();
        close(velocity[0], expected, 1.0);
        let eps_n = object["eps_n"].as_f64().unwrap();
        close(velocity[velocity.len() - 1], -eps_n * expected, 1.0);
    }
}

#[test]
fn nothing_is_tangential_in_a_central_impact() {
    let workspace = Workspace::new();
    workspace.write("bodies.json", fs::read(example("glass_on_wall.json")).unwrap());
    let line = "impact bodies.json --speed 1 --angle 0 --course c.csv --points 20";
    assert_eq!(workspace.run(line).code, 0);
    let table = rows(&workspace.read("c.csv"));
    assert_eq!(table.len(), 21);
    for row in &table[1..] {
        assert_eq!(row[1..4], ["stick", "1", ""]);
        assert_eq!(row[7..], ["0.0", "0.0", "0.0"]);
    }
}

#[test]
fn files_of_courses_that_cannot_be_written() {
    let workspace = Workspace::new();
    for line in
        ["collide --kappa 18 --psi 1 --course no/c.csv", "collide --kappa 18 --psi 1 --course ."]
    {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{line}");
        assert!(ran.stderr.contains("cannot be written"), "{}", ran.stderr);
    }
    for (line, parts) in [
        ("collide --kappa 18 --psi 1 --course p.svg --plot ./p.svg", ["--course", "--plot"]),
        ("collide --batch x.csv --out y.csv --course c.csv", ["--course", "--batch"]),
        ("collide --kappa 18 --psi 1 --points 7", ["--course", "required"]),
        ("collide --kappa 18 --psi 1 --course c.csv --points 0", ["--points", "2..=10000000"]),
    ] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}");
        assert!(parts.iter().all(|part| ran.stderr.contains(part)), "{line}: {}", ran.stderr);
    }
    assert!(workspace.names().is_empty());
    // Both files and the table together.
    let ran =
        workspace.run("collide --kappa 18 --psi 1 --course c.csv --plot p.svg --method exact");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    assert_eq!(workspace.names(), ["c.csv", "p.svg"]);
}
