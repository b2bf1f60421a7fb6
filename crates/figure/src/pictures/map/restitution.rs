//! The colours of the tangential restitution, and their key.

use colorous::Color;

use super::panel::MapPanel;
use crate::canvas::Bitmap;
use crate::canvas::panel::{Edge, LINEAR, Panel};
use crate::canvas::style;
use crate::canvas::svg::Svg;
use crate::error::FigureError;

/// The number of shades of a scale.
const SHADES: u8 = 255;
/// The shade after them stands for cells without a value.
const NO_SHADE: u8 = SHADES;

/// Largest values of a scale, and the distance of its ticks; powers of ten of them serve, too.
const ENDS: [(f64, f64); 5] = [(1.0, 0.2), (2.0, 0.5), (2.5, 0.5), (5.0, 1.0), (10.0, 2.0)];

/// Draws the map of the restitution `values` into `panel`, with its key.
pub fn draw(
    svg: &mut Svg,
    map: &MapPanel<'_>,
    panel: &Panel,
    values: &[f64],
) -> Result<(), FigureError> {
    let scale = ColourScale::of(values);
    let mut palette = scale.palette();
    let key = Bitmap {
        columns: 1,
        rows: usize::from(SHADES),
        pixels: (0..SHADES).rev().collect(),
        palette: palette.clone(),
    };
    palette.push(style::MISSING);
    svg.image(panel.frame, &map.bitmap(|cell| scale.shade(values[cell]), palette).base64()?);

    let frame = map.beside(panel);
    let bar = Panel { frame, x: (0.0, 1.0), y: (scale.lowest(), scale.largest), scales: LINEAR };
    svg.image(bar.frame, &key.base64()?);
    bar.border(svg);
    svg.begin_group("scale");
    bar.ticks_every(svg, Edge::Right, scale.step);
    svg.end_group();
    map.over(svg, panel);
    map.axes(svg, panel, &format!("{}{}", map.heading, bar.power(Edge::Right)));
    Ok(())
}

/// Colours for values from −`largest` to `largest`, or from 0 if no value is negative.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ColourScale {
    /// Whether there are negative values.
    symmetric: bool,
    /// The upper end, a round number.
    largest: f64,
    /// The distance of ticks; both ends are multiples of it.
    step: f64,
}

impl ColourScale {
    /// The scale with the smallest round ends that holds all `values`.
    fn of(values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let symmetric = finite().any(|value| value < 0.0);
        let most = finite().fold(0.0_f64, |most, value| most.max(value.abs()));
        let most = if most > 0.0 { most } else { 1.0 };
        #[allow(clippy::cast_possible_truncation)]
        let power = most.log10().floor() as i32;
        // Parsed, because powers computed are not always the nearest doubles.
        let scaled = |factor: f64| format!("{factor}e{power}").parse().unwrap_or(most);
        let holds = |end: &&(f64, f64)| most <= scaled(end.0) * (1.0 + 1e-9);
        let (end, step) = *ENDS.iter().find(holds).unwrap_or(&ENDS[ENDS.len() - 1]);
        // A scale from 0 has the whole height for half of the values.
        let step = if symmetric { step } else { 0.5 * step };
        Self { symmetric, largest: scaled(end), step: scaled(step) }
    }

    /// The lower end.
    fn lowest(&self) -> f64 {
        if self.symmetric { -self.largest } else { 0.0 }
    }

    /// The shade of a value as an index into the palette.
    fn shade(&self, value: f64) -> u8 {
        if !value.is_finite() {
            return NO_SHADE;
        }
        let part = (value - self.lowest()) / (self.largest - self.lowest());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let shade = (part.clamp(0.0, 1.0) * f64::from(SHADES - 1)).round() as u8;
        shade
    }

    /// The colours of all shades from the lower end to the upper one; white is at 0.
    fn palette(&self) -> Vec<Color> {
        let part = |shade: u8| f64::from(shade) / f64::from(SHADES - 1);
        let sign = |part: f64| if self.symmetric { 2.0 * part - 1.0 } else { part };
        (0..SHADES).map(|shade| style::diverging(sign(part(shade)))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hex(colours: &[Color]) -> Vec<String> {
        colours.iter().copied().map(style::hex).collect()
    }

    fn diverging(parts: [f64; 3]) -> Vec<String> {
        hex(&parts.map(style::diverging))
    }

    #[test]
    fn ends_are_round_and_hold_all_values() {
        for (values, largest, step) in [
            ([-0.0213, 0.01], 0.025, 0.005),
            ([0.83, -0.1], 1.0, 0.2),
            ([-1.0, 0.3], 1.0, 0.2),
            ([-1e-3, 2.4e-3], 2.5e-3, 5e-4),
            ([-0.11, 0.1], 0.2, 0.05),
            ([-0.26, 0.4], 0.5, 0.1),
            ([-0.51, f64::NAN], 1.0, 0.2),
        ] {
            let scale = ColourScale { symmetric: true, largest, step };
            assert_eq!(ColourScale::of(&values), scale);
        }
    }

    #[test]
    fn the_colours_are_symmetric_about_zero() {
        let scale = ColourScale::of(&[-0.6, 1.0]);
        let shades = [-1.0, -0.5, 0.0, 0.5, 1.0, f64::NAN].map(|value| scale.shade(value));
        assert_eq!(shades, [0, 64, 127, 191, 254, 255]);
        let palette = scale.palette();
        assert_eq!(hex(&[palette[0], palette[127], palette[254]]), diverging([-1.0, 0.0, 1.0]));
    }

    #[test]
    fn values_without_a_sign_use_the_whole_scale() {
        let scale = ColourScale::of(&[0.0, 0.97, f64::NAN]);
        assert_eq!(scale, ColourScale { symmetric: false, largest: 1.0, step: 0.1 });
        assert_eq!([0.0, 0.5, 1.0].map(|value| scale.shade(value)), [0, 127, 254]);
        let palette = scale.palette();
        assert_eq!(hex(&[palette[0], palette[127], palette[254]]), diverging([0.0, 0.5, 1.0]));
    }

    #[test]
    fn a_map_of_zeros_or_without_values_has_a_scale() {
        let unit = ColourScale { symmetric: false, largest: 1.0, step: 0.1 };
        assert_eq!(ColourScale::of(&[0.0, -0.0]), unit);
        assert_eq!(ColourScale::of(&[f64::NAN]), unit);
        assert!(ColourScale::of(&[f64::MIN_POSITIVE]).largest > 0.0);
        assert!(ColourScale::of(&[5e-324, -5e-324]).largest > 0.0);
    }
}
