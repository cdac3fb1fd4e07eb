//! Why the head's hit rates differ from the paper's, measured: what the motors,
//! the sensors' gain and the smoothing of the histograms do.

use super::movement::movement;
use super::whisks::{ALL, Task, Visits};
use crate::experiment::dataset::Dataset;
use crate::experiment::record::head::{early, number};
use crate::experiment::record::on_other_rigs;
use crate::experiment::recording::{Recordings, of_set};
use crate::experiment::request::Request;
use crate::page::Page;
use crate::paper::biotact::{STRATEGIES, TEXTURES};
use crate::rigs::{CHANNELS, WhiskingHead};
use host_sim::Error;
use tactile::train::Options;

/// The paper's smoothing, and what it is if its "width 5 intervals" is the full
/// width at half maximum of a Gaussian: 5/√(8 ln 2).
const SMOOTH: f64 = 5.0;
const NARROW: f64 = 2.123_3;

/// Another range of the sensor, in that of the rig: nothing then clips.
const WIDER: f64 = 1.5;

/// Reasons: of hit rates, and of how often a whisk touches.
pub(super) struct Why {
    pub(super) hits: String,
    pub(super) biphasic: String,
}

/// Numbers without digits behind the point, one after another.
fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|x| format!("{x:.0}")).collect();
    values.join(", ")
}

/// What came of one rig.
struct Found {
    /// Joint hit rate of each strategy after one training whisk and after the
    /// most, percent.
    one: Vec<f64>,
    most: Vec<f64>,
    /// Spread between whisks of each strategy at 10 mm, smooth surface, codes.
    spread: Vec<f64>,
    /// Share of biphasic whisks with strong and fast RCP, percent, and contacts
    /// a whisk.
    strong: (f64, f64),
}

impl Found {
    fn of(
        request: &Request,
        recordings: &Recordings,
        most: usize,
        smooth: f64,
    ) -> Result<Self, Error> {
        let visits = Visits::new(request, recordings);
        let order: Vec<usize> = (0..request.extent.whisks()).collect();
        let options = Options {
            smooth,
            ..Options::default()
        };
        let rates = |count: usize| -> Result<Vec<f64>, Error> {
            let rate = |strategy| {
                let split = order.split_at(count);
                Ok(100.0 * visits.bayes(&ALL, options, Task::Both, strategy, split)?)
            };
            (0..STRATEGIES.len()).map(rate).collect()
        };
        let all = of_set(recordings, Dataset::Head);
        let ticks = request.rigs.head.whisk_ticks();
        let moved = |job: usize| all.get(job).map(|visit| movement(visit, ticks));
        let spread = |strategy| moved(number(strategy, TEXTURES.len() - 1, 1));
        let strong = moved(early(STRATEGIES.len())).unwrap_or_default();
        Ok(Self {
            one: rates(1)?,
            most: rates(most)?,
            spread: (0..STRATEGIES.len())
                .map(|strategy| spread(strategy).map_or(0.0, |found| found.spread))
                .collect(),
            strong: (strong.biphasic, strong.contacts),
        })
    }

    fn other(request: &Request, most: usize, change: fn(&mut WhiskingHead)) -> Result<Self, Error> {
        let (other, recordings) = on_other_rigs(request, Dataset::Head, |other| {
            change(&mut other.rigs.head);
        })?;
        Self::of(&other, &recordings, most, SMOOTH)
    }

    fn cells(&self, what: &str) -> Vec<String> {
        let text = |values: &[f64]| format!("**{}**", list(values));
        vec![
            what.to_owned(),
            text(&self.one),
            text(&self.most),
            text(&self.spread),
            format!("**{:.0}**", self.strong.0),
            format!("**{:.1}**", self.strong.1),
        ]
    }
}

/// Says it on the page.
pub(super) fn section(
    page: &mut Page,
    request: &Request,
    recordings: &Recordings,
    most: usize,
) -> Result<Why, Error> {
    let plain = Found::of(request, recordings, most, SMOOTH)?;
    let narrow = Found::of(request, recordings, most, NARROW)?;
    let exact = Found::other(request, most, |head| head.motor.follows = false)?;
    let wider = Found::other(request, most, |head| head.full_scale_rad *= WIDER)?;
    page.say(format_args!(
        "**What the paper leaves open.** Hit rates of naive Bayes on texture and distance in \
         percent, unmodulated, RCP7, RCP9, one choice of training whisks; spread of x between \
         whisks at 10 mm in codes, likewise; share of biphasic whisks and contacts a whisk with \
         strong and fast RCP. A sensor of {WIDER} times the range never clips before the surfaces \
         that are classified, and makes RCP that much weaker; the rig has the range at which a \
         degree of overlap reads 0.1, as in eq. 11. A smoothing of {NARROW:.1} bins takes the \
         paper's width of 5 intervals as that at half maximum."
    ));
    page.table(
        &format!("rig | 1 training whisk | {most} | spread | biphasic, % | contacts"),
        [
            plain.cells("as it is"),
            exact.cells("motors that follow without error"),
            wider.cells("a sensor of 1.5 times the range"),
            narrow.cells("histograms smoothed by 2.1 bins, not 5"),
        ],
    );
    let visits = Visits::new(request, recordings);
    let order: Vec<usize> = (0..request.extent.whisks()).collect();
    let (low, high) = visits.range(0, order.get(..most).unwrap_or(&[]), 1);
    let mut axes = Vec::new();
    for axis in [0, 1] {
        let picked: Vec<usize> = (axis..CHANNELS).step_by(2).collect();
        let split = order.split_at(most);
        let hit = visits.bayes(&picked, Options::default(), Task::Texture, 0, split)?;
        axes.push(100.0 * hit);
    }
    Ok(Why {
        hits: format!(
            "the histograms' smoothing of 5 bins in 100 ({:.0} codes of y, where the noise is 4) \
             is wider than what textures differ by: smoothed by {NARROW:.1} bins, {most} training \
             whisks give {} % (unmodulated, RCP7, RCP9). The error is therefore the same after one \
             whisk as after {most}. RCP does not make whisks more repeatable here, which is how the \
             paper explains its gain, but less: x spreads by {} codes between whisks, as what is \
             felt comes back through motors with friction; with motors that follow without error, \
             by {}, and hit rates are {} %. RCP also shortens contact, and air is the same before \
             all surfaces. x alone tells textures at {:.0} %, y alone at {:.0} (unmodulated)",
            (high - low) / 20.0,
            list(&narrow.most),
            list(&plain.spread),
            list(&exact.spread),
            list(&exact.most),
            axes[0],
            axes[1],
        ),
        biphasic: format!(
            "the generator alone makes two contacts a whisk (Fig. 8), and so may a spring of \
             eq. 11; here a whisker has mass, a friction of the motor of about a degree and a lag \
             of some milliseconds in the loop. With motors that follow without error {:.0} % of \
             whisks are biphasic and touch {:.1} times: the second rise of θ' ends before it \
             reaches the surface. The paper shows two contacts in its simulation only",
            exact.strong.0, exact.strong.1
        ),
    })
}
