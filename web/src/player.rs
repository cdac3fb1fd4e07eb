//! A scene as it is watched.

use host_sim::decisions::Decided;
use host_sim::run::Run;
use host_sim::trace::WhiskerRow;
use physics::{At, Bent};
use scene::{PlantKind, Rule, Scene, Texture};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::loaded;

/// The line of a decision.
fn line(t_s: f64, d: &Decided) -> String {
    let side = d.place.map_or("", |place| place.side_name());
    let posterior = format!("{:.4}", d.posterior);
    let (samples, words) = (d.samples.to_string(), d.words());
    let t_s = format!("{t_s:.3}");
    let cells = [
        &t_s,
        side,
        &d.decision,
        &posterior,
        &samples,
        &d.label,
        &words,
    ];
    cells.join("\t")
}

/// Ticks between two points of the curves.
const EVERY: u64 = 4;

/// A scene that is played tick by tick. Numbers of whiskers are those of the first of each side,
/// left first.
#[wasm_bindgen]
pub struct Player {
    scene: Scene,
    run: Run,
    done: u64,
    whiskers: Vec<WhiskerRow>,
    decided: Vec<String>,
}

#[wasm_bindgen]
impl Player {
    /// A scene before its first tick.
    ///
    /// # Errors
    /// What is wrong with it, a line each.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, set: &str) -> Result<Self, String> {
        let loaded = loaded(text, set)?;
        let text_of = |error: host_sim::Error| error.to_string();
        let run =
            Run::new(&loaded.scene, loaded.classifier().map_err(text_of)?).map_err(text_of)?;
        Ok(Self {
            run,
            scene: loaded.scene,
            done: 0,
            whiskers: Vec::new(),
            decided: Vec::new(),
        })
    }

    /// Goes on by so many ticks, beyond the scene's end too. Returns the points of the curves:
    /// time (s), then of each side setpoint and angle (degrees), x and y (codes) and contact.
    pub fn step(&mut self, ticks: u32) -> Vec<f64> {
        let mut points = Vec::new();
        for _ in 0..ticks {
            let t_s = self.run.tick().t_s;
            self.done += 1;
            for d in self.run.decisions() {
                self.decided.push(line(t_s, &d));
            }
            if self.done.is_multiple_of(EVERY) {
                self.run.look_at_whiskers(&mut self.whiskers);
                points.push(t_s);
                for w in self
                    .whiskers
                    .iter()
                    .step_by(self.scene.head.whiskers_per_side.max(1))
                {
                    let [x, y] = w.codes;
                    points.extend([w.theta_deg, w.angle_deg, x, y, w.contact]);
                }
            }
        }
        points
    }

    /// What every whisker looks like: angle (degrees), length (m), contact, the point where it
    /// touches (m; not a number in the air), and 13 points from its base to its tip (m). Of a
    /// point x is against protraction, y across it, and z along the shaft as it is without a bend.
    pub fn bodies(&mut self) -> Vec<f64> {
        self.run.look_at_whiskers(&mut self.whiskers);
        let mut bodies = Vec::new();
        for (n, w) in self.whiskers.iter().enumerate() {
            let bent = self.run.bent(n);
            let bent = bent.unwrap_or_else(|| self.held(n, w.angle_deg));
            bodies.extend([w.angle_deg, bent.length_m, w.contact]);
            bodies.extend(bent.contact.map_or([f64::NAN; 3], |at| at.point_m));
            bodies.extend(bent.points_m.as_flattened());
        }
        bodies
    }

    /// A shaft without a shape of its own is drawn as held by its obstacle at the tip: each point
    /// is turned back, by the share that a beam has which is held there.
    fn held(&self, n: usize, angle_deg: f64) -> Bent {
        const LENGTH_M: f64 = 0.112;
        let side = n / self.scene.head.whiskers_per_side.max(1);
        let limit = self.obstacle_deg(side);
        let over = (angle_deg - limit).max(0.0).to_radians();
        let mut bent = Bent::straight(LENGTH_M);
        for [x, _, z] in &mut bent.points_m {
            let (far_m, share) = (*z, *z / LENGTH_M);
            let turned = over * (0.3 + share * (1.05 - 0.35 * share));
            *x = far_m * turned.sin();
            *z = far_m * turned.cos();
        }
        if over > 0.0 {
            bent.contact = bent.points_m.last().map(|tip| At {
                arc_m: LENGTH_M,
                point_m: *tip,
                plate_m: [0.0; 2],
            });
        }
        bent
    }

    fn obstacle_deg(&self, side: usize) -> f64 {
        let obstacle = self.scene.plant.obstacle.as_ref();
        let limit = obstacle.and_then(|obstacle| obstacle.obstacle_deg.get(side).copied());
        limit.unwrap_or(f64::INFINITY)
    }

    /// Of each side the angle at which a straight tip touches, degrees; infinite: nothing is
    /// there.
    pub fn obstacles(&self) -> Vec<f64> {
        let sides = 0..self.scene.head.sides.count();
        sides.map(|side| self.obstacle_deg(side)).collect()
    }

    /// How surfaces stand: angle to the shaft in the plane of whisking, and inclination towards
    /// the motor's axis, degrees.
    pub fn facing_deg(&self) -> Vec<f64> {
        match (self.scene.plant.kind, self.scene.plant.facing) {
            (PlantKind::Whisker, Some(facing)) => vec![facing.slant_deg, facing.tilt_deg],
            _ => vec![0.0; 2],
        }
    }

    /// The decisions since the last call: time, side, decision, posterior, samples, the truth and
    /// the decision in words, with tabulators between them.
    pub fn decisions(&mut self) -> Vec<String> {
        std::mem::take(&mut self.decided)
    }

    /// The names of the classes.
    pub fn classes(&self) -> Vec<String> {
        self.run.classes().to_vec()
    }

    /// The posterior of each; empty without a classifier.
    pub fn posteriors(&mut self) -> Vec<f64> {
        let posteriors = self.run.posteriors();
        posteriors.map_or_else(Vec::new, |posteriors| posteriors.to_f64().collect())
    }

    /// The posterior at which it decides; none where it does not.
    pub fn threshold(&self) -> Option<f64> {
        match self.scene.classifier.as_ref()?.rule {
            Rule::Sequential { threshold } => Some(threshold),
            Rule::Costs { .. } | Rule::Window { .. } => None,
        }
    }

    /// What is touched, which no module knows.
    pub fn presented(&self) -> String {
        self.run.presented().0.to_owned()
    }

    /// Has a texture laid, once the present one is not touched, and left there.
    pub fn lay(&mut self, texture: &str) {
        if let (Some(texture), Some(_)) = (Texture::named(texture), &self.scene.plant.textured) {
            self.run.lay(texture);
        }
    }

    /// Whether it has textures.
    pub fn has_textures(&self) -> bool {
        self.scene.plant.textured.is_some()
    }

    /// Whiskers on each side.
    pub fn whiskers_per_side(&self) -> usize {
        self.scene.head.whiskers_per_side
    }

    /// Ticks a second.
    pub fn tick_hz(&self) -> u32 {
        self.scene.tick_hz
    }

    /// How long the scene lasts, s.
    pub fn duration_s(&self) -> f64 {
        self.scene.duration_s
    }

    /// The scene's number for the key of a slider; none where it has none.
    pub fn setting(&self, key: &str) -> Option<f64> {
        let Scene { whisking, .. } = &self.scene;
        let whisking = || whisking.as_ref();
        match key {
            "whisking.gain" => whisking()?.gain.first().copied(),
            "whisking.frequency_hz" => Some(whisking()?.frequency_hz),
            "rcp.gain" => Some(self.scene.rcp.as_ref()?.gain),
            "cia.gain" => Some(self.scene.cia.as_ref()?.gain),
            "plant.friction" => self.scene.plant.textured.as_ref()?.friction,
            "classifier.threshold" => self.threshold(),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use host_sim::decisions::Decided;
    use tactile::Decision;

    use super::line;

    #[test]
    fn a_decision_that_names_no_class_says_why() {
        let classes = ["ice", "loam"].map(str::to_owned);
        for (bits, cells) in [
            (0, "loam\t0.5000\t34\tloam\tloam"),
            (1, "unknown\t0.5000\t34\tloam\tunknown"),
            (
                3,
                "unknown\t0.5000\t34\tloam\toutside the poses of training",
            ),
            (5, "unknown\t0.5000\t34\tloam\tbetween loam and ice"),
        ] {
            // Class 1 at even odds.
            let decision = Decision::from_memory(34, 1 << 27 | 1 << 15, bits << 16).unwrap();
            let decided = Decided::new(decision, &classes, "loam", "1");
            assert_eq!(line(1.25, &decided), format!("1.250\t\t{cells}"));
        }
    }
}
