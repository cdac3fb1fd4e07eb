//! The mount of whisker, magnet and sensor: its page and its drawing, from one table of
//! dimensions.

mod drawing;
mod field;

use std::fmt::Write as _;

pub(super) use drawing::svg;
use field::Magnet;

/// A dimension and where it comes from.
pub(super) struct Dimension {
    /// Its letter in the drawing.
    letter: char,
    name: &'static str,
    mm: f64,
    source: &'static str,
}

const LENGTH: Dimension = Dimension {
    letter: 'a',
    name: "whisker, from pivot to tip",
    mm: 112.0,
    source: "BIOTACT section II-C, its longest; keys `plant.shaft`, `length_m`",
};
const BASE: Dimension = Dimension {
    letter: 'b',
    name: "diameter at the base",
    mm: 2.0,
    source: "BIOTACT section II-C",
};
const TIP: Dimension = Dimension {
    letter: 'c',
    name: "diameter at the tip",
    mm: 0.25,
    source: "BIOTACT section II-C",
};
const MAGNET_DIAMETER: Dimension = Dimension {
    letter: 'd',
    name: "diameter of the magnet",
    mm: 4.0,
    source: "chosen",
};
const MAGNET_LENGTH: Dimension = Dimension {
    letter: 'e',
    name: "length of the magnet, along its axis of magnetisation",
    mm: 3.0,
    source: "chosen; near 0.87 diameters a cylinder is most like a dipole",
};
const SLEEVE: Dimension = Dimension {
    letter: 'f',
    name: "elastic sleeve (follicle), outer diameter",
    mm: 8.0,
    source: "chosen: 2 mm of it round the magnet, whose edge moves by (e/2) sin 0.15 + (d/2)(1 − cos 0.15) = 0.25 mm",
};
const SLEEVE_LENGTH: Dimension = Dimension {
    letter: 'h',
    name: "length of the sleeve, as much above the magnet's centre as below",
    mm: 5.0,
    source: "chosen; what its stiffness must be: [parts](parts.md#whisker)",
};

/// Remanence, T.
const REMANENCE_T: f64 = 1.2;
/// Field along the axis at the sensor, mT.
const WANTED_MT: f64 = 60.0;
/// The sensor's whole range of tilt, rad.
const TILT_RAD: f64 = 0.15;

const MAGNET: Magnet = Magnet {
    radius_mm: MAGNET_DIAMETER.mm / 2.0,
    length_mm: MAGNET_LENGTH.mm,
    remanence_t: REMANENCE_T,
};

/// From the magnet's face to the sensor's plane, where the field is [`WANTED_MT`].
fn gap() -> Dimension {
    Dimension {
        letter: 'g',
        name: "gap, from the magnet's face to the plane of the Hall elements",
        mm: MAGNET.gap_mm(WANTED_MT),
        source: "computed below, for 60 mT; how deep that plane lies in the package is in the data sheet",
    }
}

/// All, in the order of their letters.
fn dimensions() -> [Dimension; 8] {
    let [a, b, c, d, e, f] = [LENGTH, BASE, TIP, MAGNET_DIAMETER, MAGNET_LENGTH, SLEEVE];
    [a, b, c, d, e, f, gap(), SLEEVE_LENGTH]
}

