//! A frame of the sensor.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::samples::frame;
use mlx90333::{Decoder, FRAME_LEN};

count::program!(
    ("integer": "frame decode",
        (bytes: &[u8; FRAME_LEN], _: &mut ()) -> u32 {
            match Decoder::new().decode(bytes) {
                Ok(frame) => {
                    u32::from(frame.first().raw()) << 16 | u32::from(frame.second().raw())
                }
                Err(_) => 0,
            }
        },
        frame, ()),
);
