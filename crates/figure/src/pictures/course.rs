//! The course of a collision in a panel: forces or velocity against time, over its phases.

use std::f64::consts::TAU;

use stickslip_model::{Collision, History, PhaseHistory, Regime, Side, Snapshot};

use crate::canvas::panel::{LINEAR, Panel};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{
    FRAME, NORMAL, NORMAL_MIRRORED, RULE, SLIP_NEGATIVE, SLIP_POSITIVE, STICK, TANGENTIAL, TEXT,
};
use crate::canvas::svg::{Anchor, Svg, Words};

/// Length of the mark of a switch.
const MARK: f64 = 9.0;
/// Most moments of a phase that are drawn.
const MOST_SAMPLES: f64 = 20_000.0;

/// A collision at the moments that are drawn.
#[derive(Clone, Debug)]
pub struct Course<'a> {
    history: &'a History,
    samples: Vec<Snapshot>,
}

impl<'a> Course<'a> {
    /// The course `history` of `collision`, for a panel of so many pixels.
    pub fn new(collision: &Collision, history: &'a History, width: f64) -> Self {
        let phases = history.phases();
        let samples = phases.flat_map(|phase| samples(collision, history, phase, width)).collect();
        Self { history, samples }
    }

    /// Its moments; at a switch there are two.
    pub fn samples(&self) -> &[Snapshot] {
        &self.samples
    }

    /// The largest normal force.
    pub fn largest_force(&self) -> f64 {
        self.samples.iter().fold(0.0_f64, |most, sample| most.max(sample.normal_force))
    }

    /// Draws the forces into `frame`, with `largest` near its upper and lower edges.
    pub fn forces(&self, svg: &mut Svg, frame: Rectangle, largest: f64) -> Panel {
        let panel = self.panel(svg, frame, (-largest, largest));
        panel.curve(svg, self.curve(|sample| sample.normal_force), NORMAL);
        panel.curve(svg, self.curve(|sample| -sample.normal_force), NORMAL_MIRRORED);
        panel.curve(svg, self.curve(|sample| sample.tangential_force), TANGENTIAL);
        panel.border(svg);
        panel
    }

    /// Draws the velocity into `frame`.
    pub fn velocity(&self, svg: &mut Svg, frame: Rectangle) -> Panel {
        let range = self.samples.iter().fold((0.0_f64, 0.0_f64), |(low, high), sample| {
            (low.min(sample.velocity), high.max(sample.velocity))
        });
        let panel = self.panel(svg, frame, range);
        panel.curve(svg, self.curve(|sample| sample.velocity), TANGENTIAL);
        panel.border(svg);
        panel
    }

    fn curve(&self, of: fn(&Snapshot) -> f64) -> impl Iterator<Item = (f64, f64)> {
        self.samples.iter().map(move |sample| (sample.time, of(sample)))
    }

    /// Phases, switches and the line of zero.
    fn panel(&self, svg: &mut Svg, frame: Rectangle, range: (f64, f64)) -> Panel {
        let duration = self.history.duration();
        let time = (-0.012 * duration, 1.012 * duration);
        let panel = Panel { frame, x: time, y: padded(range), scales: LINEAR };
        svg.begin_group("phases");
        for phase in self.history.phases() {
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
        for phase in self.history.phases().skip(1) {
            let (x, _) = panel.place((phase.begin().time, 0.0));
            svg.line((x, panel.frame.top), (x, panel.frame.top + MARK), FRAME);
        }
        svg.end_group();
        panel
    }
}

/// Enough moments of a phase for a smooth line, its ends among them: one a pixel, and 25 to each
/// swing of the spring.
fn samples(
    collision: &Collision,
    history: &History,
    phase: PhaseHistory<'_>,
    width: f64,
) -> Vec<Snapshot> {
    let duration = phase.end().time - phase.begin().time;
    let pixels = duration / history.duration() * width;
    let swings = match phase.regime() {
        Regime::Stick => duration * collision.contact.kappa().sqrt() / TAU,
        Regime::Slip => 0.0,
    };
    // The cast saturates; a phase of no duration gives 0.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let intervals = pixels.max(25.0 * swings).min(MOST_SAMPLES) as usize;
    phase.samples(12 + intervals).collect()
}

fn padded((low, high): (f64, f64)) -> (f64, f64) {
    let pad = 0.06 * (high - low);
    (low - pad, high + pad)
}

/// What colours and lines mean, beside each other from a place on; `tangential` is what the
/// tangential lines are.
pub fn legend(svg: &mut Svg, (mut left, y): (f64, f64), tangential: &str) {
    let mut entry = |svg: &mut Svg, text: &str, width: f64, key: &dyn Fn(&mut Svg, Rectangle)| {
        key(svg, Rectangle { left, top: y - 6.0, width: 24.0, height: 12.0 });
        svg.words((left + 30.0, y), Words::new(text, TEXT, Anchor::Start));
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
        [("±F_n, limits of F_t/μ", 188.0, NORMAL), (tangential, 0.0, TANGENTIAL)]
    {
        entry(svg, text, width, &|svg, at| {
            let y = at.top + 0.5 * at.height;
            svg.line((at.left, y), (at.right(), y), stroke);
        });
    }
}
