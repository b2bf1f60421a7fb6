//! A boundary that begins on that of a graze, with a square root of any steepness.

use stickslip_tracer::{Family, FreeRun, Point, Surveyor, trace};

use crate::any::any;
use crate::guards::{Failed, Label, Margin, SQUARE, exact};

/// A guard grazes at r = 0 and fires behind, and then a second one fires where its margin
/// u + α √−r is positive.
struct Root {
    steepness: f64,
}

/// Where the second boundary begins on the first.
pub const PLACE: Point = Point::new(0.03, -0.02);
pub const GRAZE: usize = 0;
pub const SECOND: usize = 1;

impl Root {
    /// The coordinates along and across the boundary of the graze, which is bent and slants.
    fn coordinates(point: &Point) -> (f64, f64) {
        let from = point - PLACE;
        let (u, v) = (0.95 * from.x + 0.3 * from.y, 0.95 * from.y - 0.3 * from.x);
        (u, v + 0.3 * u * u)
    }
}

impl Grazes for Root {
    fn value(&self, point: &Point, margin: usize) -> Option<f64> {
        let (u, r) = Self::coordinates(point);
        match margin {
            GRAZE => Some(r),
            _ => (r < 0.0).then(|| u + self.steepness * (-r).sqrt()),
        }
    }
}

/// A guard that grazes, and a second event that the runs behind the graze may have.
pub trait Grazes {
    /// The margin of the graze or of the second event; `None` where a run cannot have it.
    fn value(&self, point: &Point, margin: usize) -> Option<f64>;
}

/// The family of these events. No run shows a margin that it cannot have: those before the graze
/// do not know the second margin, and those behind do not list the graze.
pub struct Grazing<G>(pub G);

impl<G: Grazes> Family for &Grazing<G> {
    /// Whether the two guards fire.
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        let second = self.0.value(point, SECOND);
        Ok(vec![second.is_some(), second.is_some_and(|value| value > 0.0)])
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        Ok(self.0.value(point, *margin))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let label = self.label(point)?;
        let shown = if label[0] { SECOND } else { GRAZE };
        let value = self.0.value(point, shown);
        let margins = value.map(|value| ((shown, Vec::new()), value)).into_iter().collect();
        Ok(FreeRun { label, margins })
    }
}

/// Traces the boundaries, of which there are three that meet at one place, and returns how far from
/// there they do.
fn distance_of_place(family: &Grazing<Root>) -> f64 {
    let network = trace(&any(family), &SQUARE, &exact()).unwrap();
    assert_eq!(network.unresolved, []);
    assert_eq!(network.curves.len(), 3);
    let inside: Vec<_> =
        network.vertices.iter().filter(|vertex| !vertex.kind.is_on_window()).collect();
    assert_eq!(inside.len(), 1);
    (inside[0].point - PLACE).norm()
}

/// A branch along the first boundary keeps the labels at its offset of 1e-8 up to 1e-4 α behind the
/// place, and one with the labels of the strip loses them 3e-6 α before it.
#[test]
fn the_place_is_found_whatever_the_steepness() {
    for steepness in [0.03, 1.0, 7.0, 40.0] {
        let family = Grazing(Root { steepness });
        let off = distance_of_place(&family);
        assert!(off < 1e-12, "{steepness}: {off:e}");
        let atlas = Surveyor::default().atlas(&any(&family), &SQUARE).unwrap();
        assert!(atlas.agrees(), "{steepness}: {:?}", atlas.objection());
    }
    // The strip is thinner than 1e-5 up to the edge.
    let off = distance_of_place(&Grazing(Root { steepness: 300.0 }));
    assert!(off < 1e-12, "{off:e}");
}

/// As [`Root`], where labels are numbers of events: a graze at r = 0 and a second event, behind it
/// where u − α √−r is positive and before it where u is. The strip between the two boundaries has
/// the number of both its neighbours but for one. Where the second event fires, runs show another
/// margin that vanishes on the same boundary, and exists on one side of it only.
struct Counted(Root);

/// Exists where the second event fires.
const TWIN: usize = 2;

impl Counted {
    fn second(&self, point: &Point) -> f64 {
        let (u, r) = Root::coordinates(point);
        u - self.0.steepness * (-r).max(0.0).sqrt()
    }
}

