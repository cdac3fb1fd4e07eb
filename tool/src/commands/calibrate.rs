//! `whisker calibrate`: what a whisker's sensor, motor and range are, step by step.

mod results;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use firmware::allowed;
use host_sim::output::Output;
use host_sim::plot::Ink;
use host_sim::{Error, report};
use scene::MotorSection;

use super::order::SideName;
use super::tuning::Which;
use crate::calibrate::{
    ANGLE, HALF_RANGE, Listening, MIDDLE, Panel, Push, Zero, at_rest, identify, is_at_end, lead,
    picture, push, steps, suggest,
};
use crate::interrupt;
use crate::quoted::quoted;
use crate::resting::rest;
use crate::sample::Sample;
use crate::tuning::{Tuner, named};
use results::Results;

/// Which whisker, and where the results go.
#[derive(Debug, Args)]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct Arguments {
    #[command(flatten)]
    which: Which,
    /// The side whose whisker it is
    #[arg(long, value_enum, default_value = "left")]
    side: SideName,
    /// The folder for calibration.toml, steps.csv, steps.svg and steps.png
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// How long the sensor is listened to at rest, and while it whisks, s.
const REST_S: f64 = 2.0;
const WHISK_S: f64 = 2.0;
/// The duty of gentle moves, as a multiple of that by which a stop is looked for: the least that
/// a scene allows as its limit.
const GENTLE: f64 = 2.0;
/// A zero further from the middle of the range takes range away on one side.
const FAR: f64 = 0.05;

/// Does all steps; the motors are off at the end, however it ends.
pub(crate) fn calibrate(arguments: &Arguments) -> Result<(), Error> {
    let tuner = arguments.which.tuner()?;
    let Some(motor) = &tuner.scene().motor else {
        let fault = "its scene has no motor; calibrate moves the whisker by it";
        return Err(Error::Input(fault.to_owned()));
    };
    arguments.which.source.sends_all()?;
    let file = |name: &str| Output::create(&arguments.out.join(name));
    let (toml, csv) = (file("calibration.toml")?, file("steps.csv")?);
    let (svg, png) = (file("steps.svg")?, file("steps.png")?);
    let side = arguments.side.number();
    let mut module = arguments.which.source.module()?;
    module.source().has_motors().map_err(Error::Input)?;
    interrupt::heed()?;
    let mut whisker = Listening::new(&mut module, side)?;
    report::warn(format_args!(
        "keep away what the whisker could touch: it goes from {} to {} degrees, slowly, and then \
         to and fro; Ctrl-C stops it",
        motor.min_deg, motor.max_deg
    ));
    let mut results = Results::default();
    let done = all(&mut whisker, &tuner, motor, &mut results);
    let stopped = whisker.stop();
    let samples = done?;
    stopped?;
    report::say("the motor is off; whisker arm drives it");

    let origin = whisker.module().origin()?;
    let origin = origin.with("scene", &tuner.scene().name);
    toml.whole(results.toml(&origin).as_bytes())?;
    csv.whole(table(&samples).as_bytes())?;
    let title = format!("{}: steps of the setpoint", tuner.scene().name);
    let picture = picture(title, &samples, &[ANGLE, ERROR, DUTY]);
    svg.whole(picture.svg()?.as_bytes())?;
    png.whole(&picture.png()?)?;
    report::say(format_args!(
        "in {}: calibration.toml, steps.csv, steps.svg, steps.png",
        arguments.out.display()
    ));
    if !arguments.which.source.is_simulated() {
        // Somebody holds the samples: textures, in several poses.
        report::say(format_args!(
            "next: whisker capture --label NAME --pose NAME --calibration {}; in three to five poses, \
             each time with the samples held some degrees otherwise, from the second on with --resume",
            quoted(&arguments.out.join("calibration.toml"))
        ));
    }
    Ok(())
}

