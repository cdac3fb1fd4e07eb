use std::cell::RefCell;
use std::rc::Rc;

use firmware::boards::NUCLEO_F446RE;
use wire::{Command, CommandStatus, Load, LoadedWord};

use super::{Conversation, Deployment, load};
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
    let board = Scripted::new(move |command| {
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
    load(&mut Conversation::new(Box::new(board)), &what).unwrap();
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
        let board = Scripted::new(move |command| {
            let refused = Some(status).filter(|_| at(command));
            Some((refused.unwrap_or(CommandStatus::Done), [0; 2]))
        });
        let mut module = Conversation::new(Box::new(board));
        load(&mut module, &what).unwrap_err().to_string()
    };
    let is_load = |command| matches!(command, Command::Load(_));
    let is_word = |command| matches!(command, Command::Word(200, _));
    let without = "the module's image was built without deployment by command; cargo xtask firmware \
                   --any-scene builds one that has it";
    assert_eq!(refused(is_load, CommandStatus::NotHere), without);
    let room = "its flash has no room for so much";
    assert_eq!(refused(is_load, CommandStatus::OutOfRange), room);
    let armed = "load: a motor is armed";
    assert_eq!(refused(is_load, CommandStatus::Armed), armed);
    let fault = "its flash did not take what was written; try again";
    assert_eq!(refused(is_word, CommandStatus::NotWritten), fault);
    let late =
        "the board waited two seconds for the rest, and runs by the scene before; deploy again";
    assert_eq!(refused(is_word, CommandStatus::NotHere), late);
}
