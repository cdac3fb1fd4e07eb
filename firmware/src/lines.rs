//! What a module says of itself as lines: fields with spaces between them. docs/protocol.md lists
//! them.
//!
//! The wording stands here once, as texts of defmt. A board's log sends their numbers; the serial
//! port, and a simulated module, fill them in ([`wire::Line::form`]).

use mlx90333::FRAME_LEN;
use tactile::Reason;
use wire::{Field, Line};

use crate::faults::text;
use crate::{Event, NotArmed, StartCause, Startup};

/// Says what an [`Event`] is by `$say!(LEVEL, TEXT, VALUES...)`: the level in the log, a text of
/// defmt, and the values in it. `$text` gives name and likely causes of a fault's number,
/// `$class` the name of a class, `$load` the length of a tick in microseconds and how many lines
/// found no room. What an image is built without has no line.
#[macro_export]
macro_rules! say_event {
    ($say:ident, $event:expr, $text:ident, $class:expr, $load:expr) => {
        match $event {
            $crate::Event::Touch { place, number } if $crate::Part::Classifier.is_built() => {
                $say!(info, "touch {=str} {=u16}", place.side_name(), number);
            }
            $crate::Event::TouchEnd { place, number } if $crate::Part::Classifier.is_built() => {
                $say!(info, "end {=str} {=u16}", place.side_name(), number);
            }
            $crate::Event::Decision(place, decision) if $crate::Part::Classifier.is_built() => {
                let name = $class;
                let class = decision.class().map_or("unknown", &name);
                let among = decision.among().map_or([""; 2], |among| among.map(&name));
                let [why, leader, and, rival] = $crate::lines::why(decision.reason(), among);
                let [quote, of_leader, of_rival] = [class, leader, rival].map($crate::lines::quote);
                let posterior = $crate::lines::percent(decision);
                $say!(
                    info,
                    "decision {=str} {=str}{=str}{=str} {=u32}.{=u32:04} {=u32}\
                     {=str}{=str}{=str}{=str}{=str}{=str}{=str}{=str}",
                    place.side_name(),
                    quote,
                    class,
                    quote,
                    posterior / 10_000,
                    posterior % 10_000,
                    decision.samples(),
                    why,
                    of_leader,
                    leader,
                    of_leader,
                    and,
                    of_rival,
                    rival,
                    of_rival
                );
            }
            $crate::Event::Pose(place, pose) if $crate::Part::Pose.is_built() => {
                let [of_tilt, of_depth] = [pose.tilt, pose.depth].map($crate::lines::estimate);
                let (tilt_sign, [tilt, tilt_part, tilt_error, tilt_error_part]) = of_tilt;
                let (depth_sign, [depth, depth_part, depth_error, depth_error_part]) = of_depth;
                $say!(
                    info,
                    "pose {=str} {=str}{=u16}.{=u16:02} {=u16}.{=u16:02} \
                     {=str}{=u16}.{=u16:02} {=u16}.{=u16:02}",
                    place.side_name(),
                    tilt_sign,
                    tilt,
                    tilt_part,
                    tilt_error,
                    tilt_error_part,
                    depth_sign,
                    depth,
                    depth_part,
                    depth_error,
                    depth_error_part
                );
            }
            $crate::Event::SensorLost(place, why) => {
                $crate::say_fault!($say, $text, place, why.code());
            }
            $crate::Event::Frame(place, bytes) => {
                let [high, low] = $crate::lines::halves(bytes);
                $say!(
                    error,
                    "frame {=str} {=u32:08x}{=u32:08x}",
                    place.side_name(),
                    high,
                    low
                );
            }
            $crate::Event::SensorBack(place) => $say!(info, "back {=str}", place.side_name()),
            $crate::Event::ZeroMoved(place, [x, y]) if $crate::Part::Zero.is_built() => {
                $say!(info, "zero {=str} {=i16} {=i16}", place.side_name(), x, y);
            }
            $crate::Event::MotorFault(place, why) if $crate::Part::Motion.is_built() => {
                $crate::say_fault!($say, $text, place, why.code());
            }
            $crate::Event::MotorRetry(place) if $crate::Part::Motion.is_built() => {
                $say!(info, "retry {=str}", place.side_name());
            }
            $crate::Event::MotorGivenUp(place) if $crate::Part::Motion.is_built() => {
                $say!(error, "off {=str}", place.side_name());
            }
            $crate::Event::Node(node, what) if $crate::Part::Bus.is_built() => match what {
                $crate::NodeEvent::Joined => $say!(info, "node {=u8} joined", node),
                $crate::NodeEvent::Left => $say!(warn, "node {=u8} left", node),
                $crate::NodeEvent::Heard(other) => {
                    $say!(info, "node {=u8} hears {=u8}", node, other);
                }
                $crate::NodeEvent::Lost(other) => $say!(warn, "node {=u8} lost {=u8}", node, other),
                $crate::NodeEvent::Twin => {
                    $crate::say_board_fault!($say, $text, $crate::faults::number::TWIN);
                }
            },
            $crate::Event::Stopped if $crate::Part::Motion.is_built() => $say!(info, "stopped"),
            $crate::Event::Armed if $crate::Part::Motion.is_built() => $say!(info, "armed"),
            $crate::Event::Health(health) => {
                let [period_us, lost]: [u32; 2] = $load;
                $say!(
                    info,
                    "health {=u16}.{=u16} {=u32} {=u32} {=u32} {=u32}",
                    health.worst_tenths / 10,
                    health.worst_tenths % 10,
                    period_us,
                    health.missed,
                    health.dropped,
                    lost
                );
            }
            $crate::Event::Limit(number) => {
                let text = $text(number);
                $say!(warn, "limit {=u8} {=istr}", number, text);
            }
            _ => {}
        }
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! say_fault {
    ($say:ident, $text:ident, $place:expr, $number:expr) => {{
        let text = $text($number);
        $say!(
            error,
            "fault {=str} {=u8} {=istr}",
            $place.side_name(),
            $number,
            text
        );
    }};
}

/// Says what has started, as [`say_event!`](crate::say_event) does: `$what` are the version, the
/// scene and the ticks a second, `$start` is the [`Startup`] and its [`StartCause`].
#[macro_export]
macro_rules! say_start {
    ($say:ident, $text:ident, $what:expr, $start:expr) => {{
        let (version, scene, tick_hz) = $what;
        let (start, cause) = $start;
        $say!(
            info,
            "start {=str} {=str} {=u32} {=str} {=u32} {=u8}",
            version,
            scene,
            tick_hz,
            $crate::StartCause::name(cause),
            start.number,
            start.fault
        );
        if start.fault != 0 {
            $crate::say_board_fault!($say, $text, start.fault);
        }
    }};
}

/// Says which fault the board has, or has started after.
#[macro_export]
macro_rules! say_board_fault {
    ($say:ident, $text:ident, $number:expr) => {{
        let text = $text($number);
        $say!(error, "fault board {=u8} {=istr}", $number, text);
    }};
}

/// Says why no motor is driven until somebody arms it.
#[macro_export]
macro_rules! say_not_armed {
    ($say:ident, $text:ident, $reason:expr) => {
        match $reason {
            $crate::NotArmed::After(number) => {
                let text = $text(number);
                $say!(warn, "not-armed {=u8} {=istr}", number, text);
            }
            $crate::NotArmed::Unknown => $say!(warn, "not-armed 0 cause of the reset unknown"),
            $crate::NotArmed::OnCommand => $say!(info, "not-armed 0 the scene waits for a command"),
            $crate::NotArmed::Stopped => $say!(info, "not-armed 0 somebody has stopped the motors"),
            $crate::NotArmed::Before => $say!(info, "not-armed 0 the supply has been away"),
            $crate::NotArmed::Reset => $say!(info, "not-armed 0 it was reset"),
        }
    };
}

/// The posterior of a decision in units of 0.0001 %, rounded down: at most 99.9999 %.
pub fn percent(decision: tactile::Decision) -> u32 {
    ((u64::from(decision.posterior().q32()) * 1_000_000) >> 32) as u32
}

/// The sign of an estimate; its size and its error, each as whole units and hundredths.
// Before what is said: where a number is divided between two words of a line, a compiler for size
// makes one function of several such places, which goes on by a pointer.
#[inline(never)]
pub fn estimate(estimate: tactile::Estimate) -> (&'static str, [u16; 4]) {
    let sign = if estimate.hundredths < 0 { "-" } else { "" };
    let (size, error) = (
        estimate.hundredths.unsigned_abs(),
        estimate.error_hundredths,
    );
    (sign, [size / 100, size % 100, error / 100, error % 100])
}

/// The bytes of a frame, the first in the highest place.
pub const fn halves(bytes: [u8; FRAME_LEN]) -> [u32; 2] {
    let both = u64::from_be_bytes(bytes);
    [(both >> 32) as u32, both as u32]
}

/// Around a name on a line: a quotation mark where it has spaces, which would make fields of it.
pub fn quote(name: &str) -> &'static str {
    if name.bytes().any(|byte| byte == b' ') {
        "\""
    } else {
        ""
    }
}

/// Why a decision names no class, in words that follow each other, a space before them; empty
/// where one is named, or where "unknown" says it all. `among` are the leader and its rival.
pub const fn why(reason: Option<Reason>, among: [&str; 2]) -> [&str; 4] {
    match reason {
        None | Some(Reason::Unknown) => [""; 4],
        Some(Reason::Pose) => [" outside the poses of training", "", "", ""],
        Some(Reason::Between(_)) => {
            let [leader, rival] = among;
            [" between ", leader, " and ", rival]
        }
    }
}

/// A line that begins with the time at which so many ticks had passed since the start, in
/// seconds, which wrap around with the count of ticks.
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

/// What lines need to know besides the event.
#[derive(Debug, Clone, Copy)]
pub struct Context<N> {
    /// Gives the name of a class.
    pub class_name: N,
    /// A tick, µs.
    pub period_us: u32,
    /// Lines that found no room, since the start.
    pub lost: u32,
}

/// Appends what `event` says; returns its level in the log, or nothing where it has no line.
#[inline(never)]
pub fn event<'n>(
    line: &mut Line,
    event: &Event,
    context: Context<impl Fn(usize) -> &'n str>,
) -> Option<&'static str> {
    let mut level = None;
    macro_rules! say {
        ($level:ident, $text:literal $(, $value:expr)* $(,)?) => {{
            level = Some(stringify!($level));
            line.word("").form($text, &[$(Field::from($value)),*]);
        }};
    }
    let Context {
        class_name,
        period_us,
        lost,
    } = context;
    crate::say_event!(say, *event, text, class_name, [period_us, lost]);
    level
}

