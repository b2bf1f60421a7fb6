//! Pictures of all kinds.

use std::sync::OnceLock;

use stickslip_figure::Svg;
use stickslip_figure::canvas::panel::Scale;
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::canvas::style::FRAME;
use stickslip_figure::pictures::chart::{ChartAxis, LineChart, Mark, Series, Shape};
use stickslip_figure::pictures::gallery::Exhibit;
use stickslip_figure::pictures::map::{MapAxis, MapPanel, MapValues};
use stickslip_figure::pictures::{self, atlas, chart, collision, gallery, grid, map};
use stickslip_model::history::History;
use stickslip_model::{Collider, Collision, Contact, Engine};
use stickslip_plane::atlas::{CollisionAtlas, Frame, trace};
use stickslip_plane::progress::SILENT;
use stickslip_plane::{Coordinates, Grid, GridAxis, Range, sweep};
use stickslip_practice::time_steps;
use stickslip_studies::stiff_springs;

/// A collision with its course.
pub fn followed(kappa: f64, psi: f64, damping: f64) -> (Collision, History) {
    let contact = Contact::new(kappa, psi, damping).unwrap();
    let collider = Collider::default();
    (collider.collide(contact).unwrap(), collider.history(contact).unwrap())
}

/// The picture of a collision.
pub fn collision(kappa: f64, psi: f64, damping: f64) -> Svg {
    let (collision, history) = followed(kappa, psi, damping);
    collision::draw(&collision, &history)
}

/// The picture of many collisions.
pub fn gallery(contacts: &[(f64, f64)]) -> Svg {
    let exhibit = |&(kappa, psi): &(f64, f64)| {
        let (collision, history) = followed(kappa, psi, 0.0);
        let remark = format!("ψ = {psi}, {} switches", collision.switches.len());
        Exhibit { name: "a".to_owned(), remark, collision, history }
    };
    gallery::draw("κ = 63", &contacts.iter().map(exhibit).collect::<Vec<_>>())
}

/// The picture of a computed grid of 40 × 30 cells.
pub fn grid(kappa: (f64, f64), psi: (f64, f64), engine: Engine) -> Svg {
    let axis = |(low, high), cells| GridAxis { range: Range { low, high }, cells };
    let coordinates = Coordinates::Psi { damping: 0.0 };
    let grid = Grid::new(axis(kappa, 40), axis(psi, 30), coordinates);
    let tile = sweep::compute(&grid, engine, 0..grid.points());
    grid::draw(&grid, (40, 30), &tile).unwrap()
}

/// A panel of 4 × 3 cells with `values`.
pub fn panel(values: MapValues<'_>) -> MapPanel<'_> {
    MapPanel {
        heading: "tangential restitution ε_t",
        horizontal: MapAxis { name: "normal velocity g_n in m/s", range: (0.0, 2.0) },
        vertical: MapAxis { name: "tangential velocity g_t in m/s", range: (0.0, 2.0) },
        columns: 4,
        rows: 3,
        values,
        lines: vec![(FRAME, vec![(0.0, 0.0), (2.0, 2.0)])],
        points: Vec::new(),
    }
}

/// Two panels with restitution between −`largest` and `largest`, and points with names.
pub fn restitution(largest: f64) -> Svg {
    let mut values = [0.0; 12];
    (values[3], values[7], values[8]) = (largest, -largest, f64::NAN);
    let names = ["a", "b", "c", "n'"];
    let points = names.into_iter().enumerate().map(|(i, name)| (name, (1.8, 0.02 * i as f64)));
    let panel = MapPanel { points: points.collect(), ..panel(MapValues::Restitution(&values)) };
    map::draw("two panels", &[panel.clone(), panel]).unwrap()
}

/// The atlas of a window.
pub fn traced(kappa: (f64, f64), psi: (f64, f64), damping: f64) -> CollisionAtlas {
    let range = |(low, high)| Range { low, high };
    let frame = Frame::new(range(kappa), range(psi), damping);
    trace(frame, frame.tolerances().usual, SILENT).unwrap()
}

/// Atlases that several tests draw.
#[derive(Debug)]
pub struct Atlases {
    /// All kinds of boundaries and vertices.
    pub large: CollisionAtlas,
    /// Two boundaries that cross.
    pub crossing: CollisionAtlas,
    /// A window with damping.
    pub damped: CollisionAtlas,
    /// A window without a boundary.
    pub empty: CollisionAtlas,
}

/// The atlases, each traced once.
pub fn atlases() -> &'static Atlases {
    static ATLASES: OnceLock<Atlases> = OnceLock::new();
    ATLASES.get_or_init(|| Atlases {
        large: traced((0.2, 10.0), (0.01, 3.0), 0.0),
        crossing: traced((18.0, 21.0), (0.55, 0.65), 0.0),
        damped: traced((10.0, 11.0), (0.9, 1.0), 0.05),
        empty: traced((5.0, 6.0), (2.5, 3.0), 0.0),
    })
}

