//! What the serial port costs a tick: nothing.

use std::path::Path;

use host_sim::Error;
use scene::Scene;
use wire::{Command, TaggedCommand};

use super::talk::wrong;
use crate::deployment::{flashed, flashed_for};
use crate::emulate::start;
use crate::program::Program;

/// For how long each program is measured, s.
const MEASURED_S: f64 = 1.0;

/// By how many instructions a tick may be longer: what the compiler does otherwise where
/// another part of the program differs.
const MORE: f64 = 2.0;

/// Mean instructions of the tick's handler with the serial port and without it, and with
/// records that go there and that go to a probe: the first of each pair must be the second.
pub(super) fn cost(path: &Path, program: &Path, without: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let scene = &mut loaded.scene;
    scene.duration_s = MEASURED_S;
    let mut silent = scene.clone();
    silent.telemetry.serial_baud = None;
    let without = &flashed_for(&silent, path, without)?;
    let (scene, program) = (&loaded.scene, &program);
    let quiet = [program, without].map(|program| mean(scene, program, Reader::Nobody));
    let streaming = [(program, Reader::Serial), (without, Reader::Probe)];
    let streaming = streaming.map(|(program, reader)| mean(scene, program, reader));
    let mut said = Vec::new();
    for (what, [with, without]) in [("", quiet), (" with records", streaming)] {
        let (with, without) = (with?, without?);
        said.push(format!(
            "a tick{what}: {with:.1} instructions, without a serial port {without:.1}"
        ));
        if with > without + MORE {
            return wrong(format!(
                "{}; at most {MORE} more are allowed",
                said.join("\n")
            ));
        }
    }
    Ok(said)
}

/// Who has asked for records.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reader {
    Nobody,
    Probe,
    Serial,
}

fn mean(scene: &Scene, program: &Program, reader: Reader) -> Result<f64, Error> {
    let mut run = start(scene, Vec::new(), program)?;
    let command = Command::Stream(true);
    let request = TaggedCommand { tag: 1, command };
    let board = &mut run.module_mut().board;
    match reader {
        Reader::Nobody => {}
        Reader::Probe => _ = board.request(&wire::frame(&request))?,
        Reader::Serial => board.serial_write(&wire::frame(&request)),
    }
    for _ in 0..run.ticks() {
        run.tick();
        let emulated = run.module_mut();
        emulated.check()?;
        drop(emulated.take_log());
        drop(emulated.board.serial_read());
        if reader == Reader::Probe {
            emulated.board.packets()?;
        }
    }
    Ok(run.module_mut().meter.figures.tick.mean())
}
