//! The same of a head: what befalls its boards and the bus between them, and what becomes of each.

use firmware::BusConfig;
use host_sim::Error;
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use scene::Scene;
use serde::Serialize;
use wire::{Command, TaggedCommand};

use super::file::{Event, Scenario, What};
use super::said::{Listed, Lister};
use crate::chip::{Fault, ResetCause};
use crate::head::{self, Head};
use crate::program::Program;
use crate::watch::Servos;

/// Phases that differ by no more than this are the same, degrees.
const SAME_DEG: f64 = 1.0;

/// What became of a run; docs/boards.md has each key.
#[derive(Debug, Serialize)]
pub(super) struct Outcome {
    ran_s: f64,
    largest_step_deg: f64,
    relocked_s: f64,
    stop_to_off_ticks: u64,
    armed_at_end: bool,
    nodes: Vec<OfNode>,
}

#[derive(Debug, Default, Serialize)]
struct OfNode {
    ticks: u64,
    resets: u64,
    driven_s: f64,
    armed_s: f64,
    armed_at_end: bool,
    largest_step_deg: f64,
    joined_s: f64,
    leaves: u64,
    unused_messages: u32,
    is_overrun: bool,
    bus_offs: u64,
    longest_off_s: f64,
    most_transmit_errors: u16,
    most_receive_errors: u16,
    errors_at_end: [u16; 2],
    events: Vec<Listed>,
}

/// What is known of a board as the last tick ended.
#[derive(Default)]
struct Seen {
    lister: Lister,
    theta_deg: Vec<f64>,
    is_armed: bool,
    is_joined: bool,
    phase_deg: Option<f64>,
    /// For how many ticks errors have switched it off the bus.
    off: u64,
}

struct Stop {
    node: usize,
    /// In ticks of the run; none: its last byte has not come.
    arrived: Option<u64>,
}

pub(super) fn run(
    loaded: &Loaded,
    bus: BusConfig,
    program: &Program,
    scenario: &Scenario,
) -> Result<Outcome, Error> {
    let scene = &loaded.scene;
    let mut run = head::start(scene, bus, loaded.classes()?, (program, 0))?;
    let servos = Servos::new(program, scene)?;
    let mut figures = Figures::new(scene, bus.nodes);
    let head = run.module_mut();
    head.bear();
    for node in &mut head.nodes {
        let baud = scene.telemetry.serial_baud;
        node.board.machine.chip().attach_serial(baud);
    }
    let mut lasted = vec![false; scenario.events.len()];
    for _ in 0..run.ticks() {
        let t_s = run.t_s();
        let head = run.module_mut();
        for (event, lasted) in scenario.events.iter().zip(&mut lasted) {
            let lasts = event.lasts(t_s);
            if lasts != std::mem::replace(lasted, lasts) {
                // What another of its kind still does goes on.
                let others = scenario.events.iter();
                let others = others.filter(|other| other.goes_on(event, t_s));
                if let Some(other) = others.max_by(|a, b| a.at_s.total_cmp(&b.at_s)) {
                    let last = if lasts { event } else { other };
                    if let What::BusNoise { .. } = last.what {
                        befall(head, last, true)?;
                    }
                    continue;
                }
                figures.stops.extend(befall(head, event, lasts)?);
            }
        }
        run.tick();
        run.module_mut().check()?;
        figures.look(&mut run, &servos)?;
    }
    let returned = scenario.events.iter().map(|event| match event.what {
        What::Serial { .. } | What::Probe { .. } => 0.0,
        _ => event.until_s.unwrap_or(event.at_s),
    });
    Ok(figures.outcome(returned.fold(0.0, f64::max)))
}

/// An event begins or ends; the stop that it sends.
fn befall(head: &mut Head, event: &Event, begins: bool) -> Result<Option<Stop>, Fault> {
    let node = usize::from(event.node.unwrap_or(0));
    match &event.what {
        What::PowerOff => head.strike(node, |board| board.set_power(!begins))?,
        What::Reset if begins => head.strike(node, |board| board.reset_now(ResetCause::Pin))?,
        What::Jumpers { number } if begins => head.strike(node, |board| {
            board.machine.chip().set_number(*number);
            board.reset_now(ResetCause::Pin)
        })?,
        What::BusCut => head.cut(node, begins),
        What::BusNoise { share } => {
            let share = if begins { *share } else { 0.0 };
            match event.node {
                Some(_) => head.disturb(node, share),
                None => (0..head.nodes.len()).for_each(|node| head.disturb(node, share)),
            }
        }
        What::Serial { text } if begins => {
            if let Some(node) = head.nodes.get_mut(node) {
                let mut chip = node.board.machine.disturbed();
                chip.serial_write(format!("{text}\n").as_bytes());
            }
            let arrived = None;
            return Ok((text.trim() == "stop").then_some(Stop { node, arrived }));
        }
        What::Probe { request } if begins => {
            let (tag, command) = (1, request.0);
            let request = TaggedCommand { tag, command };
            if let Some(node) = head.nodes.get_mut(node) {
                node.board.request(&wire::frame(&request))?;
            }
            let arrived = None;
            return Ok((command == Command::Stop).then_some(Stop { node, arrived }));
        }
        _ => {}
    }
    Ok(None)
}

