//! The energies of two gases of examples/gas.c over time, as a picture: one with a table of ε_t,
//! and one with a constant.
//!
//! Run what is at the head of examples/gas.c, and then
//! `cargo run --release -p validation --example gas -- table.csv constant.csv gas.svg`.

use std::error::Error;
use std::{env, fs};

use stickslip_figure::canvas::panel::Scale;
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::pictures::chart::{self, ChartAxis, LineChart, Series};
use stickslip_figure::style::{BLUE, VERMILION};

/// A line of a file: time in s, and the energies of motion and of spin.
type State = [f64; 3];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [table, constant, out] = arguments.as_slice() else {
        return Err("expected the files of both gases and FILE.svg".into());
    };
    let (table, constant) = (states(table)?, states(constant)?);
    let line = |name: &str, of: &[State], energy: usize, stroke: Stroke| Series {
        name: name.to_owned(),
        points: of.iter().map(|state| (state[0], state[energy])).collect(),
        line: Some(stroke),
        mark: None,
    };
    let full = Stroke::full;
    let dashed = |colour| Stroke { dashes: "6 4", ..full(colour, 1.6) };
    let series = vec![
        line("motion, ε_t of the table", &table, 1, full(BLUE, 1.6)),
        line("spin, ε_t of the table", &table, 2, full(VERMILION, 1.6)),
        line("motion, constant ε_t", &constant, 1, dashed(BLUE)),
        line("spin, constant ε_t", &constant, 2, dashed(VERMILION)),
    ];
    let last = table[table.len() - 1][0].max(constant[constant.len() - 1][0]);
    let axis = |name, range| ChartAxis { name, range, scale: Scale::Logarithmic };
    let picture = chart::draw(&LineChart {
        title: "Mean energies in a gas of rough spheres",
        x: axis("time in s", (table[1][0].min(constant[1][0]), last)),
        y: axis("energy, as a part of that of motion at the start", (5e-5, 1.0)),
        series,
    });
    fs::write(out, picture.document())?;
    for (name, states) in [("table", &table), ("constant", &constant)] {
        for state in states.iter().filter(|state| state[1] < 0.01).take(1) {
            println!(
                "{name}: motion {:.3e}, spin {:.3e} at {:.3e} s",
                state[1], state[2], state[0]
            );
        }
        let [time, motion, spin] = states[states.len() - 1];
        println!("{name}: motion {motion:.3e}, spin {spin:.3e} at {time:.3e} s");
    }
    Ok(())
}

/// The lines of a file, of which there are two or more.
fn states(file: &str) -> Result<Vec<State>, Box<dyn Error>> {
    let text = fs::read_to_string(file)?;
    let mut states = Vec::new();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [_, time, motion, spin, _] = cells.as_slice() else {
            return Err(format!("{file}: expected five cells, not {line:?}").into());
        };
        states.push([time.parse()?, motion.parse()?, spin.parse()?]);
    }
    if states.len() < 2 {
        Err(format!("{file}: expected two lines or more").into())
    } else {
        Ok(states)
    }
}
