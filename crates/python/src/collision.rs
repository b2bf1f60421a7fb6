//! One collision.

use std::ops::Range;
use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use stickslip_figure::pictures;
use stickslip_files::FileError;
use stickslip_files::output::file::publish;
use stickslip_files::output::picture::AnimationFile;
use stickslip_model::document::COLLISION;
use stickslip_model::history::{History, Snapshot};
use stickslip_model::sensitivity::Derived;
use stickslip_model::{Collider, Contact, Engine};
use stickslip_plane::progress::{Progress, Report};
use stickslip_solver::Statistics;

use crate::arrays::numbers;
use crate::background::watched;
use crate::engines::{Choice, LawChoice, document};
use crate::failure::{Failure, bad_input};
use crate::parallel::Threads;

/// A collision with what computed it.
#[pyclass(frozen, module = "stickslip._native")]
pub struct Collision {
    result: stickslip_model::Collision,
    engine: Engine,
    statistics: Option<Statistics>,
}

#[pymethods]
impl Collision {
    #[new]
    fn new(
        py: Python<'_>,
        kappa: f64,
        psi: f64,
        damping: f64,
        engine: Choice,
        law: LawChoice,
    ) -> PyResult<Self> {
        let (law, tangential_damping) = law.law()?;
        let engine = engine.engine((law, tangential_damping))?;
        let contact = Contact::new(kappa, psi, damping)
            .and_then(|contact| contact.with_law(law, tangential_damping))
            .map_err(Failure::from)?;
        let place = || format!("kappa = {kappa:?}, psi = {psi:?}, damping = {damping:?}: ");
        let (result, statistics) = py
            .detach(|| engine.collide(contact))
            .map_err(|error| Failure::from(error).exception(&place()))?;
        Ok(Self { result, engine, statistics })
    }

    /// The collision as the JSON that the program prints.
    fn json(&self) -> PyResult<String> {
        document(COLLISION, &self.result, &self.engine, self.statistics.as_ref())
    }

    /// The error of ε_t to expect, and the distance from other switches.
    fn estimate(&self, py: Python<'_>) -> PyResult<(f64, f64, bool)> {
        let found = py.detach(|| self.engine.estimate(&self.result)).map_err(Failure::from)?;
        Ok((found.eps_t_error, found.distance, found.certain))
    }

    /// The course at `times`, a row for each; NaN outside the contact. Without times, a number of
    /// moments of each phase.
    fn history<'py>(
        &self,
        py: Python<'py>,
        times: Option<PyReadonlyArray1<'py, f64>>,
        moments: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if moments == 0 {
            return Err(bad_input("moments = 0; expected at least 1"));
        }
        let times = times.map(|times| numbers(&times)).transpose()?;
        let history = py.detach(|| self.course()).map_err(Failure::from)?;
        let rows: Vec<[f64; 8]> = match times {
            Some(times) => {
                // The course may end a rounding before the contact does.
                let (end, contact_time) = (history.duration(), self.result.contact_time);
                let at = |time: f64| {
                    let within = if time <= contact_time { time.min(end) } else { time };
                    let moment = history.at(within).map(|moment| Snapshot { time, ..moment });
                    moment.map_or(outside(time), |moment| row(&moment))
                };
                let part =
                    |part: Range<usize>| times[part].iter().copied().map(at).collect::<Vec<_>>();
                let mut rows = Vec::with_capacity(times.len());
                Threads::new(1, times.len())?.each(py, times.len(), part, |part| {
                    rows.extend(part);
                    Ok(())
                })?;
                rows
            }
            None => history
                .phases()
                .flat_map(|phase| phase.samples(moments).map(|one| row(&one)).collect::<Vec<_>>())
                .collect(),
        };
        let count = rows.len();
        rows.into_flattened().into_pyarray(py).reshape([count, 8])
    }

    /// Derivatives of ε_n, ε_t, w, the contact time and the times of switches: a row for each, with
    /// its value and its derivatives with respect to κ, ψ and damping.
    fn sensitivity(&self, py: Python<'_>) -> PyResult<Vec<[f64; 4]>> {
        let contact = self.result.contact;
        let found =
            py.detach(|| Collider::default().sensitivity(contact)).map_err(Failure::from)?;
        let rows = [found.eps_n, found.eps_t, found.final_velocity, found.contact_time];
        Ok(rows.iter().chain(&found.switch_times).map(derivatives).collect())
    }

    /// The picture as SVG.
    fn picture(&self, py: Python<'_>) -> PyResult<String> {
        let history = py.detach(|| self.course()).map_err(Failure::from)?;
        Ok(pictures::collision::draw(&self.result, &history).document())
    }

    /// Writes the same picture as it comes into being, as GIF or MP4.
    fn animate(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let file = AnimationFile::new(path).map_err(PyValueError::new_err)?;
        let unwritten = |error: FileError| PyOSError::new_err(error.to_string());
        file.probe().map_err(unwritten)?;
        let history = py.detach(|| self.course()).map_err(Failure::from)?;
        let collision = self.result.clone();
        let work = move |report: Report<'_>| {
            let frames = pictures::collision::frames(&collision, &history);
            // Abandoned work ends between two pictures.
            publish([file.write(frames.inspect(|_| report(Progress::Advance { steps: 0 })))?])
        };
        watched(py, 1, None, work)?.map_err(unwritten)
    }
}

impl Collision {
    fn course(&self) -> Result<History, stickslip_model::CollisionError> {
        self.engine.history(self.result.contact)
    }
}

fn row(moment: &Snapshot) -> [f64; 8] {
    let Snapshot {
        time,
        compression,
        normal_velocity,
        normal_force,
        spring,
        tangential_force,
        limit,
        velocity,
        ..
    } = *moment;
    [time, compression, normal_velocity, normal_force, spring, tangential_force, velocity, limit]
}

/// A moment at which there is no contact.
fn outside(time: f64) -> [f64; 8] {
    let mut row = [f64::NAN; 8];
    row[0] = time;
    row
}

fn derivatives(quantity: &Derived) -> [f64; 4] {
    [quantity.value, quantity.kappa, quantity.psi, quantity.damping]
}
