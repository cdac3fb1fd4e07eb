//! The project's scenes and models, which are part of the page.

use wasm_bindgen::prelude::wasm_bindgen;

/// Name and content of files of a folder.
macro_rules! files {
    ($include:ident, $folder:literal, $extension:literal: $($name:literal),* $(,)?) => {
        [$(($name, $include!(concat!("../../", $folder, $name, $extension)).as_slice())),*]
    };
}

const SCENES: &[(&str, &[u8])] = &files!(include_bytes, "scenes/", ".toml":
    "whisker",
    "textures",
    "both",
    "cia",
    "rcp",
    "rcp-left",
    "free",
    "active",
    "full",
    "papers",
    "biphasic",
    "bench",
    "bench-textures",
    "bringup",
    "tmag5170",
    "unknown",
    "passive",
);

const MODELS: &[(&str, &[u8])] = &files!(include_bytes, "scenes/models/", ".model":
    "whisker",
    "textures",
    "active",
    "full",
    "bench-textures",
    "both",
    "papers",
    "tmag5170",
    "unknown",
);

fn of(files: &'static [(&str, &[u8])], name: &str) -> Option<&'static [u8]> {
    let found = files.iter().find(|(other, _)| *other == name);
    found.map(|(_, content)| *content)
}

/// The names of the scenes that are on the page; that which is shown first comes first.
#[wasm_bindgen]
pub fn scenes() -> Vec<String> {
    SCENES.iter().map(|(name, _)| (*name).to_owned()).collect()
}

/// The text of one of them; none of another name.
#[wasm_bindgen]
pub fn scene_text(name: &str) -> Option<String> {
    let bytes = of(SCENES, name)?;
    Some(std::str::from_utf8(bytes).ok()?.to_owned())
}

/// The bytes of the model that a scene calls so, such as `models/textures.model`.
pub(crate) fn model(path: &str) -> Option<&'static [u8]> {
    let name = path.strip_prefix("models/")?.strip_suffix(".model")?;
    of(MODELS, name)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    fn count(folder: &str, extension: &str) -> usize {
        let here = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let files = std::fs::read_dir(here).unwrap();
        let paths = files.map(|file| file.unwrap().path());
        paths
            .filter(|path| path.extension().is_some_and(|e| e == extension))
            .count()
    }

    #[test]
    fn all_scenes_and_models_of_the_project_are_on_the_page() {
        assert_eq!(super::SCENES.len(), count("../scenes", "toml"));
        assert_eq!(super::MODELS.len(), count("../scenes/models", "model"));
    }
}
