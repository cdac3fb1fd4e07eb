//! That what is built after host-sim takes what was built for it: cargo compiles a dependency again
//! where its features are others, or where a program takes what only wrote code before.

use std::collections::BTreeSet;

use crate::ci::ALL;
use crate::run::{cargo, output};

/// What is built by a choice of packages, each with its features.
fn built(choice: &str, edges: &str) -> BTreeSet<String> {
    let mut tree = cargo("tree --locked --offline --no-dedupe --prefix none -e");
    tree.args([edges, "-f", "{p} {f}"]).args(choice.split(' '));
    let said = output(&mut tree).unwrap();
    said.lines().map(|line| line.trim().to_owned()).collect()
}

#[test]
fn what_was_built_for_the_simulator_is_taken_by_tests_bench_and_python() {
    let simulator = built("-p host-sim", "normal,build");
    assert!(simulator.len() > 50, "{}", simulator.len());
    let linked = built("-p host-sim", "normal,no-proc-macro");
    let python = "-p whisker-python --features compiled-once";
    for (choice, edges) in [
        ("-p whisker", "normal"),
        (python, "normal"),
        (ALL, "normal,dev"),
    ] {
        let after = built(choice, &format!("{edges},build"));
        let of_others = |line: &&String| !line.starts_with("host-sim ");
        let again: Vec<&String> = simulator.difference(&after).filter(of_others).collect();
        assert!(
            again.is_empty(),
            "compiled again with {choice}: {again:#?}\nname their features in crates/united"
        );
        let linked_after = built(choice, &format!("{edges},no-proc-macro"));
        let flags: Vec<&String> = simulator
            .difference(&linked)
            .filter(|package| linked_after.contains(*package))
            .collect();
        assert!(
            flags.is_empty(),
            "compiled again with {choice}, as a program takes them: {flags:#?}\nname them in crates/united"
        );
    }
}
