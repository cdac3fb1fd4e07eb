//! That textures can be told apart, and not for certain: the whole loop of
//! whisking with RCP, motor, surface and sensor, then a plain f64 naive Bayes
//! classifier with the sequential rule (LEP12 eqs. 3 to 8).

use mlx90333::Word;
use scene::Texture;

use crate::motor::rig::{PD, Rig, whisking};
use crate::plant::{Head, Plant, Textured, TexturedSettings};

const TEXTURES: [Texture; 4] = [
    Texture::Smooth,
    Texture::P600,
    Texture::P240,
    Texture::Carpet,
];
const BINS: usize = 100;
const BLOCK: usize = 20;
const SMOOTH: f64 = 5.0;
const THRESHOLD: f64 = 0.99;

type Sample = [f64; 2];

/// `whisks` of 2 Hz over a texture at 2 kHz, after one to get going.
fn record(texture: Texture, whisks: usize, seed: u64) -> Vec<Sample> {
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
    samples.split_off(1000)
}

/// Log-likelihoods of the bins of one channel for every class.
struct Channel {
    low: f64,
    high: f64,
    logs: Vec<[f64; BINS]>,
}

impl Channel {
    fn bin(&self, value: f64) -> usize {
        let share = (value - self.low) / (self.high - self.low);
        ((share * BINS as f64) as usize).min(BINS - 1)
    }

    fn train(classes: &[Vec<Sample>], axis: usize) -> Self {
        let values = || classes.iter().flatten().map(|sample| sample[axis]);
        let mut channel = Self {
            low: values().fold(f64::INFINITY, f64::min),
            high: values().fold(f64::NEG_INFINITY, f64::max),
            logs: Vec::new(),
        };
        for class in classes {
            let mut counts = [0.0; BINS];
            for sample in class {
                counts[channel.bin(sample[axis])] += 1.0;
            }
            let smoothed: [f64; BINS] = core::array::from_fn(|i| {
                let near = |(j, count): (usize, &f64)| {
                    let distance = (i as f64 - j as f64) / SMOOTH;
                    count * (-distance * distance / 2.0).exp()
                };
                counts.iter().enumerate().map(near).sum()
            });
            let total: f64 = smoothed.iter().sum();
            channel
                .logs
                .push(smoothed.map(|count| (count / total + 1e-6).ln()));
        }
        channel
    }
}

/// Decisions along a stream: class and samples used.
fn classify(channels: &[Channel; 2], stream: &[Sample]) -> Vec<(usize, usize)> {
    let mut decisions = Vec::new();
    let (mut evidence, mut used) = ([0.0; TEXTURES.len()], 0);
    for block in stream.chunks_exact(BLOCK) {
        used += BLOCK;
        for (class, evidence) in evidence.iter_mut().enumerate() {
            for sample in block {
                for (channel, value) in channels.iter().zip(sample) {
                    *evidence += channel.logs[class][channel.bin(*value)] / BLOCK as f64;
                }
            }
        }
        let best = (0..TEXTURES.len())
            .max_by(|&a, &b| evidence[a].total_cmp(&evidence[b]))
            .unwrap();
        let weight: f64 = evidence.iter().map(|e| (e - evidence[best]).exp()).sum();
        if 1.0 / weight > THRESHOLD {
            decisions.push((best, used));
            (evidence, used) = ([0.0; TEXTURES.len()], 0);
        }
    }
    decisions
}

#[test]
fn textures_are_told_apart_but_not_for_certain() {
    let train = TEXTURES.map(|texture| record(texture, 20, 1 + texture as u64));
    let channels = [0, 1].map(|axis| Channel::train(&train, axis));
    let (mut hits, mut time, mut count) = ([0.0; 4], 0.0, 0.0);
    for (class, &texture) in TEXTURES.iter().enumerate() {
        let decisions = classify(&channels, &record(texture, 60, 101 + texture as u64));
        for (_, samples) in &decisions {
            time += *samples as f64;
            count += 1.0;
        }
        let right = decisions.iter().filter(|(d, _)| *d == class).count();
        hits[class] = right as f64 / decisions.len().max(1) as f64;
    }
    let hit_rate = hits.iter().sum::<f64>() / 4.0;
    let time = time / count;
    assert!((0.70..=0.95).contains(&hit_rate), "{hit_rate}");
    assert!((100.0..=1000.0).contains(&time), "{time}");
}
