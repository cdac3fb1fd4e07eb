//! Flash, RAM, and the bus on which core and peripherals meet.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rsemu::core::space::{
    AddressSpace, DispatchPolicy, Mapping, MemAttrs, MemOps, MemResult, Perms, RamStore, Region,
    UnassignedPolicy,
};

use crate::chip::{Chip, Fault, Ps};

pub(crate) const FLASH: u32 = 0x0800_0000;
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
        self.memories.flash.bytes.read_at(offset, bytes).map(drop)
    }

    fn write(&self, offset: u64, bytes: &[u8], _: MemAttrs) -> MemResult {
        let offset = offset as u32;
        let mut chip = self.shared.access();
        let now = chip.now;
        if chip.flash.store(offset, bytes.len(), now)
            && let Err(fault) = self.memories.program(FLASH + offset, bytes)
        {
            chip.keep(fault);
        }
        Ok(())
    }
}

fn refused(error: impl std::fmt::Debug) -> Fault {
    Fault::Memory(format!("{error:?}"))
}

/// Bytes from an address on.
#[derive(Debug, Clone)]
struct Store {
    name: &'static str,
    base: u32,
    len: u32,
    bytes: Arc<RamStore>,
}

impl Store {
    fn new(name: &'static str, base: u32, len: u32) -> Self {
        Self {
            name,
            base,
            len,
            bytes: Arc::new(RamStore::new(len.into())),
        }
    }

    fn offset(&self, address: u32) -> Result<u64, Fault> {
        let outside = || Fault::Memory(format!("{address:#010x} is not in {}", self.name));
        let offset = address.checked_sub(self.base).map(u64::from);
        offset.ok_or_else(outside)
    }

    fn read(&self, address: u32, into: &mut [u8]) -> Result<(), Fault> {
        let read = self.bytes.read_at(self.offset(address)?, into);
        read.map_err(refused).map(drop)
    }

    fn write(&self, address: u32, bytes: &[u8]) -> Result<(), Fault> {
        let written = self.bytes.write_at(self.offset(address)?, bytes);
        written.map_err(refused).map(drop)
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Memories {
    flash: Store,
    ram: Store,
}

impl Memories {
    /// With a program's segments flashed; the rest of flash is erased, RAM is zero.
    pub(crate) fn flashed<'s>(
        segments: impl Iterator<Item = (u32, &'s [u8])>,
        flash_len: u32,
        ram_len: u32,
    ) -> Result<Self, Fault> {
        let memories = Self {
            flash: Store::new("flash", FLASH, flash_len),
            ram: Store::new("RAM", RAM, ram_len),
        };
        memories.erase(FLASH..FLASH + flash_len)?;
        for (address, contents) in segments {
            if address < FLASH {
                return Err(Fault::Program(format!("a segment at {address:#x}")));
            }
            memories.flash.write(address, contents)?;
        }
        Ok(memories)
    }

    pub(crate) fn space(&self, shared: &Arc<Shared>) -> Result<AddressSpace, Fault> {
        // Flash and RAM, which are read most, are found without a search.
        let space = AddressSpace::new("chip", 32)
            .with_unassigned(UnassignedPolicy::FAULT)
            .with_dispatch(DispatchPolicy::Dense {
                page_bits: 12,
                cover: u64::from(RAM) + u64::from(self.ram.len),
            });
        {
            let registers = |base| {
                Arc::new(Registers {
                    shared: Arc::clone(shared),
                    base,
                })
            };
            let mut map = space.topology();
            let [flash, ram] = [&self.flash, &self.ram].map(|store| Arc::clone(&store.bytes));
            // Read as memory; what is stored goes to the flash interface.
            let read = Mapping::new(Region::ram("flash", flash), FLASH.into());
            map.map_with(read.with_perms(Perms::RX)).map_err(refused)?;
            let stores = Arc::new(FlashStores {
                shared: Arc::clone(shared),
                memories: self.clone(),
            });
            let stores = Region::io("stores into flash", self.flash.len.into(), stores);
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
        self.flash.len
    }

    pub(crate) fn read(&self, address: u32, bytes: &mut [u8]) -> Result<(), Fault> {
        self.ram.read(address, bytes)
    }

    pub(crate) fn write(&self, address: u32, bytes: &[u8]) -> Result<(), Fault> {
        self.ram.write(address, bytes)
    }

    pub(crate) fn bytes<const N: usize>(&self, address: u32) -> Result<[u8; N], Fault> {
        let mut bytes = [0; N];
        self.read(address, &mut bytes)?;
        Ok(bytes)
    }

    pub(crate) fn word(&self, address: u32) -> Result<u32, Fault> {
        self.bytes(address).map(u32::from_le_bytes)
    }

    /// That of the two which an address would be in.
    const fn store(&self, address: u32) -> &Store {
        if address < RAM {
            &self.flash
        } else {
            &self.ram
        }
    }

    pub(crate) fn flip(&self, address: u32, bits: u8) -> Result<(), Fault> {
        let outside = || Fault::Memory(format!("{address:#010x} is not in memory"));
        let byte = self.get(address).ok_or_else(outside)?;
        self.store(address).write(address, &[byte ^ bits])
    }

    pub(crate) fn erase(&self, place: Range<u32>) -> Result<(), Fault> {
        self.flash.write(place.start, &vec![ERASED; place.len()])
    }

    /// Programs bytes of flash, which can clear bits and set none.
    pub(crate) fn program(&self, address: u32, bytes: &[u8]) -> Result<(), Fault> {
        let there = self.bytes_at(address, bytes.len())?;
        let left: Vec<u8> = there.iter().zip(bytes).map(|(a, b)| a & b).collect();
        self.flash.write(address, &left)
    }

    pub(crate) fn bytes_at(&self, address: u32, length: usize) -> Result<Vec<u8>, Fault> {
        let mut bytes = vec![0; length];
        self.store(address).read(address, &mut bytes)?;
        Ok(bytes)
    }

    pub(crate) fn lose_ram(&self) -> Result<(), Fault> {
        self.write(RAM, &vec![0; self.ram.len as usize])
    }

    pub(crate) fn get(&self, address: u32) -> Option<u8> {
        let mut byte = [0];
        self.store(address).read(address, &mut byte).ok()?;
        Some(byte[0])
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
