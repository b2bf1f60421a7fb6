//! The damping with which a contact law has a coefficient of normal restitution.
//!
//! The normal motion depends on nothing else: neither on the tangential spring nor on friction.
//! ε_n falls with the scaled damping a from 1 on. Where force and damping are both linear, or the
//! force is Hertz' and the damping Tsuji's, a does not depend on the velocity; for all other laws
//! ε_n belongs to one normal velocity.

use std::cell::Cell;
use std::f64::consts::PI;

use stickslip_contact::numerics::root::crossing;
use stickslip_contact::{Contact, ContactEnd, Damping, InvalidValue, Law, Normal, presets};

use crate::engines::Engine;
use crate::engines::error::CollisionError;

/// Whether ε_n of the law depends on the velocity: the same damping constant is another scaled
/// damping a.
pub fn depends_on_velocity(law: Law) -> bool {
    match law.damping {
        Damping::None | Damping::Hysteretic => false,
        Damping::Hardening | Damping::Yielding => true,
        _ => critical_damping(law).is_none(),
    }
}

/// The scaled damping a of a contact whose damping ratio ζ is 1: 2 where force and damping are
/// linear, and √5 where the force is Hertz' and the damping Tsuji's. `None` for other laws.
///
/// With this ζ = a/a(1), as particle codes define it, a contact that lasts until x = 0 has
/// ζ = −ln ε_n/√(π² + ln² ε_n), in both cases.
///
/// Source: Antypov and Elliott, EPL 94, 50004 (2011).
pub fn critical_damping(law: Law) -> Option<f64> {
    match (law.normal, law.damping) {
        (Normal::Linear, Damping::Linear) => Some(2.0),
        (Normal::Hertz, Damping::Tsuji) => Some(5.0_f64.sqrt()),
        _ => None,
    }
}

/// Whether a contact lasts until x = 0 with a force that may attract.
fn attracts(law: Law) -> bool {
    law.end == ContactEnd::Overlap && !law.limit_damping
}

/// ε_n of a law with the scaled damping a: in closed form for linear and hysteretic forces and
/// where a contact with Tsuji's damping of Hertz' force lasts until x = 0, otherwise by
/// [`Engine::Auto`].
///
/// ```
/// use stickslip_model::{presets, restitution};
///
/// // The damping ratio 0.1 of a linear force.
/// let law = presets::find("gran/hooke/history").ok_or("no such law")?.law;
/// assert!((restitution::eps_n(law, 0.2)? - 0.729247614287).abs() < 1e-11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CollisionError`]: the damping is out of its range, the law has adhesion, or the contact cannot
/// be computed.
pub fn eps_n(law: Law, damping: f64) -> Result<f64, CollisionError> {
    law.require_no_adhesion("e_n of a damping is")?;
    // The normal motion does not depend on κ and ψ. At κψ = 1 and the like, spring and limit of
    // some laws begin alike, which cannot be integrated.
    let contact = Contact::new(1.1, 0.3, damping)?.with_law(law, 0.0)?;
    if let Some(e_n) = law.hysteretic_e_n(damping) {
        return Ok(e_n);
    }
    if let (Some(critical), true) = (critical_damping(law), attracts(law)) {
        let ratio = damping / critical;
        return Ok((-PI * ratio / (1.0 - ratio * ratio).sqrt()).exp());
    }
    if (law.normal, law.damping) == (Normal::Linear, Damping::Linear) {
        return Ok(until_zero_force(0.5 * damping));
    }
    let (collision, _) = Engine::Auto.collide(contact)?;
    Ok(collision.eps_n)
}

/// ε_n of a linear force with the damping ratio ζ, if the contact ends at F = 0 or the force does
/// not attract.
///
/// Source: Schwager and Pöschel, Granular Matter 9, 465 (2007).
fn until_zero_force(ratio: f64) -> f64 {
    let root = (1.0 - ratio * ratio).abs().sqrt();
    // From there on both quotients are their limits at ζ = 1, to within rounding.
    let angle = if root < 1e-8 {
        2.0
    } else if ratio < 1.0 {
        (2.0 * ratio * root).atan2(2.0 * ratio * ratio - 1.0) / root
    } else {
        ((ratio + root) / (ratio - root)).ln() / root
    };
    (-ratio * angle).exp()
}

/// No damping of a law has the wanted ε_n, since it reaches no less than `least`.
fn unreachable(wanted: f64, least: f64) -> CollisionError {
    let phrase = format!("of this law has e_n = {wanted:?}");
    InvalidValue::phrase("no damping", phrase, format!("{least:?} to 1")).into()
}

