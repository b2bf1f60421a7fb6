//! One step and its guards: which guard fires first, and where.
//!
//! Nearly all guards on nearly all steps are of one sign throughout, or fall once; the first look
//! at a guard recognises both. The other guards are isolated, one by one. Once an event is located,
//! one evaluation there says which other guards may fire no later, and only these are located too.
//! An event that changes neither mode nor state is noted, and the search goes on behind it on the
//! same step. A guard is recognised in another mode by its values: it is the same guard if it has
//! the same values, or their negatives, at three places of the step.
//!
//! The files, in reading order:
//!
//! | file | content |
//! |---|---|
//! | `phase` | the active mode with its guards, between two steps |
//! | `event` | the guards that fire on a step at one instant |
//! | `examination` | everything that the examination of a step needs |
//! | `first_guard` | which guards of a step fire first |
//! | `noted` | events that change nothing |
//! | `doubt` | by how much rounding may move the place of an event |
//! | `one_guard` | what one guard does on a step |
//! | `quick` | the first look at a guard, from six values that the step already has |
//! | `by_bounds` | the first look at a guard of a readable system |
//! | `isolate` | the decision about a guard, from its monotone pieces |
//! | `path` | bounds for the state along a step, for the guards of readable systems |
//! | `along_step` | a guard as a function along a step, and its rounding |
//! | `sidestep` | places beside one where a guard has no value |
//! | `locate` | the place of a switch, by steps of the method |
//! | `notices` | touches and poles, until the step is accepted |
//! | `arrival` | guards that are zero where a step must end, and clocks |

pub(crate) mod along_step;
pub(crate) mod arrival;
mod by_bounds;
mod doubt;
mod event;
mod examination;
pub(crate) mod first_guard;
pub(crate) mod isolate;
pub(crate) mod locate;
mod noted;
pub(crate) mod notices;
pub(crate) mod one_guard;
mod path;
pub(crate) mod phase;
pub(crate) mod quick;
pub(crate) mod sidestep;
pub(crate) mod status;

pub(crate) use along_step::{dense_output, repeated_step};
pub(crate) use arrival::HERE;
pub(crate) use doubt::Doubt;
pub(crate) use event::{Crossed, Event, Found, Note, only};
pub(crate) use examination::{Examination, values_on};
pub(crate) use first_guard::{UNSEEN, all_clearly_away};
pub(crate) use notices::{Noticed, Notices};
pub(crate) use phase::Phase;
