//! Motor outputs off, from anywhere and without asking anybody.

use stm32f4xx_hal::pac::{GPIOA, GPIOC, RCC, TIM1};

/// Takes all motor outputs of the board low: the PWM pins PA8 to PA10 and the
/// enables PC10 to PC12. The pins become plain outputs, so that no timer can
/// raise them again.
///
/// For the start and for fault handlers: no locks, nothing that can fail, and
/// calling it again changes nothing. The motor drivers do not know of it:
/// after it the chip must start anew.
#[inline(never)]
pub(crate) fn off() {
    #[allow(unsafe_code, reason = "a fault handler cannot own the peripherals")]
    // SAFETY: whoever owns them is not running (start, fault handlers). Read-modify-write
    // sequences below are not interrupted by anything that writes the same registers.
    let (rcc, timer, gpioa, gpioc) =
        unsafe { (RCC::steal(), TIM1::steal(), GPIOA::steal(), GPIOC::steal()) };

    // No main output, and no automatic return of it: the timer's outputs go to
    // their idle level, low. Without a clock TIM1 ignores this.
    timer.bdtr().modify(|_, w| {
        w.aoe().clear_bit().moe().clear_bit();
        w.ossi().set_bit()
    });

    rcc.ahb1enr()
        .modify(|_, w| w.gpioaen().set_bit().gpiocen().set_bit());
    gpioa
        .bsrr()
        .write(|w| w.br8().set_bit().br9().set_bit().br10().set_bit());
    gpioc
        .bsrr()
        .write(|w| w.br10().set_bit().br11().set_bit().br12().set_bit());
    gpioa.otyper().modify(|_, w| {
        w.ot8().push_pull().ot9().push_pull();
        w.ot10().push_pull()
    });
    gpioa.moder().modify(|_, w| {
        w.moder8().output().moder9().output();
        w.moder10().output()
    });
    gpioc.otyper().modify(|_, w| {
        w.ot10().push_pull().ot11().push_pull();
        w.ot12().push_pull()
    });
    gpioc.moder().modify(|_, w| {
        w.moder10().output().moder11().output();
        w.moder12().output()
    });
}
