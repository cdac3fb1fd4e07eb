//! What the README tells a newcomer to run, and the walk at the bench.

use std::fs;

use crate::run::{Fault, cargo, listing, read, read_bytes, run, target, top, write};

/// How the simulator's commands begin; those of other programs take longer and have
/// steps of their own.
const SIMULATOR: &str = "cargo run --release -p host-sim -- ";

/// How the commands of the walk begin: programs that the tests have built.
const WALK: [&str; 2] = ["cargo run -p whisker -- ", "cargo run -p host-sim -- "];

/// Runs the README's commands of the simulator, as they stand there.
///
/// # Errors
/// The first that fails, or if there are none.
pub(crate) fn all() -> Result<(), Fault> {
    let commands = commands(&read(&top().join("README.md"))?, &[SIMULATOR]);
    for command in &commands {
        let arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
        run(&mut cargo(&arguments))?;
    }
    match commands.len() {
        0 => Err("README.md has no command of the simulator".to_owned()),
        _ => Ok(()),
    }
}

/// Walks through `docs/tool.md`, in an empty folder with a copy of the scenes, as what is
/// captured is not overwritten.
///
/// # Errors
/// The first command that fails, or if there are none.
pub(crate) fn walk() -> Result<(), Fault> {
    let folder = target().join("walk");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    for (from, extension) in [("scenes", "toml"), ("scenes/models", "model")] {
        for file in listing(&top().join(from), extension)? {
            let name = file.file_name().unwrap_or_default();
            write(&folder.join(from).join(name), read_bytes(&file)?)?;
        }
    }
    let commands = commands(&read(&top().join("docs/tool.md"))?, &WALK);
    for command in &commands {
        let arguments = command
            .split_whitespace()
            .skip("cargo run".split(' ').count());
        let mut command = cargo(&["run", "--quiet", "--locked", "--manifest-path"]);
        let manifest = top().join("Cargo.toml");
        run(command.arg(manifest).args(arguments).current_dir(&folder))?;
    }
    if commands.is_empty() {
        return Err("docs/tool.md has no command".to_owned());
    }
    Ok(())
}

/// The commands in the `sh` blocks of `text` that begin so, each in one line.
fn commands(text: &str, beginnings: &[&str]) -> Vec<String> {
    let blocks = text.split("```sh\n").skip(1);
    let blocks = blocks.filter_map(|block| block.split("```").next());
    let lines = blocks.flat_map(|block| {
        let joined = block.replace("\\\n", " ");
        joined.lines().map(str::to_owned).collect::<Vec<_>>()
    });
    let is_one = |line: &String| beginnings.iter().any(|begins| line.starts_with(begins));
    lines.filter(is_one).collect()
}

#[cfg(test)]
mod tests {
    use super::{SIMULATOR, commands};

    #[test]
    fn commands_are_found_in_shell_blocks_alone() {
        let text = format!(
            "`{SIMULATOR}--help`\n```sh\n{SIMULATOR}run \\\n  a.toml\ncargo test\n```\n{SIMULATOR}\n"
        );
        let found = commands(&text, &[SIMULATOR]);
        assert_eq!(found, [format!("{SIMULATOR}run    a.toml")]);
    }
}
