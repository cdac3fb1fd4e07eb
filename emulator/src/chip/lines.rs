//! EXTI: the line of the voltage detector (RM0390, chapter 10; RM0008, chapter 10; RM0444,
//! chapter 13). Other lines, events and requests by software are not modelled.

use super::fields::{Field, whole};

/// The detector's line, by its bit.
const DETECTOR: u32 = 1 << 16;

#[derive(Debug)]
pub(super) struct Layout {
    /// Interrupt mask, and its value after a reset.
    mask: (u32, u32),
    /// Rising edges that count.
    rising: u32,
    /// Lines that have had one.
    pending: u32,
}

/// Of the STM32F1 and F4.
pub(super) static V1: Layout = Layout {
    mask: (0x00, 0),
    rising: 0x08,
    pending: 0x14,
};

/// Of the STM32G0.
pub(super) static G0: Layout = Layout {
    mask: (0x80, 0xFFF8_0000),
    rising: 0x00,
    pending: 0x0C,
};

/// Their bits are the lines' numbers.
pub(super) fn fields(layout: &Layout) -> Vec<Field> {
    let pending = if layout.mask.0 == 0 { "PR" } else { "RPR" };
    vec![
        whole("IMR", layout.mask.0),
        whole("RTSR", layout.rising),
        whole(pending, layout.pending),
    ]
}

#[derive(Debug)]
pub(super) struct Lines {
    layout: &'static Layout,
    mask: u32,
    rising: u32,
    pending: u32,
}

impl Lines {
    pub(super) const fn new(layout: &'static Layout) -> Self {
        Self {
            layout,
            mask: layout.mask.1,
            rising: 0,
            pending: 0,
        }
    }

    pub(super) const fn reset(&mut self) {
        *self = Self::new(self.layout);
    }

    pub(super) const fn rise(&mut self) {
        self.pending |= self.rising & DETECTOR;
    }

    pub(super) const fn interrupts(&self) -> bool {
        self.pending & self.mask & DETECTOR != 0
    }

    pub(super) fn read(&self, offset: u32) -> Option<u32> {
        let layout = self.layout;
        Some(match offset {
            at if at == layout.mask.0 => self.mask,
            at if at == layout.rising => self.rising,
            at if at == layout.pending => self.pending,
            _ => return None,
        })
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) -> bool {
        let layout = self.layout;
        let only_detector = |value: u32, after_reset: u32| value & !DETECTOR == after_reset;
        match offset {
            at if at == layout.mask.0 && only_detector(value, layout.mask.1) => self.mask = value,
            at if at == layout.rising && only_detector(value, 0) => self.rising = value,
            // Ones clear.
            at if at == layout.pending => self.pending &= !value,
            _ => return false,
        }
        true
    }
}
