//! Commands and replies against frames written by hand, and against each other.

use crate::common::{crc_by_shifting, sealed};
use proptest::prelude::*;
use proptest::sample::select;
use tmag5170::{
    Access, ChannelPair, Command, CommandError, ConversionStatus, DataType, Register, Reply,
    ReplyError, Status, encode,
};

fn register() -> impl Strategy<Value = Register> {
    select(Register::ALL.to_vec())
}

#[test]
fn commands_by_hand() {
    // The frame that the data sheet gives for switching the CRC off.
    let off = Command::write(Register::TestConfig, 0x0004);
    assert_eq!(off.bytes(), 0x0F00_0407_u32.to_be_bytes());
    // The read of TEST_CONFIG in TI's forum, with its check bits put in.
    let read = Command::read(Register::TestConfig);
    assert_eq!(read.bytes(), 0x8F00_0008_u32.to_be_bytes());
    assert_eq!(
        Command::read(Register::X).and_convert().bytes(),
        sealed(0x0890_0001)
    );
    assert_eq!(
        Command::read(Register::X).and_tell_type().bytes(),
        sealed(0x0890_0002)
    );
}

#[test]
fn addresses_are_those_of_the_table() {
    for (address, register) in (0..).zip(Register::ALL) {
        assert_eq!(register.address(), address);
        assert_eq!(Register::at(address), Some(register));
    }
    for address in 21..=u8::MAX {
        assert_eq!(Register::at(address), None);
    }
    let read_none = sealed(0x0950_0000);
    assert_eq!(
        Command::decode(&read_none),
        Err(CommandError::NoRegister(0x15))
    );
}

#[test]
fn registers_after_a_reset() {
    // TI's tmag5170.h.
    let defaults = [
        0, 0, 0, 0, 0x7D83, 0x7D83, 0x7D83, 0x6732, 0, 0, 0, 0, 0, 0x8000, 0, 0x0040, 0, 0, 0, 0, 0,
    ];
    assert_eq!(Register::ALL.map(Register::after_reset), defaults);
    let read_only = [0x08, 0x09, 0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x10, 0x13, 0x14];
    for register in Register::ALL {
        assert_eq!(
            register.is_setting(),
            !read_only.contains(&register.address())
        );
    }
}

#[test]
fn a_reply_by_hand() {
    // S11..S4 = 0xA5, value 0x1234, S3..S0 = 0xE.
    let bytes = sealed(0x0A51_234E);
    let reply = Reply::decode(&bytes).unwrap();
    assert_eq!(reply.value, 0x1234);
    assert_eq!(reply.status, Status::new(0xA5E));
    assert_eq!(reply.status.count(), 6);
    assert!(reply.status.contains(Status::PREVIOUS_CRC) && reply.status.contains(Status::SYSTEM));
    assert!(!reply.status.contains(Status::AFE));
}

#[test]
fn the_reply_of_the_forum() {
    // Thread 1374120: just powered up (S10), something in SYS_STATUS (S9), an error (S3).
    let reply = Reply::decode(&0x6000_008C_u32.to_be_bytes()).unwrap();
    assert_eq!(reply.status.bits(), 0x608);
    assert_eq!(reply.trusted(), Err(ReplyError::Restarted));
}

#[test]
fn a_pair_by_hand() {
    // As TI's specialRead: nibbles S, 2, 2, 1, 1, 2, 1.
    let bytes = sealed(0x0145_7869);
    let pair = ChannelPair::decode(&bytes).unwrap();
    assert_eq!(
        (pair.status.bits(), pair.second, pair.first),
        (1, 0x456, 0x789)
    );
    assert_eq!(bytes, encode::pair(Status::new(1), 0x789, 0x456));
}

