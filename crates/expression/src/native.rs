//! Systems of Rust as formulas: a number that records what is done with it.

use std::cell::RefCell;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use stickslip_number::Number;
use stickslip_solver::sensitivity::ReadableTransition;
use stickslip_solver::{Direction, Guard, InvalidValue, ReadableSystem, Schedule, State};

use crate::graph::{Binary, Formula, Graph, Unary};
use crate::system::{Component, Mode, Next, Parameter, Rule, System, Trigger};

/// A hybrid system of Rust that is written once for all numbers: `N` components, at most `G` guards
/// in a mode, and `P` parameters, which are numbers too.
///
/// With values for its parameters it is a [`ReadableSystem`] of the solver ([`ValuedSystem`]).
/// [`System::of_native`] reads it as formulas. Whatever there is for texts is there for it too:
/// orbits and branches, atlases, derivatives, and its text.
///
/// ```
/// use stickslip_expression::{Jump, NativeSystem, System, ValuedSystem};
/// use stickslip_solver::{Direction, Dop853, Guard, Number, Options, Start, run};
///
/// /// A relay with hysteresis: it pushes a number up and down.
/// struct Relay;
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// enum Push {
///     Up,
///     Down,
/// }
///
/// impl NativeSystem<1, 1, 1> for Relay {
///     type Mode = Push;
///
///     fn parameters(&self) -> [(&str, f64); 1] {
///         [("width", 0.5)]
///     }
///     fn components(&self) -> [(&str, f64); 1] {
///         [("x", 0.0)]
///     }
///     fn modes(&self) -> &[Push] {
///         &[Push::Up, Push::Down]
///     }
///     fn field<T: Number>(&self, mode: Push, _: &[T; 1], _time: T, y: &[T; 1]) -> [T; 1] {
///         [-y[0] + if mode == Push::Up { 1.0 } else { -1.0 }]
///     }
///     fn guards(&self, mode: Push) -> [(&str, Guard); 1] {
///         [(if mode == Push::Up { "down" } else { "up" }, Guard::new(Direction::Below))]
///     }
///     fn guard_values<T: Number>(
///         &self, mode: Push, width: &[T; 1], _time: T, y: &[T; 1],
///     ) -> [T; 1] {
///         [width[0] + if mode == Push::Up { -y[0] } else { y[0] }]
///     }
///     fn transition<T: Number>(
///         &self, mode: Push, _: usize, _: &[T; 1], _time: T, y: &[T; 1],
///     ) -> Jump<Push, T, 1> {
///         Jump::to(if mode == Push::Up { Push::Down } else { Push::Up }, *y)
///     }
/// }
///
/// // The solver runs it as it is compiled.
/// let start = Start { mode: Push::Up, s: 0.0, state: [0.0].into() };
/// let relay = ValuedSystem { system: &Relay, parameters: [0.5] };
/// let mut switches = Vec::new();
/// run(Dop853, &relay, start, 2.0, &Options::default(), &mut switches)?;
/// assert!((switches[0].s - 2.0_f64.ln()).abs() < 1e-12);
///
/// // As formulas it has a text.
/// let text = System::of_native(&Relay)?.text();
/// assert!(text.contains("when width - x < 0 \"down\" -> Down"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait NativeSystem<const N: usize, const G: usize, const P: usize> {
    /// A smooth regime.
    type Mode: Copy + PartialEq + Debug;

    /// The names of the parameters, and their values unless others are given.
    fn parameters(&self) -> [(&str, f64); P];

    /// The names of the components, and their values at the start.
    fn components(&self) -> [(&str, f64); N];

    /// All modes, first that in which a run starts.
    fn modes(&self) -> &[Self::Mode];

    /// The derivative of the state.
    fn field<T: Number>(&self, mode: Self::Mode, parameters: &[T; P], s: T, y: &[T; N]) -> [T; N];

    /// The guards of a mode with their names. [`Guard::OFF`] fills unused places.
    fn guards(&self, mode: Self::Mode) -> [(&str, Guard); G];

    /// The values of the guards. Those of clocks and of unused places are ignored.
    fn guard_values<T: Number>(
        &self,
        mode: Self::Mode,
        parameters: &[T; P],
        s: T,
        y: &[T; N],
    ) -> [T; G];

    /// What follows when a guard fires. The provided version changes nothing.
    fn transition<T: Number>(
        &self,
        mode: Self::Mode,
        _guard: usize,
        _parameters: &[T; P],
        _s: T,
        y: &[T; N],
    ) -> Jump<Self::Mode, T, N> {
        Jump::to(mode, *y)
    }

    /// The period and the phase of a [clock](Guard::clock).
    fn clock<T: Number>(
        &self,
        _mode: Self::Mode,
        _guard: usize,
        _parameters: &[T; P],
    ) -> Option<[T; 2]> {
        None
    }
}

