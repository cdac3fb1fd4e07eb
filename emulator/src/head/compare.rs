//! A head of emulated boards beside that of the simulator, and beside one simulated board.

use std::path::Path;

use host_sim::Error;
use host_sim::decisions::Decided;
use host_sim::run::Run;

use crate::chip::SIDE_NAMES;
use crate::compare::{difference, same_numbers};
use crate::deployment::flashed;
use crate::emulate::pwm_counts;

/// The head on the PC and on boards, in their number format: every number of every row of the
/// trace and every decision must be the same, to the last bit. The crystals of every other board
/// are by `ppm` millionths faster, those between as much slower.
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
    let classifier = loaded.classifier()?;
    let feels = same_numbers(&mut loaded, classifier.as_ref(), model.facts)?;
    let scene = &loaded.scene;
    let pwm = pwm_counts(scene, model);
    let mut host = Run::with_pwm(scene, classifier.clone(), pwm)?;
    let mut boards = super::start(scene, bus, host.classes().to_vec(), (&program, ppm))?;
    let mut alone = scene.clone();
    alone.head.nodes = None;
    let mut alone = Run::with_pwm(&alone, classifier, pwm)?;

    let named = |fault: String| Error::Work(format!("{}: {fault}", path.display()));
    let (mut most, mut decisions) = ([[f64::NAN; 2]; 3], 0);
    for n in 1..=host.ticks() {
        let (mut expected, mut found) = (host.tick(), boards.tick());
        boards.module_mut().check()?;
        if !feels {
            (expected.contact, found.contact) = ([0.0; 2], [0.0; 2]);
        }
        if scene.classifier.is_none() {
            expected.touch = [0; 2];
        }
        if let Some(column) = difference(&expected, &found) {
            return Err(named(format!(
                "tick {n}: {column} in the simulated head, in that of boards\n  {expected:?}\n  \
                 {found:?}"
            )));
        }
        let (decided, found): (Vec<Decided>, Vec<Decided>) =
            (host.decisions().collect(), boards.decisions().collect());
        if decided != found {
            return Err(named(format!(
                "tick {n}: decided in the simulated head, in that of boards\n  {decided:?}\n  \
                 {found:?}"
            )));
        }
        decisions += found.len();
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
    let load = boards.module_mut().load();
    let mut lines = vec![format!(
        "{}: {} boards, crystals ±{ppm} ppm, and the simulated head agree to the last bit in {} \
         ticks, {decisions} decisions; {load}",
        path.display(),
        bus.nodes,
        host.ticks()
    )];
    let names = ["boards", "simulated head", "one simulated board"];
    lines.extend(names.into_iter().zip(most).map(|(name, most)| {
        let of_side = |(side, theta): (&str, f64)| format!("{side} {theta:.2}");
        let sides = SIDE_NAMES.into_iter().zip(most);
        let sides: Vec<String> = sides
            .filter(|(_, theta)| !theta.is_nan())
            .map(of_side)
            .collect();
        format!("{name}: largest θ′ {} degrees", sides.join(", "))
    }));
    Ok(lines)
}
