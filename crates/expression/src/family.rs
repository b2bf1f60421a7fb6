//! A system and two of its parameters, as a family of runs whose boundaries can be traced.

mod align;
mod values;

use std::borrow::Cow;

use stickslip_solver::margin::Margin;
use stickslip_solver::{Dop853, InvalidValue, Options, RunError};
use stickslip_tracer::{
    Accumulation, Family, FreeRun, Point, Window,
    hybrid::{DynamicFamily, DynamicFired, DynamicProblem, DynamicSetting, FamilyError, Itinerary},
};

pub use align::RuleOrder;

use crate::compiled::Compiled;
use crate::run::Runnable;
use crate::system::{Mode, Next, Rule, System, Trigger};

/// A system whose runs depend on two of its parameters.
///
/// Itineraries count rules by their places in [`Self::rules`]. The method is [`Dop853`]. Where no
/// run starts, a condition does not hold: one that the system [requires](System::required), or,
/// counted behind those, that a start has a value, such as that what is under a square root is not
/// negative.
///
/// ```
/// use stickslip_expression::{System, SystemFamily};
/// use stickslip_solver::Options;
/// use stickslip_tracer::{Family, Point, hybrid::Itinerary};
///
/// let system = System::parse(
///     "parameter height = 1, e = 0.5\nstate x = height, v = 0\nx' = v\nv' = -1\n\
///      when x < 0 \"floor\"\n  x := 0\n  v := -e*v\nend = 2.4",
/// )?;
/// let family = SystemFamily::new(&system, [0, 1], &system.values(), None, Options::default())?;
/// assert_eq!(family.rules(), ["floor"]);
/// // The second bounce comes after (1 + 2e)·√(2·height).
/// assert_eq!(family.label(&Point::new(1.0, 0.3))?, Itinerary::Fires(vec![0, 0]));
/// assert_eq!(family.label(&Point::new(1.0, 0.4))?, Itinerary::Fires(vec![0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SystemFamily {
    runs: DynamicFamily<Plane, Dop853>,
    rules: Vec<String>,
}

/// The systems of a plane of parameters.
#[derive(Clone, Debug)]
struct Plane {
    compiled: Compiled,
    parameters: Vec<f64>,
    axes: [usize; 2],
    end: Option<f64>,
}

impl DynamicProblem for Plane {
    type System = Runnable;

    fn at(&self, point: &Point) -> Option<DynamicSetting<Runnable>> {
        let parameters = self.parameters_at(point);
        // Where a start or a period is not a number, there is no run.
        let system = self.compiled.where_it_may(&parameters).ok()?;
        let start = system.start();
        let (mode, s, state) = (start.mode, start.s, start.state.to_vec());
        let end = self.end.unwrap_or(system.end());
        (end > s).then_some(DynamicSetting { system, mode, s, state, end })
    }

    fn conditions(&self, point: &Point) -> Vec<f64> {
        self.compiled.rooms(&self.parameters_at(point))
    }
}

impl Plane {
    fn parameters_at(&self, point: &Point) -> Vec<f64> {
        let mut parameters = self.parameters.clone();
        for (&axis, value) in self.axes.iter().zip([point.x, point.y]) {
            parameters[axis] = value;
        }
        parameters
    }
}

impl SystemFamily {
    /// The family over the parameters at the places `axes`. The other ones have the values in
    /// `parameters`. All runs end at `end`, if it is given.
    ///
    /// # Errors
    /// [`InvalidValue`] if there are not as many parameters as the system has, if one is not
    /// finite, if an axis is none of them or both are the same, or if the first mode depends on
    /// one by several conditions, or beside rules that act at given times.
    pub fn new(
        system: &System,
        axes: [usize; 2],
        parameters: &[f64],
        end: Option<f64>,
        options: Options,
    ) -> Result<Self, InvalidValue> {
        Self::ordered(system, RuleOrder::of(system), axes, parameters, (end, options))
    }

    /// As [`Self::new`], with an order of rules.
    ///
    /// # Errors
    /// As [`Self::new`], or the order is not one of the rules of the system.
    pub fn ordered(
        system: &System,
        order: RuleOrder,
        axes: [usize; 2],
        parameters: &[f64],
        (end, options): (Option<f64>, Options),
    ) -> Result<Self, InvalidValue> {
        if !order.fits(system) {
            let expected = "a place for each rule of each mode";
            let count = order.names.len();
            return Err(InvalidValue::new("the number of rules in order", count, expected));
        }
        let by_axes = axes.iter().find_map(|&axis| system.require_one_first_mode(axis).err());
        let (system, order) = match by_axes {
            None => (Cow::Borrowed(system), order),
            Some(refusal) => {
                let (system, order) = chosen(system, order).ok_or(refusal)?;
                (Cow::Owned(system), order)
            }
        };
        // Sequences are those of rules alone.
        let mut aligned = order.align(&system);
        values::require_values(&mut aligned);
        let compiled = aligned.compile_as_it_is()?;
        let rules = order.names;
        compiled.check(parameters)?;
        let count = parameters.len();
        if let Some(&axis) = axes.iter().find(|&&axis| axis >= count || axes[0] == axes[1]) {
            let expected = "two different parameters of the system";
            return Err(InvalidValue::new("the place of an axis", axis, expected));
        }
        let problem = Plane { compiled, parameters: parameters.to_vec(), axes, end };
        Ok(Self { runs: DynamicFamily { problem, method: Dop853, options }, rules })
    }

