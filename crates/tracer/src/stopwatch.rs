//! The time that something takes. In a browser there is no clock, and asking for one would end the
//! program: no time passes there.

use std::time::Duration;
#[cfg(not(target_family = "wasm"))]
use std::time::Instant;

/// The time since it was started. Results never depend on it, only what is kept and reported.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopwatch {
    #[cfg(not(target_family = "wasm"))]
    begun: Instant,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self {
            #[cfg(not(target_family = "wasm"))]
            begun: Instant::now(),
        }
    }

    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn elapsed(&self) -> Duration {
        self.begun.elapsed()
    }

    #[cfg(target_family = "wasm")]
    #[expect(clippy::unused_self, reason = "it has a clock elsewhere")]
    pub(crate) fn elapsed(&self) -> Duration {
        Duration::ZERO
    }
}
