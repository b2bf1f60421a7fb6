//! Count instructions under callgrind: `RUSTFLAGS="-C target-cpu=x86-64" cargo bench --bench
//! instructions` prints a table of them in Markdown.
//!
//! The program runs itself under valgrind, with a workload done once and `1 + REPEATS` times;
//! start, input and what only the first round costs drop out of the difference. Valgrind (3.19)
//! does not know all instructions of x86-64-v3, for which the workspace is built otherwise.

use std::env;
use std::error::Error;
use std::hint::black_box;
use std::process::Command;

use benches::{contacts, plane};
use stickslip::model::{Collider, Collision, Contact, exact};
use stickslip::plane::{CollisionFamily, CollisionPlane};
use stickslip::solver::EmbeddedPair;
use stickslip::tracer::{Family, TraceOptions, trace};

/// What is counted: its row in the table, and a function that does it some times over and returns
/// how many units one time has.
type Workload = (&'static str, fn(usize) -> usize);

const WORKLOADS: [Workload; 17] = [
    ("collision, dop853 at 4e-13", |times| collisions(EmbeddedPair::Dop853, 4e-13, times)),
    ("collision, dop853 at 1e-12", |times| collisions(EmbeddedPair::Dop853, 1e-12, times)),
    ("collision, dop853 at 1e-9", |times| collisions(EmbeddedPair::Dop853, 1e-9, times)),
    ("collision, dopri5 at 1e-12", |times| collisions(EmbeddedPair::Dopri5, 1e-12, times)),
    ("collision, dopri5 at 1e-9", |times| collisions(EmbeddedPair::Dopri5, 1e-9, times)),
    ("collision, exact", |times| exact_collisions(&contacts::contacts(), times)),
    ("collision with the damping 0.1, dop853 at 4e-13", |times| {
        integrated_collisions(&contacts::damped(), EmbeddedPair::Dop853, 4e-13, times)
    }),
    ("the same, exact", |times| exact_collisions(&contacts::damped(), times)),
    ("the same, exact, each with another damping", |times| {
        exact_collisions(&contacts::damped_differently(), times)
    }),
    ("free run at κ = 63, ψ = 0.5, with its margins", |times| free_runs(&integrated(), times)),
    ("prescribed run there, mean over these margins", |times| {
        prescribed_runs(&integrated(), times)
    }),
    ("boundaries in κ 60–66, ψ 0.45–0.55, traced", |times| traces(&integrated(), times)),
    ("the same free run, exact", |times| free_runs(&exact_family(), times)),
    ("the same prescribed run, exact", |times| prescribed_runs(&exact_family(), times)),
    ("the same boundaries, exact", |times| traces(&exact_family(), times)),
    ("point located among 4000 cubics", located_points),
    ("its vertical distance to the nearest curve", vertical_distances),
];

/// Times a workload is done under measurement.
const REPEATS: usize = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    if let [flag, index, times] = &arguments[..]
        && flag == "--workload"
    {
        println!("{}", WORKLOADS[index.parse::<usize>()?].1(times.parse()?));
        return Ok(());
    }
    // `cargo test --benches` runs them too, without this argument.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let output = |program: &str, arguments: &[&str]| -> Result<String, Box<dyn Error>> {
        let output = Command::new(program).args(arguments).output();
        let output = output.map_err(|error| format!("cannot run {program}: {error}"))?;
        Ok(String::from_utf8(output.stdout)?.trim().to_owned())
    };
    let commit = output("git", &["rev-parse", "--short", "HEAD"])?;
    let dirty = output("git", &["status", "--porcelain", "--untracked-files=no"])?;
    let changed = if dirty.is_empty() { "" } else { ", changed" };
    let date = output("date", &["+%F"])?;
    let (rustc, valgrind) = (output("rustc", &["--version"])?, output("valgrind", &["--version"])?);
    println!("{rustc}, {valgrind}, {date}, commit {commit}{changed}:\n");
    println!("| one | instructions |\n|---|---|");
    for (index, (name, _)) in WORKLOADS.iter().enumerate() {
        let (once, units) = counted(index, 1)?;
        let (again, _) = counted(index, 1 + REPEATS)?;
        let each = (again - once) as f64 / (REPEATS * units) as f64;
        println!("| {name} | {each:.0} |");
    }
    Ok(())
}

