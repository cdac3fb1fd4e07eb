//! The command line. `host-sim --help` documents it.

fn main() -> std::process::ExitCode {
    host_sim::commands::program::main()
}
