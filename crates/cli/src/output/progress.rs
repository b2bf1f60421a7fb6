//! Progress: a bar on a terminal, and a line a minute where standard error is none.

use std::fmt;
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use stickslip_orbits::OrbitWatch;
use stickslip_plane::progress::Progress;

use super::console::say;

/// How often progress is said where no bar is seen.
const INTERVAL: Duration = Duration::from_mins(1);
/// How often it is asked for, where nobody reports it.
const PAUSE: Duration = Duration::from_millis(100);

/// Progress on standard error. The bar disappears when it is dropped.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    /// Ends lines, where there is no terminal, and questions, unless it is told, when dropped.
    beside: Vec<Sender<()>>,
}

impl Bar {
    /// A bar that counts the steps of a computation.
    pub fn steps() -> Self {
        Self::new(None, "{bar:25} {percent}%, {eta} left  {msg}")
    }

    /// A bar that counts the steps of work on orbits, for which it asks.
    pub fn watching(watch: Arc<OrbitWatch>) -> Self {
        let mut made = Self::steps();
        let bar = made.bar.clone();
        let ask = move || {
            let (done, steps) = watch.progress();
            bar.set_length(steps as u64);
            bar.set_position(done as u64);
        };
        made.beside.push(every(PAUSE, ask));
        made
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
        let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        let seen = io::stderr().is_terminal();
        let lines = (!seen).then(|| lines(bar.clone(), INTERVAL, say));
        Self { bar, beside: lines.into_iter().collect() }
    }

    /// Shows that `count` more are done.
    pub fn advance(&self, count: usize) {
        self.bar.inc(count as u64);
    }

    /// Shows that the input has been read up to `byte`.
    pub fn reach(&self, byte: u64) {
        self.bar.set_position(byte);
    }

    /// Shows what a computation reports.
    pub fn report(&self, progress: Progress) {
        match progress {
            Progress::Begin { steps } => {
                self.bar.set_length(self.bar.length().unwrap_or(0) + steps as u64);
            }
            Progress::Advance { steps } => self.advance(steps),
            Progress::Now { what } => self.bar.set_message(what),
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Gives a line about `bar` to `out` every `interval`, until the sender is dropped.
fn lines(
    bar: ProgressBar,
    interval: Duration,
    out: impl Fn(String) + Send + 'static,
) -> Sender<()> {
    every(interval, move || out(line(&bar)))
}

/// Calls `action` every `interval`, until the sender is dropped.
fn every(interval: Duration, action: impl Fn() + Send + 'static) -> Sender<()> {
    let (sender, ended) = mpsc::channel();
    thread::spawn(move || {
        while ended.recv_timeout(interval) == Err(RecvTimeoutError::Timeout) {
            action();
        }
    });
    sender
}

/// How far a computation is, and how long it has taken.
fn line(bar: &ProgressBar) -> String {
    let minutes = (bar.elapsed().as_secs_f64() / 60.0).round();
    let part = match bar.length() {
        Some(length) if length > 0 => {
            format!("{:.0} %", 100.0 * bar.position() as f64 / length as f64)
        }
        // A computation that has said what it does, and not how long it is.
        _ if !bar.message().is_empty() => "0 %".to_owned(),
        _ => format!("{} bytes", bar.position()),
    };
    let doing = match bar.message() {
        doing if doing.is_empty() => doing,
        doing => format!(", {doing}"),
    };
    format!("progress: {part} after {minutes} min{doing}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_until_the_end() {
        const SAID: &str = "progress: 25 % after 0 min, searching along the grid";
        let (said, heard) = mpsc::channel();
        let bar = ProgressBar::with_draw_target(Some(8), ProgressDrawTarget::hidden());
        bar.inc(2);
        bar.set_message("searching along the grid");
        let keep = lines(bar, Duration::from_millis(1), move |line| said.send(line).unwrap());
        assert_eq!(heard.recv().unwrap(), SAID);
        drop(keep);
        // The thread ends, and with it its side of the channel.
        assert!(heard.iter().all(|line| line == SAID));
    }
}
