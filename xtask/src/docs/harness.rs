//! The drawing of the harness: the board between the parts of its two sides.

use std::fmt::Write as _;

use serde::Deserialize;

use crate::run::Fault;

const TABLE: &str = include_str!("harness.csv");

/// A wire on either side, and what is in it.
#[derive(Debug, Deserialize)]
struct Wire {
    part: String,
    /// At the part; none where it joins the wire above.
    signal: String,
    left_pin: String,
    left_contact: String,
    g071rb_contact: String,
    right_pin: String,
    right_contact: String,
    passes: InWire,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum InWire {
    /// Nothing.
    #[serde(rename = "")]
    Nothing,
    /// A buffer supplied from 5 V, its input low while the chip's pin floats.
    BufferLow,
    /// The same, its input high, and its output where it does not drive.
    BufferHigh,
    /// 2.2 kΩ to 5 V.
    PullUp,
    /// 10 kΩ to ground.
    PullDown,
    /// The wire above.
    Joined,
}

fn wires() -> Result<Vec<Wire>, Fault> {
    let mut table = csv::ReaderBuilder::new();
    let mut table = table.comment(Some(b'#')).from_reader(TABLE.as_bytes());
    let wires: Result<_, _> = table.deserialize().collect();
    wires.map_err(|error| format!("harness.csv: {error}"))
}

/// Size of the drawing, and its middle.
const WIDTH: f64 = 1100.0;
const MIDDLE: f64 = WIDTH / 2.0;
/// From the middle: the board's edge, the near and the far edge of the parts.
const BOARD: f64 = 115.0;
const NEAR: f64 = 400.0;
const FAR: f64 = 530.0;
/// A gate, and what is before and after it.
const GATE: f64 = 288.0;
const BEFORE: f64 = 234.0;
const AFTER: f64 = 352.0;
/// Between two wires, and from one part to the next.
const PITCH: f64 = 26.0;
const GAP: f64 = 26.0;
const TOP: f64 = 44.0;

/// Under every drawing.
const LEGEND: [&str; 2] = [
    "triangle: a gate of a 74AHCT125 at 5 V",
    "each bridge has the motors' own supply, with a current limit and a switch",
];

/// A board, as its harness is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Drawn {
    /// With both sides.
    F446re,
    /// With the left side, as the next one.
    F103rb,
    G071rb,
}

impl Drawn {
    const fn sides(self) -> &'static [Side] {
        match self {
            Self::F446re => &[Side::Left, Side::Right],
            Self::F103rb | Self::G071rb => &[Side::Left],
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::F446re => "NUCLEO-F446RE",
            Self::F103rb => "NUCLEO-F103RB",
            Self::G071rb => "NUCLEO-G071RB",
        }
    }

    /// What lies under the drawing, a line each.
    const fn remarks(self) -> &'static [&'static str] {
        match self {
            Self::F446re => &[],
            Self::F103rb => &[
                "PA0, PA1, PA6 and PA7 do not bear 5 V: a level shifter in the data line,",
                "and an encoder with outputs of 3.3 V or open collectors",
            ],
            Self::G071rb => &[
                "PB6 is not D10 here: ST's UM2324 has its contact",
                "whether a pin bears 5 V: the data sheet's table of pins",
            ],
        }
    }
}

/// The drawing of a board's harness: an SVG document.
///
/// # Errors
/// If the table is broken.
pub(super) fn svg(drawn: Drawn) -> Result<String, Fault> {
    let wires = wires()?;
    let mut body = String::new();
    let mut y = TOP;
    let parts: Vec<&[Wire]> = wires.chunk_by(|a, b| a.part == b.part).collect();
    for part in &parts {
        y += GAP;
        for side in drawn.sides() {
            draw_part(&mut body, drawn, part, *side, y);
        }
        y += PITCH * part.len() as f64;
    }
    let bottom = y + GAP / 2.0;
    let mut board = String::new();
    rectangle(&mut board, MIDDLE - BOARD, TOP, 2.0 * BOARD, bottom - TOP);
    text(&mut board, MIDDLE, TOP + 16.0, "middle", drawn.name());
    for side in drawn.sides() {
        text(
            &mut board,
            side.x(FAR - 65.0),
            TOP - 12.0,
            "middle",
            side.name(),
        );
    }
    let mut height = bottom + 8.0;
    for line in LEGEND.iter().chain(drawn.remarks()) {
        height += 16.0;
        text(&mut board, 20.0, height, "start", line);
    }
    height += 16.0;
    let width = match drawn.sides() {
        [Side::Left] => MIDDLE + BOARD + 20.0,
        _ => WIDTH,
    };
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{board}{body}</svg>\n"
    ))
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

