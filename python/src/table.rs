//! Tables as numpy's structured arrays: rows are packed here, and numpy sees the bytes as they
//! lie.

use std::slice::Iter;

use host_sim::cells::Cells;
use host_sim::decisions::{COLUMNS, Columns, Decided};
use host_sim::trace::{TraceLine, TraceShape};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyList;
use scene::{Scene, Texture};

/// What a column has. All are multiples of eight bytes, so that numbers are aligned.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kind {
    /// `float64`; not a number where a file has an empty cell.
    Number,
    /// `int64`.
    Whole,
    /// `uint64`.
    Seed,
    /// Text of up to so many characters.
    Text(usize),
    /// The column is not there: its cells are left out.
    Absent,
}

impl Kind {
    /// A text as wide as the longest of these.
    pub(crate) fn text<'t>(all: impl Iterator<Item = &'t str>) -> Self {
        let widest = all.map(|text| text.chars().count()).max();
        Self::Text(widest.unwrap_or(0).max(1).next_multiple_of(2))
    }

    const fn bytes(self) -> usize {
        match self {
            Self::Number | Self::Whole | Self::Seed => 8,
            Self::Text(width) => 4 * width,
            Self::Absent => 0,
        }
    }
}

/// A trial of the trace: a number, but text as in all tables, since a recording's may be any token.
/// Ten digits are more trials than ticks of a month.
const TRIAL: Kind = Kind::Text(10);

/// The columns of a table.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    columns: Vec<(String, Kind)>,
}

impl Layout {
    pub(crate) fn new<'n>(columns: impl IntoIterator<Item = (&'n str, Kind)>) -> Self {
        let columns = columns.into_iter();
        Self {
            columns: columns
                .map(|(name, kind)| (name.to_owned(), kind))
                .collect(),
        }
    }

    /// The same with a column before all others.
    pub(crate) fn after(mut self, name: &str, kind: Kind) -> Self {
        self.columns.insert(0, (name.to_owned(), kind));
        self
    }

    /// Of a row.
    pub(crate) fn bytes(&self) -> usize {
        self.columns.iter().map(|(_, kind)| kind.bytes()).sum()
    }

    /// What packs a row behind those that are in `bytes`.
    pub(crate) fn row<'r>(&'r self, bytes: &'r mut Vec<u8>) -> Row<'r> {
        let columns = self.columns.iter();
        Row { bytes, columns }
    }

    /// Rows as an array that owns `bytes`.
    pub(crate) fn array<'py>(
        &self,
        py: Python<'py>,
        bytes: Vec<u8>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let fields = PyList::empty(py);
        for (name, kind) in &self.columns {
            match kind {
                Kind::Number => fields.append((name, "f8"))?,
                Kind::Whole => fields.append((name, "i8"))?,
                Kind::Seed => fields.append((name, "u8"))?,
                Kind::Text(width) => fields.append((name, format!("U{width}")))?,
                Kind::Absent => {}
            }
        }
        let dtype = py.import("numpy")?.getattr("dtype")?.call1((fields,))?;
        bytes.into_pyarray(py).call_method1("view", (dtype,))
    }
}

/// Packs the cells of a row, each as its column has it.
pub(crate) struct Row<'r> {
    bytes: &'r mut Vec<u8>,
    columns: Iter<'r, (String, Kind)>,
}

impl Row<'_> {
    pub(crate) fn seed(&mut self, value: u64) {
        self.columns.next();
        self.bytes.extend(value.to_ne_bytes());
    }
}

impl Cells for Row<'_> {
    /// What is none is 0 among whole numbers.
    fn number(&mut self, value: f64, decimals: u32) {
        match self.columns.as_slice() {
            [(_, Kind::Text(_)), ..] => {
                return self.text(&format!("{value:.*}", decimals as usize));
            }
            [(_, Kind::Absent), ..] => {}
            [(_, Kind::Whole), ..] => self.bytes.extend((value as i64).to_ne_bytes()),
            _ => self.bytes.extend(value.to_ne_bytes()),
        }
        self.columns.next();
    }

    /// What is beyond the column's width is cut off.
    fn text(&mut self, text: &str) {
        let Some((_, Kind::Text(width))) = self.columns.next() else {
            return;
        };
        let end = self.bytes.len() + 4 * width;
        for c in text.chars().take(*width) {
            self.bytes.extend(u32::from(c).to_ne_bytes());
        }
        self.bytes.resize(end, 0);
    }
}

/// The tables of a scene's run.
#[derive(Debug, Clone)]
pub(crate) struct RunTables {
    pub(crate) shape: TraceShape,
    pub(crate) trace: Layout,
    pub(crate) decisions: Columns,
}

impl RunTables {
    /// Of a scene that decides among `classes`.
    pub(crate) fn of(scene: &Scene, classes: &[String]) -> Self {
        let shape = TraceShape::of(scene);
        let names = || classes.iter().map(String::as_str);
        let decision = Kind::text(names().chain([host_sim::decisions::UNKNOWN]));
        // Any of them may be laid.
        let textures = scene
            .plant
            .textured
            .as_ref()
            .map_or(&[][..], |_| Texture::NAMES);
        let label = Kind::text(textures.iter().copied().chain(["obstacle"]));
        let columns = shape.names().into_iter().map(|name| {
            let kind = match name.as_str() {
                "touch" | "touch_right" => Kind::Whole,
                "trial" => TRIAL,
                "decision" | "decision_right" => decision,
                "label" => label,
                _ => Kind::Number,
            };
            (name, kind)
        });
        Self {
            shape,
            trace: Layout {
                columns: columns.collect(),
            },
            decisions: Columns::of_scene(scene),
        }
    }

    /// A row of the trace, in the order of its columns.
    pub(crate) fn row(&self, rows: &mut Vec<u8>, line: &TraceLine<'_>) {
        line.cells(self.shape, &mut self.trace.row(rows));
    }
}

/// Decisions as `decisions.csv` has them, of each run with its seed if they are of several.
pub(crate) fn decisions<'py>(
    py: Python<'py>,
    runs: &[(Option<u64>, &[Decided])],
    columns: Columns,
) -> PyResult<Bound<'py, PyAny>> {
    let all = || runs.iter().flat_map(|(_, decided)| decided.iter());
    let pairs: Vec<String> = all().map(|d| d.why()[1].clone()).collect();
    let kind = |name| match name {
        "label" => Kind::text(all().map(|d| d.label.as_str())),
        "trial" => Kind::text(all().map(|d| d.trial.as_str())),
        "decision" => Kind::text(all().map(|d| d.decision.as_str())),
        "among" => Kind::text(pairs.iter().map(String::as_str)),
        "side" => Kind::Text(6),
        // The longest is "unknown".
        "reason" => Kind::Text(8),
        "samples" | "touch" | "whisker" => Kind::Whole,
        _ => Kind::Number,
    };
    let names = columns.indices().map(|index| COLUMNS[index].name);
    let layout = Layout::new(names.map(|name| (name, kind(name))));
    let layout = match runs {
        [(Some(_), _), ..] => layout.after("seed", Kind::Seed),
        _ => layout,
    };
    let mut rows = Vec::new();
    for (seed, decided) in runs {
        for d in *decided {
            let mut row = layout.row(&mut rows);
            if let Some(seed) = seed {
                row.seed(*seed);
            }
            d.cells(columns, &mut row);
        }
    }
    layout.array(py, rows)
}
