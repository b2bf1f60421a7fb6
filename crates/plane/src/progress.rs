//! Reports of how far a long computation has come.

/// What a computation reports while it runs, from any thread and in any order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// A stage of the computation begins.
    Begin {
        /// The number of steps that it takes.
        steps: usize,
    },
    /// Steps of the stage are done.
    Advance {
        /// The number of steps since the last report.
        steps: usize,
    },
}

/// Receives the reports of a computation.
pub type Report<'a> = &'a (dyn Fn(Progress) + Sync);

/// Ignores all reports.
pub const SILENT: Report<'static> = &|_| {};
