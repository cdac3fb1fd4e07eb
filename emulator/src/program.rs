//! The program file of a board: what is flashed, where its symbols are.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use firmware::{BoardCode, ConfigError, HEADER_BYTES, HeadConfig, Header, decode};
use object::elf::{FileHeader32, PT_LOAD};
use object::read::elf::{FileHeader, ProgramHeader};
use object::{Endianness, Object, ObjectSection};
use rtt::LogDecoder;
use scene::{Scene, file};
use whisking::{Fix, FormatCode};

use crate::chip::{Fault, MODELS, Model};

#[derive(Debug, Clone)]
pub(crate) struct Program {
    bytes: Arc<[u8]>,
    /// Where in memory what stands, by load address.
    segments: Vec<(u32, Vec<u8>)>,
    /// The board that it was built for: its main source file is called after it, as the debug
    /// information says.
    model: Option<&'static Model>,
}

fn bad(what: impl std::fmt::Display) -> Fault {
    Fault::Program(what.to_string())
}

impl Program {
    pub(crate) fn load(path: &Path) -> Result<Self, Fault> {
        let named = |fault: &dyn std::fmt::Display| bad(format!("{}: {fault}", path.display()));
        let bytes = file::read(path, file::BINARY_BYTES).map_err(|error| named(&error))?;
        Self::parse(bytes).map_err(|fault| match fault {
            Fault::Program(what) => named(&what),
            fault => fault,
        })
    }

    fn parse(bytes: Vec<u8>) -> Result<Self, Fault> {
        let data = bytes.as_slice();
        let header = FileHeader32::<Endianness>::parse(data).map_err(bad)?;
        let endian = header.endian().map_err(bad)?;
        let mut segments = Vec::new();
        for segment in header.program_headers(endian, data).map_err(bad)? {
            let contents = segment.data(endian, data);
            let contents = contents.map_err(|()| bad("a segment lies outside the file"))?;
            if segment.p_type(endian) == PT_LOAD && !contents.is_empty() {
                segments.push((segment.p_paddr(endian), contents.to_vec()));
            }
        }
        let file = object::File::parse(data).map_err(bad)?;
        let names = file.section_by_name(".debug_str");
        let names = names.and_then(|names| names.uncompressed_data().ok());
        let names = names.unwrap_or_default();
        let is_named = |model: &&Model| {
            let main = format!("src/bin/{}.rs", model.program);
            let mut names = names.windows(main.len());
            names.any(|found| found == main.as_bytes())
        };
        let model = MODELS.into_iter().find(is_named);
        Ok(Self {
            bytes: bytes.into(),
            segments,
            model,
        })
    }

    pub(crate) fn model(&self) -> Result<&'static Model, Fault> {
        let unknown = || bad("it is of no board that is emulated");
        self.model.ok_or_else(unknown)
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    pub(crate) fn segments(&self) -> impl Iterator<Item = (u32, &[u8])> {
        let segments = self.segments.iter();
        segments.map(|(at, contents)| (*at, contents.as_slice()))
    }

    pub(crate) fn log_decoder(&self) -> Result<LogDecoder, Fault> {
        Ok(LogDecoder::new(&self.bytes)?)
    }

    /// Where scenes and models lie: the slots, and what lies behind them.
    pub(crate) fn scenes(&self) -> Result<Range<u32>, Fault> {
        let [a, b] = self.model()?.facts.flash.slots;
        Ok(a.erased.start..b.erased.end().max(b.model.end()))
    }

    pub(crate) fn brings_scene(&self) -> Result<bool, Fault> {
        let places = self.scenes()?;
        let mut segments = self.segments();
        Ok(segments.any(|(at, _)| places.contains(&at)))
    }

    pub(crate) fn check_of(&self, scene: &Scene) -> Result<(), Fault> {
        let board = self.model()?.facts;
        let Some(config) = self.config()? else {
            return Ok(());
        };
        let head = head(config, board.code)
            .map_err(|fault| bad(format!("the scene that it brings with it: {fault}")))?;
        let (found, name) = (head.name.as_str(), scene.name.as_str());
        if found != name {
            return Err(bad(format!(
                "found that of the scene {found:?}, allowed: that of {name:?}"
            )));
        }
        let (found, tick_hz) = (head.tick_hz, scene.tick_hz);
        if found != tick_hz {
            return Err(bad(format!(
                "found tick_hz = {found}, allowed: {tick_hz}, as the scene {name:?} has it"
            )));
        }
        let (found, sides) = (usize::from(head.sides), scene.head.sides.count());
        if found != sides {
            return Err(bad(format!(
                "found {found} sides, allowed: {sides}, as the scene {name:?} has them"
            )));
        }
        Ok(())
    }

    fn config(&self) -> Result<Option<&[u8]>, Fault> {
        let [slot, _] = self.model()?.facts.flash.slots;
        let start = slot.config().start;
        let mut segments = self.segments();
        Ok(segments.find_map(|(at, contents)| {
            let before = start.checked_sub(at)? as usize;
            contents.get(before..).filter(|found| !found.is_empty())
        }))
    }

    /// Has `contents` lie at an address where scenes and models do, when it is flashed.
    pub(crate) fn add(&mut self, at: u32, contents: &[u8]) -> Result<(), Fault> {
        let places = self.scenes()?;
        if at < places.start || at as usize + contents.len() > places.end as usize {
            let found = contents.len();
            return Err(bad(format!("no room for {found} bytes at {at:#010x}")));
        }
        self.segments.push((at, contents.to_vec()));
        Ok(())
    }

    pub(crate) fn symbol(&self, name: &str) -> Result<u32, Fault> {
        Ok(rtt::symbol(&self.bytes, name)?)
    }
}

fn head(bytes: &[u8], board: BoardCode) -> Result<HeadConfig, ConfigError> {
    let header = Header::of(bytes)?;
    let end = HEADER_BYTES.saturating_add(header.length as usize);
    let bytes = bytes.get(..end).unwrap_or(bytes);
    if header.format == FormatCode::Fixed as u8 {
        return decode::<Fix>(bytes, board).map(|config| config.head);
    }
    decode::<f32>(bytes, board).map(|config| config.head)
}