/// What follows when a guard of a [`NativeSystem`] fires.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump<M, T, const N: usize> {
    /// The mode.
    pub mode: M,
    /// The state.
    pub state: [T; N],
    /// Another mode, which follows instead where this number is negative.
    pub otherwise: Option<(T, M)>,
}

impl<M, T, const N: usize> Jump<M, T, N> {
    /// A mode and a state.
    pub const fn to(mode: M, state: [T; N]) -> Self {
        Self { mode, state, otherwise: None }
    }
}

/// A [`NativeSystem`] at values of its parameters, as the solver runs it.
#[derive(Clone, Copy, Debug)]
pub struct ValuedSystem<'a, S, const P: usize> {
    /// The system.
    pub system: &'a S,
    /// The values.
    pub parameters: [f64; P],
}

impl<S, const N: usize, const G: usize, const P: usize> ReadableSystem<N, G>
    for ValuedSystem<'_, S, P>
where
    S: NativeSystem<N, G, P>,
{
    type Mode = S::Mode;

    fn field<T: Number>(&self, mode: S::Mode, s: T, y: &[T; N]) -> [T; N] {
        self.system.field(mode, &self.parameters.map(T::from), s, y)
    }
    fn guards(&self, mode: S::Mode) -> [Guard; G] {
        self.system.guards(mode).map(|(_, guard)| guard)
    }
    fn guard_values<T: Number>(&self, mode: S::Mode, s: T, y: &[T; N]) -> [T; G] {
        self.system.guard_values(mode, &self.parameters.map(T::from), s, y)
    }
    fn transition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> (S::Mode, State<N>) {
        let jump = self.system.transition(mode, guard, &self.parameters, s, &y.data.0[0]);
        let other = jump.otherwise.filter(|(condition, _)| *condition < 0.0);
        (other.map_or(jump.mode, |(_, mode)| mode), jump.state.into())
    }
    fn transition_condition(&self, mode: S::Mode, guard: usize, s: f64, y: &State<N>) -> f64 {
        let jump = self.system.transition(mode, guard, &self.parameters, s, &y.data.0[0]);
        jump.otherwise.map_or(f64::NAN, |(condition, _)| condition)
    }
    fn schedule(&self, mode: S::Mode, guard: usize) -> Schedule<'_> {
        let clock = self.system.clock(mode, guard, &self.parameters);
        clock.map_or(Schedule::NEVER, |[period, phase]| Schedule::every(period, phase))
    }
}

/// Its runs have derivatives by the state
/// ([`sensitivities`](stickslip_solver::sensitivity::sensitivities)). Those by parameters are those
/// of its formulas.
impl<S, const N: usize, const G: usize, const P: usize> ReadableTransition<N, G>
    for ValuedSystem<'_, S, P>
where
    S: NativeSystem<N, G, P>,
{
    fn reset<T: Number>(&self, mode: S::Mode, guard: usize, s: T, y: &[T; N]) -> [T; N] {
        self.system.transition(mode, guard, &self.parameters.map(T::from), s, y).state
    }
}

