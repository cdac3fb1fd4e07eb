//! Which variant is chosen, and why.

use super::super::page::{Page, short, verdict};
use super::measure::{Row, Study};
use super::model::{Deficit, Entry, Exponential, Variant};
use super::text::{bytes, percent};

/// Share of identical decisions aimed at.
const IDENTICAL: f64 = 0.995;
/// Error of the posterior aimed at.
const POSTERIOR: f64 = 0.01;

/// What the paragraphs ask a study.
struct Asked<'s>(&'s Study);

impl Asked<'_> {
    fn row(&self, variant: Variant) -> &Row {
        // The study has all variants.
        self.0.of(variant).unwrap_or(&self.0.product)
    }

    /// Largest error of the leading class.
    fn leader(&self, variant: Variant) -> f64 {
        self.row(variant).errors.leader.largest
    }

    /// Percent of identical decisions on the textures, restarted.
    fn textures(&self, variant: Variant) -> String {
        percent(self.row(variant).restarted(1).share())
    }

    /// Bytes of constants and of state that it needs less than the product.
    fn saved(&self, variant: Variant) -> [i64; 2] {
        let [product, other] = [None, Some(variant)].map(|variant| bytes(self.0, variant));
        [0, 1].map(|n| product[n] as i64 - other[n] as i64)
    }
}

const fn entry(bits: u32) -> Variant {
    Variant {
        entry: Entry::Full(bits),
        ..Variant::PRODUCT
    }
}

const fn deficit(deficit: Deficit) -> Variant {
    Variant {
        deficit,
        ..Variant::PRODUCT
    }
}

const fn exponential(exponential: Exponential) -> Variant {
    Variant {
        exponential,
        ..Variant::PRODUCT
    }
}

/// Appends the choice, its goals, and a paragraph for each of the three.
pub(super) fn write(page: &mut Page, study: &Study) {
    let asked = Asked(study);
    let p = Variant::PRODUCT;
    let errors = &study.product.errors;
    page.say(format_args!(
        "**Chosen: entries of {} bits with {} units a bit, deficits of {} bits, and 2^−x of {}.** \
         The log posterior of the leading class is then within {} of double precision ({} on \
         average). A decision differs only where a posterior is nearer to the threshold than its \
         own error; where everyone goes on by himself, one that falls a block apart moves those \
         after it, too.",
        p.entry.bits(),
        p.entry.per_bit(),
        p.deficit.bits(),
        p.exponential.name(),
        short(errors.leader.largest),
        short(errors.leader.mean()),
    ));
    goals(page, study);
    entries(page, &asked);
    deficits(page, &asked);
    exponentials(page, &asked);
}

fn goals(page: &mut Page, study: &Study) {
    let product = &study.product;
    let posterior = product.errors.posterior.largest;
    let mut rows = vec![vec![
        format!("posterior within {POSTERIOR}"),
        short(posterior),
        verdict(posterior <= POSTERIOR).to_owned(),
    ]];
    for (n, about) in study.about.iter().enumerate() {
        for (how, same) in [
            ("restarted", product.restarted(n)),
            ("running", product.running(n)),
        ] {
            rows.push(vec![
                format!(
                    "{} % of sequential decisions identical, {}, {how}",
                    percent(IDENTICAL),
                    about.name
                ),
                format!("{} of {}", same.same, same.of),
                verdict(same.share() >= IDENTICAL).to_owned(),
            ]);
        }
    }
    page.table("goal of the product | found | ", rows);
}

fn entries(page: &mut Page, asked: &Asked<'_>) {
    let error = asked.0.product.errors.leader.largest;
    let [constants, _] = bytes(asked.0, None);
    page.say(format_args!(
        "The entries decide the error. With 12 bits it is {:.1} times as large and with 8 bits \
         {:.0} times, and {} % and {} % of the decisions on the textures are identical (restarted; \
         {} % with the product's), for {} and {} bytes saved of {constants}. All of 16 bits, {} \
         units a bit, bring it down to {} ({} %), but such entries exceed a third of 2¹⁶: those \
         of three channels no longer add two classes at a time without a carry.",
        asked.leader(entry(12)) / error,
        asked.leader(entry(8)) / error,
        asked.textures(entry(12)),
        asked.textures(entry(8)),
        percent(asked.0.product.restarted(1).share()),
        asked.saved(entry(12))[0],
        asked.saved(entry(8))[0],
        Entry::Full(16).per_bit(),
        short(asked.leader(entry(16))),
        asked.textures(entry(16)),
    ));
}

fn deficits(page: &mut Page, asked: &Asked<'_>) {
    let [_, state] = bytes(asked.0, None);
    let [wide, narrow] = [Deficit::Bits64, Deficit::Bits16].map(deficit);
    page.say(format_args!(
        "Deficits of 64 bits leave {} where 32 bits have {}, for {} bytes of state more than \
         {state}. Those of 16 bits save {} bytes and make it {}; for every class it is {} in place \
         of {}, as they hold a class {:.0} bit behind the leader, from where it comes back early.",
        short(asked.leader(wide)),
        short(asked.0.product.errors.leader.largest),
        -asked.saved(wide)[1],
        asked.saved(narrow)[1],
        short(asked.leader(narrow)),
        short(asked.row(narrow).errors.all.largest),
        short(asked.0.product.errors.all.largest),
        Deficit::range_bit_16(),
    ));
}

fn exponentials(page: &mut Page, asked: &Asked<'_>) {
    let [exact, lines, micromath, shift] = [
        Exponential::Exact,
        Exponential::Lines16,
        Exponential::Micromath,
        Exponential::Shift,
    ]
    .map(exponential);
    page.say(format_args!(
        "An exact 2^−x gives {}: what the {} add does not show beside the table's error. On these \
         recordings 16 lines ({}) would do as well and save {} bytes; but their own error, {}, is \
         {:.1} of that of the table on average ({}), and that of the {} is {}, which leaves the \
         table the only error to think of. `micromath` ({}) has an error of {} by itself and \
         wants floating point, which not every core has. A shift alone ({}) is too coarse: {} % of \
         the decisions on the textures are identical (restarted).",
        short(asked.leader(exact)),
        Variant::PRODUCT.exponential.name(),
        short(asked.leader(lines)),
        asked.saved(lines)[0],
        short(Exponential::Lines16.error()),
        Exponential::Lines16.error() / asked.0.product.errors.leader.mean(),
        short(asked.0.product.errors.leader.mean()),
        Variant::PRODUCT.exponential.name(),
        short(Variant::PRODUCT.exponential.error()),
        short(asked.leader(micromath)),
        short(Exponential::Micromath.error()),
        short(asked.leader(shift)),
        asked.textures(shift),
    ));
}
