//! What an atlas calls its parameters, its labels and its margins.

use std::fmt::Debug;

use crate::curve::Vertex;
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
