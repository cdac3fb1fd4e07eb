//! What the README tells a newcomer to run.

use crate::run::{Fault, cargo, read, run, top};

/// How the simulator's commands begin; those of other programs take longer and have
/// steps of their own.
const SIMULATOR: &str = "cargo run --release -p host-sim -- ";

/// Runs the README's commands of the simulator, as they stand there.
///
/// # Errors
/// The first that fails, or if there are none.
pub(crate) fn all() -> Result<(), Fault> {
    let commands = commands(&read(&top().join("README.md"))?);
    for command in &commands {
        let arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
        run(&mut cargo(&arguments))?;
    }
    match commands.len() {
        0 => Err("README.md has no command of the simulator".to_owned()),
        _ => Ok(()),
    }
}

/// The commands in the `sh` blocks of `text`, each in one line.
fn commands(text: &str) -> Vec<String> {
    let blocks = text.split("```sh\n").skip(1);
    let blocks = blocks.filter_map(|block| block.split("```").next());
    let lines = blocks.flat_map(|block| {
        let joined = block.replace("\\\n", " ");
        joined.lines().map(str::to_owned).collect::<Vec<_>>()
    });
    lines.filter(|line| line.starts_with(SIMULATOR)).collect()
}

#[cfg(test)]
mod tests {
    use super::{SIMULATOR, commands};

    #[test]
    fn commands_are_found_in_shell_blocks_alone() {
        let text = format!(
            "`{SIMULATOR}--help`\n```sh\n{SIMULATOR}run \\\n  a.toml\ncargo test\n```\n{SIMULATOR}\n"
        );
        let found = commands(&text);
        assert_eq!(found, [format!("{SIMULATOR}run    a.toml")]);
    }
}
