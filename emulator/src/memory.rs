//! Flash, RAM, and the bus on which core and peripherals meet.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rsemu::core::space::{
    AddressSpace, DispatchPolicy, Mapping, MemAttrs, MemOps, MemResult, Perms, RamStore, Region,
    UnassignedPolicy,
};

use crate::chip::{Chip, Fault, Memory, Model, Ps};
use crate::program::Program;

pub(crate) const FLASH: u32 = 0x0800_0000;
/// A byte of flash that is erased.
const ERASED: u8 = 0xFF;
pub(crate) const RAM: u32 = 0x2000_0000;

/// Where peripherals can be: those on buses, ports with a bus of their own, the debug unit.
const PERIPHERALS: [(&str, u32, u64); 3] = [
    ("peripherals", 0x4000_0000, 0x8_0000),
    ("ports", 0x5000_0000, 0x2000),
    ("debug", 0xE004_2000, 0x400),
];

/// The chip as core and machine share it.
#[derive(Debug)]
pub(crate) struct Shared {
    chip: Mutex<Chip>,
    /// The machine's time, for accesses in the middle of an instruction.
    now: AtomicU64,
    /// The core has touched a peripheral since the machine last looked.
    touched: AtomicBool,
}

impl Shared {
    pub(crate) fn new(chip: Chip) -> Arc<Self> {
        Arc::new(Self {
            chip: Mutex::new(chip),
            now: AtomicU64::new(0),
            touched: AtomicBool::new(true),
        })
    }

    /// No thread panics while holding it.
    pub(crate) fn chip(&self) -> MutexGuard<'_, Chip> {
        self.chip.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn set_now(&self, now: Ps) {
        self.now.store(now, Ordering::Relaxed);
    }

    pub(crate) fn take_touched(&self) -> bool {
        // Seldom set: the load is the cheaper half of a swap.
        self.touched.load(Ordering::Relaxed) && self.touched.swap(false, Ordering::Relaxed)
    }

    pub(crate) fn touch(&self) {
        self.touched.store(true, Ordering::Relaxed);
    }

    fn access(&self) -> MutexGuard<'_, Chip> {
        let mut chip = self.chip();
        chip.now = self.now.load(Ordering::Relaxed);
        self.touch();
        chip
    }
}

/// Peripheral registers from this address on.
#[derive(Debug)]
struct Registers {
    shared: Arc<Shared>,
    base: u32,
}

impl MemOps for Registers {
    fn read(&self, offset: u64, bytes: &mut [u8], _: MemAttrs) -> MemResult {
        let address = self.base + offset as u32;
        let mut chip = self.shared.access();
        let mask = u32::MAX >> (32 - 8 * bytes.len().clamp(1, 4));
        let word = chip.read(address & !3, mask).unwrap_or_else(|fault| {
            chip.keep(fault);
            0
        });
        let shifted = word >> (8 * (address & 3));
        for (byte, value) in bytes.iter_mut().zip(shifted.to_le_bytes()) {
            *byte = value;
        }
        Ok(())
    }

    fn write(&self, offset: u64, bytes: &[u8], _: MemAttrs) -> MemResult {
        let address = self.base + offset as u32;
        let shift = 8 * (address & 3);
        let (mut value, mut mask) = ([0; 4], [0; 4]);
        for ((value, mask), byte) in value.iter_mut().zip(&mut mask).zip(bytes) {
            (*value, *mask) = (*byte, 0xFF);
        }
        let [value, mask] = [value, mask].map(|bytes| u32::from_le_bytes(bytes) << shift);
        let mut chip = self.shared.access();
        if let Err(fault) = chip.write(address & !3, value, mask) {
            chip.keep(fault);
        }
        Ok(())
    }
}

#[derive(Debug)]
struct FlashStores {
    shared: Arc<Shared>,
    memories: Memories,
}

impl MemOps for FlashStores {
    fn read(&self, offset: u64, bytes: &mut [u8], _: MemAttrs) -> MemResult {
        self.memories.flash.read_at(offset, bytes).map(drop)
    }

