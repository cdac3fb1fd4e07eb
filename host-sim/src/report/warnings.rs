//! What a user has to know before trusting a model, or its figures.

use std::fmt;

use tactile::train::joint::Warning;

struct Count(usize, &'static str);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(count, what) = self;
        let plural = match *what {
            "touch" => "es",
            _ => "s",
        };
        write!(f, "{count} {what}{}", if *count == 1 { "" } else { plural })
    }
}

pub(super) struct InWords<'a>(pub(super) &'a Warning);

impl fmt::Display for InWords<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Warning::FewTrials { name, trials } => {
                let trials = Count(*trials, "trial");
                write!(f, "{name}: too few to judge by, {trials}")
            }
            Warning::Empty { name, trials } => write!(
                f,
                "{name}: without one block of samples with contact, {}",
                Count(*trials, "trial")
            ),
            Warning::Halved { name } => write!(
                f,
                "{name}: its only trial was cut in halves, which are more alike than trials"
            ),
            Warning::OneRecording => write!(
                f,
                "all is of one recording: what this says of another one is unknown"
            ),
            Warning::NotAcrossRecordings => write!(
                f,
                "not every class is in several recordings: trials were held out, not \
                 recordings, so what this says of another recording is unknown"
            ),
            Warning::Pose {
                pose,
                name,
                touches,
                least,
            } => write!(
                f,
                "{pose}: not used as a pose of its own, {} of {name}, and it needs {least}",
                Count(*touches, "touch")
            ),
            Warning::NoOpinion {
                name,
                touches,
                least,
            } => write!(
                f,
                "no second opinion: too few touches of {name}: {touches}, needs {least}; in \
                 another pose than that of training it may be wrong"
            ),
            Warning::NoPose {
                name,
                what,
                found,
                least,
            } => write!(
                f,
                "no poses are estimated: too few {what} of {name}: {found}, needs {least}"
            ),
            Warning::WidePose { found, most } => write!(
                f,
                "no poses are estimated: tilt_deg or depth_deg is {found}, allowed: -{most} to \
                 {most}; take another unit, or another zero"
            ),
            Warning::Alike { names, mistaken } => write!(
                f,
                "{} and {} cannot be distinguished: in {:.0} % the other one wins",
                names[0],
                names[1],
                100.0 * mistaken
            ),
            Warning::Weight { table, weight } if *weight <= 0.0 => {
                write!(f, "table {} tells nothing: its weight is zero", table + 1)
            }
            Warning::Weight { table, weight } => write!(
                f,
                "table {} has the largest weight there is, {weight:.2}: what was held out never \
                 contradicts it, and posteriors may state too little",
                table + 1
            ),
            other => write!(f, "{other:?}"),
        }
    }
}
