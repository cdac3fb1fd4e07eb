//! Values put into the text of a scene file, whose comments and order stay.

use host_sim::Error;
use scene::{Override, Scene};
use similar::TextDiff;
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// The text of `file` with these values in it, which is read again as the scene that they come
/// to.
pub(crate) fn edit(file: &str, text: &str, values: &[Override]) -> Result<String, Error> {
    let refused = |problems: scene::Problems| Error::Input(problems.to_string());
    // A refusal names key and value.
    let (wanted, _) = Scene::from_str_with(file, text, values).map_err(refused)?;
    config::check(&wanted).map_err(|fault| Error::Input(format!("{file}: {fault}")))?;
    let wrong = |fault: String| Error::Work(format!("{file}: {fault}; nothing was saved"));
    let document = text.parse::<DocumentMut>();
    let mut document = document.map_err(|fault| wrong(fault.to_string()))?;
    for one in values {
        let value = one
            .value()
            .parse()
            .unwrap_or_else(|_| Value::from(one.value()));
        put(&mut document, one.key(), value).map_err(wrong)?;
    }
    let edited = with_ends_of(text, &document.to_string());
    let found = Scene::from_str(file, &edited).map_err(refused)?;
    let fault = "its text could not be edited as it should be";
    let is_so = (found == wanted).then_some(edited);
    is_so.ok_or_else(|| wrong(fault.to_owned()))
}

/// The edited text with the byte-order mark and the ends of lines that `text` has: of a line that
/// is unchanged its own, of others those of the first line.
fn with_ends_of(text: &str, edited: &str) -> String {
    const MARK: char = '\u{feff}';
    fn lines(text: &str) -> Vec<&str> {
        let lines = text.trim_start_matches(MARK).lines();
        lines.map(|line| line.trim_end_matches('\r')).collect()
    }
    let has_return = text.split_inclusive('\n');
    let has_return: Vec<bool> = has_return.map(|line| line.ends_with("\r\n")).collect();
    let (before, after) = (lines(text), lines(edited));
    let mut ends = vec![has_return.first() == Some(&true); after.len()];
    for change in TextDiff::from_slices(&before, &after).iter_all_changes() {
        let (old, new) = (change.old_index(), change.new_index());
        let old = old.and_then(|old| has_return.get(old));
        let new = new.and_then(|new| ends.get_mut(new));
        if let (Some(old), Some(new)) = (old, new) {
            *new = *old;
        }
    }
    let mut whole = String::from_iter(text.starts_with(MARK).then_some(MARK));
    for (line, has_return) in after.iter().zip(ends) {
        whole.push_str(line);
        whole.push_str(if has_return { "\r\n" } else { "\n" });
    }
    if !edited.ends_with('\n') {
        whole.truncate(whole.trim_end_matches(['\r', '\n']).len());
    }
    whole
}

fn put(document: &mut DocumentMut, path: &str, value: Value) -> Result<(), String> {
    let (section, key) = path.split_once('.').unwrap_or(("", path));
    let table: &mut dyn TableLike = if section.is_empty() {
        document.as_table_mut()
    } else {
        let item = document.entry(section).or_insert_with(toml_edit::table);
        let fault = || format!("{section} is no table");
        item.as_table_like_mut().ok_or_else(fault)?
    };
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(place) => {
            // A remark behind it stays.
            let decor = place.decor().clone();
            *place = value;
            *place.decor_mut() = decor;
        }
        None => {
            table.insert(key, Item::Value(value));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use scene::Override;

    use super::edit;

    const SCENE: &str = "# A scene.\nname = 'a'\ntick_hz = 2000 # Hz\nduration_s = 1\nseed = 1\n\
                         head = { whiskers_per_side = 1, sides = 'left' }\n\
                         plant.kind = 'ideal'\n\n# It whisks.\n[whisking]\nfrequency_hz = 2.0  # slow\n\
                         integrator = 'exact'\ncoupling = false\nnoise = 0.0\ngain = 1.0\n\
                         start = [[1.0, 0.0]]\n";

    fn edited(text: &str, values: &[&str]) -> String {
        let values: Vec<Override> = values.iter().map(|value| value.parse().unwrap()).collect();
        edit("a.toml", text, &values).unwrap()
    }

    #[test]
    fn comments_order_ends_of_lines_and_a_byte_order_mark_stay() {
        let windows = format!("\u{feff}{}", SCENE.replace('\n', "\r\n"));
        let mixed = SCENE.replacen("seed = 1\n", "seed = 1\r\n", 1);
        for text in [windows, mixed] {
            let found = edited(&text, &["whisking.frequency_hz=3.5", "tick_hz=1000"]);
            assert_eq!(found, text.replace("2000", "1000").replace("2.0 ", "3.5 "));
        }
    }

    #[test]
    fn what_is_not_there_is_added_to_its_table() {
        let found = edited(SCENE, &["motor.kp=0.07", "motor.kd=0.001"]);
        assert_eq!(found, format!("{SCENE}\n[motor]\nkp = 0.07\nkd = 0.001\n"));
        let found = edited(SCENE, &["whisking.numbers=fixed"]);
        assert_eq!(found, format!("{SCENE}numbers = \"fixed\"\n"));
        let found = edited(
            SCENE,
            &["plant.obstacle_deg=[100.0]", "plant.stiffness=0.1"],
        );
        let added = "plant.kind = 'ideal'\nplant.obstacle_deg = [100.0]\nplant.stiffness = 0.1\n";
        assert_eq!(found, SCENE.replace("plant.kind = 'ideal'\n", added));
    }
}
