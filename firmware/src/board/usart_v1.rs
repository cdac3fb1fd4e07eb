//! USARTs with one data register (STM32F1, STM32F4).

use stm32_metapac::usart::Usart;

/// Where bytes come from, and where they go to.
pub(crate) fn data_registers(usart: Usart) -> [u32; 2] {
    // Pointers have 32 bits on these chips.
    [usart.dr().as_ptr() as u32; 2]
}

/// Eight bits, no parity, one stop bit, `divider` clocks a bit; both ways by DMA.
pub(crate) fn start(usart: Usart, divider: u16) {
    usart.brr().write(|w| w.0 = divider.into());
    usart.cr3().write(|w| {
        w.set_dmar(true);
        w.set_dmat(true);
    });
    usart.cr1().write(|w| {
        w.set_te(true);
        w.set_re(true);
        w.set_ue(true);
    });
}
