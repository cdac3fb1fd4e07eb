//! One tick of a whole module: RCP and oscillators by sides, then CIA and
//! muscles by whiskers.

use crate::gate::{self, Gate};
use crate::muscle::{self, MuscleIntegrator};
use crate::oscillator::{self, OscillatorIntegrator};
use crate::{Optional, Real, Start, noise};

/// Constants of the tick in number format `R`.
///
/// The parts are types. A board names concrete ones, such as
/// [`oscillator::Exact`], [`Present`](crate::Present) and
/// [`Absent`](crate::Absent), so that its program has the code of those alone;
/// the defaults are chosen at run time, for simulations of any scene.
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

/// The pattern generator of a module: what steps its [`State`].
pub trait PatternGenerator<R: Real> {
    /// One tick. `contact` is π of each side (eq. 9), from the angle before
    /// this tick: a muscle moves with the z and g that follow it.
    ///
    /// Whatever comes in, NaN included, the state stays finite and in its
    /// bounds: |ψ| ≤ 1.5, 0 ≤ z ≤ 1, 0 ≤ g ≤ 2, |θ| ≤ 2.5.
    fn step<const S: usize, const N: usize>(&self, state: &mut State<R, S, N>, contact: [R; S]);
}

/// One whisker: its muscle and its gain g.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whisker<R: Real> {
    /// θ, v and the integrator's past.
    pub muscle: muscle::State<R>,
    /// By how much contact lifts g above its nominal value (eqs. 12 and 13).
    pub lift: Gate<R>,
    /// Nominal value of g.
    pub nominal: R,
}

/// State of a module of `S` sides (1 or 2) with `N` whiskers each.
#[derive(Debug, Clone)]
pub struct State<R: Real, const S: usize, const N: usize> {
    /// The oscillator of each side.
    pub oscillators: oscillator::State<R, S>,
    /// z of each side (eq. 10), 0 to 1.
    pub z: [Gate<R>; S],
    /// The whiskers of each side.
    pub whiskers: [[Whisker<R>; N]; S],
    drive: [R; S],
    noise: noise::State<R, S>,
}

impl<R: Real> Whisker<R> {
    /// g of eqs. 12 and 13, 0 to 2.
    pub fn gain(&self) -> f64 {
        self.nominal.to_f64() + self.lift.value.to_f64()
    }
}

impl<R: Real, const S: usize, const N: usize> State<R, S, N> {
    /// A module at its start; `seed` is that of the noise.
    pub fn new(start: &Start<R, S, N>, seed: u64) -> Self {
        let muscles = start.whiskers();
        Self {
            oscillators: oscillator::State::new(start.oscillators),
            z: [Gate::default(); S],
            whiskers: core::array::from_fn(|side| {
                core::array::from_fn(|w| Whisker {
                    muscle: muscles[side][w],
                    lift: Gate::default(),
                    nominal: start.gain[side][w],
                })
            }),
            drive: start.drive,
            noise: noise::State::new(seed),
        }
    }

    /// Protraction θ of every whisker; θ' = 100 θ + 50 degrees.
    pub fn theta(&self) -> [[R; N]; S] {
        self.whiskers
            .each_ref()
            .map(|side| side.each_ref().map(|whisker| whisker.muscle.theta))
    }
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
        // No comparison with zero where there is one side.
        let stronger = contact.into_iter().reduce(|zeta, pi| pi.max(zeta));
        let zeta = stronger.unwrap_or(R::ZERO);

        let noise = self.noise.part().map(|noise| noise.step(&mut state.noise));
        self.oscillators
            .step(&mut state.oscillators, noise.as_ref());

        let drives = self.oscillators.drives(&state.oscillators);
        for (side, whiskers) in state.whiskers.iter_mut().enumerate() {
            let before = state.drive[side];
            let after = drives[side].drive();
            let open = self.peak_gain * (R::ONE - state.z[side].mean);
            for whisker in whiskers {
                if let Some(cia) = self.cia.part() {
                    cia.step(&mut whisker.lift, whisker.nominal, zeta);
                }
                let gain = open * (whisker.nominal + whisker.lift.mean);
                self.muscle.step(&mut whisker.muscle, gain, before, after);
            }
            state.drive[side] = after;
        }
    }
}
