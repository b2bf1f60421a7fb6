//! Columns of measured impacts: their names, and the data in them.

use std::f64::consts::FRAC_PI_2;

use stickslip_model::InvalidValue;

use super::data::{Datum, Measured};

/// A named column, in which values may be missing.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredColumn {
    /// The name of a quantity with its unit, perhaps with `_error` at its end.
    pub name: String,
    /// A value for each row.
    pub values: Vec<Option<f64>>,
}

/// A quantity that a column may hold, with its unit in units of the fit.
#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    Angle(f64),
    Speed,
    Normal,
    Tangential,
    Measured(Measured, f64),
    Error(Measured, f64),
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

impl Meaning {
    /// The names of all columns except columns of errors.
    const NAMES: [(&'static str, Self); 11] = [
        ("centre_impact_angle_deg", Self::Angle(DEGREE)),
        ("centre_impact_angle_rad", Self::Angle(1.0)),
        ("speed_m_per_s", Self::Speed),
        ("normal_m_per_s", Self::Normal),
        ("tangential_m_per_s", Self::Tangential),
        ("eps_n", Self::Measured(Measured::EpsN, 1.0)),
        ("eps_t", Self::Measured(Measured::EpsT, 1.0)),
        ("centre_e_t", Self::Measured(Measured::CentreRestitution, 1.0)),
        ("spin_rad_per_s", Self::Measured(Measured::Spin, 1.0)),
        ("centre_rebound_angle_deg", Self::Measured(Measured::ReboundAngle, DEGREE)),
        ("centre_rebound_angle_rad", Self::Measured(Measured::ReboundAngle, 1.0)),
    ];

    fn find(name: &str) -> Option<Self> {
        let known = |name: &str| {
            Self::NAMES.iter().find(|(known, _)| *known == name).map(|(_, meaning)| *meaning)
        };
        known(name).or_else(|| match known(name.strip_suffix("_error")?)? {
            Self::Measured(quantity, unit) => Some(Self::Error(quantity, unit)),
            _ => None,
        })
    }

    /// Whether two columns would hold the same.
    fn clashes(self, other: Self) -> bool {
        match (self, other) {
            (Self::Angle(_), Self::Angle(_)) => true,
            (Self::Measured(a, _), Self::Measured(b, _))
            | (Self::Error(a, _), Self::Error(b, _)) => a == b,
            _ => self == other,
        }
    }
}

/// The data in `columns`; `rows` are the numbers of the rows, for messages and residuals.
///
/// An impact is given by an angle and a speed, which may be the same `speed_m_per_s` for all rows,
/// or by two velocities. Without bodies (`scaled`) all speeds are 1, and columns must not give
/// them.
///
/// ```
/// use stickslip_practice::fit::{MeasuredColumn, Measured, data};
///
/// let column = |name: &str, values: &[Option<f64>]| {
///     MeasuredColumn { name: name.to_owned(), values: values.to_vec() }
/// };
/// let columns = [
///     column("centre_impact_angle_deg", &[Some(30.0), Some(60.0)]),
///     column("centre_e_t", &[Some(0.7), None]),
///     column("spin_rad_per_s", &[Some(600.0), Some(400.0)]),
/// ];
/// let data = data(&columns, &[2, 3], Some(4.0), false)?;
/// assert_eq!(data.len(), 3);
/// assert_eq!((data[2].row, data[2].quantity, data[2].value), (3, Measured::Spin, 400.0));
/// assert!((data[2].normal_m_per_s - 2.0).abs() < 1e-12);
/// # Ok::<(), stickslip_model::InvalidValue>(())
/// ```
///
/// # Errors
/// [`InvalidValue`]: columns are missing, unknown or contradict each other, a row has no impact,
/// or an angle is out of range. Values of other quantities are checked by the fit.
pub fn data(
    columns: &[MeasuredColumn],
    rows: &[usize],
    speed_m_per_s: Option<f64>,
    scaled: bool,
) -> Result<Vec<Datum>, InvalidValue> {
    let mut known: Vec<(&MeasuredColumn, Meaning)> = Vec::new();
    for column in columns {
        let Some(meaning) = Meaning::find(&column.name) else {
            let quantities = Meaning::NAMES.map(|(name, _)| name).join(", ");
            return Err(InvalidValue::phrase(
                format!("column '{}'", column.name),
                "is unknown",
                format!("{quantities}, or one of the measured quantities with _error"),
            ));
        };
        if let Some((other, _)) = known.iter().find(|(_, other)| meaning.clashes(*other)) {
            let phrase = format!("'{}' and '{}' are both given", other.name, column.name);
            return Err(InvalidValue::phrase("the columns", phrase, "one of them"));
        }
        known.push((column, meaning));
    }
    let impacts = Impacts::new(&known, speed_m_per_s, scaled)?;
    let column = |meaning| known.iter().find(|(_, it)| *it == meaning).map(|(column, _)| *column);
    if let Some((column, _)) = known.iter().find(|(_, it)| {
        matches!(it, Meaning::Error(quantity, unit) if column(Meaning::Measured(*quantity, *unit)).is_none())
    }) {
        let name = format!("column '{}'", column.name);
        let phrase = "is given without its quantity";
        return Err(InvalidValue::phrase(name, phrase, "both, in the same unit"));
    }
    let mut data = Vec::new();
    for (index, &row) in rows.iter().enumerate() {
        for (found, meaning) in &known {
            let Meaning::Measured(quantity, unit) = *meaning else { continue };
            let at = |column: &MeasuredColumn| column.values.get(index).copied().flatten();
            let Some(value) = at(found) else { continue };
            if quantity == Measured::ReboundAngle && !quantity.allows(value * unit) {
                let expected = if unit == 1.0 {
                    "an angle between -π/2 and π/2"
                } else {
                    "an angle between -90 and 90 degrees"
                };
                return Err(InvalidValue::new(in_row(row, found), value, expected));
            }
            let (normal_m_per_s, tangential_m_per_s) = impacts.at(index, row)?;
            let error = column(Meaning::Error(quantity, unit)).and_then(at);
            data.push(Datum {
                row,
                normal_m_per_s,
                tangential_m_per_s,
                quantity,
                value: value * unit,
                error: error.map(|error| error * unit),
            });
        }
    }
    Ok(data)
}

/// Where the impact of a row is.
enum Impacts<'a> {
    Angle {
        angle: &'a MeasuredColumn,
        unit: f64,
        speed: Option<&'a MeasuredColumn>,
        all: Option<f64>,
    },
    Velocities {
        normal: &'a MeasuredColumn,
        tangential: &'a MeasuredColumn,
    },
}

