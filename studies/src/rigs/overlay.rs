//! Keys in the place of others.

use toml::{Table, Value};

pub(super) type Fault = (String, String);

/// Puts what `top` has in the place of what `base` has; both name the same things.
pub(super) fn overlay(base: &mut Table, top: Table) -> Result<(), Fault> {
    for (key, value) in top {
        let Some(place) = base.get_mut(&key) else {
            let known: Vec<&str> = base.keys().map(String::as_str).collect();
            let fault = format!("unknown key, allowed: {}", known.join(", "));
            return Err((key, fault));
        };
        match (place, value) {
            (Value::Table(inner), Value::Table(value)) => overlay(inner, value)?,
            (place, value) => {
                *place = alike(place, value).map_err(|fault| (key, fault))?;
            }
        }
    }
    Ok(())
}

/// The value, as the kind of `place`: a whole number will do for any.
fn alike(place: &Value, value: Value) -> Result<Value, String> {
    match (place, value) {
        (Value::Float(_), Value::Integer(whole)) => Ok(Value::Float(whole as f64)),
        (Value::Array(old), Value::Array(new)) if old.len() == new.len() => {
            let values = old.iter().zip(new);
            let values: Result<Vec<Value>, String> =
                values.map(|(old, new)| alike(old, new)).collect();
            values.map(Value::Array)
        }
        (place, value) if place.same_type(&value) && !place.is_array() => Ok(value),
        (place, value) => Err(format!("found {value}, allowed what is like {place}")),
    }
}
