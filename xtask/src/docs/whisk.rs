//! docs/whisk.svg: a run of the simulator, moving: the whisker, what its sensor reads, and what it
//! decides. Angles, readings and decisions are the run's; between base and tip the bend is drawn.

use std::fmt::Write as _;

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
    decision: String,
    posterior: f64,
    t_s: f64,
}

/// Runs the scene and draws it.
pub(super) fn picture() -> Result<String, Fault> {
    let path = top().join("scenes/textures.toml");
    let scene = scene::Scene::load(&path).map_err(|error| error.to_string())?;
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
    let [left, right, above, below] = CHART;
    let x_of = |t_s: f64| left + (right - left) * t_s / SECONDS;
    let mut svg = String::from(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 820 270" font-family="sans-serif" font-size="14">
<rect width="100%" height="100%" fill="white"/>
"##,
    );
    // The surface, by its texture, which changes in the air.
    let [from, to] = [
        at(obstacle + 3.0, 0.72 * LENGTH),
        at(obstacle + 3.0, 1.1 * LENGTH),
    ];
    let mut begun = 0.0;
    for (n, tick) in ticks.iter().enumerate() {
        let next = ticks.get(n + 1);
        if next.is_some_and(|next| next.label == tick.label) {
            continue;
        }
        let until = next.map_or(SECONDS, |next| next.t_s);
        let (label, show) = (&tick.label, seen(begun, until));
        let _ = writeln!(
            svg,
            r##"<g opacity="0">{show}<line x1="{:.1}" y1="{:.1}" x2="{:.1}" y2="{:.1}" stroke="#8a6d3b" stroke-width="10"/><text x="{:.1}" y="{:.1}">{label}</text></g>"##,
            from[0],
            from[1],
            to[0],
            to[1],
            to[0] + 14.0,
            to[1] + 20.0
        );
        begun = until;
    }
    // The whisker, its motor, and a dot while it touches.
    let positions: Vec<String> = ticks
        .iter()
        .step_by(STEP)
        .chain(ticks.last())
        .map(|tick| shaft(tick.angle_left_deg, obstacle))
        .collect();
    let _ = writeln!(
        svg,
        r##"<path d="{}" fill="none" stroke="black" stroke-width="3" stroke-linecap="round"><animate attributeName="d" dur="{SECONDS}s" repeatCount="indefinite" values="{}"/></path>
<circle cx="{}" cy="{}" r="13" fill="#c8ced6" stroke="black"/>
<text x="{}" y="{}" text-anchor="middle">motor and sensor</text>"##,
        positions[0],
        positions.join(";"),
        BASE[0],
        BASE[1],
        BASE[0],
        BASE[1] + 30.0
    );
    let mut touches = vec![(0.0, "0")];
    for pair in ticks.windows(2) {
        let [before, after] = pair else { continue };
        let touches_it = |tick: &Tick| tick.angle_left_deg >= obstacle;
        if touches_it(before) != touches_it(after) {
            touches.push((after.t_s, if touches_it(after) { "1" } else { "0" }));
        }
    }
    let tip = at(obstacle, LENGTH);
    let _ = writeln!(
        svg,
        r##"<circle cx="{:.1}" cy="{:.1}" r="7" fill="#d9534f" opacity="0">{}</circle>"##,
        tip[0],
        tip[1],
        jumps("opacity", &touches)
    );
    // What the sensor reads, the least and the most of each pixel.
    let codes = || ticks.iter().map(|tick| tick.x_left);
    let (least, most) = codes().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    let y_of = |x: f64| below - (below - above) * (x - least) / (most - least);
    let mut line = String::new();
    let columns = (right - left) as usize;
    for column in ticks.chunks(ticks.len().div_ceil(columns)) {
        let here = || column.iter().map(|tick| y_of(tick.x_left));
        let (top, bottom) = here().fold((f64::MAX, f64::MIN), |(a, b), y| (a.min(y), b.max(y)));
        let first = if line.is_empty() { 'M' } else { 'L' };
        let _ = write!(
            line,
            "{first}{:.0} {top:.1}V{bottom:.1}",
            x_of(column[0].t_s)
        );
    }
    let _ = writeln!(
        svg,
        r##"<text x="{left}" y="20">what the sensor reads (blue), and what the module decides (green)</text>
<path d="{line}" fill="none" stroke="#0050a0"/>
<rect x="{left}" y="{:.0}" width="{:.0}" height="{:.0}" fill="white" opacity="0.8"><animate attributeName="x" dur="{SECONDS}s" repeatCount="indefinite" values="{left};{right}"/><animate attributeName="width" dur="{SECONDS}s" repeatCount="indefinite" values="{:.0};0"/></rect>"##,
        above - 10.0,
        right - left,
        below - above + 15.0,
        right - left
    );
    for (n, decision) in decisions.iter().enumerate() {
        let (x, y) = (x_of(decision.t_s), above - 15.0);
        let until = decisions.get(n + 1).map_or(SECONDS, |next| next.t_s);
        let Decision { decision: name, .. } = decision;
        let says = match name.as_str() {
            "unknown" => name.clone(),
            _ => format!("{name}, {:.1} % sure", 100.0 * decision.posterior),
        };
        let _ = writeln!(
            svg,
            r##"<circle cx="{x:.1}" cy="{y}" r="4" fill="#2e8b57" opacity="0">{}</circle>
<text x="{left}" y="55" font-size="20" fill="#2e8b57" opacity="0">{says}{}</text>"##,
            seen(decision.t_s, SECONDS),
            seen(decision.t_s, until)
        );
    }
    let _ = writeln!(
        svg,
        r##"<text x="{left}" y="{}">{SECONDS} s of a simulated run of scenes/textures.toml, at its own pace</text>
</svg>"##,
        below + 30.0
    );
    svg
}
