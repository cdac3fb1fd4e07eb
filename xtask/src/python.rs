//! The Python module: built, and installed into clean environments as a user would.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::{env, fs};

use crate::run::{Fault, cargo, linted, listing, once, output, remove, run, target, top};
use crate::traces;

/// The oldest Python that the wheel is for.
const OLDEST: u32 = 10;
/// The first that there is not.
const NEWEST: u32 = 16;

/// What builds it: a release is the same whenever it is made.
const MATURIN: &str = "maturin==1.16.0";

/// How it is built: as `pip install` does, or of what the tests were built of.
const RELEASE: &[&str] = &["--release"];
const AS_TESTS: &[&str] = &["--features", "compiled-once"];

pub(crate) fn place(name: &str) -> PathBuf {
    target().join("python").join(name)
}

/// An environment that is made from nothing with these packages.
pub(crate) fn environment(python: &Path, name: &str, packages: &[&str]) -> Result<PathBuf, Fault> {
    let folder = place(name);
    run(Command::new(python)
        .args(["-m", "venv", "--clear"])
        .arg(&folder))?;
    let inside = folder.join("bin").join("python");
    if !packages.is_empty() {
        run(pip(&inside).args(packages))?;
    }
    Ok(inside)
}

pub(crate) fn pip(python: &Path) -> Command {
    let mut command = Command::new(python);
    command.args("-m pip install --quiet --disable-pip-version-check".split(' '));
    command
}

/// The Pythons of this machine that the wheel is for, the oldest first.
fn pythons() -> Vec<PathBuf> {
    let home = env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let versions = fs::read_dir(home.join(".pyenv/versions"))
        .into_iter()
        .flatten();
    let installed = versions.filter_map(|entry| Some(entry.ok()?.path().join("bin")));
    let path = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = installed.chain(env::split_paths(&path)).collect();
    let of = |minor: u32| {
        let name = format!("python3.{minor}");
        let mut all = folders.iter().map(|folder| folder.join(&name));
        // A shim of a version that is not chosen is there and does not run.
        all.find(|program| {
            program.exists() && output(Command::new(program).arg("--version")).is_ok()
        })
    };
    (OLDEST..NEWEST).filter_map(of).collect()
}

fn newest() -> Result<PathBuf, Fault> {
    let none = || format!("no Python from 3.{OLDEST} on");
    pythons().pop().ok_or_else(none)
}

fn oldest() -> Result<PathBuf, Fault> {
    pythons().into_iter().next().ok_or("no Python".to_owned())
}

/// What builds the wheel of the package in a folder to another, which is emptied.
fn maturin(python: &Path, package: &Path, wheels: &Path) -> Result<Command, Fault> {
    let tools = environment(python, "tools", &[MATURIN])?;
    remove(wheels)?;
    let mut build = Command::new(tools);
    build
        .args(["-m", "maturin", "build", "--locked", "--out"])
        .arg(wheels);
    build.arg("--interpreter").arg(python).current_dir(package);
    Ok(build)
}

const BUILT_NONE: &str = "no wheel was built";

fn only(folder: &Path, extension: &str, none: &str) -> Result<PathBuf, Fault> {
    let first = listing(folder, extension)?.into_iter().next();
    first.ok_or_else(|| none.to_owned())
}

fn tests(inside: &Path) -> Result<Command, Fault> {
    let mut tests = Command::new(inside);
    tests.args(["-m", "pytest", "--quiet"]);
    tests.env("WHISKER_TRACES", traces::written()?);
    tests.current_dir(top().join("python"));
    Ok(tests)
}

/// The wheel in a clean environment of the newest Python of this machine, where its tests are run,
/// and in one of the oldest, where it runs a scene; the night runs the tests there too.
pub(crate) fn test() -> Result<(), Fault> {
    let python = newest()?;
    let wheels = place("wheels");
    let mut build = maturin(&python, &top().join("python"), &wheels)?;
    run(linted(build.args(AS_TESTS)))?;
    let wheel = only(&wheels, "whl", BUILT_NONE)?;
    let packages = ["gymnasium", "mypy", "pandas", "pytest"];
    let inside = environment(&python, "newest", &packages)?;
    run(pip(&inside).arg(&wheel))?;
    // The stubs say what is there.
    let mut stubs = Command::new(&inside);
    run(stubs.args(["-m", "mypy.stubtest", "vibrissa._core"]))?;
    run(&mut tests(&inside)?)?;
    try_wheel(&wheels)
}

