//! What an atlas calls its parameters, its labels and its margins.

use std::fmt::Debug;

use stickslip_solver::margin::{Margin, Place};

use crate::curve::Vertex;
use crate::hybrid::Itinerary;
use crate::tracing::network::Unresolved;
use crate::window::Point;

/// What an atlas calls its parameters, the labels of its regions and the margins of its curves.
///
/// Pictures, tables and sentences take it from here, whoever has traced the atlas. Nothing is run:
/// an atlas that was read from a file has names too.
pub trait Names<Label, Margin> {
    /// The names of the two parameters.
    fn axes(&self) -> [&str; 2];

    /// The two parameters of a traced point; its coordinates if nothing else is known.
    fn parameters(&self, point: &Point) -> [f64; 2] {
        (*point).into()
    }

    /// The traced point of two parameters: the inverse of [`Self::parameters`].
    fn point(&self, parameters: [f64; 2]) -> Point {
        parameters.into()
    }

    /// A label in words.
    fn text(&self, label: &Label) -> String;

    /// A label as shortly as a picture has room for.
    fn short(&self, label: &Label) -> String {
        self.text(label)
    }

    /// What happens where a margin vanishes, in a word.
    fn kind(&self, margin: &Margin) -> &'static str;

    /// A place in a sentence.
    fn place(&self, point: &Point) -> String {
        let ([x_name, y_name], [x, y]) = (self.axes(), self.parameters(point));
        format!("{x_name} = {x:?}, {y_name} = {y:?}")
    }

    /// What a trace could not explain, in a sentence; `vertices` are those of the atlas.
    fn unresolved(&self, what: &Unresolved<Label>, vertices: &[Vertex<Margin>]) -> String {
        match what {
            Unresolved::Change { between, .. } => {
                let [one, other] = between.each_ref().map(|point| self.place(point));
                format!("the switches change between {one} and {other} without a boundary")
            }
            Unresolved::Stalled { vertex } => {
                let place = self.place(&vertices[*vertex].point);
                format!("a boundary ends without a known cause at vertex {vertex}, {place}")
            }
            Unresolved::TooManyNodes { point } => {
                let place = self.place(point);
                format!("a boundary has too many points and was left at {place}")
            }
            Unresolved::NoLength { point, .. } => {
                format!("a boundary has no length at {}", self.place(point))
            }
            Unresolved::TooManyCurves { point } => {
                format!("too many boundaries; the next one starts at {}", self.place(point))
            }
        }
    }
}

/// Names for families of which nothing is known: coordinates, and labels as in debug output.
#[derive(Clone, Copy, Debug)]
pub struct Unnamed;

impl<Label: Debug, Margin> Names<Label, Margin> for Unnamed {
    fn axes(&self) -> [&str; 2] {
        ["x", "y"]
    }

    fn text(&self, label: &Label) -> String {
        format!("{label:?}")
    }

    fn kind(&self, _: &Margin) -> &'static str {
        "boundary"
    }

    fn place(&self, point: &Point) -> String {
        format!("({:?}, {:?})", point.x, point.y)
    }
}

/// The names in an atlas of a hybrid system.
///
/// ```
/// use stickslip_tracer::{Names, RunNames, hybrid::Itinerary};
///
/// let axes = ["height".to_owned(), "e".to_owned()];
/// let names = RunNames { family: "ball".to_owned(), axes, guards: vec!["bounce".to_owned()] };
/// assert_eq!(names.text(&Itinerary::Fires(vec![0, 0])), "bounce; bounce");
/// assert_eq!(names.short(&Itinerary::Begins(vec![0, 0])), "2+");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunNames {
    /// What was traced.
    pub family: String,
    /// The names of the two parameters.
    pub axes: [String; 2],
    /// The names of the guards that itineraries count.
    pub guards: Vec<String>,
}

impl Names<Itinerary, Margin> for RunNames {
    fn axes(&self) -> [&str; 2] {
        self.axes.each_ref().map(String::as_str)
    }

    /// The guards that fire, and how a run ends that does not come to its end.
    fn text(&self, label: &Itinerary) -> String {
        let name = |guard: &usize| self.guards.get(*guard).map_or("", String::as_str);
        let names = |guards: &[usize]| guards.iter().map(name).collect::<Vec<_>>().join("; ");
        match label {
            Itinerary::Fires(guards) => names(guards),
            Itinerary::Begins(guards) => format!("{}; …", names(guards)),
            Itinerary::Accumulates => "accumulates".to_owned(),
            Itinerary::Unfinished => "unfinished".to_owned(),
            Itinerary::Fails => "fails".to_owned(),
            Itinerary::NoStart(0) => "no start".to_owned(),
            Itinerary::NoStart(failed) => format!("no start, by condition {}", failed + 1),
        }
    }

    /// The number of events.
    fn short(&self, label: &Itinerary) -> String {
        match label {
            Itinerary::Fires(guards) => guards.len().to_string(),
            Itinerary::Begins(guards) => format!("{}+", guards.len()),
            Itinerary::Accumulates => "∞".to_owned(),
            Itinerary::Unfinished | Itinerary::Fails => "–".to_owned(),
            Itinerary::NoStart(_) => "none".to_owned(),
        }
    }

    fn kind(&self, margin: &Margin) -> &'static str {
        match margin.place {
            Place::End => "event-at-end",
            Place::Minimum { .. } | Place::Maximum { .. } => "graze",
            Place::Exit(_) => "order",
            Place::Start { .. } => "event-at-start",
            Place::Branch(_) => "branch",
            Place::Condition => "condition",
        }
    }
}
