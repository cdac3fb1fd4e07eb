//! What was chosen after results had been seen, and what would have come of it otherwise.

use anyhow::Result;
use host_sim::progress::Verbosity;
use tactile::train::joint::Options;

use super::figures::{Figures, Table, number, over, plus_minus};
use super::goals::Trained;
use super::ground::Ground;
use crate::cores::each;
use crate::page::{Page, row};

/// Where such choices are noted, each with the way there from the page.
const NOTES: [(&str, &str, &str); 3] = [
    (
        "docs/decisions.md",
        "../decisions.md",
        include_str!("../../../docs/decisions.md"),
    ),
    (
        "crates/tactile/src/touch.rs",
        "../../crates/tactile/src/touch.rs",
        include_str!("../../../crates/tactile/src/touch.rs"),
    ),
    (
        "crates/tactile/src/train/joint/trial.rs",
        "../../crates/tactile/src/train/joint/trial.rs",
        include_str!("../../../crates/tactile/src/train/joint/trial.rs"),
    ),
];

/// Choices taken back, tried beside the defaults.
enum Without {
    /// Floors: another share that they may refuse, none or that of the study before.
    Floors(f64),
    /// Bins and block: those of the study before.
    Bins { bins: usize, block: u32 },
}

const WITHOUT: [Without; 3] = [
    Without::Floors(0.0),
    Without::Floors(0.05),
    Without::Bins {
        bins: 32,
        block: 20,
    },
];

impl Without {
    fn name(&self) -> String {
        match *self {
            Self::Floors(0.0) => "no floors".to_owned(),
            Self::Floors(share) => format!("{} % refused", 100.0 * share),
            Self::Bins { bins, block } => format!("{bins} bins with blocks of {block}"),
        }
    }

    fn options(&self, defaults: &Options) -> Options {
        let defaults = defaults.clone();
        match *self {
            Self::Floors(refused) => Options {
                refused,
                ..defaults
            },
            Self::Bins { bins, block } => Options {
                bins,
                block,
                ..defaults
            },
        }
    }
}

/// The notes, and the figures without what an option can take back.
pub(super) fn section(
    page: &mut Page,
    table: &mut Table,
    grounds: &[Ground],
    verbosity: Verbosity,
) -> Result<()> {
    page.heading(2, "Chosen after results were seen");
    page.say("Values that were chosen with results before the eyes, as their sources tell them:");
    for (name, way, text) in NOTES {
        for note in notes(text) {
            page.say(format_args!("> {note} ([{name}]({way}))"));
        }
    }
    page.say(
        "Of these the floors' share, bins and block are options. The figures without them, one \
         at a time, mean of all trainings; the others cannot be taken back by an option, and what \
         was found without them stands in the notes.",
    );
    for ground in grounds {
        let trained = &ground.trained;
        let Options {
            refused: share,
            bins,
            block,
            ..
        } = &ground.shipped().joint.options;
        let share = 100.0 * share;
        let mut rows = vec![of(
            &format!("by default: {share} % refused, {bins} bins with blocks of {block}"),
            &trained.iter().map(Trained::usual),
        )];
        for without in WITHOUT {
            let found = each(verbosity, "taken back", trained, |one| {
                let options = without.options(&one.joint.options);
                let streams = ground.recording(one.seed, ground.scene.duration_s);
                let joint = ground.train_by(streams, &options)?;
                ground.score(&joint.model()?, 0.99)
            })?;
            let name = without.name();
            for (one, figures) in trained.iter().zip(&found) {
                table.add(["hindsight", ground.name, &name], one.seed, figures);
            }
            rows.push(of(&name, &found.iter()));
        }
        page.table(
            &format!(
                "{} | hit rate | stated | found | refused | undecided",
                ground.name
            ),
            rows,
        );
    }
    Ok(())
}

fn of<'f>(name: &str, models: &(impl Iterator<Item = &'f Figures> + Clone)) -> Vec<String> {
    let mean = |figure: fn(&Figures) -> f64| over(models.clone(), figure);
    let cells = [
        plus_minus(mean(Figures::hit_rate), 2),
        number(mean(|f| 100.0 * f.calibration.stated).0, 2),
        plus_minus(mean(|f| 100.0 * f.calibration.found.share), 2),
        plus_minus(mean(|f| 100.0 * f.refused.share), 1),
        plus_minus(mean(|f| 100.0 * f.undecided.share), 1),
    ];
    row(name, cells)
}

/// The paragraphs of a text, or of the comments of a source, that say what was chosen
/// after something had been seen.
fn notes(text: &str) -> Vec<String> {
    let line = |line: &str| {
        let line = line.trim_start();
        let marks = ["//!", "///"];
        let said = marks.into_iter().find_map(|mark| line.strip_prefix(mark));
        said.unwrap_or(line).trim().to_owned()
    };
    let lines: Vec<String> = text.lines().map(line).collect();
    let paragraphs = lines.split(String::is_empty).map(|lines| lines.join(" "));
    let chosen = |text: &String| {
        let text = text.to_lowercase();
        text.contains("chosen") && text.contains("seen") || text.contains("chosen after")
    };
    let plain = |text: String| text.replace("[`", "`").replace("`]", "`");
    paragraphs.filter(chosen).map(plain).collect()
}

#[cfg(test)]
mod tests {
    use super::{NOTES, notes};

    #[test]
    fn paragraphs_of_comments_are_found() {
        let text =
            "//! One.\n//!\n//! Two was chosen after\n//! [`THREE`] was seen.\n//!\n//! Four.";
        assert_eq!(notes(text), ["Two was chosen after `THREE` was seen."]);
    }

    #[test]
    fn the_record_and_the_detector_say_what_was_chosen() {
        for (name, _, text) in &NOTES[..2] {
            assert!(!notes(text).is_empty(), "{name}");
        }
    }
}
