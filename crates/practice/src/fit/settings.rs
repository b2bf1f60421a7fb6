//! The settings of a fit.

use stickslip_model::{Damping, Law};
use stickslip_plane::Range;

use super::bodies::Bodies;
use super::data::{Datum, Measured};
use super::free::{Free, Ranges};

/// The data, and what is fitted to them.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The bodies and their contact law. What is not fitted has their values.
    pub bodies: Bodies,
    /// The data, at most [`Self::MOST_DATA`].
    pub data: Vec<Datum>,
    /// What is fitted: [`Free::Damping`], or up to two others, or both.
    pub free: Vec<Free>,
    /// Where it is looked for.
    pub ranges: Ranges,
    /// ε_n at normal incidence, which decides the damping instead of the bodies.
    pub eps_n: Option<f64>,
    /// The part of the cases in which the intervals hold the true value, from 0.5 to 0.9999.
    pub level: f64,
    /// Whether only the ratios of the errors are known. Their common factor is then estimated from
    /// the residuals, as it is where no datum has an error.
    pub relative_errors: bool,
}

impl Settings {
    /// Most data.
    pub const MOST_DATA: usize = 10_000;
    /// Largest κ.
    pub const LARGEST_KAPPA: f64 = 1e4;

    /// A fit of κ and μ to `data`, with intervals at 0.95.
    #[must_use]
    pub fn new(bodies: Bodies, data: Vec<Datum>) -> Self {
        let mut ranges = Ranges::default();
        // Beyond it contacts never end.
        ranges.damping.high = ranges.damping.high.min(0.99 * bodies.pair.law.endless_from());
        Self {
            bodies,
            data,
            free: vec![Free::Kappa, Free::Mu],
            ranges,
            eps_n: None,
            level: 0.95,
            relative_errors: false,
        }
    }

    /// The numbers that are fitted to the tangential motion.
    pub(super) fn tangential(&self) -> Vec<Free> {
        self.free.iter().copied().filter(|free| *free != Free::Damping).collect()
    }

    /// The data to which the damping is fitted, or the data of the tangential motion.
    pub(super) fn data_of(&self, normal: bool) -> impl Iterator<Item = (usize, &Datum)> + Clone {
        let data = self.data.iter().enumerate();
        data.filter(move |(_, datum)| (datum.quantity == Measured::EpsN) == normal)
    }

    /// Checks all settings.
    ///
    /// # Errors
    /// [`InvalidFit`] names the first that is out of its range.
    pub fn validate(&self) -> Result<(), InvalidFit> {
        let count = self.data.len();
        if count == 0 || count > Self::MOST_DATA {
            return Err(InvalidFit::Count { count });
        }
        for datum in &self.data {
            valid(datum, self.bodies.are_scaled())?;
        }
        if !(0.5..=0.9999).contains(&self.level) {
            return Err(InvalidFit::Level { value: self.level });
        }
        self.valid_free()?;
        self.valid_damping()?;
        let stages = [(true, self.free.contains(&Free::Damping).into())];
        for (normal, free) in stages.into_iter().chain([(false, self.tangential().len())]) {
            let data = self.data_of(normal).count();
            if data < free {
                return Err(InvalidFit::TooFew { data, free, normal });
            }
            if free > 0 {
                self.valid_errors(normal)?;
            }
        }
        Ok(())
    }

    fn valid_free(&self) -> Result<(), InvalidFit> {
        for (index, free) in self.free.iter().enumerate() {
            let name = free.name();
            if self.free[..index].contains(free) {
                return Err(InvalidFit::Twice { name });
            }
            let Range { low, high } = self.ranges.of(*free);
            let (least, open, most) = match free {
                Free::Kappa => (0.0, true, Self::LARGEST_KAPPA),
                Free::Mu => (0.0, true, 100.0),
                Free::TangentialDamping | Free::Damping => (0.0, false, 100.0),
            };
            let above = if open { low > least } else { low >= least };
            if !(above && low < high && high <= most) {
                return Err(InvalidFit::Range { name, low, high, most, open });
            }
        }
        if self.free.is_empty() || self.tangential().len() > 2 {
            return Err(InvalidFit::Free { count: self.tangential().len() });
        }
        Ok(())
    }

