//! The whisking head of BIOTACT: two rows of three whiskers before a flat
//! surface, moved by the firmware's own tick in a closed loop: what the whiskers
//! feel goes by sensor frames through H50 and RCP back to the muscles, and motors
//! follow those as their position control, friction and load let them.
//!
//! Head frame, from above: x forward along the axis of the cone, y to the
//! left, z up; the front of the head at x = 0, the surface at x = distance. A
//! whisker at θ' = 90 degrees points sideways, beyond that forward.

//!
//! Recorded are visits, strategies × textures × distances, and early ones, where the surface is
//! nearer and RCP can also be strong and fast: they are looked at but not classified.

use anyhow::Result;
use whisking::{GateSettings, Integrator, Settings};

use super::{Chance, EACH, HeadModule, PositionControl, SIDES, keys, plane, seed_of, whiskers};
use crate::experiment::{Dataset, Recording, Request};
use crate::paper::biotact::{
    DISTANCES_MM, OBSTACLES_DEG, STRATEGIES, STRONG, TAU_Z_PERIODS, TEXTURES, WHISKERS,
};
use physics::vector::add;
use physics::{Biotact, Plate, Pose, SensorSettings, Shaft, Surface, TouchingWhisker};

/// Channels: x and y of every whisker, left side first.
pub(crate) const CHANNELS: usize = 2 * SIDES * EACH;

/// Sensor channels, then θ' of the front whiskers in degrees and whether a
/// side touches (1) or not (0).
pub(crate) const COLUMNS: usize = CHANNELS + 4;

/// Where the front whisker meets the smooth surface in the early visits,
/// degrees: the obstacle of BIOTACT Fig. 8.
pub(crate) const EARLY_DEG: f64 = OBSTACLES_DEG[0];

/// The texture and distance of all in a placebo: P600 at 10 mm.
const PLACEBO: (usize, usize) = (1, 1);

const CLASSIFIED: usize = STRATEGIES.len() * TEXTURES.len() * DISTANCES_MM.len();

/// How many visits there are: those of the strategies, then the early ones, one
/// a strategy and one with strong and fast RCP.
pub(crate) fn jobs() -> usize {
    CLASSIFIED + STRATEGIES.len() + 1
}

/// The job of an early visit; `strategy` is one more than the last for strong and fast RCP.
pub(crate) fn early(strategy: usize) -> usize {
    CLASSIFIED + strategy
}

pub(crate) fn number(strategy: usize, texture: usize, distance: usize) -> usize {
    (strategy * TEXTURES.len() + texture) * DISTANCES_MM.len() + distance
}

keys! {
    WhiskingHead, rig:
    tick_hz: f64 => 200.0..=20_000.0,
    whisk_hz: f64 => 0.05..=25.0,
    noise: f64 => 0.0..=1.0,
    gain: f64 => 0.0..=2.0,
    lead_whisks: usize => 0.0..=1000.0,
    base_back_m: [f64; EACH] => 0.0..=1.0,
    base_side_m: [f64; EACH] => 0.0..=1.0,
    placement_sd_m: f64 => 0.0..=0.1,
    spot_spread_m: f64 => 0.0..=0.1,
    pitch_deg: f64 => -60.0..=60.0,
    roll_deg: f64 => -60.0..=60.0,
    follicle: f64 => 0.01..=100.0,
    smooth_bins: f64 => 0.0..=50.0,
    full_scale_rad: f64 => 1e-4..=3.0,
    motor: PositionControl,
}

/// What the head is put before, and how it whisks there.
struct Visit<'a> {
    /// From the front of the head to the surface, m.
    distance_m: f64,
    surface: &'a Surface,
    /// The spot of it that is met, m along and up it.
    spot_m: [f64; 2],
    /// RCP, if whisking is modulated.
    rcp: Option<GateSettings>,
    whisks: usize,
    /// Of this visit's chance.
    seed: u64,
}

impl WhiskingHead {
    pub(crate) fn whisk_ticks(&self) -> usize {
        (self.tick_hz / self.whisk_hz).round() as usize
    }

