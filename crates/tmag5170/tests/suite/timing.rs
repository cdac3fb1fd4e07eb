//! Durations against the data sheet's table of rates.

use tmag5170::timing::{
    CLOCK_MAX_HZ, START_UP_US, START_UP_WAIT_US, conversion_time_us, frame_time_ns,
};
use tmag5170::{Average, Channels};

/// SBASAF4, 7.3.4: thousands of sets a second of one, two and three axes.
const RATES: [[f64; 3]; 6] = [
    [20.0, 13.3, 10.0],
    [13.3, 8.0, 5.7],
    [8.0, 4.4, 3.1],
    [4.4, 2.4, 1.6],
    [2.4, 1.2, 0.8],
    [1.2, 0.6, 0.4],
];

#[test]
fn rates_of_the_table() {
    for (average, rates) in Average::ALL.iter().zip(RATES) {
        let channels = [Channels::X, Channels::Xy, Channels::Xyz];
        for (channels, rate) in channels.into_iter().zip(rates) {
            let time_us = conversion_time_us(channels, false, *average);
            let rounded = (10_000.0 / f64::from(time_us)).round() / 10.0;
            assert_eq!(rounded, rate, "{average:?} {channels:?}");
        }
    }
}

#[test]
fn the_temperature_is_a_channel() {
    let xy = conversion_time_us(Channels::Xy, true, Average::X8);
    assert_eq!(xy, conversion_time_us(Channels::Xyz, false, Average::X8));
    assert_eq!(conversion_time_us(Channels::Off, false, Average::X32), 0);
    assert_eq!(conversion_time_us(Channels::Off, true, Average::X1), 50);
}

#[test]
fn frames() {
    assert_eq!(frame_time_ns(CLOCK_MAX_HZ), 3_390);
    assert_eq!(frame_time_ns(1_000_000), 32_190);
    assert_eq!(frame_time_ns(0), u64::MAX);
    const { assert!(START_UP_WAIT_US > START_UP_US) };
}
