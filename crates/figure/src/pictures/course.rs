//! The course of a collision in a panel: forces or velocity against time, over its phases.

use std::f64::consts::TAU;

use stickslip_model::history::{History, PhaseHistory, Snapshot};
use stickslip_model::{Collision, Regime, Side};

use crate::canvas::Legend;
use crate::canvas::panel::{LINEAR, Panel};
use crate::canvas::shape::Rectangle;
use crate::canvas::style::{
    FRAME, NORMAL, NORMAL_MIRRORED, RULE, SLIP_NEGATIVE, SLIP_POSITIVE, STICK, TANGENTIAL,
};
use crate::canvas::svg::Svg;

/// Length of the mark of a switch.
const MARK: f64 = 9.0;
/// Width of a key in the legend.
const KEY: f64 = 24.0;
/// The largest number of moments of a phase that are drawn.
const MOST_SAMPLES: f64 = 20_000.0;

/// A collision at the moments that are drawn.
#[derive(Clone, Debug)]
pub struct Course<'a> {
    history: &'a History,
    samples: Vec<Snapshot>,
    units: Units,
    /// Whether the limit of friction is no normal force.
    adhesive: bool,
    /// The moment up to which it is drawn, if that is not the end.
    until: Option<Snapshot>,
}

/// The units in which a course is drawn, in those of its values.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    /// Of time.
    pub time: f64,
    /// Of forces.
    pub force: f64,
    /// Of the tangential velocity.
    pub velocity: f64,
}

impl Units {
    /// The units of the values themselves.
    const SCALED: Self = Self { time: 1.0, force: 1.0, velocity: 1.0 };
}

impl<'a> Course<'a> {
    /// The course `history` of `collision`, for a panel `width` pixels wide.
    pub fn new(collision: &Collision, history: &'a History, width: f64) -> Self {
        let phases = history.phases();
        let samples = phases.flat_map(|phase| samples(collision, history, phase, width)).collect();
        let adhesive = collision.contact.law().normal.is_adhesive();
        Self { history, samples, units: Units::SCALED, adhesive, until: None }
    }

    /// The same course, drawn in other units.
    pub fn in_units(self, units: Units) -> Self {
        Self { units, ..self }
    }

    /// The same course, drawn up to a moment.
    pub fn until(self, moment: Snapshot) -> Self {
        Self { until: Some(moment), ..self }
    }

    /// The time up to which it is drawn.
    fn last(&self) -> f64 {
        self.until.map_or(f64::INFINITY, |moment| moment.time)
    }

    /// The moments that are drawn; at a switch there are two.
    pub fn samples(&self) -> &[Snapshot] {
        &self.samples
    }

    /// The largest normal force.
    pub fn largest_force(&self) -> f64 {
        let force = |sample: &Snapshot| {
            if self.adhesive { sample.normal_force.max(sample.limit) } else { sample.normal_force }
        };
        let most = self.samples.iter().fold(0.0_f64, |most, sample| most.max(force(sample)));
        self.units.force * most
    }

    /// Draws the forces into `frame`. A force of `largest` is near its upper edge, and of
    /// −`largest` near its lower one.
    pub fn forces(&self, svg: &mut Svg, frame: Rectangle, largest: f64) -> Panel {
        let panel = self.panel(svg, frame, (-largest, largest));
        let force = self.units.force;
        panel.curve(svg, self.curve(force, |sample| sample.normal_force), NORMAL);
        if self.adhesive {
            for force in [force, -force] {
                panel.curve(svg, self.curve(force, |sample| sample.limit), NORMAL_MIRRORED);
            }
        } else {
            panel.curve(svg, self.curve(-force, |sample| sample.normal_force), NORMAL_MIRRORED);
        }
        panel.curve(svg, self.curve(force, |sample| sample.tangential_force), TANGENTIAL);
        panel.border(svg);
        panel
    }

    /// Draws the tangential velocity into `frame`.
    pub fn velocity(&self, svg: &mut Svg, frame: Rectangle) -> Panel {
        let range = self.samples.iter().fold((0.0_f64, 0.0_f64), |(low, high), sample| {
            (low.min(sample.velocity), high.max(sample.velocity))
        });
        let unit = self.units.velocity;
        let panel = self.panel(svg, frame, (unit * range.0, unit * range.1));
        panel.curve(svg, self.curve(unit, |sample| sample.velocity), TANGENTIAL);
        panel.border(svg);
        panel
    }

