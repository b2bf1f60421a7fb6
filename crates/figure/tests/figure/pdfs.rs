//! A PDF has every shape of its picture.

use std::io::Read;

use flate2::read::ZlibDecoder;
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Group, Node, Options, Paint, Tree};
use stickslip_figure::{Svg, pdf};

use crate::examples::all;
use crate::svg::FONT;

/// The shapes, images and clips of a group. Nothing in it may be of a kind that is not written.
fn count(group: &Group, name: &str) -> (usize, usize, usize) {
    assert!(group.mask().is_none(), "{name}");
    assert!(group.filters().is_empty() && group.opacity().get() == 1.0, "{name}");
    let found = group.children().iter().fold((0, 0, 0), |(shapes, images, clips), node| {
        let more = match node {
            Node::Group(group) => count(group, name),
            Node::Text(text) => count(text.flattened(), name),
            Node::Path(path) => {
                let fill = path.fill().map(|fill| (fill.paint(), fill.opacity()));
                let stroke = path.stroke().map(|stroke| (stroke.paint(), stroke.opacity()));
                for (paint, opacity) in fill.into_iter().chain(stroke) {
                    assert!(matches!(paint, Paint::Color(_)) && opacity.get() == 1.0, "{name}");
                }
                // What only has a hint is not painted.
                (usize::from(path.fill().is_some() || path.stroke().is_some()), 0, 0)
            }
            Node::Image(_) => (0, 1, 0),
        };
        (shapes + more.0, images + more.1, clips + more.2)
    });
    let clips = usize::from(group.clip_path().is_some());
    (found.0, found.1, found.2 + clips)
}

/// The operators of the page.
fn operators(file: &[u8]) -> Vec<String> {
    let find = |what: &[u8], from: usize| {
        from + file[from..].windows(what.len()).position(|bytes| bytes == what).expect("a stream")
    };
    let start = find(b"stream\n", find(b"\n4 0 obj", 0)) + b"stream\n".len();
    let mut text = String::new();
    ZlibDecoder::new(&file[start..]).read_to_string(&mut text).expect("a page");
    text.split_ascii_whitespace()
        .filter(|word| word.starts_with(|first: char| first.is_ascii_alphabetic()))
        .map(Into::into)
        .collect()
}

#[test]
fn every_shape_is_written() {
    for (name, svg) in all() {
        let mut fonts = Database::new();
        fonts.load_font_data(FONT.to_vec());
        let options = Options { fontdb: fonts.into(), ..Options::default() };
        let tree = Tree::from_str(&svg.document(), &options).unwrap();
        let (shapes, images, clips) = count(tree.root(), name);
        let file = pdf(svg).unwrap();
        assert!(file.starts_with(b"%PDF-1.") && file.ends_with(b"%%EOF"), "{name}");
        let operators = operators(&file);
        let painted =
            operators.iter().filter(|word| ["S", "f", "f*", "B", "B*"].contains(&&word[..]));
        assert_eq!(painted.count(), shapes, "{name}");
        let number = |what: &str| operators.iter().filter(|word| *word == what).count();
        assert_eq!((number("Do"), number("W")), (images, clips), "{name}");
        assert_eq!(number("q"), number("Q"), "{name}");
        assert_eq!(file, pdf(svg).unwrap());
    }
}

#[test]
fn a_picture_without_size_is_refused() {
    assert!(pdf(&Svg::new(0.0, 10.0, "nothing")).is_err());
}