fn all(
    whisker: &mut Listening<'_>,
    tuner: &Tuner,
    motor: &MotorSection,
    results: &mut Results,
) -> Result<Vec<Sample>, Error> {
    zero(whisker, results)?;
    // Gently, until direction and range are known; a whisker that stands at a stop is no fault
    // then.
    let gentle = (GENTLE * motor.homing_duty).min(motor.duty_limit);
    // More is not taken where nothing is expected.
    let gentle = gentle.min(allowed::GENTLE_DUTY);
    limit(whisker, tuner, [gentle, 2.0 * gentle + motor.unmoved_duty])?;
    whisker.arm()?;
    match push(whisker)? {
        Push::With(moved) => report::say(format_args!(
            "direction: moves with its duty, {moved:.1} degrees for a push of 3 at a duty of at \
             most {gentle}"
        )),
        Push::Against(moved) => {
            return Err(Error::Work(format!(
                "direction: moved {moved:.1} degrees against its duty: exchange the encoder's \
                 channels A and B, or the motor's two wires, not both; the motors were stopped"
            )));
        }
        Push::Still => {
            return Err(Error::Work(format!(
                "direction: stays where it is at a duty of {gentle} (twice motor.homing_duty): motor or \
                 encoder not connected, or more friction than that; the motors were stopped"
            )));
        }
    }
    let range = travel(whisker, motor, results)?;
    // Limits that protect change only with motors that are off.
    rest(whisker.module())?;
    limit(whisker, tuner, [motor.duty_limit, motor.unmoved_duty])?;
    whisker.go_on()?;
    whisker.arm()?;
    whisk(whisker, results)?;
    let samples = gains(whisker, motor, range, results)?;
    rest(whisker.module())?;
    Ok(samples)
}

/// Takes another largest duty, and another by which it may change while nothing moves.
fn limit(whisker: &mut Listening<'_>, tuner: &Tuner, duties: [f64; 2]) -> Result<(), Error> {
    let keys = ["motor.duty_limit", "motor.unmoved_duty"];
    let set = [0, 1].map(|n| named(keys[n], &duties[n].to_string()));
    let done = tuner.set(whisker.module(), &set)?;
    done.map(drop).map_err(Error::Work)
}

fn zero(whisker: &mut Listening<'_>, results: &mut Results) -> Result<(), Error> {
    let samples = at_rest(whisker, REST_S)?;
    let zero = Zero::of(&samples).ok_or_else(|| {
        Error::Work("zero: no reading of the sensor counts; whisker log names the fault".to_owned())
    })?;
    for (name, channel) in ["x", "y"].into_iter().zip(&zero.channels) {
        report::say(format_args!(
            "zero: {name} {:.1} codes, {:+.1} % of the way to the end of its range; noise {:.1} \
             codes, drift {:+.1} in {REST_S} s",
            channel.mean,
            100.0 * channel.offset(),
            channel.sd,
            channel.drift
        ));
        if channel.offset().abs() > FAR {
            report::warn(format_args!(
                "zero: {name} is {:.0} codes from the middle, {MIDDLE}: turn the magnet in its \
                 hub, or the sensor below it (docs/build.md)",
                channel.mean - MIDDLE
            ));
        }
    }
    if zero.invalid > 0 {
        report::warn(format_args!(
            "zero: {} of {} readings do not count; whisker log names the fault",
            zero.invalid,
            zero.invalid + zero.counted
        ));
    }
    results.zero = Some(zero);
    Ok(())
}

fn travel(
    whisker: &mut Listening<'_>,
    motor: &MotorSection,
    results: &mut Results,
) -> Result<[f64; 2], Error> {
    let ends = [motor.min_deg, motor.max_deg];
    let mut range = ends;
    for (end, found) in ends.into_iter().zip(&mut range) {
        let Some(met) = lead(whisker, end)? else {
            continue;
        };
        *found = met;
        report::warn(format_args!(
            "range: meets something at {met:.1} degrees on the way to {end}: a stop, or \
             something in its way. Keep motor.min_deg and motor.max_deg two degrees inside"
        ));
    }
    report::say(format_args!(
        "range: free from {:.1} to {:.1} degrees",
        range[0], range[1]
    ));
    results.range_deg = Some(range);
    Ok(range)
}

