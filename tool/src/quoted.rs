//! Paths in commands that somebody may copy into a shell.

use std::path::Path;

/// A path as a shell takes it: in quotes if it has blanks or what a shell reads otherwise.
pub(crate) fn quoted(path: &Path) -> String {
    let name = path.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "._-+/:=@%,".contains(c);
    if cfg!(not(unix)) || name.chars().all(is_plain) {
        return name;
    }
    format!("'{}'", name.replace('\'', "'\\''"))
}

#[cfg(all(test, unix))]
mod tests {
    use std::path::Path;
    use std::process::Command;

    #[test]
    fn a_shell_takes_it_as_one_word() {
        for name in ["out/a-1.csv", "my bench/ö.toml", "it's $HOME & *.csv"] {
            let script = format!("printf %s {}", super::quoted(Path::new(name)));
            let printed = Command::new("sh").args(["-c", &script]).output().unwrap();
            assert_eq!(String::from_utf8_lossy(&printed.stdout), name);
        }
        assert_eq!(super::quoted(Path::new("out/a.csv")), "out/a.csv");
    }
}
