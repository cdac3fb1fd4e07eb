//! A scene as it is watched.

use host_sim::array::Array;
use host_sim::decisions::Decided;
use host_sim::run::Run;
use host_sim::trace::WhiskerRow;
use physics::{At, Bent};
use scene::{Deciding, PlantKind, Rule, Scene, Texture};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::started;

fn line(t_s: f64, d: &Decided, classes: &[String], are_several: bool) -> String {
    let whisker = d.place.map_or(String::new(), |place| {
        let name = place.side_name();
        if are_several {
            format!("{name} {}", place.whisker + 1)
        } else {
            name.to_owned()
        }
    });
    let [reason, among] = d.why();
    let cells = [
        &format!("{t_s:.3}"),
        whisker.as_str(),
        &d.decision,
        &format!("{:.4}", d.posterior),
        &d.samples.to_string(),
        &d.label,
        &d.verdict(classes).to_string(),
        &reason,
        &among,
        &d.touch.to_string(),
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
    array: Array,
    done: u64,
    whiskers: Vec<WhiskerRow>,
    decided: Vec<String>,
    /// Readings of x for the ear, while somebody listens.
    heard: Option<Vec<f32>>,
}

#[wasm_bindgen]
impl Player {
    /// A scene before its first tick.
    ///
    /// # Errors
    /// What is wrong with it, a line each.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, set: &str) -> Result<Self, String> {
        let (scene, run) = started(text, set)?;
        Ok(Self {
            run,
            array: Array::new(&scene),
            scene,
            done: 0,
            whiskers: Vec::new(),
            decided: Vec::new(),
            heard: None,
        })
    }

    /// Goes on by so many ticks, beyond the scene's end too. Returns the points of the curves:
    /// time (s), then of each side setpoint and angle (degrees), x and y (codes) and contact.
    pub fn step(&mut self, ticks: u32) -> Vec<f64> {
        let mut points = Vec::new();
        for _ in 0..ticks {
            let row = self.run.tick();
            let t_s = row.t_s;
            self.done += 1;
            if let Some(heard) = &mut self.heard {
                let x = row.x.into_iter().find(|x| x.is_finite());
                heard.push(x.unwrap_or_default() as f32);
            }
            for d in self.run.decisions() {
                let are_several = self.scene.head.whiskers_per_side > 1;
                let line = line(t_s, &d, self.run.classes(), are_several);
                self.decided.push(line);
                self.array.take(&d);
            }
            if self.done.is_multiple_of(EVERY) {
                self.run.look_at_whiskers(&mut self.whiskers);
                points.push(t_s);
                let each = self.scene.head.whiskers_per_side.max(1);
                for w in self.whiskers.iter().step_by(each) {
                    let [x, y] = w.codes;
                    points.extend([w.theta_deg, w.angle_deg, x, y, w.contact]);
                }
            }
        }
        points
    }

    /// What every whisker looks like: angle (degrees), length (m), contact, the two points where it
    /// touches (m; not a number where it does not), and 13 points from its base to its tip (m). Of a
    /// point x is against protraction, y across it, and z along the shaft as it is without a bend.
    pub fn bodies(&mut self) -> Vec<f64> {
        self.run.look_at_whiskers(&mut self.whiskers);
        let mut bodies = Vec::new();
        for (n, w) in self.whiskers.iter().enumerate() {
            let bent = self.run.bent(n);
            let bent = bent.unwrap_or_else(|| self.held(n, w.angle_deg));
            bodies.extend([w.angle_deg, bent.length_m, w.contact]);
            let point = |at: Option<At>| at.map_or([f64::NAN; 3], |at| at.point_m);
            bodies.extend(bent.contacts.map(point).as_flattened());
            bodies.extend(bent.points_m.as_flattened());
        }
        bodies
    }

    /// Where every whisker stands: its column, its row, and the number of its board (-1: one board
    /// has all), from 0.
    pub fn stands(&self) -> Vec<i32> {
        let stands = self.array.stands().iter();
        let numbers = stands.flat_map(|at| {
            let board = at.board.map_or(-1, |board| board as i32);
            [at.column as i32, at.row as i32, board]
        });
        numbers.collect()
    }

    /// What every whisker has decided within the last second; empty: nothing.
    pub fn said(&self) -> Vec<String> {
        let whiskers = 0..self.array.stands().len();
        let said = whiskers.map(|n| self.array.said(n, self.run.t_s()).to_owned());
        said.collect()
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
            bent.contacts[0] = bent.points_m.last().map(|tip| At {
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

    /// Where on a straight hair a surface touches, as a share of its length; where the surface begins
    /// and ends along itself, from there (m; infinite: nowhere), and the radius of its ends (m).
    pub fn outline(&self) -> Vec<f64> {
        let (low, high) = (f64::NEG_INFINITY, f64::INFINITY);
        match (self.scene.plant.kind, self.scene.plant.facing) {
            (PlantKind::Whisker, Some(facing)) => vec![
                facing.touches_at,
                facing.begins_m.unwrap_or(low),
                facing.ends_m.unwrap_or(high),
                facing.edge_radius_m,
            ],
            _ => vec![1.0, low, high, 0.0],
        }
    }

    /// How surfaces stand: angle to the shaft in the plane of whisking, and inclination towards
    /// the motor's axis, degrees.
    pub fn facing_deg(&self) -> Vec<f64> {
        match (self.scene.plant.kind, self.scene.plant.facing) {
            (PlantKind::Whisker, Some(facing)) => vec![facing.slant_deg, facing.tilt_deg],
            _ => vec![0.0; 2],
        }
    }

    /// Starts or stops to keep what [`Player::heard`] returns.
    pub fn listen(&mut self, on: bool) {
        self.heard = on.then(Vec::new);
    }

    /// The readings of x since the last call, a code a tick, of the first whisker.
    pub fn heard(&mut self) -> Vec<f32> {
        self.heard.as_mut().map_or_else(Vec::new, std::mem::take)
    }

    /// The decisions since the last call, with tabulators between time, side (with the whisker's
    /// number, from 1, where a side has several), decision, posterior, samples, the truth, what it is
    /// worth (`right`, `wrong`, `refused`), the reason and the pair if no class is named (as in
    /// `decisions.csv`), and the number of the touch.
    pub fn decisions(&mut self) -> Vec<String> {
        std::mem::take(&mut self.decided)
    }

    /// The names of the classes.
    pub fn classes(&self) -> Vec<String> {
        self.run.classes().to_vec()
    }

    /// Whether all whiskers decide as one, by the samples of all.
    pub fn decides_together(&self) -> bool {
        let classifier = self.scene.classifier.as_ref();
        let is_together = classifier.is_some_and(|of| of.whiskers == Deciding::Together);
        is_together && self.array.stands().len() > 1
    }

    /// The posterior of each, where whiskers decide for themselves of the first; empty without a
    /// classifier.
    pub fn posteriors(&mut self) -> Vec<f64> {
        let posteriors = self.run.posteriors();
        posteriors.map_or_else(Vec::new, |posteriors| posteriors.to_f64().collect())
    }

    /// The posterior at which it decides; none where it does not.
    pub fn threshold(&self) -> Option<f64> {
        threshold(&self.scene)
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

    /// The textures that can be laid: all that its plant computes; none where it has none.
    pub fn textures(&self) -> Vec<String> {
        let names = self.scene.plant.textures_to_lay().into_iter();
        names.map(str::to_owned).collect()
    }

    /// Whiskers on each side.
    pub fn whiskers_per_side(&self) -> usize {
        self.scene.head.whiskers_per_side
    }

    /// Ticks a second.
    pub fn tick_hz(&self) -> u32 {
        self.scene.tick_hz
    }

    /// The scene's number for the key of a slider; none where it has none.
    pub fn setting(&self, key: &str) -> Option<f64> {
        setting(&self.scene, key)
    }
}

pub(crate) fn setting(scene: &Scene, key: &str) -> Option<f64> {
    let whisking = || scene.whisking.as_ref();
    match key {
        "whisking.gain" => whisking()?.gain.first().copied(),
        "whisking.frequency_hz" => Some(whisking()?.frequency_hz),
        "rcp.gain" => Some(scene.rcp.as_ref()?.gain),
        "cia.gain" => Some(scene.cia.as_ref()?.gain),
        "plant.friction" => scene.plant.textured.as_ref()?.friction,
        "classifier.threshold" => threshold(scene),
        _ => None,
    }
}

fn threshold(scene: &Scene) -> Option<f64> {
    match scene.classifier.as_ref()?.rule {
        Rule::Sequential { threshold } => Some(threshold),
        Rule::Costs { .. } | Rule::Window { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use host_sim::decisions::Decided;
    use tactile::Decision;

    use super::{Player, line};

    fn player(scene: &str) -> Player {
        Player::new(&crate::scene_text(scene).unwrap(), "").unwrap()
    }

    #[test]
    fn a_decision_that_names_no_class_says_why() {
        let classes = ["ice", "loam"].map(str::to_owned);
        for (bits, decision, why) in [
            (0, "loam", "right\t\t"),
            (1, "unknown", "refused\tunknown\t"),
            (3, "unknown", "refused\tpose\t"),
            (5, "unknown", "refused\tbetween\tloam|ice"),
        ] {
            // Class 1 at even odds.
            let made = Decision::from_memory(34, 1 << 27 | 1 << 15, bits << 16).unwrap();
            let decided = Decided::new(made, &classes, "loam", "1");
            let expected = format!("1.250\t\t{decision}\t0.5000\t34\tloam\t{why}\t0");
            assert_eq!(line(1.25, &decided, &classes, false), expected);
        }
    }

    #[test]
    fn unknown_is_right_of_what_the_model_does_not_know() {
        let mut player = player("unknown");
        player.lay("carpet");
        player.step(8_000);
        let decisions = player.decisions();
        assert!(!decisions.is_empty());
        for line in decisions {
            let cells: Vec<&str> = line.split('\t').collect();
            let is_right = cells[2] == "unknown";
            let worth = if is_right { "right" } else { "wrong" };
            assert_eq!((cells[5], cells[6]), ("carpet", worth), "{line}");
        }
    }

    #[test]
    fn whiskers_of_a_head_are_on_their_boards_and_say_what_they_decide() {
        let keys = "head.whiskers_per_side=4\nhead.rows=2\nhead.nodes=8\nclassifier.whiskers=each";
        let mut player = Player::new(&crate::scene_text("both").unwrap(), keys).unwrap();
        assert_eq!(player.stands()[..6], [0, 0, 0, 1, 0, 1]);
        assert_eq!(player.stands()[21..], [1, 1, 7]);
        let mut numbers = std::collections::BTreeSet::new();
        for _ in 0..40 {
            player.step(200);
            let said = player.said();
            for line in player.decisions() {
                let cells: Vec<&str> = line.split('\t').collect();
                let (side, number) = cells[1].split_once(' ').unwrap();
                let number: usize = number.parse().unwrap();
                let n = number - 1 + if side == "left" { 0 } else { 4 };
                assert!(!said[n].is_empty(), "{line}");
                numbers.insert(n);
            }
        }
        assert!(numbers.len() > 4, "{numbers:?}");
    }

    #[test]
    fn only_what_a_plant_computes_can_be_laid() {
        assert_eq!(player("whisker").textures().len(), 11);
        let simple = ["smooth", "p600", "p240", "carpet"];
        assert_eq!(player("textures").textures(), simple);
        assert!(player("cia").textures().is_empty());
    }

    #[test]
    fn a_tick_is_heard_once_while_somebody_listens() {
        let mut player = player("textures");
        player.step(100);
        assert!(player.heard().is_empty());
        player.listen(true);
        player.step(100);
        let heard = player.heard();
        assert_eq!(heard.len(), 100);
        assert!(heard.iter().all(|x| (0.0..=16_383.0).contains(x)));
        assert!(player.heard().is_empty());
    }
}