/// What takes long: the source distribution, built outside the checkout; sweeps on Dask and Ray;
/// every notebook.
pub(crate) fn whole() -> Result<(), Fault> {
    let tools = environment(&newest()?, "tools", &[MATURIN])?;
    let sources = place("sources");
    remove(&sources)?;
    let mut pack = Command::new(tools);
    pack.args(["-m", "maturin", "sdist", "--out"]).arg(&sources);
    run(pack.current_dir(top().join("python")))?;
    let packed = only(&sources, "gz", "no source distribution was made")?;
    let packages = "dask[distributed] ray gymnasium pytest ipykernel matplotlib nbclient nbformat \
                    pandas xarray";
    let packages: Vec<&str> = packages.split_whitespace().collect();
    // Ray comes to a new Python late.
    let inside = environment(&oldest()?, "whole", &packages)?;
    let elsewhere = env::temp_dir();
    run(pip(&inside).arg(packed).current_dir(&elsewhere))?;
    run(tests(&inside)?.env("WHISKER_WHOLE", "1"))?;
    run(Command::new(&inside).arg(top().join("python/notebooks/execute.py")))
}

pub(crate) fn release() -> Result<PathBuf, Fault> {
    let wheels = place("wheels");
    run(maturin(&newest()?, &top().join("python"), &wheels)?.args(RELEASE))?;
    only(&wheels, "whl", BUILT_NONE)
}

/// Installs the wheel of this folder into a clean environment of the oldest Python of this
/// machine, and runs a scene by it.
pub(crate) fn try_wheel(folder: &Path) -> Result<(), Fault> {
    const LINE: &str = "import vibrissa; sim = vibrissa.Sim(vibrissa.SCENES['rcp']); \
                        print('by the wheel: whisked to', sim.step(1000)['angle_left_deg'].max())";
    let inside = environment(&oldest()?, "tried", &[])?;
    run(pip(&inside).arg(only(folder, "whl", "no wheel in the archive")?))?;
    // Of the wheel, not of a folder that has the package, too.
    run(Command::new(inside).args(["-I", "-c", LINE]))
}

/// The figures of the wheel that `pip install` would make, as JSON.
pub(crate) fn figures() -> Result<String, Fault> {
    let wheel = release()?;
    let said = Measured::with(&wheel, &top(), "speeds")?.figures()?;
    let bytes = fs::metadata(&wheel)
        .map_err(|error| error.to_string())?
        .len();
    let figures = said.trim().trim_start_matches('{');
    Ok(format!("{{\"wheel_bytes\": {bytes}, {figures}"))
}

/// A wheel in a clean environment, and what measures it.
pub(crate) struct Measured {
    inside: PathBuf,
    script: PathBuf,
}

impl Measured {
    fn with(wheel: &Path, tree: &Path, name: &str) -> Result<Self, Fault> {
        let inside = environment(&newest()?, name, &["gymnasium"])?;
        run(pip(&inside).arg(wheel))?;
        let script = tree.join("python/tests/speeds.py");
        Ok(Self { inside, script })
    }

    pub(crate) fn own() -> Result<Self, Fault> {
        Self::with(&release()?, &top(), "speeds")
    }

    /// Of another checkout, whose wheel is built in the folder `built`.
    pub(crate) fn of(tree: &Path, built: &Path) -> Result<Self, Fault> {
        let python = newest()?;
        let mut build = maturin(&python, &tree.join("python"), &built.join("wheels"))?;
        run(build.args(RELEASE).env("CARGO_TARGET_DIR", built))?;
        let wheel = only(&built.join("wheels"), "whl", BUILT_NONE)?;
        Self::with(&wheel, tree, "speeds-other")
    }

    pub(crate) fn figures(&self) -> Result<String, Fault> {
        output(Command::new(&self.inside).arg(&self.script))
    }
}

/// Error against time of the bending whisker and of MuJoCo; the page is written where programs are.
pub(crate) fn against_mujoco() -> Result<(), Fault> {
    run(&mut cargo(
        "build --locked --release -p physics --example push",
    ))?;
    let inside = environment(&newest()?, "mujoco", &["mujoco>=4,<5", "scipy"])?;
    let mut compare = Command::new(inside);
    compare
        .arg(top().join("tests/truth/against_mujoco.py"))
        .arg(target().join("release/examples/push"))
        .arg(target().join("bending.md"));
    run(compare.env("OPENBLAS_NUM_THREADS", "1"))
}

/// The program that runs the page's tests, with Selenium, in an environment that is made once.
pub(crate) fn with_browser() -> Result<PathBuf, Fault> {
    static MADE: Mutex<Option<PathBuf>> = Mutex::new(None);
    let packages = ["pytest", "pytest-xdist", "selenium"];
    once(&MADE, || environment(&newest()?, "browser", &packages))
}
