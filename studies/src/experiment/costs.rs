//! Every classifier's hit rate beside what it costs on a Cortex-M4F.

use super::page::Section;
use crate::accuracy::page::Page;

/// Counted kernels, as `cargo xtask count` left them.
const COUNTED: &str = include_str!("../../../docs/measured/instructions.csv");

/// What a classifier's board form consists of.
struct Form {
    /// The classifier, as in its score.
    classifier: &'static str,
    /// Kernels and how often each runs a sample.
    kernels: &'static [(&'static str, f64)],
    /// Bytes of state and of tables in flash.
    bytes: (usize, usize),
    /// What is to be said of it.
    note: &'static str,
}

/// Bytes of a table of likelihoods: 16 bits a bin, channel and class (classes
/// in pairs), without the header.
const fn table(bins: usize, channels: usize, classes: usize) -> usize {
    4 * bins * channels * classes.div_ceil(2)
}

/// Words of an open block and of evidence: sequential, others.
const fn state(classes: usize, sequential: bool) -> usize {
    let evidence = if sequential {
        classes + 1
    } else {
        2 * classes + 2
    };
    4 * (classes + 1 + evidence)
}

/// Weights, biases and scales of a network in f32.
const fn network(inputs: usize, hidden: usize, outputs: usize) -> usize {
    4 * (2 * inputs + hidden * (inputs + 1) + outputs * (hidden + 1))
}

/// Bins of POSE's |DFT| of 6000 samples.
const POSE_BINS: usize = 3001;

/// LEP10's rule on one axis.
const fn one_axis(classifier: &'static str) -> Form {
    Form {
        classifier,
        kernels: &[("classifier push of one channel K=4", 1.0)],
        bytes: (state(4, false), table(347, 1, 4)),
        note: "",
    }
}

const FORMS: [Form; 14] = [
    one_axis("naive Bayes, window of 0.5 s, x"),
    one_axis("naive Bayes, window of 0.5 s, y"),
    Form {
        classifier: "spectral template |DFT|, 352 poses",
        kernels: &[
            ("spectrum push B=120", POSE_BINS as f64 / 120.0),
            (
                "spectrum magnitude B=120",
                POSE_BINS as f64 / 120.0 / 6000.0,
            ),
            (
                "template push C=2 K=4",
                POSE_BINS as f64 / 2.0 * 88.0 / 6000.0,
            ),
        ],
        bytes: (
            8 * POSE_BINS + 8 * 352 + 8,
            2 * POSE_BINS * 352 + 4 * POSE_BINS,
        ),
        note: "25 banks of 120 bins, then 88 times 4 templates, two bins at a time; they fit no \
               board's flash",
    },
    Form {
        classifier: "naive Bayes, window of 0.5 s, x and y",
        kernels: &[("classifier push K=4", 1.0)],
        bytes: (state(4, false), table(347, 2, 4)),
        note: "",
    },
    Form {
        classifier: "maximum likelihood, window of 200 ms",
        kernels: &[("classifier push K=4", 1.0)],
        bytes: (state(4, false), table(347, 2, 4)),
        note: "",
    },
    Form {
        classifier: "sequential Bayes, 200 ms on average",
        kernels: &[
            ("classifier push K=4", 0.95),
            ("classifier push and end of block K=4", 0.05),
        ],
        bytes: (state(4, true), table(347, 2, 4)),
        note: "",
    },
    Form {
        classifier: "template of the power spectrum, 400 ms",
        kernels: &[("spectral template push C=2 B=48 K=4", 1.0)],
        bytes: (8 * 96 + 8, 4 * (2 * 48 * 4 + 48)),
        note: "",
    },
    Form {
        classifier: "network on the power spectrum, 400 ms",
        kernels: &[
            ("spectrum push B=120", 1.0),
            ("spectrum power B=120", 1.0 / 800.0),
            ("network push 120-20-4", 120.0 / 800.0),
        ],
        bytes: (8 * 120 + 8 + 80, network(120, 20, 4) + 480),
        note: "",
    },
    Form {
        classifier: "stationary naive Bayes, 12 channels",
        kernels: &[("classifier push K=9", 6.0)],
        bytes: (state(9, false), table(100, 12, 9)),
        note: "as six pairs of channels",
    },
    Form {
        classifier: "template by sum of squares, 12 channels",
        kernels: &[("template push C=12 K=9", 1.0)],
        bytes: (8 * 9 + 8, 2 * 1000 * 12 * 9),
        note: "",
    },
    Form {
        classifier: "template by sum of squares, 352 poses",
        kernels: &[("template push C=2 K=4", 44.0)],
        bytes: (8 * 352 + 8, 2 * 6000 * 352),
        note: "352 templates as 44 times 4 of 2 channels; they do not fit a board's flash",
    },
    Form {
        classifier: "features f1–f5, quadratic",
        kernels: &[("features push B=332", 1.0)],
        bytes: (8 * 332 + 24, 4 * 332 + 80),
        note: "bins 3 Hz apart",
    },
    Form {
        classifier: "IMP and network 33–33–8",
        kernels: &[
            ("imp push one vibrissa", 33.0),
            ("network push 33-33-8", 33.0 / 3471.0),
        ],
        bytes: (32 * 33 + 4 + 4 * 33 + 132, network(33, 33, 8)),
        note: "",
    },
    Form {
        classifier: "IMP and network 66–66–4, votes",
        kernels: &[
            ("imp push one vibrissa", 66.0),
            ("network push 33-33-8", 4.0 * 33.0 / 58.0),
        ],
        bytes: (2 * (32 * 33 + 4) + 264, network(66, 66, 4)),
        note: "the network as four of 33 by 33 units",
    },
];

