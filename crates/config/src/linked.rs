//! A program that brings a scene with it: what would be deployed stands in its ELF file, where it
//! would lie in flash, so that programs of two scenes differ in data alone and are compiled once.
//!
//! An own writer, as that of the crate `object` (0.36) keeps the table of segments where it is, with
//! no room for more.

use firmware::boards::{FlashMap, Region, SLOT_HEADER_BYTES, SlotHeader};
use tactile::ModelBuf;

use crate::Image;

/// Offsets in the header of an ELF file of 32 bits: of the two tables, and of their numbers of
/// entries.
const SEGMENTS_AT: usize = 28;
const SECTIONS_AT: usize = 32;
const SEGMENTS: usize = 44;
const SECTIONS: usize = 48;
const NAMES: usize = 50;
const SEGMENT_BYTES: usize = 32;
const SECTION_BYTES: usize = 40;
/// `\x7fELF`, 32 bits, little-endian.
const MAGIC: [u8; 6] = [0x7F, b'E', b'L', b'F', 1, 1];
/// PT_LOAD, PF_R; SHT_PROGBITS, SHF_ALLOC.
const LOAD: u32 = 1;
const READ: u32 = 4;
const PROGBITS: u32 = 1;
const ALLOC: u32 = 2;

/// Why a program cannot bring a scene with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say it")]
pub enum Unlinked {
    #[error("found no program of a board: no whole ELF file of 32 bits, little-endian")]
    NotElf,
    #[error("found a program that brings a scene with it, allowed: one for any scene")]
    HasScene,
    #[error("found {found} bytes of {what}, allowed on this board: at most {room}")]
    Room {
        what: &'static str,
        found: usize,
        room: u32,
    },
}

