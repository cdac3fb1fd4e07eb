//! What becomes of claims, and of every classifier's hit rate, over several seeds, by both protocols
//! and beside placebos.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail};

use super::Arm;
use crate::moments::{SURE, Summary, VERY_SURE};
use crate::page::{Claim, Page, Recognition, Score, joined};

/// Pages of the seeds, by arms.
#[derive(Default)]
pub(super) struct Bodies(BTreeMap<Arm, Vec<Page>>);

impl Bodies {
    pub(super) fn add(&mut self, arm: Arm, page: Page) {
        self.0.entry(arm).or_default().push(page);
    }

    pub(super) fn of(&self, arm: Arm) -> &[Page] {
        self.0.get(&arm).map_or(&[], Vec::as_slice)
    }
}

/// A claim is met, is not, its seeds do not say which, or labels alone are recognised too, so that it
/// says nothing.
pub(super) const VERDICTS: [&str; 4] = ["met", "**not met**", "within noise", "**does not count**"];

/// How well something is recognised over the seeds, and how well by chance.
pub(super) struct Recognised {
    rates: Vec<f64>,
    chance: f64,
}

impl Recognised {
    /// Of the claims or scores of some seeds; none if there are none.
    pub(super) fn of(
        found: impl Iterator<Item = Recognition>,
        chance: impl Fn(&Recognition) -> Option<f64>,
    ) -> Option<Self> {
        let found: Vec<Recognition> = found.filter(|found| found.rate.is_finite()).collect();
        Some(Self {
            chance: chance(found.first()?)?,
            rates: found.iter().map(|found| found.rate).collect(),
        })
    }

    /// Whether it is recognised no better and no worse than by chance. Very sure, as a page has
    /// dozens of placebos: of a hundred that are at chance one is taken for none.
    pub(super) fn is_at_chance(&self) -> bool {
        let rate = Summary::of(&self.rates);
        // Rates that are all chance's to the last bit but for rounding have no error.
        (rate.mean - self.chance).abs() <= rate.half_interval(&VERY_SURE) + 1e-9
    }

    /// Whether it is recognised, and no worse than `other` on the same seeds.
    pub(super) fn is_as_good_as(&self, other: &Self) -> bool {
        let pairs = other.rates.iter().zip(&self.rates);
        let short: Vec<f64> = pairs.map(|(other, this)| other - this).collect();
        let short = Summary::of(&short);
        !self.is_at_chance() && short.mean <= short.half_interval(&SURE) + 1e-9
    }

    /// The rate and in brackets chance, bold where that is asked for.
    pub(super) fn text(&self, is_bold: bool) -> String {
        // κ has another scale than percent.
        let digits = if self.chance > 1.0 { 1 } else { 2 };
        let rate = Summary::of(&self.rates).text(digits, false);
        let text = format!("{rate} ({:.digits$})", self.chance);
        if is_bold { format!("**{text}**") } else { text }
    }
}

pub(super) struct Judged {
    pub(super) ours: String,
    pub(super) margin: Summary,
    unit: &'static str,
    rate: Option<Recognised>,
    pub(super) labels: Option<Recognised>,
}

impl Judged {
    pub(super) fn verdict(&self) -> &'static str {
        let labels = self.labels.as_ref();
        let do_not_count = labels.is_some_and(|labels| !labels.is_at_chance());
        VERDICTS[match self.margin.side() {
            _ if do_not_count => 3,
            1 => 0,
            -1 => 1,
            _ => 2,
        }]
    }

    /// The margin; without its error where no chance is in it.
    pub(super) fn margin_text(&self) -> String {
        let mut margin = self.margin;
        if self.rate.is_none() && margin.error <= 0.0 {
            margin.count = 1;
        }
        format!("{} {}", margin.text(digits(self.unit), true), self.unit)
    }
}

/// Digits behind the point of a margin in this unit.
pub(super) fn digits(unit: &str) -> usize {
    match unit {
        _ if unit.contains('θ') => 4,
        _ if unit.contains('κ') => 2,
        _ => 1,
    }
}

