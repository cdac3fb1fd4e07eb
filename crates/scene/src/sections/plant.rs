//! `[plant]`: what the whiskers meet.

use std::ops::RangeInclusive;

use super::shaft::{ShaftName, ShaftNumbers};
use crate::choice::{Choice, choice};
use crate::key::Condition::{self, Given, Is};
use crate::key::{Key, number, pair_per_side, per_own, per_side, positive, word, words};
use crate::keys::keys;

choice! {
    /// What stands between the motor command and the sensor.
    pub enum PlantKind {
        /// The angle is θ′ exactly; contact follows BIOTACT eq. 11.
        Ideal = "ideal",
        /// Simulated motor, whisker and textured surfaces.
        Textured = "textured",
        /// The same with an elastic shaft that sticks, slips and bounces.
        Whisker = "whisker",
    }
}

impl PlantKind {
    /// Whether surfaces with textures are presented.
    pub const fn has_textures(self) -> bool {
        matches!(self, Self::Textured | Self::Whisker)
    }
}

choice! {
    /// A surface that a whisker is swept over, named after its material or grit.
    pub enum Texture {
        /// A smooth surface.
        Smooth = "smooth",
        /// P600 sandpaper, fine.
        P600 = "p600",
        /// P240 sandpaper, coarser.
        P240 = "p240",
        /// Carpet.
        Carpet = "carpet",
        /// Carpet with long, coarse loops.
        RoughCarpet = "rough-carpet",
        /// Stones in bitumen.
        Tarmac = "tarmac",
        /// A vinyl floor.
        Vinyl = "vinyl",
        /// Sheet aluminium.
        Aluminium = "aluminium",
        /// P40 sandpaper, the coarsest.
        P40 = "p40",
        /// P80 sandpaper.
        P80 = "p80",
        /// P180 sandpaper.
        P180 = "p180",
        /// The first of the scene's own surfaces.
        Own1 = "own-1",
        /// The second.
        Own2 = "own-2",
        /// The third.
        Own3 = "own-3",
        /// The fourth.
        Own4 = "own-4",
    }
}

impl Texture {
    /// The words of all.
    pub const NAMES: &'static [&'static str] = Self::WORDS;

    /// That of a word; none if it is none.
    pub fn named(word: &str) -> Option<Self> {
        Self::of_word(word)
    }
}

impl Texture {
    /// Which of a scene's own surfaces it is, from 0; none if it is none.
    pub const fn own(self) -> Option<usize> {
        match self {
            Self::Own1 => Some(0),
            Self::Own2 => Some(1),
            Self::Own3 => Some(2),
            Self::Own4 => Some(3),
            _ => None,
        }
    }

    /// Whether the plant without an elastic shaft knows it too.
    pub const fn is_simple(self) -> bool {
        matches!(self, Self::Smooth | Self::P600 | Self::P240 | Self::Carpet)
    }
}

choice! {
    /// When one surface takes the place of another.
    pub enum Exchanged {
        /// Once its time has come and no whisker has touched the old one for a while.
        Air = "air",
        /// At its time, under a bent whisker too.
        Timed = "timed",
    }
}

const TEXTURED: Condition = Is("kind", PlantKind::Textured.name());
const ELASTIC: Condition = Is("kind", PlantKind::Whisker.name());

const TEXTURES: &[Condition] = &[TEXTURED, ELASTIC];
const WHISKER: &[Condition] = &[ELASTIC];
/// The most that a plate may be tilted, either way.
pub(crate) const TILT_LIMIT_DEG: f64 = 80.0;

/// Where there is something to press on.
const STIFF: &[Condition] = &[Given("obstacle_deg"), TEXTURED, ELASTIC];