impl<'a> Impacts<'a> {
    fn new(
        known: &[(&'a MeasuredColumn, Meaning)],
        all: Option<f64>,
        scaled: bool,
    ) -> Result<Self, InvalidValue> {
        let column = |meaning| known.iter().find(|(_, it)| *it == meaning).map(|(it, _)| *it);
        let angle = known.iter().find_map(|(column, meaning)| match meaning {
            Meaning::Angle(unit) => Some((*column, *unit)),
            _ => None,
        });
        let speed = column(Meaning::Speed);
        let velocities = (column(Meaning::Normal), column(Meaning::Tangential));
        let told = [speed, velocities.0, velocities.1].into_iter().flatten().next();
        if let (true, Some(column)) = (scaled, told) {
            let name = format!("column '{}'", column.name);
            let phrase = "has no meaning without bodies";
            return Err(InvalidValue::phrase(name, phrase, "angles alone"));
        }
        match (angle, velocities) {
            (Some((angle, unit)), (None, None)) => {
                let all = if scaled { Some(1.0) } else { all };
                if speed.is_some() == all.is_some() {
                    let how = if speed.is_some() { "is given twice" } else { "is missing" };
                    let expected = "either a column speed_m_per_s or one speed for all rows";
                    return Err(InvalidValue::phrase("the speed", how, expected));
                }
                Ok(Self::Angle { angle, unit, speed, all })
            }
            (None, (Some(normal), Some(tangential))) if speed.is_none() && all.is_none() => {
                Ok(Self::Velocities { normal, tangential })
            }
            _ => Err(InvalidValue::phrase(
                "no",
                "impact",
                "either the column centre_impact_angle_deg or centre_impact_angle_rad, or both \
                 normal_m_per_s and tangential_m_per_s without any speed",
            )),
        }
    }

    /// The normal and the tangential velocity of a row.
    fn at(&self, index: usize, row: usize) -> Result<(f64, f64), InvalidValue> {
        let number = |column: &MeasuredColumn| {
            let value = column.values.get(index).copied().flatten();
            let missing = || InvalidValue::phrase(in_row(row, column), "is missing", "a number");
            value.ok_or_else(missing)
        };
        match self {
            Self::Velocities { normal, tangential } => Ok((number(normal)?, number(tangential)?)),
            Self::Angle { angle, unit, speed, all } => {
                let value = number(angle)?;
                let radians = value * unit;
                if !(0.0..FRAC_PI_2).contains(&radians) {
                    let expected = if *unit == 1.0 {
                        "an angle from 0 to below π/2"
                    } else {
                        "an angle from 0 to below 90 degrees"
                    };
                    return Err(InvalidValue::new(in_row(row, angle), value, expected));
                }
                let speed = match (speed, all) {
                    (Some(column), _) => number(column)?,
                    (None, Some(speed)) => *speed,
                    (None, None) => f64::NAN,
                };
                Ok((speed * radians.cos(), speed * radians.sin()))
            }
        }
    }
}

fn in_row(row: usize, column: &MeasuredColumn) -> String {
    format!("row {row}: {}", column.name)
}
