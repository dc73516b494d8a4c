//! Text and figures as they stand in HTML.

use std::fmt::{Display, Formatter, Result, Write as _};

/// Plain text in HTML content or in a quoted attribute: `& < > " '` escaped.
pub struct Text<'a>(pub &'a str);

impl Display for Text<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        for character in self.0.chars() {
            match character {
                '&' => formatter.write_str("&amp;")?,
                '<' => formatter.write_str("&lt;")?,
                '>' => formatter.write_str("&gt;")?,
                '"' => formatter.write_str("&quot;")?,
                '\'' => formatter.write_str("&#39;")?,
                // HTML has no place for other control characters, escaped or not
                control if control.is_control() && !matches!(control, '\n' | '\t') => {
                    formatter.write_str("\u{FFFD}")?
                }
                other => write!(formatter, "{other}")?,
            }
        }
        Ok(())
    }
}

impl maud::Render for Text<'_> {
    fn render_to(&self, buffer: &mut String) {
        // Writing into a string cannot fail.
        let _ = write!(buffer, "{self}");
    }
}

/// Returns a measured figure with `decimals` digits after the point; a dash if there is none or it is not finite.
pub fn figure(value: Option<f64>, decimals: usize) -> String {
    match value.filter(|value| value.is_finite()) {
        // adding 0.0 turns a negative zero into a plain one
        Some(value) => format!("{:.decimals$}", round(value, decimals) + 0.0).replace('-', "\u{2212}"),
        None => "\u{2013}".to_owned(),
    }
}

/// Returns a difference: [`figure`] with its sign.
pub fn signed(value: Option<f64>, decimals: usize) -> String {
    let plus = if value.is_some_and(|value| value.is_finite() && round(value, decimals) > 0.0) { "+" } else { "" };
    format!("{plus}{}", figure(value, decimals))
}

/// Returns a count in groups of three digits.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut grouped = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            grouped.push('\u{202F}'); // narrow no-break space
        }
        grouped.push(digit);
    }
    grouped
}

/// Returns the fragment that leads to story `index` (0 is the first): letters and digits of its name, made unique by
/// its number.
pub fn anchor(index: usize, name: &str) -> String {
    let letters = name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' });
    format!("scene-{}-{}", index + 1, letters.collect::<String>().trim_matches('-'))
}

fn round(value: f64, decimals: usize) -> f64 {
    let scale = 10.0_f64.powi(decimals as i32);
    if (value * scale).is_finite() { (value * scale).round() / scale } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_text() {
        assert_eq!(Text("a<b> & \"c\" 'd'\0").to_string(), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;\u{FFFD}");
    }

    #[test]
    fn figures_are_finite_or_dashes() {
        assert_eq!(figure(Some(-1.26), 1), "\u{2212}1.3");
        assert_eq!(figure(Some(-0.001), 2), "0.00");
        assert_eq!([figure(None, 2), figure(Some(f64::NAN), 2), figure(Some(f64::INFINITY), 2)], ["\u{2013}"; 3]);
        assert_eq!(
            [signed(Some(2.0), 1), signed(Some(-2.0), 1), signed(Some(0.01), 1)],
            ["+2.0", "\u{2212}2.0", "0.0"]
        );
    }

    #[test]
    fn counts_stand_in_threes() {
        assert_eq!(
            [count(0), count(999), count(1000), count(1_234_567)],
            ["0", "999", "1\u{202F}000", "1\u{202F}234\u{202F}567"]
        );
    }

    #[test]
    fn anchors_are_safe_in_an_attribute() {
        assert_eq!(anchor(0, "Pan & \"zoom\""), "scene-1-pan----zoom");
        assert_eq!(anchor(1, "λ"), "scene-2-");
    }
}
