//! What is in a picture, read from its document.

use resvg::usvg::fontdb::Database;
use resvg::usvg::{Group, Node, Options, Rect, TextChunk, Tree};
use roxmltree::Document;
use stickslip_figure::Svg;

pub const FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-subset.ttf");

/// A text of a picture, and the rectangle around it.
#[derive(Clone, Debug)]
pub struct PlacedText {
    pub text: String,
    pub at: Rect,
    pub upwards: bool,
    /// Whether the font has all its characters.
    pub complete: bool,
}

/// All texts in the order of the document, without subscripts and superscripts being marked.
pub fn texts(svg: &Svg) -> Vec<String> {
    let document = svg.document();
    let document = Document::parse(&document).unwrap();
    words(document.root())
}

/// The texts in all groups of a class.
pub fn texts_in(svg: &Svg, class: &str) -> Vec<String> {
    let document = svg.document();
    let document = Document::parse(&document).unwrap();
    let groups = document.descendants().filter(|node| node.attribute("class") == Some(class));
    groups.flat_map(words).collect()
}

/// The texts that browsers show under the pointer.
pub fn hints(svg: &Svg) -> Vec<String> {
    let document = svg.document();
    let document = Document::parse(&document).unwrap();
    let areas = document.descendants().filter(|node| node.has_tag_name("path"));
    areas
        .flat_map(|area| area.descendants())
        .filter(roxmltree::Node::is_text)
        .filter_map(|node| node.text())
        .map(Into::into)
        .collect()
}

/// The number of elements in all groups of a class.
pub fn count_in(svg: &Svg, class: &str, element: &str) -> usize {
    let document = svg.document();
    let document = Document::parse(&document).unwrap();
    let groups = document.descendants().filter(|node| node.attribute("class") == Some(class));
    groups.flat_map(|group| group.children()).filter(|node| node.has_tag_name(element)).count()
}

fn words(root: roxmltree::Node<'_, '_>) -> Vec<String> {
    let texts = root.descendants().filter(|node| node.has_tag_name("text"));
    let pieces = |text: roxmltree::Node<'_, '_>| {
        text.descendants()
            .filter(roxmltree::Node::is_text)
            .filter_map(|piece| piece.text())
            .collect()
    };
    texts.map(pieces).collect()
}

/// All texts with their places, set in the font of the PNG pictures.
pub fn placed(svg: &Svg) -> (Rect, Vec<PlacedText>) {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    let options = Options { fontdb: fonts.into(), ..Options::default() };
    let tree = Tree::from_str(&svg.document(), &options).unwrap();
    let mut texts = Vec::new();
    collect(tree.root(), &mut texts);
    let picture = Rect::from_xywh(0.0, 0.0, tree.size().width(), tree.size().height()).unwrap();
    (picture, texts)
}

fn collect(group: &Group, texts: &mut Vec<PlacedText>) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect(group, texts),
            Node::Text(text) => {
                let mut glyphs = text.layouted().iter().flat_map(|span| &span.positioned_glyphs);
                let words = text.chunks().iter().map(TextChunk::text).collect();
                let complete = glyphs.all(|glyph| glyph.id.0 != 0);
                let (at, upwards) = (text.abs_bounding_box(), text.abs_transform().has_skew());
                texts.push(PlacedText { text: words, at, upwards, complete });
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}
