//! docs/measured/desk.md: sizes and speeds of the Python module and of the page.

use std::fmt::Write;

use serde::Deserialize;

use crate::run::{Fault, document, top};
use crate::{page, python};

/// Median, least and largest of some runs.
type Spread = [f64; 3];

#[derive(Deserialize)]
struct OfPython {
    wheel_bytes: u64,
    first_trace_s: Spread,
    run_s: Spread,
    hundred_s: Spread,
    peak_mib: f64,
    env_steps_s: Spread,
    python: String,
}

#[derive(Deserialize)]
struct OfPage {
    bytes: u64,
    first_frame_s: f64,
    frames_s: f64,
    tick_us: f64,
}

/// Measures both, and writes the page and the picture of the README.
pub(crate) fn measure() -> Result<(), Fault> {
    page::build()?;
    page::test(Some(top().join("docs/page.png")))?;
    let read = |json: &str| serde_json::from_str(json).map_err(|error| error.to_string());
    let page: OfPage = read(&python::written("page.json")?)?;
    let said = python::figures()?;
    let python: OfPython = serde_json::from_str(&said).map_err(|error| error.to_string())?;
    document(
        "docs/measured/desk.md",
        written(&python, &page).as_bytes(),
        false,
    )
}

fn written(python: &OfPython, page: &OfPage) -> String {
    let mut text = String::from(
        "# Sizes and speeds at the desk\n\n\
         <!-- Written by `cargo xtask desk`; do not edit by hand. -->\n\n\
         What the Python module and the page take, measured by `cargo xtask desk` on a virtual \
         machine with two cores; in brackets the least and the largest of seven runs.\n\n\
         | what | found | goal |\n|---|---|---|\n",
    );
    let spread = |[median, least, most]: Spread, digits: usize| {
        format!("{median:.digits$} ({least:.digits$} to {most:.digits$})")
    };
    let [steps, least, most] = python.env_steps_s.map(|steps| steps / 1000.0);
    let rows = [
        (
            format!(
                "Python {}: import to first trace, main scene, s",
                python.python
            ),
            spread(python.first_trace_s, 2),
            "1",
        ),
        (
            "one run of the main scene with all rows, s".to_owned(),
            spread(python.run_s, 3),
            "",
        ),
        (
            "100 seeds of the main scene, `run_many`, s".to_owned(),
            spread(python.hundred_s, 2),
            "2",
        ),
        (
            "most memory of the process until then, MiB".to_owned(),
            format!("{:.0}", python.peak_mib),
            "200",
        ),
        (
            "128 environments, thousand steps a second".to_owned(),
            format!("{steps:.0} ({least:.0} to {most:.0})"),
            "400",
        ),
        (
            "wheel, kB".to_owned(),
            format!("{:.0}", python.wheel_bytes as f64 / 1e3),
            "",
        ),
        (
            "page, kB".to_owned(),
            format!("{:.0}", page.bytes as f64 / 1e3),
            "1500",
        ),
        (
            "page: first frame after opening, s".to_owned(),
            format!("{:.2}", page.first_frame_s),
            "1",
        ),
        (
            "page: frames a second, one elastic whisker".to_owned(),
            format!("{:.1}", page.frames_s),
            "60",
        ),
        (
            "page: a tick of the elastic whisker with its points, µs".to_owned(),
            format!("{:.1}", page.tick_us),
            "",
        ),
    ];
    for (what, found, goal) in rows {
        // Writing to a string does not fail.
        let _ = writeln!(text, "| {what} | {found} | {goal} |");
    }
    text.push_str(
        "\nTraces of the scenes `both`, `cia`, `textures` and `whisker` have the same SHA-256 from \
         `host-sim run`, from Python and on the page; the tests of both compare them.\n",
    );
    text
}
