//! Flash, RAM, and the bus on which core and peripherals meet.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rsemu::core::space::{
    AddressSpace, MemAttrs, MemOps, MemResult, RamStore, Region, UnassignedPolicy,
};

use crate::chip::{Chip, Fault, Memory, Ps};
use crate::program::Program;

const FLASH: u32 = 0x0800_0000;
const FLASH_LEN: u32 = 512 * 1024;
const RAM: u32 = 0x2000_0000;
const RAM_LEN: u32 = 128 * 1024;

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

    /// The chip. Nobody panics while holding it.
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

    fn access(&self) -> MutexGuard<'_, Chip> {
        let mut chip = self.chip();
        chip.now = self.now.load(Ordering::Relaxed);
        self.touched.store(true, Ordering::Relaxed);
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
        let word = chip.read(address & !3).unwrap_or_else(|fault| {
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

/// Flash and RAM.
#[derive(Debug, Clone)]
pub(crate) struct Memories {
    flash: Arc<RamStore>,
    ram: Arc<RamStore>,
}

fn refused(error: impl std::fmt::Debug) -> Fault {
    Fault::Memory(format!("{error:?}"))
}

impl Memories {
    /// Memories with the program flashed; RAM is zero.
    pub(crate) fn new(program: &Program) -> Result<Self, Fault> {
        let memories = Self {
            flash: Arc::new(RamStore::new(FLASH_LEN.into())),
            ram: Arc::new(RamStore::new(RAM_LEN.into())),
        };
        for (address, contents) in program.segments() {
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

    /// The address space of the core.
    pub(crate) fn space(&self, shared: &Arc<Shared>) -> Result<AddressSpace, Fault> {
        let space = AddressSpace::new("chip", 32).with_unassigned(UnassignedPolicy::FAULT);
        {
            let registers = |base| {
                Arc::new(Registers {
                    shared: Arc::clone(shared),
                    base,
                })
            };
            let mut map = space.topology();
            let (flash, ram) = (Arc::clone(&self.flash), Arc::clone(&self.ram));
            map.map(Region::ram("flash", flash), FLASH.into())
                .map_err(refused)?;
            map.map(Region::ram("ram", ram), RAM.into())
                .map_err(refused)?;
            for (name, base, length) in [
                ("peripherals", 0x4000_0000, 0x8_0000),
                ("debug", 0xE004_2000, 0x400),
            ] {
                map.map(Region::io(name, length, registers(base)), base.into())
                    .map_err(refused)?;
            }
        }
        Ok(space)
    }

    /// Reads RAM as a probe does.
    pub(crate) fn read(&self, address: u32, bytes: &mut [u8]) -> Result<(), Fault> {
        let offset = ram_offset(address)?;
        self.ram.read_at(offset, bytes).map_err(refused).map(drop)
    }

    /// A word of RAM.
    pub(crate) fn word(&self, address: u32) -> Result<u32, Fault> {
        let mut bytes = [0; 4];
        self.read(address, &mut bytes)?;
        Ok(u32::from_le_bytes(bytes))
    }

    /// Flips bits of a byte of RAM or flash.
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

    /// Writes RAM as a probe does.
    pub(crate) fn write(&self, address: u32, bytes: &[u8]) -> Result<(), Fault> {
        let offset = ram_offset(address)?;
        self.ram.write_at(offset, bytes).map_err(refused).map(drop)
    }
}

fn ram_offset(address: u32) -> Result<u64, Fault> {
    let outside = || Fault::Memory(format!("{address:#010x} is not in RAM"));
    address.checked_sub(RAM).map(u64::from).ok_or_else(outside)
}

impl Memory for Memories {
    fn get(&self, address: u32) -> Option<u8> {
        let mut byte = [0];
        if let Some(offset) = address.checked_sub(RAM).filter(|&o| o < RAM_LEN) {
            self.ram.read_at(offset.into(), &mut byte).ok()?;
        } else {
            let offset = address.checked_sub(FLASH).filter(|&o| o < FLASH_LEN)?;
            self.flash.read_at(offset.into(), &mut byte).ok()?;
        }
        Some(byte[0])
    }

    fn put(&self, address: u32, byte: u8) -> Option<()> {
        let offset = address.checked_sub(RAM).filter(|&o| o < RAM_LEN)?;
        self.ram.write_at(offset.into(), &[byte]).ok()?;
        Some(())
    }
}
