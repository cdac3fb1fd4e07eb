//! docs/whisk.svg: a run of the simulator, moving: the whisker, what its sensor reads, and what it
//! decides. Angles, readings and decisions are the run's; between base and tip the bend is drawn.

use std::fmt::Write as _;

use crate::emulate::variants;
use crate::run::{Fault, output, target, top, workspace_program};

/// Where the whisker is, and how long it is, px.
const BASE: [f64; 2] = [150.0, 232.0];
const LENGTH: f64 = 190.0;
/// Where the readings stand: from left to right, from top to bottom, px.
const CHART: [f64; 4] = [330.0, 790.0, 90.0, 220.0];
/// Ticks between two positions of the moving picture.
const STEP: usize = 80;
/// Seconds that are shown: two textures.
const SECONDS: f64 = 5.0;

/// What of a tick is drawn.
#[derive(serde::Deserialize)]
struct Tick {
    t_s: f64,
    angle_left_deg: f64,
    x_left: f64,
    label: String,
}

#[derive(serde::Deserialize)]
struct Decision {
    #[serde(rename = "decision")]
    class: String,
    posterior: f64,
    t_s: f64,
}

pub(super) fn picture() -> Result<String, Fault> {
    let path = top().join("scenes/textures.toml");
    let scene = variants::load(&path)?;
    let out = target().join("whisk");
    let mut run = workspace_program("host-sim");
    run.args(["--quiet", "run", "--no-plot"]).arg(path);
    run.args(["--set", &format!("duration_s={SECONDS}")]);
    output(run.arg("--out").arg(&out))?;
    let ticks: Vec<Tick> = rows(&out.join("trace.csv"))?;
    let decisions: Vec<Decision> = rows(&out.join("decisions.csv"))?;
    let obstacle = scene.plant.obstacle.as_ref();
    let obstacle = obstacle.and_then(|sides| sides.obstacle_deg.first().copied());
    let obstacle = obstacle.ok_or("scenes/textures.toml has no obstacle")?;
    Ok(drawn(&ticks, &decisions, obstacle))
}

fn rows<T: serde::de::DeserializeOwned>(path: &std::path::Path) -> Result<Vec<T>, Fault> {
    let wrong = |error: csv::Error| format!("{}: {error}", path.display());
    let mut table = csv::Reader::from_path(path).map_err(wrong)?;
    table.deserialize().collect::<Result<_, _>>().map_err(wrong)
}

/// A place so far from the base, at this angle: 0 to the left, 90 upwards.
fn at(deg: f64, length: f64) -> [f64; 2] {
    let (sine, cosine) = deg.to_radians().sin_cos();
    [BASE[0] - length * cosine, BASE[1] - length * sine]
}

/// A whisker whose base is turned so far, and whose tip cannot pass the obstacle.
fn shaft(deg: f64, obstacle: f64) -> String {
    let ([bx, by], [tx, ty]) = (at(deg, 0.6 * LENGTH), at(deg.min(obstacle), LENGTH));
    format!("M{} {}Q{bx:.1} {by:.1} {tx:.1} {ty:.1}", BASE[0], BASE[1])
}

/// Values that a thing takes at these times, without steps between: an attribute that jumps.
fn jumps(attribute: &str, values: &[(f64, &str)]) -> String {
    let [mut times, mut list] = [String::new(), String::new()];
    for (n, (t_s, value)) in values.iter().enumerate() {
        let separator = if n == 0 { "" } else { ";" };
        let _ = write!(times, "{separator}{:.4}", t_s / SECONDS);
        let _ = write!(list, "{separator}{value}");
    }
    format!(
        r#"<animate attributeName="{attribute}" calcMode="discrete" dur="{SECONDS}s" repeatCount="indefinite" keyTimes="{times}" values="{list}"/>"#
    )
}

/// A thing that is seen from one time to another.
fn seen(from: f64, to: f64) -> String {
    let mut values = vec![(0.0, "0"), (from, "1"), (to, "0")];
    if from <= 0.0 {
        values.remove(0);
    }
    values.retain(|(t_s, _)| *t_s < SECONDS);
    jumps("opacity", &values)
}

fn drawn(ticks: &[Tick], decisions: &[Decision], obstacle: f64) -> String {
    let [left, .., below] = CHART;
    let caption = below + 30.0;
    let parts = [
        surfaces(ticks, obstacle),
        whisker(ticks, obstacle),
        readings(ticks),
        named(decisions),
    ];
    let parts = parts.concat();
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 820 270" font-family="sans-serif" font-size="14">
<rect width="100%" height="100%" fill="white"/>
{parts}<text x="{left}" y="{caption}">{SECONDS} s of a simulated run of scenes/textures.toml, at its own pace</text>
</svg>
"#
    )
}

