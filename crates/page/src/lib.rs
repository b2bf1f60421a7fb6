//! The explorer as one HTML page, which is made by `web/build.mjs`.
//!
//! ```
//! let page = stickslip_page::showing("preset=figure3");
//! std::fs::write(std::env::temp_dir().join("stickslip-explorer.html"), page)?;
//! # Ok::<(), std::io::Error>(())
//! ```

/// The page. Any browser of 2023 or newer opens it from the disk. A link to it may end with `#` and
/// a view; the page's own button *Copy link* writes such links.
pub const PAGE: &str = include_str!("../explorer.html");

/// Where the page keeps the view that it shows when it is opened without one.
const PLACE: &str = r#"<meta name="stickslip-view" content="">"#;

/// The page that opens with a view: a link that was copied from it, or what follows the `#` there.
/// Fields that are unknown, or have no usable value, are as usual.
pub fn showing(link: &str) -> String {
    let view = link.split_once('#').map_or(link, |(_, view)| view);
    // In an address these three are written with %; here they would end the attribute.
    let view = view.replace('&', "&amp;").replace('"', "%22").replace('<', "%3C");
    PAGE.replacen(PLACE, &PLACE.replace(r#"="">"#, &format!(r#"="{view}">"#)), 1)
}

/// The view that shows a system, given as a text.
///
/// ```
/// assert_eq!(stickslip_page::view_of_system("x' = 1"), "tab=system&text=x%27%20%3D%201");
/// ```
pub fn view_of_system(text: &str) -> String {
    use std::fmt::Write;
    let mut view = String::from("tab=system&text=");
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() {
            view.push(char::from(byte));
        } else {
            // Writing to memory does not fail.
            let _ = write!(view, "%{byte:02X}");
        }
    }
    view
}

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;

#[cfg(test)]
mod tests {
    use super::{PAGE, PLACE, showing};

    #[test]
    fn the_page_has_one_place_for_a_view() {
        assert_eq!(PAGE.matches(PLACE).count(), 1);
    }

    #[test]
    fn a_view_cannot_leave_its_attribute() {
        let page = showing("file:///x.html#preset=figure3&law=\"><script>");
        let view =
            r#"<meta name="stickslip-view" content="preset=figure3&amp;law=%22>%3Cscript>">"#;
        assert!(page.contains(view));
        assert_eq!(page.len(), PAGE.len() + view.len() - PLACE.len());
    }
}
