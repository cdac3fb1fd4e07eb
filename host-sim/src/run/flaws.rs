//! What simulated sensors make of a deflection: a magnet that is turned, a gain that a
//! presentation has and one of its own for y, neighbours' magnets, hysteresis, and a zero that is elsewhere and moves.

use scene::Scene;

/// A code of 14 bits as a deflection.
const CODE: f64 = 1.0 / 8191.0;

/// All sensors of a head; none of it is known to a module.
#[derive(Debug, Clone)]
pub(super) struct Flaws {
    whiskers: usize,
    /// Sine and cosine of the angle by which sensors are turned about their shafts.
    turn: [f64; 2],
    /// Of x and y alike, while the present surface is there.
    pub(super) gain: f64,
    gain_y: f64,
    /// Share of a neighbour's deflection.
    cross_talk: f64,
    /// Half the width of the hysteresis, a deflection.
    play: f64,
    /// What each sensor holds within its hysteresis.
    held: Vec<[f64; 2]>,
    /// By side: deflections at the start, and by how much they change in a second.
    zero: [[f64; 2]; 2],
    drift: [[f64; 2]; 2],
    are_there: bool,
}

impl Flaws {
    pub(super) fn new(scene: &Scene) -> Self {
        let plant = &scene.plant;
        let of = |codes: &Option<Vec<[f64; 2]>>| {
            let pair = |side| codes.as_deref().and_then(|sides| sides.get(side).copied());
            [0, 1].map(|side: usize| pair(side).unwrap_or_default().map(|codes| codes * CODE))
        };
        let (sine, cosine) = libm::sincos(plant.misaligned_deg.to_radians());
        Self {
            whiskers: scene.head.whiskers_per_side,
            turn: [sine, cosine],
            gain: 1.0,
            gain_y: plant.gain_y,
            cross_talk: plant.cross_talk,
            play: 0.5 * plant.hysteresis_codes * CODE,
            held: vec![[0.0; 2]; scene.whiskers()],
            zero: of(&plant.zero_codes),
            drift: of(&plant.zero_drift),
            are_there: sine != 0.0
                || plant.gain_y != 1.0
                || plant.spread.is_some_and(|spread| spread.gain_spread > 0.0)
                || plant.cross_talk > 0.0
                || plant.hysteresis_codes > 0.0
                || plant.zero_codes.is_some()
                || plant.zero_drift.is_some(),
        }
    }

    pub(super) fn restart(&mut self) {
        self.held.fill([0.0; 2]);
        self.gain = 1.0;
    }

    /// What the sensor of whisker `n`, left side first, reads `t_s` after the start, of the
    /// deflections of `all`. In the first tick it is the deflection itself: no frame has come by
    /// then, and a module takes its sensors to be at mid-scale.
    pub(super) fn sensed(&mut self, n: usize, t_s: f64, all: &[[f64; 2]]) -> [f64; 2] {
        let own = all.get(n).copied().unwrap_or_default();
        let side = n / self.whiskers.max(1);
        let (Some(zero), Some(drift), Some(held)) = (
            self.zero.get(side),
            self.drift.get(side),
            self.held.get_mut(n),
        ) else {
            return own;
        };
        if t_s <= 0.0 || !self.are_there {
            return own;
        }
        let mut read = own;
        // What is left out changes no bit.
        if self.cross_talk > 0.0 {
            let beside = [n.checked_sub(1), n.checked_add(1)].into_iter().flatten();
            let beside = beside.filter(|other| other / self.whiskers.max(1) == side);
            for [x, y] in beside.filter_map(|other| all.get(other)) {
                read = [read[0] + self.cross_talk * x, read[1] + self.cross_talk * y];
            }
        }
        let [sine, cosine] = self.turn;
        if sine != 0.0 {
            let [x, y] = read;
            read = [cosine * x - sine * y, sine * x + cosine * y];
        }
        read = [self.gain * read[0], self.gain * self.gain_y * read[1]];
        if self.play > 0.0 {
            for (read, held) in read.iter_mut().zip(held) {
                if read.is_finite() {
                    *held = held.clamp(*read - self.play, *read + self.play);
                    *read = *held;
                }
            }
        }
        [0, 1].map(|axis: usize| read[axis] + (zero[axis] + t_s * drift[axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::{CODE, Flaws};
    use scene::Scene;

    fn flaws(keys: &str) -> Flaws {
        let text = format!(
            "name = \"f\"\ntick_hz = 2000\nduration_s = 1\nseed = 1\n[head]\n\
             whiskers_per_side = 2\n[plant]\nkind = \"ideal\"\n{keys}\n"
        );
        Flaws::new(&Scene::from_str("f.toml", &text).unwrap())
    }

    const ALL: [[f64; 2]; 4] = [[0.1, 0.2], [0.4, -0.2], [0.6, 0.0], [0.0, 0.8]];

    fn close(found: [f64; 2], expected: [f64; 2]) {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn without_flaws_a_sensor_reads_what_there_is_to_the_bit() {
        let mut plain = flaws("");
        for (n, deflection) in ALL.into_iter().enumerate() {
            assert_eq!(plain.sensed(n, 0.5, &ALL), deflection);
        }
        assert!(plain.sensed(0, 0.5, &[[f64::NAN, 0.0]; 4])[0].is_nan());
    }

    #[test]
    fn what_is_turned_or_near_is_read_as_geometry_has_it() {
        let half = 0.5_f64.sqrt();
        for (keys, n, expected) in [
            // An eighth of a turn takes x to y, and gains come behind it.
            (
                "misaligned_deg = 45\ngain_y = 2.0",
                2,
                [0.6 * half, 1.2 * half],
            ),
            // Neighbours of a side are felt, and those of the other are not.
            ("cross_talk = 0.1", 1, [0.41, -0.18]),
            ("cross_talk = 0.1", 2, [0.6, 0.08]),
        ] {
            close(flaws(keys).sensed(n, 0.5, &ALL), expected);
        }
    }

    #[test]
    fn a_presentation_s_gain_is_of_x_and_y_alike_until_the_restart() {
        let mut scaled = flaws("gain_y = 2.0");
        scaled.gain = 1.05;
        close(scaled.sensed(1, 0.5, &ALL), [0.42, -0.42]);
        scaled.restart();
        close(scaled.sensed(1, 0.5, &ALL), [0.4, -0.4]);
    }

    #[test]
    fn within_its_hysteresis_a_sensor_stays() {
        let mut stiff = flaws("hysteresis_codes = 100");
        let mut read = |codes: f64| stiff.sensed(0, 0.5, &[[codes * CODE, 0.0]])[0] / CODE;
        // 50 behind on the way up, and on the way down.
        for (at, expected) in [
            (40.0, 0.0),
            (200.0, 150.0),
            (120.0, 150.0),
            (0.0, 50.0),
            (-50.0, 0.0),
        ] {
            let found = read(at);
            assert!((found - expected).abs() < 1e-9, "{at}: {found}");
        }
    }
}
