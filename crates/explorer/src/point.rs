//! Points of maps.

/// The result at one point of a map.
pub struct MapPoint {
    /// The values of the scene's fields; NaN where there is no result.
    pub values: [f32; 4],
    /// The number of switches or events; [`NO_COUNT`] where there is no result.
    pub count: u16,
    /// The code of the itinerary.
    pub code: u32,
}

/// The count of a point without a result.
pub const NO_COUNT: u16 = u16::MAX;

impl MapPoint {
    /// A point without a result.
    pub const FAILED: Self = Self { values: [f32::NAN; 4], count: NO_COUNT, code: 0 };
}
