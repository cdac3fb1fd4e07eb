//! Nothing: what this is for stands in its Cargo.toml.
