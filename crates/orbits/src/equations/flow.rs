//! The smooth flow of a mode, with its derivatives: rules are not consulted.

use nalgebra::DMatrix;
use stickslip_expression::{Graph, Inputs, Program, System, Variable};
use stickslip_solver::dynamic::{
    DynamicDense, DynamicObserver, DynamicStart, DynamicSystem, run_dynamic,
};
use stickslip_solver::{Dop853, Guard, Options, RunError};

/// The equations of a mode together with their variational equations.
#[derive(Clone, Debug)]
pub(crate) struct Flow {
    program: Program,
    n: usize,
    columns: usize,
}

/// Where a flow leads.
#[derive(Clone, Debug)]
pub(crate) struct Flown {
    /// The state.
    pub state: Vec<f64>,
    /// Its derivatives by the state at the start, by the time at the start, and by parameters.
    pub by: DMatrix<f64>,
}

impl Flow {
    /// The flow of a mode, with derivatives by some parameters.
    pub fn new(graph: &mut Graph, system: &System, mode: usize, active: &[usize]) -> Self {
        let n = system.components.len();
        let slopes = &system.modes[mode].slopes;
        let columns = n + 1 + active.len();
        let mut formulas = slopes.clone();
        for column in 0..columns {
            let zero = graph.constant(0.0);
            for &slope in slopes {
                formulas.push(graph.slope(slope, &mut |graph, variable| match variable {
                    Variable::Component(place) => {
                        graph.component(narrow(n * (column + 1)).saturating_add(place))
                    }
                    Variable::Time if column == n => graph.constant(1.0),
                    Variable::Parameter(place)
                        if column > n && active[column - n - 1] == place as usize =>
                    {
                        graph.constant(1.0)
                    }
                    _ => zero,
                }));
            }
        }
        let components = n * (columns + 1);
        let inputs = Inputs { components, parameters: system.parameters.len(), fixed: true };
        Self { program: Program::compile(graph, &formulas, inputs), n, columns }
    }

    /// Where `state` is after a duration, which may be negative.
    pub fn run(
        &self,
        parameters: &[f64],
        (s, state): (f64, &[f64]),
        duration: f64,
        options: &Options,
    ) -> Result<Flown, RunError> {
        self.watched(parameters, (s, state), duration, options, &mut ())
    }

    /// As [`Self::run`], with the largest sizes of components on the way, where they exceed those
    /// that are given.
    pub fn measure(
        &self,
        parameters: &[f64],
        start: (f64, &[f64]),
        duration: f64,
        options: &Options,
        sizes: &mut [f64],
    ) -> Result<(), RunError> {
        enlarge(sizes, start.1);
        let end = self.watched(parameters, start, duration, options, &mut Largest(sizes))?;
        enlarge(sizes, &end.state);
        Ok(())
    }

    fn watched(
        &self,
        parameters: &[f64],
        (s, state): (f64, &[f64]),
        duration: f64,
        options: &Options,
        observer: &mut impl DynamicObserver<()>,
    ) -> Result<Flown, RunError> {
        let Self { n, columns, .. } = *self;
        let mut all = vec![0.0; n * (columns + 1)];
        all[..n].copy_from_slice(state);
        for place in 0..n {
            all[n + n * place + place] = 1.0;
        }
        let length = duration.abs();
        if length > 0.0 || !length.is_finite() {
            let (program, direction) = (self.program.with(parameters), duration.signum());
            let along = Along { program, origin: s, direction };
            let start = DynamicStart { mode: (), s: 0.0, state: &all };
            let end = run_dynamic(Dop853, &along, start, length, options, observer)?;
            all = end.finished()?.state;
        }
        let by = DMatrix::from_column_slice(n, columns, &all[n..]);
        all.truncate(n);
        Ok(Flown { state: all, by })
    }
}

/// A flow in one direction, from the time 0.
struct Along {
    program: Program,
    origin: f64,
    direction: f64,
}

impl DynamicSystem for Along {
    type Mode = ();

    fn field(&self, (): (), s: f64, y: &[f64], slope: &mut [f64]) {
        self.program.run(self.origin + self.direction * s, y, slope);
        if self.direction < 0.0 {
            for slope in slope {
                *slope = -*slope;
            }
        }
    }
    fn guards(&self, (): ()) -> &[Guard] {
        &[]
    }
    fn guard_values(&self, (): (), _: f64, _: &[f64], _: &mut [f64]) {}
}

/// Sizes of components that are no less than those of a state.
pub(crate) fn enlarge(sizes: &mut [f64], state: &[f64]) {
    for (size, value) in sizes.iter_mut().zip(state) {
        *size = size.max(value.abs());
    }
}

/// The largest sizes of components at steps.
struct Largest<'a>(&'a mut [f64]);

impl DynamicObserver<()> for Largest<'_> {
    const WANTS_SEGMENTS: bool = true;

    fn on_segment(&mut self, (): (), dense: &DynamicDense<'_>) {
        enlarge(self.0, dense.coefficients());
    }
}

/// A place as formulas have it. There are fewer than 2³².
pub(crate) fn narrow(place: usize) -> u32 {
    u32::try_from(place).unwrap_or(u32::MAX)
}
