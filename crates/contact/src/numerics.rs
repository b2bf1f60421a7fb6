//! Numbers with twice the digits, and roots in a bracket.

pub mod double_double;
pub mod root;
