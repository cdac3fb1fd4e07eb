//! What a tick computes, without the hardware around it: for each whisker a
//! frame, two filtered channels, RCP, CIA, muscle, position control and a
//! classifier of nine classes; for each side an oscillator and a drive.

use mlx90333::Decoder;
use whisking::{PatternGenerator, Start, State, filter, pd};

use crate::format::{Format, in_memory};
use crate::listener::{Listener, open_9};
use crate::samples::frame;

/// One whisker's share: sensor, filters, motor and classifier.
#[derive(Debug)]
pub struct Channel<R: Format> {
    filters: [filter::State<R>; 2],
    pd: pd::State<R>,
    listener: Listener<2>,
    counts: i32,
}

impl<R: Format> Channel<R> {
    /// Takes the frame of a number in: what the classifier says, and the contact or
    /// `strongest`, whichever is more.
    #[inline]
    fn listen(&mut self, number: u32, strongest: R) -> (u32, R) {
        let Ok(frame) = Decoder::new().decode(frame(number)) else {
            return (1 << 31, strongest);
        };
        let words = [frame.first(), frame.second()];
        let [x, y] = words.map(|word| R::from_code(word.signed14().max(-8191)));
        let [on_x, on_y] = &mut self.filters;
        let felt = [
            in_memory(R::H50).process(on_x, x),
            in_memory(R::H50).process(on_y, y),
        ];
        let strongest = felt
            .into_iter()
            .fold(strongest, |most, one| one.abs().max(most));
        let codes = words.map(|word| i32::from(word.signed14()) + 8192);
        (self.listener.push(codes), strongest)
    }
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
    pub fn tick(&mut self, call: u32) -> u32 {
        self.tick_by(call, Channel::listen, whisk, follow)
    }

    /// The same by functions that are not inlined: in one long function the
    /// addresses of many whiskers are beyond what an instruction reaches.
    #[inline]
    pub fn tick_apart(&mut self, call: u32) -> u32 {
        #[inline(never)]
        fn listen<R: Format>(channel: &mut Channel<R>, number: u32, strongest: R) -> (u32, R) {
            channel.listen(number, strongest)
        }
        #[inline(never)]
        fn whisk<R: Format, const S: usize, const N: usize>(
            state: &mut State<R, S, N>,
            contact: [R; S],
        ) {
            self::whisk(state, contact);
        }
        #[inline(never)]
        fn follow<R: Format, const S: usize, const N: usize>(
            channels: &mut [[Channel<R>; N]; S],
            state: &State<R, S, N>,
        ) -> u32 {
            self::follow(channels, state)
        }
        self.tick_by(call, listen, whisk, follow)
    }

    #[inline]
    fn tick_by(
        &mut self,
        call: u32,
        listen: impl Fn(&mut Channel<R>, u32, R) -> (u32, R),
        whisk: impl Fn(&mut State<R, S, N>, [R; S]),
        follow: impl Fn(&mut [[Channel<R>; N]; S], &State<R, S, N>) -> u32,
    ) -> u32 {
        let mut contact = [R::ZERO; S];
        for (side, channels) in self.channels.iter_mut().enumerate() {
            for (n, channel) in channels.iter_mut().enumerate() {
                let number = call + (side * N + n) as u32;
                let (said, strongest) = listen(channel, number, contact[side]);
                self.said = self.said.wrapping_add(said);
                contact[side] = strongest;
            }
        }
        whisk(&mut self.state, contact);
        let duties = follow(&mut self.channels, &self.state);
        self.said = self.said.wrapping_add(duties);
        self.said
    }
}

/// Moves the whiskers.
#[inline]
fn whisk<R: Format, const S: usize, const N: usize>(state: &mut State<R, S, N>, contact: [R; S]) {
    in_memory(R::WHISKING).step(state, contact);
}

/// Lets the motors follow; the sum of the duties.
#[inline]
fn follow<R: Format, const S: usize, const N: usize>(
    channels: &mut [[Channel<R>; N]; S],
    state: &State<R, S, N>,
) -> u32 {
    let mut said = 0_u32;
    for (channels, whiskers) in channels.iter_mut().zip(&state.whiskers) {
        for (channel, whisker) in channels.iter_mut().zip(whiskers) {
            channel.counts += 2;
            let duty =
                in_memory(R::PD).step(&mut channel.pd, whisker.muscle.theta, channel.counts, 2);
            said = said.wrapping_add(duty.magnitude().into());
        }
    }
    said
}
