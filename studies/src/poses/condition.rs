//! How a scene differs from that of the training, and its recordings.

use std::fmt;

use anyhow::{Error, Result};
use host_sim::commands::record;
use host_sim::progress::Verbosity;
use host_sim::recording::Stream;
use physics::{Grit, Material, Surface};
use scene::{Override, Scene};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    /// To this tilt, degrees.
    Tilt(f64),
    /// The obstacle at this angle, degrees.
    Obstacle(f64),
    ScaleY(f64),
    /// Of what was recorded.
    ScaleX(f64),
    /// Codes of x and y at rest.
    Zero([f64; 2]),
    /// Degrees about the shaft.
    Turned(f64),
    /// Share of y in x and of x in y, of what was recorded.
    CrossTalk(f64),
    /// Of each texture, as a share of its own.
    Friction(f64),
    /// Hz.
    Whisk(f64),
    NoRcp,
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Tilt(to) => write!(f, "tilt {to}°"),
            Self::Obstacle(to) => write!(f, "obstacle {to}°"),
            Self::ScaleY(by) => write!(f, "y × {by}"),
            Self::ScaleX(by) => write!(f, "x × {by}"),
            Self::Zero([x, y]) => write!(f, "zero {x:+}; {y:+}"),
            Self::Turned(by) => write!(f, "turned {by:+}°"),
            Self::CrossTalk(share) => write!(f, "cross-talk {:+} %", 100.0 * share),
            Self::Friction(by) => write!(f, "friction × {by}"),
            Self::Whisk(hz) => write!(f, "whisk {hz} Hz"),
            Self::NoRcp => write!(f, "RCP off"),
        }
    }
}

/// The code of no deflection, and the largest deflection in codes.
const MIDDLE: f64 = 8192.0;
const MOST: f64 = 8191.0;

impl Change {
    /// The key of the scene that makes it, and its value.
    fn key(self) -> Option<(&'static str, String)> {
        match self {
            Self::Tilt(to) => Some(("plant.tilt_deg", to.to_string())),
            Self::Obstacle(to) => Some(("plant.obstacle_deg", format!("[{to}]"))),
            Self::ScaleY(by) => Some(("plant.gain_y", by.to_string())),
            Self::Zero([x, y]) => Some(("plant.zero_codes", format!("[[{x}, {y}]]"))),
            Self::Turned(by) => Some(("plant.misaligned_deg", by.to_string())),
            Self::Whisk(hz) => Some(("whisking.frequency_hz", hz.to_string())),
            Self::NoRcp => Some(("rcp.gain", "0".to_owned())),
            Self::ScaleX(_) | Self::CrossTalk(_) | Self::Friction(_) => None,
        }
    }

    /// A sample as recorded with it, where no key of the scene makes it.
    fn sensed(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let code = |deflection: f64| MIDDLE + deflection.round().clamp(-MOST, MOST);
        let [dx, dy] = [x - MIDDLE, y - MIDDLE];
        match self {
            Self::ScaleX(by) => [code(by * dx), y],
            Self::CrossTalk(share) => [code(dx + share * dy), code(dy + share * dx)],
            _ => [x, y],
        }
    }
}

/// A scene's name and text.
type File = (&'static str, &'static str);

pub(super) const WHISKER: File = ("whisker", include_str!("../../../scenes/whisker.toml"));
pub(super) const TEXTURES: File = ("textures", include_str!("../../../scenes/textures.toml"));
pub(super) const SPREAD: File = (
    "bench-textures",
    include_str!("../../../scenes/bench-textures.toml"),
);

/// The four textures of the scenes, and what the friction of each is, as `whisker` has them.
pub(super) const SURFACES: [(&str, Material); 4] = [
    ("smooth", Material::SmoothPlastic),
    ("p600", Material::Sandpaper(Grit::P600)),
    ("p240", Material::Sandpaper(Grit::P240)),
    ("carpet", Material::SmoothCarpet),
];

/// What a recording is of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setting<'s> {
    pub(super) file: File,
    pub(super) changes: &'s [Change],
    /// None: those of the scene.
    pub(super) textures: Option<&'s [&'s str]>,
    /// None: that of the scene.
    pub(super) seconds: Option<f64>,
}

impl<'s> Setting<'s> {
    pub(super) const fn of(file: File, changes: &'s [Change]) -> Self {
        Self {
            file,
            changes,
            textures: None,
            seconds: None,
        }
    }

    fn scene(&self, seed: u64, friction: Option<f64>) -> Result<Scene> {
        let mut sets = vec![("seed", seed.to_string())];
        sets.extend(self.changes.iter().filter_map(|change| change.key()));
        sets.extend(self.seconds.map(|s| ("duration_s", format!("{s:?}"))));
        sets.extend(friction.map(|friction| ("plant.friction", friction.to_string())));
        sets.extend(
            self.textures
                .map(|all| ("plant.textures", format!("{all:?}"))),
        );
        let set = |(key, value): &(&str, String)| Override::new((*key).to_owned(), key, value);
        let sets: Vec<_> = sets.iter().map(set).collect();
        let read = Scene::from_str_with(self.file.0, self.file.1, &sets);
        read.map(|(scene, _)| scene).map_err(Error::new)
    }

    /// Records it, as `host-sim record` does.
    pub(super) fn record(&self, seed: u64) -> Result<Vec<Stream>> {
        let friction = self.changes.iter().find_map(|change| match change {
            Change::Friction(by) => Some(*by),
            _ => None,
        });
        let mut streams = match friction {
            None => record::streams(&self.scene(seed, None)?, Verbosity::Quiet)?,
            Some(by) => self.with_friction(seed, by)?,
        };
        for sample in streams.iter_mut().flat_map(|stream| &mut stream.samples) {
            for change in self.changes {
                *sample = change.sensed(*sample);
            }
        }
        Ok(streams)
    }

    /// A scene has one friction for all: each texture is recorded by itself.
    fn with_friction(&self, seed: u64, by: f64) -> Result<Vec<Stream>> {
        let mut all = Vec::new();
        let whole = self.scene(seed, None)?.duration_s;
        for (texture, material) in SURFACES {
            let only = [texture];
            let alone = Setting {
                textures: Some(&only),
                seconds: Some(whole / SURFACES.len() as f64),
                ..*self
            };
            let scene = alone.scene(seed, Some(by * Surface::of(material).friction))?;
            all.extend(record::streams(&scene, Verbosity::Quiet)?);
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::Change;

    #[test]
    fn what_is_recorded_is_changed_about_the_middle() {
        let scaled = Change::ScaleX(0.85).sensed([8292.0, 8000.0]);
        assert_eq!(scaled, [8277.0, 8000.0]);
        let mixed = Change::CrossTalk(-0.03).sensed([8192.0, 9192.0]);
        assert_eq!(mixed, [8162.0, 9192.0]);
        assert_eq!(Change::ScaleX(2.0).sensed([16000.0, 1.0]), [16383.0, 1.0]);
        assert_eq!(Change::Tilt(18.0).sensed([1.0, 2.0]), [1.0, 2.0]);
    }
}
