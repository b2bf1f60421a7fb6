//! How particle codes step through a contact.

/// A scheme of a particle code.
///
/// Both advance velocity v and overlap x by leaps, v_{n+½} = v_{n−½} + dt f_n and
/// x_{n+1} = x_n + dt v_{n+½}. The force f_n is that at the overlap x_n and the velocity v_{n−½}.
/// Velocity Verlet whose forces see the velocities of half steps (LAMMPS, MercuryDPM), leapfrog
/// (YADE) and semi-implicit Euler (MFiX) are this same sequence. In each step, in this order: the
/// history is rescaled, if the law says so; it advances by v_{n−½}; the tangential force follows
/// from it; and where that exceeds Coulomb's limit, it is cut off and the history is reset to it.
///
/// Sources: LAMMPS 29 Sep 2021 `pair_gran_hooke_history.cpp`, `pair_gran_hertz_history.cpp`,
/// `pair_granular.cpp` (all `compute`), `fix_nve_sphere.cpp`; MercuryDPM (kuwt/MercuryDPM_fork)
/// `BaseParticle.cc`, `SlidingFrictionInteraction.cc`; MFiX 21.3.2 `calc_force_dem.f`,
/// `cfnewvalues.f` with `INTG_EULER`; YADE 2021.01a `NewtonIntegrator.cpp` for the motion alone.
/// Only LAMMPS was run and compared. Schemes of other kinds, such as MFiX' Adams–Bashforth, are not
/// computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Scheme {
    /// The history advances by a whole step in the first step of a contact too, as in LAMMPS,
    /// MercuryDPM and MFiX 21.3.2. Bodies touch where the overlap at the end of a step is above 0,
    /// and the history is forgotten where it is not.
    #[default]
    Lammps,
    /// In the first step of a contact the history advances by the time since the contact began,
    /// x/v, but by a whole step at most, as in an older MFiX (truongd8593/mfix, commit 01e0f96,
    /// `calc_force_dem.f`, `DTSOLID_TMP`). What else is special there was not compared.
    Elapsed,
}

impl Scheme {
    /// All schemes.
    pub const ALL: [Self; 2] = [Self::Lammps, Self::Elapsed];

    /// The name of the scheme: `lammps` or `elapsed`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Lammps => "lammps",
            Self::Elapsed => "elapsed",
        }
    }

    /// The scheme with this [`Self::name`].
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scheme| scheme.name() == name)
    }
}