    /// Where a whisker is at an angle θ'. Its sensor's x is along protraction, and `roll_deg` from
    /// there about the shaft.
    fn pose(&self, side: usize, whisker: usize, theta_deg: f64) -> Pose {
        let left = if side == 0 { 1.0 } else { -1.0 };
        let (sine, cosine) = libm::sincos(theta_deg.to_radians());
        let (back, aside) = (self.base_back_m[whisker], self.base_side_m[whisker]);
        let (turned, straight) = libm::sincos(self.roll_deg.to_radians());
        // The shaft is (−cos, ± sin, 0): forward its derivative by θ', y = shaft × forward.
        let forward = [sine, left * cosine, 0.0];
        let y = [0.0, 0.0, -left];
        Pose {
            base_m: [-back, left * aside, 0.0],
            x: add(forward.map(|part| straight * part), turned, y),
            y: add(y.map(|part| straight * part), -turned, forward),
        }
    }

    /// The part of a whisker's rotation that is about the motor's axis, of both by the sensor's.
    fn in_the_plane_of_whisking(&self, [x, y]: [f64; 2]) -> f64 {
        let (turned, straight) = libm::sincos(self.roll_deg.to_radians());
        straight * x - turned * y
    }

    /// The surface where the arm has brought it once, and the spot of it that whiskers meet.
    fn placed(&self, visit: &Visit<'_>, chance: &mut Chance) -> Plate {
        let (sine, cosine) = libm::sincos(self.pitch_deg.to_radians());
        let distance_m = visit.distance_m + self.placement_sd_m * chance.normal();
        let spread = self.spot_spread_m;
        let spot = visit.spot_m.map(|m| m + chance.between(-spread, spread));
        let along = [0.0, 1.0, 0.0];
        let up = [sine, 0.0, cosine];
        let aside = add([distance_m, 0.0, 0.0], spot[0], along);
        let axes = ([-cosine, 0.0, sine], along);
        plane(add(aside, spot[1], up), axes, *visit.surface)
    }

    /// What is felt from tick to tick: samples of [`COLUMNS`] numbers.
    fn visit(
        &self,
        shafts: &[Shaft; EACH],
        sensor: &SensorSettings,
        visit: &Visit<'_>,
    ) -> Result<Vec<f32>> {
        let settings = Settings {
            tick_hz: self.tick_hz,
            frequency_hz: self.whisk_hz,
            // The module's; the paper has forward Euler, by which free whisking peaks at 122.9 degrees
            // in place of 121.9.
            integrator: Integrator::Exact,
            coupling: true,
            noise: self.noise,
            rcp: visit.rcp,
            cia: None,
        };
        let seed = seed_of(visit.seed, &[0]);
        let mut module = HeadModule::new(&settings, &self.motor, self.gain, seed)?;

        let mut chance = Chance::new(seed_of(visit.seed, &[1]));
        let mut plate = self.placed(visit, &mut chance);
        let mut is_to_move = false;
        let mut whiskers = Vec::with_capacity(SIDES * EACH);
        for n in 0..SIDES * EACH {
            let seed = seed_of(visit.seed, &[2, n as u64]);
            let whisker = TouchingWhisker::new(&shafts[n % EACH], sensor, seed);
            whiskers.push(whisker?);
        }
        let dt_s = 1.0 / self.tick_hz;

        let lead = self.lead_whisks * self.whisk_ticks();
        let mut felt = Vec::with_capacity(visit.whisks * self.whisk_ticks() * COLUMNS);
        for tick in 0..lead + visit.whisks * self.whisk_ticks() {
            for (n, whisker) in whiskers.iter().enumerate() {
                module.feel(n, whisker.codes());
            }
            module.tick()?;
            // Again for each whisk, as soon as no whisker touches.
            is_to_move |= tick > 0 && tick % self.whisk_ticks() == 0;
            if is_to_move && !whiskers.iter().any(TouchingWhisker::contact) {
                plate = self.placed(visit, &mut chance);
                is_to_move = false;
            }
            let mut touching = [false; SIDES];
            let mut front = [0.0; SIDES];
            for (n, whisker) in whiskers.iter_mut().enumerate() {
                let (side, place) = (n / EACH, n % EACH);
                // The follicle's torque; a free whisker's inertia is in the motor's.
                let stiffness = shafts[place].follicle.rotation_n_m_rad;
                let bent = stiffness * self.in_the_plane_of_whisking(whisker.rotation_rad());
                let load = if whisker.contact() { bent } else { 0.0 };
                let angle = module.turn(n, load, dt_s);
                if place == 0 {
                    front[side] = angle;
                }
                let pose = self.pose(side, place, angle);
                whisker.step(&pose, Some(&plate), dt_s);
                touching[side] |= whisker.contact();
                if tick >= lead {
                    felt.extend(whisker.codes().map(f32::from));
                }
            }
            if tick >= lead {
                felt.extend(front.map(|angle| angle as f32));
                felt.extend(touching.map(|touches| f32::from(u8::from(touches))));
            }
        }
        Ok(felt)
    }
}

