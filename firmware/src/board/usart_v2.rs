//! USARTs with a data register each way (STM32G0).

use stm32_metapac::usart::Usart;

pub(crate) fn data_registers(usart: Usart) -> [u32; 2] {
    // Pointers have 32 bits on these chips.
    [usart.rdr().as_ptr() as u32, usart.tdr().as_ptr() as u32]
}

/// Eight bits, no parity, one stop bit, `divider` clocks a bit; both ways by DMA.
pub(crate) fn start(usart: Usart, divider: u16) {
    usart.brr().write(|w| w.0 = divider.into());
    usart.cr3().write(|w| {
        w.set_dmar(true);
        w.set_dmat(true);
        // A byte that was lost must not stop those after it.
        w.set_ovrdis(true);
    });
    usart.cr1().write(|w| {
        w.set_te(true);
        w.set_re(true);
        w.set_ue(true);
    });
}
