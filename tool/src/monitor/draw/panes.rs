//! Words and bars beside the charts.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};
use wire::Flags;

use super::super::shown::{STATES, Shown, Whisker};
use super::bold;

/// The state of each whisker, a line each: states that hold are in capitals.
pub(super) fn states(frame: &mut Frame<'_>, area: Rect, shown: &Shown) {
    let lines: Vec<Line<'_>> = shown.whiskers.iter().map(state).collect();
    frame.render_widget(Paragraph::new(lines), area);
}

fn state(whisker: &Whisker) -> Line<'static> {
    let mut spans = vec![Span::raw(format!("{:5}", whisker.side))];
    let Some(record) = &whisker.record else {
        spans.push(Span::raw(" no record yet"));
        return Line::from(spans);
    };
    for (name, flag) in STATES {
        let is_so = record.flags.contains(flag);
        let text = if is_so {
            format!(" [{}]", name.to_uppercase())
        } else {
            format!("  {name} ")
        };
        let is_bad = is_so == (flag != Flags::VALID) && matches!(name, "resting" | "valid");
        let style = match (is_so, is_bad) {
            (_, true) => bold().fg(Color::Red),
            (true, _) => bold().fg(Color::Green),
            (false, _) => Style::new().add_modifier(Modifier::DIM),
        };
        spans.push(Span::styled(text, style));
    }
    Line::from(spans)
}

pub(super) fn panes(frame: &mut Frame<'_>, area: Rect, shown: &Shown) {
    if area.width < 10 || area.height < 3 {
        return;
    }
    let bars: usize = shown.whiskers.iter().map(|of| of.posteriors.len()).sum();
    let sure = (bars + shown.classifying.len() + 2) as u16;
    let load = shown.load.len() as u16 + 2;
    let [sure, rest] = Layout::vertical([Constraint::Max(sure), Constraint::Min(0)]).areas(area);
    posteriors(frame, sure, shown);
    let faults = match shown.faults.len() {
        0 => 3,
        _ => (rest.height / 2).max(3),
    };
    let [events, faults, load] = Layout::vertical([
        Constraint::Min(3),
        Constraint::Max(faults),
        Constraint::Max(load),
    ])
    .areas(rest);
    events_pane(frame, events, shown);
    faults_pane(frame, faults, shown);
    let lines: Vec<Line<'_>> = plain(&shown.load).collect();
    pane(frame, load, " ticks and records ", Paragraph::new(lines));
}

fn plain(lines: &[String]) -> impl Iterator<Item = Line<'_>> {
    lines.iter().map(|line| Line::from(line.as_str()))
}

fn pane(frame: &mut Frame<'_>, area: Rect, title: &str, text: Paragraph<'_>) {
    frame.render_widget(text.block(Block::bordered().title(title)), area);
}

fn posteriors(frame: &mut Frame<'_>, area: Rect, shown: &Shown) {
    let width = usize::from(area.width.saturating_sub(2));
    let all = shown
        .whiskers
        .iter()
        .flat_map(|whisker| &whisker.posteriors);
    let longest = all.map(|(name, _)| name.chars().count()).max();
    let name_width = longest.unwrap_or(0).min(width / 3);
    let room = width.saturating_sub(name_width + 9);
    let mut lines = Vec::new();
    for whisker in &shown.whiskers {
        let mark = if shown.whiskers.len() > 1 {
            &whisker.side[..1]
        } else {
            ""
        };
        for (name, posterior) in &whisker.posteriors {
            let name: String = name.chars().take(name_width).collect();
            let bar = bar(*posterior, room.saturating_sub(mark.len()));
            let percent = 100.0 * posterior;
            lines.push(Line::from(vec![
                Span::raw(format!("{mark}{name:name_width$} ")),
                Span::styled(bar, Color::Green),
                Span::raw(format!(" {percent:5.1}%")),
            ]));
        }
    }
    lines.extend(plain(&shown.classifying));
    pane(frame, area, " posterior ", Paragraph::new(lines));
}

/// A bar of `room` characters for 1, in eighths of one.
fn bar(share: f32, room: usize) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let eighths = (share.clamp(0.0, 1.0) * room as f32 * 8.0).round() as usize;
    let bar = format!("{}{}", "█".repeat(eighths / 8), EIGHTHS[eighths % 8]);
    format!("{bar:room$}")
}

fn events_pane(frame: &mut Frame<'_>, area: Rect, shown: &Shown) {
    let room = usize::from(area.height.saturating_sub(2));
    let old = shown.events.len().saturating_sub(room);
    // Decisions have a percentage, touches none.
    let style = |text: &str| match text.find('%') {
        Some(_) => bold(),
        None => Style::new(),
    };
    let lines = shown.events[old..].iter();
    let lines = lines.map(|text| Line::from(text.as_str()).style(style(text)));
    let lines: Vec<Line<'_>> = lines.collect();
    pane(
        frame,
        area,
        " touches and decisions ",
        Paragraph::new(lines),
    );
}

fn faults_pane(frame: &mut Frame<'_>, area: Rect, shown: &Shown) {
    let mut lines = Vec::new();
    for fault in &shown.faults {
        lines.push(Line::from(fault.what.as_str()).style(bold().fg(Color::Red)));
        lines.push(Line::from(format!("check: {}", fault.remedy)));
    }
    if lines.is_empty() {
        lines.push(Line::from("none"));
    }
    let title = format!(" faults: {} ", shown.fault_count);
    let text = Paragraph::new(lines).wrap(Wrap { trim: true });
    pane(frame, area, &title, text);
}
