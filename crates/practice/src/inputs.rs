//! Inputs of particle codes: the lines with which a code computes the contacts of two bodies.
//!
//! [`lines`] writes the constants of a [`BodyPair`] in the terms of a code. Laws and constants that
//! the code cannot compute are refused, with the reason.

use std::f64::consts::PI;
use std::fmt::Write;

use stickslip_model::spheres::BodyPair;
use stickslip_model::{ContactEnd, CoulombTest, Damping, HistoryOf, Law, Normal, Tangential};

/// A particle code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// LAMMPS, `pair_style granular` of 2025.
    Lammps,
    /// LIGGGHTS-PUBLIC 3.8.
    Liggghts,
    /// YADE.
    Yade,
    /// MFiX-DEM.
    Mfix,
    /// MercuryDPM.
    Mercury,
}

impl Code {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Lammps, Self::Liggghts, Self::Yade, Self::Mfix, Self::Mercury];

    /// The name: `lammps`, `liggghts`, `yade`, `mfix` or `mercury`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lammps => "lammps",
            Self::Liggghts => "liggghts",
            Self::Yade => "yade",
            Self::Mfix => "mfix",
            Self::Mercury => "mercury",
        }
    }

    /// The code with this name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|code| code.name() == name)
    }
}

/// The lines with which `code` computes the contacts of `pair`, in SI units.
///
/// ```
/// use stickslip_model::presets;
/// use stickslip_model::spheres::{BodyPair, Surface};
/// use stickslip_practice::inputs::{Code, lines};
///
/// let law = presets::find("gran/hooke/history").ok_or("no such law")?.law;
/// let surface = Surface {
///     friction: 0.3,
///     tangential_stiffness_kg_per_s2: 2e4,
///     damping_time_s: 1e-7,
/// };
/// let pair = BodyPair {
///     effective_mass_kg: 1e-5,
///     effective_radius_m: 5e-4,
///     elastic_constant: 5e4,
///     stiffness_ratio: 0.8,
///     alpha: 2.0 / 7.0,
///     surface,
///     law,
///     tangential_damping_ratio: 0.5,
/// };
/// let text = lines(Code::Lammps, &pair)?;
/// assert!(text.contains("tangential linear_history 20000.0 0.5 0.3 damping mass_velocity"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A sentence: the code does not have the law, or not with these constants.
pub fn lines(code: Code, pair: &BodyPair) -> Text {
    let constants = Constants::new(pair);
    let text = match code {
        _ if pair.law.damping.is_hysteretic() => Err(hysteretic(code).to_owned()),
        _ if !pair.law.friction.is_constant() => Err(DECAYING.to_owned()),
        _ if pair.law.normal.is_adhesive() => Err(ADHESIVE.to_owned()),
        Code::Lammps => constants.lammps(),
        Code::Liggghts => constants.liggghts(),
        Code::Yade => constants.yade(),
        Code::Mfix => constants.mfix(),
        Code::Mercury => constants.mercury(),
    };
    text.map_err(|reason| format!("{} has no input for these contacts: {reason}", code.name()))
}

/// Why the inputs of a code are not written with a hysteretic force.
fn hysteretic(code: Code) -> &'static str {
    match code {
        Code::Liggghts | Code::Mercury => {
            "its hysteretic force hardens up to an overlap that it must be given (deltaMaxLim, \
             penetrationDepthMax), with the largest stiffness there, and impacts below it say neither; \
             expected a law with damping or without"
        }
        Code::Lammps | Code::Yade | Code::Mfix => {
            "it has no hysteretic normal force of this form; expected a law with damping or without"
        }
    }
}

/// Why the inputs of no code are written with a friction that decays.
const DECAYING: &str =
    "its friction decays with the velocity; expected one coefficient of friction";

/// Why the inputs of no code are written with adhesion.
const ADHESIVE: &str = "inputs with adhesion are not written; expected a law without it";

/// The constants of a pair as codes have them.
struct Constants {
    law: Law,
    /// Effective mass and radius.
    mass: f64,
    radius: f64,
    /// k, or ρ.
    elastic: f64,
    /// k_t, or K.
    tangential: f64,
    friction: f64,
    /// γ.
    damping: f64,
    /// Ratio of the dampings.
    ratio: f64,
}

type Text = Result<String, String>;

/// How far constants may be from those that a code makes of others.
const CLOSE: f64 = 1e-9;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= CLOSE * a.abs().max(b.abs())
}

