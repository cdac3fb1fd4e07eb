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
    begun: u64,
    /// Set once a texture is laid by hand: the scene's order has no say any more.
    is_by_hand: bool,
    /// To be laid by hand, once nothing is touched.
    wanted: Option<Texture>,
    /// Ticks without touch before that.
    apart: u64,
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
            is_by_hand: false,
            wanted: None,
            apart: ticks(AIR_S),
            label,
            trial: 0,
        }
    }

    pub(super) fn restart(&mut self) {
        self.label = self.first;
        self.trial = 0;
        self.touched = 0;
        self.begun = 0;
        self.is_by_hand = false;
        self.wanted = None;
    }

    /// Has this texture laid in place of the present one as soon as that is not touched, and
    /// left there.
    pub(super) const fn lay(&mut self, texture: Texture) {
        self.is_by_hand = true;
        self.wanted = Some(texture);
    }

    pub(super) const fn is_laid(&self) -> bool {
        self.is_by_hand && self.wanted.is_none()
    }

    /// The texture to put in place before tick `done + 1`, if it changes there;
    /// `touches`: whether the present one is touched.
    pub(super) fn change(&mut self, done: u64, touches: bool) -> Option<Texture> {
        if touches {
            self.touched = done;
        }
        if self.is_by_hand {
            let may = self.begun == 0 || done - self.touched >= self.apart;
            let texture = self.wanted.take_if(|_| may)?;
            self.begun += 1;
            self.trial = self.begun - 1;
            self.label = texture.name();
            return Some(texture);
        }
        let is_over = done >= self.begun.saturating_mul(self.length);
        let may = |air| self.begun == 0 || done - self.touched >= air;
        if !is_over || !self.air.is_none_or(may) {
            return None;
        }
        let count = done / self.length;
        self.begun = count + 1;
        let among = self.textures.len() as u64;
        let texture = *self.textures.get(count.checked_rem(among)? as usize)?;
        self.label = texture.name();
        self.trial = count / among;
        Some(texture)
    }
}

#[cfg(test)]
mod tests {
    use scene::{Scene, Texture};

    use super::Presented;

    #[test]
    fn by_hand_a_texture_is_laid_in_the_air_and_stays() {
        let text = include_str!("../../../scenes/textures.toml");
        let scene = Scene::from_str("textures.toml", text).unwrap();
        let mut presented = Presented::new(&scene);
        presented.lay(Texture::Carpet);
        assert!(!presented.is_laid());
        assert_eq!(presented.change(0, false), Some(Texture::Carpet));
        assert!(presented.is_laid());
        // Beyond the scene's 2.5 s, too.
        assert!((1..10_000).all(|done| presented.change(done, false).is_none()));
        presented.change(10_000, true);
        presented.lay(Texture::Smooth);
        // 20 ms without touch.
        assert!((10_001..10_040).all(|done| presented.change(done, false).is_none()));
        assert_eq!(presented.label, "carpet");
        assert_eq!(presented.change(10_040, false), Some(Texture::Smooth));
        assert_eq!((presented.label, presented.trial), ("smooth", 1));
    }
}