/// An axis of a chart.
pub fn axis(range: (f64, f64), scale: Scale) -> ChartAxis<'static> {
    ChartAxis { name: "error of w_{final}, root mean square", range, scale }
}

/// A series with a line and marks.
pub fn series(name: &str, points: &[(f64, f64)]) -> Series {
    let mark = Some(Mark { shape: Shape::Ring, colour: "#D55E00" });
    let line = Some(Stroke::full("#0072B2", 1.4));
    Series { name: name.to_owned(), points: points.to_vec(), line, mark }
}

/// A chart of the powers 1 to 4 on logarithmic axes.
pub fn powers(x: (f64, f64), y: (f64, f64)) -> Svg {
    let shapes = [Shape::Disc, Shape::Ring, Shape::Square, Shape::Cross];
    let all = (1..).zip(shapes).map(|(power, shape)| {
        let steps = (0..=20).map(|step| x.0 * (x.1 / x.0).powf(f64::from(step) / 20.0));
        let points: Vec<_> = steps.map(|x| (x, x.powi(power))).collect();
        let mark = Some(Mark { shape, colour: "#009E73" });
        Series { mark, ..series(&format!("κ^{power} over √κ: {power}.000 ± 0.001"), &points) }
    });
    chart::draw(&LineChart {
        title: "Powers of κ",
        x: axis(x, Scale::Logarithmic),
        y: axis(y, Scale::Logarithmic),
        series: all.collect(),
    })
}

/// Pictures of all kinds, with names for messages.
pub fn all() -> &'static [(String, Svg)] {
    static ALL: OnceLock<Vec<(String, Svg)>> = OnceLock::new();
    ALL.get_or_init(drawn)
}

fn drawn() -> Vec<(String, Svg)> {
    let mut drawn = Vec::new();
    for (kappa, psi, damping) in
        [(63.0, 0.5, 0.0), (18.0, 1.0, 0.2), (1e4, 0.5, 0.0), (5.0, 1e6, 0.0), (1e-3, 1e-13, 0.0)]
    {
        let name = format!("collision at {kappa}, {psi}, {damping}");
        drawn.push((name, collision(kappa, psi, damping)));
    }
    let contacts = [2.5, 1.5, 1.2, 0.7, 0.4].map(|psi| (63.0, psi));
    for count in [0, 1, 5] {
        drawn.push((format!("{count} collisions"), gallery(&contacts[..count])));
    }
    for (kappa, psi) in
        [((0.0, 70.0), (0.0, 2.9)), ((0.0, 4e16), (3.0, 4.0)), ((0.0, 5.0), (2.5, 9.0))]
    {
        drawn.push((format!("grid of {kappa:?}"), grid(kappa, psi, Engine::Exact)));
    }
    for largest in [1.0, 0.83, 0.17, 0.0213, 2e-4] {
        drawn.push((format!("restitution up to {largest}"), restitution(largest)));
    }
    let Atlases { large, crossing, damped, empty } = atlases();
    for (name, made) in
        [("large", large), ("crossing", crossing), ("damped", damped), ("empty", empty)]
    {
        drawn.push((format!("{name} atlas"), atlas::draw(made)));
    }
    for (x, y) in [
        ((10.0, 1e8), (1e-10, 1.0)),
        ((5e-5, 0.06), (1e-18, 3.0)),
        ((2e-4, 0.3), (1e-3, 1e4)),
        ((5.0, 100.0), (5.0, 1e6)),
        ((1e-9, 1e9), (1e-30, 1e30)),
    ] {
        drawn.push((format!("powers over {x:?}"), powers(x, y)));
    }
    let linear = LineChart {
        title: "F(phase)",
        x: axis((-1.0, 0.0), Scale::Linear),
        y: axis((0.0, 5e6), Scale::Linear),
        series: vec![series("", &[(-0.5, 1e6)]), series("inner problem", &[(-0.5, 1e6)])],
    };
    drawn.push(("linear chart".to_owned(), chart::draw(&linear)));
    let contacts = vec![Contact::new(4.0, 0.5, 0.1).unwrap()];
    let settings =
        time_steps::TimeStepSettings { contacts, ..time_steps::TimeStepSettings::default() };
    let steps = time_steps::run(&settings, SILENT).unwrap();
    drawn.push(("time steps".to_owned(), pictures::time_steps::draw(&steps)));
    let kappa = Range { low: 10.0, high: 100.0 };
    let settings = stiff_springs::StiffSpringSettings { kappa, psi: vec![0.3, 1.0] };
    let stiff = stiff_springs::run(&settings, SILENT).unwrap();
    let stiff = pictures::studies::stiff_springs::draw(&stiff);
    drawn.extend(stiff.into_iter().map(|picture| (picture.name, picture.svg)));
    drawn
}