impl Constants {
    fn new(pair: &BodyPair) -> Self {
        Self {
            law: pair.law,
            mass: pair.effective_mass_kg,
            radius: pair.effective_radius_m,
            elastic: pair.elastic_constant,
            tangential: pair.surface.tangential_stiffness_kg_per_s2,
            friction: pair.surface.friction,
            damping: pair.surface.damping_time_s * pair.elastic_constant,
            ratio: pair.tangential_damping_ratio,
        }
    }

    /// Whether the normal force never attracts.
    fn limited(&self) -> bool {
        self.law.limit_damping || self.law.end == ContactEnd::Force
    }

    /// γ/√(m k) or γ/√(m ρ).
    fn scaled_damping(&self) -> f64 {
        self.damping / (self.mass * self.elastic).sqrt()
    }

    /// ε_n from which a code makes the scaled damping `critical` ζ.
    fn restitution(&self, critical: f64) -> Text {
        let ratio = self.scaled_damping() / critical;
        if ratio < 1.0 {
            return Ok(format!("{:?}", (-PI * ratio / (1.0 - ratio * ratio).sqrt()).exp()));
        }
        Err(format!("the damping ratio {ratio:?} is not that of an e_n; expected below 1"))
    }

    /// Refuses a dashpot of another part in Coulomb's test.
    fn require_test(&self, test: CoulombTest) -> Result<(), String> {
        let matters = self.ratio * self.damping != 0.0 && self.law.remembers();
        if matters && self.law.coulomb_test != test {
            return Err(match test {
                CoulombTest::Total => {
                    "Coulomb's limit holds for spring and dashpot there; expected \
                                       the law with coulomb_test total, or no tangential damping"
                }
                CoulombTest::Spring => {
                    "Coulomb's limit holds for the spring alone there; expected \
                                        the law with coulomb_test spring, or no tangential damping"
                }
            }
            .to_owned());
        }
        Ok(())
    }

    /// Poisson's ratio and Young's modulus of equal bodies with these constants of Hertz' force and
    /// Mindlin's stiffness.
    fn material(&self) -> Result<(f64, f64), String> {
        let quotient = self.tangential / self.elastic;
        let poisson = (3.0 - 2.0 * quotient) / (3.0 - quotient);
        if !(quotient >= 1.0 && poisson > -1.0 && quotient < 3.0) {
            return Err(format!(
                "a material has K/ρ = 3(1 − ν)/(2 − ν), from 1 to 2, and this one has {quotient:?}; \
                 expected other constants, or a code that takes stiffnesses"
            ));
        }
        let modulus = 0.75 * self.elastic / self.radius.sqrt();
        Ok((poisson, 2.0 * (1.0 - poisson * poisson) * modulus))
    }

    fn lammps(&self) -> Text {
        let Self { law, mass, radius, elastic, tangential, friction, damping, ratio } = *self;
        self.require_test(CoulombTest::Total)?;
        let root = radius.sqrt();
        let hertz = law.normal == Normal::Hertz;
        let (normal, stiffness) =
            if hertz { ("hertz", elastic / root) } else { ("hooke", elastic) };
        let (keyword, eta) = match law.damping {
            Damping::None | Damping::Hysteretic | Damping::Hardening | Damping::Yielding => {
                ("velocity", "0.0".to_owned())
            }
            _ if damping == 0.0 => ("velocity", "0.0".to_owned()),
            Damping::Linear => ("mass_velocity", format!("{:?}", damping / mass)),
            Damping::Viscoelastic => ("viscoelastic", format!("{:?}", damping / (mass * root))),
            Damping::Tsuji if hertz => ("coeff_restitution", self.restitution(5.0_f64.sqrt())?),
            Damping::Tsuji => {
                return Err("a damping that grows as x^(1/4) goes with hertz; expected linear or \
                            viscoelastic"
                    .to_owned());
            }
        };
        let spring = match (law.history, law.tangential, law.rescaled) {
            (HistoryOf::None, ..) => format!("linear_nohistory {ratio:?}"),
            (_, Tangential::Constant, false) => {
                format!("linear_history {tangential:?} {ratio:?}")
            }
            (_, Tangential::Constant, true) => {
                return Err("a rescaled history goes with mindlin; expected another law".to_owned());
            }
            (history, Tangential::Mindlin, rescaled) => {
                let rescaled = if rescaled { "_rescale" } else { "" };
                let force = if history == HistoryOf::Force { "/force" } else { "" };
                format!("mindlin{rescaled}{force} {:?} {ratio:?}", tangential / root)
            }
        };
        let limit = if self.limited() { " limit_damping" } else { "" };
        Ok(format!(
            "pair_style granular\npair_coeff * * {normal} {stiffness:?} {eta} tangential {spring} \
             {friction:?} damping {keyword}{limit}\n"
        ))
    }

