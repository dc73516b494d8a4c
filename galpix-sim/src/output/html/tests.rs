//! The page as a whole: escaped, balanced, self-contained, whatever the figures are.

use super::overview::{Standing, Summary};
use super::*;

/// Returns a story with every part; `frames` rows.
fn story(name: &str, frames: u32) -> Story {
    let row = |frame: u32| Row {
        frame,
        measures: Measures {
            psnr_db: Some(40.0 - f64::from(frame)),
            psnr_inside_db: Some(41.0),
            change_error: Some(1.5),
            judder_px: Some(0.25),
            missing_percent: Some(5.0 * f64::from(frame)),
        },
        psnr_hold_db: Some(30.0 - f64::from(frame)),
        psnr_known_db: Some(42.0),
        position_error_px: Some(0.1 * f64::from(frame)),
        mean_position_error_px: Some(0.05),
        holes: u64::from(frame) * 10,
        filled: u64::from(frame) * 9,
        ns_per_galpixel: Some(f64::from(frame)),
        ..Row::default()
    };
    let per_frame_px = (0..=frames).map(|frame| 0.4 + 0.02 * f64::from(frame)).collect();
    Story {
        name: name.to_owned(),
        about: "A wall behind a pole.".to_owned(),
        width: 20,
        height: 10,
        budget_line: "D = 1024".to_owned(),
        rounding: "low-discrepancy".to_owned(),
        fill: "bullet".to_owned(),
        certificate: Some(CertificateLine {
            quantisation_px: 0.59375,
            drift_px: 0.25,
            total_px: 0.84375,
            holds: true,
            per_frame_px,
            prop: 16,
        }),
        film_apng: crate::output::film::apng(
            &[crate::picture::Picture::filled(3, 2, [9; 3])],
            40,
            crate::output::film::Colours::Exact,
        )
        .expect("a film"),
        heat: None,
        rows: (1..=frames).map(row).collect(),
        notes: vec!["The pole is thin.".to_owned()],
    }
}

fn report(stories: Vec<Story>) -> Report {
    Report {
        title: "galpix".to_owned(),
        intro: vec!["Moved, not held.".to_owned()],
        facts: vec![("version".to_owned(), "0.1.0".to_owned())],
        stories,
    }
}

/// Returns the document without what is not markup.
fn markup(html: &str) -> String {
    let mut left = html.to_owned();
    for element in ["script", "style"] {
        while let Some(start) = left.find(&format!("<{element}>")) {
            let end = left[start..].find(&format!("</{element}>")).expect("a closing tag") + start + element.len() + 3;
            left.replace_range(start..end, "");
        }
    }
    left
}

/// Panics unless every element is closed by its own tag, in order.
fn assert_balanced(html: &str) {
    const VOID: [&str; 3] = ["meta", "img", "!doctype"];
    let mut open = Vec::new();
    let markup = markup(html);
    for tag in markup.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').unwrap_or_else(|| panic!("a bare < before {tag:.60}"));
        let name = tag.trim_start_matches('/').split([' ', '\n']).next().unwrap_or_default().trim_end_matches('/');
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "closed in the wrong order");
        } else if !VOID.contains(&name) && !tag.ends_with('/') {
            open.push(name);
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "an open quote in <{tag:.120}>");
    }
    assert!(open.is_empty(), "never closed: {open:?}");
}

/// Panics if the page loads anything from elsewhere.
fn assert_self_contained(html: &str) {
    for outside in ["http:", "https:", "//cdn", "@import", "url(", "<link", "<iframe", "src=\"/", "src=\"."] {
        assert!(!html.contains(outside), "the page contains {outside}");
    }
    for (attribute, allowed) in [("src=\"", "data:image/png;base64,"), ("href=\"", "#")] {
        assert!(html.split(attribute).skip(1).all(|value| value.starts_with(allowed)), "a strange {attribute}");
    }
}

