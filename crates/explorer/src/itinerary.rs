//! Codes of itineraries, by which the page colours them.

use stickslip_model::{Collision, Regime, Side};
use stickslip_solver::Outcome;
use stickslip_tracer::hybrid::Itinerary;

/// A hash of 32 bits (FNV-1a), never 0.
#[derive(Clone, Copy)]
struct Code(u32);

impl Code {
    const BEGIN: Self = Self(0x811c_9dc5);

    fn then(self, byte: u8) -> Self {
        Self((self.0 ^ u32::from(byte)).wrapping_mul(0x0100_0193))
    }

    fn end(self) -> u32 {
        self.0.max(1)
    }
}

/// The code of the itinerary of a collision.
pub fn of_collision(collision: &Collision) -> u32 {
    let entered = collision.switches.iter().map(|switch| (switch.to, switch.side));
    let phases = std::iter::once((collision.start, collision.start_side)).chain(entered);
    let character = |phase| match phase {
        (Regime::Stick, _) => b'o',
        (Regime::Slip, Side::Positive) => b'+',
        (Regime::Slip, Side::Negative) => b'-',
    };
    phases.map(character).fold(Code::BEGIN, Code::then).end()
}

/// The code of a run whose guards fired in this order.
pub fn of_run(fired: &[usize], outcome: Outcome) -> u32 {
    let whole = matches!(outcome, Outcome::ReachedEnd | Outcome::EndedByGuard { .. });
    of_guards(
        match outcome {
            Outcome::Zeno { .. } => return Code::BEGIN.then(b'z').end(),
            Outcome::StepLimit | Outcome::Stopped => return Code::BEGIN.then(b'u').end(),
            _ => fired,
        },
        whole,
    )
}

fn of_guards(fired: &[usize], whole: bool) -> u32 {
    #[expect(clippy::cast_possible_truncation, reason = "a hash")]
    let code = fired.iter().fold(Code::BEGIN, |code, guard| code.then(*guard as u8));
    code.then(if whole { b'.' } else { b'~' }).end()
}

/// The code of an itinerary, the same as that of its runs.
pub fn of_label(label: &Itinerary) -> u32 {
    match label {
        Itinerary::Fires(fired) => of_guards(fired, true),
        Itinerary::Begins(fired) => of_guards(fired, false),
        Itinerary::Accumulates => Code::BEGIN.then(b'z').end(),
        Itinerary::Unfinished => Code::BEGIN.then(b'u').end(),
        Itinerary::Fails => 0,
        Itinerary::NoStart(_) => Code::BEGIN.then(b'n').end(),
    }
}

/// An itinerary in words: the names of its rules, and how often each one follows itself.
pub fn words(label: &Itinerary, rules: &[String]) -> String {
    let (fired, more) = match label {
        Itinerary::Fires(fired) => (fired, ""),
        Itinerary::Begins(fired) => (fired, " …"),
        Itinerary::Accumulates => return "events accumulate".to_owned(),
        Itinerary::Unfinished => return "too many steps".to_owned(),
        Itinerary::Fails => return "no run".to_owned(),
        Itinerary::NoStart(_) => return "no start".to_owned(),
    };
    let several = |run: &[usize]| {
        let name = rules.get(run[0]).map_or("?", String::as_str);
        if run.len() == 1 { name.to_owned() } else { format!("{name} × {}", run.len()) }
    };
    let named: Vec<String> = fired.chunk_by(|one, next| one == next).map(several).collect();
    if named.is_empty() { format!("no event{more}") } else { format!("{}{more}", named.join(", ")) }
}
