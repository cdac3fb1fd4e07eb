//! The status registers, bit by bit, against the table of known bits.

use tmag5170::{Fault, StatusFaults};

/// Written out once more, from TI's tmag5170.h: AFE_STATUS, SYS_STATUS, name.
const TABLE: [(u16, u16, &str); 18] = [
    (0x8000, 0, "restarted"),
    (0x1000, 0, "signal chain"),
    (0x0800, 0, "temperature chain"),
    (0x0400, 0, "Hall element Z"),
    (0x0200, 0, "Hall element Y"),
    (0x0100, 0, "Hall element X"),
    (0x0002, 0, "trim memory"),
    (0x0001, 0, "internal supply too low"),
    (0, 0x4000, "ALERT pin held"),
    (0, 0x2000, "SDO pin held"),
    (0, 0x1000, "frame with a wrong CRC"),
    (0, 0x0800, "frame of a wrong length"),
    (0, 0x0020, "supply too high"),
    (0, 0x0010, "supply too low"),
    (0, 0x0008, "temperature beyond its limits"),
    (0, 0x0004, "Z beyond its limits"),
    (0, 0x0002, "Y beyond its limits"),
    (0, 0x0001, "X beyond its limits"),
];

#[test]
fn each_known_bit() {
    for ((afe, sys, name), known) in TABLE.into_iter().zip(StatusFaults::KNOWN) {
        let faults = StatusFaults::new(afe, sys);
        assert_eq!((faults.afe_status(), faults.sys_status()), (afe, sys));
        assert_eq!(faults, known.bit);
        assert_eq!(faults.unknown(), 0);
        assert_eq!(faults.to_string(), name);
        assert_eq!(faults.named().collect::<Vec<_>>(), [known]);
        assert!(known.cause.len() > 10, "{name}");
    }
}

#[test]
fn each_pair_of_known_bits() {
    for (i, Fault { bit: high, .. }) in StatusFaults::KNOWN.into_iter().enumerate() {
        for Fault { bit: low, .. } in StatusFaults::KNOWN.into_iter().skip(i + 1) {
            let both = high | low;
            assert!(both.contains(high) && both.contains(low) && !low.contains(both));
            assert_eq!(both.without(high), low);
            assert_eq!(both.to_string(), format!("{high}, {low}"));
        }
    }
}

#[test]
fn what_is_no_fault_is_left_out() {
    // The level of ALERT, and the operating state.
    assert!(StatusFaults::new(0, 0x8700).is_empty());
    assert_eq!(StatusFaults::new(0, 0x8700), StatusFaults::NONE);
    assert_eq!(StatusFaults::NONE.to_string(), "none");
}

#[test]
fn each_unknown_bit_is_kept_and_told() {
    for bits in [
        0x4000, 0x2000, 0x0080, 0x0040, 0x0020, 0x0010, 0x0008, 0x0004,
    ] {
        let faults = StatusFaults::new(bits, 0);
        assert_eq!(faults.unknown(), u32::from(bits) << 16);
        assert_eq!(faults.named().count(), 0);
        assert_eq!(faults.to_string(), format!("unknown {bits:#06x}0000"));
    }
    let mixed = StatusFaults::new(0x8000, 0x0050);
    assert_eq!(
        mixed.to_string(),
        "restarted, supply too low, unknown 0x00000040"
    );
}
