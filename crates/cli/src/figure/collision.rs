//! The picture of one collision: forces above, velocity below, against time.

use std::f64::consts::TAU;

use stickslip_model::{Collision, History, PhaseHistory, Regime, Side, Snapshot};

use super::panel::{Edge, LINEAR, Panel};
use super::style::{
    FRAME, NORMAL, NORMAL_MIRRORED, RULE, SLIP_NEGATIVE, SLIP_POSITIVE, STICK, TANGENTIAL, TEXT,
    TITLE,
};
use super::svg::{Anchor, Rectangle, Svg, Words};
use super::text::number;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 560.0;
const FORCES: Rectangle = Rectangle { left: 80.0, top: 70.0, width: 664.0, height: 270.0 };
const VELOCITY: Rectangle = Rectangle { top: 352.0, height: 156.0, ..FORCES };
/// Where the title and the legend are.
const TITLE_AT: (f64, f64) = (80.0, 22.0);
const LEGEND_Y: f64 = 50.0;
/// Length of the mark of a switch.
const MARK: f64 = 9.0;

/// Most moments of a phase that are drawn.
const MOST_SAMPLES: f64 = 20_000.0;

/// Draws `collision`, whose course is `history`.
pub fn draw(collision: &Collision, history: &History) -> Svg {
    let title = title(collision);
    let mut svg = Svg::new(WIDTH, HEIGHT, &title);
    svg.words(TITLE_AT, Words::new(&title, TITLE, Anchor::Start));
    legend(&mut svg);

    let samples: Vec<Snapshot> =
        history.phases().flat_map(|phase| samples(collision, history, phase)).collect();
    let duration = history.duration();
    let time = (-0.012 * duration, 1.012 * duration);
    let force = samples.iter().fold(0.0_f64, |most, sample| most.max(sample.normal_force));
    let velocity = samples.iter().fold((0.0_f64, 0.0_f64), |(low, high), sample| {
        (low.min(sample.velocity), high.max(sample.velocity))
    });
    let forces = Panel { frame: FORCES, x: time, y: padded((-force, force)), scales: LINEAR };
    let velocities = Panel { frame: VELOCITY, x: time, y: padded(velocity), scales: LINEAR };
    for panel in [&forces, &velocities] {
        background(&mut svg, panel, history);
    }

    let curve =
        |of: fn(&Snapshot) -> f64| samples.iter().map(move |sample| (sample.time, of(sample)));
    forces.curve(&mut svg, curve(|sample| sample.normal_force), NORMAL);
    forces.curve(&mut svg, curve(|sample| -sample.normal_force), NORMAL_MIRRORED);
    forces.curve(&mut svg, curve(|sample| sample.tangential_force), TANGENTIAL);
    forces.border(&mut svg);
    forces.ticks(&mut svg, Edge::Left, true);
    forces.ticks(&mut svg, Edge::Bottom, false);
    forces.name(&mut svg, Edge::Left, 58.0, "force in units of m β^{2/5} g_n^{6/5}");

    velocities.curve(&mut svg, curve(|sample| sample.velocity), TANGENTIAL);
    velocities.border(&mut svg);
    velocities.ticks(&mut svg, Edge::Left, true);
    velocities.ticks(&mut svg, Edge::Bottom, true);
    velocities.name(&mut svg, Edge::Left, 58.0, "velocity w = (α/μ) g_t/g_n");
    velocities.name(&mut svg, Edge::Bottom, 36.0, "time t in units of β^{−2/5} g_n^{−1/5}");
    svg
}

fn title(collision: &Collision) -> String {
    let contact = &collision.contact;
    let [kappa, psi, damping] =
        [contact.kappa(), contact.psi(), contact.damping()].map(|parameter| number(parameter, 6));
    let eps_t = number(collision.eps_t(), 4);
    let count = collision.switches.len();
    let plural = if count == 1 { "" } else { "es" };
    format!("κ = {kappa}, ψ = {psi}, a = {damping}:  ε_t = {eps_t}, {count} switch{plural}")
}

/// Enough moments of a phase for a smooth line, its ends among them: one a pixel, and 25 to each swing of the spring.
fn samples(collision: &Collision, history: &History, phase: PhaseHistory<'_>) -> Vec<Snapshot> {
    let duration = phase.end().time - phase.begin().time;
    let pixels = duration / history.duration() * FORCES.width;
    let swings = match phase.regime() {
        Regime::Stick => duration * collision.contact.kappa().sqrt() / TAU,
        Regime::Slip => 0.0,
    };
    // The cast saturates; a phase of no duration gives 0.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let intervals = pixels.max(25.0 * swings).min(MOST_SAMPLES) as usize;
    phase.samples(12 + intervals).collect()
}

/// Phases, switches and the line of zero.
fn background(svg: &mut Svg, panel: &Panel, history: &History) {
    svg.begin_group("phases");
    for phase in history.phases() {
        let colour = match (phase.regime(), phase.side()) {
            (Regime::Stick, _) => continue,
            (Regime::Slip, Side::Positive) => SLIP_POSITIVE,
            (Regime::Slip, Side::Negative) => SLIP_NEGATIVE,
        };
        panel.span(svg, (phase.begin().time, phase.end().time), colour);
    }
    svg.end_group();
    panel.horizontal(svg, 0.0, RULE);
    svg.begin_group("switches");
    for phase in history.phases().skip(1) {
        let (x, _) = panel.place((phase.begin().time, 0.0));
        svg.line((x, panel.frame.top), (x, panel.frame.top + MARK), FRAME);
    }
    svg.end_group();
}

fn padded((low, high): (f64, f64)) -> (f64, f64) {
    let pad = 0.06 * (high - low);
    (low - pad, high + pad)
}

fn legend(svg: &mut Svg) {
    let mut left = FORCES.left;
    let mut entry = |svg: &mut Svg, text: &str, width: f64, key: &dyn Fn(&mut Svg, Rectangle)| {
        key(svg, Rectangle { left, top: LEGEND_Y - 6.0, width: 24.0, height: 12.0 });
        svg.words((left + 30.0, LEGEND_Y), Words::new(text, TEXT, Anchor::Start));
        left += width;
    };
    for (text, colour) in [("slip +", SLIP_POSITIVE), ("stick", STICK), ("slip −", SLIP_NEGATIVE)]
    {
        entry(svg, text, 90.0, &|svg, at| {
            svg.fill(at, colour);
            svg.outline(at, RULE);
        });
    }
    entry(svg, "switch", 92.0, &|svg, at| {
        let x = at.left + 0.5 * at.width;
        svg.line((x, at.top), (x, at.top + MARK), FRAME);
    });
    for (text, width, stroke) in
        [("±F_n, limits of F_t/μ", 188.0, NORMAL), ("F_t/μ, w", 0.0, TANGENTIAL)]
    {
        entry(svg, text, width, &|svg, at| {
            let y = at.top + 0.5 * at.height;
            svg.line((at.left, y), (at.right(), y), stroke);
        });
    }
}