impl Family for &Counted {
    /// As many entries as events.
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        let (_, r) = Root::coordinates(point);
        Ok(vec![true; usize::from(r < 0.0) + usize::from(self.second(point) > 0.0)])
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        let second = self.second(point);
        Ok(match *margin {
            GRAZE => Some(Root::coordinates(point).1),
            SECOND => Some(second),
            _ => (second > 0.0).then_some(0.7 * second),
        })
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let (_, r) = Root::coordinates(point);
        let shown = if self.second(point) > 0.0 { TWIN } else { SECOND };
        let margins = [(r > 0.0).then_some(GRAZE), Some(shown)].into_iter().flatten();
        let value = |margin: usize| {
            let margin = (margin, Vec::new());
            self.margin(point, &margin).map(|value| value.map(|value| (margin, value)))
        };
        let margins = margins.map(value).collect::<Result<Option<Vec<_>>, _>>()?;
        Ok(FreeRun { label: self.label(point)?, margins: margins.unwrap_or_default() })
    }
}

/// Branches stalled where the strip is as wide as runs can tell, or ended where the two margins of
/// one boundary seemed to touch.
#[test]
fn a_strip_between_regions_of_one_label_ends_where_the_boundaries_meet() {
    for steepness in [0.03, 1.0, 7.0, 40.0, 100.0] {
        let family = Counted(Root { steepness });
        let atlas = Surveyor::default().atlas(&any(&family), &SQUARE).unwrap();
        assert!(atlas.agrees(), "{steepness}: {:?}", atlas.objection());
        assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (4, 4));
        let vertices = atlas.plane.vertices().iter();
        let off = vertices.map(|vertex| (vertex.point - PLACE).norm()).fold(f64::NAN, f64::min);
        assert!(off < 1e-11, "{steepness}: {off:e}");
    }
}

/// As [`Counted`], with labels that tell the two events apart. All runs show the second margin,
/// also those on both sides of the boundary of the graze.
struct Shown(Counted);

impl Shown {
    fn value(&self, point: &Point, margin: usize) -> f64 {
        match margin {
            GRAZE => Root::coordinates(point).1,
            _ => 0.1 * self.0.second(point),
        }
    }
}

impl Family for &Shown {
    /// Whether the two events happen.
    type Label = Label;
    type Margin = Margin;
    type Error = Failed;

    fn label(&self, point: &Point) -> Result<Label, Failed> {
        Ok(vec![self.value(point, GRAZE) < 0.0, self.value(point, SECOND) > 0.0])
    }

    fn margin(&self, point: &Point, (margin, _): &Margin) -> Result<Option<f64>, Failed> {
        Ok(Some(self.value(point, *margin)))
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<Label, Margin>, Failed> {
        let label = self.label(point)?;
        let shown = if label[0] { vec![SECOND] } else { vec![GRAZE, SECOND] };
        let margins = shown.into_iter().map(|margin| {
            let value = self.value(point, margin);
            ((margin, Vec::new()), value)
        });
        Ok(FreeRun { label, margins: margins.collect() })
    }
}

/// A branch along the graze runs past the place, and the margin that tells where it lies has one
/// name on both of its sides.
#[test]
fn a_margin_that_is_known_on_both_sides_begins_on_a_graze() {
    for steepness in [0.03, 0.3, 1.0, 3.0, 10.0, 40.0] {
        let family = Shown(Counted(Root { steepness }));
        let atlas = Surveyor::default().atlas(&any(&family), &SQUARE).unwrap();
        assert!(atlas.agrees(), "{steepness}: {:?}", atlas.objection());
        assert_eq!((atlas.plane.curves().len(), atlas.plane.regions().len()), (4, 4));
        let vertices = atlas.plane.vertices().iter();
        let off = vertices.map(|vertex| (vertex.point - PLACE).norm()).fold(f64::NAN, f64::min);
        assert!(off < 1e-11, "{steepness}: {off:e}");
    }
}

/// As [`Root`], where the boundary of the graze is a circle that is smaller than a cell of the
/// grid. The second boundary begins and ends on it. The strip between the two is 6e-8 wide at most.
struct Ring;

const CENTRE: Point = Point::new(0.04, 0.05);
const RADIUS: f64 = 0.01;

impl Grazes for Ring {
    fn value(&self, point: &Point, margin: usize) -> Option<f64> {
        let from = point - CENTRE;
        let r = 0.5 * (from.norm_squared() / RADIUS - RADIUS);
        match margin {
            GRAZE => Some(r),
            _ => (r < 0.0).then(|| from.x + 40.0 * (-r).sqrt()),
        }
    }
}

/// A branch that starts where the strip is thinner than runs can tell lies behind both its ends.
/// What is not found is in doubt.
#[test]
fn a_strip_that_is_not_found_is_in_doubt() {
    let network = trace(&any(&Grazing(Ring)), &SQUARE, &exact()).unwrap();
    assert!(network.curves.len() == 3 || !network.unresolved.is_empty(), "{network:?}");
}
