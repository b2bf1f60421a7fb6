//! Curves in a parameter plane on which the switching of a piecewise-smooth ODE changes.
//!
//! This crate will follow switch boundaries {margin = 0} of hybrid systems in two parameters and return the
//! subdivision of the plane that they make. It holds only this page so far.
