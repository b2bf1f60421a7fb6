//! Random systems whose events coincide exactly or nearly.
//!
//! | module | content |
//! |---|---|
//! | `planted` | the systems, in every form in which a run takes them |
//! | `oracle` | what happens in them, by exact arithmetic |
//! | `api` | guards with priorities |

#![allow(
    clippy::cast_possible_truncation,
    clippy::format_push_string,
    clippy::needless_range_loop,
    clippy::too_many_lines,
    clippy::trivially_copy_pass_by_ref,
    reason = "an oracle is written as it is checked by hand"
)]

#[path = "instants/api.rs"]
mod api;
#[path = "instants/oracle.rs"]
pub mod oracle;
#[path = "instants/planted.rs"]
mod planted;

use stickslip_solver::dynamic::{DynamicEvent, DynamicObserver, DynamicStart, run_dynamic};
use stickslip_solver::{
    Dop853, Dopri5, Method, Observer, Options, Outcome, RunError, Start, State, SwitchEvent,
    hybrid::Preempted, run,
};

use oracle::{Act, Plan};
use planted::{Any, AnyBox, Fixed, FixedBox, G, LINEAR, N, Planted, double};

/// A form of a system, and a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    Fixed,
    FixedBox,
    Any,
    AnyBox,
}

pub const FORMS: [Form; 4] = [Form::Fixed, Form::FixedBox, Form::Any, Form::AnyBox];

/// A random system with what happens in it.
pub struct Case {
    planted: Planted,
    pub plan: Plan,
    options: Options,
}

/// An event of a run.
#[derive(Clone, Debug)]
struct Seen {
    s: f64,
    guard: usize,
    from: usize,
    to: usize,
    before: [f64; N],
    after: [f64; N],
    simultaneous: Vec<usize>,
}

#[derive(Default)]
struct Log {
    seen: Vec<Seen>,
    preempted: Vec<usize>,
}

impl Observer<usize, N> for Log {
    fn on_switch(&mut self, event: &SwitchEvent<usize, N>) {
        let SwitchEvent { s, guard, simultaneous, from, to, before, after, .. } = *event;
        let simultaneous = (0..G).filter(|other| simultaneous >> other & 1 == 1).collect();
        let (before, after) = (before.data.0[0], after.data.0[0]);
        self.seen.push(Seen { s, guard, from, to, before, after, simultaneous });
    }

    fn on_preempted(&mut self, preempted: &Preempted<usize>) {
        self.preempted.push(preempted.guard);
    }
}

impl DynamicObserver<usize> for Log {
    fn on_switch(&mut self, event: &DynamicEvent<'_, usize>) {
        let DynamicEvent { s, guard, simultaneous, from, to, before, after, .. } = *event;
        let [before, after] = [before, after].map(|y| std::array::from_fn(|i| y[i]));
        let simultaneous = simultaneous.to_vec();
        self.seen.push(Seen { s, guard, from, to, before, after, simultaneous });
    }

    fn on_preempted(&mut self, preempted: &Preempted<usize>) {
        self.preempted.push(preempted.guard);
    }
}

/// What is wrong in a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    Error(RunError),
    /// The order is another one, and the run says that it is not decided.
    Undecided,
    Outcome(Outcome),
    /// Other guards act, or in another order.
    Order(String),
    /// A time or a state is wrong.
    Value(String),
}

