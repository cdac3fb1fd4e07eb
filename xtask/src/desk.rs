//! docs/measured/desk.md: sizes and speeds of the Python module and of the page.

use serde::Deserialize;

use crate::run::{self, Fault, document, top};
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
    phone_frames_s: f64,
}

pub(crate) fn measure() -> Result<(), Fault> {
    page::build()?;
    page::test()?;
    page::count_frames(Some(&top().join("docs/page.png")))?;
    let read = |json: &str| serde_json::from_str(json).map_err(|error| error.to_string());
    let page: OfPage = read(&run::read(&python::place("page.json"))?)?;
    let said = python::figures()?;
    let python: OfPython = serde_json::from_str(&said).map_err(|error| error.to_string())?;
    let page = written(&python, &page);
    document("docs/measured/desk.md", page.as_bytes(), false)
}

fn written(python: &OfPython, page: &OfPage) -> String {
    let spread = |[median, least, most]: Spread, digits: usize| {
        format!("{median:.digits$} ({least:.digits$} to {most:.digits$})")
    };
    format!(
        include_str!("desk.md.in"),
        python = python.python,
        first_trace_s = spread(python.first_trace_s, 2),
        run_s = spread(python.run_s, 3),
        hundred_s = spread(python.hundred_s, 2),
        peak_mib = python.peak_mib,
        env_steps = spread(python.env_steps_s.map(|steps| steps / 1e3), 0),
        wheel_kb = python.wheel_bytes as f64 / 1e3,
        page_kb = page.bytes as f64 / 1e3,
        first_frame_s = page.first_frame_s,
        frames_s = page.frames_s,
        tick_us = page.tick_us,
        phone_frames_s = page.phone_frames_s,
    )
}
