//! Number format of the tick: what `whisking.numbers` comes to where the scene runs.

use scene::{Integrator, Numbers, Scene};
use whisking::FormatCode as NumberFormat;

/// A number format that a board does not have.
///
/// It prints as `whisking.numbers: what was found; what is allowed`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("whisking.numbers: found \"{found}\"; allowed on the {board}: {}", self.allowed())]
pub struct NoSuchFormat {
    found: Numbers,
    board: String,
    has_fpu: bool,
}

impl NoSuchFormat {
    const fn allowed(&self) -> &'static str {
        match (self.found, self.has_fpu) {
            (Numbers::Double, true) => "\"auto\", \"f32\" or \"fixed\"; f64 is for simulations",
            (Numbers::Double, false) => "\"auto\" or \"fixed\"; f64 is for simulations",
            _ => "\"auto\" or \"fixed\", because it has no FPU",
        }
    }
}

/// The format of a simulation. `auto` is `f64` for `euler`, whose point is to be
/// the papers', otherwise `f32`.
pub fn in_simulation(scene: &Scene) -> NumberFormat {
    let integrator = scene.whisking.as_ref().map(|whisking| whisking.integrator);
    match (given(scene), integrator) {
        (Numbers::Auto, Some(Integrator::Euler)) | (Numbers::Double, _) => NumberFormat::Double,
        (Numbers::Auto | Numbers::Single, _) => NumberFormat::Single,
        (Numbers::Fixed, _) => NumberFormat::Fixed,
    }
}

/// The format of a board with an FPU or without. `auto` is `f32` with an FPU,
/// otherwise fixed point. `board` is what a message calls it.
///
/// # Errors
/// A format that the board does not have.
pub fn on_board(scene: &Scene, board: &str, has_fpu: bool) -> Result<NumberFormat, NoSuchFormat> {
    match given(scene) {
        Numbers::Auto | Numbers::Single if has_fpu => Ok(NumberFormat::Single),
        Numbers::Auto | Numbers::Fixed => Ok(NumberFormat::Fixed),
        found @ (Numbers::Single | Numbers::Double) => Err(NoSuchFormat {
            found,
            board: board.to_owned(),
            has_fpu,
        }),
    }
}

/// A passive scene says nothing.
fn given(scene: &Scene) -> Numbers {
    let whisking = scene.whisking.as_ref();
    whisking.map_or(Numbers::Auto, |whisking| whisking.numbers)
}

#[cfg(test)]
mod tests {
    use super::NumberFormat::{self, Double, Fixed, Single};
    use super::{in_simulation, on_board};
    use crate::tests::{passive, scene};
    use scene::Scene;

    fn of(integrator: &str, numbers: &str) -> Scene {
        let integrator = format!("whisking.integrator={integrator}");
        scene(&[&integrator, &format!("whisking.numbers={numbers}")])
    }

    #[test]
    fn a_simulation_has_every_format() {
        for (integrator, numbers, format) in [
            ("exact", "auto", Single),
            ("euler", "auto", Double),
            ("exact", "f64", Double),
            ("euler", "f32", Single),
            ("euler", "fixed", Fixed),
        ] {
            assert_eq!(in_simulation(&of(integrator, numbers)), format);
        }
        assert_eq!(in_simulation(&passive()), Single);
    }

    #[test]
    fn a_board_has_what_its_core_computes() {
        let on = |numbers, has_fpu| -> Result<NumberFormat, String> {
            on_board(&of("euler", numbers), "toy", has_fpu).map_err(|error| error.to_string())
        };
        assert_eq!(
            [true, false].map(|fpu| on("auto", fpu)),
            [Ok(Single), Ok(Fixed)]
        );
        assert_eq!(
            ["fixed", "f32"].map(|numbers| on(numbers, true)),
            [Ok(Fixed), Ok(Single)]
        );
        let no_fpu = "\"auto\" or \"fixed\", because it has no FPU";
        let simulations = "\"auto\", \"f32\" or \"fixed\"; f64 is for simulations";
        let neither = "\"auto\" or \"fixed\"; f64 is for simulations";
        for (numbers, has_fpu, allowed) in [
            ("f32", false, no_fpu),
            ("f64", true, simulations),
            ("f64", false, neither),
        ] {
            let expected =
                format!("whisking.numbers: found \"{numbers}\"; allowed on the toy: {allowed}");
            assert_eq!(on(numbers, has_fpu), Err(expected));
        }
        assert_eq!(on_board(&passive(), "toy", false), Ok(Fixed));
    }
}
