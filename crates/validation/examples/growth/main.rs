//! How the time of an atlas grows with the number of its curves.
//!
//! Two families: a bent chessboard, whose fields are as many as one likes and have a closed form,
//! and windows of collisions, from an ordinary one to stiff springs. Each atlas is compared with
//! runs at random points: with the closed form, and with the collisions themselves; a point without
//! a region counts as wrong. Curves and regions of a chessboard are also counted without a trace.
//! Times are those of the processors.
//!
//! Run with `cargo run --release -p validation --example growth -- [CURVES] [POINTS]`: chessboards
//! and windows with up to CURVES curves, about, and POINTS points each; 5200 and 20 000 without
//! arguments. Fails if a point or a count is wrong, or if anything speaks against an atlas.

mod chessboard;
mod collisions;

use std::error::Error;
use std::time::Instant;

/// An atlas of one size, and what was found about it.
struct Row {
    what: String,
    curves: usize,
    regions: usize,
    unresolved: usize,
    findings: usize,
    wrong: usize,
    /// What else is not as it should be.
    objection: Option<String>,
    seconds: f64,
}

impl Row {
    fn print(&self, points: usize) {
        let Self { what, curves, regions, unresolved, findings, wrong, seconds, .. } = self;
        let each = 1e3 * seconds / *curves as f64;
        println!(
            "| {what} | {curves} | {regions} | {unresolved} | {findings} | {wrong} of {points} | \
             {seconds:.2} s | {each:.2} ms |"
        );
        if let Some(objection) = &self.objection {
            eprintln!("{what}: {objection}");
        }
    }

    fn is_right(&self) -> bool {
        self.wrong == 0 && self.objection.is_none()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut count = |usual: usize| arguments.next().map_or(Ok(usual), |argument| argument.parse());
    let (most, points) = (count(5200)?, count(20_000)?);
    println!("| window | curves | regions | unresolved | findings | wrong | time | per curve |");
    println!("|---|---|---|---|---|---|---|---|");
    let mut right = true;
    let mut report = |row: Row| {
        row.print(points);
        right &= row.is_right();
    };
    for side in chessboard::SIDES {
        if chessboard::counts(side).curves <= most {
            report(chessboard::row(side, points)?);
        }
    }
    for window in collisions::WINDOWS.iter().filter(|window| window.about <= most) {
        report(collisions::row(window, points)?);
    }
    if right { Ok(()) } else { Err("an atlas is not right".into()) }
}

/// The result of a computation, and its time in seconds: that of all processors where the system
/// tells it, so that other work does not count.
fn timed<T>(compute: impl FnOnce() -> T) -> (T, f64) {
    let (start, processor) = (Instant::now(), processor_seconds());
    let result = compute();
    let spent = processor_seconds().zip(processor).map(|(after, before)| after - before);
    (result, spent.unwrap_or_else(|| start.elapsed().as_secs_f64()))
}

/// The processor time of this process so far, in hundredths of a second, from Linux's `/proc`.
fn processor_seconds() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, in parentheses, may have spaces.
    let mut fields = status.rsplit_once(')')?.1.split_whitespace();
    let user: f64 = fields.nth(11)?.parse().ok()?;
    let system: f64 = fields.next()?.parse().ok()?;
    Some((user + system) / 100.0)
}
