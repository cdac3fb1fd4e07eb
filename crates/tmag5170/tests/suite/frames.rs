//! Commands and replies against frames written by hand, and against each other.

use crate::common::{crc_by_shifting, sealed};
use proptest::prelude::*;
use proptest::sample::select;
use tmag5170::{Access, Command, CommandError, Register, Reply, ReplyError, Status, encode};

#[test]
fn commands_by_hand() {
    // The frame that the data sheet gives for switching the CRC off.
    let off = Command::write(Register::TestConfig, 0x0004);
    assert_eq!(off.bytes(), 0x0F00_0407_u32.to_be_bytes());
    // The read of TEST_CONFIG in TI's forum, with its check bits put in.
    let read = Command::read(Register::TestConfig);
    assert_eq!(read.bytes(), 0x8F00_0008_u32.to_be_bytes());
    let convert = Command {
        convert: true,
        ..Command::read(Register::X)
    };
    assert_eq!(convert.bytes(), sealed(0x0890_0001));
    // There are 21 registers.
    let read_none = Command::decode(&sealed(0x0950_0000));
    assert_eq!(read_none, Err(CommandError::NoRegister(21)));
}

#[test]
fn replies_by_hand() {
    // S11..S4 = 0xA5, value 0x1234, S3..S0 = 0xE.
    let reply = Reply::decode(&sealed(0x0A51_234E)).unwrap();
    assert_eq!((reply.status, reply.value), (Status::new(0xA5E), 0x1234));
    assert_eq!(reply.status.count(), 6);
    assert!(reply.status.contains(Status::PREVIOUS_CRC) && reply.status.contains(Status::SYSTEM));
    assert!(!reply.status.contains(Status::AFE));
    // That the command before was rejected is no fault of this reading.
    let status = Status::new(0x8F7);
    assert_eq!(Reply { status, ..reply }.trusted(), Ok(0x1234));
}

#[test]
fn errors_name_what_was_found() {
    let [expected, found] = [6, 12];
    let says = |error: ReplyError, words| assert_eq!(error.to_string(), words);
    says(
        ReplyError::BadCrc { expected, found },
        "bad CRC: 0xc, expected 0x6",
    );
    let status = Status::new(0x108);
    says(
        ReplyError::Sensor(status),
        "the sensor reports a fault: status 0x108",
    );
}

proptest! {
    #[test]
    fn commands_come_back(
        register in select(&Register::ALL[..]),
        written: Option<u16>,
        convert: bool,
    ) {
        let read = Access::Read(register);
        let access = written.map_or(read, |value| Access::Write(register, value));
        let command = Command { access, convert };
        let bytes = command.bytes();
        prop_assert_eq!(bytes[3] & 0x0F, crc_by_shifting(bytes));
        prop_assert_eq!(bytes[3] & 0xE0, 0);
        prop_assert_eq!(Command::decode(&bytes), Ok(command));
    }

    #[test]
    fn replies_come_back(status in 0_u16..0x1000, value: u16) {
        let status = Status::new(status);
        let bytes = encode::register(status, value);
        prop_assert_eq!(Reply::decode(&bytes), Ok(Reply { status, value }));
        let rejecting = encode::rejecting(bytes);
        // All bits one is taken for a line that no sensor drives.
        let error = match rejecting {
            [0xFF, 0xFF, 0xFF, 0xFF] => ReplyError::NoSensor,
            _ => ReplyError::Rejected,
        };
        prop_assert_eq!(Reply::decode(&rejecting), Err(error));
    }
}
