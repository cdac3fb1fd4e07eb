//! Encoder and motor: the encoder by hand first, so that what the motor does can be trusted.

use firmware::Part as BoardPart;
use firmware::faults::number;
use host_sim::Error;
use serde::Serialize;

use super::bench::Bench;
use super::module::of_fault;
use super::report::{Done, Part, not_done};
use crate::calibrate::{Listening, Push, REST_DEG, push};
use crate::configuration::Taken;
use crate::interrupt;

/// The duty by which the motor is tried, of all.
const FIFTH: f64 = 0.2;
/// For how long the whisker may be turned by hand, s, and how far it must be, degrees.
const HAND_S: f64 = 5.0;
const TURNED_DEG: f64 = 10.0;
/// For so long it must stand still before the motor is tried, s, by so much, degrees.
const STILL_S: f64 = 0.3;
const STILL_DEG: f64 = 0.5;

const NO_MOTOR: &str = "not done: the scene has no motor; scenes/bringup.toml has one";

pub(super) fn encoder(bench: &mut Bench, side: u8) -> Done {
    if !bench.running.has_motor {
        return not_done(NO_MOTOR);
    }
    if bench.running.program().facts().is_none() {
        return not_done("not done: no hand turns a simulated whisker");
    }
    bench.stream()?;
    bench.ask("turn the whisker forward by hand, by a quarter of a turn, within five seconds")?;
    let mut whisker = bench.whisker(side)?;
    let mut from = None;
    let mut turned = 0.0;
    whisker.watch(HAND_S, |sample| {
        turned = sample.measured_deg - *from.get_or_insert(sample.measured_deg);
        f64::abs(turned) < TURNED_DEG
    })?;
    drop(whisker);
    let mut part = Part::new("watched the encoder while the whisker was turned forward by hand");
    part.saw(format!("it counts {turned:+.1} degrees"));
    bench.counts_up[usize::from(side)] = Some(turned >= TURNED_DEG);
    let means = if turned >= TURNED_DEG {
        "forward counts up, as it must. Degrees that are too many or too few: motor.gear, or \
         motor.counts_per_rev, which has all four edges of a line"
    } else if turned <= -TURNED_DEG {
        part.find("exchange the encoder's channels A and B: forward counts down");
        "the encoder is the wrong way round: a motor that follows it would run away"
    } else {
        part.find(
            "the encoder's supply, and A and B at the board's pins with an oscilloscope: both must \
             change as the whisker turns. If it was not turned, do this step again",
        );
        "the encoder does not count, or the whisker was not turned"
    };
    Ok(part.with(&turned).means(means))
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
enum Turns {
    Forward(f64),
    Backward,
    Not,
    /// Another fault than these has ended it.
    Fault(u8),
}

pub(super) fn motor(bench: &mut Bench, side: u8) -> Done {
    if !bench.running.has_motor {
        return not_done(NO_MOTOR);
    }
    if bench.counts_up[usize::from(side)] == Some(false) {
        return not_done("not done: the encoder must be right before a motor follows it");
    }
    if let Err(why) = bench.module.source().has_motors() {
        return not_done(format!("not done: {why}"));
    }
    bench.stream()?;
    let warning = "the motor is to turn the whisker by three degrees, at a fifth of its duty: bring the \
                   whisker to rest, keep fingers and things away, set the supply's current limit low and \
                   switch it on";
    if !bench.may_drive(warning)? {
        return not_done("not done: no yes was given (--motor says it for a script)");
    }
    let gentle = bench.running.gentle(FIFTH)?;
    if gentle != bench.running
        && let Some(why) = refused(&gentle.send(&mut bench.module)?)
    {
        return not_done(why);
    }
    let turned = tried(bench, side);
    bench.stop()?;
    if gentle != bench.running {
        bench.running.send(&mut bench.module)?;
    }
    Ok(judged(turned?, bench.counts_up[usize::from(side)]))
}

fn refused(taken: &Taken) -> Option<String> {
    let why = match taken {
        Taken::Runs => return None,
        Taken::NotBuilt => format!("its image was built without {}", BoardPart::Set),
        Taken::Refused(refused) => format!("it refuses {refused}"),
    };
    Some(format!(
        "not done: the module takes no smaller duty, {why}; deploy a scene with motor.duty_limit = \
         {FIFTH}, as scenes/bringup.toml has it"
    ))
}

fn tried(bench: &mut Bench, side: u8) -> Result<Turns, Error> {
    let mut whisker = bench.whisker(side)?;
    stands_still(&mut whisker)?;
    // Before it is armed: it would begin where the pattern generator is.
    whisker.hold(Some(REST_DEG))?;
    whisker.arm()?;
    let pushed = push(&mut whisker);
    interrupt::check()?;
    match (pushed, whisker.last_fault) {
        (Ok(Push::With(moved)), _) => Ok(Turns::Forward(moved)),
        (Ok(Push::Against(_)), _)
        | (Err(_), Some(number::RUNAWAY | number::TRAVEL | number::FOLLOWING)) => {
            Ok(Turns::Backward)
        }
        (Ok(Push::Still), _) | (Err(_), Some(number::STALL | number::ENCODER)) => Ok(Turns::Not),
        (Err(_), Some(fault)) => Ok(Turns::Fault(fault)),
        (Err(error), None) => Err(error),
    }
}

fn stands_still(whisker: &mut Listening<'_>) -> Result<(), Error> {
    let still = (STILL_S / whisker.tick_s()) as u32;
    let (mut at, mut since) = (f64::NAN, 0);
    whisker.watch(HAND_S, |sample| {
        let is_still = (sample.measured_deg - at).abs() < STILL_DEG;
        if !is_still {
            at = sample.measured_deg;
        }
        since = if is_still { since + 1 } else { 0 };
        since < still
    })?;
    Ok(())
}

fn judged(turned: Turns, counts_up: Option<bool>) -> Part {
    let did = "asked for three degrees forward, at a fifth of the motor's duty at most";
    let mut part = Part::new(did).with(&turned);
    match turned {
        Turns::Forward(moved) => {
            part.saw(format!("the whisker went {moved:.1} degrees forward"));
            part.means("motor and encoder agree. whisker calibrate measures the rest")
        }
        Turns::Backward => {
            part.saw("the whisker went backward");
            part.find(if counts_up == Some(true) {
                "exchange the motor's two wires: the encoder is right, so the motor is reversed"
            } else {
                "exchange the motor's two wires, or the encoder's A and B: the step encoder says which"
            });
            part.means("motor and encoder disagree about the direction")
        }
        Turns::Not => {
            part.saw("the whisker did not move");
            part.find(
                "the motor's supply and its emergency switch, the driver's enable or sleep pin, PWM at \
                 its input with an oscilloscope; or more friction than a fifth of the duty overcomes",
            );
            part.means("nothing turns at a fifth of the duty")
        }
        Turns::Fault(fault) => {
            part.saw(format!("fault {fault}"));
            part.find(of_fault(fault));
            part.means("the module has switched the motor off")
        }
    }
}
