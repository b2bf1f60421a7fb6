//! Standard output and standard error.

use std::fmt::Display;
use std::io::{self, BufWriter, Write};

use crate::error::Failure;

/// Writes results to standard output. If its reader has gone away, that is not a failure: the
/// reader has seen enough.
///
/// # Errors
/// [`Failure::Stdout`]: writing fails for another reason.
pub fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Stdout(error)),
        _ => Ok(()),
    }
}

/// Writes a line to standard error.
pub fn say(line: impl Display) {
    // If standard error is closed, nobody wants to know.
    let _ = writeln!(io::stderr(), "{line}");
}
