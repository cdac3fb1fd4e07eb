//! Every classifier's hit rate beside what it costs on a Cortex-M4F.

use std::path::Path;

use super::page::Section;
use crate::accuracy::page::Page;

/// The table of the scores. Instructions a sample and bytes are from
/// `docs/classifiers.csv` (name, instructions, bytes of state, bytes of
/// tables), where the counted form has the same name.
pub(super) fn section(page: &mut Page, sections: &[Section], docs: &Path) {
    let rows: Vec<Vec<String>> = sections
        .iter()
        .flat_map(|section| &section.scores)
        .map(|score| {
            let cost = find(docs, score.classifier);
            let [instructions, state, table] =
                cost.unwrap_or_else(|| ["not counted"; 3].map(str::to_owned));
            vec![
                score.classifier.to_owned(),
                score.task.clone(),
                format!("**{:.1}**", score.hit),
                instructions,
                state,
                table,
            ]
        })
        .collect();
    if rows.is_empty() {
        return;
    }
    page.heading(2, "Every classifier: how well, and at what cost");
    page.say(
        "Hit rate, instructions a sample on a Cortex-M4F (mean, without reading the sensor), and \
         bytes of state and tables.",
    );
    page.table(
        "classifier | on | hit rate, % | instructions a sample | state, bytes | tables, bytes",
        rows,
    );
}

/// Instructions, bytes of state and of tables of a classifier.
fn find(docs: &Path, classifier: &str) -> Option<[String; 3]> {
    let mut table = csv::Reader::from_path(docs.join("classifiers.csv")).ok()?;
    let rows = table.records().filter_map(Result::ok);
    let mut rows = rows.filter(|row| row.get(0) == Some(classifier));
    let row = rows.next()?;
    let cell = |n: usize| row.get(n).map(str::to_owned);
    Some([cell(1)?, cell(2)?, cell(3)?])
}
