//! What is measured of an impact.

/// A quantity that experiments measure after an impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Measured {
    /// Coefficient of normal restitution ε_n.
    EpsN,
    /// Coefficient of tangential restitution ε_t of the surfaces; −1 is full reversal.
    EpsT,
    /// Tangential velocity of the centre after over that before the contact.
    CentreRestitution,
    /// Angular velocity of the first sphere after the contact in rad/s, positive in the direction
    /// in which it would roll.
    Spin,
    /// Angle in rad from the normal at which the centre leaves, negative where it is thrown back.
    ReboundAngle,
}

impl Measured {
    /// All quantities.
    pub const ALL: [Self; 5] =
        [Self::EpsN, Self::EpsT, Self::CentreRestitution, Self::Spin, Self::ReboundAngle];

    /// The name in files, with the unit: `eps_n`, `eps_t`, `centre_e_t`, `spin_rad_per_s` or
    /// `centre_rebound_angle_rad`.
    pub fn name(self) -> &'static str {
        match self {
            Self::EpsN => "eps_n",
            Self::EpsT => "eps_t",
            Self::CentreRestitution => "centre_e_t",
            Self::Spin => "spin_rad_per_s",
            Self::ReboundAngle => "centre_rebound_angle_rad",
        }
    }

    /// The name of the column of a table for people, with the unit: as [`Self::name`], but angles
    /// are in degrees.
    pub fn heading(self) -> &'static str {
        match self {
            Self::ReboundAngle => "centre_rebound_angle_deg",
            other => other.name(),
        }
    }

    /// A value as people read it, in the unit of [`Self::heading`].
    pub fn shown(self, value: f64) -> f64 {
        if self == Self::ReboundAngle { value.to_degrees() } else { value }
    }

    /// The quantity with this [`Self::name`].
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// The values that the quantity can have, in words.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::EpsN => "a number above 0, at most 1",
            Self::EpsT | Self::CentreRestitution => "a number from -1e6 to 1e6",
            Self::Spin => "a number from -1e12 to 1e12",
            Self::ReboundAngle => "an angle between -π/2 and π/2, in rad",
        }
    }

    pub(super) fn allows(self, value: f64) -> bool {
        match self {
            Self::EpsN => value > 0.0 && value <= 1.0,
            Self::EpsT | Self::CentreRestitution => value.abs() <= 1e6,
            Self::Spin => value.abs() <= 1e12,
            Self::ReboundAngle => value.abs() < std::f64::consts::FRAC_PI_2,
        }
    }
}
impl serde::Serialize for Measured {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// One measured value. The spheres do not spin before the impact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Datum {
    /// The number of the row that the value is from, which residuals repeat.
    pub row: usize,
    /// Normal velocity of approach g_n in m/s, above 0.
    pub normal_m_per_s: f64,
    /// Tangential velocity g_t in m/s: above 0, or 0 beside ε_n.
    pub tangential_m_per_s: f64,
    /// What is measured.
    pub quantity: Measured,
    /// Its value.
    pub value: f64,
    /// Its standard error, from 1e-12 to 1e12.
    pub error: Option<f64>,
}

impl Datum {
    /// A value measured at `angle_rad` from the normal, at `speed_m_per_s`.
    pub fn at_angle(
        angle_rad: f64,
        speed_m_per_s: f64,
        quantity: Measured,
        value: f64,
        error: Option<f64>,
    ) -> Self {
        Self {
            row: 0,
            normal_m_per_s: speed_m_per_s * angle_rad.cos(),
            tangential_m_per_s: speed_m_per_s * angle_rad.sin(),
            quantity,
            value,
            error,
        }
    }

    /// The angle of the impact from the normal in rad.
    pub fn angle_rad(&self) -> f64 {
        self.tangential_m_per_s.atan2(self.normal_m_per_s)
    }

    /// The speed in m/s.
    pub fn speed_m_per_s(&self) -> f64 {
        self.normal_m_per_s.hypot(self.tangential_m_per_s)
    }
}
