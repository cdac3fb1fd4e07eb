//! All whiskers of a head from above, the nose at the top.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::Block;
use ratatui::widgets::canvas::{Canvas, Circle, Context, Line as Stroke};

use super::bold;
use crate::monitor::looking::Hair;

/// The angle that is drawn level, degrees.
const LEVEL_DEG: f64 = 84.0;
/// Half the width of the face, and the distance of columns and of rows (outwards, and down, so that
/// each is seen), in lengths of a hair.
const FACE: f64 = 0.16;
const COLUMN: f64 = 0.22;
const ROW: [f64; 2] = [0.03, 0.05];
/// Contact from which on a circle shows it.
const LEAST: f64 = 0.05;
/// Points of a character of braille.
const POINTS: [f64; 2] = [2.0, 4.0];

pub(super) fn hairs(frame: &mut Frame<'_>, area: Rect, hairs: &[Hair]) {
    let boards = hairs.iter().filter_map(|hair| hair.stand.board).max();
    let boards = boards.map_or(1, |last| last + 1);
    let count = hairs.len();
    let title = format!(" {count} whiskers on {boards} boards: o contact, decisions ");
    let tall = hairs
        .first()
        .map_or(0.0, |hair| COLUMN * (hair.columns - 1) as f64);
    // Swings of 45 degrees either way from level, and names beyond the tips.
    let [wide, high] = [2.0 * (FACE + 1.3), tall + 1.6];
    let [width, height] = [area.width, area.height].map(|cells| f64::from(cells.saturating_sub(2)));
    let [width, height] = [width.max(1.0) * POINTS[0], height.max(1.0) * POINTS[1]];
    let scale = (width / wide).min(height / high);
    let [x, y] = [width, height].map(|points| points / scale / 2.0);
    let canvas = Canvas::default()
        .block(Block::bordered().title(title))
        .marker(Marker::Braille)
        .x_bounds([-x, x])
        .y_bounds([-y, y])
        .paint(|context| {
            for hair in hairs {
                shaft(context, hair);
            }
            context.layer();
            for hair in hairs {
                words(context, hair);
            }
        });
    frame.render_widget(canvas, area);
}

/// Where a hair stands, and where its tip is while it is straight.
fn ends(hair: &Hair) -> [(f64, f64); 2] {
    let way = if hair.stand.side == 0 { -1.0 } else { 1.0 };
    let middle = (hair.columns - 1) as f64 / 2.0;
    let root = (
        way * (FACE + ROW[0] * hair.stand.row as f64),
        COLUMN * (middle - hair.stand.column as f64) - ROW[1] * hair.stand.row as f64,
    );
    let (up, out) = (hair.angle_deg - LEVEL_DEG).to_radians().sin_cos();
    [root, (root.0 + way * out, root.1 + up)]
}

fn shaft(context: &mut Context<'_>, hair: &Hair) {
    let [(x1, y1), (x2, y2)] = ends(hair);
    let of_side = if hair.stand.side == 0 {
        Color::Cyan
    } else {
        Color::Yellow
    };
    context.draw(&Stroke::new(x1, y1, x2, y2, of_side));
    if hair.contact >= LEAST {
        context.draw(&Circle {
            x: x2,
            y: y2,
            radius: 0.03 + 0.07 * hair.contact.min(1.0),
            color: Color::Red,
        });
    }
}

fn words(context: &mut Context<'_>, hair: &Hair) {
    let [(x, y), (tip, high)] = ends(hair);
    if let Some(board) = hair.stand.board
        && hair.stand.row == 0
    {
        context.print(x - x.signum() * 0.08, y, board.to_string());
    }
    if !hair.said.is_empty() {
        let said = Line::from(hair.said.clone()).style(bold());
        // Left of a tip on the left, as far as a name is long.
        let back = if hair.stand.side == 0 { 0.3 } else { 0.0 };
        context.print(tip - back, high, said);
    }
}
