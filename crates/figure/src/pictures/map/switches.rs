//! The colours of the numbers of switches, their labels in the regions, and their key.

use std::collections::BTreeSet;

use colorous::Color;

use super::panel::{MapPanel, MapValues};
use crate::canvas::panel::{LINEAR, Panel};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{self, SMALL};
use crate::canvas::svg::{Anchor, Svg, Words};
use crate::canvas::{Cells, place};
use crate::error::FigureError;

/// The largest number of labels beside the key.
const MOST_NUMBERS: usize = 16;

/// All numbers of switches that occur in `maps`, so that each number has one colour in all panels.
pub fn counts(maps: &[MapPanel<'_>]) -> Vec<i32> {
    let values = maps.iter().flat_map(|map| match map.values {
        MapValues::Switches(values) => values,
        MapValues::Restitution(_) => &[],
    });
    let counts: BTreeSet<i32> = values.copied().filter(|&count| count >= 0).collect();
    counts.into_iter().collect()
}

/// Draws the map of the numbers of switches into `panel`, with its key; `counts` are all numbers
/// that have a colour.
pub fn draw(
    svg: &mut Svg,
    map: &MapPanel<'_>,
    panel: &Panel,
    values: &[i32],
    counts: &[i32],
) -> Result<(), FigureError> {
    // If there are more numbers than colours, neighbours share a colour.
    let colours = counts.len().min(usize::from(u8::MAX));
    let shade = |count: i32| {
        let rank = counts.binary_search(&count).ok()?;
        u8::try_from(rank * colours / counts.len()).ok()
    };
    let mut palette: Vec<_> = (0..colours).map(|i| style::ordered(i, colours)).collect();
    palette.push(style::MISSING);
    let missing = u8::try_from(colours).unwrap_or(u8::MAX);
    let colour = |count: i32| palette[usize::from(shade(count).unwrap_or(missing))];
    let pixel = |cell: usize| shade(values[cell]).unwrap_or(missing);
    svg.image(panel.frame, &map.bitmap(pixel, palette.clone()).base64()?);
    map.over(svg, panel);

    svg.begin_group("regions");
    let values = map.free_of_points(panel, values);
    let cells = Cells { columns: map.columns, values: &values };
    let cell_width = panel.frame.width / map.columns as f64;
    let cell_height = panel.frame.height / map.rows as f64;
    let half_size = |count: i32| {
        // Figures are 0.64 of the font size wide and 0.73 high.
        let digits = count.to_string().len() as f64;
        ((0.32 * SMALL * digits + 2.0) / cell_width, (0.365 * SMALL + 2.0) / cell_height)
    };
    for label in place(cells, half_size).into_iter().filter(|label| label.value >= 0) {
        let x = panel.frame.left + (label.column as f64 + 0.5) * cell_width;
        let y = panel.frame.bottom() - (label.row as f64 + 0.5) * cell_height;
        let text = label.value.to_string();
        let words = Words::new(&text, SMALL, Anchor::Middle);
        svg.words((x, y), Words { colour: style::readable_on(colour(label.value)), ..words });
    }
    svg.end_group();
    map.axes(svg, panel, map.heading);

    key(svg, map.beside(panel), counts, colour);
    Ok(())
}

/// The key: a field for each number of switches, or a scale from 0 to the largest number where the
/// fields would be too many to be labelled.
fn key(svg: &mut Svg, frame: Rectangle, counts: &[i32], colour: impl Fn(i32) -> Color) {
    let few = counts.len() <= MOST_NUMBERS;
    let largest = counts.last().copied().unwrap_or(0).max(1);
    let top = if few { counts.len().max(1) as f64 } else { f64::from(largest) };
    let key = Panel { frame, x: (0.0, 1.0), y: (0.0, top), scales: LINEAR };
    // Each colour reaches down to the bottom, under the colours that follow, so that no seams show.
    for (rank, count) in counts.iter().enumerate().rev() {
        let upper = if few { rank as f64 + 1.0 } else { f64::from(*count) };
        let (left, top) = key.place((0.0, upper));
        let height = key.frame.bottom() - top;
        svg.fill(Rectangle { left, top, height, ..key.frame }, &style::hex(colour(*count)));
    }
    svg.begin_group("counts");
    let mut label = |count: i32, height: f64| {
        let (x, y) = key.place((1.0, height));
        svg.words((x + 8.0, y), Words::new(&count.to_string(), SMALL, Anchor::Start));
    };
    if few {
        for (rank, count) in counts.iter().enumerate() {
            label(*count, rank as f64 + 0.5);
        }
    } else {
        let step = even_step(largest);
        // The largest number is labelled in any case, and keeps its neighbour away.
        let others = (0..largest).step_by(usize::try_from(step).unwrap_or(1));
        others.filter(|count| largest - count > step / 2).for_each(|c| label(c, f64::from(c)));
        label(largest, f64::from(largest));
    }
    svg.end_group();
    key.border(svg);
}

/// A round even number, of which at most [`MOST_NUMBERS`] multiples are below `largest`.
fn even_step(largest: i32) -> i32 {
    let steps = (0..9).flat_map(|power| [2, 4, 10].map(|digit| digit * 10_i32.pow(power)));
    let fits = |step: &i32| largest / step < i32::try_from(MOST_NUMBERS).unwrap_or(i32::MAX);
    steps.filter(|step| *step > 0).find(fits).unwrap_or(largest)
}

#[cfg(test)]
mod tests {
    use super::even_step;

    #[test]
    fn steps_of_the_key_are_even_and_few() {
        for (largest, step) in
            [(17, 2), (34, 4), (164, 20), (218, 20), (1000, 100), (i32::MAX, 200_000_000)]
        {
            assert_eq!(even_step(largest), step, "{largest}");
        }
    }
}
