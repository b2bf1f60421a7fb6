//! The colours and line styles of all pictures.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::style as drawn;
use stickslip_figure::style::{COLOURS, KINDS, PLACES};

/// Colours in maps of colours.
const SHADES: u8 = 255;

/// Colours by name, lines by the kind of a boundary, shades by the character of a phase, and both
/// maps of colours.
#[pyfunction]
pub fn style(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let dictionary = |entries: Vec<(&str, Line)>| -> PyResult<Bound<'_, PyDict>> {
        let dictionary = PyDict::new(py);
        entries.into_iter().try_for_each(|(name, line)| dictionary.set_item(name, line))?;
        Ok(dictionary)
    };
    let boundaries = KINDS.map(|(kind, name, _)| (name, line(drawn::boundary(kind))));
    let places = PLACES
        .iter()
        .flat_map(|(names, _, stroke)| names.iter().map(|name| (*name, line(*stroke))));
    let part = |shade: u8| f64::from(shade) / f64::from(SHADES);
    let diverging = (0..=SHADES).map(|shade| drawn::hex(drawn::diverging(2.0 * part(shade) - 1.0)));
    let growing = (0..=SHADES)
        .map(|shade| drawn::hex(drawn::ordered(usize::from(shade), usize::from(SHADES) + 1)));
    let all = PyDict::new(py);
    all.set_item("colours", COLOURS.to_vec())?;
    all.set_item("rule", drawn::RULE.colour)?;
    all.set_item("boundaries", dictionary(boundaries.to_vec())?)?;
    all.set_item("places", dictionary(places.collect())?)?;
    let phases = [("+", drawn::SLIP_POSITIVE), ("o", drawn::STICK), ("-", drawn::SLIP_NEGATIVE)];
    all.set_item("phases", phases.to_vec())?;
    all.set_item("diverging", diverging.collect::<Vec<_>>())?;
    all.set_item("growing", growing.collect::<Vec<_>>())?;
    Ok(all)
}

/// A colour, and lengths of dashes and gaps in widths of the line.
type Line = (&'static str, Vec<f64>);

fn line(stroke: Stroke) -> Line {
    let lengths = stroke.dashes.split_whitespace().filter_map(|length| length.parse::<f64>().ok());
    (stroke.colour, lengths.map(|length| length / stroke.width).collect())
}
