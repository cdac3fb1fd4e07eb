//! What a tick computes, without the hardware around it: for each whisker a
//! frame, two filtered channels, RCP, CIA, muscle, position control and a
//! classifier of nine classes; for each side an oscillator and a drive.

use mlx90333::Decoder;
use whisking::{Start, State, filter, pd};

use crate::format::Format;
use crate::listener::{Listener, open_9};
use crate::samples::frame;

/// One whisker's share.
#[derive(Debug)]
struct Channel<R: Format> {
    filters: [filter::State<R>; 2],
    pd: pd::State<R>,
    listener: Listener<9>,
    counts: i32,
}

/// `S` sides with `N` whiskers each.
#[derive(Debug)]
pub struct Pipeline<R: Format, const S: usize, const N: usize> {
    state: State<R, S, N>,
    channels: [[Channel<R>; N]; S],
    /// Duties and decisions, so that nothing is computed for nobody.
    said: u32,
}

impl<R: Format, const S: usize, const N: usize> Pipeline<R, S, N> {
    /// At its start.
    pub fn new(start: &Start<R, S, N>) -> Self {
        let channel = || Channel {
            filters: Default::default(),
            pd: pd::State::default(),
            listener: Listener::new(open_9()),
            counts: 0,
        };
        Self {
            state: State::new(start, 1),
            channels: core::array::from_fn(|_| core::array::from_fn(|_| channel())),
            said: 0,
        }
    }

    /// One tick; whisker n has frame `call` + n.
    #[inline]
    pub fn tick(&mut self, call: u32) {
        let mut contact = [R::ZERO; S];
        for (side, channels) in self.channels.iter_mut().enumerate() {
            for (n, channel) in channels.iter_mut().enumerate() {
                let bytes = frame(call + (side * N + n) as u32);
                let Ok(frame) = Decoder::new().decode(bytes) else {
                    self.said |= 1 << 31;
                    continue;
                };
                let words = [frame.first(), frame.second()];
                let [x, y] = words.map(|word| R::from_code(word.signed14().max(-8191)));
                let [on_x, on_y] = &mut channel.filters;
                let felt = [R::H50.process(on_x, x), R::H50.process(on_y, y)];
                for one in felt {
                    contact[side] = one.abs().max(contact[side]);
                }
                let codes = words.map(|word| i32::from(word.signed14()) + 8192);
                self.said = self.said.wrapping_add(channel.listener.push(codes));
            }
        }
        R::WHISKING.step(&mut self.state, contact);
        for (channels, whiskers) in self.channels.iter_mut().zip(&self.state.whiskers) {
            for (channel, whisker) in channels.iter_mut().zip(whiskers) {
                channel.counts += 2;
                let duty = R::PD.step(&mut channel.pd, whisker.muscle.theta, channel.counts, 2);
                self.said = self.said.wrapping_add(duty.magnitude().into());
            }
        }
    }

    /// What came of it.
    pub const fn said(&self) -> u32 {
        self.said
    }
}
