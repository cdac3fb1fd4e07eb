//! Whiskers that look for their stop: a hand that holds one meanwhile, and encoders that lose counts.

use crate::played::{
    LEFT, Played, TICK_HZ, alone, angles, farthest, faults, play, play_once, undisturbed,
};
use firmware::Event;
use host_sim::motor::EncoderFlaws;
use host_sim::run::Run;
use scene::Scene;
use whisking::motor::Fault;

const NONE: EncoderFlaws = EncoderFlaws::NONE;
/// When an encoder begins to lose counts.
const SLIPS: u64 = 3 * TICK_HZ;

/// A whisker that looks for its stop and whisks freely, twice a second.
fn finds(motor: &str) -> Scene {
    alone(2.0, &format!("rest = \"find\"\n{motor}"))
}

/// A whisker at 120 degrees is armed, and a hand holds it for two seconds where it meets it on its
/// way to the stop: from behind only, so that it gives way forwards, or fast.
fn held(hand_deg: f64, is_fast: bool, motor: &str) -> Played {
    let scene = finds(&format!("arm = \"on-command\"\n{motor}"));
    let mut until = None;
    play(&scene, 12 * TICK_HZ, |tick, run| {
        let motor = run.motor_mut(0).unwrap();
        if tick == 0 {
            motor.turn_to_deg(120.0);
        }
        let is_met = motor.angle_deg() <= hand_deg;
        if is_met && until.is_none() {
            until = Some(tick + 2 * TICK_HZ);
        }
        let holds = until.is_some_and(|until| tick < until);
        motor.block(holds && (is_fast || is_met && motor.duty() <= 0.0));
        if tick == 10 {
            run.arm(true);
        }
    })
}

#[test]
fn a_hand_is_not_taken_for_the_stop() {
    for hand_deg in [60.0, 70.0, 80.0, 90.0] {
        for is_fast in [false, true] {
            let played = held(hand_deg, is_fast, "");
            let (_, first) = faults(&played)[0];
            assert_eq!(first, Fault::Homing, "{hand_deg}");
            // Once it is gone, the whisker whisks where it should.
            let error = farthest(&played, 6 * TICK_HZ);
            assert!(error < 25.0, "{hand_deg} {is_fast}: {error}");
            // Until then it does not whisk: it is heard nowhere.
            let early = played.heard.iter().map(|(tick, _)| *tick);
            let early = early.filter(|tick| (11..2 * TICK_HZ).contains(tick));
            assert!(early.count() < 5, "{hand_deg} {is_fast}: it is heard");
        }
    }
}

/// A hand nearer to the stop than the whisker's range is to the other one.
#[test]
fn a_hand_near_the_stop_is_found_where_the_far_stop_is_known() {
    let first = |motor: &str| faults(&held(50.0, false, motor)).first().copied();
    assert_eq!(first(""), None);
    let found = first("far_stop_deg = 180\n").map(|(_, fault)| fault);
    assert_eq!(found, Some(Fault::Homing));
    let sound = undisturbed(&finds("far_stop_deg = 180\n"), 4 * TICK_HZ);
    assert_eq!(sound.events, []);
    assert!(farthest(&sound, 3 * TICK_HZ) < 25.0);
}

/// Homing leaves a whisker at the end of its range, 160°, at full speed. It is braked there, and not
/// tested, which would drive it on.
#[test]
fn a_whisker_that_was_homed_is_braked() {
    let played = undisturbed(&finds(""), 2 * TICK_HZ);
    let angles = played.rows.iter().map(|row| row.angle_deg[0]);
    let highest = angles.fold(0.0, f64::max);
    println!("{highest} degrees");
    assert!((160.0..166.0).contains(&highest), "{highest}");
}

/// What became of an encoder that loses this share of the counts of protraction.
fn slips(slip: f64, ticks: u64) -> Played {
    flawed(EncoderFlaws { slip, ..NONE }, SLIPS, ticks)
}

fn flawed(flaws: EncoderFlaws, from: u64, ticks: u64) -> Played {
    play_once(&finds(""), ticks, from, |run| {
        run.motor_mut(0).unwrap().set_encoder(flaws);
    })
}

