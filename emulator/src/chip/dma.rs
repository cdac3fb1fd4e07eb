//! A DMA controller, which moves single bytes on request. There are two kinds.

mod layout;

pub(super) use layout::{CHANNELS, Layout, STREAMS};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Move {
    pub(super) peripheral: u32,
    pub(super) memory: u32,
    pub(super) to_memory: bool,
}

/// Registers of a stream, from where it begins.
const CR: u32 = 0x00;
const NDTR: u32 = 0x04;
const PAR: u32 = 0x08;
const MAR: u32 = 0x0C;

/// In CR of either kind.
const EN: u32 = 1 << 0;

#[derive(Debug, Clone, Copy, Default)]
struct Stream {
    cr: u32,
    ndtr: u32,
    par: u32,
    mar: u32,
    /// Bytes asked for when it was enabled.
    length: u32,
    /// As if it were the first.
    flags: u32,
}

/// Streams and channels are counted from 0.
#[derive(Debug, Clone)]
pub(super) struct Dma {
    layout: &'static Layout,
    streams: [Stream; 8],
}

enum Place {
    /// The flags of some streams, from the first on.
    Flags(usize),
    Clear(usize),
    Stream(usize, u32),
}

impl Dma {
    pub(super) fn new(layout: &'static Layout) -> Self {
        Self {
            layout,
            streams: [Stream::default(); 8],
        }
    }

    pub(super) fn reset(&mut self) {
        *self = Self::new(self.layout);
    }

    pub(super) fn stop(&mut self, stream: usize) {
        if let Some(stream) = self.streams.get_mut(stream) {
            stream.cr &= !EN;
        }
    }

    /// Serves a request: the byte to move, if it listens. A stream listens to the one `selected`
    /// alone.
    pub(super) fn request(&mut self, stream: usize, selected: u32) -> Option<Move> {
        let layout = self.layout;
        let s = self.streams.get_mut(stream)?;
        let select = layout.select;
        let is_other = select != 0 && (s.cr & select) >> select.trailing_zeros() != selected;
        if s.cr & EN == 0 || s.ndtr == 0 || is_other {
            return None;
        }
        let done = s.length - s.ndtr;
        let moved = if s.cr & layout.minc != 0 { done } else { 0 };
        let moved = Move {
            peripheral: s.par,
            memory: s.mar.wrapping_add(moved),
            to_memory: s.cr & layout.from_memory == 0,
        };
        s.ndtr -= 1;
        if 2 * (done + 1) == s.length {
            s.flags |= layout.half;
        }
        if s.ndtr == 0 {
            s.flags |= layout.complete;
            if s.cr & layout.circ != 0 {
                s.ndtr = s.length;
            } else {
                s.cr &= !layout.ends;
            }
        }
        Some(moved)
    }

    pub(super) fn interrupts(&self, stream: usize) -> bool {
        let (layout, stream) = (self.layout, &self.streams[stream]);
        stream.flags & layout.tcif != 0 && stream.cr & layout.tcie != 0
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        Some(match self.place(offset)? {
            Place::Flags(first) => {
                let flags = self.streams[first..].iter().zip(self.layout.flags_at);
                flags.fold(0, |all, (stream, at)| all | stream.flags << at)
            }
            Place::Clear(_) => 0,
            Place::Stream(n, register) => {
                let s = &self.streams[n];
                match register {
                    CR => s.cr,
                    NDTR => s.ndtr,
                    PAR => s.par,
                    MAR => s.mar,
                    _ => return None,
                }
            }
        })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let layout = self.layout;
        match self.place(offset) {
            // Flags are read, and cleared elsewhere.
            None | Some(Place::Flags(_)) => return false,
            Some(Place::Clear(first)) => {
                for (stream, at) in self.streams[first..].iter_mut().zip(layout.flags_at) {
                    let cleared = value >> at & layout.flags;
                    // The flag of them all, where there is one, clears them all.
                    let all = cleared & layout.of_all != 0;
                    stream.flags &= !if all { layout.flags } else { cleared };
                }
            }
            Some(Place::Stream(n, register)) => {
                let s = &mut self.streams[n];
                let enabled = s.cr & EN != 0;
                match register {
                    CR if value & !layout.modelled != 0 => return false,
                    CR => {
                        if value & EN != 0 && !enabled {
                            s.length = s.ndtr;
                        }
                        // A stream without bytes to move does not start.
                        let idle = value & EN != 0 && s.ndtr == 0;
                        s.cr = if idle { value & !layout.ends } else { value };
                    }
                    // The others are locked while the stream is enabled.
                    NDTR | PAR | MAR if enabled => {}
                    NDTR => s.ndtr = value & 0xFFFF,
                    PAR => s.par = value,
                    MAR => s.mar = value,
                    _ => return false,
                }
            }
        }
        true
    }

    fn place(&self, offset: u32) -> Option<Place> {
        let layout = self.layout;
        let (flag_registers, size) = (layout.flag_registers, layout.size);
        let streams = layout.flags_at.len() * flag_registers as usize;
        if let Some(offset) = offset.checked_sub(8 * flag_registers) {
            let n = (offset / size) as usize;
            return (n < streams).then_some(Place::Stream(n, offset % size));
        }
        let [register, clear] = [offset / 4 % flag_registers, offset / 4 / flag_registers];
        let first = layout.flags_at.len() * register as usize;
        match (offset % 4, clear) {
            (0, 0) => Some(Place::Flags(first)),
            (0, _) => Some(Place::Clear(first)),
            _ => None,
        }
    }
}