/// The scaled damping a with which the law has this ε_n, above 0 and at most 1: in closed form
/// where the force is hysteretic, or a contact with linear force and damping, or with Hertz' and
/// Tsuji's, lasts until x = 0; otherwise solved, with an ε_n within 1e-12.
///
/// ```
/// use stickslip_model::{presets, restitution};
///
/// for name in ["gran/hooke/history", "gran/hertz/history", "paper"] {
///     let law = presets::find(name).ok_or("no such law")?.law;
///     let damping = restitution::damping(law, 0.8)?;
///     assert!((restitution::eps_n(law, damping)? - 0.8).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CollisionError`]: ε_n is out of its range, or no damping of this law has it, or the law has
/// adhesion, or a contact cannot be computed.
pub fn damping(law: Law, wanted: f64) -> Result<f64, CollisionError> {
    /// The largest damping that is tried. A contact with far too much takes long to compute.
    const MOST: f64 = 128.0;
    /// What a force that yields is computed for.
    const MOST_YIELDING: f64 = 1e4;
    law.require_no_adhesion("the damping of an e_n is")?;
    let ok = wanted > 0.0 && wanted <= 1.0;
    InvalidValue::check("e_n", wanted, "a number above 0, at most 1", ok)?;
    if wanted == 1.0 {
        return Ok(0.0);
    }
    if law.damping == Damping::None {
        return Err(unreachable(wanted, 1.0));
    }
    if law.damping.is_hysteretic() && law.damping != Damping::Yielding {
        let power = if law.normal == Normal::Linear { -2.0 } else { -3.0 };
        return Ok((wanted.ln() * power).exp_m1());
    }
    if let (Some(critical), true) = (critical_damping(law), attracts(law)) {
        let log = -wanted.ln();
        return Ok(critical * log / PI.hypot(log));
    }
    let most = if law.damping == Damping::Yielding { MOST_YIELDING } else { MOST };
    let most = f64::min(most, (1.0 - 1e-9) * law.endless_from());
    let (mut low, mut high) = (0.0, f64::min(0.5, most));
    loop {
        let least = eps_n(law, high)?;
        if least <= wanted {
            break;
        }
        if high >= most {
            return Err(unreachable(wanted, least));
        }
        (low, high) = (high, f64::min(2.0 * high, most));
    }
    let failure = Cell::new(None);
    let found = crossing(low, high, |damping| match eps_n(law, damping) {
        Ok(e_n) => e_n - wanted,
        Err(error) => {
            failure.set(Some(error));
            0.0
        }
    });
    failure.take().map_or(Ok(found), Err)
}

/// What it takes to have an ε_n, and what a particle code makes of it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Restitution {
    /// ε_n.
    pub e_n: f64,
    /// The scaled damping a of the law that has it.
    pub damping: f64,
    /// The damping ratio ζ, where ε_n does not depend on the velocity.
    pub critical_damping_ratio: Option<f64>,
    /// The keywords with which the code takes ε_n as an input.
    pub keywords: Vec<Keyword>,
}

/// A keyword with which a particle code takes a coefficient of normal restitution.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Keyword {
    /// The keyword.
    pub keyword: &'static str,
    /// Where its formula was read.
    pub source: &'static str,
    /// The scaled damping a that the code computes.
    pub damping: f64,
    /// ε_n of the law with this damping: what the code reaches without errors of time steps.
    pub e_n: f64,
}

/// The formulas by which codes make a damping of ε_n.
#[derive(Clone, Copy)]
enum Formula {
    /// 2ζ, the formula of linear forces.
    Linear,
    /// √5 ζ, that of Hertz' force with Tsuji's damping.
    Hertz,
    /// The polynomial of Tsuji's figure.
    Polynomial,
    /// √2 times that, for the effective mass.
    EffectiveMass,
}

impl Formula {
    fn damping(self, e_n: f64) -> f64 {
        let log = -e_n.ln();
        let ratio = log / PI.hypot(log);
        match self {
            Self::Linear => 2.0 * ratio,
            Self::Hertz => 5.0_f64.sqrt() * ratio,
            Self::Polynomial => {
                let terms = [4.8218, -18.022, 27.467, -22.348, 11.087, -4.2783, 1.2728];
                terms.into_iter().fold(0.0, |sum, term| sum * e_n + term)
            }
            Self::EffectiveMass => 2.0_f64.sqrt() * Self::Polynomial.damping(e_n),
        }
    }
}