/// Appends what has started, to the line that `begin` gives, and to another one the last fault;
/// `end` takes each.
pub fn start(
    line: impl Fn() -> Line,
    what: (&str, &str, u32),
    start: (&Startup, StartCause),
    mut end: impl FnMut(&mut Line),
) {
    macro_rules! say {
        ($level:ident, $text:literal $(, $value:expr)* $(,)?) => {
            end(line().word("").form($text, &[$(Field::from($value)),*]))
        };
    }
    crate::say_start!(say, text, what, start);
}

/// Appends why no motor is driven until somebody arms it.
pub fn not_armed(line: &mut Line, reason: NotArmed) {
    macro_rules! say {
        ($level:ident, $text:literal $(, $value:expr)* $(,)?) => {
            _ = line.word("").form($text, &[$(Field::from($value)),*])
        };
    }
    crate::say_not_armed!(say, text, reason);
}

#[cfg(test)]
mod tests {
    use tactile::Decision;
    use whisking::motor;
    use wire::Line;

    use super::{Context, at, event, not_armed, start};
    use crate::faults::{TABLE, can_occur, number};
    use crate::{Event, Health, NotArmed, Place, Record, SensorFault, StartCause};

    fn said(line: &mut Line) -> String {
        let text = String::from_utf8(line.ended().to_vec()).unwrap();
        text.strip_suffix("\r\n").unwrap().to_owned()
    }