impl System {
    /// A system of Rust as formulas. Its modes have the names that `Debug` gives them, or `main` if
    /// there is only one.
    ///
    /// # Errors
    /// [`InvalidValue`]: a transition leads to a mode that is not listed, or a clock has no period.
    pub fn of_native<S, const N: usize, const G: usize, const P: usize>(
        native: &S,
    ) -> Result<Self, InvalidValue>
    where
        S: NativeSystem<N, G, P>,
    {
        let graph = RefCell::new(Graph::default());
        let formula = |number: Recorded<'_>| number.formula(&graph);
        let recorded = |formula: Formula| Recorded::Formula(formula, &graph);
        let variable = |place: usize, parameter: bool| {
            // There are fewer than 2³².
            let place = u32::try_from(place).unwrap_or(u32::MAX);
            let mut graph = graph.borrow_mut();
            if parameter { graph.parameter(place) } else { graph.component(place) }
        };
        let parameters: [_; P] = std::array::from_fn(|place| recorded(variable(place, true)));
        let y: [_; N] = std::array::from_fn(|place| recorded(variable(place, false)));
        let time = graph.borrow_mut().time();
        let s = recorded(time);
        let modes = native.modes();
        let place = |mode: S::Mode| {
            let place = modes.iter().position(|it| *it == mode);
            place.ok_or_else(|| {
                let name = format!("{mode:?}");
                InvalidValue::new("the mode behind a transition", &*name, "a mode of the system")
            })
        };
        let rule = |mode: S::Mode, guard: usize, value: Recorded<'_>| {
            let (name, own) = native.guards(mode)[guard];
            let trigger = match own.direction() {
                Direction::Off => return Ok(None),
                Direction::Clock => {
                    let clock = native.clock(mode, guard, &parameters).ok_or_else(|| {
                        InvalidValue::new("the clock", name, "a guard with a period and a phase")
                    })?;
                    let [period, phase] = clock.map(formula);
                    Trigger::Every { period, phase }
                }
                direction => Trigger::When(formula(value), direction),
            };
            let jump = native.transition(mode, guard, &parameters, s, &y);
            let changes = jump.state.map(formula).into_iter().enumerate();
            let own_place = place(mode)?;
            let next = match (place(jump.mode)?, jump.otherwise) {
                (next, Some((condition, other))) => {
                    Next::Branch(formula(condition), next, place(other)?)
                }
                (next, None) if next == own_place => Next::Stay,
                (next, None) => Next::Mode(next),
            };
            Ok(Some(Rule {
                label: Some(name.to_owned()),
                priority: (i8::MIN..=i8::MAX).find(|it| own.priority(*it) == own).unwrap_or(0),
                sees_jumps: own.sees_jumps() == own,
                ends_after: own.fires_until_end(),
                from_zero: own.zero_order(),
                changes: changes.filter(|(k, it)| *it != formula(y[*k])).collect(),
                next,
                ..Rule::new(trigger)
            }))
        };
        let mode = |own: S::Mode| {
            let values = native.guard_values(own, &parameters, s, &y);
            let rules =
                values.into_iter().enumerate().filter_map(|(k, it)| rule(own, k, it).transpose());
            let name = if modes.len() == 1 { "main".to_owned() } else { format!("{own:?}") };
            let slopes = native.field(own, &parameters, s, &y).map(formula).to_vec();
            Ok(Mode { name, slopes, rules: rules.collect::<Result<_, InvalidValue>>()? })
        };
        let modes = modes.iter().map(|own| mode(*own)).collect::<Result<Vec<_>, InvalidValue>>()?;
        let components = native.components().map(|(name, start)| Component {
            name: name.to_owned(),
            start: formula(start.into()),
            discrete: false,
        });
        let named = native.parameters().map(|(name, value)| Parameter {
            name: name.to_owned(),
            value,
            range: None,
        });
        let (components, parameters) = (components.to_vec(), named.to_vec());
        Ok(Self { graph: graph.into_inner(), parameters, components, modes, ..Self::default() })
    }
}

/// A number of which a graph records how it is made. What is made of constants stays one.
#[derive(Clone, Copy, Debug)]
enum Recorded<'g> {
    Constant(f64),
    Formula(Formula, &'g RefCell<Graph>),
}

