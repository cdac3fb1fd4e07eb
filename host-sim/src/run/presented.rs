//! Which surface is in place, and when the next takes its place.

use scene::{Exchanged, PlantKind, Scene, Texture};

/// What is being touched: which texture, and how often it has been before.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Presented {
    /// What is touched before the first texture.
    first: &'static str,
    textures: Vec<Texture>,
    /// Ticks a presentation.
    length: u64,
    /// Ticks without touch before a texture is exchanged; `None`: whatever it touches.
    air: Option<u64>,
    /// The last tick with touch.
    touched: u64,
    /// Presentations that have begun.
    begun: u64,
    pub(super) label: &'static str,
    pub(super) trial: u64,
}

/// How long nothing may have been touched before a texture is exchanged, s: a period
/// of the slowest vibration, lest it is done while the whisker bounces.
const AIR_S: f64 = 0.02;

impl Presented {
    pub(super) fn new(scene: &Scene) -> Self {
        let label = match scene.plant.kind {
            PlantKind::Ideal if scene.plant.obstacle.is_some() => "obstacle",
            _ => "free",
        };
        let ticks = |seconds: f64| ((seconds * f64::from(scene.tick_hz)).round() as u64).max(1);
        let textured = scene.plant.textured.as_ref();
        let length = textured.map_or(u64::MAX, |textured| ticks(textured.present_s));
        let textures = textured.map(|textured| textured.textures.clone());
        let in_air = textured.is_some_and(|textured| textured.exchange == Exchanged::Air);
        Self {
            first: label,
            textures: textures.unwrap_or_default(),
            length,
            air: in_air.then(|| ticks(AIR_S)),
            touched: 0,
            begun: 0,
            label,
            trial: 0,
        }
    }

    pub(super) fn restart(&mut self) {
        self.label = self.first;
        self.trial = 0;
        self.touched = 0;
        self.begun = 0;
    }

    /// The texture to put in place before tick `done + 1`, if it changes there;
    /// `touches`: whether the present one is touched.
    pub(super) fn change(&mut self, done: u64, touches: bool) -> Option<Texture> {
        if touches {
            self.touched = done;
        }
        let count = done / self.length;
        let may = |air| self.begun == 0 || done - self.touched >= air;
        if count < self.begun || !self.air.is_none_or(may) {
            return None;
        }
        self.begun = count + 1;
        let among = self.textures.len() as u64;
        let texture = *self.textures.get(count.checked_rem(among)? as usize)?;
        self.label = texture.name();
        self.trial = count / among;
        Some(texture)
    }
}
