//! What a module tells as lines of text: fields with spaces between them, the first of which
//! is the time. docs/serial.md lists them.

use wire::Line;

use crate::faults;
use crate::{Event, NotArmed, Place, StartCause, Startup};

/// A line that begins with the time at which so many ticks had passed since the start, in
/// seconds, which begin anew with the count of ticks.
#[inline(never)]
pub fn at(ticks: u32, tick_hz: u32) -> Line {
    let (whole, part) = (ticks / tick_hz.max(1), ticks % tick_hz.max(1));
    let ms = part * 1_000 / tick_hz.max(1);
    let mut line = Line::new();
    line.number(whole).text(".");
    // The thousandths alone, with their zeros.
    for digit in [ms / 100, ms / 10 % 10, ms % 10] {
        line.number(digit);
    }
    line
}

/// Appends what `event` says; `class_name` names classes.
pub fn event<'n>(line: &mut Line, event: &Event, class_name: impl FnOnce(usize) -> &'n str) {
    match *event {
        Event::Touch { place, number } => {
            of(line, "touch", place).field(number.into());
        }
        Event::TouchEnd { place, number } => {
            of(line, "end", place).field(number.into());
        }
        Event::Decision(place, decision) => {
            let class = decision.class().map_or("unknown", class_name);
            of(line, "decision", place).word(class).word("");
            // Percent with four decimals, rounded down: at most 99.9999.
            let posterior = (u64::from(decision.posterior().q32()) * 1_000_000) >> 32;
            line.fixed(posterior as u32, 4);
            line.field(decision.samples());
        }
        Event::SensorLost(place, why) => fault(of(line, "fault", place), why.code()),
        Event::MotorFault(place, why) => fault(of(line, "fault", place), why.code()),
        Event::SensorBack(place) => _ = of(line, "back", place),
        Event::ZeroMoved(place, [x, y]) => {
            of(line, "zero", place).signed(x.into()).signed(y.into());
        }
        Event::MotorRetry(place) => _ = of(line, "retry", place),
        Event::MotorGivenUp(place) => _ = of(line, "off", place),
    }
}

/// Appends a word and the side that it is about.
fn of<'l>(line: &'l mut Line, what: &str, place: Place) -> &'l mut Line {
    line.word(what).word(place.side_name())
}

/// Appends number, name and likely causes of a fault or limit.
#[inline(never)]
fn fault(line: &mut Line, number: u8) {
    let [name, causes] = faults::texts(number);
    line.field(number.into()).word(name);
    line.text(" (").text(causes).text("?)");
}

/// Appends what a limit is that was passed.
pub fn limit(line: &mut Line, number: u8) {
    fault(line.word("limit"), number);
}

/// How ticks and lines have fared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fared {
    /// The longest tick of the last second, tenths of a microsecond.
    pub worst_tenths: u32,
    /// A tick, µs.
    pub period_us: u32,
    /// Ticks that did not happen in time, since the start.
    pub missed: u32,
    /// Events that found their queue full, since the start.
    pub dropped: u32,
    /// Lines that found no room, since the start.
    pub lost: u32,
}

/// Appends it.
pub fn health(line: &mut Line, fared: &Fared) {
    line.word("health ").fixed(fared.worst_tenths, 1);
    for number in [fared.period_us, fared.missed, fared.dropped, fared.lost] {
        line.field(number);
    }
}

/// Appends what has started: version, scene, ticks a second, why, starts since power-up and
/// the number of the last fault.
pub fn start(
    line: &mut Line,
    [version, scene]: [&str; 2],
    tick_hz: u32,
    cause: StartCause,
    start: &Startup,
) {
    line.word("start").word(version).word(scene);
    line.field(tick_hz).word(match cause {
        StartCause::Watchdog => "watchdog",
        StartCause::Software => "software",
        StartCause::Power => "power-up",
        StartCause::BrownOut => "brown-out",
        StartCause::Pin => "reset-pin",
        StartCause::Other => "unknown",
    });
    line.field(start.number).field(start.fault.into());
}

/// Appends the fault of the board that it has started after.
pub fn board_fault(line: &mut Line, number: u8) {
    fault(line.word("fault board"), number);
}

/// Appends why no motor is driven until somebody arms it.
pub fn not_armed(line: &mut Line, reason: NotArmed) {
    line.word("not-armed");
    match reason {
        NotArmed::After(number) => fault(line, number),
        NotArmed::Unknown => _ = line.word("0 cause of the reset unknown"),
        NotArmed::OnCommand => _ = line.word("0 the scene waits for a command"),
    }
}

