//! The byte-per-interrupt transfer against a plain list of bytes.

use mlx90333::{Step, Transfer};
use proptest::prelude::*;

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

proptest! {
    #[test]
    fn any_order_of_events(events in prop::collection::vec(event(), 0..200)) {
        let mut transfer = Transfer::default();
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
