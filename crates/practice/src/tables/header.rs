//! A table as a header for C.

use std::fmt::{Display, Write};

use super::chebyshev::{ACROSS, ALONG};
use super::stretch::Stretch;
use super::table::{NO_REGION, Table};

/// The header, with names between @ for what differs.
const TEMPLATE: &str = include_str!("header.h");

/// The part of the header about regions.
const REGIONS: &str = "
static inline int @prefix@_region(double kappa, double psi)
{
    uint32_t strip;
    double along, across;
    if (!@prefix@_place(kappa, psi, &strip, &along, &across))
        return -1;
    return @prefix@_strip_regions[strip];
}
";

/// The prefix cannot begin names in C.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("prefix = {0:?}; expected up to 64 ASCII letters, digits and _, and a letter first")]
pub struct InvalidPrefix(pub String);

/// Checks that `prefix` can begin names in C.
///
/// # Errors
/// [`InvalidPrefix`]: it cannot.
pub fn require_prefix(prefix: &str) -> Result<(), InvalidPrefix> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let starts = prefix.starts_with(|c: char| c.is_ascii_alphabetic());
    let ok = starts && prefix.len() <= 64 && prefix.chars().all(is_name);
    if ok { Ok(()) } else { Err(InvalidPrefix(prefix.to_owned())) }
}

impl Table {
    /// The table as a self-contained header for C99, whose names begin with `prefix`. Functions and
    /// arguments are explained in it.
    ///
    /// # Errors
    /// [`InvalidPrefix`]: the prefix cannot begin names in C.
    pub fn c_header(&self, prefix: &str) -> Result<String, InvalidPrefix> {
        require_prefix(prefix)?;
        let arrays = self.arrays();
        let with_regions = !arrays.regions.is_empty();
        let mut text = TEMPLATE.to_owned();
        let mut fill = |name: &str, value: &str| text = text.replace(name, value);
        fill("@REGIONS@", if with_regions { REGIONS } else { "" });
        let region = if with_regions {
            "the number of the region of the atlas, an index of @prefix@_itineraries; or -1"
        } else {
            "not in this file, which was written without regions"
        };
        fill("@REGION@", region);
        fill("@ARRAYS@", &self.c_arrays());
        fill("@SUMMARY@", &self.summary());
        for (name, value) in [
            ("@KAPPA_LOW@", self.kappa[0]),
            ("@KAPPA_HIGH@", self.kappa[1]),
            ("@PSI_LOW@", self.psi[0]),
            ("@PSI_HIGH@", self.psi[1]),
            ("@DAMPING@", self.damping),
            ("@EPS_N@", self.eps_n),
            ("@BOUND@", self.bound),
        ] {
            fill(name, &format!("{value:?}"));
        }
        for (name, keys) in [("SLAB", arrays.slab_keys), ("STRIP", arrays.strip_keys)] {
            fill(&format!("@{name}_SHIFT@"), &keys.shift.to_string());
            fill(&format!("@{name}_FIRST@"), &format!("UINT64_C({})", keys.first));
        }
        fill("@SLABS@", &arrays.scales.len().to_string());
        fill("@prefix@", prefix);
        fill("@PREFIX@", &prefix.to_uppercase());
        Ok(text)
    }

    fn summary(&self) -> String {
        let [kappa, psi] = [self.kappa, self.psi];
        format!(
            "The restitution of two frictional spheres (Schwager, Becker and Poeschel, Eur. Phys. J. \
             E\n * 27, 107, 2008) for kappa from {:?} to {:?} and psi from {:?} to {:?} at the scaled \
             damping\n * {:?}. The error of eps_t is below {:?}; at {} points it was at most {:.2e}.\n \
             * Written by stickslip.",
            kappa[0],
            kappa[1],
            psi[0],
            psi[1],
            self.damping,
            self.bound,
            self.verification.points,
            self.verification.largest_error
        )
    }

