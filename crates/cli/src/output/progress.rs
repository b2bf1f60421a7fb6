//! Progress bars, which are shown on a terminal only.

use std::fmt;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use stickslip_plane::progress::Progress;

/// A progress bar on standard error. It disappears when it is dropped.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar that counts the steps of a computation.
    pub fn steps() -> Self {
        Self::new(None, "{bar:25} {percent}%, {eta} left")
    }

    /// A bar that counts the bytes of an input of `length` bytes, if that is known.
    pub fn bytes(length: Option<u64>) -> Self {
        match length {
            Some(_) => Self::new(length, "{bar:40} {percent}% of {total_bytes}, {eta} left"),
            None => Self::new(None, "{spinner} {bytes}, {bytes_per_sec}"),
        }
    }

    /// A bar that counts the points of a map, of which `points` are still missing.
    pub fn points(points: usize) -> Self {
        const TEMPLATE: &str = "{bar:25} {percent}% of {human_len} points, {rate}/s, {eta} left";
        Self::new(Some(points as u64), TEMPLATE)
    }

    fn new(length: Option<u64>, template: &str) -> Self {
        let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
            // Writing into the line of the bar does not fail.
            let _ = write!(out, "{:.0}", state.per_sec());
        };
        let style =
            ProgressStyle::with_template(template).map(|style| style.with_key("rate", rate));
        let bar = ProgressBar::with_draw_target(length, ProgressDrawTarget::stderr());
        Self(bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar())))
    }

    /// Shows that `count` more are done.
    pub fn advance(&self, count: usize) {
        self.0.inc(count as u64);
    }

    /// Shows that the input has been read up to `byte`.
    pub fn reach(&self, byte: u64) {
        self.0.set_position(byte);
    }

    /// Shows what a computation reports.
    pub fn report(&self, progress: Progress) {
        match progress {
            Progress::Begin { steps } => {
                self.0.set_length(self.0.length().unwrap_or(0) + steps as u64);
            }
            Progress::Advance { steps } => self.advance(steps),
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
