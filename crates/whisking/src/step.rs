//! One tick of a whole module: RCP and the oscillator of each side, then CIA
//! and the muscle of each whisker.

use serde::{Deserialize, Serialize};

use crate::{Fix, MAX_OWN, MAX_SIDES, Real, State, WhiskerState, gate, muscle, noise, oscillator};

/// Constants of the pattern generator in number format `R`; they step a [`State`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Config<R: Real> {
    /// The oscillators' integrator.
    pub oscillators: oscillator::Config<R>,
    /// The muscles' integrator.
    pub muscle: muscle::Config<R>,
    /// 1.45, the peak of the muscle gain (eq. 8).
    pub peak_gain: R,
    /// RCP, if the module has it.
    pub rcp: Option<gate::Rcp<R>>,
    /// CIA, if the module has it.
    pub cia: Option<gate::Cia<R>>,
    /// Noise, if the module has it.
    pub noise: Option<noise::Config<R>>,
}

/// A number format for which the pattern generator is compiled in this crate: so a board's
/// program, whose own code is compiled for size, has it compiled for speed.
pub trait Number: Real {
    /// [`Config::step`].
    fn step(config: &Config<Self>, state: &mut State<Self>, contact: &[Self]);
}

macro_rules! number {
    ($($number:ty),*) => {
        $(impl Number for $number {
            #[inline(never)]
            fn step(config: &Config<Self>, state: &mut State<Self>, contact: &[Self]) {
                config.tick(state, contact);
            }
        })*
    };
}
number!(f32, f64, Fix);

/// What a side does to its whiskers in a tick. The default is that of no side: a whisker
/// without a side rests.
#[derive(Clone, Copy, Default)]
struct Push<R> {
    /// Drive W at the two ends of the tick.
    before: R,
    after: R,
    /// 1.45 (1 − z).
    open: R,
}

impl<R: Real> Config<R> {
    /// RCP, if the module has it and the program can compute it; alike the others.
    #[inline]
    fn rcp(&self) -> Option<&gate::Rcp<R>> {
        self.rcp.as_ref().filter(|_| cfg!(feature = "rcp"))
    }

    #[inline]
    fn cia(&self) -> Option<&gate::Cia<R>> {
        self.cia.as_ref().filter(|_| cfg!(feature = "cia"))
    }

    #[inline]
    fn noise(&self) -> Option<&noise::Config<R>> {
        self.noise.as_ref().filter(|_| cfg!(feature = "noise"))
    }

    /// One tick. `contact` is π of each side (eq. 9), left first, measured at the angle before this
    /// tick; a missing one is zero. The muscles move with the z and g that follow from it.
    ///
    /// For any contact, NaN included, the state stays finite and within its bounds: |ψ| ≤ 1.5,
    /// 0 ≤ z ≤ 1, 0 ≤ g ≤ 2, |θ| ≤ 2.5. Whatever bits its numbers have, a tick leads within them;
    /// seven whisks after a word was spoilt all is as before. Only sides that are left quite opposed
    /// stay so until noise parts them, as the equations say. How many sides and whiskers there are,
    /// and whose whisker is whose, is part of a state's shape: it is taken as it stands.
    #[inline]
    pub fn step(&self, state: &mut State<R>, contact: &[R])
    where
        R: Number,
    {
        R::step(self, state, contact);
    }

    /// The same, compiled where it is used.
    #[inline]
    fn tick(&self, state: &mut State<R>, contact: &[R]) {
        let mut zeta = R::ZERO;
        for (n, side) in state.sides.iter_mut().enumerate() {
            let pi = contact.get(n).copied().unwrap_or(R::ZERO);
            if let Some(rcp) = self.rcp() {
                rcp.step(&mut side.z, pi);
            }
            zeta = pi.max(zeta);
        }

        let mut drawn = [[R::ZERO; 2]; MAX_SIDES];
        let noise = self.noise().map(|noise| {
            noise.step(&mut state.noise, &mut drawn);
            &drawn[..]
        });
        self.oscillators.step(&mut state.oscillators, noise);

        let drives = self.oscillators.drives(&state.oscillators);
        let mut pushes = [Push::default(); MAX_SIDES];
        for ((side, drive), push) in state.sides.iter_mut().zip(&drives).zip(&mut pushes) {
            let after = muscle::drive(*drive);
            // Gates that no part of the module moves are not looked at.
            let z = match self.rcp() {
                Some(_) => side.z.mean,
                None => R::ZERO,
            };
            *push = Push {
                before: side.drive,
                after,
                open: self.peak_gain * (R::ONE - z),
            };
            side.drive = after;
        }
        // So that a number of whiskers whose bits were flipped leads nowhere else.
        for whisker in state.whiskers.iter_mut().take(MAX_OWN) {
            let push = pushes.get(usize::from(whisker.side));
            self.move_whisker(whisker, push.unwrap_or(&Push::default()), zeta);
        }
    }

    // Apart: in the loop all its constants are loaded ahead, for which there are not
    // registers enough.
    #[inline(never)]
    fn move_whisker(&self, whisker: &mut WhiskerState<R>, push: &Push<R>, zeta: R) {
        let nominal = whisker.nominal();
        let mut gain = nominal;
        if let Some(cia) = self.cia() {
            cia.step(&mut whisker.lift, nominal, zeta);
            gain = nominal + whisker.lift.mean;
        }
        let gain = push.open * gain;
        let Push { before, after, .. } = *push;
        self.muscle.step(&mut whisker.muscle, gain, before, after);
    }
}
