//! The section in words and tables; every number comes from the study.

use super::super::counts::{Counts, Target, cell};
use super::super::page::{Page, short};
use super::chosen;
use super::ground::{LEAST_POSTERIOR, RESTART};
use super::measure::{COLUMNS, Decisions, OnOne, Row, Study, THRESHOLDS, WINDOWS};
use super::model::{Deficit, Entry, Exponential, Variant};

/// One thing changed from the product at a time, then all at once.
pub(super) fn shown() -> Vec<Variant> {
    let product = Variant::PRODUCT;
    let entries = Entry::ALL.map(|entry| Variant { entry, ..product });
    let deficits = Deficit::ALL.map(|deficit| Variant { deficit, ..product });
    let exponentials = Exponential::ALL.map(|exponential| Variant {
        exponential,
        ..product
    });
    let all = entries.into_iter().chain(deficits).chain(exponentials);
    let mut shown: Vec<Variant> = all.filter(|variant| *variant != product).collect();
    shown.push(Variant {
        entry: Entry::Full(8),
        deficit: Deficit::Bits16,
        exponential: Exponential::Lines16,
    });
    shown.push(Variant {
        entry: Entry::Full(16),
        deficit: Deficit::Bits64,
        exponential: Exponential::Exact,
    });
    shown
}

/// Appends everything but the picture.
pub(super) fn write(page: &mut Page, study: &Study, counts: &Counts) {
    let [terrain, textures] = study.about;
    page.heading(2, "The classifier's arithmetic");
    page.say(format_args!(
        "A posterior is made of table entries (log2 of a likelihood, rounded), of deficits (how \
         far each class's evidence lies behind the leader's) and of 2^−x. Below, one of the three \
         at a time differs from the product, in the end all. The product's row is measured on \
         `tactile` itself, and the yardstick is `tactile::reference`, double precision \
         throughout. Everyone hears {} samples of a robot's vibration over {} grounds \
         ([terrain](../tests/data/terrain/README.md)), and {} samples of a whisker on {} textures: \
         a run of `scenes/textures.toml` with another seed than the one learnt from.",
        terrain.samples, terrain.classes, textures.samples, textures.classes
    ));
    chosen::write(page, study);
    errors(page, study);
    exponentials(page, counts);
    for (n, about) in study.about.iter().enumerate() {
        page.heading(3, &format!("Decisions on the {}", about.name));
        if n == 0 {
            let windows = WINDOWS.map(|samples| samples.to_string()).join(", ");
            page.say(format_args!(
                "Percent, under the sequential rule at each threshold and over all windows of \
                 {windows} samples. Identical is: the same stream, class and samples, after the \
                 same block, of all blocks after which either decides. Restarted: evidence starts \
                 again where the yardstick's does. Running: each goes on by himself, and a \
                 decision that falls a block apart takes those after it along. Hits: right \
                 decisions, mean over classes."
            ));
        }
        decisions(page, study, n);
    }
}

/// A name for each choice: of the variant, or of the product's.
fn names(variant: Option<Variant>) -> [String; 3] {
    let Variant {
        entry,
        deficit,
        exponential,
    } = variant.unwrap_or(Variant::PRODUCT);
    let mark = if variant.is_none() { "**" } else { "" };
    [
        format!("{mark}{} ({}){mark}", entry.bits(), entry.per_bit()),
        format!("{mark}{}{mark}", deficit.bits()),
        format!("{mark}{}{mark}", exponential.name()),
    ]
}

/// The product, then what is shown beside it.
fn rows(study: &Study) -> impl Iterator<Item = &Row> {
    let variants = shown().into_iter().filter_map(|variant| study.of(variant));
    std::iter::once(&study.product).chain(variants)
}

/// Bytes of constants and of state, for the textures' model.
pub(super) fn bytes(study: &Study, variant: Option<Variant>) -> [usize; 2] {
    let about = study.about[1];
    let variant = variant.unwrap_or(Variant::PRODUCT);
    [
        variant.constant_bytes(about.bins, about.classes),
        variant.state_bytes(about.block, about.classes),
    ]
}