/// Instructions of a run of this program that does a workload some times over, and the units of one
/// time.
fn counted(index: usize, times: usize) -> Result<(u64, usize), Box<dyn Error>> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe()?)
        .args(["--workload", &index.to_string(), &times.to_string()])
        .output()?;
    let report = String::from_utf8(output.stderr)?;
    if !output.status.success() {
        let advice = r#"a build with RUSTFLAGS="-C target-cpu=x86-64" has only instructions that valgrind knows"#;
        return Err(format!("{report}the run under valgrind failed; {advice}").into());
    }
    let count =
        report.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    let count = count.ok_or_else(|| format!("{report}no count"))?;
    Ok((count, String::from_utf8(output.stdout)?.trim().parse()?))
}

fn collisions(pair: EmbeddedPair, tolerance: f64, times: usize) -> usize {
    integrated_collisions(&contacts::contacts(), pair, tolerance, times)
}

fn integrated_collisions(
    contacts: &[Contact],
    pair: EmbeddedPair,
    tolerance: f64,
    times: usize,
) -> usize {
    let collider = Collider::with_tolerances(pair, tolerance, tolerance);
    let mut collision = Collision::before(contacts[0]);
    for _ in 0..times {
        for &contact in contacts {
            collider.collide_into(black_box(contact), &mut collision).expect("a collision");
            black_box(collision.final_velocity);
        }
    }
    contacts.len()
}

fn exact_collisions(contacts: &[Contact], times: usize) -> usize {
    let mut collision = Collision::before(contacts[0]);
    for _ in 0..times {
        for &contact in contacts {
            exact::collide_into(black_box(contact), &mut collision).expect("a collision");
            black_box(collision.final_velocity);
        }
    }
    contacts.len()
}

fn collision_plane() -> CollisionPlane {
    CollisionPlane::new((60.0, 66.0), (0.45, 0.55), 0.0).expect("a plane")
}

fn integrated() -> CollisionFamily {
    collision_plane().integrated()
}

fn exact_family() -> CollisionFamily {
    collision_plane().family()
}

fn free_runs(family: &CollisionFamily, times: usize) -> usize {
    let point = collision_plane().point(63.0, 0.5);
    for _ in 0..times {
        black_box(family.free_run(black_box(&point)).expect("a run"));
    }
    1
}

fn prescribed_runs(family: &CollisionFamily, times: usize) -> usize {
    let point = collision_plane().point(63.0, 0.5);
    let margins = family.free_run(&point).expect("a run").margins;
    for _ in 0..times {
        for (margin, _) in &margins {
            black_box(family.margin(black_box(&point), margin).expect("a run"));
        }
    }
    margins.len()
}

fn traces(family: &CollisionFamily, times: usize) -> usize {
    let window = collision_plane().window();
    for _ in 0..times {
        let network = trace(family, black_box(&window), &TraceOptions::default());
        black_box(network.expect("boundaries"));
    }
    1
}

fn located_points(times: usize) -> usize {
    let (plane, points) = (plane::subdivision(plane::curves()), plane::points());
    for _ in 0..times {
        for point in &points {
            black_box(plane.locate(black_box(point)));
        }
    }
    points.len()
}

fn vertical_distances(times: usize) -> usize {
    let (plane, points) = (plane::subdivision(plane::curves()), plane::points());
    for _ in 0..times {
        for point in &points {
            black_box(plane.vertical_distance(black_box(point)));
        }
    }
    points.len()
}