impl Side {
    /// A place at this distance from the middle.
    fn x(self, from_middle: f64) -> f64 {
        match self {
            Self::Left => MIDDLE - from_middle,
            Self::Right => MIDDLE + from_middle,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// The anchors of texts that end at the middle's side and at the other.
    const fn anchors(self) -> [&'static str; 2] {
        match self {
            Self::Left => ["end", "start"],
            Self::Right => ["start", "end"],
        }
    }
}

fn draw_part(body: &mut String, drawn: Drawn, part: &[Wire], side: Side, top: f64) {
    let name = part.first().map_or("", |wire| &wire.part);
    let height = PITCH * part.len() as f64 - 6.0;
    let corner = side.x(NEAR).min(side.x(FAR));
    rectangle(body, corner, top, FAR - NEAR, height);
    let [inner, outer] = side.anchors();
    text(body, side.x(FAR - 8.0), top + 16.0, outer, name);
    for (n, wire) in part.iter().enumerate() {
        let y = top + 12.0 + PITCH * n as f64;
        let (pin, contact) = match side {
            Side::Left if drawn == Drawn::G071rb => (&wire.left_pin, &wire.g071rb_contact),
            Side::Left => (&wire.left_pin, &wire.left_contact),
            Side::Right => (&wire.right_pin, &wire.right_contact),
        };
        // Text beside the board's edge ends towards it on the inside.
        text(body, side.x(BOARD - 8.0), y + 4.0, outer, pin);
        text(body, side.x(BOARD + 8.0), y - 4.0, inner, contact);
        text(body, side.x(NEAR + 8.0), y + 4.0, inner, &wire.signal);
        let end = match wire.passes {
            InWire::Joined => NEAR - 40.0,
            _ => NEAR,
        };
        line(body, [side.x(BOARD), y], [side.x(end), y]);
        draw_in_wire(body, wire.passes, side, y);
    }
}

fn draw_in_wire(body: &mut String, in_wire: InWire, side: Side, y: f64) {
    let at = NEAR - 80.0;
    match in_wire {
        InWire::Nothing => {}
        InWire::BufferLow => {
            gate(body, side, y);
            text(body, side.x(BEFORE), y - 4.0, "middle", "10 kΩ to ground");
        }
        InWire::BufferHigh => {
            gate(body, side, y);
            text(body, side.x(BEFORE), y - 4.0, "middle", "10 kΩ to 3.3 V");
            text(body, side.x(AFTER), y - 4.0, "middle", "10 kΩ to 5 V");
        }
        InWire::PullUp => text(body, side.x(at), y - 4.0, "middle", "2.2 kΩ to 5 V"),
        InWire::PullDown => text(body, side.x(at), y - 4.0, "middle", "10 kΩ to ground"),
        InWire::Joined => {
            let x = side.x(NEAR - 40.0);
            line(body, [x, y], [x, y - PITCH]);
        }
    }
}

/// A gate of a buffer, which points away from the board.
fn gate(body: &mut String, side: Side, y: f64) {
    let (base, tip) = (side.x(GATE), side.x(GATE + 18.0));
    let (above, below) = (y - 9.0, y + 9.0);
    let _ = writeln!(
        body,
        "<polygon points=\"{base},{above} {base},{below} {tip},{y}\" fill=\"white\" \
         stroke=\"black\"/>"
    );
}

fn rectangle(body: &mut String, x: f64, y: f64, width: f64, height: f64) {
    let _ = writeln!(
        body,
        "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"#eef2f6\" \
         stroke=\"black\"/>"
    );
}

fn line(body: &mut String, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
    let _ = writeln!(
        body,
        "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"black\"/>"
    );
}

fn text(body: &mut String, x: f64, y: f64, anchor: &str, text: &str) {
    let _ = writeln!(
        body,
        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>"
    );
}

#[cfg(test)]
mod tests {
    use super::wires;
    use crate::run::{read, top};

    #[test]
    fn the_pins_are_those_of_the_firmware() {
        let board = top().join("firmware/src/board");
        let shared = read(&board.join("wiring.rs")).unwrap();
        let own = read(&board.join("nucleo_f446re.rs")).unwrap();
        let wires = wires().unwrap();
        let pins = wires
            .iter()
            .flat_map(|wire| [&wire.left_pin, &wire.right_pin]);
        let mut found = 0;
        for pin in pins.filter(|pin| pin.starts_with('P')) {
            let named = format!("('{}', {})", &pin[1..2], &pin[2..]);
            let is_there = [&shared, &own]
                .into_iter()
                .any(|text| text.contains(&named));
            assert!(is_there, "{pin} is not in the firmware's tables");
            found += 1;
        }
        assert_eq!(
            found, 16,
            "sensor four, encoder two, bridge two, on two sides"
        );
    }
}
