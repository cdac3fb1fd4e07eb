//! A whisker pressed slowly against a plate: what to press, checked, and the tables of it.

use std::io;

use physics::elastica::{MOST_PUSH_DEG, MOST_TAPER, Press, PressError, Pressed};
use physics::{Biotact, Follicle, Shaft};
use scene::key_facts;

use crate::columns::{self, Column, columns};
use crate::world::SHAFTS;

/// What to press, and how far.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Pressing {
    /// A shaft by its name, as scenes have it, or in its place the five numbers that follow
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME"))]
    pub shaft: Option<String>,
    /// Length of the shaft
    #[cfg_attr(feature = "cli", arg(long, value_name = "M"))]
    pub length_m: Option<f64>,
    /// Its diameter at the base
    #[cfg_attr(feature = "cli", arg(long, value_name = "M"))]
    pub hub_m: Option<f64>,
    /// That diameter over the one at the tip
    #[cfg_attr(feature = "cli", arg(long, value_name = "RATIO"))]
    pub taper: Option<f64>,
    /// Young's modulus of the material
    #[cfg_attr(feature = "cli", arg(long, value_name = "PA"))]
    pub youngs_pa: Option<f64>,
    /// Rotational stiffness of the follicle, N m/rad; inf: the base is clamped
    #[cfg_attr(feature = "cli", arg(long, value_name = "K"))]
    pub follicle_nm_rad: Option<f64>,
    /// Angle between shaft and plate in the plane of whisking; the plate passes through the
    /// unbent tip at first touch
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG", default_value_t = SLANT_DEG))]
    pub slant_deg: f64,
    /// Inclination of the plate towards the motor's axis
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG", default_value_t = 0.0))]
    pub tilt_deg: f64,
    /// Coefficient of friction of a tip that slides from the first touch on
    #[cfg_attr(feature = "cli", arg(long, value_name = "MU", default_value_t = 0.0))]
    pub friction: f64,
    /// Angles of the motor beyond first touch, a row each
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "A,B,...", value_delimiter = ',', required = true)
    )]
    pub push_deg: Vec<f64>,
}

/// The slant where none is given, as of scenes.
pub const SLANT_DEG: f64 = physics::Facing::USUAL.slant_deg;

/// What is wrong with a [`Pressing`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{key}: {fault}")]
pub struct Refused {
    /// The field.
    pub key: &'static str,
    /// What was found, and what is allowed.
    pub fault: String,
}

impl Refused {
    fn new(key: &'static str, found: impl std::fmt::Display, allowed: &str) -> Self {
        let fault = format!("found {found}, allowed: {allowed}");
        Self { key, fault }
    }
}

/// The columns of the table, a row a push.
pub const COLUMNS: [Column; 7] = columns! {
    "push_deg", "degrees", "angle of the motor beyond first touch";
    "moment_x_nm", "N m", "size of the moment at the base in the plane of whisking";
    "moment_y_nm", "N m", "the same across it";
    "normal_n", "N", "force along the plate's normal";
    "friction_n", "N", "size of the force along the plate";
    "contact_m", "m", "arc length from the base to the contact";
    "place_m", "m",
        "place of the contact from first touch, along the plate in the plane of whisking; positive \
        away from the base";
};

/// The columns of the shape, of each push points from base to tip.
pub const OF_SHAPE: [Column; 5] = columns! {
    "push_deg", "degrees", "angle of the motor beyond first touch";
    "s_m", "m", "arc length from the base";
    "x_m", "m", "along the unbent shaft at first touch, from the base";
    "y_m", "m", "towards protraction, in the plane of whisking";
    "z_m", "m", "along the motor's axis";
};

impl Pressing {
    /// The shaft at each push, in their order.
    ///
    /// # Errors
    /// The first field that is wrong, or the push that does not hold.
    pub fn press(&self) -> Result<Vec<Pressed>, Refused> {
        let press = Press {
            shaft: self.shaft()?,
            slant_deg: of_scene("slant_deg", "slant_deg", self.slant_deg)?,
            tilt_deg: of_scene("tilt_deg", "tilt_deg", self.tilt_deg)?,
            friction: of_scene("friction", "friction", self.friction)?,
        };
        for push in &self.push_deg {
            within("push_deg", *push, [0.0, MOST_PUSH_DEG])?;
        }
        press.at(&self.push_deg).map_err(|error| match error {
            PressError::Ends { up_to_deg } => {
                let most = self.push_deg.iter().copied().fold(0.0, f64::max);
                let why = "beyond it the shaft snaps over, lets go, or is behind the plate";
                Refused::new("push_deg", most, &format!("0 to {up_to_deg}; {why}"))
            }
            PressError::Setting(bad) => Refused {
                key: bad.0,
                fault: bad.to_string(),
            },
        })
    }

