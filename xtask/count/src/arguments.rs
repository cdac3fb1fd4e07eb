//! Arguments of kernels, passed in the registers that as many single ones have.

/// Two arguments.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Two<R>(pub R, pub R);

/// Three arguments.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Three<R>(pub R, pub R, pub R);
