//! One step and its guards: which of them fires first, and where.

mod along_step;
mod event;
mod examination;
mod first_guard;
mod isolate;
mod locate;
mod one_guard;
mod phase;
mod quick;
mod together;

pub(crate) use event::{Event, Found};
pub(crate) use examination::Examination;
pub(crate) use phase::{Phase, Standing};
pub(crate) use together::Passage;
