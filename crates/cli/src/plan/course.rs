//! The file of a course.

use std::path::PathBuf;

use super::files::{Named, require_different};
use crate::args::CourseArguments;
use crate::error::Failure;

/// The course of a collision in time, as a file.
#[derive(Clone, Debug, PartialEq)]
pub struct CoursePlan {
    /// The file.
    pub path: PathBuf,
    /// Number of even times, at least two.
    pub points: usize,
}

impl CoursePlan {
    /// The course that `arguments` ask for, beside other outputs and inputs.
    ///
    /// # Errors
    /// [`Failure::Usage`]: the file is one of the others.
    pub fn new(
        arguments: &CourseArguments,
        others: &[Named],
        inputs: &[Named],
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = &arguments.course else { return Ok(None) };
        let outputs: Vec<Named> =
            others.iter().copied().chain([("--course", Some(&**path))]).collect();
        require_different(&outputs, inputs)?;
        Ok(Some(Self { path: path.clone(), points: arguments.points as usize }))
    }
}