#[cfg(test)]
mod tests {
    use tactile::Decision;
    use whisking::motor;
    use wire::{LINE_BYTES, Line};

    use super::{Fared, at, board_fault, event, health, limit, not_armed, start};
    use crate::faults::{TABLE, number};
    use crate::{Event, NotArmed, Place, Record, SensorFault, StartCause};

    fn said(line: &mut Line) -> String {
        let text = String::from_utf8(line.ended().to_vec()).unwrap();
        text.strip_suffix("\r\n").unwrap().to_owned()
    }

    fn told(of: &Event) -> String {
        let mut line = at(24_690, 2_000);
        event(&mut line, of, |class| ["smooth", "carpet"][class]);
        said(&mut line)
    }

    const RIGHT: Place = Place::new(1, 0);

    #[test]
    fn the_time_is_to_the_tick() {
        for (ticks, tick_hz, expected) in [
            (0, 2_000, "0.000"),
            (1, 2_000, "0.000"),
            (2, 2_000, "0.001"),
            (24_690, 2_000, "12.345"),
            (199, 200, "0.995"),
            (u32::MAX, 2_000, "2147483.647"),
        ] {
            assert_eq!(said(&mut at(ticks, tick_hz)), expected);
        }
    }

    #[test]
    fn every_event_has_its_fields() {
        let touch = Event::Touch {
            place: Place::new(0, 0),
            number: 65_535,
        };
        assert_eq!(told(&touch), "12.345 touch left 65535");
        let end = Event::TouchEnd {
            place: RIGHT,
            number: 7,
        };
        assert_eq!(told(&end), "12.345 end right 7");
        // Class 1 at even odds after 34 samples; the same, unknown.
        for (touch, class) in [(0, "carpet"), (1 << 16, "unknown")] {
            let decision = Decision::from_memory(34, 1 << 27, touch).unwrap();
            let q32 = decision.posterior().q32();
            let percent = f64::from(q32) / f64::from(1_u32 << 16) / 65_536.0 * 100.0;
            let percent = (percent * 1e4).floor() / 1e4;
            assert_eq!(
                told(&Event::Decision(RIGHT, decision)),
                format!("12.345 decision right {class} {percent:.4} 34")
            );
        }
        assert_eq!(
            told(&Event::SensorLost(RIGHT, SensorFault::NoFrame)),
            "12.345 fault right 16 no frame in time (none was started: follows another fault?)"
        );
        assert!(
            told(&Event::MotorFault(RIGHT, motor::Fault::Stall))
                .starts_with("12.345 fault right 6 driven but not moving (blocked;")
        );
        assert_eq!(told(&Event::SensorBack(RIGHT)), "12.345 back right");
        assert_eq!(told(&Event::MotorRetry(RIGHT)), "12.345 retry right");
        assert_eq!(told(&Event::MotorGivenUp(RIGHT)), "12.345 off right");
    }

    #[test]
    fn every_fault_fits_whole() {
        for row in TABLE {
            let mut line = at(u32::MAX, 2_000);
            board_fault(&mut line, row.number);
            let text = said(&mut line);
            let whole = format!(" {} {} ({}?)", row.number, row.name, row.causes);
            assert!(text.ends_with(&whole), "{text}");
            // The longest word before it is that.
            let mut refused = at(u32::MAX, 2_000);
            not_armed(&mut refused, NotArmed::After(row.number));
            assert!(said(&mut refused).ends_with(&whole));
        }
        let mut line = Line::new();
        limit(&mut line, number::MISSED);
        assert!(said(&mut line).starts_with(" limit 32 ticks were missed ("));
    }

    #[test]
    fn start_and_health_have_their_fields() {
        let (_, first) = Record::start(None, StartCause::Power);
        let mut line = at(0, 2_000);
        start(
            &mut line,
            ["0.1.0", "textures"],
            2_000,
            StartCause::Power,
            &first,
        );
        assert_eq!(
            said(&mut line),
            "0.000 start 0.1.0 textures 2000 power-up 1 0"
        );
        let fared = Fared {
            worst_tenths: 123,
            period_us: 500,
            missed: 1,
            dropped: 2,
            lost: u32::MAX,
        };
        let mut line = at(2_000, 2_000);
        health(&mut line, &fared);
        assert_eq!(said(&mut line), "1.000 health 12.3 500 1 2 4294967295");
        assert!(line.ended().len() < LINE_BYTES);
    }
}
