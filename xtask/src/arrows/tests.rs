//! Small trees, each with what the check must find or must let pass.

use std::collections::BTreeSet;
use std::path::Path;

use super::circles::{Arrows, circles};
use super::paths;
use super::rooms::{Dependency, Package, against_the_order};
use super::tree::Tree;

/// The arrows between `files`, a line each after its name, of which the first is the
/// root.
fn arrows(files: &str) -> Arrows {
    let files = || {
        files
            .lines()
            .filter_map(|line| line.trim().split_once(": "))
    };
    let reader = |path: &Path| {
        let found = files().find(|(name, _)| Path::new(name) == path);
        found.map(|(_, text)| text.to_owned())
    };
    let mut arrows = Arrows::new();
    let (root, _) = files().next().expect("a root");
    let tree = Tree::read(Path::new(root), &reader).expect("a tree");
    paths::arrows(&tree, &mut arrows);
    arrows
}

/// The arrows as text: from, to and names.
fn drawn(files: &str) -> Vec<String> {
    let mut drawn = Vec::new();
    for ((from, to), names) in arrows(files) {
        let names = names.into_iter().collect::<Vec<_>>().join(" ");
        drawn.push(format!("{} {} {names}", from.display(), to.display()));
    }
    drawn
}

/// The sizes of the circles among `files`.
fn sizes(files: &str) -> Vec<usize> {
    circles(&arrows(files)).iter().map(BTreeSet::len).collect()
}

fn package(name: &str, uses: &[&str]) -> Package {
    let dependencies = uses.iter().map(|&used| Dependency {
        name: used.to_owned(),
    });
    Package {
        name: name.to_owned(),
        dependencies: dependencies.collect(),
        targets: Vec::new(),
    }
}

#[test]
fn a_dependency_downwards_passes() {
    let packages = [
        package("studies", &["host-sim", "classifiers", "physics"]),
        package("host-sim", &["firmware", "scene", "physics"]),
        package("physics", &[]),
    ];
    assert_eq!(against_the_order(&packages), Vec::<String>::new());
}

#[test]
fn a_dependency_upwards_fails() {
    let found = against_the_order(&[package("firmware", &["host-sim", "plan"])]);
    assert_eq!(found, ["firmware -> host-sim does not point down"]);
}

#[test]
fn a_dependency_within_a_row_fails() {
    let found = against_the_order(&[package("tactile", &["whisking"])]);
    assert_eq!(found, ["tactile -> whisking does not point down"]);
}

#[test]
fn a_package_without_a_row_fails() {
    assert_eq!(against_the_order(&[package("new", &[])]).len(), 1);
}

#[test]
fn a_chain_passes() {
    let files = "
        lib.rs: pub mod a; pub mod b; mod c; pub use c::C;
        a.rs: use crate::b::B; pub struct A(B);
        b.rs: pub struct B(super::c::C);
        c.rs: pub struct C;
    ";
    assert_eq!(drawn(files), ["a.rs b.rs B", "b.rs c.rs C"]);
    assert_eq!(sizes(files), [0; 0]);
}

#[test]
fn a_circle_of_two_fails() {
    let files = "
        lib.rs: mod a; mod b;
        a.rs: use crate::b::B; pub struct A;
        b.rs: pub struct B; fn f() -> super::a::A { todo!() }
    ";
    assert_eq!(sizes(files), [2]);
}

#[test]
fn a_circle_of_three_fails() {
    let files = "
        lib.rs: mod a; mod b; mod c;
        a.rs: use crate::b; fn f() { b::g(); }
        b.rs: use crate::c::*; pub fn g() { h() }
        c.rs: pub fn h() { let x = crate::a::LIMIT; }
    ";
    // The last arrow leads to nothing until a.rs defines it.
    assert_eq!(sizes(files), [0; 0]);
    let files = files.replace("a.rs: ", "a.rs: pub const LIMIT: u8 = 1; ");
    assert_eq!(sizes(&files), [3]);
}

