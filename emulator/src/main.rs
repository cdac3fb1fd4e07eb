//! The emulated board's command line; `cargo xtask emulate` builds the program and calls it.

fn main() -> std::process::ExitCode {
    emulator::main()
}
