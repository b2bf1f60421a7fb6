//! The course of a collision from its closed form: the motion between the switches of the exact
//! engine.

use stickslip_contact::{Collision, Regime, Side};
use stickslip_exact::exact::normal_state;

use super::Snapshot;
use super::record::Course;

/// A collision of the exact engine.
#[derive(Clone, Debug)]
pub struct Closed(pub Collision);

/// The start of a phase.
struct Begin {
    regime: Regime,
    side: Side,
    time: f64,
    spring: f64,
    velocity: f64,
}

impl Closed {
    fn begun(&self, phase: usize) -> Begin {
        let Self(collision) = self;
        match phase.checked_sub(1) {
            None => {
                let (regime, side) = (collision.start, collision.start_side);
                let velocity = collision.contact.psi();
                Begin { regime, side, time: 0.0, spring: 0.0, velocity }
            }
            Some(index) => {
                let switch = collision.switches[index];
                Begin {
                    regime: switch.to,
                    side: switch.side,
                    time: switch.time,
                    spring: switch.spring,
                    velocity: switch.velocity,
                }
            }
        }
    }

    /// The moment of a phase at a time.
    fn state(&self, phase: usize, time: f64) -> Snapshot {
        let Self(collision) = self;
        let contact = &collision.contact;
        let begin = self.begun(phase);
        let normal = normal_state(contact, time);
        let (spring, velocity) = match begin.regime {
            // s·w − v is constant.
            Regime::Slip => {
                let change = normal.velocity - normal_state(contact, begin.time).velocity;
                let sign = begin.side.sign();
                (sign * normal.force / contact.kappa(), begin.velocity + sign * change)
            }
            // The spring oscillates.
            Regime::Stick => {
                let omega = contact.kappa().sqrt();
                let (sin, cos) = (omega * (time - begin.time)).sin_cos();
                let Begin { spring, velocity, .. } = begin;
                (spring * cos + velocity / omega * sin, velocity * cos - spring * omega * sin)
            }
        };
        Snapshot {
            time,
            compression: normal.compression,
            normal_velocity: normal.velocity,
            normal_force: normal.force,
            spring,
            tangential_force: -contact.kappa() * spring,
            velocity,
            limit: normal.force,
        }
    }

    fn end_time(&self, phase: usize) -> f64 {
        self.0.switches.get(phase).map_or(self.0.contact_time, |switch| switch.time)
    }
}

impl Course for Closed {
    fn duration(&self) -> f64 {
        self.0.contact_time
    }

    fn phases(&self) -> usize {
        self.0.switches.len() + 1
    }

    fn phase(&self, phase: usize) -> (Regime, Side) {
        let Begin { regime, side, .. } = self.begun(phase);
        (regime, side)
    }

    fn begin(&self, phase: usize) -> Snapshot {
        self.state(phase, self.begun(phase).time)
    }

    fn end(&self, phase: usize) -> Snapshot {
        self.state(phase, self.end_time(phase))
    }

    fn at(&self, time: f64) -> Snapshot {
        self.state(self.0.switches.partition_point(|switch| switch.time <= time), time)
    }

    fn samples(&self, phase: usize, intervals: usize) -> Vec<Snapshot> {
        // t = t_c sin² φ: the motion is smooth in φ at both ends.
        let duration = self.duration();
        let times = [self.begun(phase).time, self.end_time(phase)];
        let [from, to] = times.map(|time| (time / duration).min(1.0).sqrt().asin());
        let between = (1..intervals).map(|index| {
            let part = index as f64 / intervals as f64;
            let sin = (from + (to - from) * part).sin();
            self.state(phase, (duration * sin * sin).clamp(times[0], times[1]))
        });
        let ends = [self.begin(phase), self.end(phase)];
        let inner = if ends[0].time < ends[1].time { between.collect() } else { Vec::new() };
        let [first, last] = ends;
        std::iter::once(first).chain(inner).chain([last]).collect()
    }
}
