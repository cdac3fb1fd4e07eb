//! The paper's claims (Sullivan et al. 2011, figures 6 to 9) as numbers: the
//! settings of each figure, what to measure, the value, and how close.
//!
//! Glossary. *Steady state*: the last five whisks of a ten-second run. *Peak*: a
//! local maximum of θ' with a fall of at least [`PROMINENCE_DEG`] on both sides.
//! *Contact*: an excursion of π above [`TOUCH`] that ends below [`RELEASE`].
//!
//! All claims are for forward Euler at 2 kHz, 2 Hz, no noise. What the paper
//! leaves open: both sides start at ψ = \[1, 0\] with θ at rest; the steady
//! state does not depend on it. A row measures any implementation's trace.

use super::{Gate, Obstacle, Row, Settings};

/// Length of a run.
pub(crate) const RUN_S: f64 = 10.0;
const STEADY_WHISKS: usize = 5;
/// How near an angle must come.
pub(crate) const ANGLE_TOLERANCE_DEG: f64 = 0.1;
/// How near z must come: half a unit of the last digit given.
const Z_TOLERANCE: f64 = 0.0005;
/// Fall of θ', in degrees, that makes a maximum a peak. The smallest real one
/// (Fig. 8, between its two peaks) is 5 degrees.
const PROMINENCE_DEG: f64 = 0.5;
const TOUCH: f64 = 0.05;
/// Ringing of H50 after release stays below.
const RELEASE: f64 = 0.02;

const LEFT: usize = 0;
const RIGHT: usize = 1;

