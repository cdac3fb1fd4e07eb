//! Scene texts that several tests start from.

/// A scene with every section but `[motor]`, one obstacle a side.
pub(crate) const FULL: &str = r#"name        = "rcp7"
tick_hz     = 2000          # control and sampling rate
duration_s  = 6.0
seed        = 1             # all randomness comes from it

[head]
whiskers_per_side = 1       # 1..=12

[whisking]
frequency_hz = 2.0
integrator   = "exact"      # or "euler"
coupling     = true
noise        = 0.0
gain         = 1.0
start        = [[1.0, 0.0], [1.0, 0.0]]   # psi of left and right

[rcp]
gain  = 0.7
tau_s = 0.125

[cia]
gain  = 0.5
tau_s = 0.125

[plant]
kind      = "ideal"
obstacle_deg = [100.0, 125.0]   # left, right
stiffness = 0.1

[classifier]
rule      = "sequential"    # or "window"
model     = "models/example.model"
threshold = 0.99
window    = 400
"#;

/// A scene without whisking.
pub(crate) const PASSIVE: &str = "name = 'a'\ntick_hz = 2000\nduration_s = 1\nseed = 0\n\
                                  head.whiskers_per_side = 1\n";

/// [`FULL`] with the left side alone.
pub(crate) fn left() -> String {
    let text = with(FULL, "[whisking]", "sides = 'left'\n[whisking]");
    let text = with(&text, "[[1.0, 0.0], [1.0, 0.0]]", "[[1.0, 0.0]]");
    with(&text, "[100.0, 125.0]", "[100.0]")
}

/// The text with its only occurrence of `old` replaced by `new`.
///
/// # Panics
/// When `old` is not there exactly once, so that no test goes on unchanged.
pub(crate) fn with(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "{old:?} in the text");
    text.replace(old, new)
}

/// What reading `text` as `s.toml` complains of, a line a problem; empty when nothing is wrong.
pub(crate) fn complaint(text: &str) -> String {
    match scene::Scene::from_str("s.toml", text) {
        Ok(_) => String::new(),
        Err(problems) => problems.to_string(),
    }
}
