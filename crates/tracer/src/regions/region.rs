//! Regions, and the labels that the curves around them give them.

use crate::curve::Curve;
use crate::regions::arrangement::faces::Faces;
use crate::regions::arrangement::piece::Edge;
use crate::regions::arrangement::slabs::Slabs;
use crate::regions::finding::Finding;
use crate::window::Point;

/// A connected part of the window that no curve enters.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Region<Label> {
    /// The label that the curves around the region have on this side; the most frequent label if
    /// they disagree, and `None` if no curve bounds the region.
    pub label: Option<Label>,
    /// The area without islands. It is exact for the interpolated curves.
    pub area: f64,
    /// A point well inside.
    pub sample: Point,
    /// The distance of `sample` from the region's boundary.
    pub clearance: f64,
    /// The indices of the curves that bound the region, with the side on which the region lies.
    pub boundary: Vec<(usize, CurveSide)>,
}

/// A side of a curve, seen in the direction of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum CurveSide {
    /// The left side.
    Left,
    /// The right side.
    Right,
}

/// The regions of the faces, without their sample points.
pub fn regions<Label: Clone + Ord, Margin>(
    curves: &[Curve<Label, Margin>],
    slabs: &Slabs,
    edges: &[Edge],
    faces: &Faces,
    origin: &Point,
) -> Vec<Region<Label>> {
    let empty =
        Region { label: None, area: 0.0, sample: *origin, clearance: 0.0, boundary: Vec::new() };
    let mut regions = vec![empty; faces.count];
    for (index, edge) in edges.iter().enumerate() {
        let area: f64 = slabs.pieces[edge.pieces.clone()]
            .iter()
            .map(|piece| if piece.forward { 1.0 } else { -1.0 } * piece.cubic.area(origin))
            .sum();
        let sides = [(CurveSide::Left, area), (CurveSide::Right, -area)];
        for (face, (side, area)) in faces.of_edges[index].into_iter().zip(sides) {
            let Some(face) = face else { continue };
            regions[face].area += area;
            if index < curves.len() {
                regions[face].boundary.push((index, side));
            }
        }
    }
    for region in &mut regions {
        region.label = most_frequent(region.boundary.iter().map(|&side| label(curves, side)));
    }
    regions
}

/// The label of a curve on one of its sides.
fn label<Label, Margin>(
    curves: &[Curve<Label, Margin>],
    (curve, side): (usize, CurveSide),
) -> &Label {
    &curves[curve].sides[usize::from(side == CurveSide::Right)]
}

/// The most frequent label; the least one if there are several.
fn most_frequent<'a, Label: Clone + Ord + 'a>(
    labels: impl Iterator<Item = &'a Label>,
) -> Option<Label> {
    let mut counts = std::collections::BTreeMap::new();
    for label in labels {
        *counts.entry(label).or_insert(0_usize) += 1;
    }
    let most = counts.values().copied().max()?;
    counts.into_iter().find(|&(_, count)| count == most).map(|(label, _)| label.clone())
}

/// Adds a finding for every curve without the region's label on this side, together with a curve
/// that has it: a neighbour at a vertex, if possible.
pub fn find_disagreements<Label: Clone + Ord, Margin>(
    index: usize,
    region: &Region<Label>,
    curves: &[Curve<Label, Margin>],
    findings: &mut Vec<Finding<Label>>,
) {
    let Some(common) = &region.label else { return };
    let (agreeing, others): (Vec<_>, Vec<_>) =
        region.boundary.iter().partition(|&&side| label(curves, side) == common);
    for &&other in &others {
        let ends = |curve: usize| curves[curve].ends.into_iter().flatten();
        let neighbour = agreeing.iter().find_map(|&&(curve, _)| {
            let vertex = ends(other.0).find(|&vertex| ends(curve).any(|end| end == vertex))?;
            Some((curve, Some(vertex)))
        });
        // The label comes from a curve, so at least one curve agrees.
        let Some((curve, vertex)) = neighbour.or(agreeing.first().map(|side| (side.0, None)))
        else {
            continue;
        };
        findings.push(Finding::Labels {
            region: index,
            curves: [curve, other.0],
            labels: [common.clone(), label(curves, other).clone()],
            vertex,
        });
    }
}
