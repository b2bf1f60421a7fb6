//! The structure of an atlas: its regions as a planar graph with labels, without places.

use std::cmp::Ordering;

use crate::atlas::AtlasOf;
use crate::family::Family;
use crate::regions::outline::OutlinePart;
use crate::regions::region::CurveSide;
use crate::regions::subdivision::Subdivision;
use crate::window::{Point, Window};

/// What lies beside a region on a stretch of its outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Beside {
    /// The region with this index.
    Region(usize),
    /// A side of the window, counterclockwise from the lower one.
    Window(usize),
}

/// A region: its label, and what lies beside it in the order of each of its outlines.
#[derive(Clone, Debug)]
struct Node<Label> {
    label: Label,
    rings: Vec<Vec<Beside>>,
}

/// The regions of an atlas, each with what lies beside it, in order.
///
/// A vertex at which only two curves end, between the same two regions, is not part of it: there a
/// boundary changes its kind, and the regions stay what they are.
#[derive(Clone, Debug)]
pub(super) struct Structure<Label> {
    nodes: Vec<Node<Label>>,
}

/// An atlas at a value of the third parameter, with its structure.
pub(super) struct Sample<F: Family> {
    pub value: f64,
    pub atlas: AtlasOf<F>,
    pub structure: Structure<F::Label>,
}

impl<Label: Clone + Ord> Structure<Label> {
    /// The structure of a plane of a family. The run at its sample point gives the label of a
    /// region that no curve bounds.
    pub fn of<F: Family<Label = Label>>(
        plane: &Subdivision<Label, F::Margin>,
        family: &F,
    ) -> Result<Self, F::Error> {
        let mut degrees = vec![0_usize; plane.vertices().len()];
        for end in plane.curves().iter().filter_map(|curve| curve.ends).flatten() {
            degrees[end] += 1;
        }
        let mut nodes = Vec::with_capacity(plane.regions().len());
        for (index, region) in plane.regions().iter().enumerate() {
            let label = match &region.label {
                Some(label) => label.clone(),
                None => family.label(&region.sample)?,
            };
            let outlines = plane.outlines(index);
            let rings = outlines.iter().map(|outline| ring(plane, &degrees, outline)).collect();
            nodes.push(Node { label, rings });
        }
        Ok(Self { nodes })
    }

    /// The label of a region.
    pub fn label(&self, region: usize) -> &Label {
        &self.nodes[region].label
    }

    /// The labels of all regions, in order.
    pub fn labels(&self) -> Vec<Label> {
        let mut labels: Vec<_> = self.nodes.iter().map(|node| node.label.clone()).collect();
        labels.sort();
        labels
    }

    /// The regions of each structure that the other one does not have, by their indices; `None` if
    /// the structures do not differ.
    ///
    /// Regions are distinguished first by their labels, then also by the labels beside them, then
    /// by the neighbours of these, and so on as long as this distinguishes more regions.
    pub fn differing(&self, other: &Self) -> Option<[Vec<usize>; 2]> {
        let both = [self, other];
        let labels = sorted(both.iter().flat_map(|own| own.nodes.iter().map(|node| &node.label)));
        let mut count = labels.len();
        let mut colours = both.map(|own| {
            own.nodes.iter().map(|node| place(&labels, &&node.label)).collect::<Vec<_>>()
        });
        loop {
            let unmatched = unmatched(&colours, count);
            if unmatched.iter().any(|regions| !regions.is_empty()) {
                return Some(unmatched);
            }
            let signatures = [0, 1].map(|which| {
                let nodes = both[which].nodes.iter().zip(&colours[which]);
                nodes
                    .map(|(node, colour)| (*colour, coloured(&node.rings, &colours[which])))
                    .collect::<Vec<_>>()
            });
            let all = sorted(signatures.iter().flatten());
            if all.len() == count {
                return None;
            }
            count = all.len();
            colours = [0, 1].map(|which| {
                signatures[which].iter().map(|signature| place(&all, &signature)).collect()
            });
        }
    }
}

