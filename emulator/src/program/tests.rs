use firmware::boards::{BoardFacts, NUCLEO_F103RB, NUCLEO_F446RE};
use scene::Scene;

use super::Program;
use crate::deployment::Deployment;

const BENCH: &str = include_str!("../../../scenes/bench.toml");

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// An ELF file of one segment, whose debug information names a board's program.
fn elf(source: &str, at: u32, contents: &[u8]) -> Vec<u8> {
    const NAMES: &[u8] = b"\0.debug_str\0.shstrtab\0\0\0";
    let (header, segment, section) = (52, 32, 40);
    let first = header + segment;
    let size = contents.len() as u32;
    let names = first + size;
    let strings = names + NAMES.len() as u32;
    let sections = (strings + source.len() as u32).next_multiple_of(4);
    let halves = |low: u32, high: u32| low | high << 16;
    let mut file = words(&[u32::from_le_bytes(*b"\x7fELF"), 0x0001_0101, 0, 0]);
    file.extend(words(&[
        halves(2, 40),
        1,
        at,
        header,
        sections,
        0,
        halves(header, segment),
        halves(1, section),
        halves(3, 2),
    ]));
    file.extend(words(&[1, first, at, at, size, size, 4, 4]));
    file.extend_from_slice(contents);
    file.extend_from_slice(NAMES);
    file.extend_from_slice(source.as_bytes());
    file.resize(sections as usize, 0);
    let table = |name: u32, kind: u32, at: u32, size: usize| {
        words(&[name, kind, 0, 0, at, size as u32, 0, 0, 1, 0])
    };
    file.extend(table(0, 0, 0, 0));
    file.extend(table(1, 1, strings, source.len()));
    file.extend(table(12, 3, names, NAMES.len()));
    file
}

fn scene(changes: &[(&str, &str)]) -> Scene {
    let text = changes
        .iter()
        .fold(BENCH.to_owned(), |text, (from, to)| text.replace(from, to));
    Scene::from_str("bench.toml", &text).unwrap()
}

/// The program of a board that brings a scene with it.
fn program(scene: &Scene, board: &BoardFacts, source: &str) -> Program {
    let [slot, _] = board.flash.slots;
    let config = Deployment::of(scene, None, board).unwrap().config;
    let file = elf(
        &format!("src/bin/{source}.rs"),
        slot.config().start,
        &config,
    );
    Program::parse(file).unwrap()
}

#[test]
fn a_program_is_for_the_scene_that_it_brings() {
    let bench = scene(&[]);
    for (board, source) in [
        (&NUCLEO_F446RE, "nucleo_f446re"),
        (&NUCLEO_F103RB, "nucleo_f103rb"),
    ] {
        let program = program(&bench, board, source);
        assert_eq!(program.model().unwrap().program, source);
        assert_eq!(program.check_of(&bench), Ok(()));
        let other = scene(&[("\"bench\"", "\"another\"")]);
        let fault = program.check_of(&other).unwrap_err().to_string();
        let expected = "found that of the scene \"bench\", allowed: that of \"another\"";
        assert!(fault.ends_with(expected), "{fault}");
        let slow = scene(&[("tick_hz    = 2000", "tick_hz = 1000")]);
        let fault = program.check_of(&slow).unwrap_err().to_string();
        assert!(
            fault.contains("found tick_hz = 2000, allowed: 1000"),
            "{fault}"
        );
    }
}

#[test]
fn a_program_without_a_scene_is_for_any() {
    let elsewhere = NUCLEO_F446RE.flash.program.start;
    let file = elf("src/bin/nucleo_f446re.rs", elsewhere, &[0; 16]);
    let program = Program::parse(file).unwrap();
    assert_eq!(program.check_of(&scene(&[])), Ok(()));
}

#[test]
fn other_files_are_no_programs() {
    for file in [&b""[..], b"a text", b"\x7fELF"] {
        assert!(Program::parse(file.to_vec()).is_err());
    }
    let file = elf("src/bin/another.rs", 0, &[0; 16]);
    let program = Program::parse(file).unwrap();
    assert!(program.check_of(&scene(&[])).is_err());
}
