//! What a part of the program costs a tick.

use std::path::Path;

use firmware::boards::BoardFacts;
use host_sim::Error;
use scene::Scene;
use wire::Command;

use crate::deployment::{flashed, flashed_for};
use crate::program::Program;
use crate::session::Session;
use crate::talk::wrong;

/// For how long each program is measured, s.
const MEASURED_S: f64 = 1.0;

/// Who has asked for records.
#[derive(Clone, Copy)]
pub(crate) enum Asks {
    Nothing,
    Probe,
    /// A probe that then fetches none.
    ProbeInVain,
    Serial,
}

/// What is compared: what is asked of a program with the part, and of one without it, and how many
/// instructions a tick the first may take more.
pub(crate) type Price = (&'static str, [Asks; 2], f64);

/// The scene in `path` as its program with the part runs it, and `without`, by what changes the
/// scene for that.
pub(crate) fn cost(
    path: &Path,
    [program, without]: [&Path; 2],
    silence: impl FnOnce(&mut Scene),
    prices: impl FnOnce(&Scene, &BoardFacts) -> Vec<Price>,
) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    loaded.scene.duration_s = MEASURED_S;
    let mut silent = loaded.clone();
    silence(&mut silent.scene);
    let programs = [&program, &flashed_for(&silent, without)?];
    let scene = &loaded.scene;
    let mut said = Vec::new();
    for (what, asks, most) in prices(scene, program.model()?.facts) {
        let [with, without] = [0, 1].map(|n| mean(scene, programs[n], asks[n]));
        let (with, without) = (with?, without?);
        let more = with - without;
        said.push(format!(
            "{what}: {more:.1} instructions a tick beside {without:.1}"
        ));
        if more > most {
            let said = said.join("\n");
            return wrong(format!("{said}\nat most {most} are allowed"));
        }
    }
    Ok(said)
}

fn mean(scene: &Scene, program: &Program, asks: Asks) -> Result<f64, Error> {
    let mut session = Session::running(scene, Vec::new(), program)?;
    if let Asks::Serial = asks {
        session = session.by_serial();
    }
    if !matches!(asks, Asks::Nothing) {
        session.send(Command::Stream(true))?;
    }
    for _ in 0..session.run.ticks() {
        session.tick()?;
        drop(session.log());
        if !matches!(asks, Asks::ProbeInVain) {
            session.packets()?;
        }
    }
    Ok(session.board_mut().meter.tick.mean())
}