fn sorted<T: Ord>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut values: Vec<T> = values.collect();
    values.sort();
    values.dedup();
    values
}

/// The place of a value that is in the list.
fn place<T: Ord>(values: &[T], value: &T) -> usize {
    values.partition_point(|other| other.cmp(value) == Ordering::Less)
}

/// The regions of each structure whose colour is not as frequent in the other one.
fn unmatched(colours: &[Vec<usize>; 2], count: usize) -> [Vec<usize>; 2] {
    let counts = [0, 1].map(|which| {
        let mut counts = vec![0_usize; count];
        for &colour in &colours[which] {
            counts[colour] += 1;
        }
        counts
    });
    [0, 1].map(|which| {
        let own = colours[which].iter().enumerate();
        own.filter(|&(_, &colour)| counts[0][colour] != counts[1][colour])
            .map(|(region, _)| region)
            .collect()
    })
}

/// The rings with the colours of the regions, from their least rotation, in order. Sides of the
/// window come before the colours.
fn coloured(rings: &[Vec<Beside>], colours: &[usize]) -> Vec<Vec<usize>> {
    const SIDES: usize = 4;
    let colour = |beside: &Beside| match *beside {
        Beside::Window(side) => side,
        Beside::Region(region) => SIDES + colours[region],
    };
    let mut rings: Vec<Vec<usize>> = rings
        .iter()
        .map(|ring| {
            let ring: Vec<usize> = ring.iter().map(colour).collect();
            let turned = |by: usize| [&ring[by..], &ring[..by]].concat();
            (0..ring.len()).map(turned).min().unwrap_or_default()
        })
        .collect();
    rings.sort();
    rings
}

/// What lies beside an outline, in order.
fn ring<Label: Clone + Ord, Margin>(
    plane: &Subdivision<Label, Margin>,
    degrees: &[usize],
    outline: &[OutlinePart],
) -> Vec<Beside> {
    // What lies beside each stretch, and whether the stretch continues the one before it if both
    // are beside the same.
    let stretches: Vec<(Beside, bool)> = outline
        .iter()
        .filter_map(|stretch| match *stretch {
            OutlinePart::Curve(curve, side) => {
                let (far, start) = match side {
                    CurveSide::Left => (1, 0),
                    CurveSide::Right => (0, 1),
                };
                // Only a plane with findings has a curve without a region beside it.
                let beside = Beside::Region(plane.regions_beside(curve)[far]?);
                let ends = plane.curves()[curve].ends;
                Some((beside, ends.is_some_and(|ends| degrees[ends[start]] == 2)))
            }
            OutlinePart::Window(ends) => {
                Some((Beside::Window(side_of(plane.window(), ends)), true))
            }
        })
        .collect();
    let mut ring: Vec<Beside> = Vec::with_capacity(stretches.len());
    for (index, &(beside, continues)) in stretches.iter().enumerate() {
        let before = stretches[(index + stretches.len() - 1) % stretches.len()].0;
        if !(continues && before == beside) {
            ring.push(beside);
        }
    }
    // A ring whose parts all continue one another is one part.
    if ring.is_empty() {
        stretches.into_iter().take(1).map(|(beside, _)| beside).collect()
    } else {
        ring
    }
}

/// The side of the window on which a straight part of its boundary lies.
pub(super) fn side_of(window: &Window, [from, to]: [Point; 2]) -> usize {
    let middle = from.lerp(&to, 0.5);
    let along = (to - from).abs();
    let upper = |axis: usize| middle[axis] - window.low[axis] > window.high[axis] - middle[axis];
    match (along.x > along.y, upper(0), upper(1)) {
        (true, _, false) => 0,
        (false, true, _) => 1,
        (true, _, true) => 2,
        (false, false, _) => 3,
    }
}
