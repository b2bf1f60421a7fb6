use crate::examples::{collision, gallery};
use crate::svg::{count_in, texts};

/// The entries of the legend, which follow the title.
fn legend(texts: &[String], count: usize) -> Vec<&str> {
    texts[1..=count].iter().map(String::as_str).collect()
}

#[test]
fn the_legend_names_the_phases_that_occur() {
    let svg = collision(63.0, 0.5, 0.0);
    let all = ["slip +", "stick", "slip −", "switch", "Fn", "−Fn", "Ft/μ"];
    assert_eq!(legend(&texts(&svg), 7), all);
    assert_eq!(count_in(&svg, "switches", "line"), 2 * 6);
    // Itinerary +o+: the other side does not occur.
    let without_minus = ["slip +", "stick", "switch", "Fn", "−Fn", "Ft/μ"];
    assert_eq!(legend(&texts(&collision(18.0, 1e-7, 0.0)), 6), without_minus);
    // A contact that only slides has no switch.
    let sliding = collision(5.0, 1e6, 0.0);
    assert_eq!(legend(&texts(&sliding), 4), ["slip +", "Fn", "−Fn", "Ft/μ"]);
    assert_eq!(count_in(&sliding, "switches", "line"), 0);
}

#[test]
fn the_legend_of_a_gallery_names_the_phases_of_all_its_collisions() {
    let sliding = gallery(&[(63.0, 2.5), (63.0, 3.0)]);
    assert_eq!(legend(&texts(&sliding), 4), ["slip +", "Fn", "−Fn", "Ft/μ"]);
    let mixed = gallery(&[(63.0, 2.5), (63.0, 0.5)]);
    let all = ["slip +", "stick", "slip −", "switch", "Fn", "−Fn", "Ft/μ"];
    assert_eq!(legend(&texts(&mixed), 7), all);
}
