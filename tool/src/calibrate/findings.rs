//! What was seen of a module beside what its simulation shows, figure by figure: which of them
//! need a look, and what they are a sign of.

use std::fmt::Write as _;

use super::watched::{MIDDLE, Watched};

/// One figure of a module, and of the simulation of its scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Finding {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) found: f64,
    pub(crate) simulated: f64,
    /// From which it needs a look on.
    pub(crate) most: f64,
    pub(crate) sign: &'static str,
}

impl Finding {
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

/// Name and unit of a figure, what it is a sign of where it exceeds so many times that of the
/// simulation and so much more, and what it is of. A star in its name stands for an axis: there is
/// one for each. The limits are chosen, from what the simulated sensor does: wide of its noise, and
/// within what the classifier bears.
type Figure = ([&'static str; 3], [f64; 2], fn(&Watched, usize) -> f64);

const FIGURES: [Figure; 11] = [
    (["records lost", "", LOST], [0.0, 0.0], |w, _| w.lost as f64),
    (["ticks missed", "", MISSED], [0.0, 0.0], |w, _| {
        w.missed as f64
    }),
    (
        ["readings that do not count", "%", LINE],
        [1.0, 0.01],
        |w, _| 100.0 * w.invalid,
    ),
    (["at an end of the range", "%", END], [1.0, 0.0], |w, _| {
        100.0 * w.at_end
    }),
    (
        ["* at rest from the middle", "codes", TILT],
        [1.0, 400.0],
        zero,
    ),
    (["noise of * at rest", "codes", GAP], [2.0, 1.0], noise),
    (
        ["slow noise of * at rest", "of white noise's", SLOW],
        [1.0, 2.0],
        |w, a| w.slow[a],
    ),
    (
        ["* at rest, after against before", "codes", DRIFT],
        [1.0, 20.0],
        moved,
    ),
    (
        ["swing of * in the air", "codes", SWING],
        [3.0, 60.0],
        swing,
    ),
    (
        ["* with the angle", "codes a degree", FOLLOWS],
        [1.0, 0.5],
        |w, a| w.follows[a],
    ),
    (
        ["setpoint against measured", "degrees rms", MOTOR],
        [2.0, 0.5],
        |w, _| w.error_deg,
    ),
];

pub(crate) fn findings(of: &Watched, simulated: &Watched) -> Vec<Finding> {
    let mut findings = Vec::new();
    for ([name, unit, sign], [times, more], of_one) in FIGURES {
        let axes = name.contains('*').then_some(&["x", "y"][..]);
        for (axis, letter) in axes.unwrap_or(&[""]).iter().enumerate() {
            let [found, simulated] = [of, simulated].map(|watched| of_one(watched, axis));
            findings.push(Finding {
                name: name.replace('*', letter),
                unit,
                found,
                simulated,
                most: times * simulated.abs() + more,
                sign,
            });
        }
    }
    findings
}

fn zero(of: &Watched, axis: usize) -> f64 {
    of.zero[0].channels[axis].mean - MIDDLE
}

fn noise(of: &Watched, axis: usize) -> f64 {
    of.zero[0].channels[axis].sd
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

pub(crate) fn table(findings: &[Finding]) -> String {
    let mut table = String::from(
        "| figure | unit | found | simulated | at most | |\n|---|---|---|---|---|---|\n",
    );
    for finding in findings {
        let sign = if finding.is_off() { finding.sign } else { "" };
        let (name, unit) = (&finding.name, finding.unit);
        let numbers = [finding.found, finding.simulated, finding.most].map(short);
        // Writing to a string does not fail.
        let _ = writeln!(
            table,
            "| {name} | {unit} | {} | {sign} |",
            numbers.join(" | ")
        );
    }
    table
}

fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.strip_prefix('-')
        .filter(|left| *left == "0")
        .unwrap_or(text)
        .to_owned()
}