/// Mean instructions of a kernel on a Cortex-M4F, in the first format counted.
fn counted(kernel: &str) -> Option<f64> {
    let mut rows = csv::Reader::from_reader(COUNTED.as_bytes());
    let mut found = rows.records().filter_map(Result::ok);
    let row = found.find(|row| row.get(0) == Some(kernel) && row.get(2) == Some("cortex-m4f"))?;
    row.get(3)?.parse().ok()
}

impl Form {
    fn instructions(&self) -> Option<f64> {
        let parts = self
            .kernels
            .iter()
            .map(|(kernel, times)| Some(times * counted(kernel)?));
        parts.sum()
    }
}

/// The table of the scores.
pub(super) fn section(page: &mut Page, sections: &[Section]) {
    let rows: Vec<Vec<String>> = sections
        .iter()
        .flat_map(|section| &section.scores)
        .map(|score| {
            let form = FORMS
                .iter()
                .find(|form| form.classifier == score.classifier);
            let instructions = form.and_then(Form::instructions);
            let cell = |text: Option<String>| text.unwrap_or_else(|| "not counted".to_owned());
            vec![
                // |DFT| must not end the cell.
                score.classifier.replace('|', "\\|"),
                score.task.clone(),
                format!("**{:.1}**", score.hit),
                cell(instructions.map(|n| format!("{n:.0}"))),
                cell(form.map(|form| form.bytes.0.to_string())),
                cell(form.map(|form| form.bytes.1.to_string())),
                form.map_or("", |form| form.note).to_owned(),
            ]
        })
        .collect();
    if rows.is_empty() {
        return;
    }
    page.heading(2, "Every classifier: how well, and at what cost");
    page.say(
        "Hit rate, instructions a sample on a Cortex-M4F (mean, composed of the kernels that \
         `cargo xtask count` counts, without reading the sensor), bytes of state and of tables.",
    );
    page.table(
        "classifier | on | hit rate, % | instructions a sample | state, bytes | tables, bytes | ",
        rows,
    );
}

#[cfg(test)]
mod tests {
    use super::{FORMS, counted};

    #[test]
    fn every_kernel_is_counted() {
        for form in &FORMS {
            for (kernel, _) in form.kernels {
                assert!(counted(kernel).is_some_and(|n| n > 1.0), "{kernel}");
            }
            assert!(form.instructions().is_some());
        }
    }
}
