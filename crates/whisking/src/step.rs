//! One tick of a whole module: RCP and the oscillator of each side, then CIA
//! and the muscle of each whisker.

use crate::muscle::{self, MuscleIntegrator};
use crate::oscillator::{self, OscillatorIntegrator};
use crate::{Optional, Real, State, gate, noise};

/// Constants of the tick in number format `R`.
///
/// The parts are types. A board names concrete ones, such as
/// [`oscillator::Exact`], [`Present`](crate::Present) and
/// [`Absent`](crate::Absent), so that its program contains their code alone. The
/// defaults are chosen at run time, for simulations of any scene.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "bake", derive(databake::Bake), databake(path = whisking))]
pub struct Config<
    R: Real,
    Oscillators = oscillator::Config<R>,
    Muscle = muscle::Config<R>,
    Rcp = Option<gate::Rcp<R>>,
    Cia = Option<gate::Cia<R>>,
    Noise = Option<noise::Config<R>>,
> {
    /// The oscillators' integrator.
    pub oscillators: Oscillators,
    /// The muscles' integrator.
    pub muscle: Muscle,
    /// 1.45, the peak of the muscle gain (eq. 8).
    pub peak_gain: R,
    /// RCP, if the module has it.
    pub rcp: Rcp,
    /// CIA, if the module has it.
    pub cia: Cia,
    /// Noise, if the module has it.
    pub noise: Noise,
}

/// The pattern generator of a module; it steps a [`State`].
pub trait PatternGenerator<R: Real> {
    /// One tick. `contact` is π of each side (eq. 9), measured at the angle before
    /// this tick; the muscles move with the z and g that follow from it.
    ///
    /// For any contact, NaN included, the state stays finite and within its
    /// bounds: |ψ| ≤ 1.5, 0 ≤ z ≤ 1, 0 ≤ g ≤ 2, |θ| ≤ 2.5. Whatever bits a state has, a
    /// tick leads within them; seven whisks after a word was spoilt all is as before. Only
    /// sides that are left quite opposed stay so until noise parts them, as the equations say.
    fn step<const S: usize, const N: usize>(&self, state: &mut State<R, S, N>, contact: [R; S]);
}

impl<R, Oscillators, Muscle, Rcp, Cia, Noise> PatternGenerator<R>
    for Config<R, Oscillators, Muscle, Rcp, Cia, Noise>
where
    R: Real,
    Oscillators: OscillatorIntegrator<R>,
    Muscle: MuscleIntegrator<R>,
    Rcp: Optional<gate::Rcp<R>>,
    Cia: Optional<gate::Cia<R>>,
    Noise: Optional<noise::Config<R>>,
{
    #[inline]
    fn step<const S: usize, const N: usize>(&self, state: &mut State<R, S, N>, contact: [R; S]) {
        if let Some(rcp) = self.rcp.part() {
            for (z, pi) in state.z.iter_mut().zip(contact) {
                rcp.step(z, pi);
            }
        }
        let zeta = contact.into_iter().fold(R::ZERO, |zeta, pi| pi.max(zeta));

        let noise = self.noise.part().map(|noise| noise.step(&mut state.noise));
        self.oscillators
            .step(&mut state.oscillators, noise.as_ref());

        let drives = self.oscillators.drives(&state.oscillators);
        for (side, whiskers) in state.whiskers.iter_mut().enumerate() {
            let before = state.drive[side];
            let after = muscle::drive(drives[side]);
            // Gates that no part of the module moves are not looked at.
            let z = match self.rcp.part() {
                Some(_) => state.z[side].mean,
                None => R::ZERO,
            };
            let open = self.peak_gain * (R::ONE - z);
            for whisker in whiskers {
                let nominal = whisker.nominal();
                let mut gain = nominal;
                if let Some(cia) = self.cia.part() {
                    cia.step(&mut whisker.lift, nominal, zeta);
                    gain = nominal + whisker.lift.mean;
                }
                let gain = open * gain;
                self.muscle.step(&mut whisker.muscle, gain, before, after);
            }
            state.drive[side] = after;
        }
    }
}