/// The surface, by its texture, which changes while the whisker is in the air.
fn surfaces(ticks: &[Tick], obstacle: f64) -> String {
    let [[x, y], [tip_x, tip_y]] = [0.88, 1.15].map(|part| at(obstacle + 3.0, part * LENGTH));
    let mut svg = String::new();
    let mut begun = 0.0;
    for (n, tick) in ticks.iter().enumerate() {
        let next = ticks.get(n + 1);
        if next.is_some_and(|next| next.label == tick.label) {
            continue;
        }
        let until = next.map_or(SECONDS, |next| next.t_s);
        let _ = writeln!(
            svg,
            r##"<g opacity="0">{}<line x1="{x:.1}" y1="{y:.1}" x2="{tip_x:.1}" y2="{tip_y:.1}" stroke="#8a6d3b" stroke-width="10"/><text x="{:.1}" y="{:.1}">{}</text></g>"##,
            seen(begun, until),
            tip_x + 14.0,
            tip_y + 20.0,
            tick.label
        );
        begun = until;
    }
    svg
}

/// The whisker, its motor, and a dot while it touches.
fn whisker(ticks: &[Tick], obstacle: f64) -> String {
    let shown = ticks.iter().step_by(STEP).chain(ticks.last());
    let shafts = shown.map(|tick| shaft(tick.angle_left_deg, obstacle));
    let shafts: Vec<String> = shafts.collect();
    let touches = |tick: &Tick| tick.angle_left_deg >= obstacle;
    let mut dots = vec![(0.0, "0")];
    for (before, after) in ticks.iter().zip(ticks.iter().skip(1)) {
        if touches(before) != touches(after) {
            dots.push((after.t_s, if touches(after) { "1" } else { "0" }));
        }
    }
    let ([x, y], [tip_x, tip_y]) = (BASE, at(obstacle, LENGTH));
    format!(
        r##"<path d="{}" fill="none" stroke="black" stroke-width="3" stroke-linecap="round"><animate attributeName="d" dur="{SECONDS}s" repeatCount="indefinite" values="{}"/></path>
<circle cx="{x}" cy="{y}" r="13" fill="#c8ced6" stroke="black"/>
<text x="{x}" y="{}" text-anchor="middle">motor and sensor</text>
<circle cx="{tip_x:.1}" cy="{tip_y:.1}" r="7" fill="#d9534f" opacity="0">{}</circle>
"##,
        shafts.first().map_or("", String::as_str),
        shafts.join(";"),
        y + 30.0,
        jumps("opacity", &dots)
    )
}

/// What the sensor reads, the least and the most of each pixel; what is still to come is pale.
fn readings(ticks: &[Tick]) -> String {
    let [left, right, above, below] = CHART;
    let codes = ticks.iter().map(|tick| tick.x_left);
    let (least, most) = codes.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    let y_of = |x: f64| below - (below - above) * (x - least) / (most - least);
    let mut line = String::new();
    for column in ticks.chunks(ticks.len().div_ceil((right - left) as usize)) {
        let here = column.iter().map(|tick| y_of(tick.x_left));
        let (top, bottom) = here.fold((f64::MAX, f64::MIN), |(a, b), y| (a.min(y), b.max(y)));
        let first = if line.is_empty() { 'M' } else { 'L' };
        let x = x_of(column[0].t_s);
        let _ = write!(line, "{first}{x:.0} {top:.1}V{bottom:.1}");
    }
    let width = right - left;
    format!(
        r##"<text x="{left}" y="20">what the sensor reads (blue), and what the module decides (green)</text>
<path d="{line}" fill="none" stroke="#0050a0"/>
<rect x="{left}" y="{}" width="{width}" height="{}" fill="white" opacity="0.8"><animate attributeName="x" dur="{SECONDS}s" repeatCount="indefinite" values="{left};{right}"/><animate attributeName="width" dur="{SECONDS}s" repeatCount="indefinite" values="{width};0"/></rect>
"##,
        above - 10.0,
        below - above + 15.0
    )
}

fn x_of(t_s: f64) -> f64 {
    let [left, right, ..] = CHART;
    left + (right - left) * t_s / SECONDS
}

fn named(decisions: &[Decision]) -> String {
    let [left, _, above, _] = CHART;
    let mut svg = String::new();
    for (n, decision) in decisions.iter().enumerate() {
        let (class, t_s) = (&decision.class, decision.t_s);
        let until = decisions.get(n + 1).map_or(SECONDS, |next| next.t_s);
        let says = match class.as_str() {
            "unknown" => class.clone(),
            _ => format!("{class}, {:.1} % sure", 100.0 * decision.posterior),
        };
        let _ = writeln!(
            svg,
            r##"<circle cx="{:.1}" cy="{}" r="4" fill="#2e8b57" opacity="0">{}</circle>
<text x="{left}" y="55" font-size="20" fill="#2e8b57" opacity="0">{says}{}</text>"##,
            x_of(t_s),
            above - 15.0,
            seen(t_s, SECONDS),
            seen(t_s, until)
        );
    }
    svg
}