/// The page.
pub(super) fn page() -> String {
    let mut page = "\
# Mount, magnet and gap

<!-- Generated from xtask/src/docs/mount.rs by `cargo xtask docs`; do not edit by hand. -->

How the whisker's base stands over the sensor. The whisker is held by an elastic sleeve, turns
about a pivot, and carries a magnet that turns with it; the sensor below does not move. Motor and
gear turn all of that as one, about an axis across the whisker, so that the sensor feels what bends
the whisker and not what moves it. Nothing of it has been built or measured.

![Whisker, sleeve, magnet and sensor in section, with their dimensions](mount.svg)

| | dimension | mm | from |
|---|---|---|---|
"
    .to_owned();
    for Dimension {
        letter,
        name,
        mm,
        source,
    } in dimensions()
    {
        // A String takes whatever is written.
        let _ = writeln!(page, "| {letter} | {name} | {mm:.2} | {source} |");
    }
    let dipole = MAGNET.tilt_share(gap().mm) / 0.5;
    let _ = write!(
        page,
        "
- **The pivot is the magnet's centre**: the sleeve is symmetrical about it. Where it lies elsewhere, the magnet moves sideways as it
  turns, which adds to the tilt or takes from it.
- **The magnet is magnetised along the whisker's axis** and centred over the sensor's mark, on its
  axis. Off centre, x and y have an offset: [by symptom](troubleshooting.md#the-whisker).
- **X lies along the direction of whisking**, y across it.
- **Nothing magnetic within some 20 mm** (chosen, five diameters): no steel screw, no iron in the
  mount. The motor's own magnet is the nearest that cannot be avoided; fault 22 tells of a field too
  high, a slow offset that follows the motor's angle of one too near.

## Field and gap

On its axis a cylinder of radius R and length L, magnetised along it with remanence B_r, has at a
distance z from its face

B(z) = (B_r/2) ((L + z)/√((L + z)² + R²) − z/√(z² + R²)).

For this magnet with B_r = {REMANENCE_T} T (chosen, at the low end of neodymium's usual 1.2 to 1.4 T;
take the maker's value). Turned about its centre by a small φ its field across the axis is k B φ:
k is 0.5 for a dipole, and here, from the derivative of the equation above, less.

| z, mm | B, mT | k | B across at {TILT_RAD} rad, mT |
|---|---|---|---|
"
    );
    for step in 2..=10 {
        let z = 0.5 + 0.5 * f64::from(step);
        let (b, k) = (MAGNET.axial_mt(z), MAGNET.tilt_share(z));
        let across = k * b * TILT_RAD.sin();
        let _ = writeln!(page, "| {z:.1} | {b:.0} | {k:.2} | {across:.1} |");
    }
    let _ = write!(
        page,
        "
What a sensor needs:

- **TMAG5170 (A1)**: B within its range along Z, ±100 mT, with room for what the magnet's grade and
  the gap vary by: 60 mT. Across, its ±25 mT are far from used up. It computes 2 X/Z, so that with
  this magnet it reads {:.0} % of the tilt that it would of a dipole: a gain, which a model that is
  trained on the same mount does not see.
- **MLX90333**: the norm of its field within the limits that its data sheet states. They are not
  repeated here, as no copy of that table was at hand; its own report (fault 22, *field too low*,
  *field too high*) says whether they are kept.

A gap that is wrong changes the field along the axis as B, and what is read as the tilt, which is a
ratio, as k: from 3.0 to 3.5 mm by a quarter and by a tenth. A wider gap with a stronger magnet is
more forgiving in both.
",
        100.0 * dipole
    );
    page
}

#[cfg(test)]
mod tests {
    use super::{MAGNET, TILT_RAD, WANTED_MT, dimensions, gap, page};

    #[test]
    fn the_gap_gives_the_field_that_is_wanted() {
        let field = MAGNET.axial_mt(gap().mm);
        assert!((field - WANTED_MT).abs() < 1e-6, "{field}");
        assert!((3.0..3.5).contains(&gap().mm), "{}", gap().mm);
    }

    #[test]
    fn the_sleeve_is_wide_enough_for_the_magnets_edge() {
        let [.., magnet, length, sleeve, _, _] = dimensions();
        let (sine, cosine) = TILT_RAD.sin_cos();
        let moved = length.mm / 2.0 * sine + magnet.mm / 2.0 * (1.0 - cosine);
        assert!((moved - 0.25).abs() < 0.01, "{moved}: the page says 0.25");
        let wall = (sleeve.mm - magnet.mm) / 2.0;
        assert!((wall - 2.0).abs() < 1e-9 && moved < wall / 4.0, "{wall}");
    }

    #[test]
    fn the_page_names_every_dimension() {
        let page = page();
        for dimension in dimensions() {
            let row = format!("| {} | {} | ", dimension.letter, dimension.name);
            assert!(page.contains(&row), "{row}");
        }
    }
}
