//! Textures can be distinguished, but not with certainty: the whole loop of
//! whisking with RCP, motor, surface and sensor, then the classifier as it is
//! trained by default, with the sequential rule (LEP12 eqs. 3 to 8).

use mlx90333::Word;
use scene::{Rule, Texture};
use tactile::train::{Options, Trainer};

use crate::decisions::Score;
use crate::motor::rig::{PD, Rig, whisking};
use crate::plant::{Head, Plant, Textured, TexturedSettings};
use crate::recording::{GATE, Stream};
use crate::replay::Replay;
use crate::training;

const TEXTURES: [Texture; 4] = [
    Texture::Smooth,
    Texture::P600,
    Texture::P240,
    Texture::Carpet,
];

/// `whisks` of 2 Hz over a texture at 2 kHz, after one to get going.
fn record(texture: Texture, whisks: usize, seed: u64) -> Stream {
    let head = Head {
        whiskers_per_side: 1,
        obstacle_deg: vec![100.0],
        stiffness: 0.1,
    };
    let mut plant = Textured::new(head, TexturedSettings::default(), seed).unwrap();
    plant.present(texture);
    let mut rig = Rig::new(&whisking(2000.0, Some(0.7)), &PD, 1.0);
    let mut samples = Vec::new();
    for _ in 0..(whisks + 1) * 1000 {
        // Through the sensor's 14 bits.
        let reading = plant.deflection(0, 0);
        let reading = reading.map(|v| f64::from(Word::from_normalised(v as f32).normalised()));
        samples.push(reading);
        rig.tick(reading[0]);
        plant.advance(&[rig.motor.angle_deg()], 5e-4);
    }
    Stream {
        label: texture.name().to_owned(),
        trial: String::new(),
        samples: samples.split_off(1000),
        contact: None,
        touch: None,
        pose: None,
    }
}

#[test]
fn textures_are_distinguished_but_not_for_certain() {
    let training = TEXTURES.map(|texture| record(texture, 20, 1 + texture as u64));
    let trainer = Trainer::new(2, Options::default()).unwrap();
    let rule = Rule::Sequential { threshold: 0.99 };
    let model = training::single(trainer, &training, GATE, false).unwrap();
    let mut replay = Replay::new(model, rule).unwrap();
    let mut decided = Vec::new();
    for texture in TEXTURES {
        let test = record(texture, 60, 101 + texture as u64);
        let decisions = replay.stream(&test).unwrap();
        assert!(!decisions.is_empty(), "{texture}");
        decided.extend(decisions);
    }
    let score = Score::new(replay.classes(), &decided);
    let (hit_rate, time) = (score.hit_rate().unwrap(), score.mean_samples().unwrap());
    assert!((0.70..=0.95).contains(&hit_rate), "{hit_rate}");
    assert!((100.0..=1000.0).contains(&time), "{time}");
}
