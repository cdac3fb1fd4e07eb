//! What becomes of claims over several seeds and beside a placebo.

use crate::moments::{SURE, Summary, VERY_SURE};
use crate::page::{Claim, Page, Recognition, joined};
use anyhow::{Context, Result, bail};

/// Pages of the seeds: as it is, and of placebos.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    pub(super) pages: Vec<Page>,
    pub(super) placebos: Vec<Page>,
}

impl Bodies {
    pub(super) const fn of(&mut self, is_placebo: bool) -> &mut Vec<Page> {
        if is_placebo {
            &mut self.placebos
        } else {
            &mut self.pages
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    Met,
    /// It does not.
    NotMet,
    /// The seeds do not say whether it does.
    WithinNoise,
    /// Its placebo is recognised too, so that it says nothing.
    DoesNotCount,
}

impl Verdict {
    pub(super) const fn text(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::NotMet => "**not met**",
            Self::WithinNoise => "within noise",
            Self::DoesNotCount => "**does not count**",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placebo {
    rate: Summary,
    chance: f64,
}

impl Placebo {
    fn of(found: &[Recognition]) -> Option<Self> {
        let chance = found.first()?.chance;
        let rates: Vec<f64> = found.iter().map(|found| found.rate).collect();
        let rate = Summary::of(&rates);
        Some(Self { rate, chance })
    }

    /// Whether it is recognised no better and no worse than by chance. Very sure, as a page has
    /// dozens of placebos: of a hundred that are at chance one is taken for none.
    fn is_at_chance(&self) -> bool {
        let off = (self.rate.mean - self.chance).abs();
        // Rates that are all chance's to the last bit but for rounding have no error.
        off <= self.rate.half_interval(&VERY_SURE) + 1e-9
    }

    pub(super) fn text(&self) -> String {
        // κ has another scale than percent.
        let digits = if self.chance > 1.0 { 1 } else { 2 };
        let Self { rate, chance } = self;
        let text = format!("{} ({chance:.digits$})", rate.text(digits, false));
        if self.is_at_chance() {
            text
        } else {
            format!("**{text}**")
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    pub(super) what: String,
    pub(super) paper: String,
    pub(super) ours: String,
    pub(super) margin: Summary,
    pub(super) unit: &'static str,
    pub(super) placebo: Option<Placebo>,
}

impl Judged {
    pub(super) fn verdict(&self) -> Verdict {
        if self.placebo.is_some_and(|placebo| !placebo.is_at_chance()) {
            return Verdict::DoesNotCount;
        }
        let half = self.margin.half_interval(&SURE);
        if self.margin.mean > half {
            Verdict::Met
        } else if self.margin.mean < -half {
            Verdict::NotMet
        } else {
            Verdict::WithinNoise
        }
    }

    /// The margin; without its error where no chance is in it.
    pub(super) fn margin_text(&self) -> String {
        let is_certain = self.placebo.is_none() && self.margin.error <= 0.0;
        let count = if is_certain { 1 } else { self.margin.count };
        Summary {
            count,
            ..self.margin
        }
        .text(self.digits(), true)
    }

    /// Digits behind the point of the margin.
    fn digits(&self) -> usize {
        if self.unit.contains('θ') {
            4
        } else if self.unit.contains('κ') {
            2
        } else {
            1
        }
    }
}

fn of_all(pages: &[Page], n: usize) -> impl Iterator<Item = &Claim> {
    pages.iter().filter_map(move |page| page.claims.get(n))
}

pub(super) fn judged(pages: &[Page], placebos: &[Page]) -> Result<Vec<Judged>> {
    let claims = pages.first().map_or(&[][..], |page| &page.claims);
    let one = |(n, claim): (usize, &Claim)| {
        let ours: Vec<&str> = of_all(pages, n).map(|claim| &*claim.ours).collect();
        let same = of_all(pages, n).filter(|other| other.what == claim.what);
        let margins: Vec<f64> = same.map(|claim| claim.margin).collect();
        if margins.len() != pages.len() {
            bail!("seeds differ in {:?}", claim.what);
        }
        let found: Vec<Recognition> = of_all(placebos, n)
            .filter_map(|claim| claim.recognition)
            .collect();
        Ok(Judged {
            what: claim.what.clone(),
            paper: claim.paper.clone(),
            ours: joined(&ours).with_context(|| format!("seeds differ in words: {ours:?}"))?,
            margin: Summary::of(&margins),
            unit: claim.unit,
            placebo: Placebo::of(&found),
        })
    };
    claims.iter().enumerate().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::{Verdict, judged};
    use crate::page::{Page, figure};

    fn pages(margins: &[f64], rates: &[f64]) -> Vec<Page> {
        let page = |(margin, rate): (&f64, &f64)| {
            let mut page = Page::default();
            let ours = format!("{} points", figure(*margin, 1));
            let claim = page.claim("a beats b", "so", ours, (*margin, "points"));
            claim.rests_on(*rate, 25.0);
            page
        };
        margins.iter().zip(rates).map(page).collect()
    }

    #[test]
    fn a_claim_is_met_beyond_its_noise_and_counts_if_its_placebo_is_at_chance() {
        let chance = pages(&[0.0; 5], &[24.0, 26.0, 25.0, 27.0, 23.5]);
        let leak = pages(&[0.0; 5], &[29.0, 30.0, 31.0, 30.0, 29.0]);
        let verdict = |margins: [f64; 5], placebos| {
            let found = judged(&pages(&margins, &[90.0; 5]), placebos).unwrap();
            found[0].verdict()
        };
        // Errors of the means: 0.32; the interval is 2.776 times as wide.
        let margins = [1.0, 2.0, 2.0, 3.0, 2.0];
        assert_eq!(verdict(margins, &chance), Verdict::Met);
        assert_eq!(
            verdict(margins.map(|m| m - 1.5), &chance),
            Verdict::WithinNoise
        );
        assert_eq!(verdict(margins.map(|m| m - 4.0), &chance), Verdict::NotMet);
        assert_eq!(verdict(margins, &leak), Verdict::DoesNotCount);
        // Whoever is worse than chance knows the classes too.
        let worse = pages(&[0.0; 5], &[20.0, 21.0, 20.0, 21.0, 20.0]);
        assert_eq!(verdict(margins, &worse), Verdict::DoesNotCount);
    }
}
