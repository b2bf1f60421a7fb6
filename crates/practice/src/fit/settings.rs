//! The settings of a fit.

use stickslip_model::spheres::Surface;
use stickslip_model::{Damping, InvalidValue, Law};
use stickslip_plane::Range;

use super::bodies::FittedBodies;
use super::data::{Datum, Measured};
use super::free::{Free, Ranges};

/// The data, and what is fitted to them.
#[derive(Clone, Debug, PartialEq)]
pub struct FitSettings {
    /// The bodies and their contact law. What is not fitted has their values.
    pub bodies: FittedBodies,
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

impl FitSettings {
    /// Most data.
    pub const MOST_DATA: usize = 10_000;
    /// Largest κ.
    pub const LARGEST_KAPPA: f64 = 1e4;

    /// A fit of κ and μ to `data`, with intervals at 0.95.
    pub fn new(bodies: FittedBodies, data: Vec<Datum>) -> Self {
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
    /// [`InvalidValue`] names the first that is out of its range, or contradicts another.
    pub fn validate(&self) -> Result<(), InvalidValue> {
        let count = self.data.len();
        if !(1..=Self::MOST_DATA).contains(&count) {
            return Err(Self::bad_count(count));
        }
        for datum in &self.data {
            valid(datum, self.bodies.are_scaled())?;
        }
        let accepted = (0.5..=0.9999).contains(&self.level);
        InvalidValue::check("level", self.level, "0.5 to 0.9999", accepted)?;
        let Surface { friction, tangential_stiffness_kg_per_s2, .. } = self.bodies.pair.surface;
        let above = "a finite number above 0";
        InvalidValue::check("mu", friction, above, friction > 0.0)?;
        let ok = tangential_stiffness_kg_per_s2 > 0.0 || !self.law().remembers();
        InvalidValue::check("kappa", tangential_stiffness_kg_per_s2, above, ok)?;
        self.valid_free()?;
        self.valid_damping()?;
        let stages = [(true, self.free.contains(&Free::Damping).into())];
        for (normal, free) in stages.into_iter().chain([(false, self.tangential().len())]) {
            let data = self.data_of(normal).count();
            if data < free {
                let of = if normal { "of eps_n" } else { "of the tangential motion" };
                let phrase = format!("data {of} for {free} free numbers");
                return Err(InvalidValue::phrase(
                    data.to_string(),
                    phrase,
                    "at least as many data",
                ));
            }
            if free > 0 {
                self.valid_errors(normal)?;
            }
        }
        Ok(())
    }

    pub(super) fn bad_count(count: usize) -> InvalidValue {
        InvalidValue::phrase(count.to_string(), "data", format!("1 to {}", Self::MOST_DATA))
    }

    fn valid_free(&self) -> Result<(), InvalidValue> {
        for (index, free) in self.free.iter().enumerate() {
            let name = free.name();
            if self.free[..index].contains(free) {
                return Err(InvalidValue::phrase(name, "is free twice", "different names"));
            }
            if *free == Free::Kappa && !self.bodies.pair.law.remembers() {
                let phrase = "is free, but the law has no spring";
                return Err(InvalidValue::phrase(name, phrase, "other free numbers"));
            }
            let Range { low, high } = self.ranges.of(*free);
            let (least, open, most) = match free {
                Free::Kappa => (0.0, true, Self::LARGEST_KAPPA),
                Free::Mu => (0.0, true, 100.0),
                Free::TangentialDamping | Free::Damping => (0.0, false, 100.0),
            };
            let above = if open { low > least } else { low >= least };
            if !(above && low < high && high <= most) {
                let phrase = format!("{low:?} to {high:?} of {name} cannot be used");
                let from = if open { "above" } else { "from" };
                let expected = format!("two rising numbers {from} 0, at most {most:?}");
                return Err(InvalidValue::phrase("the range", phrase, expected));
            }
        }
        if self.free.is_empty() || self.tangential().len() > 2 {
            let expected = "1 or 2 of kappa (or k_t), mu and tangential_damping, or damping";
            let (count, phrase) = (self.tangential().len(), "free numbers besides the damping");
            return Err(InvalidValue::phrase(count.to_string(), phrase, expected));
        }
        Ok(())
    }

    fn valid_damping(&self) -> Result<(), InvalidValue> {
        let law = self.bodies.pair.law;
        let free = self.free.contains(&Free::Damping);
        let damped = law.damping != Damping::None;
        if let Some(value) = self.eps_n {
            if free {
                let phrase = format!("= {value:?} decides the damping, which is free");
                return Err(InvalidValue::phrase("eps_n", phrase, "one of the two"));
            }
            let without = "1, since this law has no damping";
            let expected = if damped { Measured::EpsN.expected() } else { without };
            let accepted = Measured::EpsN.allows(value) && (damped || value == 1.0);
            InvalidValue::check("eps_n", value, expected, accepted)?;
        }
        if free && !damped {
            return Err(without_damping(Free::Damping));
        }
        if free && law.normal.is_adhesive() {
            let phrase = "is free, and with adhesion too much of it holds the bodies together";
            return Err(InvalidValue::phrase("damping", phrase, "a given damping"));
        }
        if free && self.ranges.damping.high >= law.endless_from() {
            let high = self.ranges.damping.high;
            let phrase = format!("up to {high:?} has contacts that never end");
            let expected = format!("a range below {:?}", law.endless_from());
            return Err(InvalidValue::phrase("damping", phrase, expected));
        }
        let elastic = match self.eps_n {
            Some(value) => value == 1.0,
            None => !free && self.bodies.pair.surface.damping_time_s == 0.0,
        };
        let dashpot = Free::TangentialDamping;
        if self.free.contains(&dashpot) && (!damped || elastic) {
            return Err(without_damping(dashpot));
        }
        Ok(())
    }

    /// All data of a stage have errors, or none has one and all are of one quantity.
    fn valid_errors(&self, normal: bool) -> Result<(), InvalidValue> {
        let data = || self.data_of(normal).map(|(_, datum)| datum);
        let with = data().filter(|datum| datum.error.is_some()).count();
        if with == 0 {
            let mut quantities: Vec<_> = data().map(|datum| datum.quantity.name()).collect();
            quantities.dedup();
            if let Some(other) = quantities.iter().find(|name| **name != quantities[0]) {
                let phrase = format!("and {other} have no errors");
                let expected =
                    "errors, which weigh one quantity against the other, or one quantity";
                return Err(InvalidValue::phrase(quantities[0], phrase, expected));
            }
        } else if let Some(datum) = data().find(|datum| datum.error.is_none()) {
            let name = format!("row {}: {}", datum.row, datum.quantity.name());
            let phrase = "has no error, and others have one";
            return Err(InvalidValue::phrase(name, phrase, "all errors, or none"));
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

fn without_damping(free: Free) -> InvalidValue {
    let phrase = "is free, but has no effect without damping";
    InvalidValue::phrase(free.name(), phrase, "a law with damping, and eps_n below 1")
}

fn valid(datum: &Datum, scaled: bool) -> Result<(), InvalidValue> {
    let Datum { row, normal_m_per_s, tangential_m_per_s, quantity, value, error } = *datum;
    let bad = |name: &str, value: f64, expected: &'static str| {
        Err(InvalidValue::new(format!("row {row}: {name}"), value, expected))
    };
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
            bad(&format!("{}_error", quantity.name()), error, "1e-12 to 1e12")
        }
        _ => Ok(()),
    }
}
