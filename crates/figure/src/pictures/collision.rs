//! The picture of one collision: forces above, velocity below, against time.

use stickslip_model::history::History;
use stickslip_model::spheres::{Encounter, ImpactReport};
use stickslip_model::text::number;
use stickslip_model::{Collision, Contact, Normal};

use super::course::{self, Course, Units};
use crate::canvas::panel::Edge;
use crate::canvas::shape::Rectangle;
use crate::canvas::style::TITLE;
use crate::canvas::svg::{Anchor, Svg, Words};

/// About the number of pixels from the start of contact to its end.
pub const PANEL_WIDTH: f64 = 664.0;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 560.0;
const FORCES: Rectangle = Rectangle { left: 80.0, top: 70.0, width: PANEL_WIDTH, height: 270.0 };
const VELOCITY: Rectangle = Rectangle { top: 352.0, height: 156.0, ..FORCES };
/// The number of moments of an animation.
const FRAMES: u32 = 75;
const TITLE_AT: (f64, f64) = (80.0, 22.0);
const LEGEND_AT: (f64, f64) = (80.0, 50.0);

/// The name of the axis of forces, where the elastic force is that of Hertz.
pub const FORCE: &str = "force in units of m β^{2/5} g_n^{6/5}";
/// The name of the axis of time.
pub const TIME: &str = "time t in units of β^{−2/5} g_n^{−1/5}";
/// The names of the axes of an impact.
const SI_NAMES: [&str; 3] = ["force [N]", "time [s]", "velocity of the surfaces [m/s]"];

/// Draws `collision`, whose course is `history`.
pub fn draw(collision: &Collision, history: &History) -> Svg {
    let (course, names) = scaled(collision, history);
    panels(&title(collision), &course, names)
}

/// The picture of [`draw`] at successive moments, up to which it is drawn, for an animation: the
/// moments are evenly spaced, and the last one is the end of contact.
pub fn frames(collision: &Collision, history: &History) -> impl Iterator<Item = Svg> {
    let (course, names) = scaled(collision, history);
    successive(title(collision), course, names, history)
}

/// Draws an impact that is not central, whose course is `history`, in SI units.
pub fn draw_impact(report: &ImpactReport, history: &History) -> Svg {
    panels(&title(&report.collision), &in_si(report, history), SI_NAMES)
}

/// The picture of [`draw_impact`] at successive moments, as [`frames`].
pub fn frames_of_impact(report: &ImpactReport, history: &History) -> impl Iterator<Item = Svg> {
    successive(title(&report.collision), in_si(report, history), SI_NAMES, history)
}

/// The course of a collision in its own units, and the names of its axes.
fn scaled<'a>(collision: &Collision, history: &'a History) -> (Course<'a>, [&'static str; 3]) {
    let [force, time] = axes(&collision.contact);
    (Course::new(collision, history, FORCES.width), [force, time, "velocity w = (α/μ) g_t/g_n"])
}

/// The course of an impact in SI units.
fn in_si<'a>(report: &ImpactReport, history: &'a History) -> Course<'a> {
    let Encounter { impact, .. } = &report.encounter;
    let units = Units {
        time: impact.time_unit_s,
        force: impact.force_unit_n(),
        velocity: impact.velocity_m_per_s(1.0),
    };
    Course::new(&report.collision, history, FORCES.width).in_units(units)
}

/// The panels of a course up to successive moments.
fn successive(
    title: String,
    course: Course<'_>,
    names: [&'static str; 3],
    history: &History,
) -> impl Iterator<Item = Svg> {
    (1..=FRAMES).filter_map(move |frame| {
        let moment = history.at(history.duration() * (f64::from(frame) / f64::from(FRAMES)))?;
        Some(panels(&title, &course.clone().until(moment), names))
    })
}

/// Draws the panels of a course, with the names of the axes of force, time and velocity.
fn panels(title: &str, course: &Course<'_>, [force, time, speed]: [&str; 3]) -> Svg {
    let mut svg = Svg::new(WIDTH, HEIGHT, title);
    svg.words(TITLE_AT, Words::new(title, TITLE, Anchor::Start));
    course::legend(&mut svg, LEGEND_AT, std::slice::from_ref(course));

    let forces = course.forces(&mut svg, FORCES, course.largest_force());
    forces.ticks(&mut svg, Edge::Left, true);
    forces.ticks(&mut svg, Edge::Bottom, false);
    forces.name(&mut svg, Edge::Left, 58.0, force);

    let velocity = course.velocity(&mut svg, VELOCITY);
    velocity.ticks(&mut svg, Edge::Left, true);
    velocity.ticks(&mut svg, Edge::Bottom, true);
    velocity.name(&mut svg, Edge::Left, 58.0, speed);
    velocity.name(&mut svg, Edge::Bottom, 36.0, time);
    svg
}

/// The names of the axes of forces and time.
fn axes(contact: &Contact) -> [&'static str; 2] {
    match contact.law().normal {
        Normal::Hertz | Normal::Dmt | Normal::Jkr => [FORCE, TIME],
        Normal::Linear => ["force in units of m β^{1/2} g_n", "time t in units of β^{−1/2}"],
    }
}

/// The parameters and results of a collision in a line.
fn title(collision: &Collision) -> String {
    let contact = &collision.contact;
    let [kappa, psi, damping] =
        [contact.kappa(), contact.psi(), contact.damping()].map(|parameter| number(parameter, 6));
    let eps_t = number(collision.eps_t(), 4);
    let count = collision.switches.len();
    let plural = if count == 1 { "" } else { "es" };
    let b = match contact.tangential_damping() {
        0.0 => String::new(),
        b => format!(", b = {}", number(b, 6)),
    };
    format!("κ = {kappa}, ψ = {psi}, a = {damping}{b}:  ε_t = {eps_t}, {count} switch{plural}")
}