#[test]
fn every_kind_of_report_is_balanced_and_self_contained() {
    let bare = Story { name: "bare".to_owned(), ..Story::default() };
    let blind = Story {
        rows: (1..4).map(|frame| Row { frame, ..Row::default() }).collect(),
        certificate: Some(CertificateLine::default()),
        ..bare.clone()
    };
    let absurd = Story {
        rows: vec![Row {
            frame: u32::MAX,
            measures: Measures { psnr_db: Some(f64::NAN), missing_percent: Some(f64::INFINITY), ..Measures::default() },
            holes: u64::MAX,
            ..Row::default()
        }],
        film_apng: vec![1, 2, 3],
        ..bare.clone()
    };
    let kinds = [
        vec![],
        vec![bare.clone()],
        vec![blind],
        vec![absurd],
        vec![story("one", 1)],
        vec![story("all", 16), bare, story("long", 90)],
    ];
    for stories in kinds {
        let html = html(&report(stories));
        assert_balanced(&html);
        assert_self_contained(&html);
        assert!(!html.contains("NaN") && !html.contains("inf<"));
    }
}

#[test]
#[should_panic(expected = "closed in the wrong order")]
fn the_balance_check_can_fail() {
    assert_balanced("<p><b>text</p></b>");
}

#[test]
fn hostile_text_stays_text() {
    let hostile = "<script>alert('x')</script>\" onload=\"y & z";
    let mut story = story(hostile, 2);
    for text in [&mut story.about, &mut story.budget_line, &mut story.rounding, &mut story.fill, &mut story.notes[0]] {
        *text = hostile.to_owned();
    }
    let mut report = report(vec![story]);
    report.title = hostile.to_owned();
    report.intro = vec![hostile.to_owned()];
    report.facts = vec![(hostile.to_owned(), hostile.to_owned())];
    let html = html(&report);
    assert!(!html.contains("<script>alert") && !html.contains("\" onload"));
    // title twice, intro, fact twice, contents, overview, heading, about, three tags, film, three plots, note
    assert_eq!(html.matches("&lt;script&gt;alert(&#39;x&#39;)").count(), 17);
    assert_balanced(&html);
}

#[test]
fn a_story_has_its_film_plots_certificate_and_table() {
    let html = html(&report(vec![story("pan", 16)]));
    assert!(html.contains("<img width=\"3\" height=\"2\""));
    assert_eq!(html.matches("<svg class=\"plot\"").count(), 3);
    assert!(html.contains("keeps the paper\u{2019}s one-pixel promise: at most 0.8438\u{00A0}px up to frame 16."));
    assert!(html.contains("is 1.6000\u{00A0}px, past the bound of its frame first in frame 6"));
    assert!(html.contains("certified bound"));
    assert_eq!(html.matches("<tr><td>").count(), 16);
    assert!(html.contains("href=\"#scene-1-pan\"") && html.contains("id=\"scene-1-pan\""));
}

#[test]
fn overview_and_table_have_the_measures_that_every_table_has() {
    let html = html(&report(vec![story("pan", 16)]));
    for (name, mean, of_frame_2) in [
        ("inside dB", "41.00", "41.00"),
        ("change", "1.50", "1.50"),
        ("judder px", "0.250", "0.250"),
        ("missing %", "42.50", "10.00"),
    ] {
        assert!(html.contains(&format!("<td data-name=\"{name}\"><span>{mean}</span></td>")), "{name}: {mean}");
        assert_eq!(html.matches(&format!(">{name}</th>")).count(), 2, "{name}");
        assert!(html.contains(&format!("<td>{of_frame_2}</td>")), "{name}: {of_frame_2}");
    }
}

#[test]
fn a_promise_not_kept_is_said() {
    let mut story = story("pan", 4);
    story.certificate = Some(CertificateLine { total_px: 1.46875, holds: false, ..CertificateLine::default() });
    let html = html(&report(vec![story]));
    assert!(html.contains("does not keep the paper\u{2019}s one-pixel promise: at most 1.4688\u{00A0}px."));
    assert!(html.contains("is 0.4000\u{00A0}px; each frame is inside"));
}

