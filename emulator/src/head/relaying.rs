//! A board of a head that is asked by way of another one.

use std::collections::HashMap;
use std::path::Path;

use firmware::{Packet, RELAYED_HZ, Relay};
use host_sim::Error;
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use scene::Scene;
use wire::{
    Answer, CONFIG_CHANGED, Command, CommandStatus, Flags, Looked, TaggedCommand, TickRecord,
    WhiskerId,
};

use super::HeadSession;
use crate::compare::{plain, same_numbers};
use crate::deployment::{Deployment, crc_of, flashed, staged, words};
use crate::emulate::pwm_counts;
use crate::program::Program;
use crate::session::{PATIENCE, answer_to};
use crate::talk::{records, wrong};

/// For how long records are compared, s.
const COMPARED_S: f64 = 0.5;

/// In how many ticks a stop takes effect on every board: that of the first, a message that waits
/// for one which is under way, and that of the other.
const STOPPED_TICKS: u32 = 4;

/// In how many ticks an arm takes effect: it waits for a stop that might be under way.
const ARMED_TICKS: u32 = 40;

struct Talk {
    session: HeadSession,
    /// The last board.
    far: u8,
    tag: u16,
    ticks: u32,
    records: Vec<TickRecord>,
}

impl Talk {
    fn tick(&mut self) -> Result<Vec<Packet>, Error> {
        self.session.tick()?;
        self.ticks += 1;
        let packets = self.session.packets()?;
        self.records.extend(records(&packets));
        Ok(packets)
    }

    fn ask(&mut self, node: u8, command: Command) -> Result<Answer, Error> {
        self.tag += 1;
        let tag = self.tag;
        let request = TaggedCommand { tag, command };
        if !self.session.request(Some(node), request)? {
            return wrong(format!("{command:?}: no room for it"));
        }
        for _ in 0..PATIENCE {
            if let Some(answer) = answer_to(tag, &self.tick()?) {
                return Ok(answer);
            }
        }
        wrong(format!("{command:?}: no answer from board {node}"))
    }

    fn must(&mut self, node: u8, command: Command, status: CommandStatus) -> Result<(), Error> {
        let found = self.ask(node, command)?.status;
        if found == status {
            return Ok(());
        }
        wrong(format!(
            "{command:?} to board {node}: found {found:?}, expected {status:?}"
        ))
    }

    fn done(&mut self, command: Command) -> Result<(), Error> {
        self.must(self.far, command, CommandStatus::Done)
    }

    fn runs_by(&mut self, node: u8) -> Result<[i32; 2], Error> {
        Ok(self.ask(node, Command::Scene)?.values)
    }
}

/// The scene that all run by, and how it is on boards.
struct Case<'p> {
    loaded: Loaded,
    program: &'p Program,
    runs: Deployment,
    feels: bool,
    /// Whiskers of a board.
    each: usize,
}

impl Case<'_> {
    /// The first whisker of a board.
    fn whisker(&self, node: u8) -> WhiskerId {
        let n = usize::from(node) * self.each;
        let of_side = self.loaded.scene.head.whiskers_per_side.max(1);
        WhiskerId {
            side: (n / of_side) as u8,
            number: (n % of_side) as u8,
        }
    }

    fn deployment(&self, change: impl FnOnce(&mut Scene)) -> Result<Deployment, Error> {
        let mut scene = self.loaded.scene.clone();
        change(&mut scene);
        Deployment::of(&scene, self.loaded.model(), self.program.model()?.facts)
    }
}

/// The last board of the head is asked by way of the first, which a probe is connected to: it must
/// say that it runs the scene, send records as the simulated head has them, take another
/// configuration and another scene, and stop. Returns what was seen, a line each.
pub(crate) fn relay(path: &Path, program: &Path) -> Result<Vec<String>, Error> {
    let (mut loaded, program) = flashed(path, program)?;
    let facts = program.model()?.facts;
    let feels = same_numbers(&mut loaded, facts)?;
    let Some(bus) = config::bus(&loaded.scene) else {
        return wrong(format!("{}: no head of several boards", path.display()));
    };
    let mut talk = Talk {
        session: HeadSession::of(&loaded.scene, &program)?,
        far: bus.nodes - 1,
        tag: 0,
        ticks: 0,
        records: Vec::new(),
    };
    let case = Case {
        runs: Deployment::of(&loaded.scene, loaded.model(), facts)?,
        each: loaded.scene.whiskers() / usize::from(bus.nodes),
        loaded,
        program: &program,
        feels,
    };
    let took = talk.says_its_scene(&case)?;
    talk.must(bus.nodes, Command::Hello, CommandStatus::NoBoard)?;
    talk.must(talk.far, Command::Restart, CommandStatus::NotHere)?;
    let [records, looks] = talk.same_records(&case)?;
    talk.takes_another_configuration(&case)?;
    talk.stops(&case)?;
    let deployed = talk.takes_another_scene(&case)?;
    talk.stops_while_it_loads(&case)?;
    Ok(vec![
        format!(
            "board {} answers board 0 in {took} ticks; as in the simulated head {records} records \
             and {looks} looks at a whisker",
            talk.far
        ),
        deployed,
    ])
}

