//! A module behind a probe, talked with through its RAM.

use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use firmware::Links;
use host_sim::Error;
use host_sim::origin::Origin;
use host_sim::received::Receiver;
use rtt::{LogDecoder, Ram, Ring, Rtt};
use scene::file;
use wire::TaggedCommand;

use super::find;
use super::memory::{MemoryPort, ram};
use crate::source::{BoardName, Incoming, Laying, Source, by_probe, framed};

/// Between two looks where nothing has come: a quarter of the time in which the ring of packets
/// fills.
const PAUSE: Duration = Duration::from_millis(10);

/// Opens the board behind a probe; `program` is the ELF file that it runs.
pub(crate) fn open(
    selector: &str,
    board: BoardName,
    program: Option<&Path>,
    laying: Laying,
) -> Result<Box<dyn Source>, Error> {
    Ok(Box::new(Behind::new(
        find::open(selector)?,
        board,
        program,
        laying,
    )?))
}

pub(super) struct Behind {
    memory: MemoryPort,
    board: BoardName,
    rtt: Rtt,
    /// Of packets and requests; none where its program has no telemetry.
    rings: Option<[Ring; 2]>,
    receiver: Receiver,
    decoder: Option<LogDecoder>,
    laying: Laying,
    since: Instant,
}

impl Behind {
    pub(super) fn new(
        probe: probe_rs::probe::Probe,
        board: BoardName,
        program: Option<&Path>,
        laying: Laying,
    ) -> Result<Self, Error> {
        let mut memory = MemoryPort::of(probe)?;
        memory.check(board)?;
        let (rtt, decoder) = match program {
            Some(path) => {
                let elf = file::read(path, file::BINARY_BYTES);
                let elf = elf.map_err(|error| Error::file(path, error))?;
                let wrong = |error| Error::file(path, error);
                let rtt = Rtt::of_program(&elf).map_err(wrong)?;
                if !rtt.is_there(&mut memory)? {
                    let fault = "is not what the board runs; whisker flash SCENE programs it, \
                                 and says which file it is";
                    return Err(Error::file(path, fault));
                }
                (rtt, Some(LogDecoder::new(&elf).map_err(wrong)?))
            }
            None => (find_block(&mut memory, board)?, None),
        };
        let packets = rtt.packets(&mut memory)?;
        let requests = rtt.requests(&mut memory)?;
        let rings = packets.zip(requests).map(|(up, down)| [up, down]);
        if let Some([packets, _]) = rings {
            // What whoever was here before has left is no answer to us.
            packets.drain(&mut memory)?;
        }
        Ok(Self {
            memory,
            board,
            rtt,
            rings,
            receiver: Receiver::default(),
            decoder,
            laying,
            since: Instant::now(),
        })
    }

    fn send(&mut self, frame: &[u8]) -> Result<(), Error> {
        let sent = match self.rings {
            Some([_, requests]) => requests.send(&mut self.memory, frame)?,
            None => 0,
        };
        if sent == frame.len() {
            return Ok(());
        }
        let fault = "the board takes no requests: its scene has telemetry.rtt = false, or it \
                     stands still; whisker log --program ELF says what it does";
        Err(Error::Work(fault.to_owned()))
    }
}

fn find_block(memory: &mut MemoryPort, board: BoardName) -> Result<Rtt, Error> {
    let (at, length) = ram(board);
    let mut bytes = vec![0; length];
    memory.read(at, &mut bytes)?;
    Rtt::find(at, &bytes).ok_or_else(|| {
        Error::Work(
            "no module runs on the board, or one that was built otherwise; whisker flash SCENE \
             programs it"
                .to_owned(),
        )
    })
}

impl Source for Behind {
    fn next(&mut self) -> Result<Incoming, Error> {
        let bytes = match self.rings {
            Some([packets, _]) => packets.drain(&mut self.memory)?,
            None => Vec::new(),
        };
        let log = self.rtt.log().drain(&mut self.memory)?;
        let lines = self.decoder.as_mut().map(|decoder| decoder.lines(&log));
        if bytes.is_empty() && log.is_empty() {
            sleep(PAUSE);
        }
        Ok(Incoming {
            packets: self.receiver.packets(&bytes),
            lines: lines.unwrap_or_default(),
            ..Incoming::default()
        })
    }

    fn request(&mut self, node: Option<u8>, request: TaggedCommand) -> Result<(), Error> {
        self.send(&framed(node, request))
    }

    fn has_log(&self) -> Result<(), Error> {
        let fault = "--program ELF is missing: the file of the program that the board runs, whose \
                     table its log is read by";
        match self.decoder {
            Some(_) => Ok(()),
            None => Err(Error::Input(fault.to_owned())),
        }
    }

    fn laying(&mut self) -> Option<&mut Laying> {
        Some(&mut self.laying)
    }

    fn now_s(&mut self) -> f64 {
        self.since.elapsed().as_secs_f64()
    }

    fn would_answer(&self, links: Links) -> Result<(), Error> {
        by_probe(links)
    }

    fn origin(&self) -> Origin {
        Origin::default().with("board", self.board.board().name)
    }
}
