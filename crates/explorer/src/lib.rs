//! The engines of stickslip behind a C interface, for a page that runs them as WebAssembly.
//!
//! The page writes a request as JSON into [`input`], calls [`call`], and reads the answer at
//! [`text_ptr`]. Maps and courses are raw arrays: [`map`] and [`course`] fill [`values_ptr`],
//! [`counts_ptr`], [`codes_ptr`] and [`numbers_ptr`], which stay valid until the next call. There
//! is one state for each thread, and each worker of the page has a module of its own.
//!
//! The one import is `env.curve`, by which the page is shown each curve of an atlas as soon as it
//! has been followed.
//!
//! Errors are answers with a field `error`. Nothing here panics on any request.
//!
//! The modules in reading order: `request` has what a page asks for, `scene` the plane that a map
//! or an atlas shows, `axis` and `point` what it is made of, `spheres` and `system` its two kinds,
//! `itinerary` their colours, `atlas` the boundaries, `page` what is shown before the answer, and
//! `state` what the arrays hold.

#![allow(clippy::missing_errors_doc, reason = "errors of the program are sentences for its user")]

mod atlas;
mod axis;
mod itinerary;
mod page;
mod request;
mod scene;
mod spheres;
pub mod state;
mod system;

use std::cell::RefCell;

use crate::state::State;

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

fn with<T>(act: impl FnOnce(&mut State) -> T) -> T {
    STATE.with_borrow_mut(act)
}

/// Room for a request of `length` bytes of JSON in UTF-8, which the page writes there.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    with(|state| state.room(length))
}

/// Answers the request in [`input`] as JSON, see `text_ptr`; returns the answer's length in bytes.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn call() -> usize {
    with(State::call)
}

/// Computes the rows from `first` to before `end` of a map of the present scene, from the top.
///
/// Each point has [`stride`] values, one count and one code. Returns the number of points, which is
/// 0 without a scene.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn map(columns: usize, rows: usize, first: usize, end: usize) -> usize {
    with(|state| state.map([columns, rows], first..end))
}

/// The number of values of each point of a map.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn stride() -> usize {
    with(|state| state.stride())
}

/// Computes the course of the contact at a point of the present scene: `least` + 1 even moments, or
/// more if the spring swings often, and all switches, each [`course_stride`] numbers. Returns the
/// number of moments; if it is 0, the text says why.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn course(x: f64, y: f64, least: usize) -> usize {
    with(|state| state.course([x, y], least))
}

/// The number of numbers of each moment of a course: time, compression, its rate, normal force,
/// spring, tangential force, velocity, 0 for stick or the side of the slip, and Coulomb's limit
/// over μ.
#[allow(unsafe_code, reason = "the name of an export")]
#[unsafe(no_mangle)]
pub extern "C" fn course_stride() -> usize {
    spheres::MOMENT
}

/// Defines the address and the length of an array of the state.
macro_rules! arrays {
    ($($array:ident: $pointer:ident, $length:ident;)*) => { $(
        #[doc = concat!("The address of the `", stringify!($array), "`.")]
        #[allow(unsafe_code, reason = "the name of an export")]
        #[unsafe(no_mangle)]
        pub extern "C" fn $pointer() -> *const u8 {
            with(|state| state.$array.as_ptr().cast())
        }

        #[doc = concat!("The number of elements of the `", stringify!($array), "`.")]
        #[allow(unsafe_code, reason = "the name of an export")]
        #[unsafe(no_mangle)]
        pub extern "C" fn $length() -> usize {
            with(|state| state.$array.len())
        }
    )* };
}

arrays! {
    text: text_ptr, text_len;
    numbers: numbers_ptr, numbers_len;
    values: values_ptr, values_len;
    counts: counts_ptr, counts_len;
    codes: codes_ptr, codes_len;
}
