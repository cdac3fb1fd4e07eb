//! What the page `web/page` computes: a scene that is played, and its trace with its hash.
//!
//! The simulation is host-sim without its command line. [`Player`] is what is drawn and heard,
//! [`Tracer`] the same scene from its start to its end, written as `trace.csv`; both say what is
//! wrong with a scene in the words of the command line. `cargo xtask page` makes one file of it.

mod bundle;
mod player;
mod tracer;

pub use bundle::{scene_text, scenes};
pub use player::Player;
pub use tracer::Tracer;

use host_sim::loaded::Loaded;
use host_sim::run::Run;
use scene::{Override, Scene};
use wasm_bindgen::prelude::wasm_bindgen;

/// Checks a scene's text, with the lines `key=value` of `set` in place of its own keys; what is
/// wrong, a line each.
fn loaded(text: &str, set: &str) -> Result<Loaded, String> {
    let set = set.lines().filter_map(|line| {
        let (key, value) = line.split_once('=')?;
        Some(Override::new(key.to_owned(), key, value))
    });
    let set: Vec<Override> = set.collect();
    let read = Loaded::from_text("scene", text, &set, |path| {
        let name = path.to_string_lossy();
        let found = bundle::model(&name).map(<[u8]>::to_vec);
        found.ok_or_else(|| "not on this page".to_owned())
    });
    read.map_err(|error| error.to_string())
}

/// Such a scene, and its run before the first tick.
fn started(text: &str, set: &str) -> Result<(Scene, Run), String> {
    let loaded = loaded(text, set)?;
    let run = loaded.classifier();
    let run = run.and_then(|classifier| Run::new(&loaded.scene, classifier));
    Ok((loaded.scene, run.map_err(|error| error.to_string())?))
}

/// What is wrong with a scene's text and the lines `key=value` of `set`; empty: nothing.
#[wasm_bindgen]
pub fn fault_of(text: &str, set: &str) -> String {
    started(text, set).err().unwrap_or_default()
}

/// Whether a scene's text has no number for the key of a slider.
#[wasm_bindgen]
pub fn lacks(text: &str, key: &str) -> bool {
    let loaded = loaded(text, "");
    loaded.is_ok_and(|loaded| player::setting(&loaded.scene, key).is_none())
}

#[cfg(test)]
mod tests {
    use super::{Tracer, loaded, scene_text, scenes};

    #[test]
    fn every_scene_on_the_page_can_be_played_with_its_model() {
        assert!(scenes().len() > 10);
        for name in scenes() {
            let scene = loaded(&scene_text(&name).unwrap(), "").unwrap();
            scene.classifier().unwrap();
        }
    }

    #[test]
    fn what_is_wrong_is_said_in_the_scene_s_words() {
        let text = &scene_text("whisker").unwrap();
        let fault = loaded(&text.replace("2000", "20"), "").unwrap_err();
        assert!(fault.starts_with("scene:7: tick_hz: found 20; "), "{fault}");
        let fault = loaded(text, "rcp.gain=-1\n").unwrap_err();
        let expected = "rcp.gain: rcp.gain: found -1; ";
        assert!(fault.starts_with(expected), "{fault}");
    }

    #[test]
    fn the_trace_is_the_same_in_parts_and_its_hash_is_of_its_bytes() {
        let text = &scene_text("cia").unwrap();
        let mut whole = Tracer::new(text, "", true).unwrap();
        assert!(whole.step(1_000_000));
        let mut parts = Tracer::new(text, "", false).unwrap();
        while !parts.step(777) {}
        assert_eq!(whole.hash(), parts.hash());
        assert!(parts.bytes().is_empty());
        let head = b"t_s,theta_left_deg,theta_right_deg,";
        assert!(whole.bytes().starts_with(head));
        let mut other = Tracer::new(text, "cia.gain=0.4\n", false).unwrap();
        assert!(other.step(1_000_000));
        assert_ne!(whole.hash(), other.hash());
    }
}
