//! A release: one archive with all that a stranger needs, which names no folder of the machine that
//! built it, and a test that uses nothing but this archive.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use std::{env, fs};

use crate::firmware::{self, Board};
use crate::run::{Fault, cargo, listing, output, read, remove, run, target, top, write};
use crate::{book, mount, page, python};

#[derive(clap::Args)]
pub(crate) struct Choice {
    /// Then unpack it into a clean folder, and take it to a decision of an emulated board
    #[arg(long)]
    test: bool,
    /// What the command runs itself as, with compilers that name no folder of this machine
    #[arg(long, hide = true, conflicts_with = "test")]
    within: bool,
}

/// The name of the folder in the archive, and of the archive.
const NAME: &str = concat!("whisker-", env!("CARGO_PKG_VERSION"), "-x86_64-linux");

/// What compilers compile for, as the names of their settings have it.
const TARGETS: [&str; 5] = [
    "X86_64_UNKNOWN_LINUX_GNU",
    "WASM32_UNKNOWN_UNKNOWN",
    "THUMBV7EM_NONE_EABIHF",
    "THUMBV7M_NONE_EABI",
    "THUMBV6M_NONE_EABI",
];

/// Files of the tree that are in the archive, too: from where, to where.
const COPIED: [(&str, &str); 7] = [
    ("xtask/src/dist/README.md", "README.md"),
    ("xtask/src/dist/try.sh", "try.sh"),
    ("CHANGELOG.md", "CHANGELOG.md"),
    ("CITATION.cff", "CITATION.cff"),
    ("LICENSE-APACHE", "LICENSE-APACHE"),
    ("LICENSE-MIT", "LICENSE-MIT"),
    ("docs/mount.svg", "mount/mount.svg"),
];

/// The most seconds from the archive to a decision, with each board.
const MOST_S: f64 = 60.0;

pub(crate) fn all(choice: &Choice) -> Result<(), Fault> {
    if choice.within {
        return fill(&folder_of(&target()));
    }
    let built = target().join("dist/build");
    let mut git = Command::new("git");
    git.args(["log", "-1", "--format=%ct"]).current_dir(top());
    let time = output(&mut git)?;
    let mut within = Command::new(env::current_exe().map_err(|error| error.to_string())?);
    within.args(["dist", "--within"]);
    within
        .env("CARGO_TARGET_DIR", &built)
        .env("CARGO_INCREMENTAL", "0")
        .env("SOURCE_DATE_EPOCH", time.trim())
        .env("WHISKER_RELEASE", "1")
        .env_remove("RUSTFLAGS");
    let flags = without_folders(&built)?;
    for target in TARGETS {
        within.env(format!("CARGO_TARGET_{target}_RUSTFLAGS"), &flags);
    }
    run(&mut within)?;
    let archive = pack(&folder_of(&built), time.trim())?;
    if choice.test { test(&archive) } else { Ok(()) }
}

pub(crate) fn nightly() -> Result<(), Fault> {
    all(&Choice {
        test: true,
        within: false,
    })
}

fn folder_of(built: &Path) -> PathBuf {
    built.with_file_name(NAME)
}

/// Has a compiler replace the folders of this machine, of several that fit by the last.
fn without_folders(built: &Path) -> Result<String, Fault> {
    let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let cargo = env::var_os("CARGO_HOME").map_or_else(|| home.join(".cargo"), PathBuf::from);
    let flags = [(&*top(), "."), (built, "target"), (&cargo, "cargo")].map(|(folder, name)| {
        let folder = folder.display().to_string();
        // Flags are divided at spaces.
        if folder.contains(' ') {
            Err(format!("{folder}: a release needs a path without spaces"))
        } else {
            Ok(format!("--remap-path-prefix={folder}={name}"))
        }
    });
    let flags: Result<Vec<_>, _> = flags.into_iter().collect();
    Ok(flags?.join(" "))
}

