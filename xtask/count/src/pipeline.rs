//! What a tick computes, without the hardware around it: for each whisker a
//! frame, two filtered channels, RCP, CIA, muscle, position control and a
//! classifier of nine classes; for each side an oscillator and a drive.

use heapless::Vec;
use mlx90333::Decoder;
use whisking::{MAX_SIDES, MAX_WHISKERS, Number, Real, State, filter, pd};

use crate::format::Parts;
use crate::listener::{Listener, open_9};
use crate::samples::frame;

/// One whisker's share: sensor, filters, motor and classifier.
#[derive(Debug)]
struct Channel<R: Real> {
    filters: [filter::State<R>; 2],
    pd: pd::State<R>,
    listener: Listener<2>,
    counts: i32,
}

impl<R: Real> Channel<R> {
    fn new() -> Self {
        Self {
            filters: Default::default(),
            pd: pd::State::default(),
            listener: Listener::new(open_9()),
            counts: 0,
        }
    }

    /// Takes the frame of a number in: what the classifier says, and the contact or
    /// `strongest`, whichever is more.
    #[inline]
    fn listen(&mut self, h50: &filter::Config<R>, number: u32, strongest: R) -> (u32, R) {
        let Ok(frame) = Decoder::new().decode(frame(number)) else {
            return (1 << 31, strongest);
        };
        let words = [frame.first(), frame.second()];
        let [x, y] = words.map(|word| R::from_code(word.signed14().max(-8191)));
        let [on_x, on_y] = &mut self.filters;
        let felt = [h50.process(on_x, x), h50.process(on_y, y)];
        let strongest = felt
            .into_iter()
            .fold(strongest, |most, one| one.abs().max(most));
        let codes = words.map(|word| i32::from(word.signed14()) + 8192);
        (self.listener.push(codes), strongest)
    }
}

/// The whiskers of a module.
#[derive(Debug)]
pub struct Pipeline<R: Real> {
    state: State<R>,
    channels: Vec<Channel<R>, MAX_WHISKERS>,
    /// Duties and decisions, so that nothing is computed in vain.
    said: u32,
}

impl<R: Number> Pipeline<R> {
    /// At its start.
    pub fn new(parts: &Parts<R>) -> Self {
        let state = State::new(&parts.motion.start, 1);
        Self {
            channels: state.whiskers.iter().map(|_| Channel::new()).collect(),
            state,
            said: 0,
        }
    }

    /// One tick; whisker n has frame `call` + n.
    #[inline]
    pub fn tick(&mut self, parts: &Parts<R>, call: u32) -> u32 {
        let mut contact = [R::ZERO; MAX_SIDES];
        let whiskers = self.channels.iter_mut().zip(&self.state.whiskers);
        for (n, (channel, whisker)) in whiskers.enumerate() {
            let Some(strongest) = contact.get_mut(usize::from(whisker.side)) else {
                continue;
            };
            let (said, contact) = channel.listen(&parts.h50, call + n as u32, *strongest);
            self.said = self.said.wrapping_add(said);
            *strongest = contact;
        }
        parts.motion.whisking.step(&mut self.state, &contact);
        for (channel, whisker) in self.channels.iter_mut().zip(&self.state.whiskers) {
            channel.counts += 2;
            let pd = &parts.motion.servo.pd;
            let duty = pd.step(&mut channel.pd, whisker.muscle.theta, channel.counts, 2);
            self.said = self.said.wrapping_add(duty.magnitude().into());
        }
        self.said
    }
}
