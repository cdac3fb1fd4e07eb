//! The byte-per-interrupt transfer against a plain list of bytes.

use crate::common::{pair, rule};
use mlx90333::{Decoder, Faults, Frame, Mode, Step, Transfer, encode};
use proptest::prelude::*;

fn run(transfer: &mut Transfer, bytes: [u8; 8]) -> [u8; 8] {
    assert_eq!(transfer.start(), 0xFF);
    let (last, others) = bytes.split_last().unwrap();
    for &byte in others {
        assert_eq!(transfer.on_byte(byte), Step::Send(0xFF));
        assert!(transfer.is_busy());
    }
    match transfer.on_byte(*last) {
        Step::Done(received) => received,
        step => panic!("{step:?}"),
    }
}

#[derive(Clone, Copy, Debug)]
enum Event {
    Start,
    Byte(u8),
    Abort,
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        2 => Just(Event::Start),
        20 => any::<u8>().prop_map(Event::Byte),
        1 => Just(Event::Abort),
    ]
}

#[test]
fn idle_drops_bytes() {
    let mut transfer = Transfer::default();
    assert!(!transfer.is_busy());
    for _ in 0..20 {
        assert_eq!(transfer.on_byte(0x55), Step::Idle);
    }
    let bytes = [0xFF, 1, 2, 3, 4, 5, 6, 7];
    assert_eq!(run(&mut transfer, bytes), bytes);
    assert_eq!(transfer.on_byte(0x55), Step::Idle);
}

proptest! {
    #[test]
    fn frames_decode_as_sent(frames in prop::collection::vec(pair(), 1..5), rule in rule()) {
        let decoder = Decoder::with(Mode::AlphaBeta, rule);
        let mut transfer = Transfer::new();
        for (alpha, beta) in frames {
            let sent = encode::alpha_beta(alpha, beta, Faults::NONE, rule);
            let received = run(&mut transfer, sent);
            prop_assert!(!transfer.is_busy());
            prop_assert_eq!(decoder.decode(&received), Ok(Frame::AlphaBeta { alpha, beta }));
        }
    }

    #[test]
    fn any_order_of_events(events in prop::collection::vec(event(), 0..200)) {
        let mut transfer = Transfer::new();
        let mut model: Option<Vec<u8>> = None;
        for event in events {
            match event {
                Event::Start => {
                    prop_assert_eq!(transfer.start(), 0xFF);
                    model = Some(Vec::new());
                }
                Event::Abort => {
                    transfer.abort();
                    model = None;
                }
                Event::Byte(byte) => {
                    let step = transfer.on_byte(byte);
                    let Some(list) = &mut model else {
                        prop_assert_eq!(step, Step::Idle);
                        continue;
                    };
                    list.push(byte);
                    if let Ok(frame) = <[u8; 8]>::try_from(list.as_slice()) {
                        prop_assert_eq!(step, Step::Done(frame));
                        model = None;
                    } else {
                        prop_assert_eq!(step, Step::Send(0xFF));
                    }
                }
            }
            prop_assert_eq!(transfer.is_busy(), model.is_some());
        }
    }
}
