//! Hours of a scene on the PC.

use std::path::Path;
use std::time::Instant;

use host_sim::Error;
use host_sim::decisions::Decided;
use host_sim::loaded::Loaded;
use host_sim::run::Run;
use host_sim::trace::Row;

use super::ShardRow;
use super::span::Span;
use crate::notice::Notice;

/// What the rows call it.
pub(super) const NAME: &str = "host-sim";
/// The length of the first and of the last part, at most: an hour, s.
const SPAN_S: f64 = 3_600.0;
/// How long the start lasts at most, which is held against nothing, s.
const START_S: f64 = 10.0;
/// By how many pages of memory the process may grow after its first part.
const PAGES: u64 = 256;

/// Runs the scene in `path` with another seed for so many hours. Every number of every
/// tick must be one; no sensor and no motor may have a fault; memory must not grow; whiskers
/// must range, and decisions be made and be right, in the last hour as in the first (in the
/// last quarter as in the first, of less than four hours).
pub(super) fn on_pc(path: &Path, seed: u64, hours: f64) -> Result<ShardRow, Error> {
    let begun = Instant::now();
    let mut loaded = Loaded::new(path)?;
    loaded.scene.seed = seed;
    loaded.scene.duration_s = 3_600.0 * hours;
    let scene = &loaded.scene;
    let tick_hz = f64::from(scene.tick_hz);
    let sides = scene.head.sides.count();
    let mut run = Run::new(scene, loaded.classifier()?)?;
    let classes = run.classes().to_vec();

    let ticks = run.ticks();
    let length = (ticks / 4).min((SPAN_S * tick_hz) as u64);
    let start = (ticks / 10).min((START_S * tick_hz) as u64);
    let [mut first, mut last] = [Span::default(), Span::default()];
    let (mut decisions, mut touch, mut wraps, mut pages) = (0, 0_u16, 0, None);
    for tick in 1..=ticks {
        let row = run.tick();
        let broken = |what: &str| {
            let at_s = row.t_s;
            let scene = &scene.name;
            Error::Work(format!("{scene}, seed {seed}, {at_s} s: {what}"))
        };
        if !is_finite(&row, sides) {
            return Err(broken(&format!("what is no number: {row:?}")));
        }
        if let Some(notice) = run.events().iter().find_map(Notice::of) {
            return Err(broken(&format!("{notice:?}")));
        }
        let decided: Vec<Decided> = run.decisions().collect();
        decisions += decided.len() as u64;
        let number = row.touch[0];
        if number != 0 {
            // After the largest number comes 1.
            wraps += u64::from(number < touch);
            touch = number;
        }
        if (start..start + length).contains(&tick) {
            first.tick(&row, &decided, &classes);
        }
        if tick > ticks - length {
            last.tick(&row, &decided, &classes);
        }
        if tick == start + length {
            pages = resident_pages();
        }
        if tick == ticks {
            let grown = resident_pages().zip(pages);
            let grown = grown.map(|(end, begin)| end.saturating_sub(begin));
            if let Some(grown) = grown.filter(|grown| *grown > PAGES) {
                return Err(broken(&format!("memory has grown by {grown} pages")));
            }
            if let Some(difference) = first.difference(&last) {
                return Err(broken(&difference));
            }
        }
    }
    Ok(ShardRow {
        subject: NAME.to_owned(),
        scene: scene.name.clone(),
        seed,
        hours,
        ticks,
        decisions,
        first_rate: Some(first.rate(tick_hz)),
        last_rate: Some(last.rate(tick_hz)),
        first_right: first.right(),
        last_right: last.right(),
        touches: wraps * u64::from(u16::MAX) + u64::from(touch),
        wrapped: wraps,
        took_s: begun.elapsed().as_secs_f64(),
    })
}

fn is_finite(row: &Row, sides: usize) -> bool {
    let mut values = row.pairs().into_iter();
    values.all(|pair| pair.iter().take(sides).all(|value| value.is_finite()))
}

/// Pages of memory that the process has; nothing where the system does not say.
fn resident_pages() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    pages.split_whitespace().nth(1)?.parse().ok()
}