impl<'g> Recorded<'g> {
    fn formula(self, graph: &RefCell<Graph>) -> Formula {
        match self {
            Self::Constant(x) => graph.borrow_mut().constant(x),
            Self::Formula(formula, _) => formula,
        }
    }

    /// The graph of some numbers, unless all are constants.
    fn graph<const K: usize>(numbers: [Self; K]) -> Option<&'g RefCell<Graph>> {
        numbers.into_iter().find_map(|it| match it {
            Self::Constant(_) => None,
            Self::Formula(_, graph) => Some(graph),
        })
    }

    /// A number that is made of others: as doubles, or as formulas.
    fn of<const K: usize>(
        numbers: [Self; K],
        doubles: impl FnOnce([f64; K]) -> f64,
        formulas: impl FnOnce(&mut Graph, [Formula; K]) -> Formula,
    ) -> Self {
        match Self::graph(numbers) {
            None => Self::Constant(doubles(numbers.map(|it| match it {
                Self::Constant(x) => x,
                Self::Formula(..) => f64::NAN,
            }))),
            Some(graph) => {
                let operands = numbers.map(|it| it.formula(graph));
                Self::Formula(formulas(&mut graph.borrow_mut(), operands), graph)
            }
        }
    }

    fn unary(self, function: Unary) -> Self {
        Self::of([self], |[x]| function.of(x), |graph, [x]| graph.unary(function, x))
    }

    fn power(self, exponent: f64, double: impl FnOnce(f64) -> f64) -> Self {
        Self::of(
            [self],
            |[x]| double(x),
            |graph, [x]| {
                let exponent = graph.constant(exponent);
                graph.power(x, exponent)
            },
        )
    }

    fn binary(self, function: Binary, other: Self) -> Self {
        let doubles = |[x, y]: [f64; 2]| function.of(x, y);
        Self::of([self, other], doubles, |graph, [x, y]| graph.binary(function, x, y))
    }
}

impl From<f64> for Recorded<'_> {
    fn from(x: f64) -> Self {
        Self::Constant(x)
    }
}

impl Neg for Recorded<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Unary::Neg)
    }
}

/// Operators, with numbers of the same kind and with doubles.
macro_rules! operators {
    ($($name:ident $function:ident),*) => {$(
        impl $name for Recorded<'_> {
            type Output = Self;
            fn $function(self, other: Self) -> Self {
                self.binary(Binary::$name, other)
            }
        }
        impl $name<f64> for Recorded<'_> {
            type Output = Self;
            fn $function(self, other: f64) -> Self {
                self.binary(Binary::$name, other.into())
            }
        }
    )*};
}

operators!(Add add, Sub sub, Mul mul, Div div);

/// Functions of one number that graphs have under another name.
macro_rules! unary {
    ($($name:ident $function:ident),*) => {$(
        fn $name(self) -> Self {
            self.unary(Unary::$function)
        }
    )*};
}

#[rustfmt::skip]
impl Number for Recorded<'_> {
    unary!(floor Floor, abs Abs, sqrt Sqrt, exp Exp, exp_m1 ExpM1, ln Ln, ln_1p Ln1p);
    unary!(sin Sin, cos Cos, tan Tan, asin Asin, acos Acos, atan Atan);
    unary!(sinh Sinh, cosh Cosh, tanh Tanh, asinh Asinh, acosh Acosh, atanh Atanh, erf Erf);

    fn select(self, on_or_above: Self, below: Self) -> Self {
        let doubles = |[x, y, z]: [f64; 3]| x.select(y, z);
        Self::of([self, on_or_above, below], doubles, |graph, [x, y, z]| graph.select(x, y, z))
    }
    fn min(self, other: Self) -> Self {
        self.binary(Binary::Min, other)
    }
    fn max(self, other: Self) -> Self {
        self.binary(Binary::Max, other)
    }
    fn atan2(self, x: Self) -> Self {
        self.binary(Binary::Atan2, x)
    }
    fn powi(self, exponent: i32) -> Self {
        self.power(f64::from(exponent), |x| Number::powi(x, exponent))
    }
    fn powf(self, exponent: f64) -> Self {
        self.power(exponent, |x| Number::powf(x, exponent))
    }
}
