//! What both sides do in some scenes, from the emulated board, as a picture.

use std::path::Path;

use host_sim::Error;
use host_sim::plot::{Panel, sides};

use crate::deployment::flashed;
use crate::scenario::Several;
use crate::session::Session;

/// Runs each scene on the board that the program beside it was built for, and draws them one
/// below the other: an SVG document.
pub(crate) fn picture(Several { scenes, program }: &Several) -> Result<String, Error> {
    if scenes.len() != program.len() {
        return Err(Error::Input("each scene needs its program".to_owned()));
    }
    let panels = scenes.iter().zip(program);
    let panels = panels.map(|(scene, program)| panel(scene, program));
    sides(&panels.collect::<Result<Vec<_>, Error>>()?)
}

fn panel(path: &Path, program: &Path) -> Result<Panel, Error> {
    let (loaded, program) = flashed(path, program)?;
    let scene = &loaded.scene;
    let obstacle = scene.plant.obstacle.as_ref();
    let Some(&[left, right]) = obstacle.map(|obstacle| obstacle.obstacle_deg.as_slice()) else {
        let reason = "plant.obstacle_deg: found none for each of two sides; the picture shows both";
        return Err(Error::file(path, reason));
    };
    let mut session = Session::running(scene, loaded.classes()?, &program)?;
    let mut rows = Vec::new();
    for _ in 0..session.run.ticks() {
        session.tick()?;
        rows.push(*session.run.row());
    }
    let on = |part: bool| if part { "with" } else { "without" };
    let (rcp, cia) = (on(scene.rcp.is_some()), on(scene.cia.is_some()));
    let title = format!("{}: {rcp} RCP, {cia} CIA", scene.name);
    Ok(Panel {
        title,
        rows,
        obstacle_deg: [left, right],
    })
}
