//! That the same sources give the same bytes: the firmware of a scene, built from two
//! copies of the tree, in folders of other names, each from nothing.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use object::{Object, ObjectSection, SectionFlags};

use crate::firmware::{self, Board, with_elf};
use crate::run::{Fault, cargo, output, read_bytes, remove, run, target, top, write};

/// Where the copies stand, below the target folder: names of other lengths.
const COPIES: [&str; 2] = ["reproducible/a", "reproducible/another/place"];

/// A section with this flag is loaded.
const LOADED: u64 = object::elf::SHF_ALLOC as u64;

/// Builds the firmware of `scene` for `board` twice and compares what is flashed, and the
/// whole ELF file.
pub(crate) fn twice(board: Board, scene: &Path) -> Result<(), Fault> {
    let [first, second] = COPIES.map(|name| copy(&target().join(name)));
    let [first, second] = [
        build(board, scene, &first?)?,
        build(board, scene, &second?)?,
    ];
    let [flashed, again] = [flashed(&first)?, flashed(&second)?];
    let bytes: usize = flashed.iter().map(|(_, data)| data.len()).sum();
    let place = format!("{} on {}", scene.display(), board.name);
    for (one, other) in flashed.iter().zip(&again) {
        if one != other {
            return Err(format!("{place}: section {} differs", one.0));
        }
    }
    if flashed.len() != again.len() {
        return Err(format!("{place}: other sections"));
    }
    if read_bytes(&first)? != read_bytes(&second)? {
        return Err(format!(
            "{place}: the same {bytes} bytes are flashed; the ELF file differs"
        ));
    }
    println!("{place}: two builds, the same {bytes} bytes flashed and the same ELF file");
    Ok(())
}

pub(crate) fn copy(folder: &Path) -> Result<PathBuf, Fault> {
    let wrong = |error: std::io::Error| format!("{}: {error}", folder.display());
    remove(folder)?;
    let mut git = Command::new("git");
    let files = ["ls-files", "--cached", "--others", "--exclude-standard"];
    for file in output(git.args(files).current_dir(top()))?.lines() {
        let (from, to) = (top().join(file), folder.join(file));
        // What is removed and not yet committed is listed, too.
        if from.is_file() {
            fs::create_dir_all(to.parent().unwrap_or(folder)).map_err(wrong)?;
            fs::copy(&from, &to).map_err(wrong)?;
        }
    }
    Ok(folder.to_owned())
}

fn build(board: Board, scene: &Path, folder: &Path) -> Result<PathBuf, Fault> {
    let built = folder.join("target");
    let remap = format!("-D warnings --remap-path-prefix={}=.", folder.display());
    let linked = firmware::linked(board, &folder.join(scene))??;
    let arguments = board.build_arguments(&linked.image.features);
    let mut compiler = cargo(&format!("build --quiet {arguments}"));
    run(compiler
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", &built)
        .env("RUSTFLAGS", remap))?;
    let program = read_bytes(&firmware::elf_in(board, &built))?;
    let elf = built.join("linked.elf");
    write(&elf, linked.with(board, &program)?)?;
    Ok(elf)
}

fn flashed(elf: &Path) -> Result<Vec<(String, Vec<u8>)>, Fault> {
    with_elf(elf, |file| {
        let mut sections = Vec::new();
        for section in file.sections() {
            let SectionFlags::Elf { sh_flags } = section.flags() else {
                continue;
            };
            if sh_flags & LOADED != 0 {
                sections.push((section.name()?.to_owned(), section.data()?.to_owned()));
            }
        }
        Ok::<_, object::Error>(sections)
    })
}