/// The keywords of the law with this name, with their formulas and sources.
fn keywords(name: &str) -> &'static [(&'static str, Formula, &'static str)] {
    const LAMMPS: &str = "LAMMPS 22 Jul 2025, Update 4, as it runs: gran_sub_mod_damping.cpp";
    const NEWER: &str = "LAMMPS, commit 07b704c: gran_sub_mod_damping.cpp";
    const LIGGGHTS: &str = "LIGGGHTS-PUBLIC, commit 25fc396: normal_model_hooke.h, _hertz.h";
    const MERCURY: &str = "MercuryDPM: LinearViscoelasticNormalSpecies.cc (commit 0841c35), \
                           HertzianViscoelasticNormalSpecies.cc (commit 126c08f)";
    const MFIX: &str = "MFiX (copy CurtinIDS/mfix, commit aa5da90): check_solids_dem.f";
    const YADE: &str = "YADE (copy rohitkjohnedu/my_yade, commit 1677975): HertzMindlin.cpp, \
                        ViscoelasticPM.cpp";
    match name.split('/').collect::<Vec<_>>()[..] {
        ["granular", "hertz", "tsuji", ..] => &[
            ("damping tsuji", Formula::Polynomial, LAMMPS),
            ("damping tsuji, newer", Formula::EffectiveMass, NEWER),
            ("damping coeff_restitution", Formula::Hertz, LAMMPS),
        ],
        ["granular", "hooke", "tsuji", ..] => &[
            ("damping tsuji", Formula::Polynomial, LAMMPS),
            ("damping tsuji, newer", Formula::EffectiveMass, NEWER),
            ("damping coeff_restitution", Formula::Linear, LAMMPS),
        ],
        [_, "hooke", "hysteresis", ..]
        | ["mercury", "LinearPlasticViscoelasticSlidingFriction"] => &[],
        ["liggghts", "hooke", ..] => &[("coefficientRestitution", Formula::Linear, LIGGGHTS)],
        ["liggghts", "hertz", ..] => &[("coefficientRestitution", Formula::Hertz, LIGGGHTS)],
        ["mercury", "LinearViscoelasticSlidingFriction"] => {
            &[("setStiffnessAndRestitutionCoefficient", Formula::Linear, MERCURY)]
        }
        ["mercury", ..] => {
            &[("setElasticModulusAndRestitutionCoefficient", Formula::Hertz, MERCURY)]
        }
        ["mfix", ..] => &[("DES_EN_INPUT", Formula::Linear, MFIX)],
        ["yade", "MindlinPhys_Mindlin"] => &[("en", Formula::Hertz, YADE)],
        ["yade", "ViscElPhys_Basic"] => &[("tc, en, et", Formula::Linear, YADE)],
        _ => &[],
    }
}

/// What it takes for the law with this name to have an ε_n, above 0 and at most 1, and what its
/// code makes of ε_n as an input. `None` if no law has this name.
///
/// ```
/// use stickslip_model::restitution;
///
/// // MFiX takes the formula of linear forces for Hertz' force too, and loses less than it should.
/// let found = restitution::of("mfix/HERTZIAN", 0.8)?.ok_or("no such law")?;
/// assert_eq!(found.keywords[0].keyword, "DES_EN_INPUT");
/// assert!((found.keywords[0].e_n - 0.8192).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`CollisionError`]: as [`damping`].
pub fn of(name: &str, e_n: f64) -> Result<Option<Restitution>, CollisionError> {
    let Some(preset) = presets::find(name) else { return Ok(None) };
    let law = preset.law;
    let keywords = keywords(preset.name).iter().map(|&(keyword, formula, source)| {
        let damping = formula.damping(e_n);
        Ok(Keyword { keyword, source, damping, e_n: eps_n(law, damping)? })
    });
    let found = of_law(law, e_n)?;
    let keywords = keywords.collect::<Result<_, CollisionError>>()?;
    Ok(Some(Restitution { keywords, ..found }))
}

/// As [`of`], for a law that may have no name, and without keywords.
///
/// # Errors
/// [`CollisionError`]: as [`damping`].
pub fn of_law(law: Law, e_n: f64) -> Result<Restitution, CollisionError> {
    let damping = damping(law, e_n)?;
    let critical_damping_ratio = critical_damping(law).map(|critical| damping / critical);
    Ok(Restitution { e_n, damping, critical_damping_ratio, keywords: Vec::new() })
}
