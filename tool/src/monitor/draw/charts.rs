//! Signals against time.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::text::Span;
use ratatui::widgets::{Axis, Block, Chart, Dataset, GraphType};

use super::super::shown::{Shown, Whisker, signals};

struct Kind {
    quantity: &'static str,
    /// Signals with their names, the first of them a line.
    curves: &'static [(usize, &'static str)],
    /// Least range that is shown.
    least: f64,
    fixed: Option<[f64; 2]>,
    decimals: usize,
}

/// How the first, second and third signal of a chart are marked, which distinguishes them without
/// colour too.
const MARKS: [(char, Color, Marker, GraphType); 3] = [
    ('⣀', Color::Cyan, Marker::Braille, GraphType::Line),
    ('•', Color::Yellow, Marker::Dot, GraphType::Scatter),
    ('+', Color::Magenta, Marker::Custom('+'), GraphType::Scatter),
];

const KINDS: [Kind; 3] = [
    Kind {
        quantity: "deg",
        curves: &[(1, "measured"), (0, "setpoint")],
        least: 10.0,
        fixed: None,
        decimals: 1,
    },
    Kind {
        quantity: "codes",
        curves: &[(2, "x"), (3, "y")],
        least: 200.0,
        fixed: None,
        decimals: 0,
    },
    Kind {
        quantity: "of 1",
        curves: &[(4, "contact"), (5, "z"), (6, "duty")],
        least: 0.0,
        fixed: Some([-1.0, 1.0]),
        decimals: 2,
    },
];

pub(super) fn charts(frame: &mut Frame<'_>, area: Rect, shown: &Shown) {
    if area.width < 20 || area.height < 4 {
        return;
    }
    // As many charts as have five rows each.
    let count = KINDS.len().min(usize::from(area.height / 5)).max(1);
    let columns = vec![Constraint::Fill(1); shown.whiskers.len()];
    let columns = Layout::horizontal(columns).split(area);
    for (column, whisker) in columns.iter().zip(&shown.whiskers) {
        let rows = Layout::vertical(vec![Constraint::Fill(1); count]).split(*column);
        for (n, (kind, row)) in KINDS.iter().zip(rows.iter()).enumerate() {
            chart(frame, *row, kind, whisker, shown, n + 1 == count);
        }
    }
}

fn chart(
    frame: &mut Frame<'_>,
    area: Rect,
    kind: &Kind,
    whisker: &Whisker,
    shown: &Shown,
    is_last: bool,
) {
    let now = whisker.record.as_ref().map(signals);
    let mut title = vec![Span::raw(format!(" {} ", whisker.side))];
    for ((signal, name), (sign, colour, ..)) in kind.curves.iter().zip(MARKS) {
        let value = now.map_or("-".to_owned(), |now| {
            format!("{:.*}", kind.decimals, now[*signal])
        });
        title.push(Span::styled(format!("{sign}{name} {value} "), colour));
    }
    title.push(Span::raw(format!("{} ", kind.quantity)));

    // One in some columns, so that a line behind them is seen.
    let sparse = |(n, (signal, _)): (usize, &(usize, _))| -> Vec<(f64, f64)> {
        let points = &whisker.curves[*signal];
        let step = match n {
            0 => 1,
            _ => (points.len() / usize::from(area.width / 3).max(1)).max(1),
        };
        let some = points.iter().copied().skip(n * step / 3).step_by(step);
        some.collect()
    };
    let sparse: Vec<_> = kind.curves.iter().enumerate().map(sparse).collect();
    let marked = sparse.iter().zip(MARKS);
    let datasets = marked.map(|(points, (_, colour, marker, graph))| {
        Dataset::default()
            .marker(marker)
            .graph_type(graph)
            .style(colour)
            .data(points)
    });
    let range = range(kind, whisker);
    let labels = range.map(|end| format!("{end:6.0}"));
    let mut times = Axis::default().bounds([shown.from_s, shown.to_s]);
    if is_last {
        times = times.labels([shown.from_s, shown.to_s].map(|end_s| format!("{end_s:.1} s")));
    }
    let chart = Chart::new(datasets.collect())
        .block(Block::bordered().title(title))
        .legend_position(None)
        .x_axis(times)
        .y_axis(Axis::default().bounds(range).labels(labels));
    frame.render_widget(chart, area);
}

fn range(kind: &Kind, whisker: &Whisker) -> [f64; 2] {
    if let Some(fixed) = kind.fixed {
        return fixed;
    }
    let signals = kind.curves.iter();
    let values = signals.flat_map(|(signal, _)| &whisker.curves[*signal]);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (_, value) in values {
        (least, most) = (least.min(*value), most.max(*value));
    }
    if least > most {
        return [0.0, kind.least];
    }
    // 1, 2 or 5 times a power of ten, so that the ends are numbers as people write them.
    let rough = (most - least).max(kind.least) / 5.0;
    let power = 10_f64.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|factor| factor * power);
    let step = steps.into_iter().find(|step| *step >= rough);
    let step = step.unwrap_or(10.0 * power);
    let low = (least / step).floor() * step;
    [low, ((most / step).ceil() * step).max(low + kind.least)]
}