    fn write(&self, offset: u64, bytes: &[u8], _: MemAttrs) -> MemResult {
        let offset = offset as u32;
        let mut chip = self.shared.access();
        if chip.store_flash(offset, bytes.len())
            && let Err(fault) = self.memories.program(FLASH + offset, bytes)
        {
            chip.keep(fault);
        }
        Ok(())
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Memories {
    flash: Arc<RamStore>,
    flash_len: u32,
    ram: Arc<RamStore>,
    ram_len: u32,
}

fn refused(error: impl std::fmt::Debug) -> Fault {
    Fault::Memory(format!("{error:?}"))
}

impl Memories {
    /// Memories with the program flashed; the rest of flash is erased, RAM is zero.
    pub(crate) fn new(program: &Program, model: &Model) -> Result<Self, Fault> {
        Self::flashed(program.segments(), model.flash, model.ram)
    }

    pub(crate) fn flashed<'s>(
        segments: impl Iterator<Item = (u32, &'s [u8])>,
        flash_len: u32,
        ram_len: u32,
    ) -> Result<Self, Fault> {
        let memories = Self {
            flash: Arc::new(RamStore::new(flash_len.into())),
            flash_len,
            ram: Arc::new(RamStore::new(ram_len.into())),
            ram_len,
        };
        memories.erase(FLASH..FLASH + flash_len)?;
        for (address, contents) in segments {
            let offset = address
                .checked_sub(FLASH)
                .ok_or_else(|| Fault::Program(format!("a segment at {address:#x}")))?;
            memories
                .flash
                .write_at(offset.into(), contents)
                .map_err(refused)?;
        }
        Ok(memories)
    }

    pub(crate) fn space(&self, shared: &Arc<Shared>) -> Result<AddressSpace, Fault> {
        // Flash and RAM, which are read most, are found without a search.
        let space = AddressSpace::new("chip", 32)
            .with_unassigned(UnassignedPolicy::FAULT)
            .with_dispatch(DispatchPolicy::Dense {
                page_bits: 12,
                cover: u64::from(RAM) + u64::from(self.ram_len),
            });
        {
            let registers = |base| {
                Arc::new(Registers {
                    shared: Arc::clone(shared),
                    base,
                })
            };
            let mut map = space.topology();
            let (flash, ram) = (Arc::clone(&self.flash), Arc::clone(&self.ram));
            // Read as memory; what is stored goes to the flash interface.
            let read = Mapping::new(Region::ram("flash", flash), FLASH.into());
            map.map_with(read.with_perms(Perms::RX)).map_err(refused)?;
            let stores = Arc::new(FlashStores {
                shared: Arc::clone(shared),
                memories: self.clone(),
            });
            let stores = Region::io("stores into flash", self.flash_len.into(), stores);
            map.map_with(
                Mapping::new(stores, FLASH.into())
                    .with_perms(Perms::WRITE)
                    .with_priority(-1),
            )
            .map_err(refused)?;
            map.map(Region::ram("ram", ram), RAM.into())
                .map_err(refused)?;
            for (name, base, length) in PERIPHERALS {
                map.map(Region::io(name, length, registers(base)), base.into())
                    .map_err(refused)?;
            }
        }
        Ok(space)
    }

    pub(crate) const fn flash_len(&self) -> u32 {
        self.flash_len
    }

    pub(crate) fn read(&self, address: u32, bytes: &mut [u8]) -> Result<(), Fault> {
        let offset = ram_offset(address)?;
        self.ram.read_at(offset, bytes).map_err(refused).map(drop)
    }

    pub(crate) fn bytes<const N: usize>(&self, address: u32) -> Result<[u8; N], Fault> {
        let mut bytes = [0; N];
        self.read(address, &mut bytes)?;
        Ok(bytes)
    }

    pub(crate) fn word(&self, address: u32) -> Result<u32, Fault> {
        self.bytes(address).map(u32::from_le_bytes)
    }

    pub(crate) fn flip(&self, address: u32, bits: u8) -> Result<(), Fault> {
        let outside = || Fault::Memory(format!("{address:#010x} is not in memory"));
        let byte = [self.get(address).ok_or_else(outside)? ^ bits];
        let (store, base) = if address < RAM {
            (&self.flash, FLASH)
        } else {
            (&self.ram, RAM)
        };
        let done = store.write_at((address - base).into(), &byte);
        done.map_err(refused).map(drop)
    }

    pub(crate) fn erase(&self, place: Range<u32>) -> Result<(), Fault> {
        let ones = vec![ERASED; place.len()];
        let offset = place.start - FLASH;
        self.flash
            .write_at(offset.into(), &ones)
            .map_err(refused)
            .map(drop)
    }

    /// Programs bytes of flash, which can clear bits and set none.
    pub(crate) fn program(&self, address: u32, bytes: &[u8]) -> Result<(), Fault> {
        let there = self.flashed_bytes(address, bytes.len())?;
        let left: Vec<u8> = there.iter().zip(bytes).map(|(a, b)| a & b).collect();
        let offset = address - FLASH;
        self.flash
            .write_at(offset.into(), &left)
            .map_err(refused)
            .map(drop)
    }

    pub(crate) fn flashed_bytes(&self, address: u32, length: usize) -> Result<Vec<u8>, Fault> {
        let outside = || Fault::Memory(format!("{address:#010x} is not in flash"));
        let offset = address.checked_sub(FLASH).ok_or_else(outside)?;
        let mut bytes = vec![0; length];
        self.flash
            .read_at(offset.into(), &mut bytes)
            .map_err(refused)?;
        Ok(bytes)
    }

    pub(crate) fn lose_ram(&self) -> Result<(), Fault> {
        self.write(RAM, &vec![0; self.ram_len as usize])
    }

    pub(crate) fn write(&self, address: u32, bytes: &[u8]) -> Result<(), Fault> {
        let offset = ram_offset(address)?;
        self.ram.write_at(offset, bytes).map_err(refused).map(drop)
    }
}

impl rtt::Ram for &Memories {
    type Fault = Fault;

    fn read(&mut self, at: u32, into: &mut [u8]) -> Result<(), Fault> {
        Memories::read(self, at, into)
    }

    fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Fault> {
        Memories::write(self, at, bytes)
    }
}

fn ram_offset(address: u32) -> Result<u64, Fault> {
    let outside = || Fault::Memory(format!("{address:#010x} is not in RAM"));
    address.checked_sub(RAM).map(u64::from).ok_or_else(outside)
}

impl Memory for Memories {
    fn get(&self, address: u32) -> Option<u8> {
        let mut byte = [0];
        if let Some(offset) = address.checked_sub(RAM).filter(|&o| o < self.ram_len) {
            self.ram.read_at(offset.into(), &mut byte).ok()?;
        } else {
            let offset = address.checked_sub(FLASH).filter(|&o| o < self.flash_len)?;
            self.flash.read_at(offset.into(), &mut byte).ok()?;
        }
        Some(byte[0])
    }

    fn put(&self, address: u32, byte: u8) -> Option<()> {
        let offset = address.checked_sub(RAM).filter(|&o| o < self.ram_len)?;
        self.ram.write_at(offset.into(), &[byte]).ok()?;
        Some(())
    }
}
