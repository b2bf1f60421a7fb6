//! Boundaries and regions of a plane, as accurate as a screen shows them.

use serde_json::{Value, json};
use stickslip_plane::Range;
use stickslip_plane::atlas::BoundaryKind;
use stickslip_solver::margin::Margin;
use stickslip_tracer::{
    Atlas, AtlasOptions, Effort, Names, Point, RunNames, Serial, Surveyor, TraceOptions, Watch,
    Window,
    regions::{CurveSide, OutlinePart, VerifyOptions},
    tracing::SpecialPoint,
};

use crate::axis::Axis;
use crate::spheres::{Spheres, collide};
use crate::system::SystemPlane;
use crate::{itinerary, page};

/// The options for a window with this shorter side. Where a run takes microseconds, the effort is
/// the usual one, but the verification a spot check that takes no longer than the trace; else it is
/// that of a screen.
fn options(shorter: f64, effort: Effort) -> AtlasOptions {
    /// The part of the shorter side by which a curve may be off. A picture needs 1e-4, but regions
    /// narrower than a curve's error would not be found, and a trace of that accuracy takes as
    /// long.
    const ACCURACY: f64 = 1e-8;
    let interpolation = (ACCURACY * shorter).clamp(1e-11, 1e-2);
    let trace = TraceOptions { interpolation, max_curves: 1500, ..TraceOptions::default() };
    let tolerance = 10.0 * interpolation;
    let (nearest, farthest) = (10.0 * tolerance, 1e4 * tolerance);
    let usual = VerifyOptions { nearest, farthest, ..VerifyOptions::default() };
    let verify = match effort {
        Effort::Default => VerifyOptions { random_points: 2000, near_points: 4, ..usual },
        _ => usual,
    };
    effort.applied(AtlasOptions { trace, tolerance, verify, rounds: 4, ..AtlasOptions::default() })
}

/// The least part of an axis' upper end that is traced, where the axis begins at 0.
const LEAST: f64 = 1e-3;

fn range(axis: &Axis) -> Range {
    Range { low: axis.low.max(LEAST * axis.high), high: axis.high }
}

/// The boundaries and regions of collisions.
pub fn of_spheres(spheres: &Spheres, [x, y]: [&Axis; 2]) -> Result<Value, String> {
    let sides = [range(x), range(y)];
    let (plane, units) = spheres.plane(sides).map_err(|error| error.to_string())?;
    plane.sheet().require_wide(plane.names()).map_err(|error| error.to_string())?;
    plane.require_smooth().map_err(|error| error.to_string())?;
    let window = plane.window();
    let any = plane.contact(&window.low).map_err(|error| error.to_string())?;
    let effort = if any.obeys_paper() { Effort::Default } else { Effort::Screen };
    let place = |point: &Point| {
        let [x, y] = plane.parameters(point);
        [x / units[0], y / units[1]]
    };
    let show = |points: &[Point]| page::show(&points.iter().map(place).collect::<Vec<_>>());
    let (options, watch) = (options(window.extent().min(), effort), Watch::SILENT.showing(&show));
    let surveyor = Surveyor { options, executor: Serial, watch };
    let atlas = surveyor.atlas(&plane.family(), &window).map_err(|error| error.to_string())?;
    let name = |region: usize| {
        let sample = &atlas.plane.regions()[region].sample;
        let found = plane.contact(sample).ok().and_then(|contact| Some(collide(contact).ok()?.0));
        match found {
            Some(found) => {
                (found.itinerary(), found.switches.len(), itinerary::of_collision(&found))
            }
            None => ("no collision".to_owned(), 0, 0),
        }
    };
    Ok(document(&atlas, &window, place, |margin| BoundaryKind::of(&any, margin).name(), name))
}

/// The boundaries and regions of a system.
pub fn of_system(plane: &SystemPlane, [x, y]: [&Axis; 2]) -> Result<Value, String> {
    let window = Window { low: Point::new(x.low, y.low), high: Point::new(x.high, y.high) };
    let place = |point: &Point| (*point).into();
    let show = |points: &[Point]| page::show(&points.iter().map(place).collect::<Vec<_>>());
    let options = options(window.extent().min(), Effort::Screen);
    let surveyor = Surveyor { options, executor: Serial, watch: Watch::SILENT.showing(&show) };
    let family = plane.family();
    let atlas = surveyor.atlas(family, &window).map_err(|error| error.to_string())?;
    let name = |region: usize| {
        let Some(label) = &atlas.plane.regions()[region].label else {
            let sample = plane.point(atlas.plane.regions()[region].sample.into());
            return ("no boundary".to_owned(), usize::from(sample.count), sample.code);
        };
        let count = label.fired().map_or(0, <[usize]>::len);
        (itinerary::words(label, family.rules()), count, itinerary::of_label(label))
    };
    let names = RunNames::default();
    Ok(document(&atlas, &window, place, |margin| names.kind(margin), name))
}

fn special_name(special: SpecialPoint) -> &'static str {
    match special {
        SpecialPoint::Crossing => "crossing",
        SpecialPoint::DoubleGraze => "double graze",
        SpecialPoint::Cusp => "cusp",
        SpecialPoint::GrazeAtEnd => "graze at the end",
        SpecialPoint::SimultaneousEvents => "simultaneous events",
        SpecialPoint::Tangency => "tangency",
        SpecialPoint::Other => "other",
    }
}

/// An atlas as an object. `name` has the itinerary, the count and the code of a region.
fn document<Label: Clone + Ord + std::fmt::Debug>(
    atlas: &Atlas<Label, Margin>,
    window: &Window,
    place: impl Fn(&Point) -> [f64; 2],
    kind: impl Fn(&Margin) -> &'static str,
    name: impl Fn(usize) -> (String, usize, u32),
) -> Value {
    let plane = &atlas.plane;
    let extent = window.extent();
    let curves = plane.curves().iter().enumerate().map(|(index, curve)| {
        let points: Vec<[f64; 2]> = curve.polyline(&extent).iter().map(&place).collect();
        json!({ "kind": kind(&curve.margin), "points": points, "sides": plane.regions_beside(index) })
    });
    let vertices = plane.special_points().into_iter().map(|(vertex, special)| {
        let point = place(&plane.vertices()[vertex].point);
        json!({ "name": special_name(special), "point": point })
    });
    let stretch = |stretch: &OutlinePart| match stretch {
        OutlinePart::Curve(curve, side) => {
            json!({ "curve": curve, "back": *side == CurveSide::Right })
        }
        OutlinePart::Window(ends) => json!({ "line": ends.each_ref().map(&place) }),
    };
    let regions = plane.regions().iter().enumerate().map(|(index, region)| {
        let (itinerary, count, code) = name(index);
        let rings: Vec<Vec<Value>> =
            plane.outlines(index).iter().map(|ring| ring.iter().map(stretch).collect()).collect();
        json!({
            "itinerary": itinerary,
            "count": count,
            "code": code,
            "sample": place(&region.sample),
            "share": region.area / extent.product(),
            "doubtful": atlas.is_doubtful(index),
            "rings": rings,
        })
    });
    json!({
        "boundaries": curves.collect::<Vec<_>>(),
        "vertices": vertices.collect::<Vec<_>>(),
        "regions": regions.collect::<Vec<_>>(),
        "agrees": atlas.agrees(),
        "objection": atlas.objection(),
        "low": place(&window.low),
        "high": place(&window.high),
    })
}
