//! The colours of the tangential restitution, and their key.

use super::colour_scale::{ColourScale, SHADES};
use super::panel::MapPanel;
use crate::canvas::Bitmap;
use crate::canvas::panel::{Edge, LINEAR, Panel};
use crate::canvas::style;
use crate::canvas::svg::Svg;
use crate::error::FigureError;

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
