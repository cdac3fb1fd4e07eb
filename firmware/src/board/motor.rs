//! The motor that the scene names: its type, its constants and its pins.

use firmware::Active;
use firmware::design_parameters::{RETRY_S, stall, ticks};
use firmware::{ActiveConfig, Follower};
use stm32f4xx_hal::pac::{RCC, TIM1};
use whisking::motor::StallConfig;

use super::encoder::Encoder;
use super::{pwm, scene};

/// The moving part of the module: one whisker.
pub(crate) type Motion = Active<f32, Motor, Encoder, 1, 1>;

const STALL: StallConfig = stall(scene::TICK_HZ, scene::STALL_Q15);

/// Its constants.
pub(crate) const CONFIG: ActiveConfig<f32> = ActiveConfig {
    whisking: scene::WHISKING,
    pd: scene::PD,
    retry: ticks(RETRY_S, scene::TICK_HZ),
    stall: STALL,
};

/// The module's motion from its start, the whisker being at rest now.
pub(crate) fn motion(motor: Motor, encoder: Encoder) -> Motion {
    let state = whisking::State::new(&scene::START, scene::SEED);
    Active::new(state, [[Follower::new(motor, encoder, STALL)]])
}

#[cfg(motor = "h-bridge")]
mod driver {
    //! A brushed motor on an H-bridge: PWM on PA8, direction on PB5.

    use stm32f4xx_hal::gpio::{Output, PA8, PB5, PinState};
    use whisking::motor::HBridge;

    use super::{RCC, TIM1, pwm};

    /// The motor.
    pub(crate) type Motor = HBridge<pwm::Channel<0>, PB5<Output>>;

    /// The pins of the H-bridge.
    pub(crate) struct Pins {
        pub(crate) pwm: PA8,
        pub(crate) direction: PB5,
    }

    /// A motor that is off.
    pub(crate) fn start(timer: TIM1, pins: Pins, rcc: &mut RCC) -> Motor {
        let (pwm, _, _) = pwm::start(timer, rcc);
        let direction = pins.direction.into_push_pull_output_in_state(PinState::Low);
        let motor = HBridge::new(pwm, direction).with_buffered_pwm();
        pins.pwm.into_alternate::<1>();
        motor
    }
}

#[cfg(motor = "six-step")]
mod driver {
    //! A brushless motor on three half-bridges (L6230): inputs on PA8 to PA10,
    //! enables on PC10 to PC12, Hall sensors on PA15, PB3 and PB10.

    use stm32f4xx_hal::gpio::{
        Debugger, Input, Output, PA8, PA9, PA10, PA15, PB3, PB10, PC10, PC11, PC12, PinState,
    };
    use whisking::motor::{SixStep, SixStepConfig};

    use super::{RCC, STALL, TIM1, pwm};

    /// The motor.
    pub(crate) type Motor = SixStep<
        (pwm::Channel<0>, pwm::Channel<1>, pwm::Channel<2>),
        (PC10<Output>, PC11<Output>, PC12<Output>),
        (PA15<Input>, PB3<Input>, PB10<Input>),
    >;

    const CONFIG: SixStepConfig = SixStepConfig {
        stall: STALL,
        ..SixStepConfig::DEFAULT
    };

    /// The pins of the power stage and of the Hall sensors, phase 1 first.
    pub(crate) struct Pins {
        pub(crate) inputs: (PA8, PA9, PA10),
        pub(crate) enables: (PC10, PC11, PC12),
        pub(crate) halls: (PA15<Debugger>, PB3<Debugger>, PB10),
    }

    /// A motor that is off.
    pub(crate) fn start(timer: TIM1, pins: Pins, rcc: &mut RCC) -> Motor {
        let pwms = pwm::start(timer, rcc);
        let enables = (
            pins.enables.0.into_push_pull_output_in_state(PinState::Low),
            pins.enables.1.into_push_pull_output_in_state(PinState::Low),
            pins.enables.2.into_push_pull_output_in_state(PinState::Low),
        );
        let halls = (
            pins.halls.0.into_pull_up_input(),
            pins.halls.1.into_pull_up_input(),
            pins.halls.2.into_pull_up_input(),
        );
        let motor = SixStep::new(pwms, enables, halls, CONFIG).with_buffered_pwm();
        pins.inputs.0.into_alternate::<1>();
        pins.inputs.1.into_alternate::<1>();
        pins.inputs.2.into_alternate::<1>();
        motor
    }
}

pub(crate) use driver::{Motor, Pins, start};
