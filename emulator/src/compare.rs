//! host-sim and the emulated board side by side, tick by tick.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use clap::ValueEnum;
use config::AnyConfig;
use firmware::boards::BoardFacts;
use firmware::{Event, EventRecord, Packet};
use host_sim::Error;
use host_sim::classifier::Classifier;
use host_sim::decisions::Decided;
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use host_sim::trace::Row;
use scene::Numbers;
use wire::{Flags, TickRecord};

use crate::counters::Started;
use crate::deployment::image;
use crate::emulate::pwm_counts;
use crate::program::Program;
use crate::session::Session;

/// By how much the mean period of the ticks may be off: the tick rates that no
/// divider makes exactly are met within 2e-5.
const PERIOD_ERROR: f64 = 3e-5;

/// Who fetches the log from the board.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum Probe {
    /// A probe, all the time
    #[default]
    Attached,
    /// No probe; the log's ring is full after half a second
    Absent,
    /// A probe that has asked the program to wait for it where the ring is full, as
    /// probe-rs does, and is then pulled: after half a second, with the ring full
    Pulled,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Circumstances {
    pub probe: Probe,
    /// Whether every counter that wraps starts just below its wrap, and must pass it.
    pub wraps: bool,
}

/// After what time of the scene the ring is full, s: early enough for short scenes, and
/// after the lines of the start.
const GONE_AFTER_S: f64 = 0.5;

pub(crate) type Seen = (Row, Vec<Decided>);

/// A scene on the PC, in the board's number format, and on the board.
pub(crate) struct Pair {
    pub(crate) host: Run,
    pub(crate) target: Session,
    pub(crate) feels: bool,
    classifies: bool,
}

impl Pair {
    /// Both before their first tick; the scene gets the board's number format.
    pub(crate) fn new(loaded: &mut Loaded, program: &Program) -> Result<Self, Error> {
        let model = program.model()?;
        let feels = same_numbers(loaded, model.facts)?;
        let scene = &loaded.scene;
        let host = Run::with_pwm(scene, loaded.classifier()?, pwm_counts(scene, model))?;
        let target = Session::running(scene, host.classes().to_vec(), program)?;
        Ok(Self {
            host,
            target,
            feels,
            classifies: scene.classifier.is_some(),
        })
    }

    pub(crate) fn tick_board(&mut self) -> Result<Seen, Error> {
        self.target.tick()?;
        let run = &self.target.run;
        Ok((*run.row(), run.decisions().collect()))
    }

    /// The PC makes the `n`-th tick, which must be as on the board, with the touches of the PC numbered
    /// as there; how many decisions fell.
    pub(crate) fn follow(
        &mut self,
        n: u64,
        found: Seen,
        touch: impl Fn(u16) -> u16,
    ) -> Result<u64, Error> {
        let mut expected = self.host.tick();
        expected.touch = if self.classifies {
            expected.touch.map(&touch)
        } else {
            [0; 2]
        };
        let mut decided: Vec<Decided> = self.host.decisions().collect();
        for decided in &mut decided {
            decided.touch = touch(decided.touch);
        }
        let places = "on the PC, on the board";
        let decisions = same_tick(n, places, self.feels, [(expected, decided), found]);
        decisions.map_err(Error::Work)
    }

    /// The records and events of each tick, as far as PC and board must agree about them: the
    /// lower bits of a word are no measurement, contact that nothing uses is not computed, and
    /// some events are the board's own.
    pub(crate) fn by_tick(&self, packets: &[Packet]) -> BTreeMap<u32, Vec<Packet>> {
        let mut ticks = BTreeMap::<u32, Vec<Packet>>::new();
        for packet in packets {
            let (tick, plain) = match packet {
                Packet::Record(record) => {
                    (record.sequence, Packet::Record(plain(record, self.feels)))
                }
                Packet::Event(EventRecord { sequence, event }) => match event {
                    Event::Armed | Event::Stopped | Event::Health(_) | Event::Limit(_) => continue,
                    _ => (*sequence, *packet),
                },
                Packet::Answer(_) => continue,
            };
            ticks.entry(tick).or_default().push(plain);
        }
        ticks
    }
}

/// A tick in two places must be the same, contact only where the scene `feels` it; how many
/// decisions fell.
pub(crate) fn same_tick(
    n: u64,
    places: &str,
    feels: bool,
    mut seen: [Seen; 2],
) -> Result<u64, String> {
    if !feels {
        for (row, _) in &mut seen {
            row.contact = [0.0; 2];
        }
    }
    let [(expected, decided), (found, found_decided)] = &seen;
    if let Some(column) = difference(expected, found) {
        return Err(format!(
            "tick {n}: {column} {places}\n  {expected:?}\n  {found:?}"
        ));
    }
    if decided != found_decided {
        return Err(format!(
            "tick {n}: decided {places}\n  {decided:?}\n  {found_decided:?}"
        ));
    }
    Ok(decided.len() as u64)
}

/// What PC and board must agree about of a record.
pub(crate) fn plain(record: &TickRecord, feels: bool) -> TickRecord {
    TickRecord {
        x: record.codes()[0],
        y: record.codes()[1],
        contact: if feels { record.contact } else { 0 },
        flags: record.flags.without(Flags::LOST),
        ..*record
    }
}