pub(crate) fn record(request: &Request, job: usize, seed: u64) -> Result<Recording> {
    let rig = &request.rigs.head;
    let (strategy, texture, distance_m) = if let Some(strategy) = job.checked_sub(CLASSIFIED) {
        let front = WHISKERS[0].0 / 1000.0;
        let reach = -front * libm::cos(EARLY_DEG.to_radians());
        (strategy, TEXTURES.len() - 1, reach - rig.base_back_m[0])
    } else {
        let (group, distance) = (job / DISTANCES_MM.len(), job % DISTANCES_MM.len());
        let (strategy, texture) = (group / TEXTURES.len(), group % TEXTURES.len());
        let distance_m = DISTANCES_MM[request.place(distance, PLACEBO.1)] / 1000.0;
        (strategy, texture, distance_m)
    };
    let (gain, periods) = match STRATEGIES.get(strategy) {
        Some((_, gain)) => (*gain, TAU_Z_PERIODS),
        None => STRONG,
    };
    let surface = request.surface(&whiskers::ABRASIVES, texture, PLACEBO.0);
    let visit = Visit {
        distance_m,
        // The arm goes along its axis: one spot of a texture for all distances and strategies.
        spot_m: request.spot_m(Dataset::Head, texture, seed),
        surface: &surface,
        rcp: (gain > 0.0).then_some(GateSettings {
            gain,
            tau_s: periods / rig.whisk_hz,
        }),
        whisks: request.extent.whisks,
        seed,
    };
    let sensor = whiskers::sensor([rig.full_scale_rad; 2]);
    // The front one first.
    let shafts = Biotact::ALL.map(|length| whiskers::held(Shaft::biotact(length), rig.follicle));
    let felt = rig.visit(&shafts, &sensor, &visit)?;
    Ok(Recording::new(COLUMNS, felt))
}

#[cfg(test)]
mod tests {
    use super::{COLUMNS, DISTANCES_MM, Visit, WHISKERS, WhiskingHead};
    use crate::moments::range;
    use crate::rigs::{Chance, Rigs};
    use physics::vector::{add, cross, dot};
    use physics::{Biotact, Material, SensorSettings, Shaft, Surface};

    fn rig() -> WhiskingHead {
        Rigs::with(&[]).head
    }

    #[test]
    fn x_is_the_way_of_the_tip_and_the_sides_mirror() {
        let rig = rig();
        let tip = |side, theta| {
            let pose = rig.pose(side, 1, theta);
            add(pose.base_m, 0.112, cross(pose.x, pose.y))
        };
        for side in [0, 1] {
            let pose = rig.pose(side, 1, 110.0);
            let step = 1e-4_f64;
            let moved = add(tip(side, 110.0 + step), -1.0, tip(side, 110.0 - step));
            let way = moved.map(|part| part / (2.0 * step.to_radians() * 0.112));
            assert!((dot(way, pose.x) - 1.0).abs() < 1e-9, "{way:?}");
        }
        let (left, right) = (tip(0, 100.0), tip(1, 100.0));
        assert!((left[0] - right[0]).abs() < 1e-15 && (left[1] + right[1]).abs() < 1e-15);
        assert!(left[1] > 0.1, "the left is at +y");
        assert!(
            tip(0, 120.0)[0] > tip(0, 90.0)[0],
            "protraction goes forward"
        );
    }

    /// The shaft stays, its sensor turns about it, and the motor bears what it bore.
    #[test]
    fn a_roll_turns_the_sensor_about_its_shaft() {
        let straight = rig();
        let mut rolled = rig();
        rolled.roll_deg = 20.0;
        for (side, theta) in [(0, 70.0), (1, 110.0)] {
            let (from, to) = (straight.pose(side, 1, theta), rolled.pose(side, 1, theta));
            let off = add(cross(from.x, from.y), -1.0, cross(to.x, to.y));
            assert!(dot(off, off) < 1e-24);
            let turn = dot(to.x, from.y).atan2(dot(to.x, from.x));
            assert!((turn.to_degrees() - 20.0).abs() < 1e-9, "{turn}");
            // A rotation towards protraction, as the rolled sensor has it.
            let of = [dot(to.x, from.x), dot(to.y, from.x)].map(|part| 0.3 * part);
            assert!((rolled.in_the_plane_of_whisking(of) - 0.3).abs() < 1e-12);
        }
    }