#[test]
fn what_a_status_lets_pass() {
    let reply = |bits| Reply {
        status: Status::new(bits),
        value: 7,
    };
    // That the command before was rejected was told then.
    assert_eq!(reply(0x8F7).trusted(), Ok(7));
    assert_eq!(reply(0x400).trusted(), Err(ReplyError::Restarted));
    assert_eq!(
        reply(0x10A).trusted(),
        Err(ReplyError::Sensor(Status::new(0x10A)))
    );
    let pair = |bits| ChannelPair {
        status: Status::new(bits),
        first: 1,
        second: 2,
    };
    assert_eq!(pair(2).trusted(DataType::Xz), Ok(pair(2)));
    assert_eq!(pair(2).trusted(DataType::Xy), Err(ReplyError::OtherType(2)));
    assert_eq!(
        pair(10).trusted(DataType::Xz),
        Err(ReplyError::Sensor(Status::new(10)))
    );
}

#[test]
fn conversion_status_by_hand() {
    let status = ConversionStatus::new(0x2550);
    assert!(status.ready());
    assert_eq!(status.new_axes(), [true, false, true]);
    assert_eq!(status.count(), 5);
    assert_eq!(
        ConversionStatus::new(0x0200).new_axes(),
        [false, true, false]
    );
}

#[test]
fn each_error_has_its_words() {
    let words = [
        (ReplyError::NoSensor, "no sensor: all bits one"),
        (ReplyError::LineLow, "data line stuck low: all bits zero"),
        (
            ReplyError::Rejected,
            "the sensor found a wrong CRC in the command",
        ),
        (
            ReplyError::BadCrc {
                expected: 6,
                found: 12,
            },
            "bad CRC: 0xc, expected 0x6",
        ),
        (ReplyError::Restarted, "the sensor has restarted"),
        (
            ReplyError::Sensor(Status::new(0x108)),
            "the sensor reports a fault: status 0x108",
        ),
        (ReplyError::OtherType(4), "data of another type: 4"),
    ];
    for (error, expected) in words {
        let error: Box<dyn std::error::Error> = Box::new(error);
        assert_eq!(error.to_string(), expected);
    }
}

proptest! {
    #[test]
    fn commands_come_back(
        register in register(), value: u16, write: bool, convert: bool, tell_type: bool,
    ) {
        let access = if write {
            Access::Write(register, value)
        } else {
            Access::Read(register)
        };
        let command = Command { access, convert, tell_type };
        let bytes = command.bytes();
        prop_assert_eq!(bytes[3] & 0x0F, crc_by_shifting(bytes));
        prop_assert_eq!(bytes[3] & 0xC0, 0);
        prop_assert_eq!(Command::decode(&bytes), Ok(command));
    }

    #[test]
    fn replies_come_back(status in 0_u16..0x1000, value: u16) {
        let bytes = encode::register(Status::new(status), value);
        let reply = Reply { status: Status::new(status), value };
        match u32::from_be_bytes(bytes) {
            0 | u32::MAX => prop_assert!(false),
            _ => prop_assert_eq!(Reply::decode(&bytes), Ok(reply)),
        }
        let rejecting = encode::rejecting(bytes);
        // All bits one is taken for a line that nobody drives.
        if rejecting != [0xFF; 4] {
            prop_assert_eq!(Reply::decode(&rejecting), Err(ReplyError::Rejected));
        }
    }

    #[test]
    fn pairs_come_back(status in 0_u16..16, first in 0_u16..4096, second in 0_u16..4096) {
        let status = Status::new(status);
        let bytes = encode::pair(status, first, second);
        prop_assert_eq!(ChannelPair::decode(&bytes), Ok(ChannelPair { status, first, second }));
        let rejecting = encode::rejecting(bytes);
        if rejecting != [0xFF; 4] {
            prop_assert_eq!(ChannelPair::decode(&rejecting), Err(ReplyError::Rejected));
        }
    }

    /// What a sensor sends that has restarted meanwhile is no pair of two axes.
    #[test]
    fn a_register_after_a_restart_is_no_pair(status in 0_u16..0x1000, value: u16) {
        let restarted = Status::new(status | 0x400);
        let bytes = encode::register(restarted, value);
        let pair = ChannelPair::decode(&bytes).unwrap();
        for axes in [DataType::Xy, DataType::Xz, DataType::Zy] {
            prop_assert!(matches!(pair.trusted(axes), Err(ReplyError::OtherType(4..=7))));
        }
    }
}