/// By how much the whisker has drifted in the second that ends with a tick, degrees.
fn drifted(played: &Played, end: u64) -> f64 {
    let off = |end: u64| {
        let rows = &played.rows[(end - TICK_HZ) as usize..end as usize];
        let off = rows.iter().map(|row| row.angle_deg[0] - row.theta_deg[0]);
        off.sum::<f64>() / TICK_HZ as f64
    };
    off(end) - off(SLIPS)
}

#[test]
fn lost_counts_are_found_before_the_end_stop() {
    for (slip, least_deg, most_deg) in [(0.001, 1.0, 3.0), (0.01, 10.0, 30.0)] {
        let played = slips(slip, 90 * TICK_HZ);
        let found = faults(&played);
        let (first, _) = found[0];
        let drifted = drifted(&played, first - TICK_HZ);
        assert!(first < 21 * TICK_HZ, "{slip}: {first}");
        let expected = least_deg..most_deg;
        assert!(expected.contains(&drifted), "{slip}: {drifted}");
        let counted = [Fault::LostCounts; 3];
        assert!(found.iter().map(|(_, fault)| *fault).eq(counted), "{slip}");
        assert_eq!(played.events.last().unwrap().1, Event::MotorGivenUp(LEFT));
    }
}

#[test]
fn a_whisker_that_loses_half_its_counts_is_given_up() {
    let played = slips(0.5, 20 * TICK_HZ);
    let found = faults(&played);
    let (first, _) = found[0];
    assert!(first - SLIPS < 3 * TICK_HZ, "{first}");
    assert_eq!(found[1].1, Fault::LostCounts);
    assert_eq!(played.events.last().unwrap().1, Event::MotorGivenUp(LEFT));
}

/// What drifts by less than is a fault is put right each time.
#[test]
fn a_sound_whisker_goes_home_now_and_then_without_a_fault() {
    for slip in [0.0, 1e-4] {
        let played = slips(slip, 65 * TICK_HZ);
        assert_eq!(played.events, []);
        let angles = (0..).zip(angles(&played, 0)).skip(2 * TICK_HZ as usize);
        let low = angles.filter(|(_, angle)| *angle < 30.1);
        let low: Vec<u64> = low.map(|(tick, _)| tick).collect();
        let gaps = low.windows(2).filter(|pair| pair[1] - pair[0] > TICK_HZ);
        assert_eq!(1 + gaps.count(), 3, "every 20 s");
        let drifted = drifted(&played, 60 * TICK_HZ);
        assert!(drifted.abs() < 1.0, "{drifted}");
    }
}

/// Wherever in a whisk it begins.
#[test]
fn a_scale_that_is_wrong_is_found_at_home() {
    for scale in [0.5, 2.0] {
        for phase in 0..8 {
            let from = SLIPS + phase * TICK_HZ / 16;
            let played = flawed(EncoderFlaws { scale, ..NONE }, from, 30 * TICK_HZ);
            let found = faults(&played);
            println!("{scale} from {from}: {found:?}");
            let (first, _) = found[0];
            assert!(first - from < 21 * TICK_HZ, "{scale} from {from}: {first}");
        }
    }
}

#[test]
fn a_coarse_encoder_finds_its_stop_or_is_refused() {
    for motor in [
        "counts_per_rev = 12\nhoming_duty = 0.055\n",
        "counts_per_rev = 12\n",
        "counts_per_rev = 16\nhoming_duty = 0.06\n",
    ] {
        let played = undisturbed(&finds(motor), 12 * TICK_HZ);
        assert_eq!(faults(&played), [], "{motor}");
        let whisks = played.rows[8 * TICK_HZ as usize..].iter();
        let angles = whisks.map(|row| row.angle_deg[0]);
        let most = angles.fold(0.0, f64::max);
        assert!(most > 100.0, "{motor}: {most}");
    }
    let refused = Run::new(&finds("counts_per_rev = 4\ngear = 1.0\n"), None);
    let fault = refused.err().unwrap().to_string();
    let expected = "motor.counts_per_rev: found 4; allowed with a gear of 1 and motor.rest = \
                    \"find\": at least 50";
    assert!(fault.contains(expected), "{fault}");
}
