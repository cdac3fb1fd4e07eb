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

    /// Corrects a side before tick `now` by what its leader had after the tick of its stamp.
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
        let difference = [x, y].map(|x| R::from_q24(x.clamp(-most, most) << 2));
        let age = self.times.delay - 1;
        config.shift(state, side, config.aged(difference, age));
    }
}