impl Case {
    /// The case of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        loop {
            let mut planted = Planted::random(&mut random);
            let most = random.usize(2..12);
            if let Some(plan) = Plan::new(&planted, most, &mut random)
                && (plan.counts.shared > 0 || plan.counts.close > 0 || random.f64() < 0.1)
            {
                // Waves would need too many steps.
                if plan.end - planted.start.0 > 100 * planted::UNIT {
                    planted.waves = 0.0;
                }
                let tolerance = [1e-6, 1e-10, 1e-12][random.usize(0..3)];
                let length = double(plan.end - planted.start.0) * planted.scales.time;
                let parts = [0.3, 1.0, 7.0][random.usize(0..3)];
                let max_step = if length > 0.0 { length / parts } else { f64::INFINITY };
                let limits = Options {
                    max_steps: 100_000,
                    max_switches: 100,
                    max_at_one_instant: 50,
                    ..Options::default()
                };
                let options = Options { max_step, rtol: tolerance, atol: tolerance, ..limits };
                return Self { planted, plan, options };
            }
        }
    }

    /// The run of a form by a method, if it is not what the plan says.
    pub fn fault<M: Method>(&self, method: M, form: Form) -> Option<Fault> {
        let (s, mode, y) = self.planted.start;
        let s = double(s) * self.planted.scales.time;
        // A run that a guard ends needs some more time.
        let more = f64::from(u8::from(self.plan.terminal.is_some()));
        let end = (double(self.plan.end) + more) * self.planted.scales.time;
        let y = self.planted.state(&y);
        let fixed = Start { mode, s, state: State::from(y) };
        let first = |y: &[f64]| std::array::from_fn(|i| y[i]);
        let free = DynamicStart { mode, s, state: &y };
        let (mut log, options) = (Log::default(), &self.options);
        let ended = match form {
            Form::Fixed => run(method, &Fixed(&self.planted), fixed, end, options, &mut log)
                .map(|run| (run.outcome, run.mode, run.state.data.0[0], run.decided)),
            Form::FixedBox => run(method, &FixedBox(&self.planted), fixed, end, options, &mut log)
                .map(|run| (run.outcome, run.mode, run.state.data.0[0], true)),
            Form::Any => run_dynamic(method, &Any(&self.planted), free, end, options, &mut log)
                .map(|run| (run.outcome, run.mode, first(&run.state), run.decided)),
            Form::AnyBox => {
                run_dynamic(method, &AnyBox(&self.planted), free, end, options, &mut log)
                    .map(|run| (run.outcome, run.mode, first(&run.state), true))
            }
        };
        let (outcome, mode, state, decided) = match ended {
            Ok(ended) => ended,
            Err(error) => return Some(Fault::Error(error)),
        };
        if let Some(fault) = self.compare(&log.seen) {
            // A black box is never decided. A readable system may say so.
            return Some(if decided { fault } else { Fault::Undecided });
        }
        let preempted = self.plan.acts.iter().filter(|act| act.then.is_none());
        let preempted: Vec<_> = preempted.map(|act| act.guard).collect();
        if log.preempted != preempted {
            let found = log.preempted;
            return Some(Fault::Order(format!("preempts {found:?} instead of {preempted:?}")));
        }
        let expected = match self.plan.terminal {
            Some(guard) => Outcome::EndedByGuard { guard },
            None => Outcome::ReachedEnd,
        };
        if outcome != expected {
            return Some(Fault::Outcome(outcome));
        }
        if mode != self.plan.mode {
            return Some(Fault::Order(format!(
                "ends in mode {mode} instead of {}",
                self.plan.mode
            )));
        }
        self.wrong_state(&state, &self.plan.state, &self.plan.error)
            .map(|what| Fault::Value(format!("at the end, {what}")))
    }

    /// What differs in the events of a run, however much rounding may move what a reset leaves as
    /// it is.
    fn compare(&self, seen: &[Seen]) -> Option<Fault> {
        self.compare_within(4.0, seen).and_then(|_| self.compare_within(64.0, seen))
    }

    fn compare_within(&self, roundings: f64, seen: &[Seen]) -> Option<Fault> {
        let acts = |idle: bool| {
            let acts = self.plan.acts.iter().filter(move |act| act.then.is_some());
            acts.filter(move |act| act.idle == idle)
        };
        // A reset to the value that a component has already may move it by its rounding.
        let is_same = |(one, other): (&f64, &f64)| {
            let size = self.planted.scales.state + one.abs();
            (one - other).abs() <= roundings * f64::EPSILON * size
        };
        let is_idle =
            |seen: &&Seen| seen.from == seen.to && seen.before.iter().zip(&seen.after).all(is_same);
        // A guard that ends the run changes nothing either.
        let last = self.plan.terminal.and(self.plan.acts.last());
        let ends = |index: usize| last.is_some() && index + 1 == seen.len();
        let (idle, active): (Vec<_>, Vec<_>) =
            seen.iter().enumerate().partition(|(index, seen)| is_idle(seen) && !ends(*index));
        let names = |list: &[(usize, usize)]| format!("{list:?}");
        let found: Vec<_> = active.iter().map(|(_, seen)| (seen.guard, seen.from)).collect();
        let expected: Vec<_> = acts(false).map(|act| (act.guard, act.from)).collect();
        if found != expected {
            let same = found.iter().zip(&expected).take_while(|(one, other)| one == other).count();
            let at = acts(false).nth(same).map_or(f64::NAN, |act| double(act.s));
            return Some(Fault::Order(format!(
                "after {same} events, at {at}: {} instead of {}",
                names(&found[same..]),
                names(&expected[same..])
            )));
        }
        // Guards that change nothing may be reported together, in any order.
        let mut found: Vec<(usize, f64, bool)> = Vec::new();
        for (_, seen) in &idle {
            found.push((seen.guard, seen.s, false));
            found.extend(seen.simultaneous.iter().map(|&other| (other, seen.s, true)));
        }
        // A guard that is named where another one acts may have acted itself too.
        found.sort_by_key(|(_, _, named)| *named);
        for act in acts(true) {
            let near = |(guard, s, _): &(usize, f64, bool)| {
                *guard == act.guard && self.wrong_time(*s, act).is_none()
            };
            let Some(index) = found.iter().position(near) else {
                return Some(Fault::Order(format!(
                    "guard {} that changes nothing does not act at {}",
                    act.guard,
                    double(act.s)
                )));
            };
            found.remove(index);
        }
        // Guards that are zero there and do not act are named as well.
        found.retain(|(_, _, named)| !named);
        if let Some((guard, s, _)) = found.first() {
            return Some(Fault::Order(format!("guard {guard} acts at {s} and changes nothing")));
        }
        for ((_, seen), act) in active.iter().zip(acts(false)) {
            let (to, state) = act.then.as_ref()?;
            if seen.to != *to {
                return Some(Fault::Order(format!("{seen:?} does not lead to mode {to}")));
            }
            let wrong = self
                .wrong_time(seen.s, act)
                .or_else(|| self.wrong_state(&seen.after, state, &act.error.1));
            if let Some(what) = wrong {
                return Some(Fault::Value(format!("guard {} at {}: {what}", act.guard, seen.s)));
            }
        }
        None
    }

    fn wrong_time(&self, s: f64, act: &Act) -> Option<String> {
        let exact = double(act.s);
        let bound = 16.0 * act.error.0 + 64.0 * f64::EPSILON * (exact.abs() + 1.0);
        let error = s / self.planted.scales.time - exact;
        (error.abs().partial_cmp(&bound) != Some(std::cmp::Ordering::Less))
            .then(|| format!("the time {exact} has the error {error:e}, not {bound:e}"))
    }

    fn wrong_state(
        &self,
        state: &[f64; N],
        exact: &[planted::Exact; LINEAR],
        errors: &[f64; LINEAR],
    ) -> Option<String> {
        (0..LINEAR).find_map(|i| {
            let exact = double(exact[i]);
            let bound = 16.0 * errors[i] + 256.0 * f64::EPSILON * (exact.abs() + 8.0);
            let error = state[i] / self.planted.scales.state - exact;
            (error.abs().partial_cmp(&bound) != Some(std::cmp::Ordering::Less)).then(|| {
                format!("component {i} is {exact} with the error {error:e}, not {bound:e}")
            })
        })
    }

    /// What is wrong in the case, in each form and by each method.
    pub fn faults(&self) -> Vec<(Form, &'static str, Fault)> {
        let mut faults = Vec::new();
        for form in FORMS {
            faults.extend(self.fault(Dop853, form).map(|fault| (form, "dop853", fault)));
            faults.extend(self.fault(Dopri5, form).map(|fault| (form, "dopri5", fault)));
        }
        faults
    }

    /// The system and its plan, for a closer look.
    pub fn describe(&self) -> String {
        let (planted, plan) = (&self.planted, &self.plan);
        let y = |y: &[planted::Exact; LINEAR]| y.map(double);
        let (s, mode, start) = planted.start;
        let mut text = format!("{:?}\n{:?}\n", self.options, planted.scales);
        text += &format!("start {} mode {mode} {:?}\n", double(s), y(&start));
        for (mode, slopes) in planted.slopes.iter().enumerate() {
            text += &format!("mode {mode}: slopes/4 {slopes:?}, uses {:?}\n", planted.uses[mode]);
            for (guard, transition) in planted.transitions[mode].iter().enumerate() {
                if planted.uses[mode][guard].is_some() {
                    text += &format!("  guard {guard} to {}:", transition.to);
                    for reset in &transition.resets {
                        text += &match *reset {
                            planted::Reset::Set(value) => format!(" = {}", double(value)),
                            planted::Reset::Add(value) => format!(" + {}", double(value)),
                            other => format!(" {other:?}"),
                        };
                    }
                    text += "\n";
                }
            }
        }
        for (i, function) in planted.functions.iter().enumerate() {
            let planted::Function { components, time, level, shape, scale } = function;
            let level = double(*level);
            text += &format!(
                "function {i}: {components:?} y + {time} s - {level:?}, {shape:?} 2^{scale}\n"
            );
        }
        for (i, kind) in planted.kinds.iter().enumerate() {
            text += &format!("guard {i}: {kind:?}\n");
        }
        for act in &plan.acts {
            let then = act.then.as_ref().map(|(to, state)| (to, y(state)));
            let (s, from) = (double(act.s), act.from);
            text += &format!("{s}: guard {} in {from} to {then:?}, {:e}\n", act.guard, act.error.0);
        }
        let state = y(&plan.state);
        text + &format!(
            "end {} mode {} {state:?} {:?}\n",
            double(plan.end),
            plan.mode,
            plan.terminal
        )
    }
}
