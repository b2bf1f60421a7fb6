//! The fit itself: the model on a grid, and what is made of it with data.

use rayon::prelude::*;
use stickslip_model::restitution;
use stickslip_plane::progress::{Progress, Report};

use super::axis::Axis;
use super::bodies::{Units, Values};
use super::course::FittedCourse;
use super::data::{Datum, Measured};
use super::free::Free;
use super::intervals::{interval, threshold};
use super::local::{Bottom, different, of};
use super::normal;
use super::problem::{Problem, predicted_at};
use super::scan::{Line, Lines, candidates};
use super::settings::FitSettings;
use super::{Fit, FitError, Mindlin, Minimum, Residual, RootMeanSquare, SCHEMA};
use crate::time_steps::undamped_contact_time;

/// What the model says of the impacts at all places of the global search. Several sets of data of
/// the same impacts, as from simulated experiments, can be fitted with one survey.
#[derive(Clone, Debug)]
pub struct Survey {
    settings: FitSettings,
    units: Units,
    /// The damping of the fit.
    fixed: Values,
    damping: Option<normal::DampingFit>,
    problem: Problem,
    axes: Vec<Axis>,
    /// The predictions at each place of the first axis, and there at each place of the second.
    predicted: Vec<Vec<f64>>,
}

impl Survey {
    /// Computes the model at all places, on the threads of the current pool.
    ///
    /// # Errors
    /// [`FitError`]: the settings are out of range, or an impact cannot be computed.
    pub fn new(settings: &FitSettings, progress: Report<'_>) -> Result<Self, FitError> {
        settings.validate()?;
        let speed = settings.data.iter().map(Datum::speed_m_per_s).fold(0.0, f64::max);
        let units = settings.bodies.units(speed)?;
        let (damping, fit) = normal::damping(settings, &units)?;
        let fixed = Values { damping, ..settings.bodies.values(&units) };
        let data = settings.data_of(false).map(|(_, datum)| datum);
        let problem = Problem::new(settings.bodies, units, data);
        let phase = problem.steepest()? * undamped_contact_time(settings.law());
        let axis = |free: Free| Axis::new(free, settings.ranges.of(free), phase);
        let axes: Vec<Axis> = settings.tangential().into_iter().map(axis).collect();
        let mut survey = Self {
            settings: settings.clone(),
            units,
            fixed,
            damping: fit,
            problem,
            axes,
            predicted: Vec::new(),
        };
        survey.predict(progress)?;
        Ok(survey)
    }

    /// The fit of the settings' data.
    ///
    /// # Errors
    /// [`FitError`]: an impact cannot be computed.
    pub fn fit(&self) -> Result<Fit, FitError> {
        let Self { settings, problem, axes, units, .. } = self;
        let mut bottoms = Vec::new();
        let mut lines = Vec::new();
        for index in 0..axes.len() {
            let plane = self.lines(index);
            let found = self.all_lines(&plane, index)?;
            let starts = candidates(&found);
            let descended: Vec<_> =
                starts.into_par_iter().map(|start| plane.descend(start)).collect();
            bottoms.extend(descended.into_iter().collect::<Result<Vec<_>, _>>()?);
            lines.push(found);
        }
        let bottoms = match axes.len() {
            0 => vec![self.unfitted()?],
            _ => different(&self.lines(0), bottoms)?,
        };
        let data = problem.observed.len();
        let estimated_errors = settings.estimates_errors(false);
        let counts = (data, axes.len());
        let threshold = threshold(bottoms[0].misfit, settings.level, counts, estimated_errors);
        let mut intervals = Vec::new();
        for (index, found) in lines.iter().enumerate() {
            let plane = self.lines(index);
            let free = plane.outer.free;
            let minima = bottoms.iter().map(|it| (of(free, &it.values), it.misfit));
            intervals.push(interval(&plane, found, minima, threshold)?);
        }
        let minima: Result<Vec<_>, _> = bottoms.iter().map(|it| self.minimum(it)).collect();
        let minima = minima?;
        let mindlin = self.mindlin(threshold)?;
        let scaled = settings.bodies.are_scaled();
        intervals.extend(self.damping.iter().map(|fit| fit.interval.clone()));
        Ok(Fit {
            schema: SCHEMA,
            law: settings.law(),
            alpha: settings.bodies.pair.alpha,
            speed_m_per_s: (!scaled).then_some(units.speed_m_per_s),
            kappa_of_unit_stiffness: (!scaled).then_some(units.kappa),
            free: settings.free.clone(),
            ranges: settings.ranges,
            data,
            estimated_errors,
            level: settings.level,
            threshold,
            damping: self.damping.clone(),
            eps_n: self.eps_n()?,
            residuals: self.residuals(&minima[0].values)?,
            minima,
            intervals,
            mindlin,
            course: None,
        })
    }

    /// A fit with its course over the angle.
    pub(super) fn with_course(&self, fit: Fit) -> Result<Fit, FitError> {
        let FitSettings { bodies, data, .. } = &self.settings;
        let minima: Vec<Values> = fit.minima.iter().map(|minimum| minimum.values).collect();
        let course = FittedCourse::new(bodies, &self.units, data, &minima)?;
        Ok(Fit { course, ..fit })
    }

    /// The fit of other values measured of the same quantities of the same impacts with the same
    /// errors, in the order of the settings' data.
    ///
    /// # Errors
    /// [`FitError`]: there are more or fewer values than data, one is out of range, the damping is
    /// free, or an impact cannot be computed.
    pub fn fit_of(&self, values: &[f64]) -> Result<Fit, FitError> {
        let mut settings = self.settings.clone();
        if values.len() != settings.data.len() || self.damping.is_some() {
            return Err(FitSettings::bad_count(values.len()).into());
        }
        for (datum, value) in settings.data.iter_mut().zip(values) {
            datum.value = *value;
        }
        settings.validate()?;
        let data = settings.data_of(false).map(|(_, datum)| datum);
        let problem = Problem::new(settings.bodies, self.units, data);
        Self { settings, problem, ..self.clone() }.fit()
    }

