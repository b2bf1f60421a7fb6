//! Contact laws of particle codes, by the codes' own keywords.

use super::law::{Damping, End, HistoryOf, Law, Normal, Tangential};

/// A contact law that has a name.
///
/// ```
/// use stickslip_contact::{Normal, presets};
///
/// let preset = presets::find("gran/hooke/history").ok_or("no such law")?;
/// assert_eq!(preset.law.normal, Normal::Linear);
/// assert!(!preset.law.limit_damping);
/// let limited = presets::find("gran/hooke/history+limit_damping").ok_or("no such law")?;
/// assert!(limited.law.limit_damping);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Preset {
    /// The name: keywords of the code.
    pub name: &'static str,
    /// The code.
    pub code: &'static str,
    /// The law.
    pub law: Law,
    /// Whether the law of the code has the form of a [`Law`] with tangential damping too.
    pub tangential_damping: bool,
    /// Where the equations were read, and in which version.
    pub source: &'static str,
    /// What was compared, and what was not.
    pub checked: &'static str,
}

/// What may be added to a name: a normal force that does not attract.
const LIMITED: &str = "+limit_damping";

/// The preset with a name of [`ALL`], to which `+limit_damping` may be added.
#[must_use]
pub fn find(name: &str) -> Option<Preset> {
    let (base, limited) = match name.strip_suffix(LIMITED) {
        Some(base) => (base, true),
        None => (name, false),
    };
    let mut preset = *ALL.iter().find(|preset| preset.name == base)?;
    preset.law.limit_damping |= limited;
    Some(preset)
}

/// A law of a particle code, whose contacts end where the overlap does.
const fn law(
    normal: Normal,
    damping: Damping,
    tangential: Tangential,
    history: HistoryOf,
    rescaled: bool,
) -> Law {
    let (limit_damping, end) = (false, End::Overlap);
    Law { normal, damping, tangential, history, rescaled, limit_damping, end }
}

const fn lammps(name: &'static str, law: Law) -> Preset {
    Preset {
        name,
        code: "LAMMPS",
        law,
        tangential_damping: true,
        source: "LAMMPS 29 Sep 2021: pair_gran_hooke_history, pair_gran_hertz_history, pair_granular",
        checked: "264 collisions of LAMMPS, with and without limit_damping: \
                  tests/data/lammps_laws.json",
    }
}

/// A law of LAMMPS that none of the compared collisions has.
const fn unchecked(name: &'static str, law: Law) -> Preset {
    Preset { checked: "read in the source; no collision of LAMMPS compared", ..lammps(name, law) }
}

const fn read_in(
    code: &'static str,
    name: &'static str,
    law: Law,
    tangential_damping: bool,
    source: &'static str,
    checked: &'static str,
) -> Preset {
    Preset { name, code, law, tangential_damping, source, checked }
}

const LIGGGHTS: &str = "LIGGGHTS-PUBLIC 3.8.0 (commit 3d5c00f): normal_model_hertz.h, \
                        normal_model_hooke.h, tangential_model_history.h";
const LIGGGHTS_CHECKED: &str = "read in the source, with tangential_damping off; otherwise the \
                                Coulomb test leaves out the dashpot; limitForce on is \
                                +limit_damping";
const MERCURY: &str = "MercuryDPM, a copy of July 2024 (kuwt/MercuryDPM_fork, commit fb0ebf1): \
                       Kernel/Interactions";
const MFIX: &str = "MFiX 21.3.2 (copy soufiane92/MFiX-21.3.2, commit e8a0d92): \
                    model/des/calc_force_dem.f, check_solids_dem.f";
const MFIX_CHECKED: &str = "read in the source, without tangential dashpot, which slides along the \
                            spring; the spring is not rotated with the contact";
const YADE: &str = "YADE 2021.01a (copy rohitkjohnedu/my_yade, commit 908aef9): \
                    pkg/dem/HertzMindlin.cpp, ElasticContactLaw.cpp, ViscoelasticPM.cpp";
const YADE_CHECKED: &str = "read in the source, with the integrator's own damping 0 and without \
                            tangential dashpot, which the Coulomb test leaves out";