/// What is measured over the steady state, of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    MinTheta(usize),
    MaxTheta(usize),
    /// Smallest z: what is left of the suppression when the next contact comes.
    MinZ(usize),
    /// Peaks in each whisk; none if whisks differ.
    PeaksPerWhisk(usize),
    /// Contacts in each whisk; none if whisks differ.
    ContactsPerWhisk(usize),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Claim {
    pub(crate) figure: Figure,
    pub(crate) quantity: Quantity,
    pub(crate) value: f64,
    /// Its value with eq. 7 as printed (`Reading::mass_misprint`), where known:
    /// this separates an implementation from one that follows the misprint.
    pub(crate) misprinted: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Figure {
    /// Free whisking at a gain g of all whiskers.
    Fig6(f64),
    /// RCP, σ_z = 0.7, τ_z = T_W/4, obstacles at 100 (left) and 125 (right).
    Fig7,
    /// Strong, fast RCP: σ_z = 2, τ_z = T_W/10, the same obstacles.
    Fig8,
    /// As Fig. 7, with CIA, σ_g = 0.5, τ_g = T_W/4.
    Fig9,
}

use Figure::{Fig6, Fig7, Fig8, Fig9};
use Quantity::{ContactsPerWhisk, MaxTheta, MinTheta, MinZ, PeaksPerWhisk};

pub(crate) const TABLE: [Claim; 19] = [
    // Higher g, higher θ'; at g = 2 θ approaches but does not exceed unity
    // (largest θ 0.9974; 0.875 with the misprint).
    claim(Fig6(0.5), MinTheta(LEFT), 67.2, None),
    claim(Fig6(0.5), MaxTheta(LEFT), 96.0, None),
    claim(Fig6(1.0), MinTheta(LEFT), 77.6, None),
    claim(Fig6(1.0), MaxTheta(LEFT), 122.9, Some(110.2)),
    claim(Fig6(1.5), MinTheta(LEFT), 84.2, None),
    claim(Fig6(1.5), MaxTheta(LEFT), 139.0, None),
    claim(Fig6(2.0), MinTheta(LEFT), 88.9, None),
    claim(Fig6(2.0), MaxTheta(LEFT), 149.74, Some(137.5)),
    // The left is suppressed, the right not reached; z has all but recovered.
    claim(Fig7, MaxTheta(LEFT), 108.2, Some(105.7)),
    claim(Fig7, MaxTheta(RIGHT), 122.9, Some(110.2)),
    claim(Fig7, MinZ(LEFT), 0.023, Some(0.023)),
    claim(Fig7, ContactsPerWhisk(LEFT), 1.0, Some(1.0)),
    claim(Fig7, ContactsPerWhisk(RIGHT), 0.0, Some(0.0)),
    // Biphasic, two distinct contacts a whisk.
    claim(Fig8, PeaksPerWhisk(LEFT), 2.0, Some(1.0)),
    claim(Fig8, ContactsPerWhisk(LEFT), 2.0, Some(1.0)),
    claim(Fig8, PeaksPerWhisk(RIGHT), 1.0, Some(1.0)),
    // The right side now finds its obstacle at 125.
    claim(Fig9, MaxTheta(RIGHT), 130.4, Some(114.4)),
    claim(Fig9, ContactsPerWhisk(LEFT), 1.0, Some(1.0)),
    claim(Fig9, ContactsPerWhisk(RIGHT), 1.0, Some(0.0)),
];

const fn claim(figure: Figure, quantity: Quantity, value: f64, misprinted: Option<f64>) -> Claim {
    Claim {
        figure,
        quantity,
        value,
        misprinted,
    }
}

impl Figure {
    /// Run them for [`RUN_S`].
    pub(crate) fn settings(self) -> Settings {
        let papers = Settings::papers();
        let whisk_s = papers.whisk_s();
        let gate = |gain: f64, tau_s: f64| Some(Gate { gain, tau_s });
        let obstacle = Some(Obstacle {
            at_deg: [100.0, 125.0],
            stiffness: 0.1,
        });
        match self {
            Fig6(g) => Settings {
                gains: [vec![g], vec![g]],
                ..papers
            },
            Fig7 => Settings {
                rcp: gate(0.7, whisk_s / 4.0),
                obstacle,
                ..papers
            },
            Fig8 => Settings {
                rcp: gate(2.0, whisk_s / 10.0),
                obstacle,
                ..papers
            },
            Fig9 => Settings {
                cia: gate(0.5, whisk_s / 4.0),
                ..Fig7.settings()
            },
        }
    }
}

impl Quantity {
    /// Measures it over the last [`STEADY_WHISKS`] whisks of `rows`, a run at
    /// `settings`. `None`: too few rows, a value that is not finite, or whisks
    /// that differ in a count.
    pub(crate) fn measure(self, settings: &Settings, rows: &[Row]) -> Option<f64> {
        let whisk = (settings.whisk_s() * settings.tick_hz).round() as usize;
        // One whisk more, so that whole whisks remain after the cut below.
        let tail = rows.len().checked_sub((STEADY_WHISKS + 1) * whisk)?;
        let rows = &rows[tail..];
        if !rows.iter().all(Row::is_finite) {
            return None;
        }
        let steady = &rows[whisk..];
        let least = |of: &dyn Fn(&Row) -> f64| steady.iter().map(of).reduce(f64::min);
        match self {
            MinTheta(side) => least(&|row| row.theta_deg[side]),
            MaxTheta(side) => least(&|row| -row.theta_deg[side]).map(|value| -value),
            MinZ(side) => least(&|row| row.z[side]),
            PeaksPerWhisk(side) => {
                let angles = |whisk: &[Row]| peaks(whisk.iter().map(|row| row.theta_deg[side]));
                same_in_all(whisks(rows, whisk, side).map(angles))
            }
            ContactsPerWhisk(side) => {
                let touches = |whisk: &[Row]| contacts(whisk.iter().map(|row| row.contact[side]));
                same_in_all(whisks(rows, whisk, side).map(touches))
            }
        }
    }
}

impl Claim {
    /// Whether `measured` satisfies the claim at `value` (or `misprinted`).
    pub(crate) fn is_near(&self, measured: f64, value: f64) -> bool {
        let tolerance = match self.quantity {
            MinTheta(_) | MaxTheta(_) => ANGLE_TOLERANCE_DEG,
            MinZ(_) => Z_TOLERANCE,
            PeaksPerWhisk(_) | ContactsPerWhisk(_) => 0.0,
        };
        (measured - value).abs() <= tolerance
    }
}

impl Row {
    fn is_finite(&self) -> bool {
        let pairs = [self.theta_deg, self.z, self.g, self.contact];
        pairs.iter().flatten().all(|value| value.is_finite())
    }
}

/// Whole whisks, cut where the whisker is most retracted, so that no peak or
/// contact lies on a cut.
fn whisks(rows: &[Row], whisk: usize, side: usize) -> impl Iterator<Item = &[Row]> {
    let angle = |at: usize| rows[at].theta_deg[side];
    let cut = (0..whisk.min(rows.len()))
        .min_by(|a, b| angle(*a).total_cmp(&angle(*b)))
        .unwrap_or(0);
    rows[cut..].chunks_exact(whisk)
}

fn same_in_all(mut counts: impl Iterator<Item = usize>) -> Option<f64> {
    let first = counts.next()?;
    counts.all(|count| count == first).then_some(first as f64)
}

/// Peaks of a sequence of angles that begins and ends in troughs.
pub(crate) fn peaks(angles: impl IntoIterator<Item = f64>) -> usize {
    let (mut count, mut rising) = (0, false);
    let mut extreme = f64::INFINITY; // the trough so far, or the peak if rising
    for angle in angles {
        if rising {
            extreme = extreme.max(angle);
            if angle <= extreme - PROMINENCE_DEG {
                (count, rising, extreme) = (count + 1, false, angle);
            }
        } else {
            extreme = extreme.min(angle);
            if angle >= extreme + PROMINENCE_DEG {
                (rising, extreme) = (true, angle);
            }
        }
    }
    count
}

/// Contacts begun in a sequence of π that begins free.
pub(crate) fn contacts(signal: impl IntoIterator<Item = f64>) -> usize {
    let (mut count, mut touching) = (0, false);
    for pi in signal {
        if !touching && pi > TOUCH {
            (count, touching) = (count + 1, true);
        } else if pi < RELEASE {
            touching = false;
        }
    }
    count
}

/// Reads a trace file: a header with at least the nine columns
/// `t_s,theta_left_deg,…,contact_right`, in any order, then a row a tick.
pub(crate) fn read_trace(text: &str) -> Result<Vec<Row>, String> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let read_row = |line: &str| -> Result<Row, String> {
        let cells: Vec<&str> = line.split(',').collect();
        let value = |name: &str| {
            let at = header.iter().position(|title| title.trim() == name);
            let cell = at
                .and_then(|at| cells.get(at))
                .ok_or(format!("no {name}"))?;
            let number = cell.trim().parse::<f64>();
            number.map_err(|error| format!("{name} {cell}: {error}"))
        };
        Ok(Row {
            t_s: value("t_s")?,
            theta_deg: [value("theta_left_deg")?, value("theta_right_deg")?],
            z: [value("z_left")?, value("z_right")?],
            g: [value("g_left")?, value("g_right")?],
            contact: [value("contact_left")?, value("contact_right")?],
        })
    };
    let numbered = lines.enumerate();
    numbered
        .map(|(index, line)| read_row(line).map_err(|why| format!("line {}: {why}", index + 2)))
        .collect()
}
