//! What holds for the program, whatever is in the files that it reads.

use std::fs;

use stickslip_cli::{Failure, run};
use tempfile::TempDir;

/// Points that are looked up in an atlas.
const POINTS: &str = "kappa,psi\n2.1,0.1\n2.2,0.05\n18,0.5\n0,1\n";

/// Computes the collisions that `csv` describes. Every row of the result has a collision or a
/// reason why it has none.
///
/// # Errors
/// What does not hold.
pub fn batch(csv: &[u8]) -> Result<(), String> {
    read(csv, |path| format!("collide --batch {path} --out {path}.out --method exact --threads 1"))
}

/// Computes the impact that `json` describes. The result goes to standard output.
///
/// # Errors
/// What does not hold.
pub fn impact(json: &[u8]) -> Result<(), String> {
    let (_folder, path) = stored(json)?;
    match run(["stickslip", "impact", &path, "--format", "json"]) {
        Err(failure) if failure.code() == 2 => refused(&failure, &path),
        _ => Ok(()),
    }
}

/// Looks points up in the atlas that `json` describes.
///
/// # Errors
/// What does not hold.
pub fn atlas(json: &[u8]) -> Result<(), String> {
    read(json, |path| {
        let points = format!("{path}.points");
        // If the file cannot be written, the program says that it is missing.
        let _ = fs::write(&points, POINTS);
        format!("locate --atlas {path} --batch {points} --out {path}.out")
    })
}

/// Writes `bytes` to a file, carries out the command line that `line` makes for it, and checks that
/// the output is complete or that the file is refused.
fn read(bytes: &[u8], line: impl Fn(&str) -> String) -> Result<(), String> {
    let (_folder, path) = stored(bytes)?;
    let line = line(&path);
    let ran = run(std::iter::once("stickslip").chain(line.split(' ')));
    let out = fs::read(format!("{path}.out")).ok();
    match &ran {
        Err(failure) if failure.code() == 2 => {
            require(out.is_none(), || format!("{failure}, and there is an output"))?;
            refused(failure, &path)
        }
        _ => complete(&out.unwrap_or_default(), ran.is_ok()),
    }
}

/// A file with `bytes` in its own folder.
fn stored(bytes: &[u8]) -> Result<(TempDir, String), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let path = folder.path().join("in");
    fs::write(&path, bytes).map_err(|error| error.to_string())?;
    let path = path.display().to_string();
    Ok((folder, path))
}

/// Checks that the message names the file and says what is wrong with it, on one line.
fn refused(failure: &Failure, path: &str) -> Result<(), String> {
    let reason = failure.to_string();
    let said = reason.strip_prefix(path).is_some_and(|said| said.len() > 10);
    require(said && !reason.contains('\n'), || format!("{reason:?}"))
}

/// Checks that each row of the table `csv` has its status, and that its results are numbers.
fn complete(csv: &[u8], ok: bool) -> Result<(), String> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(csv);
    let header = reader.byte_headers().map_err(|error| error.to_string())?.clone();
    require(header.len() >= 4, || format!("header {header:?}"))?;
    let mut failed = false;
    for row in reader.byte_records() {
        let row = row.map_err(|error| error.to_string())?;
        require(row.len() == header.len(), || format!("{row:?} under {header:?}"))?;
        let last = String::from_utf8_lossy(&row[row.len() - 1]).into_owned();
        failed |= &header[header.len() - 1] == b"status" && last != "ok";
        for (name, field) in header.iter().zip(&row) {
            let result = [&b"eps_n"[..], b"eps_t", b"contact_time", b"distance"].contains(&name);
            let text = String::from_utf8_lossy(field);
            let finite = text.is_empty() || text.parse().is_ok_and(f64::is_finite);
            require(!result || finite, || format!("{text} in {row:?}"))?;
        }
    }
    require(ok != failed || header.iter().all(|name| name != b"status"), || {
        format!("done: {ok}, but failed: {failed}")
    })
}

fn require(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}
