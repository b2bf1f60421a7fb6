//! Names of pictures.

use crate::limits::MOST_LAWS;

/// The names of the pictures of each law: maps, and forces.
pub const NAMES: [[&str; 2]; MOST_LAWS] = [
    ["law_01_maps", "law_01_forces"],
    ["law_02_maps", "law_02_forces"],
    ["law_03_maps", "law_03_forces"],
    ["law_04_maps", "law_04_forces"],
    ["law_05_maps", "law_05_forces"],
    ["law_06_maps", "law_06_forces"],
    ["law_07_maps", "law_07_forces"],
    ["law_08_maps", "law_08_forces"],
    ["law_09_maps", "law_09_forces"],
    ["law_10_maps", "law_10_forces"],
    ["law_11_maps", "law_11_forces"],
    ["law_12_maps", "law_12_forces"],
    ["law_13_maps", "law_13_forces"],
    ["law_14_maps", "law_14_forces"],
    ["law_15_maps", "law_15_forces"],
    ["law_16_maps", "law_16_forces"],
    ["law_17_maps", "law_17_forces"],
    ["law_18_maps", "law_18_forces"],
    ["law_19_maps", "law_19_forces"],
    ["law_20_maps", "law_20_forces"],
    ["law_21_maps", "law_21_forces"],
    ["law_22_maps", "law_22_forces"],
    ["law_23_maps", "law_23_forces"],
    ["law_24_maps", "law_24_forces"],
];
