//! mlx90333
#![cfg_attr(not(test), no_std)]