impl Talk {
    /// In how many ticks it answers.
    fn says_its_scene(&mut self, case: &Case) -> Result<u32, Error> {
        let begun = self.ticks;
        let hello = self.ask(self.far, Command::Hello)?;
        let took = self.ticks - begun;
        if hello.values != [case.loaded.scene.tick_hz as i32, case.each as i32] {
            return wrong(format!("hello: {hello:?}"));
        }
        let config = &case.runs.config;
        for node in [self.far, 0] {
            if self.runs_by(node)? != [crc_of(config)?.cast_signed(), config.len() as i32] {
                return wrong(format!("board {node} runs by another scene"));
            }
        }
        for (at, two) in (0..).step_by(2).zip(words(config).chunks(2)) {
            let found = self.ask(self.far, Command::Config(at))?.values;
            if found.map(i32::cast_unsigned)[..two.len()] != *two {
                return wrong(format!("word {at} of its configuration: {found:?}"));
            }
        }
        Ok(took)
    }

    /// Records, and looks, each against the record of the same tick in the simulated head; how many.
    fn same_records(&mut self, case: &Case) -> Result<[usize; 2], Error> {
        let (loaded, feels) = (&case.loaded, case.feels);
        let scene = &loaded.scene;
        self.done(Command::Stream(true))?;
        let ticks = (COMPARED_S * f64::from(scene.tick_hz)) as u32;
        let looks = self.look_meanwhile(case.whisker(self.far), ticks)?;

        let pwm = pwm_counts(scene, case.program.model()?);
        let mut host = Run::with_pwm(scene, loaded.classifier()?, pwm)?;
        host.module_mut().talk_with(self.far.into());
        let command = Command::Stream(true);
        host.module_mut().request(TaggedCommand { tag: 1, command });
        let key = |record: &TickRecord| (record.sequence, record.flags.contains(Flags::RIGHT));
        let mut expected = HashMap::new();
        for _ in 0..self.ticks {
            host.tick();
            let packets = host.module_mut().take_packets();
            let records = records(&packets);
            expected.extend(records.map(|record| (key(record), plain(record, feels))));
        }
        let every = Relay::every(scene.tick_hz);
        for found in &self.records {
            let of_host = expected.get(&key(found));
            if of_host != Some(&plain(found, feels)) || !found.sequence.is_multiple_of(every) {
                return wrong(format!("{found:?}\n  in the simulated head {of_host:?}"));
            }
        }
        let is_right = case.whisker(self.far).side > 0;
        for (sequence, looked) in &looks {
            let of_host = expected.get(&(*sequence, is_right));
            let of_host = of_host.map(|record| Looked {
                measured: record.measured,
                contact: record.contact,
                flags: record.flags.without(Flags::DECIDED),
                ..*looked
            });
            let contact = if feels { looked.contact } else { 0 };
            let looked = Looked { contact, ..*looked };
            if of_host != Some(looked) {
                return wrong(format!(
                    "in tick {sequence} {looked:?}\n  in the simulated head {of_host:?}"
                ));
            }
        }
        let least = (COMPARED_S * f64::from(RELAYED_HZ)) as usize * case.each - 1;
        if self.records.len() < least {
            return wrong(format!("{} records, expected {least}", self.records.len()));
        }
        Ok([self.records.len(), looks.len()])
    }

