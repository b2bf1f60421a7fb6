//! A system in all forms in which a run takes it.

use std::cell::OnceCell;

use stickslip_solver::dynamic::{
    DynamicEvent, DynamicObserver, DynamicStart, DynamicSystem, run_dynamic,
};
use stickslip_solver::{
    Dop853, Dopri5, Enclosure, Guard, HybridSystem, Method, Number, Observer, Options, Outcome,
    RunError, Schedule, Start, State, SwitchEvent,
};

use crate::erased::{self, run};

/// A system of up to four components, three guards and some modes.
pub trait Report {
    fn field<T: Number>(&self, mode: u8, s: T, y: [T; 4]) -> [T; 4];

    fn guards(&self, mode: u8) -> [Guard; 3];

    fn values<T: Number>(&self, mode: u8, s: T, y: [T; 4]) -> [T; 3];

    fn act(&self, mode: u8, _guard: usize, _s: f64, _y: &mut [f64; 4]) -> u8 {
        mode
    }

    fn schedule(&self, _guard: usize) -> Schedule<'_> {
        Schedule::NEVER
    }

    fn rest(&self, _mode: u8, _guard: usize, _y: [f64; 4]) -> Option<(u8, [f64; 4])> {
        None
    }
}

/// A system without generic functions, so that runs are compiled once for all systems.
trait Parts {
    fn field(&self, mode: u8, s: f64, y: [f64; 4]) -> [f64; 4];
    fn guards(&self, mode: u8) -> [Guard; 3];
    fn values(&self, mode: u8, s: f64, y: [f64; 4]) -> [f64; 3];
    fn enclose(&self, mode: u8, s: Enclosure, y: [Enclosure; 4]) -> [Enclosure; 3];
    fn act(&self, mode: u8, guard: usize, s: f64, y: &mut [f64; 4]) -> u8;
    fn schedule(&self, guard: usize) -> Schedule<'_>;
    fn rest(&self, mode: u8, guard: usize, y: [f64; 4]) -> Option<(u8, [f64; 4])>;
}

impl<R: Report> Parts for R {
    fn field(&self, mode: u8, s: f64, y: [f64; 4]) -> [f64; 4] {
        Report::field(self, mode, s, y)
    }
    fn guards(&self, mode: u8) -> [Guard; 3] {
        Report::guards(self, mode)
    }
    fn values(&self, mode: u8, s: f64, y: [f64; 4]) -> [f64; 3] {
        Report::values(self, mode, s, y)
    }
    fn enclose(&self, mode: u8, s: Enclosure, y: [Enclosure; 4]) -> [Enclosure; 3] {
        Report::values(self, mode, s, y)
    }
    fn act(&self, mode: u8, guard: usize, s: f64, y: &mut [f64; 4]) -> u8 {
        Report::act(self, mode, guard, s, y)
    }
    fn schedule(&self, guard: usize) -> Schedule<'_> {
        Report::schedule(self, guard)
    }
    fn rest(&self, mode: u8, guard: usize, y: [f64; 4]) -> Option<(u8, [f64; 4])> {
        Report::rest(self, mode, guard, y)
    }
}

/// The guards of a mode, once they have been asked for, and those of further modes.
#[derive(Default)]
struct Listed(OnceCell<(u8, [Guard; 3], Box<Listed>)>);

impl Listed {
    fn of(&self, mode: u8, parts: &dyn Parts) -> &[Guard] {
        let (listed, guards, more) =
            self.0.get_or_init(|| (mode, parts.guards(mode), Box::default()));
        if *listed == mode { guards } else { more.of(mode, parts) }
    }
}

/// Any system, as a readable one or as a black box.
struct Form<'a, const READABLE: bool>(&'a dyn Parts, Listed);

/// The components of a state of any dimension.
fn four<T: Copy>(y: &[T]) -> [T; 4] {
    std::array::from_fn(|i| y[i])
}

