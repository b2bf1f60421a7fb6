//! What the C interface keeps between calls: the scene, and the arrays that the page reads.
//! Programs in Rust need no interface: they use this.

use std::ops::Range;

use serde_json::json;

use crate::request;
use crate::scene::{Kind, Scene};

/// The state of one thread.
#[derive(Default)]
pub struct State {
    input: Vec<u8>,
    scene: Option<Scene>,
    /// The last answer, as JSON or as a sentence.
    pub text: String,
    /// The last course.
    pub numbers: Vec<f64>,
    /// Values of the last map, [`Self::stride`] a point.
    pub values: Vec<f32>,
    /// Numbers of switches or events of the last map.
    pub counts: Vec<u16>,
    /// Codes of the itineraries of the last map.
    pub codes: Vec<u32>,
}

impl State {
    /// Room for a request.
    pub fn room(&mut self, length: usize) -> *mut u8 {
        self.input.clear();
        self.input.resize(length, 0);
        self.input.as_mut_ptr()
    }

    /// Takes a request, as the page does it through [`Self::room`].
    pub fn fill(&mut self, request: &[u8]) {
        self.input = request.to_vec();
    }

    /// Answers the request.
    pub fn call(&mut self) -> usize {
        let answer = serde_json::from_slice(&self.input)
            .map_err(|error| json!({ "error": error.to_string() }))
            .and_then(|request| request::answer(request, &mut self.scene));
        let answer = answer.unwrap_or_else(|error| error);
        self.text = answer.to_string();
        self.text.len()
    }

    /// Computes rows of a map.
    pub fn map(&mut self, size: [usize; 2], rows: Range<usize>) -> usize {
        let Self { scene, values, counts, codes, .. } = self;
        values.clear();
        counts.clear();
        codes.clear();
        if let Some(scene) = scene {
            scene.map(size, rows, |point| {
                values.extend(point.values);
                counts.push(point.count);
                codes.push(point.code);
            });
        }
        counts.len()
    }

    /// The number of values of each point of a map.
    pub fn stride(&self) -> usize {
        self.scene.as_ref().map_or(0, |scene| scene.fields().len())
    }

    /// Computes the course of a contact.
    pub fn course(&mut self, point: [f64; 2], intervals: usize) -> usize {
        self.numbers.clear();
        self.text.clear();
        match &self.scene {
            Some(Scene { kind: Kind::Spheres(spheres), .. }) => {
                match spheres.course(point, intervals, &mut self.numbers) {
                    Ok(moments) => return moments,
                    Err(error) => self.text = error,
                }
            }
            _ => "there is no scene of collisions".clone_into(&mut self.text),
        }
        0
    }
}