    /// Unmodulated whisks at 10 mm.
    fn visit(surface: &Surface, whisks: usize) -> Visit<'_> {
        Visit {
            distance_m: 0.01,
            surface,
            spot_m: [0.0; 2],
            rcp: None,
            whisks,
            seed: 1,
        }
    }

    /// Largest |x| of the left front whisker in each of four whisks before the smooth surface.
    fn peaks(placement_sd_m: f64, spot_spread_m: f64) -> Vec<f32> {
        let mut rig = rig();
        (rig.placement_sd_m, rig.spot_spread_m) = (placement_sd_m, spot_spread_m);
        rig.noise = 0.0;
        rig.motor.follows = false;
        let sensor = SensorSettings {
            full_scale_rad: [0.02; 2],
            noise_codes: 0.0,
            ..SensorSettings::default()
        };
        let flat = Surface::of(Material::Flat);
        let visit = visit(&flat, 4);
        let shafts = Biotact::ALL.map(Shaft::biotact);
        let felt = rig.visit(&shafts, &sensor, &visit).unwrap();
        let whisks = felt.chunks(COLUMNS * rig.whisk_ticks());
        let x = |whisk: &[f32]| -> f32 {
            let x = whisk.iter().step_by(COLUMNS);
            x.map(|x| x.abs()).fold(0.0, f32::max)
        };
        whisks.map(x).collect()
    }

    #[test]
    fn the_surface_is_placed_again_for_each_whisk() {
        let apart = |peaks: &[f32]| {
            let (low, high) = range(peaks.iter().map(|peak| f64::from(*peak)));
            high - low
        };
        let still = peaks(0.0, 0.0);
        assert_eq!(still.len(), 4);
        assert!(apart(&still) < 20.0, "{still:?}");
        // A flat surface is alike at every spot; by a millimetre of distance it is not.
        let elsewhere = peaks(0.0, 0.005);
        assert!(apart(&elsewhere) < 20.0, "{elsewhere:?}");
        let moved = peaks(0.001, 0.0);
        let differ = |pair: &&[f32]| (pair[0] - pair[1]).abs() > 100.0;
        assert!(moved.windows(2).filter(differ).count() >= 2, "{moved:?}");
    }

    #[test]
    fn a_pitch_slopes_the_surface_upwards_and_keeps_its_distance() {
        let mut rig = rig();
        (rig.pitch_deg, rig.placement_sd_m) = (20.0, 0.0);
        let flat = Surface::of(Material::Flat);
        let visit = visit(&flat, 1);
        let plate = rig.placed(&visit, &mut Chance::new(3));
        assert!((dot(plate.normal, plate.normal) - 1.0).abs() < 1e-12);
        assert!(dot(plate.normal, plate.along).abs() < 1e-12);
        assert!((plate.normal[2] / -plate.normal[0] - 20.0_f64.to_radians().tan()).abs() < 1e-12);
        // The axis meets it at the distance, whatever the spot.
        let off = add([0.01, 0.0, 0.0], -1.0, plate.point_m);
        assert!(dot(plate.normal, off).abs() < 1e-12);
    }

    /// BIOTACT section II-C: all whiskers can touch a plane orthogonal to the
    /// axis. Free whisking of the module at gain 1 peaks at 121.9 degrees.
    #[test]
    fn every_whisker_touches_the_surface_at_every_distance_when_protracted() {
        let rig = rig();
        for distance in DISTANCES_MM {
            for (whisker, (length_mm, _)) in WHISKERS.into_iter().enumerate() {
                let reach = |theta: f64| {
                    let pose = rig.pose(0, whisker, theta);
                    let shaft = cross(pose.x, pose.y);
                    add(pose.base_m, length_mm / 1000.0, shaft)[0]
                };
                assert!(reach(121.9) > distance / 1000.0, "{distance} {whisker}");
                assert!(reach(90.0) < 0.0);
            }
        }
    }
}
