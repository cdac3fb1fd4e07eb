use emulator::campaign::{self, Ending, RunRow};

/// Where one table ends and the next begins.
const END: u8 = 0;

/// The tables of a campaign's shards, their merge and the page of it. A byte of zero parts two
/// tables.
///
/// # Panics
/// If rows that are taken are not what is read back after they are written, if a run is lost or
/// counted twice, or if the page names no harmful one.
pub fn shards(data: &[u8]) {
    let tables = data.split(|byte| *byte == END).map(campaign::read);
    let tables: Vec<Vec<RunRow>> = match tables.collect::<Result<_, _>>() {
        Ok(tables) => tables,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    let count: usize = tables.iter().map(Vec::len).sum();
    for table in &tables {
        let text = written(table);
        let again = campaign::read(text.as_slice()).map(|rows| written(&rows));
        assert_eq!(again.ok(), Some(text));
    }
    let Ok(rows) = campaign::merge(tables) else {
        return;
    };
    assert_eq!(rows.len(), count);
    assert!(rows.is_sorted_by(|a, b| (&a.subject, a.run) < (&b.subject, b.run)));
    if rows.is_empty() {
        return;
    }
    let Ok(page) = campaign::page(&rows) else {
        return;
    };
    assert!(page.contains(&format!("| all | {count} |")));
    let mut harmful = rows.iter().filter(|row| row.outcome == Ending::Harmful);
    assert!(harmful.all(|row| page.contains(&campaign::described(row))));
}

fn written(rows: &[RunRow]) -> Vec<u8> {
    let mut table = csv::Writer::from_writer(Vec::new());
    for row in rows {
        assert!(table.serialize(row).is_ok(), "{row:?}");
    }
    table.into_inner().unwrap_or_default()
}