keys! {
    /// What the whiskers meet.
    pub struct PlantSection {
        /// `ideal`: the angle is θ′ exactly, contact by BIOTACT eq. 11.
        /// `textured`: simulated motor, whisker and surfaces; needs `[whisking]`.
        /// `whisker`: the same with an elastic shaft that sticks, slips and bounces.
        kind: PlantKind = word(),

        /// What the sensors of a side read at rest, x and y: codes from mid-scale, as of a magnet
        /// that is not in its place.
        zero_codes: Option<Vec<[f64; 2]>> = pair_per_side(-4000.0..=4000.0)
            .unit("codes")
            .optional("mid-scale"),

        /// By how much that changes every second, as by a magnet that warms up.
        zero_drift: Option<Vec<[f64; 2]>> = pair_per_side(-1000.0..=1000.0)
            .unit("codes/s")
            .optional("it stays"),

        /// Sensitivity of sensors to y, as a share of that to x.
        gain_y: f64 = number(0.01..=100.0).default("1.0"),

        /// By how much sensors are turned about their shafts, anticlockwise.
        misaligned_deg: f64 = number(-45.0..=45.0).unit("degrees").default("0.0"),

        /// Share of the deflection of each neighbour on its side that a sensor reads too.
        cross_talk: f64 = number(0.0..=0.5).default("0.0"),

        /// Width of the sensors' hysteresis.
        hysteresis_codes: f64 = number(0.0..=1000.0).unit("codes").default("0.0"),

        /// How plates stand to whiskers; there exactly when `kind` is [`PlantKind::Whisker`].
        ..facing: Option<FacingChoice>,

        /// By how much poses differ; there exactly when `kind` is [`PlantKind::Whisker`].
        ..spread: Option<PoseSpread>,

        /// Obstacles; `None`: free whisking. Always there for surfaces with textures.
        ..obstacle: Option<Obstacles>,

        /// Surfaces; there exactly when [`PlantKind::has_textures`], but not in free air.
        ..textured: Option<Presentation>,

        /// The shaft; there exactly when `kind` is [`PlantKind::Whisker`].
        ..shaft: Option<ShaftChoice>,
    }
}

impl PlantSection {
    /// The words of the textures that can be laid before its whiskers: all that it computes; none
    /// where it has none.
    pub fn textures_to_lay(&self) -> Vec<&'static str> {
        let Some(textured) = &self.textured else {
            return Vec::new();
        };
        let elastic = self.kind == PlantKind::Whisker;
        let known = |texture: Texture| match texture.own() {
            Some(_) => textured.textures.contains(&texture),
            None => elastic || texture.is_simple(),
        };
        let names = Texture::NAMES.iter().copied();
        names
            .filter(|name| Texture::named(name).is_some_and(known))
            .collect()
    }
}

/// Free air, motors and whiskers being simulated as for textures.
impl Default for PlantSection {
    fn default() -> Self {
        Self {
            kind: PlantKind::Textured,
            zero_codes: None,
            zero_drift: None,
            gain_y: 1.0,
            misaligned_deg: 0.0,
            cross_talk: 0.0,
            hysteresis_codes: 0.0,
            facing: None,
            spread: None,
            obstacle: None,
            textured: None,
            shaft: None,
        }
    }
}

keys! {
    /// An obstacle on each side.
    pub struct Obstacles {
        /// Angle of the obstacle on each side.
        obstacle_deg: Vec<f64> = per_side(-360.0..=360.0)
            .unit("degrees")
            .required_if(TEXTURES, "free whisking"),

        /// Stiffness σ_x: contact signal per degree of overlap (BIOTACT eq. 11). Of a `whisker` above 0,
        /// and in the range that its shaft allows.
        stiffness: f64 = number(0.0..=100.0).unit("1/degree").required_if(STIFF, "not used").used_if(STIFF),
    }
}

keys! {
    /// Textured surfaces, presented one after another.
    pub struct Presentation {
        /// Surfaces, in the order in which they are presented; `textured` knows the first four.
        textures: Vec<Texture> = words().required_if(TEXTURES, "no texture").only_if(TEXTURES),

        /// How long each texture is presented; at least one tick.
        present_s: f64 = positive(1e5)
            .unit("s")
            .required_if(TEXTURES, "no texture")
            .only_if(TEXTURES),

        /// When the next texture is put in place: `air`, once its time has come and no whisker has
        /// touched for 20 ms; `timed`, at its time, under a bent whisker too.
        exchange: Exchanged = word().default("\"air\"").only_if(TEXTURES),

        /// Coefficient of friction of every texture against a sliding tip.
        friction: Option<f64> = number(0.0..=8.0).optional("that of each texture").only_if(TEXTURES),

        /// The scene's own surfaces; there exactly when [`PlantKind::has_textures`].
        ..own: Option<OwnSurfaces>,
    }
}

/// A property of the scene's own surfaces.
const fn own(ends: RangeInclusive<f64>) -> Key<Option<Vec<f64>>> {
    per_own(ends).optional("that of `smooth`").only_if(WHISKER)
}

