use resvg::usvg::Rect;
use roxmltree::Document;

use crate::examples;
use crate::svg::{PlacedText, placed};

/// The middle part of the rectangle around a text, without the room above and below its letters.
fn core(text: &PlacedText) -> Rect {
    let at = text.at;
    let (width, height) = (at.width(), at.height());
    let (along, across) = if text.upwards { (0.2, 0.0) } else { (0.0, 0.2) };
    Rect::from_ltrb(
        at.left() + along * width,
        at.top() + across * height,
        at.right() - along * width,
        at.bottom() - across * height,
    )
    .unwrap()
}

fn overlap(one: &PlacedText, two: &PlacedText) -> bool {
    let (one, two) = (core(one), core(two));
    one.left() < two.right()
        && two.left() < one.right()
        && one.top() < two.bottom()
        && two.top() < one.bottom()
}

#[test]
fn every_picture_is_xml_with_a_title_and_a_white_ground() {
    for (name, svg) in examples::all() {
        let document = svg.document();
        let document = Document::parse(&document).unwrap_or_else(|error| panic!("{name}: {error}"));
        let root = document.root_element();
        assert_eq!(root.attribute("width"), Some(svg.width().to_string().as_str()), "{name}");
        let mut children = root.children().filter(roxmltree::Node::is_element);
        assert!(children.next().unwrap().has_tag_name("title"), "{name}");
        let ground = children.next().unwrap();
        assert_eq!(ground.attribute("fill"), Some("white"), "{name}");
        // A page that is dark changes nothing: every text names its colour.
        let mut texts = document.descendants().filter(|node| node.has_tag_name("text"));
        assert!(texts.all(|text| text.attribute("fill").is_some()), "{name}");
    }
}

#[test]
fn numbers_in_every_picture_are_finite() {
    for (name, svg) in examples::all() {
        let document = svg.document();
        assert!(!document.contains("NaN") && !document.contains("inf"), "{name}");
    }
}

#[test]
fn texts_stay_inside_apart_and_within_the_font() {
    for (name, svg) in examples::all() {
        let (picture, texts) = placed(svg);
        assert!(!texts.is_empty(), "{name}");
        for text in &texts {
            let at = text.at;
            let inside = at.left() >= 0.0
                && at.top() >= 0.0
                && at.right() <= picture.right()
                && at.bottom() <= picture.bottom();
            assert!(inside, "{name}: {text:?} leaves the picture");
            assert!(text.complete, "{name}: the font lacks a character of {:?}", text.text);
        }
        for (index, one) in texts.iter().enumerate() {
            for two in &texts[index + 1..] {
                assert!(!overlap(one, two), "{name}: {one:?} covers {two:?}");
            }
        }
    }
}

#[test]
fn pictures_become_png_of_twice_their_size() {
    let svg = examples::collision(63.0, 0.5, 0.0);
    let file = stickslip_figure::png(&svg).unwrap();
    let size = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap());
    assert_eq!((size(16), size(20)), (1520, 1120));
}
