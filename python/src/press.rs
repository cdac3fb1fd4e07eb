//! A whisker pressed slowly against a plate: `host-sim press` on arrays.

use host_sim::cells::Cells as _;
use host_sim::pressing::{COLUMNS, Pressing};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::outside::wrong;
use crate::table::{Kind, Layout};

/// How a tapered whisker bends that is pressed slowly against a plate, solved exactly: a row a
/// push, with the columns of `columns("press")`.
///
/// `shaft` is a name, as scenes have it, or a dictionary of `length_m`, `hub_m` (the diameter at
/// the base), `taper` (that over the diameter at the tip), `youngs_pa` and `follicle_nm_rad`.
/// `push_deg` is one angle of the motor beyond first touch, or several. What is wrong raises a
/// `ValueError` with its range; a push that does not hold, with the largest that does.
#[pyfunction]
#[pyo3(signature = (shaft, *, push_deg, slant_deg=host_sim::pressing::SLANT_DEG, tilt_deg=0.0, friction=0.0))]
#[pyo3(text_signature = "(shaft, *, push_deg, slant_deg=30.0, tilt_deg=0.0, friction=0.0)")]
pub(crate) fn press<'py>(
    py: Python<'py>,
    shaft: &Bound<'py, PyAny>,
    push_deg: &Bound<'py, PyAny>,
    slant_deg: f64,
    tilt_deg: f64,
    friction: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let push_deg = match push_deg.extract::<f64>() {
        Ok(one) => vec![one],
        Err(_) => push_deg
            .try_iter()?
            .map(|push| push?.extract())
            .collect::<PyResult<_>>()?,
    };
    let mut pressing = Pressing {
        slant_deg,
        tilt_deg,
        friction,
        push_deg,
        ..Pressing::default()
    };
    if let Ok(numbers) = shaft.cast::<PyDict>() {
        give(&mut pressing, numbers)?;
    } else {
        pressing.shaft = Some(shaft.extract()?);
    }
    let pressed = py.detach(|| pressing.press()).map_err(wrong)?;
    let columns = COLUMNS.iter().map(|column| (column.name, Kind::Number));
    let (layout, mut rows) = (Layout::new(columns), Vec::new());
    for (push, pressed) in pressing.push_deg.iter().zip(&pressed) {
        let cells = Pressing::cells(*push, pressed);
        layout.row(&mut rows).numbers(&cells, 0);
    }
    layout.array(py, rows)
}

/// Gives the numbers of a shaft.
fn give(pressing: &mut Pressing, numbers: &Bound<'_, PyDict>) -> PyResult<()> {
    for (key, value) in numbers {
        let key: String = key.extract()?;
        let slot = match key.as_str() {
            "length_m" => &mut pressing.length_m,
            "hub_m" => &mut pressing.hub_m,
            "taper" => &mut pressing.taper,
            "youngs_pa" => &mut pressing.youngs_pa,
            "follicle_nm_rad" => &mut pressing.follicle_nm_rad,
            _ => {
                let allowed = "length_m, hub_m, taper, youngs_pa, follicle_nm_rad";
                let fault = format!("shaft: found {key:?}, allowed: {allowed}");
                return Err(wrong(fault));
            }
        };
        *slot = Some(value.extract()?);
    }
    Ok(())
}