    fn c_arrays(&self) -> String {
        let arrays = self.arrays();
        let stretch = |stretch: &Stretch| *stretch as u8;
        let stretches = |of: &[Stretch]| of.iter().map(stretch).collect::<Vec<_>>();
        let (graphs, _) = arrays.graphs.as_chunks::<ALONG>();
        let (rows, _) = arrays.rows.as_chunks::<ACROSS>();
        let mut out = String::new();
        list(&mut out, "uint32_t", "slab_hints", &arrays.slab_hints);
        doubles(&mut out, "walls", &arrays.walls);
        doubles(&mut out, "scales", &arrays.scales);
        list(&mut out, "unsigned char", "slab_stretches", &stretches(&arrays.slab_stretches));
        list(&mut out, "uint32_t", "first_strips", &arrays.first_strips);
        nested(&mut out, "graphs", graphs);
        let keys = arrays.strip_hints.len() / arrays.scales.len();
        open(&mut out, "uint16_t", "strip_hints", &format!("[][{keys}]"));
        for row in arrays.strip_hints.chunks(keys) {
            out.push('{');
            lines(&mut out, row.iter().map(ToString::to_string));
            out.push_str("},\n");
        }
        out.push_str("};\n");
        list(&mut out, "unsigned char", "strip_stretches", &stretches(&arrays.strip_stretches));
        list(&mut out, "uint32_t", "first_rows", &arrays.first_rows);
        nested(&mut out, "rows", rows);
        if !arrays.regions.is_empty() {
            let number = |&region: &u32| if region == NO_REGION { -1 } else { i64::from(region) };
            let regions: Vec<i64> = arrays.regions.iter().map(number).collect();
            list(&mut out, "int", "strip_regions", &regions);
            let names: Vec<_> = self.regions.iter().map(|name| format!("\"{name}\"")).collect();
            list(&mut out, "char *const", "itineraries", &names);
        }
        out
    }
}

/// Adds an array, in lines of up to 100 characters.
fn list(out: &mut String, kind: &str, name: &str, values: &[impl Display]) {
    open(out, kind, name, &format!("[{}]", values.len()));
    lines(out, values.iter().map(ToString::to_string));
    out.push_str("};\n");
}

fn doubles(out: &mut String, name: &str, values: &[f64]) {
    open(out, "double", name, &format!("[{}]", values.len()));
    lines(out, values.iter().map(|value| shortest(*value)));
    out.push_str("};\n");
}

fn nested<const N: usize>(out: &mut String, name: &str, values: &[[f64; N]]) {
    open(out, "double", name, &format!("[{}][{N}]", values.len()));
    for row in values {
        out.push('{');
        for (k, value) in row.iter().enumerate() {
            if k > 0 {
                out.push(',');
            }
            out.push_str(&shortest(*value));
        }
        out.push_str("},\n");
    }
    out.push_str("};\n");
}

fn open(out: &mut String, kind: &str, name: &str, shape: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "static const {kind} @prefix@_{name}{shape} = {{");
}

fn lines(out: &mut String, values: impl Iterator<Item = String>) {
    let mut length = 0;
    for value in values {
        if length + value.len() + 1 > 100 {
            out.push('\n');
            length = 0;
        }
        length += value.len() + 1;
        out.push_str(&value);
        out.push(',');
    }
    out.push('\n');
}

/// The shortest text that reads back as the same double in C.
fn shortest(value: f64) -> String {
    let (plain, scientific) = (format!("{value:?}"), format!("{value:e}"));
    // 1e0 would do for 1.0, and 0 for 0.0.
    let plain = plain.strip_suffix(".0").map_or(plain.clone(), |whole| format!("{whole}."));
    let plain = match plain.strip_prefix("-0.") {
        Some(rest) if !rest.is_empty() => format!("-.{rest}"),
        _ => match plain.strip_prefix("0.") {
            Some(rest) if !rest.is_empty() => format!(".{rest}"),
            _ => plain,
        },
    };
    if scientific.len() < plain.len() { scientific } else { plain }
}