    fn liggghts(&self) -> Text {
        let Self { law, mass, radius, elastic, tangential, friction, damping, ratio } = *self;
        self.require_test(CoulombTest::Spring)?;
        let history = if law.remembers() { "history" } else { "no_history" };
        let limit = if self.limited() { "on" } else { "off" };
        let (model, poisson, modulus, restitution, own) = match (law.normal, law.damping) {
            (Normal::Hertz, Damping::Tsuji) => {
                if law.rescaled || law.remembers() && law.history != HistoryOf::Displacement {
                    return Err("its history is a displacement; expected the law \
                                liggghts/hertz/history"
                        .to_owned());
                }
                if law.remembers() && law.tangential != Tangential::Mindlin {
                    return Err(
                        "its tangential stiffness is Mindlin's with hertz; expected the law \
                                liggghts/hertz/history"
                            .to_owned(),
                    );
                }
                let (poisson, modulus) = if law.remembers() {
                    self.material()?
                } else {
                    (0.3, 2.0 * (1.0 - 0.09) * 0.75 * elastic / radius.sqrt())
                };
                let quotient = 3.0 * (1.0 - poisson) / (2.0 - poisson);
                let own = (quotient / 1.5).sqrt();
                ("hertz", poisson, modulus, self.restitution(5.0_f64.sqrt())?, own)
            }
            (Normal::Linear, Damping::Linear) if !law.rescaled => {
                // k = A^(4/5) (m V²)^(1/5) with A = (16/15) √R Y* and the velocity V = 1 m/s.
                let amplitude = (elastic / mass.powf(0.2)).powf(1.25);
                let modulus = 2.0 * (1.0 - 0.09) * amplitude / (16.0 / 15.0 * radius.sqrt());
                ("hooke", 0.3, modulus, self.restitution(2.0)?, 1.0)
            }
            _ => {
                return Err("expected a law of liggghts/hooke or liggghts/hertz".to_owned());
            }
        };
        let extra = match (model, tangential / elastic) {
            ("hooke", quotient) if law.remembers() && close(quotient, 0.285_714_286) => {
                " ktToKnUser on"
            }
            ("hooke", quotient) if law.remembers() && !close(quotient, 1.0) => {
                return Err(format!(
                    "k_t/k is 1, or 2/7 as 0.285714286, with hooke, and here {quotient:?}; expected \
                     one of them"
                ));
            }
            _ => "",
        };
        let dashpot = match ratio {
            _ if damping == 0.0 => "off",
            0.0 => "off",
            ratio if close(ratio, own) => "on",
            ratio => {
                return Err(format!(
                    "the ratio of the dampings is 0 or {own:?} there, and here {ratio:?}; expected \
                     one of them"
                ));
            }
        };
        let mut text = String::new();
        for (name, kind, value) in [
            ("youngsModulus", "peratomtype", format!("{modulus:?}")),
            ("poissonsRatio", "peratomtype", format!("{poisson:?}")),
            ("coefficientRestitution", "peratomtypepair 1", restitution),
            ("coefficientFriction", "peratomtypepair 1", format!("{friction:?}")),
        ] {
            let _ = writeln!(text, "fix {name} all property/global {name} {kind} {value}");
        }
        if model == "hooke" {
            text += "fix characteristicVelocity all property/global characteristicVelocity scalar 1.0\n";
        }
        let _ = writeln!(
            text,
            "pair_style gran model {model} tangential {history} tangential_damping {dashpot} \
             limitForce {limit}{extra}\npair_coeff * *"
        );
        Ok(text)
    }