    /// Looks at a whisker of the other board again and again, while records come from there.
    fn look_meanwhile(
        &mut self,
        whisker: WhiskerId,
        ticks: u32,
    ) -> Result<Vec<(u32, Looked)>, Error> {
        let mut looks = Vec::new();
        let end = self.ticks + ticks;
        while self.ticks < end {
            let answer = self.ask(self.far, Command::Look(whisker))?;
            if answer.status != CommandStatus::Done {
                return wrong(format!("{whisker:?}: {answer:?}"));
            }
            looks.push((answer.sequence, Looked::of(answer.values)));
        }
        Ok(looks)
    }

    fn takes_another_configuration(&mut self, case: &Case) -> Result<(), Error> {
        let tuned = case.deployment(|scene| {
            let gains = scene.whisking.iter_mut().flat_map(|of| &mut of.gain);
            gains.for_each(|gain| *gain *= 0.9);
        })?;
        let config = &tuned.config;
        staged(config).try_for_each(|command| self.done(command))?;
        let length = config.len() as i32 | CONFIG_CHANGED;
        if self.runs_by(self.far)? == [crc_of(config)?.cast_signed(), length] {
            return Ok(());
        }
        wrong("another configuration was taken, and does not run")
    }

    fn stops(&mut self, case: &Case) -> Result<(), Error> {
        let is_driven =
            |record: &TickRecord| record.flags.contains(Flags::ARMED) || record.duty != 0;
        if !self.records.last().is_some_and(is_driven) {
            return wrong("it is not driven before it is to stop");
        }
        self.done(Command::Stop)?;
        self.pass(STOPPED_TICKS)?;
        // Whoever names a board that there is not arms none.
        self.must(self.far + 1, Command::Arm, CommandStatus::NoBoard)?;
        self.records.clear();
        self.pass(3 * Relay::every(case.loaded.scene.tick_hz))?;
        if self.records.is_empty() || self.records.iter().any(is_driven) {
            return wrong(format!("after a stop: {:?}", self.records));
        }
        self.done(Command::Stream(false))
    }

    fn takes_another_scene(&mut self, case: &Case) -> Result<String, Error> {
        let other = case.deployment(|scene| scene.name.push_str("-2"))?;
        self.session.bear();
        let begun = self.ticks;
        self.done(Command::Load(other.load()))?;
        for (number, word) in other.words().enumerate() {
            let word = Command::Word(number as u8, word);
            self.done(word)?;
            if number == 0 {
                // Its answer was lost; and then one that is not next.
                self.done(word)?;
                let next = Command::Word(2, 0);
                self.must(self.far, next, CommandStatus::OutOfRange)?;
            }
        }
        self.done(Command::Restart)?;
        let tick_hz = f64::from(case.loaded.scene.tick_hz);
        let loaded_s = f64::from(self.ticks - begun) / tick_hz;
        // It does not answer before it has started.
        while self.ask(self.far, Command::Hello)?.status != CommandStatus::Done {
            if self.ticks - begun > 10 * PATIENCE {
                return wrong("it does not start again");
            }
        }
        for (node, runs) in [(self.far, &other), (0, &case.runs)] {
            if self.runs_by(node)?[0] != crc_of(&runs.config)?.cast_signed() {
                return wrong("the scene that was deployed is not the one that runs");
            }
        }
        let [_, missed] = self.ask(0, Command::Status)?.values;
        if missed != 0 {
            return wrong(format!("board 0 has missed {missed} ticks"));
        }
        Ok(format!(
            "another configuration and another scene taken, that of {} words in {loaded_s:.2} s; \
             board 0 has missed no tick",
            other.load().words()
        ))
    }

    /// The first board is asked to stop while it loads; the last was armed after that had begun.
    fn stops_while_it_loads(&mut self, case: &Case) -> Result<(), Error> {
        let other = case.deployment(|scene| scene.name.push_str("-2"))?;
        self.must(0, Command::Load(other.load()), CommandStatus::Done)?;
        self.session.ask_last(Command::Arm)?;
        self.pass(ARMED_TICKS)?;
        if !self.session.last_drives()? {
            return wrong("it is not driven before the loading board is to stop");
        }
        // It reads nothing that names a board.
        let command = Command::Stop;
        self.session
            .request(None, TaggedCommand { tag: 0, command })?;
        self.pass(STOPPED_TICKS)?;
        if self.session.last_drives()? {
            return wrong("a board that loads passes no stop on");
        }
        Ok(())
    }

    fn pass(&mut self, ticks: u32) -> Result<(), Error> {
        (0..ticks).try_for_each(|_| self.tick().map(drop))
    }
}
