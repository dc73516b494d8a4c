//! The page around the stories.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::overview::overview;
use super::story::section;
use super::style::sheet;
use super::text::Text;
use super::{Report, Story};
use crate::picture::Picture;

/// The report as one HTML document that needs nothing but itself, in a light and a dark scheme.
#[must_use]
pub fn html(report: &Report) -> String {
    let stories: String = report.stories.iter().enumerate().map(|(index, story)| section(index, story)).collect();
    // the script only serves films
    let script = match report.stories.iter().all(|story: &Story| story.film_apng.is_empty()) {
        true => String::new(),
        false => format!("<script>\n{}</script>", include_str!("player.js")),
    };
    let primer = include_str!("primer.html").replace("<!--galpixel-->", include_str!("galpixel.svg"));
    let main = [overview(report), primer, stories].concat();
    document(&report.title, &report.intro, &report.facts, &main, &script)
}

/// A document around `main`, which is HTML: the style, a heading, paragraphs and facts, which are plain text.
#[must_use]
pub fn document(title: &str, intro: &[String], facts: &[(String, String)], main: &str, script: &str) -> String {
    [
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">".to_owned(),
        "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">".to_owned(),
        "<meta name=\"color-scheme\" content=\"light dark\">".to_owned(),
        format!("<title>{}</title><style>\n{}</style></head><body>\n", Text(title), sheet()),
        header(title, intro, facts),
        format!("<main>\n{main}</main>{script}</body></html>\n"),
    ]
    .concat()
}

/// What every report says of how it was made.
#[must_use]
pub fn facts(version: &str, command: &str, machine: &str, seconds: f64) -> Vec<(String, String)> {
    let took = format!("{seconds:.0} s");
    [("Version", version), ("Command", command), ("Machine", machine), ("Took", took.as_str())]
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .to_vec()
}

/// A picture with a caption; what it shows and the caption are plain text.
#[must_use]
pub fn picture(picture: &Picture, shows: &str, caption: &str) -> String {
    // A picture in memory can be encoded; if it cannot, the page does without it.
    let bytes = picture.png().unwrap_or_default();
    format!(
        "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">\
         <figcaption>{}</figcaption></figure>",
        picture.width,
        picture.height,
        Text(shows),
        STANDARD.encode(bytes),
        Text(caption)
    )
}

/// A section of remarks, which are plain text.
#[must_use]
pub fn notes(title: &str, notes: &[String]) -> String {
    let items: String = notes.iter().map(|note| format!("<li>{}</li>", Text(note))).collect();
    format!("<section><h2>{}</h2><ul class=\"notes\">{items}</ul></section>", Text(title))
}

/// The head of a source's section: its name, what it shows, and figures about it, all plain text.
#[must_use]
pub fn source_head(index: usize, name: &str, about: &str, tags: &[(&str, String)]) -> String {
    let tags: String = tags.iter().map(|(name, value)| format!("<li><b>{name}</b> {}</li>", Text(value))).collect();
    format!(
        "<section class=\"story\" id=\"source-{index}\"><h2>{}</h2><p class=\"about\">{}</p><ul class=\"tags\">{tags}</ul>",
        Text(name),
        Text(about)
    )
}

fn header(title: &str, intro: &[String], facts: &[(String, String)]) -> String {
    let paragraphs: String = intro.iter().map(|text| format!("<p>{}</p>", Text(text))).collect();
    let facts: String = facts
        .iter()
        .map(|(name, value)| format!("<div><dt>{}</dt><dd>{}</dd></div>", Text(name), Text(value)))
        .collect();
    let facts = if facts.is_empty() { facts } else { format!("<dl class=\"facts\">{facts}</dl>") };
    format!("<header><h1>{}</h1>{paragraphs}{facts}</header>\n", Text(title))
}