    /// The names of the rules, in the order in which itineraries count them. Rules of several modes
    /// that have one label are one.
    #[must_use]
    pub fn rules(&self) -> &[String] {
        &self.rules
    }

    /// The values of the parameters; those of the axes are not used.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.runs.problem.parameters
    }

    /// The same family with another value of a parameter, which should not be an axis. A place that
    /// is no parameter changes nothing.
    #[must_use]
    pub fn with(&self, parameter: usize, value: f64) -> Self {
        let mut other = self.clone();
        if let Some(own) = other.runs.problem.parameters.get_mut(parameter) {
            *own = value;
        }
        other
    }

    /// The same family, in which runs are told apart up to so many events.
    #[must_use]
    pub fn up_to(mut self, events: usize) -> Self {
        self.runs.options.max_switches = events;
        self
    }

    /// The events up to which runs in a window should be told apart, if events accumulate in some
    /// of them; `None` if this is seen nowhere.
    ///
    /// ```
    /// use stickslip_expression::{System, SystemFamily};
    /// use stickslip_solver::Options;
    /// use stickslip_tracer::{Point, Window};
    ///
    /// let ball = System::parse(include_str!("../../../examples/systems/ball.slip"))?;
    /// let axes = ["e", "g"].map(|name| {
    ///     ball.parameters.iter().position(|parameter| parameter.name == name).expect("known")
    /// });
    /// let values: Vec<f64> = ball.parameters.iter().map(|parameter| parameter.value).collect();
    /// let family = SystemFamily::new(&ball, axes, &values, None, Options::default())?;
    /// let window = Window { low: Point::new(0.3, 5.0), high: Point::new(0.7, 15.0) };
    /// let few = family.accumulation(&window).expect("bounces accumulate");
    /// assert!((4..=12).contains(&few.events) && few.runs > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn accumulation(&self, window: &Window) -> Option<Accumulation> {
        Accumulation::seen(&self.clone().up_to(Accumulation::EVENTS), window)
    }

    /// The run at `point`; `None` if there is none.
    ///
    /// # Errors
    /// The error of a run that fails.
    pub fn run(&self, point: &Point) -> Result<Option<DynamicFired<usize>>, RunError> {
        self.runs.run(point)
    }
}

impl Family for SystemFamily {
    type Label = Itinerary;
    type Margin = Margin;
    type Error = FamilyError;

    fn label(&self, point: &Point) -> Result<Itinerary, FamilyError> {
        self.runs.label(point)
    }
    fn margin(&self, point: &Point, which: &Margin) -> Result<Option<f64>, FamilyError> {
        self.runs.margin(point, which)
    }
    fn moved(&self, point: &Point, which: &Margin) -> Result<Margin, FamilyError> {
        self.runs.moved(point, which)
    }
    fn is_sure(&self, margin: &Margin) -> bool {
        self.runs.is_sure(margin)
    }
    fn free_run(&self, point: &Point) -> Result<FreeRun<Itinerary, Margin>, FamilyError> {
        self.runs.free_run(point)
    }
}

/// The system with a mode in front of the first ones, whose rule `start` leads to one of them by
/// the condition: so the condition has a margin, as that of every transition. `None` if there are
/// several conditions, rules at given times, which would not count at the start, or sides of
/// several surfaces to be decided there.
fn chosen(system: &System, mut order: RuleOrder) -> Option<(System, RuleOrder)> {
    let &[(condition, other)] = &system.otherwise[..] else { return None };
    let is_clock = |rule: &Rule| !matches!(rule.trigger, Trigger::When(..));
    let is_decided = |mode: usize| system.slides.iter().any(|slide| slide.first == mode);
    let has_clocks = system.modes.iter().flat_map(|mode| &mode.rules).any(is_clock);
    if has_clocks || is_decided(system.first) || is_decided(other) {
        return None;
    }
    let mut chosen = system.clone();
    let graph = &mut chosen.graph;
    let (zero, start) = (graph.constant(0.0), system.start);
    let start = start.unwrap_or(zero);
    let mut rule = Rule::new(Trigger::At(vec![start]));
    rule.next = Next::Branch(condition, system.first, other);
    let slopes = vec![zero; system.components.len()];
    chosen.modes.push(Mode { name: "start".to_owned(), slopes, rules: vec![rule] });
    (chosen.first, chosen.otherwise) = (system.modes.len(), Vec::new());
    let mut name = "start".to_owned();
    while order.names.contains(&name) {
        name.push('_');
    }
    order.places.push(vec![order.names.len()]);
    order.names.push(name);
    Some((chosen, order))
}
