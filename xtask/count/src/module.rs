//! What moves of a module, in a number format: 2 kHz, 2 whisks a second, sides coupled, RCP and
//! CIA.

use core::hint::black_box;

use whisking::{Config, GateSettings, Integrator, Real, Settings, Start, filter, pd};

/// Ticks a second: BIOTACT's.
const TICK_HZ: f64 = 2000.0;

/// The constants of a module's kernels.
#[derive(Debug)]
pub struct Module<R: Real> {
    /// The contact filter.
    pub h50: filter::Config<R>,
    /// The pattern generator.
    pub whisking: Config<R>,
    /// Where that starts.
    pub start: Start<R>,
    /// Position control.
    pub pd: pd::Config<R>,
}

impl<R: Real> Module<R> {
    /// So many sides with so many whiskers each.
    ///
    /// # Panics
    /// If a constant below is out of its range.
    pub fn new(integrator: Integrator, sides: usize, whiskers: usize) -> Self {
        // As a board, which reads its settings, the compiler does not know them.
        let settings = black_box(settings(integrator));
        let psi = [[0.6, -0.8], [0.0, -1.0]];
        let gains = [1.0; 12];
        let gains = [&gains[..whiskers]; 2];
        Self {
            h50: filter::Config::new(filter::CORNER_HZ, black_box(TICK_HZ)).expect("a corner"),
            whisking: settings.build().expect("settings in range"),
            start: settings
                .start(&psi[..sides], &gains[..sides])
                .expect("a start in range"),
            pd: black_box(PD).build(TICK_HZ).expect("gains in range"),
        }
    }
}

fn settings(integrator: Integrator) -> Settings {
    let gate = |gain| GateSettings { gain, tau_s: 0.125 };
    Settings {
        tick_hz: TICK_HZ,
        frequency_hz: 2.0,
        integrator,
        coupling: true,
        noise: 0.0,
        rcp: Some(gate(0.7)),
        cia: Some(gate(0.5)),
    }
}

const PD: pd::Settings = pd::Settings {
    kp: 0.05,
    kd: 0.001,
    limit: 0.8,
    slew_per_s: 400.0,
    min_deg: 30.0,
    max_deg: 160.0,
    // BIOTACT's motor: 512 counts a turn, a gear of 11.
    degrees_per_count: 360.0 / (512.0 * 11.0),
};
