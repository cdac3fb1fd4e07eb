//! LEP10 (Lepora et al. 2010): naive Bayes over fixed windows, four floors.

/// The four floors, in the order of every table (section II-B).
pub const FLOORS: [&str; 4] = ["rough carpet", "smooth carpet", "tarmac", "vinyl"];

/// Window of Tables I to V, s.
pub const WINDOW_S: f64 = 0.5;

/// One of Tables I to V.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    /// Its number in the paper.
    pub number: &'static str,
    /// What was classified.
    pub what: &'static str,
    /// The mean hit rate of its caption, percent.
    pub mean: f64,
    /// Percent, `[decided][true]`: the columns are the true class.
    pub percent: [[f64; 4]; 4],
}

/// Tables I to V.
pub const TABLES: [Table; 5] = [
    Table {
        number: "I",
        what: "x alone, artificial motion",
        mean: 79.0,
        percent: [
            [52.0, 18.0, 10.0, 1.0],
            [22.0, 79.5, 5.5, 0.0],
            [26.0, 2.5, 84.5, 0.0],
            [0.0, 0.0, 0.0, 99.0],
        ],
    },
    Table {
        number: "II",
        what: "y alone, artificial motion",
        mean: 82.0,
        percent: [
            [82.5, 8.0, 1.0, 2.5],
            [8.5, 72.5, 19.0, 0.0],
            [1.0, 19.5, 77.0, 2.5],
            [8.0, 0.0, 3.0, 95.0],
        ],
    },
    Table {
        number: "III",
        what: "x and y, artificial motion",
        mean: 92.0,
        percent: [
            [90.0, 8.0, 0.0, 2.5],
            [8.0, 90.5, 9.5, 0.0],
            [3.0, 1.5, 90.5, 0.0],
            [0.0, 0.0, 0.0, 97.5],
        ],
    },
    Table {
        number: "IV",
        what: "x and y, artificial training, natural validation",
        mean: 68.0,
        percent: [
            [67.0, 2.0, 3.0, 23.0],
            [32.0, 97.0, 9.5, 9.5],
            [1.0, 1.0, 87.5, 47.0],
            [0.0, 0.0, 0.0, 20.5],
        ],
    },
    Table {
        number: "V",
        what: "x and y, natural training, natural validation",
        mean: 81.0,
        percent: [
            [88.0, 8.0, 6.0, 7.0],
            [12.0, 91.5, 2.5, 0.0],
            [0.5, 0.5, 91.5, 40.0],
            [0.0, 0.0, 0.0, 53.0],
        ],
    },
];

/// Fig. 4 as the text tells it (sections III-B and III-C): mean hit rates of x
/// alone, y alone, and both at windows of half a second or more, percent.
pub const FIG4_LONG: [f64; 3] = [80.0, 80.0, 90.0];
/// Fig. 4: most of the gain comes up to this window, s.
pub const FIG4_KNEE_S: f64 = 0.1;
