//! What was asked for: which experiments, how much of them, from which seed
//! and on which rigs.

use std::fmt;
use std::str::FromStr;

use super::dataset::Dataset;
use crate::rigs::Rigs;

/// An experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Name {
    /// LEP10: fixed windows.
    Lep10,
    /// LEP12: sequential analysis.
    Lep12,
    /// BIOTACT: active whisking.
    Biotact,
    /// POSE: one contact at an unknown angle and speed.
    Pose,
    /// PSIK: many vibrissae.
    Psikharpax,
}

impl Name {
    /// All of them, in the order of the page.
    pub const ALL: [Self; 5] = [
        Self::Lep10,
        Self::Lep12,
        Self::Biotact,
        Self::Pose,
        Self::Psikharpax,
    ];

    /// As on the command line.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Lep10 => "lep10",
            Self::Lep12 => "lep12",
            Self::Biotact => "biotact",
            Self::Pose => "pose",
            Self::Psikharpax => "psikharpax",
        }
    }

    /// The data sets it needs.
    pub const fn datasets(self) -> &'static [Dataset] {
        match self {
            Self::Lep10 | Self::Lep12 => &[Dataset::Floor],
            Self::Biotact => &[Dataset::Head],
            Self::Pose => &[Dataset::Table],
            Self::Psikharpax => &[Dataset::Pad, Dataset::Corridor],
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

/// A share of the recordings: number `index` of `count`, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// 1 to `count`.
    pub index: usize,
    /// How many shares there are, 1 to 100,000.
    pub count: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("{text}: a shard is i/n with i from 1 to n and n up to 100000");
        let (index, count) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| text.parse::<usize>().map_err(|_| wrong());
        let (index, count) = (number(index)?, number(count)?);
        if !(1..=100_000).contains(&count) || !(1..=count).contains(&index) {
            return Err(wrong());
        }
        Ok(Self { index, count })
    }
}

/// How much of each experiment: fewer trials, whisks, contacts, sweeps and runs;
/// the physics is the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// As much as the papers.
    Full,
    /// What PSIK's comparisons of rigs within a full run have.
    Reduced,
    /// The least with which an experiment can still fail.
    Quick,
}

impl Extent {
    const fn pick(self, full: usize, quick: usize) -> usize {
        match self {
            Self::Full => full,
            Self::Reduced | Self::Quick => quick,
        }
    }

    /// Floor robot: trials of each rotation (LEP10 and LEP12: 4); of natural
    /// motion there are twice as many (LEP10 section III-D).
    pub const fn trials(self) -> usize {
        self.pick(4, 2)
    }

    /// Whisking head: whisks of each condition (BIOTACT: 12).
    pub const fn whisks(self) -> usize {
        self.pick(12, 8)
    }

    /// Trials of natural motion.
    pub const fn natural_trials(self) -> usize {
        2 * self.trials()
    }

    /// XY table: every how-manieth angle and speed is used (POSE: all).
    pub const fn stride(self) -> usize {
        self.pick(1, 2)
    }

    /// Fixed head: sweeps of each sandpaper to train on and to test with
    /// (PSIK: 300 and 100).
    pub const fn sweeps(self) -> (usize, usize) {
        match self {
            Self::Full => (300, 100),
            Self::Reduced => (30, 10),
            Self::Quick => (15, 5),
        }
    }

    /// Corridor: runs of each to train on (of these, to test with), and to
    /// decide in (PSIK: 10, 3, 20).
    pub const fn runs(self) -> (usize, usize, usize) {
        (self.pick(10, 3), self.pick(3, 1), self.pick(20, 2))
    }
}

/// What was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The experiments.
    pub names: Vec<Name>,
    /// How much of each.
    pub extent: Extent,
    /// All chance comes from it.
    pub seed: u64,
    /// Where whiskers are and how they move.
    pub rigs: Rigs,
}

impl Request {
    /// A quick run on the rigs that are built in.
    #[cfg(test)]
    pub(crate) fn quick(names: &[Name], seed: u64) -> Self {
        Self {
            names: names.to_vec(),
            extent: Extent::Quick,
            seed,
            rigs: Rigs::load(None).unwrap(),
        }
    }

    /// One line that tells requests apart: parts of different ones are not
    /// joined.
    pub fn line(&self) -> String {
        let names: Vec<&str> = self.names.iter().map(|name| name.text()).collect();
        let rigs = format!("{:?}", self.rigs);
        let sum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(rigs.as_bytes());
        let quick = if self.extent == Extent::Quick {
            " quick"
        } else {
            ""
        };
        format!(
            "{}{quick} seed {} rigs {sum:08x}",
            names.join("+"),
            self.seed
        )
    }

    /// The request that a line tells of, on these rigs.
    pub fn from_line(line: &str, rigs: Rigs) -> Option<Self> {
        let mut words = line.split(' ');
        let names = words.next()?.split('+');
        let name = |text: &str| Name::ALL.into_iter().find(|name| name.text() == text);
        let names = names.map(name).collect::<Option<Vec<Name>>>()?;
        let mut next = words.next()?;
        let quick = next == "quick";
        if quick {
            next = words.next()?;
        }
        let seed = words.next()?.parse().ok()?;
        (next == "seed").then_some(Self {
            names,
            extent: if quick { Extent::Quick } else { Extent::Full },
            seed,
            rigs,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Extent, Name, Request};
    use crate::rigs::Rigs;

    #[test]
    fn a_request_is_read_back_from_its_line() {
        for (names, extent) in [
            (&Name::ALL[..], Extent::Quick),
            (&[Name::Pose], Extent::Full),
        ] {
            let request = Request {
                extent,
                ..Request::quick(names, 77)
            };
            let again = Request::from_line(&request.line(), request.rigs.clone());
            assert_eq!(again, Some(request));
        }
        for bad in ["", "nose seed 1 rigs 0", "pose seed x rigs 0", "pose quick"] {
            assert_eq!(Request::from_line(bad, Rigs::load(None).unwrap()), None);
        }
    }
}
