//! The study as pictures.

use super::limit::BOUND_FACTOR;
use stickslip_model::{Contact, exact};

use super::Measurement;
use crate::study::Picture;
use stickslip_figure::canvas::panel::Scale;
use stickslip_figure::canvas::shape::Stroke;
use stickslip_figure::pictures::chart::{self, Chart, ChartAxis, Mark, Series, Shape};
use stickslip_figure::{Svg, number};

/// Colours of Okabe and Ito, and shapes that tell series apart without them.
const MARKS: [Mark; 4] = [
    Mark { shape: Shape::Disc, colour: "#0072B2" },
    Mark { shape: Shape::Ring, colour: "#D55E00" },
    Mark { shape: Shape::Cross, colour: "#009E73" },
    Mark { shape: Shape::Square, colour: "#CC79A7" },
];

const THEORY: Stroke = Stroke::full("#222222", 1.4);
const PRINTED: Stroke = Stroke { colour: "#D55E00", width: 1.6, dashes: "7 4" };
const CORRECTED: Stroke = Stroke { colour: "#CC79A7", width: 1.6, dashes: "2 3" };
const COURSE: Stroke = Stroke::full("#56B4E9", 0.9);

/// Up to here single oscillations can be told apart in a picture.
const MOST_RESOLVED: f64 = 3e3;
/// Points of an oscillation.
const FINE: f64 = 40.0;

impl Measurement {
    pub fn pictures(&self) -> Vec<Picture> {
        vec![
            Picture {
                name: "asymptote_envelope",
                caption: "The largest |w_final| of the oscillation around each ψ, the limit Fκ^{−5/4} of the inner \
                          problem, and the bound (27) with and without its factor."
                    .to_owned(),
                svg: self.envelope(),
            },
            Picture {
                name: "asymptote_correction",
                caption: "What κ^{5/4}|w_final| lacks to the constant of the inner problem, and the next order's coefficient \
                          times κ^{−5/4}."
                    .to_owned(),
                svg: self.correction(),
            },
            Picture {
                name: "asymptote_profile",
                caption: "F(phase) of the inner problem, and full collisions over one oscillation.".to_owned(),
                svg: self.profile(),
            },
            Picture {
                name: "asymptote_counts",
                caption: "The number of switches over √κ t_c/π, and 2 min(t₁, t_c − t₁)/t_c from the time t₁ of the \
                          first switch."
                    .to_owned(),
                svg: self.counts(),
            },
        ]
    }

    fn kappas(&self) -> (f64, f64) {
        (self.kappas[0], self.kappas[self.kappas.len() - 1])
    }

