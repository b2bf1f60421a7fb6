//! How far a long computation has come.

/// What a computation reports while it runs, from any thread and in any order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// So many steps are ahead.
    Begin {
        /// The number of steps.
        steps: usize,
    },
    /// So many steps more are done.
    Advance {
        /// The number of steps.
        steps: usize,
    },
}

/// Receives the reports of a computation.
pub type Report<'a> = &'a (dyn Fn(Progress) + Sync);

/// Ignores all reports.
pub const SILENT: Report<'static> = &|_| {};
