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

    const fn value(&self) -> u64 {
        self.0
    }
}

const TICKS: usize = 2_000;
const PSI: [[f64; 2]; 2] = [[1.4, 0.2], [-0.3, 0.9]];
/// Euler and Exact; f32, f64 and fixed point; one side with one whisker and with three, two
/// sides with one and with three each.
const EXPECTED: [[[u64; 4]; 3]; 2] = [
    [
        [
            0xF001_0E20_8249_9F5E,
            0xDD5E_0450_F013_83BD,
            0x7F5A_8FFC_E33F_C261,
            0x0AAD_20DC_A9F2_915E,
        ],
        [
            0xC432_D84C_8590_C469,
            0xB3F4_ABB0_8847_CD3F,
            0x42D1_F8C1_DD4B_CECD,
            0x72F7_9364_5A9D_116F,
        ],
        [
            0x5160_DEFB_ECD3_F364,
            0xD1F1_A5B5_413C_BA95,
            0x4C73_3C03_F762_C693,
            0x641D_F172_E8AA_0635,
        ],
    ],
    [
        [
            0xD822_291C_6A53_E41B,
            0xAE4D_8ED6_172C_384D,
            0xB554_19DE_1D9E_F11D,
            0x266E_8154_6182_E01C,
        ],
        [
            0xC2FF_442A_A2F4_DDF1,
            0xA75F_88F1_BA26_2951,
            0xB9CA_E9EB_2599_E515,
            0xA27B_E774_1EF4_D868,
        ],
        [
            0x471E_1155_6600_FE3E,
            0x8292_CD6A_D687_FED3,
            0x6364_E804_F028_2E06,
            0x6A7E_5DD8_B1BD_299C,
        ],
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

/// Of one side and of two, with one whisker and with three.
fn prints<R: Number>(integrator: Integrator) -> [u64; 4] {
    let mut prints = [const { Fingerprint::new() }; 4];
    for parts in 0..8 {
        let settings = settings(integrator, parts);
        let [a, b, c, d] = &mut prints;
        let [left, right] = GAINS.each_ref().map(<[f64; 3]>::as_slice);
        run::<R>(a, &settings, &[&left[..1]]);
        run::<R>(b, &settings, &[left]);
        run::<R>(c, &settings, &[&left[..1], &right[..1]]);
        run::<R>(d, &settings, &[left, right]);
    }
    prints.map(|print| print.value())
}

#[test]
fn the_same_bits_as_ever() {
    let found = [Integrator::Euler, Integrator::Exact].map(|integrator| {
        [
            prints::<f32>(integrator),
            prints::<f64>(integrator),
            prints::<Fix>(integrator),
        ]
    });
    assert_eq!(found, EXPECTED, "{found:#X?}");
}
