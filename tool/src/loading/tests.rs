use std::cell::RefCell;
use std::rc::Rc;

use firmware::boards::NUCLEO_F446RE;
use wire::{Command, CommandStatus, Load, LoadedWord};

use super::{Deployment, load};
use crate::deployment::tests::{loaded, model, on};
use crate::source::Scripted;

fn bench() -> Deployment {
    let (loaded, model) = (loaded("bench.toml", &[]), model("textures"));
    on(&NUCLEO_F446RE, loaded, Some(model)).unwrap()
}

#[test]
fn every_word_is_written_once_and_what_makes_it_count_comes_last() {
    let what = bench();
    let [config, model] = what.words();
    let order = Load {
        config: config.len() as u16,
        model: model.len() as u16,
    };
    let written = Rc::new(RefCell::new(Vec::new()));
    let (place, mut is_lost, mut has_begun) = (written.clone(), false, false);
    let mut board = Scripted::new(move |command| {
        let mut written = place.borrow_mut();
        match command {
            Command::Load(load) => {
                assert_eq!(load, order);
                has_begun = true;
            }
            Command::Word(number, word) if number == written.len() as u8 => {
                assert!(has_begun);
                written.push(word);
                // The answer to one is lost.
                if written.len() == 300 {
                    return None;
                }
            }
            // Only that one is asked for again.
            Command::Word(..) => {
                assert!(!is_lost && written.len() == 300);
                is_lost = true;
            }
            Command::Restart | Command::Hello => {}
            command => panic!("{command:?}"),
        }
        Some((CommandStatus::Done, [0; 2]))
    });
    load(&mut board, &what).unwrap();
    let written = written.borrow();
    let expected = (0..order.words()).map(|number| match order.word(number).unwrap() {
        LoadedWord::Model(n) => model[usize::from(n)],
        LoadedWord::Config(n) => config[usize::from(n)],
    });
    assert!(expected.eq(written.iter().copied()));
    assert_eq!(written.last(), config.first());
}

#[test]
fn a_board_that_refuses_says_why() {
    let what = bench();
    let refused = |at: fn(Command) -> bool, status| {
        let mut board = Scripted::new(move |command| {
            let status = if at(command) {
                status
            } else {
                CommandStatus::Done
            };
            Some((status, [0; 2]))
        });
        load(&mut board, &what).unwrap_err().to_string()
    };
    let is_load = |command| matches!(command, Command::Load(_));
    assert_eq!(
        refused(is_load, CommandStatus::NotHere),
        "the module's image was built without deployment by command; cargo xtask firmware \
         --any-scene builds one that has it"
    );
    for (at, status, fault) in [
        (
            is_load as fn(Command) -> bool,
            CommandStatus::OutOfRange,
            "its flash has no room for so much",
        ),
        (is_load, CommandStatus::Armed, "load: a motor is armed"),
        (
            |command| matches!(command, Command::Word(200, _)),
            CommandStatus::NotWritten,
            "its flash did not take what was written; try again",
        ),
    ] {
        assert_eq!(refused(at, status), fault);
    }
}
