//! Does what the pages tell their reader to do: the commands of the book, of the README and of
//! CONTRIBUTING, page by page, each in a folder of its own that holds the scenes.

mod blocks;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::run::{AT_ONCE, Fault, built, each, listing, read, read_bytes, remove, top, write};
use crate::studies;
use blocks::{Block, When, blocks, differs, pages};

/// Pages with commands that are not in the book.
const BESIDE: [&str; 2] = ["README.md", "CONTRIBUTING.md"];

/// What the commands of a page find in their folder: from where, and which files.
const FOUND: [(&str, &str); 4] = [
    ("scenes", "toml"),
    ("scenes/models", "model"),
    ("tests/data/terrain", "csv"),
    ("docs/measured", "csv"),
];

#[derive(clap::Args)]
pub(crate) struct Choice {
    /// The pages, such as docs/bench.md; without any, all of docs/SUMMARY.md, the README and
    /// CONTRIBUTING
    pages: Vec<PathBuf>,
    /// The blocks marked `sh nightly` too, which take long
    #[arg(long)]
    nightly: bool,
    /// Run nothing, say which blocks are run when
    #[arg(long)]
    list: bool,
}

/// What CI runs of all pages.
pub(crate) fn short() -> Result<(), Fault> {
    with(&[], false)
}

/// All that can be run without hardware.
pub(crate) fn nightly() -> Result<(), Fault> {
    with(&[], true)
}

pub(crate) fn all(choice: &Choice) -> Result<(), Fault> {
    if !choice.list {
        return with(&choice.pages, choice.nightly);
    }
    for (page, blocks) in chosen(&choice.pages)? {
        for block in blocks {
            println!("{:9} {}:{}", block.when.name(), page.display(), block.line);
        }
    }
    Ok(())
}

fn with(pages: &[PathBuf], nightly: bool) -> Result<(), Fault> {
    let mut run = 0;
    let mut not_run = Vec::new();
    let mut walked = Vec::new();
    for (page, blocks) in chosen(pages)? {
        let (now, later): (Vec<Block>, Vec<Block>) =
            blocks.into_iter().partition(|block| match block.when {
                When::Always => true,
                When::Nightly => nightly,
                When::Hardware => false,
            });
        for block in later {
            let (when, line) = (block.when.name(), block.line);
            not_run.push(format!("{when:9} {}:{line}", page.display()));
        }
        run += now.len();
        walked.push((page, now));
    }
    walked.retain(|(_, blocks)| !blocks.is_empty());
    each(walked, AT_ONCE, |(page, blocks)| walk(&page, &blocks))?;
    println!("{run} blocks run; not run:");
    for block in not_run {
        println!("{block}");
    }
    match run {
        0 => Err("no page has a command to be run".to_owned()),
        _ => Ok(()),
    }
}

fn walk(page: &Path, blocks: &[Block]) -> Result<(), Fault> {
    let begun = Instant::now();
    let folder = folder(page)?;
    for block in blocks {
        do_block(page, block, &folder)?;
    }
    let seconds = begun.elapsed().as_secs_f64();
    let (page, blocks) = (page.display(), blocks.len());
    println!("== {page}: {blocks} blocks, {seconds:.1} s");
    Ok(())
}

/// The pages with their blocks, by the paths from the top.
fn chosen(wanted: &[PathBuf]) -> Result<Vec<(PathBuf, Vec<Block>)>, Fault> {
    let docs = Path::new("docs");
    let named = if wanted.is_empty() {
        let book = pages(&read(&top().join(docs).join("SUMMARY.md"))?);
        let book = book.into_iter().map(|page| docs.join(page));
        BESIDE.iter().map(PathBuf::from).chain(book).collect()
    } else {
        wanted.to_vec()
    };
    let with_blocks = named.into_iter().map(|page| {
        let blocks = blocks(&read(&top().join(&page))?);
        let blocks = blocks.map_err(|fault| format!("{}:{fault}", page.display()))?;
        Ok((page, blocks))
    });
    with_blocks.collect()
}

/// A folder for the commands of a page: with what they find there, and nothing that an
/// earlier walk has left. Within the workspace, so that cargo finds that.
fn folder(page: &Path) -> Result<PathBuf, Fault> {
    let name = page.with_extension("").display().to_string();
    let folder = top()
        .join("target/walk")
        .join(name.replace(['/', '\\'], "-"));
    remove(&folder)?;
    for (from, extension) in FOUND {
        for file in listing(&top().join(from), extension)? {
            let name = file.file_name().unwrap_or_default();
            write(&folder.join(from).join(name), read_bytes(&file)?)?;
        }
    }
    Ok(folder)
}

/// Commands that run the programs that CI has built, or build them.
fn as_built(commands: &str) -> String {
    let mut commands = commands.to_owned();
    for package in ["host-sim", "whisker"] {
        if let Some(program) = built(package) {
            let run = format!("cargo run -p {package} -- ");
            commands = commands.replace(&run, &format!("'{}' ", program.display()));
        }
    }
    // A page's folder is not at the top.
    let manifest = top().join(studies::MANIFEST);
    commands.replace(studies::MANIFEST, &format!("'{}'", manifest.display()))
}

/// Runs a block as its reader does, in a shell that stops at the first failure.
fn do_block(page: &Path, block: &Block, folder: &Path) -> Result<(), Fault> {
    let place = format!("{}:{}", page.display(), block.line);
    let commands = as_built(&block.commands);
    let script = format!("exec 2>&1\n{commands}");
    let shell = Command::new("bash")
        .args(["-eu", "-o", "pipefail", "-c", &script])
        .current_dir(folder)
        .env("CARGO_TERM_QUIET", "true")
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("{place}: bash: {error}"))?;
    let said = String::from_utf8_lossy(&shell.stdout);
    // In one piece: another page is walked at the same time.
    print!("== {place}\n{}\n{said}", block.commands.trim_end());
    if !shell.status.success() {
        return Err(format!("{place}: {}", shell.status));
    }
    let shown = block
        .shown
        .as_deref()
        .and_then(|shown| differs(shown, &said));
    shown.map_or(Ok(()), |line| {
        Err(format!("{place}: the page shows what is not said: {line}"))
    })
}
