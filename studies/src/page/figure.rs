//! Figures that come of chance, marked in the text that has them, so that the texts of
//! several seeds can be joined to one of means with their errors.

use std::fmt;

use crate::moments::Summary;

/// What begins and ends a mark, and parts its fields: no text has these.
const BEGIN: char = '\u{2}';
const END: char = '\u{3}';
const BETWEEN: char = '\u{1f}';

/// A figure with so many digits behind the point; `{:+}` shows its sign.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Figure {
    value: f64,
    digits: usize,
}

pub(crate) const fn figure(value: f64, digits: usize) -> Figure {
    Figure { value, digits }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, digits } = self;
        let sign = if f.sign_plus() { "+" } else { "" };
        write!(f, "{BEGIN}{sign}{BETWEEN}{digits}{BETWEEN}{value:e}{END}")
    }
}

/// What stands between the figures of a text, and these: whether with a sign, digits and value.
type Parts<'t> = (Vec<&'t str>, Vec<(bool, usize, f64)>);

fn parts(text: &str) -> Option<Parts<'_>> {
    let (mut words, mut figures, mut rest) = (Vec::new(), Vec::new(), text);
    while let Some((before, behind)) = rest.split_once(BEGIN) {
        let (mark, after) = behind.split_once(END)?;
        let mut fields = mark.split(BETWEEN);
        let is_signed = !fields.next()?.is_empty();
        let digits = fields.next()?.parse().ok()?;
        figures.push((is_signed, digits, fields.next()?.parse().ok()?));
        words.push(before);
        rest = after;
    }
    words.push(rest);
    Some((words, figures))
}

/// One text of several that differ in their figures alone: means, with their standard errors
/// if there are two texts or more, of those figures that are numbers. None where anything else differs.
pub(crate) fn joined(texts: &[&str]) -> Option<String> {
    joined_beside(&[texts])
}

/// The same of groups of texts: the means of each group, divided by `/`, or one where all are
/// the same.
pub(crate) fn joined_beside<'t>(groups: &[&[&'t str]]) -> Option<String> {
    let of_group = |texts: &&[&'t str]| texts.iter().map(|text| parts(text)).collect();
    let all: Vec<Vec<Parts<'_>>> = groups.iter().map(of_group).collect::<Option<_>>()?;
    let (words, figures) = all.first()?.first()?;
    if all.iter().flatten().any(|(other, _)| other != words) {
        return None;
    }
    let mut text = words[0].to_owned();
    for (n, (is_signed, digits, _)) in figures.iter().enumerate() {
        let mean = |group: &Vec<Parts<'_>>| {
            // What is missing in a text has no part in the mean.
            let values = group.iter().map(|(_, figures)| figures[n].2);
            let values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
            match values.len() {
                0 => "–".to_owned(),
                _ => Summary::of(&values).text(*digits, *is_signed),
            }
        };
        let mut means: Vec<String> = all.iter().map(mean).collect();
        means.dedup();
        text.push_str(&means.join(" / "));
        text.push_str(words[n + 1]);
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::{figure, joined, joined_beside};

    #[test]
    fn figures_of_several_texts_become_means_with_their_errors() {
        let text = |a: f64, b: f64| format!("x {} %, {:+} points", figure(a, 1), figure(b, 0));
        let texts = [text(80.0, -2.0), text(84.0, 3.0), text(82.0, 2.0)];
        let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
        // Standard deviations of 2 and √7 over √3.
        let found = joined(&texts).unwrap();
        assert_eq!(found, "x 82.0 ± 1.2 %, +1 ± 2 points");
        assert_eq!(joined(&texts[..1]).unwrap(), "x 80.0 %, -2 points");
        let none = figure(f64::NAN, 1).to_string();
        assert_eq!(joined(&[&none, &none]).unwrap(), "–");
        let beside = [&texts[..], &texts[..1]];
        let found = joined_beside(&beside).unwrap();
        assert_eq!(found, "x 82.0 ± 1.2 / 80.0 %, +1 ± 2 / -2 points");
        assert_eq!(joined_beside(&[&texts, &texts]), joined(&texts));
        let one = figure(2.0, 1).to_string();
        assert_eq!(joined(&[&none, &one]).unwrap(), "2.0");
        assert!(joined(&[&one, &format!("{one} more")]).is_none());
        // The paper's own figure keeps its digits.
        let beside = crate::page::beside(82.5, 49.6);
        assert_eq!(joined(&[&beside]).unwrap(), "82.5 / **50**");
    }
}
