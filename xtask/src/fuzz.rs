//! Feeds what reads untrusted data (`fuzz/src`) with what libFuzzer finds: built with
//! counters of coverage, and with checks on. What is interesting is kept in `target/fuzz`
//! from run to run, and so is each finding.

mod found;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::run::{Fault, cargo, document, listing, output, read, run, target, top, write};
use found::Found;

/// What is fed, and the folders, from the top, of its first inputs.
const TARGETS: [(&str, &[&str]); 7] = [
    ("config", &["fuzz/corpus/config"]),
    ("frame", &["fuzz/corpus/frame"]),
    ("model", &["fuzz/corpus/model", "scenes/models"]),
    ("recording", &["fuzz/corpus/recording"]),
    ("scene", &["fuzz/corpus/scene", "scenes"]),
    ("shards", &["fuzz/corpus/shards"]),
    ("simulation", &["fuzz/corpus/scene", "scenes"]),
];

/// The target that is the emulator's, which takes minutes to build: for the night.
const SLOW: &str = "shards";

/// What libFuzzer needs of the compiler: counters on every edge, and what is compared with
/// what. All of it is in the stable one.
const FLAGS: [&str; 7] = [
    "-Cpasses=sancov-module",
    "-Cllvm-args=-sanitizer-coverage-level=4",
    "-Cllvm-args=-sanitizer-coverage-inline-8bit-counters",
    "-Cllvm-args=-sanitizer-coverage-pc-table",
    "-Cllvm-args=-sanitizer-coverage-trace-compares",
    "--cfg",
    "fuzzing",
];

/// So that what builds the targets is not fed itself.
const HOST: &str = "x86_64-unknown-linux-gnu";

/// What one input may take: seconds, and megabytes, in all and at once.
const LIMITS: [&str; 3] = ["-timeout=10", "-rss_limit_mb=1024", "-malloc_limit_mb=256"];

/// Of the words of the scenes, those for the dictionary have so many bytes.
const WORD: std::ops::Range<usize> = 2..40;

/// Feeds every target, or those named, for so many minutes each, up to the first finding.
pub(crate) fn all(names: &[String], minutes: f64, page: bool) -> Result<(), Fault> {
    if let Some(name) = names
        .iter()
        .find(|name| !TARGETS.iter().any(|t| t.0 == **name))
    {
        let known = TARGETS.map(|target| target.0).join(", ");
        return Err(format!("no such target: {name}; there is: {known}"));
    }
    let is_wanted = |name: &str| names.is_empty() || names.iter().any(|wanted| wanted == name);
    build(is_wanted(SLOW))?;
    let mut found = Vec::new();
    for (name, seeds) in TARGETS.into_iter().filter(|(name, _)| is_wanted(name)) {
        let line = feed(name, seeds, minutes)?;
        println!("{}", line.text());
        found.push(line);
    }
    if !page {
        return Ok(());
    }
    let compiler = output(Command::new("rustc").arg("--version"))?;
    let rows: Vec<String> = found.iter().map(Found::row).collect();
    let page = format!(
        include_str!("fuzz/page.md.in"),
        compiler = compiler.trim(),
        rows = rows.join("\n"),
    );
    document("docs/measured/fuzz.md", page.as_bytes(), false)
}

fn build(with_slow: bool) -> Result<(), Fault> {
    let mut command = cargo("build --locked --quiet --profile fuzz -p fuzz --bins");
    let features = if with_slow { "engine,shards" } else { "engine" };
    command.args(["--no-default-features", "--features", features]);
    command.args(["--target", HOST]);
    run(command.env("RUSTFLAGS", FLAGS.join(" ")))
}

fn feed(name: &str, seeds: &[&str], minutes: f64) -> Result<Found, Fault> {
    let place = target().join("fuzz");
    let [kept, findings] = ["kept", "findings"].map(|folder| place.join(folder).join(name));
    for folder in [&kept, &findings] {
        let made = std::fs::create_dir_all(folder);
        made.map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let words = place.join("words");
    write(&words, dictionary()?)?;
    let mut command = Command::new(target().join(HOST).join("fuzz").join(name));
    command
        .current_dir(top())
        .arg(format!("-max_total_time={:.0}", (minutes * 60.0).max(1.0)))
        .arg(format!("-artifact_prefix={}/", findings.display()))
        .arg(format!("-dict={}", words.display()))
        .args(["-print_final_stats=1", "-verbosity=1", "-max_len=16384"])
        .args(LIMITS)
        .arg(&kept)
        .args(seeds);
    let done = command
        .output()
        .map_err(|error| format!("{name}: {error}"))?;
    let said = String::from_utf8_lossy(&done.stderr);
    if !done.status.success() {
        let last: Vec<&str> = said.lines().rev().take(60).collect();
        let last: Vec<&str> = last.into_iter().rev().collect();
        return Err(format!("{name}: a finding\n{}", last.join("\n")));
    }
    Found::read(name, &said)
}

/// The words of the scenes and of the page of their keys, as libFuzzer reads them.
fn dictionary() -> Result<String, Fault> {
    let mut files: Vec<PathBuf> = listing(&top().join("scenes"), "toml")?;
    files.push(top().join("docs/scenes.md"));
    let mut words = BTreeSet::new();
    for file in files {
        let text = read(Path::new(&file))?;
        let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
        let parts = text
            .split(|c| !is_part(c))
            .filter(|part| WORD.contains(&part.len()));
        words.extend(parts.map(|part| format!("\"{part}\"\n")));
    }
    Ok(words.into_iter().collect())
}
