//! Signals against time.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::text::Span;
use ratatui::widgets::{Axis, Block, Chart, Dataset, GraphType};

use super::super::shown::{Shown, Whisker, signals};
use super::theme::Theme;

struct Kind {
    quantity: &'static str,
    curves: &'static [Curve],
    /// Least range that is shown.
    least: f64,
    fixed: Option<[f64; 2]>,
    decimals: usize,
}

/// A signal in a chart: its marker distinguishes it from the others.
struct Curve {
    signal: usize,
    name: &'static str,
    sign: char,
    colour: Color,
}

const LINE: char = '⣀';

/// The first signal of a chart, the second and the third.
const fn first(signal: usize, name: &'static str) -> Curve {
    curve(signal, name, LINE, Color::Cyan)
}

const fn second(signal: usize, name: &'static str) -> Curve {
    curve(signal, name, '•', Color::Yellow)
}

const fn third(signal: usize, name: &'static str) -> Curve {
    curve(signal, name, '+', Color::Magenta)
}

const fn curve(signal: usize, name: &'static str, sign: char, colour: Color) -> Curve {
    Curve {
        signal,
        name,
        sign,
        colour,
    }
}

const KINDS: [Kind; 3] = [
    Kind {
        quantity: "deg",
        curves: &[first(1, "measured"), second(0, "setpoint")],
        least: 10.0,
        fixed: None,
        decimals: 1,
    },
    Kind {
        quantity: "codes",
        curves: &[first(2, "x"), second(3, "y")],
        least: 200.0,
        fixed: None,
        decimals: 0,
    },
    Kind {
        quantity: "of 1",
        curves: &[first(4, "contact"), second(5, "z"), third(6, "duty")],
        least: 0.0,
        fixed: Some([-1.0, 1.0]),
        decimals: 2,
    },
];

pub(super) fn charts(frame: &mut Frame<'_>, area: Rect, shown: &Shown, theme: Theme) {
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
            chart(frame, *row, kind, whisker, shown, n + 1 == count, theme);
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
    theme: Theme,
) {
    let now = whisker.record.as_ref().map(signals);
    let mut title = vec![Span::raw(format!(" {} ", whisker.side))];
    for curve in kind.curves {
        let value = now.map_or("-".to_owned(), |now| {
            format!("{:.*}", kind.decimals, now[curve.signal])
        });
        let text = format!("{}{} {value} ", curve.sign, curve.name);
        title.push(Span::styled(text, theme.style(curve.colour)));
    }
    title.push(Span::raw(format!("{} ", kind.quantity)));

    // One in some columns, so that a line behind them is seen.
    let sparse: Vec<Vec<(f64, f64)>> = kind
        .curves
        .iter()
        .enumerate()
        .map(|(n, curve)| {
            let points = &whisker.curves[curve.signal];
            if n == 0 {
                return points.clone();
            }
            let step = (points.len() / usize::from(area.width / 3).max(1)).max(1);
            points
                .iter()
                .copied()
                .skip(n * step / 3)
                .step_by(step)
                .collect()
        })
        .collect();
    let datasets = kind.curves.iter().zip(&sparse).map(|(curve, points)| {
        let (marker, graph) = match curve.sign {
            LINE => (Marker::Braille, GraphType::Line),
            '•' => (Marker::Dot, GraphType::Scatter),
            sign => (Marker::Custom(sign), GraphType::Scatter),
        };
        Dataset::default()
            .marker(marker)
            .graph_type(graph)
            .style(theme.style(curve.colour))
            .data(points)
    });
    let range = range(kind, whisker);
    let labels = range.map(|end| format!("{end:6.0}"));
    let mut times = Axis::default().bounds([shown.from_s, shown.to_s]);
    if is_last {
        times = times.labels([
            format!("{:.1} s", shown.from_s),
            format!("{:.1} s", shown.to_s),
        ]);
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
    let values = kind
        .curves
        .iter()
        .flat_map(|curve| &whisker.curves[curve.signal]);
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
