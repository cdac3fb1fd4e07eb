//! What a DMA controller moves.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::chip) struct Move {
    pub(in crate::chip) peripheral: u32,
    pub(in crate::chip) memory: u32,
    pub(in crate::chip) to_memory: bool,
}
