//! What every page has: its frame, facts, pictures with captions, plots, notes, heads of sections.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};

use super::style::{Ink, sheet};
use super::text::Text;
use crate::picture::Picture;

/// Returns a document around `main`: the style, a heading, paragraphs and facts.
#[must_use]
pub fn document(title: &str, intro: &[String], facts: &[Fact], main: &Markup, script: &Markup) -> String {
    html! {
        (PreEscaped("<!doctype html>\n"))
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width,initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (Text(title)) }
                style { "\n" (PreEscaped(sheet())) }
            }
            body {
                "\n"
                header {
                    h1 { (Text(title)) }
                    @for text in intro { p { (Text(text)) } }
                    @if !facts.is_empty() {
                        dl.facts { @for (name, value) in facts { div { dt { (Text(name)) } dd { (Text(value)) } } } }
                    }
                }
                "\n"
                main { "\n" (main) }
                (script)
            }
        }
        "\n"
    }
    .into_string()
}

/// A name and a value about how a report was made.
pub type Fact = (String, String);

/// Returns a picture with a caption.
#[must_use]
pub fn picture(picture: &Picture, shows: &str, caption: &str) -> Markup {
    // A picture in memory can be encoded; if it cannot, the page does without it.
    let bytes = picture.png().unwrap_or_default();
    let source = format!("data:image/png;base64,{}", STANDARD.encode(bytes));
    html! {
        figure {
            img width=(picture.width) height=(picture.height) alt=(Text(shows)) src=(source);
            figcaption { (Text(caption)) }
        }
    }
}

/// Returns a section on how to read a page; its items are markup.
#[must_use]
pub fn reading(items: &str) -> Markup {
    html! { section { h2 { "How to read it" } ul.reading { (PreEscaped(items)) } } }
}

/// Returns a section of remarks.
#[must_use]
pub fn notes(title: &str, notes: &[String]) -> Markup {
    html! { section { h2 { (Text(title)) } (list(notes)) } }
}

/// Returns remarks as a list.
#[must_use]
pub fn list(notes: &[String]) -> Markup {
    html! { ul.notes { @for note in notes { li { (Text(note)) } } } }
}

/// The introduction of a source, before its figures.
pub struct Head<'h> {
    /// Its place among the sources.
    pub index: usize,
    /// Its name.
    pub name: &'h str,
    /// What it shows.
    pub about: &'h str,
    /// Figures about it.
    pub tags: &'h [(&'h str, String)],
}

/// Returns a source's section: its head, and `body` beneath.
#[must_use]
pub fn source(head: &Head<'_>, body: &Markup) -> Markup {
    html! {
        section.story id={ "source-" (head.index) } {
            h2 { (Text(head.name)) }
            p.about { (Text(head.about)) }
            ul.tags { @for (name, value) in head.tags { li { b { (name) } " " (Text(value)) } } }
            (body)
        }
    }
}

/// Returns a line in a legend.
pub(crate) fn line_key(name: &str, ink: Ink, dashed: bool) -> Markup {
    let kind = if dashed { "key dashed" } else { "key" };
    html! { span { i class=(kind) style={ "--ink:var(--" (ink.name()) ")" } {} (Text(name)) } " " }
}

/// Returns a plot with title and caption, or a sentence if there is nothing to draw; `drawing` is an SVG element.
#[must_use]
pub fn plot(title: &str, drawing: Option<String>, remark: &str) -> Markup {
    html! {
        figure {
            h3 { (Text(title)) }
            @match drawing {
                Some(drawing) => (PreEscaped(drawing)),
                None => p.nothing { "There is nothing to draw." },
            }
            figcaption { (Text(remark)) }
        }
    }
}