pub(super) struct Both {
    pub(super) what: String,
    pub(super) paper: String,
    pub(super) kept: Judged,
    /// None where nothing can be drawn again.
    pub(super) again: Option<Judged>,
    /// The placebo of spots.
    pub(super) spots: Option<Recognised>,
}

impl Both {
    /// Whether spots of one texture are told apart as well as textures are.
    pub(super) fn may_be_the_spot(&self) -> bool {
        let both = self.spots.as_ref().zip(self.kept.rate.as_ref());
        both.is_some_and(|(spots, textures)| spots.is_as_good_as(textures))
    }
}

pub(super) fn claims_of<'p>(pages: &'p [Page], what: &'p str) -> impl Iterator<Item = &'p Claim> {
    let of = move |page: &'p Page| page.claims.iter().find(|claim| claim.what == what);
    pages.iter().filter_map(of)
}

pub(super) fn margins(pages: &[Page], what: &str) -> Summary {
    let margins: Vec<f64> = claims_of(pages, what).map(|claim| claim.margin).collect();
    Summary::of(&margins)
}

fn judged(pages: &[Page], labels: &[Page], claim: &Claim) -> Result<Judged> {
    let found = || claims_of(pages, &claim.what);
    if found().count() != pages.len() {
        bail!("seeds differ in {:?}", claim.what);
    }
    let ours: Vec<&str> = found().map(|claim| &*claim.ours).collect();
    let recognised = |pages| {
        let found = claims_of(pages, &claim.what).filter_map(|claim| claim.recognition);
        Recognised::of(found, |found| Some(found.chance))
    };
    Ok(Judged {
        ours: joined(&ours).with_context(|| format!("seeds differ in words: {ours:?}"))?,
        margin: margins(pages, &claim.what),
        unit: claim.unit,
        rate: recognised(pages),
        labels: recognised(labels),
    })
}

pub(super) fn all_judged(bodies: &Bodies) -> Result<Vec<Both>> {
    let main = bodies.of(Arm::MAIN);
    let one = |claim: &Claim| {
        let again = bodies.of(Arm::AGAIN);
        let is_there = claims_of(again, &claim.what).next().is_some();
        let judged_again = || judged(again, bodies.of(Arm::AGAIN_LABELS), claim);
        let spots = claims_of(bodies.of(Arm::SPOTS), &claim.what);
        Ok(Both {
            what: claim.what.clone(),
            paper: claim.paper.clone(),
            kept: judged(main, bodies.of(Arm::LABELS), claim)?,
            again: is_there.then(judged_again).transpose()?,
            spots: Recognised::of(spots.filter_map(|of| of.recognition), |of| of.of_textures),
        })
    };
    let claims = main.first().map_or(&[][..], |page| &page.claims);
    claims.iter().map(one).collect()
}

fn hits(pages: &[Page], n: usize) -> String {
    let scores = || pages.iter().filter_map(|page| page.scores.get(n));
    let hits = scores().map(|score| score.recognition.rate);
    let hits: Vec<f64> = hits.filter(|hit| hit.is_finite()).collect();
    let decided: Vec<f64> = scores().filter_map(|score| score.decided).collect();
    let hit = Summary::of(&hits).text(1, false);
    match (hits.len(), decided.len()) {
        (0, _) => "nothing decided".to_owned(),
        (_, 0) => hit,
        _ => format!("{hit} of {} decided", Summary::of(&decided).text(0, false)),
    }
}

pub(super) fn scores(bodies: &Bodies) -> Vec<Vec<String>> {
    let of = |arm| bodies.of(arm);
    let scores = of(Arm::MAIN).first().map_or(&[][..], |page| &page.scores);
    let row = |(n, score): (usize, &Score)| {
        let recognised = |arm| {
            let scores = of(arm).iter().filter_map(|page| page.scores.get(n));
            let found = scores.map(|score| score.recognition);
            Recognised::of(found, |found| found.of_textures)
        };
        let both = recognised(Arm::SPOTS).zip(recognised(Arm::MAIN));
        let are_told = both.is_some_and(|(spots, all)| spots.is_as_good_as(&all));
        let spots = match (score.recognition.of_textures, hits(of(Arm::SPOTS), n)) {
            (None, _) => "–".to_owned(),
            (_, spots) if are_told => format!("**{spots}**"),
            (_, spots) => spots,
        };
        vec![
            // |DFT| must not end the cell.
            score.classifier.replace('|', "\\|"),
            score.task.clone(),
            format!("**{}**", hits(of(Arm::MAIN), n)),
            format!("**{}**", hits(of(Arm::AGAIN), n)),
            hits(of(Arm::LABELS), n),
            spots,
            hits(of(Arm::AGAIN_LABELS), n),
            format!("{:.1}", score.recognition.chance),
        ]
    };
    scores.iter().enumerate().map(row).collect()
}

