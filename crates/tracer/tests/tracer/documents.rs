//! Documents of atlases: written, read back, and resumed.

use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip_solver::margin::Margin;
use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
use stickslip_tracer::{
    AtlasOf, Point, Surveyor, Watch, Window,
    document::{DocumentError, FamilyAtlasDocument, SCHEMA},
    hybrid::{HybridFamily, Itinerary},
};

use crate::any::any;
use crate::guards;
use crate::surveys::{Shapes, WINDOW, assert_same, options};

type OfShapes = FamilyAtlasDocument<guards::Label, guards::Margin>;

const AXES: [&str; 2] = ["x", "y"];

fn surveyor() -> Surveyor<'static> {
    Surveyor { options: options(), ..Surveyor::default() }
}

fn document(atlas: &AtlasOf<Shapes>) -> OfShapes {
    FamilyAtlasDocument::new(atlas, &options(), "shapes", AXES)
}

/// The document, written and read.
fn passed_on(document: &OfShapes) -> OfShapes {
    serde_json::from_str(&serde_json::to_string(document).unwrap()).unwrap()
}

#[test]
fn an_atlas_reads_back_with_all_bits() {
    // In one of the two, runs fail, and a region is in doubt.
    for hole in [0.0, 0.05] {
        let atlas = surveyor().atlas(&any(Shapes { hole }), &WINDOW).unwrap();
        let written = document(&atlas);
        let read = passed_on(&written);
        assert_eq!((&read, read.is_finished()), (&written, true));
        let read = read.atlas().unwrap();
        assert_same(&read, &atlas);
        assert_eq!(read.agrees(), hole == 0.0);
        assert_eq!(read.objection().is_none(), read.agrees());
        assert_eq!(read.objection(), atlas.objection());
        assert_eq!(read.sure_area(), atlas.sure_area());
        for i in 0..1000 {
            let part = Point::new(f64::from(i % 40) / 40.0, f64::from(i / 40) / 25.0);
            let point = WINDOW.low + WINDOW.extent().component_mul(&part);
            assert_eq!(read.label(&point), atlas.label(&point));
        }
    }
}

/// A survey is cancelled again and again, and each time goes on from its file.
#[test]
fn a_survey_goes_on_from_its_file_to_the_same_bits() {
    let family = any(Shapes { hole: 0.0 });
    let whole = surveyor().atlas(&family, &WINDOW).unwrap();
    // Each time it comes a little further: a verification or a second look begins again.
    let (asked, most) = (AtomicUsize::new(0), AtomicUsize::new(3));
    let cancel = || asked.fetch_add(1, Ordering::Relaxed) >= most.load(Ordering::Relaxed);
    let cancelled = Surveyor { watch: Watch::SILENT.cancelled_by(&cancel), ..surveyor() };
    let mut atlas = cancelled.atlas(&family, &WINDOW).unwrap();
    let mut pauses = 0;
    while !atlas.is_finished() {
        let file = passed_on(&document(&atlas));
        assert!(!file.is_finished() && atlas.objection().unwrap().starts_with("not finished"));
        asked.store(0, Ordering::Relaxed);
        most.fetch_add(1, Ordering::Relaxed);
        atlas = cancelled.resume(&family, file.atlas().unwrap()).unwrap();
        pauses += 1;
    }
    assert!(pauses > 10, "{pauses} pauses");
    assert_same(&atlas, &whole);
}

#[test]
fn documents_that_contradict_themselves_are_refused() {
    let family = any(Shapes { hole: 0.0 });
    let good = document(&surveyor().atlas(&family, &WINDOW).unwrap());
    assert!(good.clone().atlas().is_ok());
    let refused = |change: fn(&mut OfShapes)| {
        let mut document = good.clone();
        change(&mut document);
        document.atlas().unwrap_err()
    };
    let error = refused(|document| document.schema = "stickslip.atlas/1".to_owned());
    assert_eq!(error, DocumentError::Schema { found: "stickslip.atlas/1".to_owned() });
    assert!(error.to_string().contains(SCHEMA));
    let error = refused(|document| document.regions[1].area += 1e-9);
    assert_eq!(error, DocumentError::Regions);
    let error = refused(|document| document.options.trace.cells = 1);
    assert!(matches!(error, DocumentError::Option(_)));
    let error = refused(|document| document.curves[0].ends = Some([100, 0]));
    assert!(matches!(error, DocumentError::Subdivision(_)));
    let error = refused(|document| document.rounds = 0);
    assert!(matches!(error, DocumentError::Index { list: "rounds", .. }));
}

/// A ball of restitution y that is dropped from the height x, with its margins and itineraries.
struct Ball(f64);

impl HybridSystem<2, 1> for Ball {
    type Mode = ();

    fn field(&self, (): (), _: f64, y: &State<2>) -> State<2> {
        State::from([y[1], -1.0])
    }
    fn guards(&self, (): ()) -> [Guard; 1] {
        [Guard::new(Direction::Below)]
    }
    fn guard_values(&self, (): (), _: f64, y: &State<2>) -> [f64; 1] {
        [y[0]]
    }
    fn transition(&self, (): (), _: usize, _: f64, y: &State<2>) -> ((), State<2>) {
        ((), State::from([0.0, -self.0 * y[1]]))
    }
}

#[test]
fn hybrid_systems_have_documents() {
    let problem = |point: &Point| {
        (Ball(point.y), Start { mode: (), s: 0.0, state: State::from([point.x, 0.0]) })
    };
    let run = Options::with_tolerance(1e-14);
    let family = any(HybridFamily { problem, method: Dop853, options: run, end: 2.4 });
    let window = Window { low: Point::new(0.5, 0.5), high: Point::new(2.0, 0.8) };
    let surveyor = surveyor();
    let atlas = surveyor.atlas(&family, &window).unwrap();
    let axes = ["height in m", "restitution"];
    let mut written = FamilyAtlasDocument::new(&atlas, &surveyor.options, "ball", axes);
    assert!(!serde_json::to_string(&written).unwrap().contains("guards"));
    written.guards.push("floor".to_owned());
    let text = serde_json::to_string(&written).unwrap();
    let document: FamilyAtlasDocument<Itinerary, Margin> = serde_json::from_str(&text).unwrap();
    assert_eq!(document, written);
    let read = document.atlas().unwrap();
    assert!(read.agrees());
    let bounces = |point: &Point| read.label(point).and_then(Itinerary::fired).map(<[usize]>::len);
    // The second bounce is at √(2x)(1 + 2y).
    assert_eq!(bounces(&Point::new(0.6, 0.55)), Some(2));
    assert_eq!(bounces(&Point::new(1.9, 0.75)), Some(1));
    assert_eq!(read.plane.curves(), atlas.plane.curves());
}
