//! What a CSV file looks like before its rows are known: where they begin, and whether quotes,
//! fields and rows have a sensible size.

use std::io;

/// Most lines that a quoted field may have. A quote that is not closed would swallow all rows after
/// it.
const QUOTED_LINES: u64 = 100;
/// Largest number of bytes of a field.
const FIELD_BYTES: usize = 1 << 20;
/// Largest number of fields of a row.
pub const FIELDS: usize = 10_000;
/// Most blank lines between two rows.
const BLANK_LINES: u64 = 1_000_000;

/// The byte order mark of UTF-8, which some programs write first.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Where a row begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Begin {
    /// The byte with which it begins, counted from 0.
    pub byte: u64,
    /// The line on which it begins, counted from 1.
    pub line: u64,
}

/// How far the text has been scanned. Scanning fails where the text has no sensible size, before
/// anything has to hold a row.
#[derive(Debug)]
pub struct Scan {
    state: State,
    /// The number of bytes so far.
    bytes: u64,
    /// The line of the next byte, counted from 1.
    line: u64,
    /// Whether the last byte was a carriage return, of which a line feed may be the other half.
    after_return: bool,
    field_bytes: usize,
    fields: usize,
    blank_lines: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// At the start of the file, behind so many bytes of a byte order mark.
    Mark { bytes: usize },
    /// Before a row.
    Between,
    /// At the start of a field that is not the first.
    Start,
    /// In a field without quotes, or behind its closing quote.
    Field,
    /// In a quoted field that began on a line.
    Quoted { line: u64 },
    /// Behind a quote in a quoted field, which closes it unless another quote follows.
    Closing { line: u64 },
}

impl Scan {
    /// Nothing has been scanned yet.
    pub fn new() -> Self {
        Self {
            state: State::Mark { bytes: 0 },
            bytes: 0,
            line: 1,
            after_return: false,
            field_bytes: 0,
            fields: 0,
            blank_lines: 0,
        }
    }

    /// Scans the next bytes, and adds the rows that begin there to `begins`.
    ///
    /// # Errors
    /// What has no sensible size, and on which line.
    pub fn take(&mut self, mut bytes: &[u8], begins: &mut Vec<Begin>) -> io::Result<()> {
        while let Some((byte, rest)) = bytes.split_first() {
            self.step(*byte, begins)?;
            bytes = rest;
            if self.state == State::Field {
                let more = bytes.iter().position(|byte| matches!(byte, b',' | b'\r' | b'\n'));
                let more = more.unwrap_or(bytes.len());
                self.bytes += more as u64;
                self.field_bytes += more;
                self.check_field(self.line)?;
                bytes = &bytes[more..];
            }
        }
        Ok(())
    }

    fn step(&mut self, byte: u8, begins: &mut Vec<Begin>) -> io::Result<()> {
        if let State::Mark { bytes } = self.state {
            if MARK.get(bytes) == Some(&byte) {
                self.state = State::Mark { bytes: bytes + 1 };
                self.bytes += 1;
                return Ok(());
            }
            self.end_mark(bytes, begins)?;
        }
        let at = self.bytes;
        self.bytes += 1;
        let begins_on = self.line;
        let ends_line = match byte {
            b'\n' => !self.after_return,
            b'\r' => true,
            _ => false,
        };
        self.line += u64::from(ends_line);
        self.after_return = byte == b'\r';
        if matches!(self.state, State::Between) {
            if matches!(byte, b'\r' | b'\n') {
                self.blank_lines += u64::from(ends_line);
                return within(self.blank_lines <= BLANK_LINES, begins_on, || {
                    format!("more than {BLANK_LINES} blank lines; expected rows")
                });
            }
            begins.push(Begin { byte: at, line: begins_on });
            (self.fields, self.blank_lines) = (0, 0);
            self.state = State::Start;
        }
        self.state = match (self.state, byte) {
            (State::Quoted { line }, b'"') => State::Closing { line },
            (State::Quoted { line }, _) => {
                within(self.line - line < QUOTED_LINES, line, || {
                    unclosed(&format!("is not closed within {QUOTED_LINES} lines"))
                })?;
                State::Quoted { line }
            }
            (State::Closing { line }, b'"') => State::Quoted { line },
            (State::Start, b'"') => State::Quoted { line: begins_on },
            (_, b',') => {
                self.fields += 1;
                State::Start
            }
            (_, b'\r' | b'\n') => State::Between,
            _ => State::Field,
        };
        if matches!(self.state, State::Start | State::Between) {
            self.field_bytes = 0;
        } else {
            self.field_bytes += 1;
        }
        self.check_field(begins_on)?;
        within(self.fields < FIELDS, begins_on, || {
            format!("a row with more than {FIELDS} fields; expected at most {FIELDS}")
        })
    }

    /// The byte order mark ends after so many of its bytes. A part of it is text of the first
    /// field.
    fn end_mark(&mut self, bytes: usize, begins: &mut Vec<Begin>) -> io::Result<()> {
        self.state = State::Between;
        if bytes < MARK.len() {
            self.bytes = 0;
            MARK[..bytes].iter().try_for_each(|byte| self.step(*byte, begins))?;
        }
        Ok(())
    }

    fn check_field(&self, line: u64) -> io::Result<()> {
        within(self.field_bytes <= FIELD_BYTES, line, || {
            format!("a field with more than {FIELD_BYTES} bytes; expected a CSV file")
        })
    }

    /// The end of the text.
    ///
    /// # Errors
    /// The text ends in a quoted field, which begins on the line that is named.
    pub fn end(&mut self, begins: &mut Vec<Begin>) -> io::Result<()> {
        match self.state {
            State::Mark { bytes } => self.end_mark(bytes, begins),
            State::Quoted { line } => Err(refused(line, &unclosed("is not closed"))),
            _ => Ok(()),
        }
    }
}

fn unclosed(how: &str) -> String {
    format!("a quote that begins here {how}; expected \" at its end, and \"\" for a quote inside")
}

fn within(holds: bool, line: u64, message: impl FnOnce() -> String) -> io::Result<()> {
    if holds { Ok(()) } else { Err(refused(line, &message())) }
}

fn refused(line: u64, message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, format!("line {line}: {message}"))
}
