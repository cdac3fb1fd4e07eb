//! What a part of the program costs a tick.

use host_sim::Error;
use scene::Scene;
use wire::Command;

use crate::program::Program;
use crate::session::Session;

/// For how long each program is measured, s.
pub(crate) const MEASURED_S: f64 = 1.0;

/// Who has asked for records.
#[derive(Clone, Copy)]
pub(crate) enum Asks {
    Nothing,
    Probe,
    /// A probe that then fetches none.
    ProbeInVain,
    Serial,
}

/// What is compared: a program with the part, one without it, and how many instructions a tick
/// the first may take more.
pub(crate) struct Price<'p> {
    pub(crate) what: &'static str,
    pub(crate) with: (&'p Program, Asks),
    pub(crate) without: (&'p Program, Asks),
    pub(crate) most: f64,
}

pub(crate) fn cost(scene: &Scene, prices: &[Price<'_>]) -> Result<Vec<String>, Error> {
    let mut said = Vec::new();
    for price in prices {
        let [with, without] = [price.with, price.without].map(|of| mean(scene, of));
        let (with, without) = (with?, without?);
        let more = with - without;
        said.push(format!(
            "{}: {more:.1} instructions a tick beside {without:.1}",
            price.what
        ));
        if more > price.most {
            let said = said.join("\n");
            return Err(Error::Work(format!(
                "{said}\nat most {} are allowed",
                price.most
            )));
        }
    }
    Ok(said)
}

fn mean(scene: &Scene, (program, asks): (&Program, Asks)) -> Result<f64, Error> {
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
    Ok(session.board_mut().meter.figures.tick.mean())
}
