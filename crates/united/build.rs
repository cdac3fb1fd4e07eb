//! Nothing: without a build script cargo leaves out what Cargo.toml lists for one.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
}