use Damping::{Linear as Constant, None as Undamped, Tsuji, Viscoelastic};
use HistoryOf::{Displacement, Force};
use Normal::{Hertz, Linear};
use Tangential::{Constant as Spring, Mindlin};

/// All laws that have a name. The first is the paper's.
pub const ALL: &[Preset] = &[
    Preset {
        name: "paper",
        code: "stickslip",
        law: Law::PAPER,
        tangential_damping: true,
        source: "Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008)",
        checked: "docs/validation.md",
    },
    lammps("gran/hooke/history", law(Linear, Constant, Spring, Displacement, false)),
    lammps("gran/hertz/history", law(Hertz, Viscoelastic, Mindlin, Displacement, false)),
    lammps("granular/hooke/linear_history", law(Linear, Viscoelastic, Spring, Displacement, false)),
    lammps(
        "granular/hooke/mass_velocity/linear_history",
        law(Linear, Constant, Spring, Displacement, false),
    ),
    lammps(
        "granular/hooke/tsuji/linear_history",
        law(Linear, Constant, Spring, Displacement, false),
    ),
    unchecked(
        "granular/hertz/velocity/linear_history",
        law(Hertz, Constant, Spring, Displacement, false),
    ),
    lammps(
        "granular/hertz/viscoelastic/linear_history",
        law(Hertz, Viscoelastic, Spring, Displacement, false),
    ),
    lammps(
        "granular/hertz/viscoelastic/mindlin",
        law(Hertz, Viscoelastic, Mindlin, Displacement, false),
    ),
    unchecked(
        "granular/hertz/tsuji/linear_history",
        law(Hertz, Tsuji, Spring, Displacement, false),
    ),
    lammps("granular/hertz/tsuji/mindlin", law(Hertz, Tsuji, Mindlin, Displacement, false)),
    lammps("granular/hertz/tsuji/mindlin/force", law(Hertz, Tsuji, Mindlin, Force, false)),
    lammps("granular/hertz/tsuji/mindlin_rescale", law(Hertz, Tsuji, Mindlin, Displacement, true)),
    lammps("granular/hertz/tsuji/mindlin_rescale/force", law(Hertz, Tsuji, Mindlin, Force, true)),
    read_in(
        "LIGGGHTS",
        "liggghts/hooke/history",
        law(Linear, Constant, Spring, Displacement, false),
        false,
        LIGGGHTS,
        LIGGGHTS_CHECKED,
    ),
    read_in(
        "LIGGGHTS",
        "liggghts/hertz/history",
        law(Hertz, Tsuji, Mindlin, Displacement, false),
        false,
        LIGGGHTS,
        LIGGGHTS_CHECKED,
    ),
    read_in(
        "MercuryDPM",
        "mercury/LinearViscoelasticSlidingFriction",
        law(Linear, Constant, Spring, Displacement, false),
        true,
        MERCURY,
        "read in the source, with equal static and dynamic friction",
    ),
    read_in(
        "MercuryDPM",
        "mercury/HertzianViscoelasticMindlin",
        law(Hertz, Tsuji, Mindlin, Displacement, false),
        false,
        MERCURY,
        "read in the source, with slidingDissipation 0; otherwise the Coulomb test leaves out the \
         dashpot",
    ),
    read_in(
        "MFiX",
        "mfix/LSD",
        law(Linear, Constant, Spring, Displacement, false),
        false,
        MFIX,
        MFIX_CHECKED,
    ),
    read_in(
        "MFiX",
        "mfix/HERTZIAN",
        law(Hertz, Tsuji, Mindlin, Displacement, false),
        false,
        MFIX,
        MFIX_CHECKED,
    ),
    read_in(
        "YADE",
        "yade/FrictPhys_CundallStrack",
        law(Linear, Undamped, Spring, Force, false),
        false,
        YADE,
        YADE_CHECKED,
    ),
    read_in(
        "YADE",
        "yade/MindlinPhys_Mindlin",
        Law { limit_damping: true, ..law(Hertz, Tsuji, Mindlin, Force, false) },
        false,
        YADE,
        YADE_CHECKED,
    ),
    read_in(
        "YADE",
        "yade/ViscElPhys_Basic",
        Law { limit_damping: true, ..law(Linear, Constant, Spring, Force, false) },
        false,
        YADE,
        YADE_CHECKED,
    ),
];