    /// The misfit of the tangential motion with some values.
    ///
    /// # Errors
    /// [`FitError`]: an impact cannot be computed.
    pub fn misfit(&self, values: &Values) -> Result<f64, FitError> {
        self.problem.misfit_at(values)
    }

    fn predict(&mut self, progress: Report<'_>) -> Result<(), FitError> {
        let Some(outer) = self.axes.first() else { return Ok(()) };
        let none = [0.0];
        let inner = self.axes.get(1);
        progress(Progress::Begin { steps: outer.places.len() });
        let rows: Vec<Result<Vec<f64>, FitError>> = outer
            .places
            .par_iter()
            .map(|at| {
                let mut predicted = Vec::new();
                for other in inner.map_or(&none[..], |axis| &axis.places) {
                    let values = self.lines(0).values(*at, *other);
                    self.problem.predict(&values, &mut predicted)?;
                }
                progress(Progress::Advance { steps: 1 });
                Ok(predicted)
            })
            .collect();
        self.predicted = rows.into_iter().collect::<Result<_, _>>()?;
        Ok(())
    }

    /// The plane with one of the axes as the outer one.
    fn lines(&self, outer: usize) -> Lines<'_> {
        Lines {
            problem: &self.problem,
            fixed: self.fixed,
            outer: &self.axes[outer],
            inner: self.axes.get(1).map(|_| &self.axes[1 - outer]),
        }
    }

    /// The lines at all places of the outer axis.
    fn all_lines(&self, plane: &Lines<'_>, outer: usize) -> Result<Vec<Line>, FitError> {
        let count = self.problem.observed.len();
        let misfit = |first: usize, second: usize| {
            let row = &self.predicted[first];
            self.problem.misfit(&row[second * count..(second + 1) * count])
        };
        let others = plane.inner.map_or(1, |axis| axis.places.len());
        let places: Vec<(usize, f64)> = plane.outer.places.iter().copied().enumerate().collect();
        let lines: Vec<Result<Line, FitError>> = places
            .into_par_iter()
            .map(|(index, at)| {
                let misfits = (0..others).map(|other| {
                    if outer == 0 { misfit(index, other) } else { misfit(other, index) }
                });
                plane.line_of(at, &misfits.collect::<Vec<f64>>())
            })
            .collect();
        lines.into_iter().collect()
    }

    /// ε_n at normal incidence.
    fn eps_n(&self) -> Result<f64, FitError> {
        let FitSettings { bodies, .. } = &self.settings;
        if bodies.pair.law.normal.is_adhesive() {
            return predicted_at(bodies, &self.units, &self.fixed, Measured::EpsN, 0.0);
        }
        Ok(restitution::eps_n(bodies.pair.law, self.fixed.damping)?)
    }

    fn unfitted(&self) -> Result<Bottom, FitError> {
        let misfit = self.problem.misfit_at(&self.fixed)?;
        Ok(Bottom { values: self.fixed, misfit, at_end: false })
    }

    fn minimum(&self, bottom: &Bottom) -> Result<Minimum, FitError> {
        let Bottom { values, misfit, at_end } = *bottom;
        let residuals = self.residuals(&values)?;
        let mean_square = |quantity: Measured| {
            let squares = residuals.iter().filter(|it| it.datum.quantity == quantity);
            let squares: Vec<f64> = squares.map(|it| it.residual.powi(2)).collect();
            let data = squares.len();
            let value = (squares.iter().sum::<f64>() / data as f64).sqrt();
            (data > 0).then_some(RootMeanSquare { quantity, data, value })
        };
        let scaled = self.settings.bodies.are_scaled();
        Ok(Minimum {
            values,
            stiffness: (!scaled).then_some(values.kappa / self.units.kappa),
            misfit,
            root_mean_squares: Measured::ALL.into_iter().filter_map(mean_square).collect(),
            at_end_of_range: at_end,
        })
    }

    fn residuals(&self, values: &Values) -> Result<Vec<Residual>, FitError> {
        let data = &self.settings.data;
        let problem = Problem::new(self.settings.bodies, self.units, data.iter());
        let mut predicted = Vec::with_capacity(data.len());
        problem.predict(values, &mut predicted)?;
        let residual = |(datum, predicted): (&Datum, f64)| Residual {
            datum: *datum,
            predicted,
            residual: datum.value - predicted,
        };
        Ok(data.iter().zip(predicted).map(residual).collect())
    }

    /// The best fit with Mindlin's stiffness, if the stiffness is free.
    fn mindlin(&self, threshold: Option<f64>) -> Result<Option<Mindlin>, FitError> {
        let Some(index) = self.axes.iter().position(|axis| axis.free == Free::Kappa) else {
            return Ok(None);
        };
        let Some(kappa) = self.settings.bodies.mindlin_kappa(&self.units) else {
            return Ok(None);
        };
        let plane = self.lines(index);
        let at = plane.outer.coordinate(kappa);
        let best = plane.line(at)?.best();
        let values = plane.values(at, best.at);
        let bottom = Bottom { values, misfit: best.misfit, at_end: false };
        let (low, high) = plane.outer.ends();
        let inside = (low..=high).contains(&at);
        let excluded = threshold.filter(|_| inside).map(|threshold| best.misfit > threshold);
        Ok(Some(Mindlin { best: self.minimum(&bottom)?, excluded }))
    }
}
