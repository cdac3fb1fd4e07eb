//! A head of emulated boards beside that of the simulator, and beside one simulated board.

use std::path::Path;

use firmware::Event;
use host_sim::bench::Bus;
use host_sim::run::Run;
use host_sim::{Error, report};

use super::{Head, US};
use crate::chip::SIDE_NAMES;
use crate::compare::{same_numbers, same_tick};
use crate::deployment::flashed;
use crate::emulate::pwm_counts;

/// A line of a log, if it says what became of a node.
fn of_node(line: &str) -> Option<String> {
    let (_, said) = line.split_once(" node ")?;
    Some(format!("node {said}"))
}

/// What a board of a simulated head has said of nodes.
fn expected(bus: Option<&Bus>, number: u8) -> Vec<String> {
    let happened = bus.map(Bus::happened).unwrap_or_default();
    let own = happened.iter().filter(|happened| happened.node == number);
    let said = own.filter_map(|happened| report::said(&Event::Node(number, happened.what), &[]));
    said.map(|(_, said)| said).collect()
}

fn cost(head: &Head, run_s: f64) -> String {
    let lengths = head.nodes.iter().map(|node| {
        let length = node.board.meter.length;
        [length.mean(), length.worst as f64].map(|time| time / US)
    });
    let longest = lengths
        .reduce(|[mean, worst], [of_mean, of_worst]| [mean.max(of_mean), worst.max(of_worst)]);
    let [mean_us, worst_us] = longest.unwrap_or_default();
    format!(
        "bus busy for {:.1} %; of the board that takes longest a tick takes {mean_us:.1} us in the \
         mean, {worst_us:.1} at most",
        100.0 * head.load().busy_s / run_s
    )
}

/// The head on the PC and on boards, in their number format: every number of every row of the
/// trace, every decision, and what each board says of the others must be the same, to the last bit.
/// The crystals of every other board are by `ppm` millionths faster, those between as much slower.
pub(crate) fn compare(
    path: &Path,
    program: &Path,
    duration_s: Option<f64>,
    ppm: i32,
) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let Some(bus) = config::bus(&loaded.scene) else {
        let fault = "head.nodes: found none; allowed: a head of several boards";
        return Err(Error::Input(format!("{}: {fault}", path.display())));
    };
    if let Some(duration_s) = duration_s {
        loaded.scene.duration_s = duration_s;
    }
    let model = program.model()?;
    let feels = same_numbers(&mut loaded, model.facts)?;
    let classifier = loaded.classifier()?;
    let scene = &loaded.scene;
    let pwm = pwm_counts(scene, model);
    let mut host = Run::with_pwm(scene, classifier.clone(), pwm)?;
    let mut boards = super::start(scene, bus, host.classes().to_vec(), (&program, ppm))?;
    let mut alone = scene.clone();
    alone.head.nodes = None;
    let mut alone = Run::with_pwm(&alone, classifier, pwm)?;

    let named = |fault: String| Error::Work(format!("{}: {fault}", path.display()));
    let mut logs = vec![Vec::new(); bus.nodes.into()];
    let (mut most, mut decisions) = ([[f64::NAN; 2]; 3], 0);
    for n in 1..=host.ticks() {
        let (mut expected, found) = (host.tick(), boards.tick());
        let head = boards.module_mut();
        head.check()?;
        for (node, said) in head.nodes.iter_mut().zip(&mut logs) {
            let lines = node.board.lines().into_iter();
            said.extend(lines.filter_map(|line| of_node(&line)));
        }
        if scene.classifier.is_none() {
            expected.touch = [0; 2];
        }
        let expected = (expected, host.decisions().collect());
        let found = (found, boards.decisions().collect());
        let places = "in the simulated head, in that of boards";
        decisions += same_tick(n, places, feels, [expected, found]).map_err(named)?;
        let alone = alone.tick();
        // Once all whisk.
        if n > host.ticks() / 3 {
            for (most, row) in most.iter_mut().zip([boards.row(), host.row(), &alone]) {
                for (most, theta) in most.iter_mut().zip(row.theta_deg) {
                    *most = most.max(theta);
                }
            }
        }
    }
    let mut reports = 0;
    for (number, mut found) in (0..).zip(logs) {
        let mut expected = expected(host.bus().as_deref(), number);
        // In which of two ticks a frame is heard depends on how soon a board has computed.
        found.sort();
        expected.sort();
        if expected != found {
            return Err(named(format!(
                "of its nodes the log of board {number} says {found:?}, in the simulated head \
                 {expected:?}"
            )));
        }
        reports += found.len();
    }
    let load = boards.module_mut().load();
    let mut lines = vec![format!(
        "{}: {} boards, crystals ±{ppm} ppm, and the simulated head agree to the last bit in {} \
         ticks, {decisions} decisions, {reports} reports of nodes; {load}",
        path.display(),
        bus.nodes,
        host.ticks()
    )];
    let run_s = boards.t_s();
    lines.push(cost(boards.module_mut(), run_s));
    let names = ["boards", "simulated head", "one simulated board"];
    lines.extend(names.into_iter().zip(most).map(|(name, most)| {
        let of_side = |(side, theta): (&str, f64)| format!("{side} {theta:.2}");
        let sides = SIDE_NAMES.into_iter().zip(most);
        let sides = sides.filter(|(_, theta)| !theta.is_nan());
        let sides: Vec<String> = sides.map(of_side).collect();
        format!("{name}: largest θ′ {} degrees", sides.join(", "))
    }));
    Ok(lines)
}