/// More of its range than a whisker in free air swings over. Chosen.
const MOST_SWING: f64 = 0.2;

fn whisk(whisker: &mut Listening<'_>, results: &mut Results) -> Result<(), Error> {
    whisker.hold(None)?;
    let samples = whisker.follow(WHISK_S, |_| true)?;
    let mut spans = Vec::new();
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let codes = || samples.iter().map(|sample| sample.codes[axis]);
        let (low, high) = (codes().min().unwrap_or(0), codes().max().unwrap_or(0));
        spans.push([low, high]);
        let share = f64::from(high - low) / (2.0 * HALF_RANGE);
        report::say(format_args!(
            "range: {name} swings from {low} to {high} in the air, {:.1} % of its range",
            100.0 * share
        ));
        if share > MOST_SWING {
            report::warn(format_args!(
                "range: {name} swings too far for free air: take away what the whisker touches and \
                 calibrate again, or it is loose in its hub"
            ));
        }
        if is_at_end(low) || is_at_end(high) {
            report::warn(format_args!(
                "range: {name} is at the end of its range: the magnet is too near, or the sensor's \
                 range too small (docs/build.md)"
            ));
        }
    }
    results.swing = spans;
    Ok(())
}

fn gains(
    whisker: &mut Listening<'_>,
    motor: &MotorSection,
    [low, high]: [f64; 2],
    results: &mut Results,
) -> Result<Vec<Sample>, Error> {
    // Away from stops.
    let (samples, left) = steps(whisker, [low + 3.0, high - 3.0])?;
    results.left_deg = Some(left);
    let Some(found) = identify(&samples, whisker.tick_s()) else {
        report::warn(
            "steps: they do not show how the motor moves the whisker: too slow, too far from its \
             setpoint, or in its way; look at steps.svg",
        );
        return Ok(samples);
    };
    let now = found.under(motor.kp, motor.kd);
    report::say(format_args!(
        "motor: {:.0} degrees/s at full duty without friction, time constant {:.0} ms, friction \
         takes a duty of {:.3} (the fit leaves {:.0} %)",
        found.speed_deg_s,
        1e3 * found.tau_s,
        found.friction,
        100.0 * found.misfit
    ));
    report::say(format_args!(
        "gains: with kp {} and kd {} it comes to rest within {:.2} degrees of its setpoint, \
         found {left:.2}; damping {:.2}",
        now.kp, now.kd, now.dead_band_deg, now.damping
    ));
    let better = suggest(&found, whisker.tick_s());
    report::say(format_args!(
        "gains: kp {} and kd {} would leave {:.2} degrees, damping {:.2}; to try them: whisker \
         set motor.kp={} motor.kd={}",
        better.kp, better.kd, better.dead_band_deg, better.damping, better.kp, better.kd
    ));
    results.motor = Some(found);
    results.suggested = Some(better);
    Ok(samples)
}

fn table(samples: &[Sample]) -> String {
    let mut table = String::from("t_s,setpoint_deg,measured_deg,duty,x,y\n");
    for sample in samples {
        let [x, y] = sample.codes;
        // Writing to a string does not fail.
        let _ = writeln!(
            table,
            "{:.4},{:.4},{:.4},{:.5},{x},{y}",
            sample.t_s, sample.setpoint_deg, sample.measured_deg, sample.duty
        );
    }
    table
}

/// The pictures of the steps, below that of the angle.
const ERROR: Panel = (
    "error, degrees (cut at 3)",
    4.0,
    &[("setpoint − measured", Ink::Found, error)],
);
const DUTY: Panel = ("duty", 0.2, &[("duty", Ink::Found, |s| s.duty)]);

fn error(of: &Sample) -> f64 {
    (of.setpoint_deg - of.measured_deg).clamp(-3.0, 3.0)
}

#[cfg(test)]
pub(super) mod tests;
