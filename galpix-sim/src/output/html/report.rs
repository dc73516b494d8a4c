//! The page of stories.

use maud::{PreEscaped, html};

use super::overview::overview;
use super::page::document;
use super::story::section;
use super::{Report, Story};

/// Returns the report as one HTML document that needs nothing but itself, in a light and a dark scheme.
#[must_use]
pub fn html(report: &Report) -> String {
    // the script only serves films
    let films = report.stories.iter().any(|story: &Story| !story.film_apng.is_empty());
    let script = html! {
        @if films { script { "\n" (PreEscaped(include_str!("player.js"))) } }
    };
    let primer = include_str!("primer.html").replace("<!--galpixel-->", include_str!("galpixel.svg"));
    let main = html! {
        (overview(report))
        (PreEscaped(primer))
        @for (index, story) in report.stories.iter().enumerate() { (section(index, story)) }
    };
    document(&report.title, &report.intro, &report.facts, &main, &script)
}
