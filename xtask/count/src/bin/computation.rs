//! All that a tick computes, without the hardware around it: for each whisker a
//! frame, two filtered channels, RCP, CIA, muscle, position control and a
//! classifier of nine classes; for each side an oscillator and a drive.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::classifier::{classifier, push};
use count::module::Module;
use count::samples::frame;
use count::{kernel, model};
use heapless::Vec;
use mlx90333::Decoder;
use tactile::Sequential;
use whisking::{Fix, Integrator, MAX_OWN, MAX_SIDES, Number, Real, State, filter, pd};

count::program!(computation);

fn computation() {
    each::<f32>("f32");
    each::<Fix>("fix");
}

#[inline(never)]
fn each<R: Number>(format: &str) {
    let (name, sides, whiskers) = if cfg!(feature = "array") {
        ("computation of 2 whiskers", 2, 1)
    } else {
        ("computation of 1 whisker", 1, 1)
    };
    let module = Module::new(Integrator::Exact, sides, whiskers);
    kernel!([R] format, name,
        (call: u32, (module, pipeline): &mut (&Module<R>, Pipeline<R>)) -> u32 {
            pipeline.tick(module, call)
        },
        |call| call, (&module, Pipeline::new(&module)));
}

/// One whisker's share: sensor, filters, motor and classifier.
#[derive(Debug)]
struct Channel<R: Real> {
    filters: [filter::State<R>; 2],
    pd: pd::State<R>,
    classifier: Sequential,
    counts: i32,
}

impl<R: Real> Channel<R> {
    fn new() -> Self {
        Self {
            filters: Default::default(),
            pd: pd::State::default(),
            classifier: classifier(model!("open9")),
            counts: 0,
        }
    }

    /// Takes the frame of a number in: what the classifier says, and the contact or
    /// `strongest`, whichever is more.
    #[inline]
    fn sense(&mut self, h50: &filter::Config<R>, number: u32, strongest: R) -> (u32, R) {
        let Ok(frame) = Decoder::new().decode(frame(number)) else {
            return (1 << 31, strongest);
        };
        let words = [frame.first, frame.second];
        let [x, y] = words.map(|word| R::from_code(word.signed14().max(-8191)));
        let [on_x, on_y] = &mut self.filters;
        let felt = [h50.process(on_x, x), h50.process(on_y, y)];
        let strongest = felt
            .into_iter()
            .fold(strongest, |most, one| one.abs().max(most));
        let codes = words.map(|word| i32::from(word.signed14()) + 8192);
        (push(&mut self.classifier, codes), strongest)
    }
}

#[derive(Debug)]
struct Pipeline<R: Real> {
    state: State<R>,
    channels: Vec<Channel<R>, MAX_OWN>,
    /// Duties and decisions, so that nothing is computed in vain.
    said: u32,
}

impl<R: Number> Pipeline<R> {
    fn new(module: &Module<R>) -> Self {
        let state = State::new(&module.start, 1);
        Self {
            channels: state.whiskers.iter().map(|_| Channel::new()).collect(),
            state,
            said: 0,
        }
    }

    /// One tick; whisker n has frame `call` + n.
    #[inline]
    fn tick(&mut self, module: &Module<R>, call: u32) -> u32 {
        let mut contact = [R::ZERO; MAX_SIDES];
        let whiskers = self.channels.iter_mut().zip(&self.state.whiskers);
        for (n, (channel, whisker)) in whiskers.enumerate() {
            let Some(strongest) = contact.get_mut(usize::from(whisker.side)) else {
                continue;
            };
            let (said, contact) = channel.sense(&module.h50, call + n as u32, *strongest);
            self.said = self.said.wrapping_add(said);
            *strongest = contact;
        }
        module.whisking.step(&mut self.state, &contact);
        for (channel, whisker) in self.channels.iter_mut().zip(&self.state.whiskers) {
            channel.counts += 2;
            let pd = &module.pd;
            let duty = pd.step(&mut channel.pd, whisker.muscle.theta, channel.counts, 2);
            self.said = self.said.wrapping_add(duty.magnitude().into());
        }
        self.said
    }
}
