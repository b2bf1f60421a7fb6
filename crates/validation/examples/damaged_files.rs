//! Files with random damage: none may be read as another result than was written.
//!
//! Each file is changed at up to four places: a byte is replaced, removed or repeated, a digit
//! becomes another one, a piece is removed, repeated or moved, or the end is cut off. The reader
//! may refuse it, or read what was written: spaces and the spelling of numbers do not matter.

use std::error::Error;
use std::fmt::Debug;
use std::fs;
use std::path::Path;

use fastrand::Rng;
use stickslip_files::input;
use stickslip_files::map::{Parts, Results};
use stickslip_plane::sealed;
use stickslip_practice::tables::{RestitutionTable, TableDocument};

const BALL: &str = "parameter height = 1, e = 0.5, until = 3\nstate x = height, v = 0\nx' = v\n\
                    v' = -1\nwhen x < 0 \"bounce\"\n  x := 0\n  v := -e*v\nend = until\n";

/// Beside a relay, y' = m + n y − y³.
const CUSP: &str = "parameter m = 0.1, n = 1\nstate x = 0, y = 1\ny' = m + n*y - y^3\nmode up\n  \
                    x' = 1 - x\n  when x > 0.5 \"up\" -> down\nmode down\n  x' = -1 - x\n  \
                    when x < -0.5 \"down\" -> up\nstart in up\nend = 9\n";

const GLASS: &str = include_str!("../../../examples/glass_on_wall.json");

/// What is made, by which command, and how it is read.
const FILES: [(&str, &str, Reader); 9] = [
    ("atlas", "trace --kappa 3:8 --psi 0.5:1.5 --out", atlas),
    ("table", "table --kappa 3:8 --psi 0.5:1.5 --bound 1e-5 --regions --out", table),
    (
        "table of velocities",
        "table --bodies glass.json --normal 1:2 --tangential 0.5:2 --bound 1e-4 --regions --out",
        table,
    ),
    (
        "family atlas",
        "trace ball.slip --x e=0.2:0.5 --y height=0.9:1.2 --max-events 4 --out",
        atlas,
    ),
    (
        "stack of a system",
        "stack ball.slip --x e=0.2:0.5 --y height=0.9:1.2 --max-events 4 \
         --over until=1.95,2.2,3.2 --out",
        document,
    ),
    ("stack over the damping", "stack --kappa 6:7 --psi 0.8:1 --damping 0.3,0.35 --out", document),
    (
        "regions of an orbit",
        "regions cusp.slip --itinerary up,down --x m=-0.3:0.3 --y n=0.5:1 --cells 2 --out",
        atlas,
    ),
    ("branch", "branch cusp.slip --itinerary up,down --over m=-0.5:0.5 --out", document),
    ("part of a map", "map --kappa 0:70 --psi 0:2.9 --size 30x20 --part 1/1 --out", part),
];

/// Reads a file, and says what is in it.
type Reader = fn(&Path) -> Result<String, String>;

fn atlas(path: &Path) -> Result<String, String> {
    shown(input::atlas::read(path))
}

fn table(path: &Path) -> Result<String, String> {
    let text = fs::read(path).map_err(|error| error.to_string())?;
    sealed::check(&text).map_err(|error| error.to_string())?;
    let document: TableDocument = serde_json::from_slice(&text).map_err(|e| e.to_string())?;
    shown(RestitutionTable::try_from(document).map(|table| TableDocument::from(&table)))
}

fn document(path: &Path) -> Result<String, String> {
    let text = fs::read(path).map_err(|error| error.to_string())?;
    sealed::check(&text).map_err(|error| error.to_string())?;
    shown(serde_json::from_slice::<serde_json::Value>(&text))
}

