//! Standard output and standard error.

use std::fmt::Display;
use std::io::{self, BufWriter, Write};

use stickslip_files::output::file::{StoredFile, publish, standard_output};

use crate::error::Failure;

/// Writes results to standard output. If its reader has gone away, that is not a failure: the
/// reader has seen enough.
pub fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::new(standard_output().map_err(Failure::Stdout)?.lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Stdout(error)),
        _ => Ok(()),
    }
}

/// Gives files their names, and says on standard error what was `found`, which may be nothing, and
/// which files have it.
pub fn deliver(
    files: impl IntoIterator<Item = StoredFile>,
    found: impl Display,
) -> Result<(), Failure> {
    let files: Vec<_> = files.into_iter().collect();
    let names: Vec<_> = files.iter().map(StoredFile::shown).collect();
    publish(files)?;
    if !names.is_empty() {
        let found = found.to_string();
        let between = if found.is_empty() { "" } else { "; " };
        say(format_args!("{found}{between}wrote {}", names.join(", ")));
    }
    Ok(())
}

/// A number of things: `1 region`, `16 regions`.
pub fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

/// Writes a line to standard error.
pub fn say(line: impl Display) {
    // If standard error is closed, nobody wants to know.
    let _ = writeln!(io::stderr(), "{line}");
}