keys! {
    /// What surfaces of the scene's own, `own-1` to `own-4`, are like. Lists have a number for
    /// each of them in `textures`, in that order.
    pub struct OwnSurfaces {
        /// Root mean square height of own surfaces.
        own_height_m: Option<Vec<f64>> = own(0.0..=0.01).unit("m"),

        /// Distance between their grains, loops or stones.
        own_grain_m: Option<Vec<f64>> = own(1e-6..=0.1).unit("m"),

        /// Their stiffness against a tip that presses on them.
        own_stiffness_n_m: Option<Vec<f64>> = own(1.0..=1e9).unit("N/m"),

        /// Damping ratio of a tip that rings on them.
        own_damping: Option<Vec<f64>> = own(0.0..=10.0),

        /// Coefficient of friction against a sliding tip; a resting one is held by 1.2 times that.
        own_friction: Option<Vec<f64>> = own(0.0..=8.0),
    }
}

keys! {
    /// How a whisker stands, and how a plate faces it where they touch.
    #[derive(Copy)]
    pub struct FacingChoice {
        /// Angle between shaft and plate in the plane of whisking; above 0 it draws the tip along
        /// the plate.
        slant_deg: f64 = number(0.0..=80.0).unit("degrees").default("30.0").only_if(WHISKER),

        /// Inclination of the plate towards the motor's axis: its slope towards y.
        tilt_deg: f64 = number(-TILT_LIMIT_DEG..=TILT_LIMIT_DEG).unit("degrees").default("20.0").only_if(WHISKER),

        /// By how much the shaft points out of the plane of whisking, along the motor's axis.
        elevation_deg: f64 = number(-60.0..=60.0).unit("degrees").default("0.0").only_if(WHISKER),

        /// Where on the straight shaft a plate touches it first, as a share of its length.
        touches_at: f64 = number(0.2..=1.0).default("1.0").only_if(WHISKER),

        /// Where the plate begins, from the place of first touch and away from the motor.
        begins_m: Option<f64> = number(-0.5..=0.5).unit("m").optional("endless").only_if(WHISKER),

        /// Where it ends; where it begins too, it is a round bar.
        ends_m: Option<f64> = number(-0.5..=0.5).unit("m").optional("endless").only_if(WHISKER),

        /// Radius of its ends, and of a bar; the plate is twice as thick.
        edge_radius_m: f64 = number(1e-4..=0.1).unit("m").default("0.001").only_if(WHISKER),
    }
}

keys! {
    /// By how much the pose of a presentation differs from the scene's. A pose is drawn for each
    /// presentation, evenly and each part by itself; it is the same for all whiskers.
    #[derive(Copy)]
    pub struct PoseSpread {
        /// Each presentation's plate is tilted by up to this more or less than `tilt_deg`, drawn
        /// evenly from the seed; within ±80 together.
        tilt_spread_deg: f64 = number(0.0..=TILT_LIMIT_DEG).unit("degrees").default("0.0").only_if(WHISKER),

        /// Each presentation's plate stands by up to this before or beyond `obstacle_deg`, drawn
        /// likewise; on both sides by the same.
        obstacle_spread_deg: f64 = number(0.0..=45.0).unit("degrees").default("0.0").only_if(WHISKER),

        /// Readings are multiplied in each presentation by a factor within 1 ± this, drawn
        /// likewise. With any of the three spreads, a surface is put in place only where no whisker
        /// has been in its way for 20 ms.
        gain_spread: f64 = number(0.0..=0.9).default("0.0").only_if(WHISKER),
    }
}

impl PoseSpread {
    /// Whether poses differ at all.
    pub fn is_there(&self) -> bool {
        self.tilt_spread_deg > 0.0 || self.obstacle_spread_deg > 0.0 || self.gain_spread > 0.0
    }
}

keys! {
    /// A shaft; all whiskers of a head have the same.
    #[derive(Copy)]
    pub struct ShaftChoice {
        /// The whiskers' shaft: that of a paper, or `own` with the keys that follow.
        shaft: ShaftName = word().default("\"biotact-middle\"").only_if(WHISKER),

        /// Its numbers; there exactly when `shaft` is [`ShaftName::Own`].
        ..own: Option<ShaftNumbers>,
    }
}
