//! The page's modules as one script, as a page from disk may load no module from a file.

use std::fs;
use std::path::Path;

/// The text of `first` after that of all modules that it imports, each once. They come to share
/// one scope, so a name that two of them give is an error in the browser.
///
/// # Errors
/// A file cannot be read, or has an import that is not `import { … } from "./NAME.js";` on one
/// line.
pub(crate) fn joined(folder: &Path, first: &str) -> Result<String, String> {
    let mut text = String::new();
    add(folder, first, &mut Vec::new(), &mut text)?;
    Ok(text)
}

fn add(
    folder: &Path,
    name: &str,
    taken: &mut Vec<String>,
    text: &mut String,
) -> Result<(), String> {
    if taken.iter().any(|other| other == name) {
        return Ok(());
    }
    taken.push(name.to_owned());
    let path = folder.join(name);
    let own = fs::read_to_string(&path).map_err(|why| format!("{}: {why}", path.display()))?;
    let (imports, rest): (Vec<&str>, Vec<&str>) =
        own.lines().partition(|line| line.starts_with("import "));
    for line in imports {
        let from = line.split_once(" from \"./");
        let wanted = from.and_then(|(_, rest)| rest.strip_suffix("\";"));
        let wanted = wanted.ok_or_else(|| format!("{name}: not on one line: {line}"))?;
        add(folder, wanted, taken, text)?;
    }
    for line in rest {
        text.push_str(line.strip_prefix("export ").unwrap_or(line));
        text.push('\n');
    }
    Ok(())
}