fn errors(page: &mut Page, study: &Study) {
    let about = study.about[1];
    page.say(format_args!(
        "|Δ ln p| after each of {} blocks of both recordings, of the class that leads and of \
         every class above {}; evidence starts again once the yardstick's posterior exceeds {}. \
         Bytes are those of {} classes and {} bins: the table packed without gaps with that of \
         2^−x, and what changes under the sequential rule. Code is not counted.",
        study.product.errors.leader.count(),
        short(LEAST_POSTERIOR),
        RESTART,
        about.classes,
        about.bins
    ));
    let header = "entry: bits (units a bit) | deficit: bits | 2^−x | constants, bytes \
                  | state, bytes | leader: largest | mean | every: largest | mean";
    let row = |row: &Row| {
        let [constants, state] = bytes(study, row.variant);
        let mut cells = names(row.variant).to_vec();
        cells.extend([constants.to_string(), state.to_string()]);
        for spread in [row.errors.leader, row.errors.all] {
            cells.extend([short(spread.largest), short(spread.mean())]);
        }
        cells
    };
    page.table(header, rows(study).map(row));
}

fn exponentials(page: &mut Page, counts: &Counts) {
    page.say("By itself, 2^−x is as good as this, for x from 0 to 2:");
    let rows = Exponential::ALL.map(|exponential| {
        vec![
            exponential.name().to_owned(),
            short(exponential.error()),
            exponential.bytes().to_string(),
        ]
    });
    page.table("2^−x | largest relative error | bytes of table", rows);
    if counts.is_empty() {
        return;
    }
    page.say("Instructions of the product, mean of a call, for two channels and four classes:");
    let kernels = [
        ("a sample", "classifier push K=4"),
        (
            "a sample that ends a block",
            "classifier push and end of block K=4",
        ),
    ];
    let rows = kernels.map(|(what, kernel)| {
        let count = |target| cell(counts.of(kernel, "integer", target));
        let mut cells = vec![what.to_owned()];
        cells.extend(Target::ALL.map(count));
        cells
    });
    let targets = Target::ALL.map(Target::name).join(" | ");
    page.table(&format!("call | {targets}"), rows);
}

fn decisions(page: &mut Page, study: &Study, recording: usize) {
    let columns = |what: &str| {
        let rules = THRESHOLDS.map(|threshold| format!("{what} {threshold}"));
        format!("{} | {what} windows", rules.join(" | "))
    };
    let header = format!(
        "entry | deficit | 2^−x | {} | {} | {}",
        columns("restarted"),
        columns("running"),
        columns("hits")
    );
    let of = |row: &Row| -> Vec<String> {
        let on: Option<&OnOne> = row.decisions.get(recording);
        let cells = |value: fn(&Decisions) -> String| on.into_iter().flatten().map(value);
        let mut all = names(row.variant).to_vec();
        all.extend(cells(|d| percent(d.restarted.share())));
        all.extend(cells(|d| percent(d.running.share())));
        all.extend(cells(|d| rate(d.hit_rate)));
        all
    };
    let mut yardstick = vec!["yardstick".to_owned(), "f64".to_owned(), "f64".to_owned()];
    yardstick.extend(vec![String::new(); 2 * COLUMNS]);
    let rates = study.reference.get(recording).into_iter().flatten();
    yardstick.extend(rates.copied().map(rate));
    page.table(
        &header,
        std::iter::once(yardstick).chain(rows(study).map(of)),
    );
}

/// A share in percent, rounded down, so that 100.0 means all.
pub(super) fn percent(share: f64) -> String {
    // A share of exactly so many tenths must not fall to the one below.
    format!("{:.1}", (share * 1000.0 + 1e-9).floor() / 10.0)
}

/// A hit rate in percent; a dash without decisions.
fn rate(rate: f64) -> String {
    if rate.is_nan() {
        return "–".to_owned();
    }
    format!("{:.1}", rate * 100.0)
}
