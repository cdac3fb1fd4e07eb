//! Which program a configuration is made for.

use firmware::boards::{ALL, BoardFacts};
use firmware::{BoardCode, VERSION};
use host_sim::Error;
use scene::Scene;
use whisking::FormatCode;
use wire::{Command, CommandStatus};

use crate::conversation::Conversation;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Program {
    pub(crate) board: BoardCode,
    pub(crate) format: FormatCode,
}

impl Program {
    pub(crate) fn ask(module: &mut Conversation) -> Result<Self, Error> {
        let answer = module.answer(Command::Board)?;
        let [program, version] = answer.values;
        if answer.status != CommandStatus::Done || version as u16 != VERSION {
            return Err(Error::Work(format!(
                "the module's program does not take scenes of version {VERSION}: whisker flash \
                 gives it one that does"
            )));
        }
        let [board, format, ..] = program.to_le_bytes();
        Self::of(board, format)
    }

    pub(crate) fn of(board: u8, format: u8) -> Result<Self, Error> {
        let boards = ALL.iter().map(|facts| facts.code);
        let mut boards = boards.chain([BoardCode::Simulation]);
        let mut formats = [FormatCode::Single, FormatCode::Double, FormatCode::Fixed].into_iter();
        let board = boards.find(|known| *known as u8 == board);
        let format = formats.find(|known| *known as u8 == format);
        let program = board.zip(format);
        let program = program.map(|(board, format)| Self { board, format });
        program.ok_or_else(|| {
            let fault = "the module's program is newer than this one: it has another board or \
                         number format";
            Error::Work(fault.to_owned())
        })
    }

    pub(crate) fn for_scene(board: BoardCode, scene: &Scene) -> Result<Self, Error> {
        let format = match BoardFacts::of(board) {
            None => config::in_simulation(scene),
            Some(facts) => config::on_board(scene, facts.name, facts.has_fpu)
                .map_err(|fault| Error::Input(fault.to_string()))?,
        };
        Ok(Self { board, format })
    }

    /// Its board; none: a simulation.
    pub(crate) fn facts(self) -> Option<&'static BoardFacts> {
        BoardFacts::of(self.board)
    }

    pub(crate) const fn format_name(self) -> &'static str {
        match self.format {
            FormatCode::Single => "f32",
            FormatCode::Double => "f64",
            FormatCode::Fixed => "fixed",
        }
    }
}
