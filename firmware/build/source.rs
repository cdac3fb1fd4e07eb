//! The scene as Rust source: the types and settings of `src/board/scene.rs`.

use std::error::Error;

use databake::{Bake, CrateEnv, TokenStream, quote};
use scene::{Arm, Driver, Scene, SensorMode, Sides};
use tactile::{Model, ModelBuf};
use whisking::{Real, Source, Start};

use crate::part::{Part, nothing};
use crate::perception::perception;

/// Writes the source in number format `R`, which the firmware calls `number`.
/// `model` is the classifier's.
///
/// # Errors
/// What is wrong with the scene.
pub(crate) fn source<R: Real>(
    scene: &Scene,
    model: Option<&ModelBuf>,
    number: &TokenStream,
) -> Result<String, Box<dyn Error>> {
    let (name, tick_hz) = (&scene.name, scene.tick_hz);
    let (frozen_s, jump_per_s) = (scene.sensor.frozen_s, scene.sensor.jump_per_s);
    let sensors_are_slow = scene.sensor.mode == SensorMode::Slow;
    let (words, zero) = words(scene);
    let telemetry = &scene.telemetry;
    let (has_serial, has_pins) = (telemetry.serial_baud.is_some(), telemetry.pins);
    let serial_baud = telemetry.serial_baud.unwrap_or(0);
    let touch = model.and_then(Model::touch_rule);
    let contact_min = plan::contact_min(scene, touch.map(|touch| touch.gate))?;
    let contact = Source::optional(
        plan::contact::<R>(scene, contact_min.is_some())?.as_ref(),
        &quote! { whisking::filter::Config<Number> },
        &CrateEnv::default(),
    );
    let (sides, motion) = match scene.head.sides {
        Sides::Left => (quote! { LEFT }, motion::<R, 1>(scene)?),
        Sides::Both => (quote! { LEFT, &crate::here::RIGHT }, motion::<R, 2>(scene)?),
    };
    let count = scene.head.sides.count();
    let perception = perception::<R>(scene, model, contact_min);

    let (contact_type, contact_value) = (contact.of_type, contact.value);
    let (motion_type, motion_value) = (motion.config.of_type, motion.config.value);
    let (perception_type, perception_value) = (perception.config.of_type, perception.config.value);
    let items = [
        quote! { pub(crate) const NAME: &str = #name; },
        quote! { pub(crate) const TICK_HZ: u32 = #tick_hz; },
        quote! { pub(crate) const HAS_SERIAL: bool = #has_serial; },
        quote! { pub(crate) const SERIAL_BAUD: u32 = #serial_baud; },
        quote! { pub(crate) const HAS_PINS: bool = #has_pins; },
        quote! { pub(crate) const SENSORS_ARE_SLOW: bool = #sensors_are_slow; },
        quote! {
            pub(crate) const SIDES: [&super::wiring::Side; #count] = [&crate::here::#sides];
        },
        quote! { pub(crate) type Number = #number; },
        words,
        quote! {
            pub(crate) type Settings =
                firmware::Config<#motion_type, #perception_type, #contact_type>;
        },
        quote! {
            pub(crate) const SETTINGS: Settings = firmware::Config {
                decoder: mlx90333::Decoder::new(),
                sensor_limits: firmware::SensorLimits {
                    zero: #zero,
                    ..firmware::design_parameters::sensor_limits(
                        TICK_HZ,
                        firmware::design_parameters::Plausible {
                            frozen_s: #frozen_s,
                            jump_per_s: #jump_per_s,
                        },
                    )
                },
                contact: #contact_value,
                motion: #motion_value,
                perception: #perception_value,
                period: crate::here::CLOCKS.tick_counts(TICK_HZ),
            };
        },
    ];
    let items = items
        .into_iter()
        .chain(motion.items)
        .chain(perception.items);
    let lines: Vec<String> = items.map(|item| item.to_string()).collect();
    Ok(lines.join("\n"))
}

/// The pattern generator and the position control.
fn motion<R: Real, const S: usize>(scene: &Scene) -> Result<Part, Box<dyn Error>>
where
    Start<R, S, 1>: Bake,
{
    let (Some(motor), Some(plan)) = (&scene.motor, plan::motion::<R, S, 1>(scene)?) else {
        let items = vec![
            quote! { pub(crate) const HAS_MOTOR: bool = false; },
            quote! { pub(crate) const ARMS_AT_START: bool = false; },
            quote! { pub(crate) type Motion = firmware::Passive; },
            quote! {
                pub(crate) fn start_motion() -> Motion {
                    firmware::Passive
                }
            },
        ];
        let config = nothing();
        return Ok(Part { items, config });
    };
    let arms_at_start = motor.arm == Arm::AtStart;
    let (motor, start_motor) = match motor.driver {
        Driver::HBridge => (quote! { Brushed }, quote! { super::motors::start_brushed }),
        Driver::SixStep => (
            quote! { Brushless },
            quote! { |_| super::motors::start_brushless(SETTINGS.motion.servo.guards.stall) },
        ),
    };
    let env = CrateEnv::default();
    let whisking = plan.whisking.source(&quote! { Number }, &env);
    let (generator, whisking) = (whisking.of_type, whisking.value);
    let (pd, start) = (plan.pd.bake(&env), plan.start.bake(&env));
    let (guards, seed) = (plan.guards.bake(&env), scene.seed);
    let (stop_all_type, stop_all) = if plan.stop_all {
        let stop_all = quote! { firmware::StopAll };
        (
            quote! { whisking::Present<#stop_all> },
            quote! { whisking::Present(#stop_all) },
        )
    } else {
        (quote! { whisking::Absent }, quote! { whisking::Absent })
    };
    let approach = plan.approach.bake(&env);
    let homing = Source::optional(
        plan.homing.as_ref(),
        &quote! { whisking::motor::HomingConfig },
        &env,
    );
    let (homing_type, homing) = (homing.of_type, homing.value);
    let items = vec![
        quote! { pub(crate) const HAS_MOTOR: bool = true; },
        quote! { pub(crate) const ARMS_AT_START: bool = #arms_at_start; },
        quote! {
            pub(crate) type Motion = firmware::Active<
                Number, super::motors::#motor, super::encoder::Encoder, #S, 1
            >;
        },
        quote! { const START: whisking::Start<Number, #S, 1> = #start; },
        quote! {
            pub(crate) fn start_motion() -> Motion {
                super::motion::start(SIDES, #start_motor, &START, #seed)
            }
        },
    ];
    let config = Source {
        of_type: quote! { firmware::ActiveConfig<Number, #generator, #stop_all_type, #homing_type> },
        value: quote! {
            firmware::ActiveConfig {
                whisking: #whisking,
                servo: firmware::ServoConfig {
                    pd: #pd,
                    retry: firmware::design_parameters::retry(TICK_HZ),
                    guards: #guards,
                    approach: #approach,
                    homing: #homing,
                },
                stop_all: #stop_all,
            }
        },
    };
    Ok(Part { items, config })
}

/// Where words come from, and when their zero is found anew.
fn words(scene: &Scene) -> (TokenStream, TokenStream) {
    let sensor = &scene.sensor;
    let Some(after_s) = sensor.zero_after_s else {
        let words = quote! {
            pub(crate) const FINDS_ZERO: bool = false;
            pub(crate) type Source = super::sensor::Frames;
            pub(crate) fn source(frames: super::sensor::Frames) -> Source {
                frames
            }
            pub(crate) fn frames(source: &mut Source) -> &mut super::sensor::Frames {
                source
            }
        };
        return (words, quote! { firmware::ZeroLimits::NONE });
    };
    let (calm, most) = (sensor.zero_calm, sensor.zero_most);
    let words = quote! {
        pub(crate) const FINDS_ZERO: bool = true;
        pub(crate) type Source = firmware::Zeroed<super::sensor::Frames>;
        pub(crate) fn source(frames: super::sensor::Frames) -> Source {
            firmware::Zeroed::new(frames)
        }
        pub(crate) fn frames(source: &mut Source) -> &mut super::sensor::Frames {
            source.source_mut()
        }
    };
    let zero = quote! {
        firmware::design_parameters::zero_limits(TICK_HZ, #after_s, #calm, #most)
    };
    (words, zero)
}
