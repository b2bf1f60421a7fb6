//! Archives of NumPy arrays.
//!
//! The arrays have the format .npy 1.0 as in numpy/lib/format.py. They are stored without
//! compression in a ZIP archive. Its entries have no time, so that the same arrays are always the
//! same bytes. The header of an array is one line of text. The crates that write it bring a parser
//! generator and a C compiler, or want the array in memory.

use std::io::{self, BufWriter, Write};

/// What an archive is written with.
pub use rawzip::ZipArchiveWriter as Archive;
use rawzip::{Error, ErrorKind};

/// Writes the entry `name`.npy, whose content `elements` writes.
///
/// # Errors
/// The archive cannot be written.
pub fn array<W: Write>(
    archive: &mut Archive<W>,
    name: &str,
    element: &str,
    shape: &str,
    elements: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let (mut entry, config) =
        archive.new_file(format!("{name}.npy").as_str()).start().map_err(plain)?;
    let mut buffer = BufWriter::with_capacity(1 << 16, config.wrap(&mut entry));
    buffer.write_all(&header(element, shape))?;
    elements(&mut buffer)?;
    let (_, descriptor) = buffer.into_inner()?.finish().map_err(plain)?;
    entry.finish(descriptor).map_err(plain)?;
    Ok(())
}

/// The header of a .npy file. It is padded so that the elements begin at a multiple of 64 bytes.
fn header(element: &str, shape: &str) -> Vec<u8> {
    const FIXED: usize = 10;
    let mut text =
        format!("{{'descr': '{element}', 'fortran_order': False, 'shape': ({shape}), }}");
    let length = (FIXED + text.len() + 1).next_multiple_of(64) - FIXED;
    text = format!("{text:<width$}\n", width = length - 1);
    // The shape has at most two numbers of eleven digits, so that the length is far below 65536.
    let [low, high, ..] = length.to_le_bytes();
    [b"\x93NUMPY\x01\x00", &[low, high][..], text.as_bytes()].concat()
}

/// The error of the file or, if the archive is wrong, an error that says so.
pub fn plain(error: Error) -> io::Error {
    match error.into_kind() {
        ErrorKind::IO(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

/// Writes a number as an array without dimensions.
///
/// # Errors
/// The archive cannot be written.
pub fn number<W: Write>(archive: &mut Archive<W>, name: &str, value: f64) -> io::Result<()> {
    array(archive, name, "<f8", "", |out| out.write_all(&value.to_le_bytes()))
}

/// Writes a text as an array without dimensions.
///
/// # Errors
/// The archive cannot be written.
pub fn text<W: Write>(archive: &mut Archive<W>, name: &str, text: &str) -> io::Result<()> {
    // In NumPy a character takes four bytes.
    let element = format!("<U{}", text.chars().count());
    array(archive, name, &element, "", |out| {
        text.chars().try_for_each(|c| out.write_all(&u32::from(c).to_le_bytes()))
    })
}

/// Writes texts as an array of this shape.
///
/// # Errors
/// The archive cannot be written.
pub fn texts<'a, W: Write>(
    archive: &mut Archive<W>,
    name: &str,
    shape: &str,
    texts: impl Iterator<Item = &'a str> + Clone,
) -> io::Result<()> {
    let width = texts.clone().map(|text| text.chars().count()).max().unwrap_or(0);
    array(archive, name, &format!("<U{width}"), shape, |out| {
        for text in texts {
            let padded = text.chars().map(u32::from).chain(std::iter::repeat(0));
            padded.take(width).try_for_each(|c| out.write_all(&c.to_le_bytes()))?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_that_of_numpy() {
        // numpy.lib.format.write_array_header_1_0 of a 2 × 3 array of doubles.
        let text = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
        let expected = format!("{text}{}\n", " ".repeat(118 - text.len() - 1));
        let header = header("<f8", "2, 3");
        assert_eq!(header[..10], *b"\x93NUMPY\x01\x00\x76\x00");
        assert_eq!(String::from_utf8_lossy(&header[10..]), expected);
    }
}