#[test]
fn a_circle_through_a_reexport_fails() {
    let files = "
        lib.rs: mod a; mod b; pub(crate) use b::inner::thing as other;
        a.rs: pub struct A; fn f() { crate::other() }
        b.rs: pub(super) mod inner;
        b/inner.rs: use crate::a::A; pub fn thing() {}
    ";
    assert_eq!(sizes(files), [2]);
    assert!(drawn(files).contains(&"a.rs b/inner.rs thing".to_owned()));
}

#[test]
fn a_module_and_a_reexport_may_have_one_name() {
    let files = "
        lib.rs: mod a; mod b; pub use b::run as b;
        a.rs: pub fn f() { super::b() }
        b.rs: pub fn run() {}
    ";
    assert_eq!(drawn(files), ["a.rs b.rs run"]);
}

#[test]
fn a_parent_and_its_child_form_a_circle() {
    let files = "
        main.rs: mod a; fn main() { a::f() } struct Shared;
        a.rs: pub fn f() { super::Shared; }
    ";
    assert_eq!(sizes(files), [2]);
}

#[test]
fn an_associated_item_stands_where_its_impl_stands() {
    let files = "
        lib.rs: mod a; mod b; mod c;
        a.rs: pub struct A; pub type Short = A;
        b.rs: use crate::a::A; impl A { pub fn new() -> A { Self::new() } }
        c.rs: fn f() { crate::a::Short::new(); }
    ";
    assert_eq!(
        drawn(files),
        ["b.rs a.rs A", "c.rs a.rs Short", "c.rs b.rs A::new"]
    );
}

#[test]
fn macros_and_their_arguments_draw_arrows() {
    let files = r#"
        lib.rs: #[macro_use] mod a; mod b; mod c;
        a.rs: macro_rules! make { () => { $crate::c::C } }
        b.rs: fn f() { make!(); println!("{}", crate::c::LENGTH); }
        c.rs: pub struct C; pub const LENGTH: u8 = 1;
    "#;
    assert_eq!(
        drawn(files),
        ["a.rs c.rs C", "b.rs a.rs make", "b.rs c.rs LENGTH"]
    );
}

#[test]
fn items_that_a_macro_writes_are_known() {
    let files = "
        lib.rs: mod a; mod b; mod keys;
        a.rs: crate::keys::keys! { pub struct A { x: u8 } }
        b.rs: crate::keys::keys! { pub(crate) B fills u8 } use crate::a::A;
        keys.rs: macro_rules! keys { () => {} } pub(crate) use keys; fn f(_: crate::b::B) {}
    ";
    assert!(drawn(files).contains(&"b.rs a.rs A".to_owned()));
    assert_eq!(sizes(files), [3]);
}

#[test]
fn tests_draw_none() {
    let files = "
        lib.rs: mod a; mod b; #[cfg(all(test, unix))] mod missing;
        a.rs: pub struct A; #[cfg(test)] mod tests { use crate::b::B; }
        b.rs: pub struct B(crate::a::A); #[test] fn t() { crate::a::A; }
    ";
    assert_eq!(drawn(files), ["b.rs a.rs A"]);
}

#[test]
fn what_hides_a_name_draws_none() {
    let files = "
        lib.rs: mod a; mod b;
        a.rs: pub struct T; pub const N: u8 = 1;
        b.rs: use super::a::*; fn f<T, const N: usize>(t: T) -> [T; N] { todo!() }
    ";
    assert_eq!(drawn(files), Vec::<String>::new());
}

#[test]
fn files_are_found_where_the_compiler_looks() {
    let files = r#"
        src/bin/p.rs: #[path = "../board/mod.rs"] mod board; mod own { mod deep; }
        src/board/mod.rs: mod pins; pub struct Board;
        src/board/pins.rs: use super::Board; use crate::own::Inline;
        src/bin/own/deep.rs: use crate::board::Board as Other;
    "#;
    let found = drawn(files);
    let board = "src/board/mod.rs Board";
    assert_eq!(
        found,
        [
            format!("src/bin/own/deep.rs {board}"),
            format!("src/board/pins.rs {board}")
        ]
    );
}
