//! What idle knows of the scene, whose settings are the tick's.

use firmware::{Links, NAME_BYTES};

use super::types::Settings;

pub(crate) const NO_SCENE: &str = "no-scene";

/// It does not change while the module runs.
pub(crate) struct About {
    name: heapless::String<NAME_BYTES>,
    tick_hz: u32,
    whiskers: u32,
    pub(crate) links: Links,
    pub(crate) has_motors: bool,
}

impl About {
    pub(crate) fn new(settings: &Settings, node: u8) -> Self {
        Self {
            name: settings.head.name.clone(),
            tick_hz: settings.head.tick_hz,
            whiskers: settings.head.of_node(node).len() as u32,
            links: settings.links,
            has_motors: settings.motion.is_some(),
        }
    }

    pub(crate) fn name(&self) -> &str {
        if self.name.is_empty() {
            NO_SCENE
        } else {
            &self.name
        }
    }

    /// Bits a second that records of every tick take, each byte with its start and stop.
    pub(crate) const fn records_baud(&self) -> u32 {
        self.tick_hz
            .saturating_mul(self.whiskers * wire::RECORD_FRAME_BYTES as u32 * 10)
    }
}