/// Gives a scene the number format of a board; whether it uses contact.
pub(crate) fn same_numbers(loaded: &mut Loaded, facts: &BoardFacts) -> Result<bool, Error> {
    let classifier = loaded.classifier()?;
    let touch = classifier.as_ref().and_then(Classifier::touch_rule);
    let least = config::contact_min(&loaded.scene, touch.map(|touch| touch.gate));
    let listens = matches!(least, Ok(Some(_)));
    let feels = matches!(config::contact::<f32>(&loaded.scene, listens), Ok(Some(_)));
    let format = image(&loaded.scene, loaded.model(), facts)?.config;
    if let Some(whisking) = &mut loaded.scene.whisking {
        whisking.numbers = match format {
            AnyConfig::Single(_) => Numbers::Single,
            AnyConfig::Fixed(_) => Numbers::Fixed,
        };
    }
    Ok(feels)
}

/// What was compared, and found equal to the last bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Agreement {
    pub ticks: u64,
    pub decisions: u64,
    /// Touches of the first whisker.
    pub touches: u64,
    /// The most bytes that the board's stack has held.
    pub stack: u32,
    pub missed: u32,
    pub wrapped: usize,
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (ticks, decisions) = (self.ticks, self.decisions);
        write!(
            f,
            "PC and board agree to the last bit in {ticks} ticks, {decisions} decisions"
        )
    }
}

/// Runs the scene that messages call `path` on the PC, in the board's number format, and on the
/// board under these circumstances; every number of every row of the trace and every decision
/// must be the same, to the last bit, but that touches may be numbered from elsewhere. The
/// board's ticks must come at the scene's rate.
///
/// Contact is compared where the scene uses it: host-sim's trace shows it wherever there is an
/// obstacle, the board computes it only for RCP, CIA or a classifier that listens during contact.
pub(crate) fn compare(
    mut loaded: Loaded,
    path: &Path,
    program: &Program,
    circumstances: Circumstances,
) -> Result<Agreement, Error> {
    let probe = circumstances.probe;
    let mut pair = Pair::new(&mut loaded, program)?;
    let scene = &loaded.scene;
    let named = |fault: &dyn std::fmt::Display| Error::Work(format!("{}: {fault}", path.display()));

    let board = pair.target.board_mut();
    let started = circumstances.wraps;
    let started = started.then(|| Started::new(program, board, scene));
    let mut started = started.transpose()?;
    if probe == Probe::Pulled {
        board.attach_reader()?;
    }
    let gone_at = match probe {
        Probe::Attached => None,
        Probe::Absent | Probe::Pulled => Some((GONE_AFTER_S * f64::from(scene.tick_hz)) as u64),
    };

    let mut agreement = Agreement::default();
    for n in 1..=pair.host.ticks() {
        if gone_at == Some(n) {
            pair.target.board_mut().lose_reader()?;
        }
        let started_at = started.as_ref();
        let touch = |number| started_at.map_or(number, |started| started.touch(number));
        let seen = pair.tick_board();
        let decisions = seen.and_then(|seen| pair.follow(n, seen, touch));
        let decisions = decisions.map_err(|fault| named(&fault))?;
        agreement.decisions += decisions;
        agreement.ticks = n;
        agreement.touches = agreement.touches.max(pair.host.row().touch[0].into());
        if let Some(started) = &mut started {
            started.look(pair.target.board_mut())?;
        }
    }
    let board = pair.target.board_mut();
    let period = board.meter.period.mean() * 1e-12 * f64::from(scene.tick_hz);
    // One tick has no period.
    if agreement.ticks > 1 && (period - 1.0).abs() > PERIOD_ERROR {
        let fault = format!("a tick lasts {period} times as long as it should");
        return Err(named(&fault));
    }
    agreement.stack = board.machine.stack_used()?;
    agreement.missed = board.missed()?;
    if let Some(started) = started {
        agreement.wrapped = started.wrapped().map_err(|left| named(&left))?;
    }
    Ok(agreement)
}

/// The first column whose bits differ; one that is not a number equals another.
fn difference(a: &Row, b: &Row) -> Option<&'static str> {
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    if !same(a.t_s, b.t_s) {
        return Some("t");
    }
    if a.touch != b.touch {
        return Some("touch");
    }
    let columns = ["theta", "z", "g", "contact", "angle", "x", "y"];
    let pairs = a.pairs().into_iter().zip(b.pairs()).zip(columns);
    let mut different = pairs.filter(|((a, b), _)| !(same(a[0], b[0]) && same(a[1], b[1])));
    different.next().map(|(_, column)| column)
}

#[cfg(test)]
mod tests {
    use super::{Row, difference};

    #[test]
    fn one_bit_is_a_difference_and_what_is_absent_is_none() {
        let row = Row {
            theta_deg: [50.0, f64::NAN],
            y: [8191.0, f64::NAN],
            ..Row::default()
        };
        assert_eq!(difference(&row, &row), None);
        let mut other = row;
        other.theta_deg[0] = f64::from_bits(50.0_f64.to_bits() + 1);
        assert_eq!(difference(&row, &other), Some("theta"));
        let mut other = row;
        other.y[1] = 0.0;
        assert_eq!(difference(&row, &other), Some("y"));
        let mut other = row;
        other.contact[0] = -0.0;
        assert_eq!(difference(&row, &other), Some("contact"));
    }
}