    /// A quantity over the time, in the `unit` in which it is drawn.
    fn curve(&self, unit: f64, of: fn(&Snapshot) -> f64) -> impl Iterator<Item = (f64, f64)> {
        let place = move |sample: &Snapshot| (sample.time * self.units.time, unit * of(sample));
        let last = self.last();
        let drawn = self.samples.iter().filter(move |sample| sample.time <= last);
        drawn.chain(&self.until).map(place)
    }

    /// Draws the phases, the switches and the line of zero.
    fn panel(&self, svg: &mut Svg, frame: Rectangle, range: (f64, f64)) -> Panel {
        let unit = self.units.time;
        let duration = unit * self.history.duration();
        let time = (-0.012 * duration, 1.012 * duration);
        let panel = Panel { frame, x: time, y: padded(range), scales: LINEAR };
        let last = self.last();
        let begun = || self.history.phases().filter(|phase| phase.begin().time <= last);
        svg.begin_group("phases");
        for phase in begun() {
            let colour = match (phase.regime(), phase.side()) {
                (Regime::Stick, _) => continue,
                (Regime::Slip, Side::Positive) => SLIP_POSITIVE,
                (Regime::Slip, Side::Negative) => SLIP_NEGATIVE,
            };
            panel.span(svg, (unit * phase.begin().time, unit * phase.end().time.min(last)), colour);
        }
        svg.end_group();
        panel.horizontal(svg, 0.0, RULE);
        svg.begin_group("switches");
        for phase in begun().skip(1) {
            let (x, _) = panel.place((unit * phase.begin().time, 0.0));
            svg.line((x, panel.frame.top), (x, panel.frame.top + MARK), FRAME);
        }
        svg.end_group();
        panel
    }
}

/// Enough moments of a phase for a smooth line, from its begin to its end: at least one per pixel,
/// and 25 per swing of the spring.
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

/// The range with a margin on both sides.
fn padded((low, high): (f64, f64)) -> (f64, f64) {
    let pad = 0.06 * (high - low);
    (low - pad, high + pad)
}

/// Draws the legend of the forces of `courses` at a place. It names the phases that occur, and
/// switches if there are any. The only line of a velocity is named by its axis.
pub fn legend(svg: &mut Svg, at: (f64, f64), courses: &[Course<'_>]) {
    let mut legend = Legend::new(at);
    let phases = || courses.iter().flat_map(|course| course.history.phases());
    for (text, regime, side, colour) in [
        ("slip +", Regime::Slip, Some(Side::Positive), SLIP_POSITIVE),
        ("stick", Regime::Stick, None, STICK),
        ("slip −", Regime::Slip, Some(Side::Negative), SLIP_NEGATIVE),
    ] {
        let is_shown = |phase: PhaseHistory<'_>| {
            phase.regime() == regime && side.is_none_or(|side| phase.side() == side)
        };
        if phases().any(is_shown) {
            legend.entry(svg, KEY, text, |svg, key| {
                svg.fill(key, colour);
                svg.outline(key, RULE);
            });
        }
    }
    if courses.iter().any(|course| course.history.phases().count() > 1) {
        legend.entry(svg, KEY, "switch", |svg, key| {
            let x = key.left + 0.5 * key.width;
            let y = key.top + 0.5 * key.height;
            svg.line((x, y - 0.5 * MARK), (x, y + 0.5 * MARK), FRAME);
        });
    }
    let adhesive = courses.iter().any(|course| course.adhesive);
    let mirrored = if adhesive { "friction limit/μ" } else { "−F_n" };
    for (text, stroke) in [("F_n", NORMAL), (mirrored, NORMAL_MIRRORED), ("F_t/μ", TANGENTIAL)] {
        legend.entry(svg, KEY, text, |svg, key| {
            let y = key.top + 0.5 * key.height;
            svg.line((key.left, y), (key.right(), y), stroke);
        });
    }
}