    fn valid_damping(&self) -> Result<(), InvalidFit> {
        let law = self.bodies.pair.law;
        let free = self.free.contains(&Free::Damping);
        let damped = law.damping != Damping::None;
        if let Some(value) = self.eps_n {
            if free {
                return Err(InvalidFit::DampingTwice { value });
            }
            let without = "1, since this law has no damping";
            let expected = if damped { Measured::EpsN.expected() } else { without };
            if !(Measured::EpsN.allows(value) && (damped || value == 1.0)) {
                return Err(InvalidFit::EpsN { value, expected });
            }
        }
        if free && !damped {
            return Err(InvalidFit::Undamped { name: Free::Damping.name() });
        }
        if free && self.ranges.damping.high >= law.endless_from() {
            return Err(InvalidFit::Endless {
                high: self.ranges.damping.high,
                most: law.endless_from(),
            });
        }
        let elastic = match self.eps_n {
            Some(value) => value == 1.0,
            None => !free && self.bodies.pair.surface.damping_time_s == 0.0,
        };
        let dashpot = Free::TangentialDamping;
        if self.free.contains(&dashpot) && (!damped || elastic) {
            return Err(InvalidFit::Undamped { name: dashpot.name() });
        }
        Ok(())
    }

    /// All data of a stage have errors, or none has one and all are of one quantity.
    fn valid_errors(&self, normal: bool) -> Result<(), InvalidFit> {
        let data = || self.data_of(normal).map(|(_, datum)| datum);
        let with = data().filter(|datum| datum.error.is_some()).count();
        if with == 0 {
            let mut quantities: Vec<_> = data().map(|datum| datum.quantity.name()).collect();
            quantities.dedup();
            if let Some(other) = quantities.iter().find(|name| **name != quantities[0]) {
                return Err(InvalidFit::Weights { first: quantities[0], second: other });
            }
        } else if let Some(datum) = data().find(|datum| datum.error.is_none()) {
            return Err(InvalidFit::NoError { row: datum.row, name: datum.quantity.name() });
        }
        Ok(())
    }

    /// Whether the size of the errors is estimated from the residuals of a stage.
    pub(super) fn estimates_errors(&self, normal: bool) -> bool {
        self.relative_errors || self.data_of(normal).all(|(_, datum)| datum.error.is_none())
    }

    pub(super) fn law(&self) -> Law {
        self.bodies.pair.law
    }
}

fn valid(datum: &Datum, scaled: bool) -> Result<(), InvalidFit> {
    let Datum { row, normal_m_per_s, tangential_m_per_s, quantity, value, error } = *datum;
    let bad = |name, value, expected| Err(InvalidFit::Datum { row, name, value, expected });
    if !(normal_m_per_s > 0.0 && normal_m_per_s.is_finite()) {
        return bad("normal_m_per_s", normal_m_per_s, "a finite number above 0");
    }
    let central = tangential_m_per_s == 0.0 && quantity == Measured::EpsN;
    if !(central || tangential_m_per_s > 0.0 && tangential_m_per_s.is_finite()) {
        let expected = "a finite number above 0, or 0 beside eps_n alone";
        return bad("tangential_m_per_s", tangential_m_per_s, expected);
    }
    if scaled && (datum.speed_m_per_s() - 1.0).abs() > 1e-9 {
        return bad("speed_m_per_s", datum.speed_m_per_s(), "1 where no bodies are known");
    }
    if scaled && quantity == Measured::Spin {
        return bad(quantity.name(), value, "none where no bodies are known");
    }
    if !quantity.allows(value) {
        return bad(quantity.name(), value, quantity.expected());
    }
    match error {
        Some(error) if !(1e-12..=1e12).contains(&error) => {
            Err(InvalidFit::Error { row, name: quantity.name(), error })
        }
        _ => Ok(()),
    }
}

