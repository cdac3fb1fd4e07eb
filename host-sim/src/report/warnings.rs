//! What a user has to know before trusting a model, or its figures.

use tactile::train::joint::Warning;

fn count(count: usize, what: &str) -> String {
    let plural = match what {
        _ if count == 1 => "",
        "touch" => "es",
        _ => "s",
    };
    format!("{count} {what}{plural}")
}

pub(super) fn in_words(warning: &Warning) -> String {
    match warning {
        Warning::FewTrials { name, trials } => {
            let trials = count(*trials, "trial");
            format!("{name}: too few to judge by, {trials}")
        }
        Warning::Empty { name, trials } => format!(
            "{name}: without one block of samples with contact, {}",
            count(*trials, "trial")
        ),
        Warning::Halved { name } => {
            format!("{name}: its only trial was cut in halves, which are more alike than trials")
        }
        Warning::OneRecording => {
            "all is of one recording: what this says of another one is unknown".to_owned()
        }
        Warning::NotAcrossRecordings => "not every class is in several recordings: trials were \
             held out, not recordings, so what this says of another recording is unknown"
            .to_owned(),
        Warning::Pose {
            pose,
            name,
            touches,
            least,
        } => format!(
            "{pose}: not used as a pose of its own, {} of {name}, and it needs {least}",
            count(*touches, "touch")
        ),
        Warning::NoOpinion {
            name,
            touches,
            least,
        } => format!(
            "no second opinion: too few touches of {name}: {touches}, needs {least}; in \
                 another pose than that of training it may be wrong"
        ),
        Warning::NoPose {
            name,
            what,
            found,
            least,
        } => format!("no poses are estimated: too few {what} of {name}: {found}, needs {least}"),
        Warning::WidePose { found, most } => format!(
            "no poses are estimated: tilt_deg or depth_deg is {found}, allowed: -{most} to \
                 {most}; take another unit, or another zero"
        ),
        Warning::Alike { names, mistaken } => format!(
            "{} and {} cannot be distinguished: in {:.0} % the other one wins",
            names[0],
            names[1],
            100.0 * mistaken
        ),
        Warning::Overstated { stated, found } => format!(
            "decisions state {:.1} %, and {:.1} % ({:.1} to {:.1}) were right",
            100.0 * stated,
            100.0 * found.share,
            100.0 * found.low,
            100.0 * found.high
        ),
        Warning::Weight { table, weight } if *weight <= 0.0 => {
            format!("table {} tells nothing: its weight is zero", table + 1)
        }
        Warning::Weight { table, weight } => format!(
            "table {} has the largest weight there is, {weight:.2}: what was held out never \
                 contradicts it, and posteriors may state too little",
            table + 1
        ),
        other => format!("{other:?}"),
    }
}
