//! What was seen of a module beside what its simulation shows, figure by figure: which of them
//! need a look, and what they are a sign of.

use std::fmt::Write as _;

use super::rest::MIDDLE;
use super::watched::Watched;

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

/// What a figure is a sign of that exceeds so many times that of the simulation and so much more.
/// The limits are chosen, from what the simulated sensor does: wide of its noise, and within what
/// the classifier bears.
type Sign = ([f64; 2], &'static str);

const TILT: Sign = (
    [1.0, 400.0],
    "tilt: the magnet is not above the sensor, or turned in its hub",
);
const GAP: Sign = (
    [2.0, 1.0],
    "gap: the magnet is too far from the sensor, and its field too weak",
);
const SLOW: Sign = (
    [1.0, 2.0],
    "a field that changes: a neighbour's magnet that moves, a motor, or the mains",
);
const SWING: Sign = (
    [3.0, 60.0],
    "gap or mount: the whisker or its magnet is loose, or the magnet too near",
);
const FOLLOWS: Sign = (
    [1.0, 0.5],
    "a neighbour's field, or a magnet off the axis: readings follow the angle",
);
const END: Sign = (
    [1.0, 0.0],
    "saturation: the magnet is too near, or the range too small",
);
const DRIFT: Sign = (
    [1.0, 20.0],
    "drift: temperature, or a magnet that gives way",
);
const LINE: Sign = (
    [1.0, 0.01],
    "line errors: wires of the sensor's SPI too long or loose; whisker log names them",
);
const LOST: Sign = (
    [0.0, 0.0],
    "the PC or the line does not keep up: close other programs, use a higher baud",
);
const MISSED: Sign = (
    [0.0, 0.0],
    "the module misses ticks: a scene with a lower tick_hz",
);
const MOTOR: Sign = (
    [2.0, 0.5],
    "motor or gear: friction, or gains too low; whisker calibrate",
);

/// A figure of all readings: name, unit, what it is of, and what it is a sign of.
type OfAll = (&'static str, &'static str, fn(&Watched) -> f64, Sign);

/// The same of each axis, whose name stands in place of the star.
type OfAxis = (&'static str, &'static str, fn(&Watched, usize) -> f64, Sign);

const FIRST: [OfAll; 4] = [
    ("records lost", "", |w| w.lost as f64, LOST),
    ("ticks missed", "", |w| w.missed as f64, MISSED),
    (
        "readings that do not count",
        "%",
        |w| 100.0 * w.invalid,
        LINE,
    ),
    ("at an end of the range", "%", |w| 100.0 * w.at_end, END),
];

const OF_AXES: [OfAxis; 6] = [
    ("* at rest from the middle", "codes", zero, TILT),
    ("noise of * at rest", "codes", noise, GAP),
    (
        "slow noise of * at rest",
        "of white noise's",
        |w, a| w.slow[a],
        SLOW,
    ),
    ("* at rest, after against before", "codes", moved, DRIFT),
    ("swing of * in the air", "codes", swing, SWING),
    (
        "* with the angle",
        "codes a degree",
        |w, a| w.follows[a],
        FOLLOWS,
    ),
];

const LAST: OfAll = (
    "setpoint against measured",
    "degrees rms",
    |w| w.error_deg,
    MOTOR,
);

pub(crate) fn findings(of: &Watched, simulated: &Watched) -> Vec<Finding> {
    let finding = |name: String, unit, of_one: &dyn Fn(&Watched) -> f64, sign: Sign| {
        let ([times, more], sign) = sign;
        let simulated = of_one(simulated);
        Finding {
            name,
            unit,
            found: of_one(of),
            simulated,
            most: times * simulated.abs() + more,
            sign,
        }
    };
    let whole = |(name, unit, of, sign): &OfAll| finding((*name).to_owned(), unit, of, *sign);
    let mut findings: Vec<Finding> = FIRST.iter().map(whole).collect();
    for (name, unit, of, sign) in &OF_AXES {
        for (axis, letter) in ["x", "y"].into_iter().enumerate() {
            let name = name.replace('*', letter);
            findings.push(finding(name, unit, &|watched| of(watched, axis), *sign));
        }
    }
    findings.push(whole(&LAST));
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

fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