    fn yade(&self) -> Text {
        let Self { law, tangential, friction, damping, ratio, .. } = *self;
        self.require_test(CoulombTest::Spring)?;
        let angle = friction.atan();
        let unlimited = || "its normal force does not attract; expected limit_damping".to_owned();
        match (law.normal, law.damping, law.tangential, law.history, law.rescaled) {
            (Normal::Hertz, Damping::Tsuji, Tangential::Mindlin, HistoryOf::Force, false) => {
                if damping != 0.0 && !close(ratio, 1.0) {
                    return Err(format!(
                        "with en the tangential dashpot equals the normal one, and here the ratio is \
                         {ratio:?}; expected 1"
                    ));
                }
                if damping != 0.0 && !self.limited() {
                    return Err(unlimited());
                }
                let (poisson, modulus) = self.material()?;
                let en = self.restitution(5.0_f64.sqrt())?;
                let en = if damping == 0.0 {
                    String::new()
                } else {
                    format!("en=MatchMaker(algo='val', val={en})")
                };
                Ok(format!(
                    "FrictMat(young={modulus:?}, poisson={poisson:?}, frictionAngle={angle:?})\n\
                     Ip2_FrictMat_FrictMat_MindlinPhys({en})\nLaw2_ScGeom_MindlinPhys_Mindlin()\n"
                ))
            }
            (Normal::Linear, Damping::Linear, Tangential::Constant, HistoryOf::None, _) => {
                Err("its laws have a history; expected another code".to_owned())
            }
            (Normal::Linear, Damping::Linear, Tangential::Constant, _, false) => {
                if damping != 0.0 && !self.limited() {
                    return Err(unlimited());
                }
                // Two equal materials in series.
                let [kn, ks] = [self.elastic, tangential].map(|it| 2.0 * it);
                let [cn, cs] = [damping, damping * ratio].map(|it| 2.0 * it);
                Ok(format!(
                    "ViscElMat(kn={kn:?}, ks={ks:?}, cn={cn:?}, cs={cs:?}, frictionAngle={angle:?})\n\
                     Ip2_ViscElMat_ViscElMat_ViscElPhys()\nLaw2_ScGeom_ViscElPhys_Basic()\n"
                ))
            }
            _ => {
                Err("expected a law of yade/MindlinPhys_Mindlin or yade/ViscElPhys_Basic"
                    .to_owned())
            }
        }
    }

    fn mfix(&self) -> Text {
        let Self { law, elastic, tangential, friction, damping, ratio, .. } = *self;
        if !law.remembers()
            || law.rescaled
            || law.history == HistoryOf::Force && law.tangential == Tangential::Mindlin
        {
            return Err("its history is a displacement; expected a law of mfix".to_owned());
        }
        if damping * ratio != 0.0 {
            return Err("its tangential dashpot is no term of these laws; expected none".to_owned());
        }
        if damping != 0.0 && self.limited() {
            return Err("its normal force may attract; expected a law without limit_damping that \
                        ends at x = 0"
                .to_owned());
        }
        let restitution = self.restitution(2.0)?;
        match (law.normal, law.damping, law.tangential) {
            (Normal::Linear, Damping::Linear, Tangential::Constant) if tangential <= elastic => {
                Ok(format!(
                    "DES_COLL_MODEL = 'LSD'\nKN = {elastic:?}\nKT_FAC = {:?}\nDES_EN_INPUT(1) = \
                     {restitution}\nDES_ETAT_FAC = 0.0\nMEW = {friction:?}\n",
                    tangential / elastic
                ))
            }
            (Normal::Hertz, Damping::Tsuji, Tangential::Mindlin) => {
                let (poisson, modulus) = self.material()?;
                Ok(format!(
                    "DES_COLL_MODEL = 'HERTZIAN'\nE_YOUNG(1) = {modulus:?}\nV_POISSON(1) = \
                     {poisson:?}\nDES_EN_INPUT(1) = {restitution}\nDES_ET_INPUT(1) = 1.0\nMEW = \
                     {friction:?}\n"
                ))
            }
            _ => Err("expected a law of mfix, with k_t of at most k".to_owned()),
        }
    }

    fn mercury(&self) -> Text {
        let Self { law, elastic, tangential, friction, damping, ratio, .. } = *self;
        let linear = (law.normal, law.damping) == (Normal::Linear, Damping::Linear)
            && law.tangential == Tangential::Constant
            && law.remembers()
            && !law.rescaled;
        if !linear {
            return Err("expected the law mercury/LinearViscoelasticSlidingFriction".to_owned());
        }
        if damping != 0.0 && self.limited() {
            return Err("its normal force may attract; expected a law without limit_damping that \
                        ends at x = 0"
                .to_owned());
        }
        self.require_test(CoulombTest::Total)?;
        Ok(format!(
            "LinearViscoelasticSlidingFrictionSpecies species;\nspecies.setStiffness({elastic:?});\n\
             species.setDissipation({damping:?});\nspecies.setSlidingStiffness({tangential:?});\n\
             species.setSlidingDissipation({:?});\nspecies.setSlidingFrictionCoefficient({friction:?});\n",
            damping * ratio
        ))
    }
}