    fn kappa_axis(&self) -> ChartAxis<'static> {
        ChartAxis { name: "scaled stiffness κ", range: self.kappas(), scale: Scale::Logarithmic }
    }

    fn envelope(&self) -> Svg {
        let (low, high) = self.kappas();
        let power = |name: &str, factor: f64, power: f64, stroke| {
            let points = self.kappas.iter().map(|kappa| (*kappa, factor * kappa.powf(power)));
            line(name, points.collect(), stroke)
        };
        let (course_psi, course) = self.course();
        let f = format!("limit {} κ^{{−5/4}}", number(self.peak.velocity, 7));
        let mut series = vec![
            line(&format!("|w_{{final}}| at ψ = {course_psi}"), course, COURSE),
            power("bound (27) as printed, 1/√κ", 1.0, -0.5, PRINTED),
            power("bound with its factor, (5/4)^{3/5}/√κ", BOUND_FACTOR, -0.5, CORRECTED),
            power(&f, self.peak.velocity, -1.25, THEORY),
        ];
        for (points, mark) in self.points.iter().zip(MARKS) {
            let name = format!("largest around ψ = {}", points[0].psi);
            series.push(marks(&name, points.iter().map(|p| (p.kappa, p.crest.velocity)), mark));
        }
        chart::draw(&Chart {
            title: "Final velocity and its bounds for stiff springs",
            x: self.kappa_axis(),
            y: ChartAxis {
                name: "|w_{final}| = ψ|ε_t|",
                range: (0.1 * self.peak.velocity * high.powf(-1.25), 2.0 / low.sqrt()),
                scale: Scale::Logarithmic,
            },
            series,
        })
    }

    fn correction(&self) -> Svg {
        let (low, high) = self.kappas();
        let law = |kappa: f64| -self.peak.correction * kappa.powf(-1.25);
        let points = self.kappas.iter().map(|kappa| (*kappa, law(*kappa)));
        let name = format!("next order, {} κ^{{−5/4}}", number(-self.peak.correction, 6));
        let mut series = vec![line(&name, points.collect(), THEORY)];
        for (points, mark) in self.points.iter().zip(MARKS) {
            let name = format!("largest around ψ = {}", points[0].psi);
            let lacking = points.iter().map(|p| (p.kappa, self.peak.velocity - p.scaled()));
            series.push(marks(&name, lacking, mark));
        }
        chart::draw(&Chart {
            title: "What the largest final velocity lacks to its limit",
            x: self.kappa_axis(),
            y: ChartAxis {
                name: "F − κ^{5/4} |w_{final}|",
                range: (0.3 * law(high), 3.0 * law(low)),
                scale: Scale::Logarithmic,
            },
            series,
        })
    }

    /// |w_final| at the middle ψ as far as single oscillations can be told apart.
    fn course(&self) -> (f64, Vec<(f64, f64)>) {
        let psi = self.points[self.points.len() / 2][0].psi;
        let (low, high) = self.kappas();
        let (from, to) = (low.sqrt(), high.min(MOST_RESOLVED).sqrt());
        // A half swing is π/√κ, and a contact lasts 3.2: an oscillation is no shorter than 1 in √κ.
        let steps = ((to - from) * FINE).max(0.0).ceil();
        let places = (0..).map(f64::from).take_while(|step| *step <= steps);
        let points = places.filter_map(|step| {
            let kappa = (from + (to - from) * step / steps.max(1.0)).powi(2);
            let collision = exact::collide(Contact::new(kappa, psi, 0.0).ok()?).ok()?;
            Some((kappa, collision.final_velocity.abs()))
        });
        (psi, points.collect())
    }

    fn profile(&self) -> Svg {
        let profile = &self.profile;
        let curve = profile.curve.iter().map(|place| (place.phase, place.velocity));
        let mut series = vec![line("inner problem", curve.collect(), THEORY)];
        for (collisions, mark) in profile.compared.iter().zip(MARKS) {
            let Some(first) = collisions.first() else { continue };
            let name = format!("κ = {}", number(first.kappa, 3));
            series.push(marks(&name, collisions.iter().map(|c| (c.phase, c.velocity)), mark));
        }
        chart::draw(&Chart {
            title: "F(phase): what is left of a stiff collision",
            x: ChartAxis {
                name: "phase φ of the last onset, in half swings",
                range: (profile.zero_phase - 1.0, profile.zero_phase),
                scale: Scale::Linear,
            },
            y: ChartAxis {
                name: "F = κ^{5/4} |w_{final}|",
                range: (0.0, 5.0),
                scale: Scale::Linear,
            },
            series,
        })
    }

    fn counts(&self) -> Svg {
        let mut series = Vec::new();
        for (points, mark) in self.points.iter().zip(MARKS) {
            let expected = points.iter().map(|p| (p.kappa, p.count_expected)).collect();
            let stroke = Stroke { colour: mark.colour, width: 1.2, dashes: "6 4" };
            series.push(line("", expected, stroke));
            let name = format!("ψ = {}", points[0].psi);
            series.push(marks(&name, points.iter().map(|p| (p.kappa, p.count_ratio)), mark));
        }
        let highest = self.points.iter().flatten().map(|p| p.count_ratio).fold(1.0, f64::max);
        chart::draw(&Chart {
            title: "Number of switches over √κ t_c/π; dashed: 2 min(t_1, t_c − t_1)/t_c",
            x: self.kappa_axis(),
            y: ChartAxis {
                name: "switches/(√κ t_c/π)",
                range: (0.0, 1.1 * highest),
                scale: Scale::Linear,
            },
            series,
        })
    }
}

fn line(name: &str, points: Vec<(f64, f64)>, stroke: Stroke) -> Series {
    Series { name: name.to_owned(), points, line: Some(stroke), mark: None }
}

fn marks(name: &str, points: impl Iterator<Item = (f64, f64)>, mark: Mark) -> Series {
    Series { name: name.to_owned(), points: points.collect(), line: None, mark: Some(mark) }
}