    fn shaft(&self) -> Result<Shaft, Refused> {
        let numbers = [
            ("length_m", self.length_m),
            ("hub_m", self.hub_m),
            ("taper", self.taper),
            ("youngs_pa", self.youngs_pa),
            ("follicle_nm_rad", self.follicle_nm_rad),
        ];
        if let Some(name) = &self.shaft {
            if let Some((key, Some(found))) = numbers.iter().find(|(_, value)| value.is_some()) {
                let allowed = "a shaft by its name or by its numbers, not both";
                return Err(Refused::new(key, found, allowed));
            }
            let known = SHAFTS.iter().find(|(known, _)| known.name() == name);
            let names: Vec<&str> = SHAFTS.iter().map(|(known, _)| known.name()).collect();
            let unknown = || Refused::new("shaft", format!("{name:?}"), &names.join(", "));
            return known.map(|(_, shaft)| *shaft).ok_or_else(unknown);
        }
        if numbers.iter().all(|(_, value)| value.is_none()) {
            let allowed =
                "a name, or in its place length, hub, taper, Young's modulus and follicle";
            return Err(Refused::new("shaft", "none", allowed));
        }
        let mut given = [0.0; 5];
        for (slot, (key, value)) in given.iter_mut().zip(numbers) {
            let allowed = "all five numbers of a shaft";
            *slot = value.ok_or_else(|| Refused::new(key, "none", allowed))?;
        }
        of_numbers(given)
    }
}

fn of_numbers([length, hub, taper, youngs, follicle]: [f64; 5]) -> Result<Shaft, Refused> {
    let length_m = of_scene("length_m", "length_m", length)?;
    within("hub_m", hub, [1e-5, length_m / 5.0])?;
    within("taper", taper, [1.0, MOST_TAPER.min(hub / 1e-6)])?;
    if follicle != f64::INFINITY {
        of_scene("follicle_nm_rad", "follicle_n_m_rad", follicle)?;
    }
    let other = Shaft::biotact(Biotact::Middle);
    Ok(Shaft {
        length_m,
        hub_diameter_m: hub,
        tip_diameter_m: hub / taper,
        youngs_pa: of_scene("youngs_pa", "youngs_pa", youngs)?,
        follicle: Follicle {
            rotation_n_m_rad: follicle,
            ..other.follicle
        },
        ..other
    })
}

fn of_scene(key: &'static str, of: &str, value: f64) -> Result<f64, Refused> {
    let facts = key_facts(&format!("plant.{of}"));
    let ends = facts.and_then(|facts| facts.ends);
    within(key, value, ends.unwrap_or([f64::MIN, f64::MAX]))
}

fn within(key: &'static str, value: f64, [low, high]: [f64; 2]) -> Result<f64, Refused> {
    // Not a number is outside, too.
    if (low..=high).contains(&value) {
        Ok(value)
    } else {
        Err(Refused::new(key, value, &format!("{low} to {high}")))
    }
}

impl Pressing {
    /// A row's numbers, in the order of [`COLUMNS`].
    pub fn cells(push_deg: f64, pressed: &Pressed) -> [f64; 7] {
        let [moment_x, moment_y] = pressed.moment_n_m;
        let [normal, friction] = [pressed.normal_n, pressed.friction_n];
        let [contact, place] = [pressed.contact_m, pressed.place_m];
        [
            push_deg, moment_x, moment_y, normal, friction, contact, place,
        ]
    }

    /// Writes the table.
    ///
    /// # Errors
    /// Any error of the writer.
    pub fn write(&self, table: impl io::Write, pressed: &[Pressed]) -> io::Result<()> {
        let rows = self.push_deg.iter().zip(pressed);
        let rows = rows.map(|(push, pressed)| Self::cells(*push, pressed));
        write(table, &COLUMNS, rows)
    }

    #[cfg(feature = "cli")]
    pub(crate) fn write_shapes(
        &self,
        table: impl io::Write,
        pressed: &[Pressed],
    ) -> io::Result<()> {
        let each = self.push_deg.iter().zip(pressed);
        let points = each.flat_map(|(push, pressed)| {
            let points = pressed.points_m.iter();
            points.map(|[s, x, y, z]| [*push, *s, *x, *y, *z])
        });
        write(table, &OF_SHAPE, points)
    }
}

/// Rows with ten digits; the push as it was given.
fn write<const N: usize>(
    table: impl io::Write,
    columns: &[Column; N],
    rows: impl Iterator<Item = [f64; N]>,
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(table);
    table.write_record(columns::names(columns))?;
    for row in rows {
        let cell = |(n, value): (usize, &f64)| match n {
            0 => value.to_string(),
            _ => format!("{value:.9e}"),
        };
        table.write_record(row.iter().enumerate().map(cell))?;
    }
    table.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> Pressing {
        Pressing {
            shaft: Some(name.to_owned()),
            slant_deg: SLANT_DEG,
            push_deg: vec![5.0],
            ..Pressing::default()
        }
    }

    #[test]
    fn every_shaft_of_scenes_has_its_name() {
        let allowed = key_facts("plant.shaft").unwrap().allowed;
        let names: Vec<&str> = allowed.split('"').skip(1).step_by(2).collect();
        assert!(names.contains(&"biotact-middle"), "{allowed}");
        for name in names.into_iter().filter(|name| *name != "own") {
            assert!(named(name).press().is_ok(), "{name}");
        }
    }

    /// What the solver refuses is refused before, by the name of its field.
    #[test]
    fn the_ends_of_all_ranges_are_allowed() {
        let numbers = [0.01, 1e-5, 10.0, 1e5, 1e-9];
        let most = [1.0, 0.2, MOST_TAPER, 1e12, f64::INFINITY];
        for numbers in [numbers, most] {
            assert_eq!(of_numbers(numbers).unwrap().check(), Ok(()));
        }
    }
}
