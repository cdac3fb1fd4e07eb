//! The oscillators of a head as a node computes them, beside what their leaders say.

use can::Q22_ONE;
use whisking::oscillator::{self, Psi};
use whisking::{MAX_SIDES, Real};

use super::Times;

/// So many ψ of its own are kept: those of the delay of a message, and one more.
const KEPT: usize = 4;

/// By how much a message changes ψ at most, in each coordinate: what is off by a whole circle is
/// right again within half a second, two whisks at 4 Hz, and no muscle moves by a step.
const MOST: i32 = Q22_ONE / 64;

/// Differences beyond which a node that moves nothing takes ψ as it comes.
const FAR: i32 = Q22_ONE / 16;

/// ψ of each side after a tick, Q22.
type All = [Psi22; MAX_SIDES];
type Psi22 = [i32; 2];

/// Oscillators beside those of their leaders.
#[derive(Debug)]
pub(super) struct Replica {
    times: Times,
    kept: [Option<(u32, All)>; KEPT],
    /// Whether it follows the leader of a side, as far as it heard it.
    is_led: [bool; MAX_SIDES],
}

impl Replica {
    pub(super) const fn new(times: Times) -> Self {
        Self {
            times,
            kept: [None; KEPT],
            is_led: [false; MAX_SIDES],
        }
    }

    pub(super) const fn forget(&mut self) {
        self.kept = [None; KEPT];
        self.is_led = [false; MAX_SIDES];
    }

    pub(super) fn is_led(&self, side: usize) -> bool {
        self.is_led.get(side) == Some(&true)
    }

    fn place(&self, tick: u32) -> usize {
        tick.checked_div(self.times.psi.into()).unwrap_or(0) as usize % KEPT
    }

    pub(super) fn keep<R: Real>(&mut self, tick: u32, all: &[Psi<R>]) {
        let mut kept = All::default();
        for (kept, psi) in kept.iter_mut().zip(all) {
            *kept = psi.map(|x| x.to_q24() >> 2);
        }
        let place = self.place(tick);
        if let Some(one) = self.kept.get_mut(place) {
            *one = Some((tick, kept));
        }
    }

    pub(super) fn at(&self, tick: u32, side: usize) -> Option<Psi22> {
        let (of, all) = (*self.kept.get(self.place(tick))?)?;
        all.get(side).copied().filter(|_| of == tick)
    }

    /// By what the leader of a side had after the tick of its stamp. What was kept since is
    /// corrected too: the leader's next ψ was said before this took effect.
    pub(super) fn correct<R: Real>(
        &mut self,
        (config, state): (&oscillator::Config<R>, &mut oscillator::State<R>),
        (side, heard): (usize, Psi22),
        now: u32,
        is_joined: bool,
    ) {
        let made = now.wrapping_sub(self.times.delay.into());
        // What was kept was of the node's own clock, before that was set.
        let Some(own) = self.at(made, side) else {
            return;
        };
        if let Some(is_led) = self.is_led.get_mut(side) {
            *is_led = true;
        }
        let ([heard_x, heard_y], [own_x, own_y]) = (heard, own);
        let [x, y] = [heard_x - own_x, heard_y - own_y];
        // Alike, but for how numbers are rounded.
        if x.abs() <= 1 && y.abs() <= 1 {
            return;
        }
        let is_far = x.abs() > FAR || y.abs() > FAR;
        let most = if is_far && !is_joined {
            4 * Q22_ONE
        } else {
            MOST
        };
        let mut difference = [x, y].map(|x| R::from_q24(x.clamp(-most, most) << 2));
        let (mut at, last) = (made, now.wrapping_sub(1));
        loop {
            self.change(at, side, difference.map(|x| x.to_q24() >> 2));
            let left = last.wrapping_sub(at);
            let age = left.min(self.times.psi.into()) as u16;
            difference = config.aged(difference, age);
            if left <= age.into() {
                break;
            }
            at = at.wrapping_add(age.into());
        }
        config.shift(state, side, difference);
    }

    /// Adds to what was kept of a side after a tick.
    fn change(&mut self, tick: u32, side: usize, difference: Psi22) {
        let place = self.place(tick);
        let kept = self.kept.get_mut(place).and_then(Option::as_mut);
        if let Some((_, all)) = kept.filter(|(of, _)| *of == tick)
            && let Some(psi) = all.get_mut(side)
        {
            for (x, difference) in psi.iter_mut().zip(difference) {
                *x = x.saturating_add(difference);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use whisking::oscillator::{Config, State};
    use whisking::{Integrator, Settings};

    use super::{Psi22, Q22_ONE, Replica, Times};

    const TICK_HZ: u32 = 2000;

    fn psi22(config: &Config<f32>, state: &State<f32>) -> Psi22 {
        config.psi(state)[0].map(|x| (x * Q22_ONE as f32) as i32)
    }

    proptest! {
        /// A follower that begins `off` radians beside its leader comes nearer by each message, by
        /// its bound at most, and never passes by: what two messages say of the same difference is
        /// corrected once.
        #[test]
        fn a_difference_is_corrected_once(
            off in -0.4_f32..0.4,
            whisk_hz in 1.0..10.0_f64,
            is_exact: bool,
            twice: bool,
        ) {
            let integrator = if is_exact { Integrator::Exact } else { Integrator::Euler };
            let settings = Settings {
                tick_hz: TICK_HZ.into(),
                frequency_hz: whisk_hz,
                integrator,
                coupling: false,
                noise: 0.0,
                rcp: None,
                cia: None,
            };
            let config = settings.build::<f32>().unwrap().oscillators;
            let at = |phase: f32| State::new([[phase.cos(), phase.sin()]].into_iter().collect());
            let (mut leader, mut follower) = (at(0.3), at(0.3 + off));
            let times = Times::at(TICK_HZ);
            let mut replica = Replica::new(times);
            let mut said: Vec<(u32, Psi22)> = Vec::new();
            let angle = |state: &State<f32>| {
                let [x, y] = config.psi(state)[0];
                y.atan2(x)
            };
            let apart = |one: &State<f32>, other: &State<f32>| {
                let difference = angle(one) - angle(other);
                difference.sin().atan2(difference.cos())
            };
            let mut last = off;
            for tick in 1..=1_000_u32 {
                let delay = u32::from(times.delay);
                for (_, heard) in said.iter().filter(|(made, _)| made + delay == tick) {
                    for _ in 0..=u32::from(twice) {
                        replica.correct((&config, &mut follower), (0, *heard), tick, true);
                    }
                }
                config.step(&mut leader, None);
                config.step(&mut follower, None);
                if tick.is_multiple_of(times.psi.into()) {
                    said.push((tick, psi22(&config, &leader)));
                    replica.keep(tick, &config.psi(&follower));
                }
                let now = apart(&follower, &leader);
                let passed_by = -now * off.signum();
                prop_assert!(passed_by < 6e-3, "{tick}: {last} {now}");
                prop_assert!(now.abs() < last.abs() + 6e-3, "{tick}: {last} {now}");
                let most = if twice { 6.0 } else { 3.0 } / 64.0;
                prop_assert!((now - last).abs() < most, "{tick}: {last} {now}");
                last = now;
            }
            prop_assert!(last.abs() < 1e-5, "{last}");
        }
    }
}
