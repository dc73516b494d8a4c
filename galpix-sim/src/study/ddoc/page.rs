//! The study as a page: a table, and each world's pictures.

use super::pictures::Pictures;
use super::report::{Document, SourceReport};
use crate::output::html;
use crate::output::html::text::{Text, count, figure};

/// The document as a self-contained page. `pictures` are those of the document's sources, in their order.
#[must_use]
pub fn html(document: &Document, pictures: &[Pictures]) -> String {
    let intro = [
        "A depth image lacks what is hidden behind the edges that it sees. The depth discontinuity occlusion camera looks a \
         little around each edge, so that a frame made from beside it has fewer holes."
            .to_owned(),
    ];
    let facts = [
        ("Version".to_owned(), document.version.to_owned()),
        ("Command".to_owned(), document.command.clone()),
        ("Machine".to_owned(), document.machine.clone()),
    ];
    let sections: String =
        document.sources.iter().zip(pictures).map(|(source, pictures)| section(source, pictures)).collect();
    let main = [READING.to_owned(), table(document), sections].concat();
    html::document("galpix: what is hidden behind edges", &intro, &facts, &main, "")
}

const READING: &str = "<section><h2>How to read it</h2><ul class=\"reading\">\
<li>Both <b>reference images</b> are taken from the same place, 90\u{00B0} wide; frames are made from them for the 26 middles of the \
faces, edges and corners of a cube around it, 45\u{00B0} wide.</li>\
<li><b>Missing</b> are samples of the truth, rendered from geometry, for which the frame has none of the same depth within a pixel; \
<b>strict</b>, at the very pixel. Figures are means over the views.</li>\
<li>In the <b>map</b>, hue is the direction in which the DDOC moves what is far, and strength how far.</li>\
</ul></section>";

fn table(document: &Document) -> String {
    let row = |source: &SourceReport| {
        let mean = |sum: u64| figure(Some(sum as f64 / source.views.max(1) as f64), 0);
        let percent = |share: Option<f64>| figure(share.map(|share| 100.0 * share), 1);
        let cells = [
            count(source.triangles as u64),
            format!("{}", source.radius),
            format!("{}", source.asymmetry),
            mean(source.missing_plain),
            mean(source.missing_ddoc),
            percent(source.ratio),
            mean(source.strict_plain),
            mean(source.strict_ddoc),
            percent(source.strict_ratio),
            count(source.samples as u64),
            figure(Some(source.seconds.total), 2),
        ];
        let cells = cells.map(|cell| format!("<td>{cell}</td>")).concat();
        format!("<tr><td class=\"word\">{}</td>{cells}</tr>", Text(&source.source))
    };
    let rows: String = document.sources.iter().map(row).collect();
    format!(
        "<section><h2>Missing samples</h2><div class=\"wide\"><table class=\"rows points\"><thead><tr><th>world</th>\
         <th>triangles</th><th>D px</th><th>a_f</th><th>plain</th><th>DDOC</th><th>ratio %</th><th>strict plain</th><th>DDOC</th>\
         <th>ratio %</th><th>samples</th><th>seconds</th></tr></thead><tbody>{rows}</tbody></table></div></section>"
    )
}

fn section(source: &SourceReport, pictures: &Pictures) -> String {
    let shown = |(name, caption, picture): &(&str, &str, crate::picture::Picture)| {
        html::picture(picture, &format!("{}: {name}", source.source), caption)
    };
    let figures: String = pictures.all.iter().map(shown).collect();
    format!(
        "<section class=\"story\"><h2>{}</h2><p class=\"about\">{}</p><div class=\"crops\">{figures}</div></section>",
        Text(&source.source),
        Text(&source.about)
    )
}