/// Settings are out of range.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidFit {
    /// There are no data, or too many.
    #[error("{count} data; expected 1 to {}", Settings::MOST_DATA)]
    Count {
        /// The number of data.
        count: usize,
    },
    /// A datum is out of range.
    #[error("row {row}: {name} = {value:?} is out of range; expected {expected}")]
    Datum {
        /// Its row.
        row: usize,
        /// The name of the quantity.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range in words.
        expected: &'static str,
    },
    /// An error is out of range.
    #[error("row {row}: {name}_error = {error:?} is out of range; expected 1e-12 to 1e12")]
    Error {
        /// Its row.
        row: usize,
        /// The name of the quantity.
        name: &'static str,
        /// The error.
        error: f64,
    },
    /// Some data have errors, but not all.
    #[error("row {row}: {name} has no error, and others have one; expected all errors, or none")]
    NoError {
        /// The row of a datum without error.
        row: usize,
        /// The name of the quantity.
        name: &'static str,
    },
    /// Several quantities are fitted together without errors.
    #[error(
        "{first} and {second} have no errors; expected errors, which weigh one quantity against the \
         other, or one quantity"
    )]
    Weights {
        /// The name of a quantity.
        first: &'static str,
        /// The name of another one.
        second: &'static str,
    },
    /// There are fewer data than numbers to be fitted.
    #[error(
        "{data} data {} for {free} free numbers; expected at least as many data",
        if *normal { "of eps_n" } else { "of the tangential motion" }
    )]
    TooFew {
        /// The number of data.
        data: usize,
        /// The number of free numbers.
        free: usize,
        /// Whether these are data of ε_n.
        normal: bool,
    },
    /// Nothing is fitted, or too much.
    #[error(
        "{count} free numbers besides the damping; expected 1 or 2 of kappa (or k_t), mu and \
         tangential_damping, or damping"
    )]
    Free {
        /// How many there are besides the damping.
        count: usize,
    },
    /// A number is to be fitted twice.
    #[error("{name} is free twice; expected different names")]
    Twice {
        /// The name.
        name: &'static str,
    },
    /// A range is not an interval, or out of range.
    #[error(
        "the range {low:?} to {high:?} of {name} cannot be used; expected two rising numbers {} 0, \
         at most {most:?}",
        if *open { "above" } else { "from" }
    )]
    Range {
        /// The name of the number.
        name: &'static str,
        /// Its lower end.
        low: f64,
        /// Its upper end.
        high: f64,
        /// The largest upper end.
        most: f64,
        /// Whether 0 is left out.
        open: bool,
    },
    /// A damping is free where nothing is damped.
    #[error(
        "{name} is free, but has no effect without damping; expected a law with damping, and eps_n below 1"
    )]
    Undamped {
        /// The name.
        name: &'static str,
    },
    /// The range of the damping has contacts that never end.
    #[error("damping up to {high:?} has contacts that never end; expected a range below {most:?}")]
    Endless {
        /// The upper end of the range.
        high: f64,
        /// Where contacts stop to end.
        most: f64,
    },
    /// The damping is both given and fitted.
    #[error("eps_n = {value:?} decides the damping, which is free; expected one of the two")]
    DampingTwice {
        /// ε_n.
        value: f64,
    },
    /// ε_n is out of range.
    #[error("eps_n = {value:?} is out of range; expected {expected}")]
    EpsN {
        /// ε_n.
        value: f64,
        /// The range in words.
        expected: &'static str,
    },
    /// The level is out of range.
    #[error("level = {value:?} is out of range; expected 0.5 to 0.9999")]
    Level {
        /// The level.
        value: f64,
    },
}
