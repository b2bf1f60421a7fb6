//! One step and its guards: which of them fires first, and where.

pub(crate) mod along_step;
pub(crate) mod event;
pub(crate) mod isolate;
mod locate;
pub(crate) mod one_guard;
pub(crate) mod phase;
mod quick;
pub(crate) mod together;