/// The name of a section, its address, and what it holds.
type Placed = (&'static str, u32, Vec<u8>);

/// What lies where in flash. The second slot is as erased: what was deployed there counts no more.
fn parts(
    image: &Image,
    model: Option<&ModelBuf>,
    flash: &FlashMap,
) -> Result<Vec<Placed>, Unlinked> {
    let [first, second] = flash.slots;
    let header = SlotHeader::linked(model.map_or(0, ModelBuf::crc)).bytes();
    let config = &image.bytes[..];
    let within = |what, bytes: &[u8], place: Region| {
        let (found, room) = (bytes.len(), place.bytes);
        let fits = found <= room as usize;
        fits.then_some(())
            .ok_or(Unlinked::Room { what, found, room })
    };
    within("scene", config, first.config())?;
    let scene = [&header[..], config].concat();
    let erased = vec![u8::MAX; SLOT_HEADER_BYTES];
    let mut parts = vec![
        (".scene", first.head.start, scene),
        (".scene_b", second.head.start, erased),
    ];
    if let Some(model) = model {
        within("model", model.as_bytes(), first.model)?;
        parts.push((".model", first.model.start, model.as_bytes().to_vec()));
    }
    Ok(parts)
}

/// The ELF file of `program` with a scene and its model, as a linker would have placed them. All
/// that was there stays where it was; the tables follow at the end.
///
/// # Errors
/// [`Unlinked`].
pub fn linked(
    program: &[u8],
    image: &Image,
    model: Option<&ModelBuf>,
    flash: &FlashMap,
) -> Result<Vec<u8>, Unlinked> {
    let mut elf = Elf::of(program).ok_or(Unlinked::NotElf)?;
    for (name, address, bytes) in parts(image, model, flash)? {
        if elf.loads(address) {
            return Err(Unlinked::HasScene);
        }
        elf.add(name, address, &bytes);
    }
    elf.end().ok_or(Unlinked::NotElf)
}

struct Elf {
    bytes: Vec<u8>,
    segments: Vec<[u8; SEGMENT_BYTES]>,
    sections: Vec<[u8; SECTION_BYTES]>,
    /// The names of sections, and which of these holds them.
    names: Vec<u8>,
    of_names: usize,
}

impl Elf {
    fn of(bytes: &[u8]) -> Option<Self> {
        let word = |at| Some(u32_at(bytes, at)? as usize);
        if !bytes.starts_with(&MAGIC) {
            return None;
        }
        let segments = table(bytes, word(SEGMENTS_AT)?, u16_at(bytes, SEGMENTS)?)?;
        let sections = table(bytes, word(SECTIONS_AT)?, u16_at(bytes, SECTIONS)?)?;
        let of_names = usize::from(u16_at(bytes, NAMES)?);
        let names: &[u8; SECTION_BYTES] = sections.get(of_names)?;
        let (at, size) = (u32_at(names, 16)? as usize, u32_at(names, 20)? as usize);
        let names = bytes.get(at..at.checked_add(size)?)?.to_vec();
        Some(Self {
            bytes: bytes.to_vec(),
            segments,
            sections,
            names,
            of_names,
        })
    }

    /// Appends bytes; where they begin.
    fn append(&mut self, bytes: &[u8]) -> u32 {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let at = self.bytes.len();
        self.bytes.extend(bytes);
        at as u32
    }

    fn loads(&self, address: u32) -> bool {
        let mut segments = self.segments.iter();
        segments.any(|segment| u32_at(segment, 12) == Some(address))
    }

    fn add(&mut self, name: &str, address: u32, bytes: &[u8]) {
        let (at, size) = (self.append(bytes), bytes.len() as u32);
        let segment = [LOAD, at, address, address, size, size, READ, 4];
        let named = self.names.len() as u32;
        let section = [named, PROGBITS, ALLOC, address, at, size, 0, 0, 4, 0];
        self.names.extend(name.bytes().chain([0]));
        self.segments.push(bytes_of(segment));
        self.sections.push(bytes_of(section));
    }

    fn end(mut self) -> Option<Vec<u8>> {
        let names = std::mem::take(&mut self.names);
        let at = self.append(&names);
        let of_names = self.sections.get_mut(self.of_names)?;
        of_names[16..20].copy_from_slice(&at.to_le_bytes());
        of_names[20..24].copy_from_slice(&(names.len() as u32).to_le_bytes());
        // What is loaded stands in the order of its addresses.
        self.segments.sort_by_key(|segment| {
            let [kind, address] = [0, 8].map(|at| u32_at(segment, at));
            (kind != Some(LOAD), address)
        });
        let (segments, sections) = (self.segments.concat(), self.sections.concat());
        let counts = [self.segments.len(), self.sections.len()];
        let [segments_at, sections_at] = [self.append(&segments), self.append(&sections)];
        let mut put = |at: usize, bytes: &[u8]| {
            let place = self.bytes.get_mut(at..at + bytes.len());
            place.map(|place| place.copy_from_slice(bytes))
        };
        put(SEGMENTS_AT, &segments_at.to_le_bytes())?;
        put(SECTIONS_AT, &sections_at.to_le_bytes())?;
        for (at, count) in [SEGMENTS, SECTIONS].into_iter().zip(counts) {
            put(at, &u16::try_from(count).ok()?.to_le_bytes())?;
        }
        Some(self.bytes)
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn table<const N: usize>(bytes: &[u8], at: usize, count: u16) -> Option<Vec<[u8; N]>> {
    let (entries, _) = bytes.get(at..)?.as_chunks::<N>();
    Some(entries.get(..usize::from(count))?.to_vec())
}

fn bytes_of<const WORDS: usize, const N: usize>(words: [u32; WORDS]) -> [u8; N] {
    let mut bytes = [0; N];
    for (place, word) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(words) {
        *place = word.to_le_bytes();
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::{Image, MAGIC, SECTION_BYTES, SEGMENT_BYTES, Unlinked, bytes_of, linked};
    use firmware::boards::{NUCLEO_F446RE, SlotHeader};
    use object::{Object, ObjectSection, ObjectSegment};
    use proptest::prelude::*;
    use scene::Scene;

    fn any_image() -> Image {
        let scene = Scene::from_str("passive.toml", include_str!("../../../scenes/passive.toml"));
        crate::image(&scene.unwrap(), None, &NUCLEO_F446RE, "").unwrap()
    }

    /// The least that is a program: four bytes at an address, and the names of its sections.
    fn program(address: u32) -> Vec<u8> {
        let names = b"\0.text\0.shstrtab\0";
        let mut header = [0; 52];
        header[..6].copy_from_slice(&MAGIC);
        header[6] = 1;
        let fields: [u16; 18] = [2, 40, 1, 0, 0, 0, 52, 0, 108, 0, 0, 0, 52, 32, 1, 40, 3, 2];
        header[16..].copy_from_slice(&fields.map(u16::to_le_bytes).concat());
        let code: [u8; SEGMENT_BYTES] = bytes_of([1, 84, address, address, 4, 4, 5, 4]);
        let sections: [[u8; SECTION_BYTES]; 3] = [
            [0; SECTION_BYTES],
            bytes_of([1, 1, 6, address, 84, 4, 0, 0, 4, 0]),
            bytes_of([7, 3, 0, 0, 88, names.len() as u32, 0, 0, 1, 0]),
        ];
        let mut bytes = [&header[..], &code, &[1, 2, 3, 4], names].concat();
        bytes.resize(108, 0);
        [bytes, sections.concat()].concat()
    }

    /// As another crate reads it.
    #[test]
    fn a_scene_lies_where_it_would_be_deployed() {
        let (image, flash) = (any_image(), NUCLEO_F446RE.flash);
        let program = program(flash.program.start);
        let elf = linked(&program, &image, None, &flash).unwrap();
        let file = object::File::parse(&*elf).unwrap();
        let config = &image.bytes[..];
        let scene = [&SlotHeader::linked(0).bytes()[..], config].concat();
        let [first, second] = flash.slots.map(|slot| u64::from(slot.head.start));
        let named = [
            (".text", u64::from(flash.program.start), &[1, 2, 3, 4][..]),
            (".scene", first, &scene[..]),
            (".scene_b", second, &[0xFF; 24][..]),
        ];
        for (name, address, data) in named {
            let section = file.section_by_name(name).unwrap();
            assert_eq!((section.address(), section.data()), (address, Ok(data)));
            let mut segments = file.segments();
            let segment = segments.find(|segment| segment.address() == address);
            assert_eq!(segment.unwrap().data(), Ok(data), "{name}");
        }
        assert_eq!(file.sections().count(), 4);
        let again = linked(&elf, &image, None, &flash);
        assert_eq!(again, Err(Unlinked::HasScene));
    }

    proptest! {
        /// Whatever a file holds, it is a program or refused.
        #[test]
        fn what_is_no_program_is_refused(
            end in 0..228_usize,
            at in 0..228_usize,
            byte in any::<u8>(),
        ) {
            let (image, flash) = (any_image(), NUCLEO_F446RE.flash);
            let mut bytes = program(0);
            let cut = linked(&bytes[..end], &image, None, &flash);
            prop_assert_eq!(cut, Err(Unlinked::NotElf));
            bytes[at] = byte;
            let _ = linked(&bytes, &image, None, &flash);
        }
    }
}