    fn line_of(of: &Event) -> String {
        let mut line = at(24_690, 2_000);
        let context = Context {
            class_name: |class| ["smooth", "carpet"][class],
            period_us: 500,
            lost: u32::MAX,
        };
        event(&mut line, of, context).expect("a line");
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
    fn a_name_is_one_field_and_ends_no_line() {
        let said_of = |names: [&'static str; 2], bits| {
            let decision = Decision::from_memory(34, 1 << 27, bits).unwrap();
            let context = Context {
                class_name: |class: usize| names[class],
                period_us: 500,
                lost: 0,
            };
            let mut line = at(0, 2_000);
            event(&mut line, &Event::Decision(RIGHT, decision), context);
            said(&mut line)
        };
        let begins = "0.000 decision right \"rough carpet\" ";
        assert!(said_of(["ice", "rough carpet"], 0).starts_with(begins));
        let ends = " between ice and \"rough carpet\"";
        assert!(said_of(["rough carpet", "ice"], 5 << 16).ends_with(ends));
        let forged = said_of(["ice", "x\r\nok stop"], 0);
        assert!(forged.contains("\"x??ok stop\" ") && !forged.contains('\n'));
    }

    #[test]
    fn every_event_has_its_fields() {
        let (place, number) = (Place::new(0, 0), 65_535);
        let health = Health {
            worst_tenths: 123,
            missed: 1,
            dropped: 2,
        };
        for (event, expected) in [
            (Event::Touch { place, number }, "touch left 65535"),
            (Event::TouchEnd { place, number }, "end left 65535"),
            (Event::SensorBack(RIGHT), "back right"),
            (Event::MotorRetry(RIGHT), "retry right"),
            (Event::MotorGivenUp(RIGHT), "off right"),
            (Event::Health(health), "health 12.3 500 1 2 4294967295"),
        ] {
            assert_eq!(line_of(&event), format!("12.345 {expected}"));
        }
        // Class 1 at even odds after 34 samples; the same, unnamed for each reason.
        for (touch, class, why) in [
            (0, "carpet", ""),
            (1 << 16, "unknown", ""),
            (3 << 16, "unknown", " outside the poses of training"),
            (5 << 16, "unknown", " between carpet and smooth"),
        ] {
            let decision = Decision::from_memory(34, 1 << 27, touch).unwrap();
            let q32 = decision.posterior().q32();
            let percent = f64::from(q32) / f64::from(1_u32 << 16) / 65_536.0 * 100.0;
            let percent = (percent * 1e4).floor() / 1e4;
            assert_eq!(
                line_of(&Event::Decision(RIGHT, decision)),
                format!("12.345 decision right {class} {percent:.4} 34{why}")
            );
        }
        let lost = line_of(&Event::SensorLost(RIGHT, SensorFault::NoFrame));
        let why = "no frame in time (none was started: follows another fault?)";
        assert_eq!(lost, format!("12.345 fault right 16 {why}"));
        let stalls = line_of(&Event::MotorFault(RIGHT, motor::Fault::Stall));
        assert!(stalls.starts_with("12.345 fault right 6 does not move as it is driven (held;"));
    }

    #[test]
    fn every_fault_fits_whole() {
        for row in TABLE.iter().filter(|row| can_occur(row.number)) {
            let whole = format!(" {} {} ({}?)", row.number, row.name, row.causes);
            let limit = line_of(&Event::Limit(row.number));
            assert!(limit.ends_with(&format!("limit{whole}")), "{limit}");
            // The longest word before it is that.
            let mut refused = at(u32::MAX, 2_000);
            not_armed(&mut refused, NotArmed::After(row.number));
            assert!(said(&mut refused).ends_with(&whole));
        }
    }

    #[test]
    fn a_start_has_its_fields() {
        let (mut record, first) = Record::start(None, StartCause::Power);
        record.note(number::WATCHDOG);
        let (_, second) = Record::start(Some(record), StartCause::Watchdog);
        let mut lines = Vec::new();
        for (begun, cause) in [(&first, StartCause::Power), (&second, StartCause::Watchdog)] {
            let what = ("0.1.0", "textures", 2_000);
            let say = |line: &mut Line| lines.push(said(line));
            start(|| at(0, 2_000), what, (begun, cause), say);
        }
        assert_eq!(lines[0], "0.000 start 0.1.0 textures 2000 power-up 1 0");
        let number = number::WATCHDOG;
        let again = format!("0.000 start 0.1.0 textures 2000 watchdog 2 {number}");
        assert_eq!(lines[1], again);
        assert!(lines[2].starts_with(&format!("0.000 fault board {number} ")));
        assert_eq!(lines.len(), 3);
    }
}
