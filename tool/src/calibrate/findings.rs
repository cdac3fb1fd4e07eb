//! What was seen of a module beside what its simulation shows, figure by figure: which of them
//! need a look, and what they are a sign of.

use std::fmt::Write as _;

use super::rest::MIDDLE;
use super::watched::Watched;

/// One figure of a module, and of the simulation of its scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Finding {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) found: f64,
    pub(crate) simulated: f64,
    /// From which it needs a look on.
    pub(crate) most: f64,
    /// What it is a sign of then.
    pub(crate) sign: &'static str,
}

impl Finding {
    /// Whether it needs a look; so does what is no number.
    pub(crate) fn is_off(&self) -> bool {
        self.found.abs() > self.most || !self.found.is_finite()
    }
}

const TILT: &str = "tilt: the magnet is not above the sensor, or turned in its hub";
const GAP: &str = "gap: the magnet is too far from the sensor, and its field too weak";
const SLOW: &str = "a field that changes: a neighbour's magnet that moves, a motor, or the mains";
const SWING: &str = "gap or mount: the whisker or its magnet is loose, or the magnet too near";
const FOLLOWS: &str = "a neighbour's field, or a magnet off the axis: readings follow the angle";
const END: &str = "saturation: the magnet is too near, or the range too small";
const DRIFT: &str = "drift: temperature, or a magnet that gives way";
const LINE: &str =
    "line errors: wires of the sensor's SPI too long or loose; whisker log names them";
const LOST: &str = "the PC or the line does not keep up: close other programs, use a higher baud";
const MISSED: &str = "the module misses ticks: a scene with a lower tick_hz";
const MOTOR: &str = "motor or gear: friction, or gains too low; whisker calibrate";

/// A figure, and the most that it may be: so many times that of the simulation and so much more.
struct Figure {
    name: &'static str,
    unit: &'static str,
    of: fn(&Watched) -> f64,
    times: f64,
    more: f64,
    sign: &'static str,
}

const fn figure(
    name: &'static str,
    unit: &'static str,
    of: fn(&Watched) -> f64,
    [times, more]: [f64; 2],
    sign: &'static str,
) -> Figure {
    Figure {
        name,
        unit,
        of,
        times,
        more,
        sign,
    }
}

/// All of them. The limits are chosen, from what the simulated sensor does: wide of its noise, and
/// within what the classifier bears.
const FIGURES: [Figure; 17] = [
    figure("records lost", "", |w| w.lost as f64, [0.0, 0.0], LOST),
    figure("ticks missed", "", |w| w.missed as f64, [0.0, 0.0], MISSED),
    figure(
        "readings that do not count",
        "%",
        |w| 100.0 * w.invalid,
        [1.0, 0.01],
        LINE,
    ),
    figure(
        "at an end of the range",
        "%",
        |w| 100.0 * w.at_end,
        [1.0, 0.0],
        END,
    ),
    figure(
        "x at rest from the middle",
        "codes",
        |w| w.zero[0].channels[0].mean - MIDDLE,
        [1.0, 400.0],
        TILT,
    ),
    figure(
        "y at rest from the middle",
        "codes",
        |w| w.zero[0].channels[1].mean - MIDDLE,
        [1.0, 400.0],
        TILT,
    ),
    figure(
        "noise of x at rest",
        "codes",
        |w| w.zero[0].channels[0].sd,
        [2.0, 1.0],
        GAP,
    ),
    figure(
        "noise of y at rest",
        "codes",
        |w| w.zero[0].channels[1].sd,
        [2.0, 1.0],
        GAP,
    ),
    figure(
        "slow noise of x at rest",
        "of white noise's",
        |w| w.slow[0],
        [1.0, 2.0],
        SLOW,
    ),
    figure(
        "slow noise of y at rest",
        "of white noise's",
        |w| w.slow[1],
        [1.0, 2.0],
        SLOW,
    ),
    figure(
        "x at rest, after against before",
        "codes",
        |w| moved(w, 0),
        [1.0, 20.0],
        DRIFT,
    ),
    figure(
        "y at rest, after against before",
        "codes",
        |w| moved(w, 1),
        [1.0, 20.0],
        DRIFT,
    ),
    figure(
        "swing of x in the air",
        "codes",
        |w| swing(w, 0),
        [3.0, 60.0],
        SWING,
    ),
    figure(
        "swing of y in the air",
        "codes",
        |w| swing(w, 1),
        [3.0, 60.0],
        SWING,
    ),
    figure(
        "x with the angle",
        "codes a degree",
        |w| w.follows[0],
        [1.0, 0.5],
        FOLLOWS,
    ),
    figure(
        "y with the angle",
        "codes a degree",
        |w| w.follows[1],
        [1.0, 0.5],
        FOLLOWS,
    ),
    figure(
        "setpoint against measured",
        "degrees rms",
        |w| w.error_deg,
        [2.0, 0.5],
        MOTOR,
    ),
];

/// All figures of a module.
pub(crate) fn findings(of: &Watched, simulated: &Watched) -> Vec<Finding> {
    let found = |figure: &Figure| {
        let simulated = (figure.of)(simulated);
        Finding {
            name: figure.name,
            unit: figure.unit,
            found: (figure.of)(of),
            simulated,
            most: figure.times * simulated.abs() + figure.more,
            sign: figure.sign,
        }
    };
    FIGURES.iter().map(found).collect()
}

fn moved(of: &Watched, axis: usize) -> f64 {
    let [before, after] = of.zero.each_ref().map(|zero| zero.channels[axis].mean);
    after - before
}

fn swing(of: &Watched, axis: usize) -> f64 {
    of.air.as_ref().map_or(f64::NAN, |air| {
        let [low, high] = air.channels[axis].span;
        f64::from(high) - f64::from(low)
    })
}

/// The figures as a table in Markdown.
pub(crate) fn table(findings: &[Finding]) -> String {
    let mut table = String::from(
        "| figure | unit | found | simulated | at most | |\n|---|---|---|---|---|---|\n",
    );
    for finding in findings {
        let sign = if finding.is_off() { finding.sign } else { "" };
        // Writing to a string does not fail.
        let _ = writeln!(
            table,
            "| {} | {} | {} | {} | {} | {sign} |",
            finding.name,
            finding.unit,
            short(finding.found),
            short(finding.simulated),
            short(finding.most)
        );
    }
    table
}

/// To what a person reads.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
