//! Faults of a module, with their cause and remedy.

use std::fmt::Write as _;

use firmware::faults::{self, TABLE};
use firmware::{Event, EventRecord, NodeEvent};
use host_sim::report;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    /// When, where and which, and its likely causes.
    pub(crate) what: String,
    pub(crate) remedy: String,
}

pub(crate) const fn number(event: &Event) -> Option<u8> {
    match event {
        Event::SensorLost(_, why) => Some(why.code()),
        Event::MotorFault(_, why) => Some(why.code()),
        Event::Node(_, NodeEvent::Twin) => Some(faults::number::TWIN),
        Event::Limit(number) => Some(*number),
        _ => None,
    }
}

pub(crate) fn fault(EventRecord { sequence, event }: &EventRecord, tick_hz: u32) -> Option<Fault> {
    let number = number(event)?;
    let t_s = f64::from(*sequence) / f64::from(tick_hz);
    let (_, said) = report::said(event, &[])?;
    let row = TABLE.iter().find(|row| row.number == number);
    Some(Fault {
        what: format!("{t_s:.3} {said}"),
        remedy: row.map_or_else(
            || "a newer version of this program".to_owned(),
            |row| plain(row.check),
        ),
    })
}

/// A text without its marks; of a link the place that it leads to.
pub(crate) fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut rest = markdown;
    while let Some((before, link)) = rest.split_once('[') {
        text.push_str(before);
        let Some((words, more)) = link.split_once("](") else {
            rest = link;
            continue;
        };
        let (target, more) = more.split_once(')').unwrap_or((more, ""));
        // Writing to a string does not fail.
        let _ = write!(text, "{words} (docs/{target})");
        rest = more;
    }
    text.push_str(rest);
    text.replace(['`', '*'], "")
}
