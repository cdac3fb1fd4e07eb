//! The whiskers of a head as somebody sees them who looks at it from above: where each stands, which
//! board carries it, and what it has just said.

use scene::Scene;

use crate::decisions::Decided;

/// How long what a whisker has said is shown, s.
const SAID_S: f64 = 1.0;

/// Where a whisker stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stand {
    /// 0 left, 1 right.
    pub side: usize,
    /// From the front, from 0.
    pub column: usize,
    /// From above, from 0.
    pub row: usize,
    /// The board that carries it; none where one has all.
    pub board: Option<usize>,
}

/// All whiskers of a scene, counted from 0, left side first.
#[derive(Debug, Clone)]
pub struct Array {
    stands: Vec<Stand>,
    columns: usize,
    /// When, and what.
    said: Vec<Option<(f64, String)>>,
}

impl Array {
    /// Of a scene in which nothing has been said.
    pub fn new(scene: &Scene) -> Self {
        let head = &scene.head;
        let whiskers = [head.sides.count(), head.whiskers_per_side];
        Self::of(whiskers, head.rows, head.nodes.map(usize::from))
    }

    /// Of so many sides of so many whiskers in rows, on so many boards, on which nothing has been
    /// said.
    pub fn of([sides, each]: [usize; 2], rows: usize, boards: Option<usize>) -> Self {
        let each = each.max(1);
        let columns = (each / rows.max(1)).max(1);
        let whiskers = each * sides;
        let a_board = boards.map(|boards| (whiskers / boards.max(1)).max(1));
        let stand = |n: usize| Stand {
            side: n / each,
            column: n % each % columns,
            row: n % each / columns,
            board: a_board.map(|a_board| n / a_board),
        };
        Self {
            stands: (0..whiskers).map(stand).collect(),
            columns,
            said: vec![None; whiskers],
        }
    }

    /// Takes in what was decided in a tick.
    pub fn take(&mut self, decided: &Decided) {
        let (Some(place), Some(t_s)) = (decided.place, decided.t_s) else {
            return;
        };
        let of_side = self.said.len() / self.sides().max(1);
        let n = usize::from(place.side) * of_side + usize::from(place.whisker);
        self.say(n, t_s, decided.decision.clone());
    }

    /// Whisker `n` has said something.
    pub fn say(&mut self, n: usize, t_s: f64, what: String) {
        if let Some(said) = self.said.get_mut(n) {
            *said = Some((t_s, what));
        }
    }

    /// Where each stands.
    pub fn stands(&self) -> &[Stand] {
        &self.stands
    }

    /// Whiskers of a row.
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// How many sides there are.
    pub fn sides(&self) -> usize {
        self.stands.last().map_or(0, |stand| stand.side + 1)
    }

    /// What whisker `n` has decided within the last second; empty: nothing.
    pub fn said(&self, n: usize, t_s: f64) -> &str {
        let said = self.said.get(n).and_then(Option::as_ref);
        let recent = said.filter(|(at_s, _)| t_s - at_s < SAID_S);
        recent.map_or("", |(_, said)| said)
    }
}

#[cfg(test)]
mod tests {
    use firmware::Place;
    use scene::{Override, Scene};
    use tactile::Decision;

    use super::{Array, Stand};
    use crate::decisions::Decided;

    fn array(keys: &[&str]) -> Array {
        let text = include_str!("../../scenes/cia.toml");
        let set: Vec<Override> = keys.iter().map(|key| key.parse().unwrap()).collect();
        Array::new(&Scene::from_str_with("cia", text, &set).unwrap().0)
    }

    #[test]
    fn whiskers_stand_in_rows_on_their_boards() {
        let array = array(&["head.whiskers_per_side=12", "head.rows=4", "head.nodes=12"]);
        let at = |n: usize| array.stands()[n];
        assert_eq!((array.stands().len(), array.columns()), (24, 3));
        let stand = |side, column, row, board| Stand {
            side,
            column,
            row,
            board: Some(board),
        };
        assert_eq!(at(0), stand(0, 0, 0, 0));
        assert_eq!(at(5), stand(0, 2, 1, 2));
        assert_eq!(at(12), stand(1, 0, 0, 6));
        assert_eq!(at(23), stand(1, 2, 3, 11));
    }

    #[test]
    fn what_is_said_is_shown_for_a_second() {
        let mut array = array(&["head.whiskers_per_side=3"]);
        let made = Decision::from_memory(34, 1 << 15, 0).unwrap();
        let decided = Decided {
            place: Some(Place::new(1, 2)),
            t_s: Some(2.0),
            ..Decided::new(made, &["ice".to_owned(), "loam".to_owned()], "ice", "1")
        };
        array.take(&decided);
        assert_eq!(array.said(5, 2.9), decided.decision);
        assert_eq!((array.said(5, 3.1), array.said(2, 2.1)), ("", ""));
    }
}
