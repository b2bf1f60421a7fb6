use stickslip_figure::{Svg, gif, pictures};
use stickslip_model::{Collider, Contact};

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

#[test]
fn an_animation_ends_with_the_picture() {
    let contact = Contact::new(63.0, 0.5, 0.0).unwrap();
    let collision = Collider::default().collide(contact).unwrap();
    let history = Collider::default().history(contact).unwrap();
    let frames: Vec<_> = pictures::collision::frames(&collision, &history).collect();
    // There are two panels.
    let switches = |svg: &Svg| count_in(svg, "switches", "line") / 2;
    let counts: Vec<_> = frames.iter().map(switches).collect();
    assert!(counts.is_sorted() && counts[0] == 0 && counts[counts.len() - 1] == 6, "{counts:?}");
    let film = gif(frames.into_iter().step_by(25)).unwrap();
    assert!(film.len() < 100_000, "{} bytes", film.len());
    let mut read = gif::DecodeOptions::new().read_info(film.as_slice()).unwrap();
    let mut pauses = Vec::new();
    while let Some(frame) = read.read_next_frame().unwrap() {
        assert_eq!((frame.width, frame.height), (760, 560));
        pauses.push(frame.delay);
    }
    assert_eq!(pauses, [6, 6, 200]);
}