/// Builds all parts into the folder that becomes the archive.
fn fill(folder: &Path) -> Result<(), Fault> {
    remove(folder)?;
    let put = |from: &Path, to: &str| {
        let to = folder.join(to);
        let made = to.parent().map_or(Ok(()), fs::create_dir_all);
        let copied = made.and_then(|()| fs::copy(from, &to));
        copied
            .map(drop)
            .map_err(|error| format!("{}: {error}", from.display()))
    };
    let mut build = cargo("build --locked --release -p host-sim -p whisker");
    build.args(["--config", "profile.release.strip='symbols'"]);
    run(build.args(["--features", "whisker/probe"]))?;
    for program in ["host-sim", "whisker"] {
        let built = target().join("release").join(program);
        put(&built, &format!("bin/{program}"))?;
    }
    for board in Board::ALL {
        let arguments = board.build_arguments(board.every_part);
        run(&mut cargo(&format!("build {arguments}")))?;
        let elf = firmware::elf_in(board, &target());
        put(&elf, &format!("boards/{}.elf", board.name))?;
    }
    page::build()?;
    put(&page::path(), "whisker.html")?;
    let wheel = python::release()?;
    put(&wheel, &format!("python/{}", name(&wheel)))?;
    book::build()?;
    run(Command::new("cp")
        .args(["-r", "--no-preserve=mode"])
        .arg(top().join("target/book"))
        .arg(folder.join("book")))?;
    for (from, extension) in [("scenes", "toml"), ("scenes/models", "model")] {
        for file in listing(&top().join(from), extension)? {
            put(&file, &format!("{from}/{}", name(&file)))?;
        }
    }
    for (part, bytes) in mount::parts(&read(&top().join("docs/build.md"))?)? {
        write(&folder.join(format!("mount/{part}.stl")), bytes)?;
    }
    COPIED
        .into_iter()
        .try_for_each(|(from, to)| put(&top().join(from), to))
}

fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Adds checksums and packs the folder; every file is of `time`, and no one's.
fn pack(folder: &Path, time: &str) -> Result<PathBuf, Fault> {
    let above = folder.parent().unwrap_or(folder);
    let sums = "find . -type f ! -name SHA256SUMS -print0 | LC_ALL=C sort -z | xargs -0 sha256sum \
                > SHA256SUMS";
    run(Command::new("sh").args(["-c", sums]).current_dir(folder))?;
    let archive = above.join(format!("{NAME}.tar.gz"));
    let mut tar = Command::new("tar");
    tar.args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner"])
        .args(["--format=ustar", "--mode=u=rwX,go=rX"])
        .arg(format!("--mtime=@{time}"))
        .args(["--use-compress-program=gzip -9n", "--create", "--file"])
        .arg(&archive)
        .arg(NAME);
    run(tar.current_dir(above))?;
    let mut sum = Command::new("sha256sum");
    let sum = output(sum.arg(name(&archive)).current_dir(above))?;
    print!("{sum}");
    write(&archive.with_file_name("SHA256SUMS"), sum)?;
    Ok(archive)
}

/// Takes the archive, alone, to a decision on an emulated board's serial port, on a machine that has
/// no Rust as far as what it runs can see.
fn test(archive: &Path) -> Result<(), Fault> {
    const PATH: &str = "/usr/bin:/bin";
    let rust = |name: &&str| env::split_paths(PATH).any(|folder| folder.join(name).exists());
    if let Some(found) = ["cargo", "rustc"].iter().find(|name| rust(name)) {
        return Err(format!(
            "{found} is in {PATH}: this test is one without Rust"
        ));
    }
    let made = output(Command::new("mktemp").args(["-d", "-t", "whisker-XXXXXX"]))?;
    let folder = PathBuf::from(made.trim());
    let clean = |program: &str| {
        let mut command = Command::new(program);
        command
            .env_clear()
            .env("PATH", PATH)
            .env("HOME", &folder)
            .current_dir(&folder);
        command
    };
    let unpacked = folder.join(NAME);
    for board in Board::ALL {
        let begun = Instant::now();
        run(clean("tar").arg("-xzf").arg(archive))?;
        let said = output(clean("sh").arg(unpacked.join("try.sh")).arg(board.name))?;
        let seconds = begun.elapsed().as_secs_f64();
        print!("{said}");
        if !said.contains(" decision left ") {
            return Err(format!("{}: no decision came", board.name));
        }
        println!(
            "{}: from the archive to a decision: {seconds:.1} s, at most {MOST_S}",
            board.name
        );
        if seconds > MOST_S {
            return Err("that is too long".to_owned());
        }
    }
    python::try_wheel(&unpacked.join("python"))?;
    run(clean("sha256sum")
        .args(["--check", "--quiet", "SHA256SUMS"])
        .current_dir(&unpacked))?;
    remove(&folder)
}
