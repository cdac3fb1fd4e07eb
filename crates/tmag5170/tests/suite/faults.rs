//! The status registers, bit by bit, against the table of known bits.

use tmag5170::StatusFaults;

/// Places of the faults in TI's tmag5170.h, AFE_STATUS above SYS_STATUS.
const PLACES: [u32; 18] = [
    31, 28, 27, 26, 25, 24, 17, 16, 14, 13, 12, 11, 5, 4, 3, 2, 1, 0,
];

/// The level of ALERT, and the operating state.
const NO_FAULTS: [u32; 4] = [15, 10, 9, 8];

#[test]
fn each_bit() {
    for place in 0..32 {
        let bits = 1_u32 << place;
        let [afe, sys] = [(bits >> 16) as u16, bits as u16];
        let faults = StatusFaults::new(afe, sys);
        if NO_FAULTS.contains(&place) {
            assert!(faults.is_empty());
            assert_eq!(faults.to_string(), "none");
            continue;
        }
        assert_eq!((faults.afe_status(), faults.sys_status()), (afe, sys));
        if let Some(row) = PLACES.iter().position(|&known| known == place) {
            let known = StatusFaults::KNOWN[row];
            assert_eq!(faults, known.bit);
            assert_eq!(faults.unknown(), 0);
            assert_eq!(faults.to_string(), known.name);
            assert_eq!(faults.named().collect::<Vec<_>>(), [known]);
        } else {
            assert_eq!(faults.unknown(), bits);
            assert_eq!(faults.named().count(), 0);
            assert_eq!(faults.to_string(), format!("unknown {bits:#010x}"));
        }
    }
}

#[test]
fn several_bits() {
    let [high, low] = [StatusFaults::RESTARTED, StatusFaults::SUPPLY_LOW];
    let both = high | low;
    assert!(both.contains(high) && both.contains(low) && !low.contains(both));
    assert_eq!(both.without(high), low);
    assert_eq!(
        StatusFaults::new(0x8000, 0x0050).to_string(),
        "restarted, supply too low, unknown 0x00000040"
    );
}
