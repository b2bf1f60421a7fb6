//! What a CSV file looks like before its rows are known: on which lines they begin, and whether
//! quotes, fields and rows have a sensible size.

use std::collections::VecDeque;
use std::io::{self, Read};

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

/// A source of CSV text, scanned as it is read. Reading fails where the text has no sensible size,
/// before the reader of rows has to hold it.
#[derive(Debug)]
pub struct Scanned<R> {
    source: R,
    scan: Scan,
}

/// How far the text has been scanned.
#[derive(Debug)]
struct Scan {
    state: State,
    /// The line of the next byte, counted from 1.
    line: u64,
    /// Whether the last byte was a carriage return, of which a line feed may be the other half.
    after_return: bool,
    field_bytes: usize,
    fields: usize,
    blank_lines: u64,
    /// The lines on which rows begin that have not been asked for.
    begins: VecDeque<u64>,
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

impl<R: Read> Scanned<R> {
    pub fn new(source: R) -> Self {
        let scan = Scan {
            state: State::Mark { bytes: 0 },
            line: 1,
            after_return: false,
            field_bytes: 0,
            fields: 0,
            blank_lines: 0,
            begins: VecDeque::new(),
        };
        Self { source, scan }
    }

    /// The line on which the next row begins, of those that have not been asked for.
    pub fn next_row(&mut self) -> Option<u64> {
        self.scan.begins.pop_front()
    }
}

impl<R: Read> Read for Scanned<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.source.read(buffer)?;
        if count == 0 && !buffer.is_empty() {
            self.scan.end()?;
        }
        self.scan.take(&buffer[..count])?;
        Ok(count)
    }
}

impl Scan {
    fn take(&mut self, bytes: &[u8]) -> io::Result<()> {
        bytes.iter().try_for_each(|byte| self.step(*byte))
    }

    fn step(&mut self, byte: u8) -> io::Result<()> {
        if let State::Mark { bytes } = self.state {
            if MARK.get(bytes) == Some(&byte) {
                self.state = State::Mark { bytes: bytes + 1 };
                return Ok(());
            }
            self.state = State::Between;
        }
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
            self.begins.push_back(begins_on);
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
        within(self.field_bytes <= FIELD_BYTES, begins_on, || {
            format!("a field with more than {FIELD_BYTES} bytes; expected a CSV file")
        })?;
        within(self.fields < FIELDS, begins_on, || {
            format!("a row with more than {FIELDS} fields; expected at most {FIELDS}")
        })
    }

    fn end(&self) -> io::Result<()> {
        match self.state {
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
