//! The touches of a recording, by their numbers.

use super::{Stream, excerpt};

/// A whole number, also as 3.0 or 3e0, which other programs write, or `true` or `false`.
pub(super) fn number(cell: &str) -> Result<u16, String> {
    let number = match cell.to_ascii_lowercase().as_str() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        number => number.parse::<f64>().ok(),
    };
    let is_whole = |number: &f64| number.trunc() == *number && (0.0..=65_535.0).contains(number);
    let number = number.filter(is_whole).map(|number| number as u16);
    number.ok_or_else(|| {
        let cell = excerpt(cell);
        format!("touch is {cell}, not a whole number from 0 to 65535")
    })
}

/// Numbers touches that have no numbers of their own: where all that is not 0 is the same, as in a
/// column of 0 and 1, each rise from 0 begins another touch, through all trials.
pub fn tell_apart(streams: &mut [Stream]) {
    let touches = streams.iter().filter_map(|stream| stream.touch.as_ref());
    let mut numbers = touches.flatten().filter(|number| **number != 0);
    let first = numbers.next().copied();
    let Some(one) = first.filter(|one| numbers.all(|number| number == one)) else {
        return;
    };
    let mut last = None;
    for touch in streams
        .iter_mut()
        .filter_map(|stream| stream.touch.as_mut())
    {
        let mut is_touching = false;
        for number in touch {
            let touches = *number != 0;
            if touches && !is_touching {
                let next = last.map(|last: u16| last.checked_add(1).unwrap_or(1));
                last = next.or(Some(one));
            }
            is_touching = touches;
            if touches {
                *number = last.unwrap_or(one);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::number;
    use crate::recording::{CHANNELS, read};

    fn touches(cells: &[&str]) -> Vec<u16> {
        let rows = cells.iter().map(|cell| format!("a,1,2,3,{cell}\n"));
        let table = format!("label,trial,x,y,touch\n{}", rows.collect::<String>());
        let streams = read(table.as_bytes(), CHANNELS).unwrap();
        streams[0].touch.clone().unwrap()
    }

    #[test]
    fn each_rise_of_a_column_of_0_and_1_begins_a_touch() {
        let told = touches(&["0", "1", "1", "0", "1", "0", "0", "1"]);
        assert_eq!(told, [0, 1, 1, 0, 2, 0, 0, 3]);
        assert_eq!(touches(&["1.0", "0.0", "1.0"]), [1, 0, 2]);
        assert_eq!(touches(&["False", "True", "False", "True"]), [0, 1, 0, 2]);
        let trials = "label,trial,x,y,touch\na,1,2,3,1\na,2,2,3,1\na,2,2,3,0\na,2,2,3,1\n";
        let of_trials = read(trials.as_bytes(), CHANNELS).unwrap();
        let of_trials: Vec<_> = of_trials.into_iter().filter_map(|s| s.touch).collect();
        assert_eq!(of_trials, [vec![1], vec![2, 0, 3]]);
    }

    #[test]
    fn touches_that_have_numbers_keep_them() {
        assert_eq!(touches(&["0", "7", "7", "0"]), [0, 7, 7, 0]);
        assert_eq!(touches(&["3", "0", "4", "0", "3"]), [3, 0, 4, 0, 3]);
    }

    #[test]
    fn other_cells_are_no_numbers() {
        for cell in ["", "-1", "0.5", "65536", "nan", "yes"] {
            assert!(number(cell).is_err(), "{cell}");
        }
    }
}