impl<const READABLE: bool> HybridSystem<4, 3> for Form<'_, READABLE> {
    type Mode = u8;
    const READABLE: bool = READABLE;

    fn field(&self, mode: u8, s: f64, y: &State<4>) -> State<4> {
        self.0.field(mode, s, four(y.as_slice())).into()
    }
    fn guards(&self, mode: u8) -> [Guard; 3] {
        self.0.guards(mode)
    }
    fn guard_values(&self, mode: u8, s: f64, y: &State<4>) -> [f64; 3] {
        self.0.values(mode, s, four(y.as_slice()))
    }
    fn enclose_guards(&self, mode: u8, s: Enclosure, y: &[Enclosure; 4]) -> [Enclosure; 3] {
        self.0.enclose(mode, s, *y)
    }
    fn transition(&self, mode: u8, guard: usize, s: f64, y: &State<4>) -> (u8, State<4>) {
        let mut after = four(y.as_slice());
        (self.0.act(mode, guard, s, &mut after), after.into())
    }
    fn schedule(&self, _: u8, guard: usize) -> Schedule<'_> {
        self.0.schedule(guard)
    }
    fn rest(&self, mode: u8, guard: usize, _s: f64, y: &State<4>) -> Option<(u8, State<4>)> {
        self.0.rest(mode, guard, four(y.as_slice())).map(|(mode, y)| (mode, y.into()))
    }
}

impl<const READABLE: bool> DynamicSystem for Form<'_, READABLE> {
    type Mode = u8;
    const READABLE: bool = READABLE;

    fn field(&self, mode: u8, s: f64, y: &[f64], slope: &mut [f64]) {
        slope.copy_from_slice(&self.0.field(mode, s, four(y)));
    }
    fn guards(&self, mode: u8) -> &[Guard] {
        self.1.of(mode, self.0)
    }
    fn guard_values(&self, mode: u8, s: f64, y: &[f64], values: &mut [f64]) {
        values.copy_from_slice(&self.0.values(mode, s, four(y)));
    }
    fn reads(&self, _mode: u8) -> &[usize] {
        &[0, 1, 2, 3]
    }
    fn enclose_guards(&self, mode: u8, s: Enclosure, y: &[Enclosure], values: &mut [Enclosure]) {
        values.copy_from_slice(&self.0.enclose(mode, s, four(y)));
    }
    fn transition(&self, mode: u8, guard: usize, s: f64, y: &mut [f64]) -> u8 {
        let mut after = four(y);
        let to = self.0.act(mode, guard, s, &mut after);
        y.copy_from_slice(&after);
        to
    }
    fn schedule(&self, _: u8, guard: usize) -> Schedule<'_> {
        self.0.schedule(guard)
    }
}

/// What a run reports. Guards that change nothing and are reported together are listed one by one.
#[derive(Debug, Default)]
pub struct Events(pub Vec<(f64, usize)>);

impl Events {
    fn push(&mut self, s: f64, guard: usize, others: impl Iterator<Item = usize>, idle: bool) {
        self.0.push((s, guard));
        if idle {
            self.0.extend(others.map(|other| (s, other)));
        }
    }

    /// The guards that have acted, in order.
    pub fn guards(&self) -> Vec<usize> {
        self.0.iter().map(|(_, guard)| *guard).collect()
    }

    /// The times at which a guard has acted.
    pub fn times(&self, guard: usize) -> Vec<f64> {
        self.0.iter().filter(|event| event.1 == guard).map(|event| event.0).collect()
    }
}

impl Observer<u8, 4> for Events {
    fn on_switch(&mut self, event: &SwitchEvent<u8, 4>) {
        let others = (0..3).filter(|other| event.simultaneous >> other & 1 == 1);
        let idle = event.from == event.to && event.before == event.after;
        self.push(event.s, event.guard, others, idle);
    }
}