pub(super) fn table_of_scores(page: &mut Page, rows: Vec<Vec<String>>) {
    if rows.is_empty() {
        return;
    }
    page.heading(2, "Every classifier");
    page.say(
        "Hit rates in percent. Placebos are recognised by the same classifier; of spots, bold is \
         what is told apart as well as textures are. What classifiers cost on a board: \
         [record 44](../decisions.md#44-what-each-classifier-of-the-experiments-takes).",
    );
    page.table(
        "classifier | on | as in the paper | drawn again | labels | spots | labels, drawn again | chance",
        rows,
    );
}

#[cfg(test)]
mod tests {
    use super::{Arm, Bodies, Both, all_judged};
    use crate::page::{Page, figure};

    fn bodies(arms: &[(Arm, [f64; 5], [f64; 5])]) -> Bodies {
        let mut bodies = Bodies::default();
        for (arm, margins, rates) in arms {
            for (margin, rate) in margins.iter().zip(rates) {
                let mut page = Page::default();
                let ours = format!("{} points", figure(*margin, 1));
                let claim = page.claim("a beats b", "so", ours, (*margin, "points"));
                claim.rests_on(*rate, 25.0);
                bodies.add(*arm, page);
            }
        }
        bodies
    }

    fn both(arms: &[(Arm, [f64; 5], [f64; 5])]) -> Both {
        all_judged(&bodies(arms)).unwrap().remove(0)
    }

    const CHANCE: [f64; 5] = [24.0, 26.0, 25.0, 27.0, 23.5];

    #[test]
    fn a_claim_is_met_beyond_its_noise_and_counts_if_labels_alone_are_at_chance() {
        let verdict = |margins: [f64; 5], labels: [f64; 5]| {
            let main = (Arm::MAIN, margins, [90.0; 5]);
            both(&[main, (Arm::LABELS, [0.0; 5], labels)])
                .kept
                .verdict()
        };
        // Errors of the means: 0.32; the interval is 2.776 times as wide.
        let margins = [1.0, 2.0, 2.0, 3.0, 2.0];
        assert_eq!(verdict(margins, CHANCE), "met");
        assert_eq!(verdict(margins.map(|m| m - 1.5), CHANCE), "within noise");
        assert_eq!(verdict(margins.map(|m| m - 4.0), CHANCE), "**not met**");
        let leak = [29.0, 30.0, 31.0, 30.0, 29.0];
        assert_eq!(verdict(margins, leak), "**does not count**");
        // Whoever is worse than chance knows the classes too.
        let worse = [20.0, 21.0, 20.0, 21.0, 20.0];
        assert_eq!(verdict(margins, worse), "**does not count**");
    }

    #[test]
    fn what_may_be_the_spot_is_told_as_well_by_spots_on_the_same_seeds() {
        let rates = [80.0, 84.0, 82.0, 83.0, 81.0];
        let of = |spots: [f64; 5]| {
            let arms = [(Arm::MAIN, [1.0; 5], rates), (Arm::SPOTS, [0.0; 5], spots)];
            both(&arms).may_be_the_spot()
        };
        assert!(of(rates.map(|rate| rate + 1.0)));
        assert!(of([79.0, 85.0, 82.0, 84.0, 79.0]));
        // Worse by two points, each seed beside its own.
        assert!(!of([78.0, 82.0, 80.5, 81.0, 79.0]));
        assert!(!of(CHANCE));
    }
}
