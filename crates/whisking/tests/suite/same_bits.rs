//! The same bits as ever: fingerprints of whole runs, in every number format, with one side
//! and with two.
//!
//! A change that only moves code must not move a last bit. Whoever changes an equation, a
//! constant or the order of operations on purpose puts the new fingerprints here.

use whisking::{Fix, GateSettings, Integrator, Number, Settings, State};

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits).
struct Fingerprint(u64);

impl Fingerprint {
    const fn new() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }

    fn add_bytes(&mut self, bytes: impl IntoIterator<Item = u8>) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }

    fn add(&mut self, number: f64) {
        self.add_bytes(number.to_bits().to_le_bytes());
    }
}

const TICKS: usize = 2_000;
const PSI: [[f64; 2]; 2] = [[1.4, 0.2], [-0.3, 0.9]];
/// Euler and Exact; f32, f64 and fixed point.
const EXPECTED: [[u64; 3]; 2] = [
    [
        0xD0EA_9B9B_EB35_3D41,
        0x878F_10D9_42FF_0E51,
        0x70BA_E50A_50F1_5E16,
    ],
    [
        0xC78D_6BD4_58C4_3DD2,
        0x050F_9960_4553_2288,
        0x1C39_DAD0_D5BA_E2BA,
    ],
];
const GAINS: [[f64; 3]; 2] = [[1.0, 0.7, 1.9], [0.4, 1.2, 0.0]];

/// Contact of a side: it rises, ends at once, and comes back, at another time on each side.
fn contact<R: Number>(tick: usize, side: usize) -> R {
    let phase = (tick + 170 * side) % 400;
    R::from_f64(if phase < 60 { phase as f64 / 50.0 } else { 0.0 })
}

/// One module: each of the three parts, and coupling, is there or not as `parts` says.
fn settings(integrator: Integrator, parts: u32) -> Settings {
    let gate = |part: u32, gain, tau_s| {
        let gate = GateSettings { gain, tau_s };
        (parts >> part & 1 == 1).then_some(gate)
    };
    Settings {
        tick_hz: 2_000.0,
        frequency_hz: if parts & 4 == 0 { 8.0 } else { 21.0 },
        integrator,
        coupling: parts & 3 != 2,
        noise: if parts & 4 == 0 { 0.0 } else { 0.9 },
        rcp: gate(0, 0.7, 0.05),
        cia: gate(1, 0.5, 0.3),
    }
}

fn run<R: Number>(print: &mut Fingerprint, settings: &Settings, gains: &[&[f64]]) {
    let config = settings.build::<R>().unwrap();
    let start = settings.start::<R>(&PSI[..gains.len()], gains).unwrap();
    let mut add = |numbers: &[R]| numbers.iter().for_each(|x| print.add(x.to_f64()));
    for side in &start.sides {
        add(&side.oscillator);
        add(&[side.drive]);
    }
    for whisker in &start.whiskers {
        add(&[whisker.gain]);
        add(&whisker.history.force);
    }
    let mut state = State::new(&start, 17);
    for tick in 0..TICKS {
        if tick == 700 {
            let last = state.whiskers.iter_mut().rev();
            let last = last.take(gains[gains.len() - 1].len()).last().unwrap();
            last.set_nominal(R::from_f64(1.6));
        }
        config.step(&mut state, &[0, 1].map(|side| contact(tick, side)));
        let psi = config.oscillators.psi(&state.oscillators);
        for (side, psi) in state.sides.iter().zip(psi) {
            add(&[side.z.value, side.z.mean]);
            add(&psi);
        }
        state.theta().for_each(|theta| add(&[theta]));
        for whisker in &state.whiskers {
            add(&[whisker.lift.value, whisker.lift.mean]);
            add(&whisker.muscle.kept());
        }
    }
}

/// Of one side with one whisker and with three, of two sides with one and with three each.
fn print<R: Number>(integrator: Integrator) -> u64 {
    let mut print = Fingerprint::new();
    for parts in 0..8 {
        let settings = settings(integrator, parts);
        let [left, right] = GAINS.each_ref().map(<[f64; 3]>::as_slice);
        for gains in [
            &[&left[..1]][..],
            &[left],
            &[&left[..1], &right[..1]],
            &[left, right],
        ] {
            run::<R>(&mut print, &settings, gains);
        }
    }
    print.0
}

#[test]
fn the_same_bits_as_ever() {
    let found = [Integrator::Euler, Integrator::Exact].map(|integrator| {
        [
            print::<f32>(integrator),
            print::<f64>(integrator),
            print::<Fix>(integrator),
        ]
    });
    assert_eq!(found, EXPECTED, "{found:#X?}");
}