#[derive(Default)]
struct Figures {
    tick_s: f64,
    ticks: u64,
    nodes: Vec<(Seen, OfNode)>,
    stops: Vec<Stop>,
    stop_to_off: u64,
    /// Until when phases were not the same, s.
    apart_s: f64,
}

impl Figures {
    fn new(scene: &Scene, nodes: u8) -> Self {
        Self {
            tick_s: 1.0 / f64::from(scene.tick_hz),
            nodes: (0..nodes).map(|_| Default::default()).collect(),
            ..Self::default()
        }
    }

    fn look(&mut self, run: &mut Run<Head>, servos: &Servos) -> Result<(), Error> {
        self.ticks += 1;
        let t_s = run.t_s();
        let head = run.module_mut();
        let mut may_drive = false;
        for (node, (seen, of_node)) in head.nodes.iter_mut().zip(&mut self.nodes) {
            let board = &mut node.board;
            let lines = board.lines();
            seen.lister.hear(t_s, &lines, board)?;
            let was_reset = board.reset.take().is_some();
            of_node.resets += u64::from(was_reset);
            if was_reset {
                seen.lister.list_reset(t_s);
            }
            of_node.ticks += u64::from(node.ended);
            let chip = board.machine.chip();
            of_node.is_overrun = chip.can.overrun;
            let (is_driven, errors) = (chip.drives_a_motor(), chip.can.errors);
            drop(chip);
            if is_driven {
                of_node.driven_s += self.tick_s;
            }
            of_node.bus_offs += u64::from(errors.is_off && seen.off == 0);
            seen.off = if errors.is_off { seen.off + 1 } else { 0 };
            of_node.longest_off_s = of_node.longest_off_s.max(seen.off as f64 * self.tick_s);
            of_node.errors_at_end = [errors.transmit, errors.receive];
            let [transmit, receive] = of_node.errors_at_end;
            of_node.most_transmit_errors = of_node.most_transmit_errors.max(transmit);
            of_node.most_receive_errors = of_node.most_receive_errors.max(receive);
            // While the chip starts its RAM says nothing.
            let is_up = node.ended > 0 && !was_reset;
            let was_armed = seen.is_armed;
            let memories = &board.machine.memories;
            seen.is_armed = is_up && servos.are_armed(memories)? == Some(true);
            seen.phase_deg = None;
            seen.is_joined &= !was_reset;
            if is_up {
                if let Some((is_joined, unused)) = servos.on_bus(memories)? {
                    of_node.leaves += u64::from(seen.is_joined && !is_joined);
                    (seen.is_joined, of_node.unused_messages) = (is_joined, unused);
                }
                seen.phase_deg = servos.phase_deg(memories)?;
                if was_armed && seen.is_armed {
                    let moved = node.snapshot.theta_deg.iter().zip(&seen.theta_deg);
                    let most = moved.fold(0.0_f64, |most, (now, was)| most.max((now - was).abs()));
                    let most = most / f64::from(node.ended);
                    of_node.largest_step_deg = of_node.largest_step_deg.max(most);
                }
                seen.theta_deg.clone_from(&node.snapshot.theta_deg);
            }
            if seen.is_joined && is_up {
                of_node.joined_s += self.tick_s;
            }
            if seen.is_armed {
                of_node.armed_s += self.tick_s;
            }
            of_node.armed_at_end = seen.is_armed;
            may_drive |= is_driven || seen.is_armed;
        }
        let mut phases = self.nodes.iter().filter_map(|(seen, _)| seen.phase_deg);
        let apart = |a: f64, b: f64| ((a - b + 540.0).rem_euclid(360.0) - 180.0).abs();
        if let Some(first) = phases.next()
            && phases.any(|phase| apart(phase, first) > SAME_DEG)
        {
            self.apart_s = t_s;
        }
        for stop in &mut self.stops {
            let node = head.nodes.get_mut(stop.node);
            let waits = node.map(|node| node.board.machine.chip().serial_waiting());
            if stop.arrived.is_none() && waits == Some(0) {
                stop.arrived = Some(self.ticks);
            }
            if let Some(arrived) = stop.arrived.filter(|_| may_drive) {
                self.stop_to_off = self.stop_to_off.max(self.ticks + 1 - arrived);
            }
        }
        if !may_drive {
            self.stops.retain(|stop| stop.arrived.is_none());
        }
        Ok(())
    }

    /// `returned_s`: when the last event was over.
    fn outcome(self, returned_s: f64) -> Outcome {
        let nodes = self.nodes.into_iter().map(|(seen, mut of_node)| {
            of_node.events = seen.lister.listed;
            of_node
        });
        let nodes: Vec<OfNode> = nodes.collect();
        let steps = nodes.iter().map(|node| node.largest_step_deg);
        Outcome {
            ran_s: self.ticks as f64 * self.tick_s,
            largest_step_deg: steps.fold(0.0, f64::max),
            relocked_s: (self.apart_s - returned_s).max(0.0),
            stop_to_off_ticks: self.stop_to_off,
            armed_at_end: nodes.iter().any(|node| node.armed_at_end),
            nodes,
        }
    }
}