impl DynamicObserver<u8> for Events {
    fn on_switch(&mut self, event: &DynamicEvent<'_, u8>) {
        let idle = event.from == event.to && event.before == event.after;
        self.push(event.s, event.guard, event.simultaneous.iter().copied(), idle);
    }
}

/// A run.
#[derive(Debug)]
pub struct Ended {
    /// The form and the method.
    pub name: String,
    pub events: Events,
    pub outcome: Outcome,
    pub s: f64,
    pub mode: u8,
    pub y: [f64; 4],
}

impl Ended {
    /// Asserts that a guard has acted at these times and at no others.
    pub fn acts_at(&self, guard: usize, times: &[f64], error: f64) {
        let found = self.events.times(guard);
        assert_eq!(found.len(), times.len(), "{}: guard {guard}: {:?}", self.name, self.events);
        for (found, expected) in found.iter().zip(times) {
            assert!((found - expected).abs() <= error, "{}: {found} {expected}", self.name);
        }
    }

    /// Asserts the last state.
    pub fn is_at(&self, y: &[f64], error: f64) {
        for (i, (found, expected)) in self.y.iter().zip(y).enumerate() {
            assert!((found - expected).abs() <= error, "{}: {i} {found} {expected}", self.name);
        }
    }
}

/// Runs a system from its start (mode, time, state) in all forms and by both methods.
pub fn runs<const N: usize>(
    system: &impl Report,
    (mode, s, y): (u8, f64, [f64; N]),
    end: f64,
    options: &Options,
) -> Vec<(String, Result<Ended, RunError>)> {
    let y = std::array::from_fn(|i| if i < N { y[i] } else { 0.0 });
    let mut ended = Vec::new();
    one::<_, true>(Dop853, "dop853", system, (mode, s, y), end, options, &mut ended);
    one::<_, true>(Dopri5, "dopri5", system, (mode, s, y), end, options, &mut ended);
    one::<_, false>(Dop853, "dop853", system, (mode, s, y), end, options, &mut ended);
    one::<_, false>(Dopri5, "dopri5", system, (mode, s, y), end, options, &mut ended);
    ended
}

/// As [`runs`], of a system that cannot fail, with usual options.
pub fn all<const N: usize>(
    system: &impl Report,
    start: (u8, f64, [f64; N]),
    end: f64,
) -> Vec<Ended> {
    let options = Options { max_switches: 2000, ..Options::with_tolerance(1e-12) };
    let ended = runs(system, start, end, &options).into_iter();
    ended.map(|(name, run)| run.unwrap_or_else(|error| panic!("{name}: {error}"))).collect()
}

fn one<M: Method + Copy, const READABLE: bool>(
    method: M,
    method_name: &str,
    parts: &dyn Parts,
    (mode, s, y): (u8, f64, [f64; 4]),
    end: f64,
    options: &Options,
    ended: &mut Vec<(String, Result<Ended, RunError>)>,
) {
    let kind = if READABLE { "readable" } else { "black box" };
    let form = &Form::<READABLE>(parts, Listed::default());
    let mut events = Events::default();
    let start = Start { mode, s, state: State::from(y) };
    let name = format!("{method_name}, {kind}");
    let fixed = run(method, form, start, end, options, &mut events).map(|run| {
        let (name, y) = (name.clone(), four(run.state.as_slice()));
        Ended { name, events, outcome: run.outcome, s: run.s, mode: run.mode, y }
    });
    ended.push((name, fixed));
    let mut events = Events::default();
    let start = DynamicStart { mode, s, state: &y };
    let name = format!("{method_name}, {kind} of any dimension");
    let free = if READABLE {
        run_dynamic(method, form, start, end, options, &mut events)
    } else {
        erased::run_dynamic(method, form, start, end, options, &mut events)
    };
    let free = free.map(|run| {
        let (name, y) = (name.clone(), four(&run.state));
        Ended { name, events, outcome: run.outcome, s: run.s, mode: run.mode, y }
    });
    ended.push((name, free));
}