/// A promise of the arithmetic is none of what is seen where the true motion leaves the path.
#[test]
fn what_no_certificate_covers_is_said_beside_the_promise() {
    let mut story = story("near-plane", 4);
    story.rows[3].truth_error_px = Some(22.3);
    let html = html(&report(vec![story.clone()]));
    assert!(
        html.contains("<p class=\"promise poor\">") && html.contains("up to 22.3000\u{00A0}px from the true motion"),
        "{html}"
    );
    story.rows[3].truth_error_px = Some(0.45);
    let html = super::html(&report(vec![story]));
    assert!(html.contains("<p class=\"promise good\">") && html.contains("at most 0.4500\u{00A0}px."));
}

#[test]
fn columns_without_figures_leave_their_plot_out_with_a_word() {
    let mut story = story("blind", 5);
    story.certificate = None;
    for row in &mut story.rows {
        *row = Row { frame: row.frame, holes: 3, ..Row::default() };
    }
    let html = html(&report(vec![story]));
    assert_eq!(html.matches("<svg class=\"plot\"").count(), 1);
    assert!(html.contains("No truth to compare with.") && html.contains("The true motion is not known here."));
}

#[test]
fn the_script_comes_with_films_only() {
    let mut silent = story("pan", 2);
    assert!(html(&report(vec![silent.clone()])).contains("<script>"));
    silent.film_apng.clear();
    assert!(!html(&report(vec![silent])).contains("<script>"));
}

#[test]
fn a_summary_is_of_the_frames_compared() {
    let mut story = story("pan", 4);
    (story.rows[3].measures, story.rows[3].psnr_hold_db) = (Measures::default(), None);
    let summary = Summary::of(&story);
    // Means of 1 to 3.
    assert_eq!((summary.frame, summary.measures.psnr_db, summary.psnr_hold_db), (Some(4), Some(38.0), Some(28.0)));
    assert_eq!((summary.measures.psnr_inside_db, summary.measures.missing_percent), (Some(41.0), Some(10.0)));
    assert_eq!(summary.gain_db, Some(10.0));
    assert_eq!(summary.worst_px, Some(0.4)); // of all frames
    assert_eq!(
        (summary.bound_px, summary.standing),
        (Some(0.4 + 0.02 * 4.0), Some(Standing::Inside)),
        "of these frames"
    );
    assert_eq!(summary.truth_px, None);
    assert_eq!(summary.ns_per_galpixel, Some(2.5)); // median of 1, 2, 3, 4
    assert_eq!(Summary::of(&Story::default()), Summary::default());
}

#[test]
fn each_frame_stands_against_its_own_bound() {
    // measured 0.1, 0.2, 0.3, 0.4
    let standing = |per_frame_px: &[f64], total_px: f64| {
        let mut story = story("pan", 4);
        let per_frame_px = per_frame_px.to_vec();
        story.certificate = Some(CertificateLine { total_px, per_frame_px, ..CertificateLine::default() });
        let summary = Summary::of(&story);
        (summary.worst_px, summary.standing)
    };
    assert_eq!(standing(&[0.0, 0.2, 0.3, 0.4, 0.5], 0.5), (Some(0.4), Some(Standing::Inside)));
    assert_eq!(standing(&[0.0, 0.5, 0.1, 0.5, 0.1], 0.5), (Some(0.4), Some(Standing::BeyondFrom(2))));
    assert_eq!(standing(&[0.5, 0.5, 0.5], 0.5), (Some(0.2), Some(Standing::Inside)), "frames 3 and 4 are not covered");
    assert_eq!(standing(&[0.5], 0.5), (None, None));
    assert_eq!(standing(&[], 0.35), (Some(0.4), Some(Standing::BeyondFrom(4))));
}