fn part(path: &Path) -> Result<String, String> {
    let parts = Parts::open(&[path.to_owned()], &program(path)).map_err(|e| e.to_string())?;
    parts.check(|_| ()).map_err(|error| error.to_string())?;
    let mut all = Vec::new();
    let read = parts.each(|points, tile| {
        all.push(format!("{points:?} {tile:?}"));
        Ok(())
    });
    read.map(|()| all.concat()).map_err(|error| error.to_string())
}

fn shown<T: Debug, E: ToString>(read: Result<T, E>) -> Result<String, String> {
    // Numbers in debug output have all their digits.
    read.map(|found| format!("{found:?}")).map_err(|error| error.to_string())
}

/// The program that the undamaged part beside this one names.
fn program(path: &Path) -> String {
    let whole = fs::read(path.with_extension("whole")).unwrap_or_default();
    let text = String::from_utf8_lossy(&whole);
    let from = text.split_once(r#"{"task":"program: "#).map_or("", |(_, rest)| rest);
    from.split_once(", tiles ").map_or("", |(program, _)| program).to_owned()
}

/// `file` with damage at up to four places.
fn damaged(file: &[u8], random: &mut Rng) -> Vec<u8> {
    let mut bytes = file.to_vec();
    for _ in 0..random.usize(1..=4) {
        if bytes.is_empty() {
            break;
        }
        let at = random.usize(..bytes.len());
        let end = bytes.len().min(at + random.usize(1..60));
        match random.u8(..8) {
            0 => bytes[at] = random.u8(..),
            1 => bytes[at] ^= 1 << random.u8(..8),
            2 => {
                bytes.remove(at);
            }
            3 => bytes.insert(at, bytes[random.usize(..bytes.len())]),
            4 => drop(bytes.drain(at..end)),
            5 => bytes.extend_from_within(at..end),
            6 => {
                let piece: Vec<u8> = bytes.drain(at..end).collect();
                let to = random.usize(..=bytes.len());
                bytes.splice(to..to, piece);
            }
            _ if random.u8(..20) == 0 => bytes.truncate(at),
            _ => {
                let digit = |byte: &&mut u8| byte.is_ascii_digit();
                if let Some(byte) = bytes[at..].iter_mut().find(digit) {
                    *byte = b'0' + random.u8(..10);
                }
            }
        }
    }
    bytes
}

/// Damages each file so many times, and says what became of it.
fn battery(times: usize) -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    for (name, text) in [("ball.slip", BALL), ("cusp.slip", CUSP), ("glass.json", GLASS)] {
        fs::write(folder.path().join(name), text)?;
    }
    for (index, (name, command, read)) in FILES.into_iter().enumerate() {
        // Only the file of a table must say what it is.
        let ending = if name.starts_with("table") { "json" } else { "file" };
        let path = folder.path().join(format!("{index}.{ending}"));
        let words = ["stickslip"].into_iter().chain(command.split_whitespace());
        let placed = |word: &str| match word {
            "ball.slip" | "cusp.slip" | "glass.json" => folder.path().join(word).into_os_string(),
            other => other.into(),
        };
        let words = words.map(placed);
        stickslip_cli::run(words.chain([path.as_os_str().to_owned()]))?;
        let file = fs::read(&path)?;
        fs::copy(&path, path.with_extension("whole"))?;
        let whole = read(&path)?;
        let mut random = Rng::with_seed(u64::try_from(index)?);
        let (mut refused, mut same, mut wrong) = (0, 0, 0);
        for _ in 0..times {
            fs::write(&path, damaged(&file, &mut random))?;
            match read(&path) {
                Err(_) => refused += 1,
                Ok(found) if found == whole => same += 1,
                Ok(_) => wrong += 1,
            }
        }
        println!("{name}: {refused} refused, {same} read as written, {wrong} read as another");
        if wrong > 0 || refused < times / 2 {
            return Err(format!("{name}: {wrong} wrong, {refused} refused").into());
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    battery(5000)
}

#[test]
fn damage_is_noticed() -> Result<(), Box<dyn Error>> {
    battery(150)
}
