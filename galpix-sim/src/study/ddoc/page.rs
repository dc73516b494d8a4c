//! The study as a page: a table, and each world's pictures.

use maud::{Markup, html};

use super::columns::columns;
use super::{Document, Seen};
use crate::output::column;
use crate::output::html::text::Text;
use crate::output::html::{self as page};

/// Returns the document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "A depth image lacks what is hidden behind the edges that it sees. The depth discontinuity occlusion camera looks a \
         little around each edge, so that a frame seen from another place has fewer holes."
            .to_owned(),
    ];
    let reports: Vec<_> = document.sources.iter().map(|seen| seen.report.clone()).collect();
    let main = html! {
        (page::reading(READING))
        section { h2 { "Missing samples" } (column::html("rows points", &columns(), &reports)) }
        @for seen in &document.sources { (section(seen)) }
    };
    page::document("galpix: what is hidden behind edges", &intro, &document.facts(), &main, &Markup::default())
}

const READING: &str = "\
<li>Both <b>reference images</b> are taken from the same place, 90\u{00B0} wide; frames are made from them for the 26 middles of the \
faces, edges and corners of a cube around it, 45\u{00B0} wide.</li>\
<li><b>Missing</b> are samples of the truth, rendered from geometry, for which the frame has none of the same depth within a pixel; \
<b>strict</b>, at the very pixel. Figures are means over the views.</li>\
<li>In the <b>map</b>, hue is the direction in which the DDOC moves what is far, and strength how far.</li>";

fn section(seen: &Seen) -> Markup {
    let report = &seen.report;
    html! {
        section.story {
            h2 { (Text(&report.source)) }
            p.about { (Text(&report.about)) }
            div.crops {
                @for (name, caption, picture) in &seen.pictures.all {
                    (page::picture(picture, &format!("{}: {name}", report.source), caption))
                }
            }
        }
    }
}
