//! Models that lie apart from the program: which are taken, and why others are not.

use firmware::{CodeClassifier, ModelLimits, ModelState, Refusal};
use tactile::{Aligned, CRC_BYTES, Deciding, ModelBuf, RuleSettings, Threshold, Whisked, checksum};

/// The main job's: two channels of codes, four classes, a gate of 0.05.
const MODEL: &[u8] = include_bytes!("../../../scenes/models/textures.model");

const LIMITS: ModelLimits = ModelLimits {
    classes: 6,
    poses: 1,
    contact_min: None,
    whisked: Whisked {
        frequency_mhz: None,
        has_rcp: None,
    },
    tick_hz: 2000,
};

#[derive(Clone, Copy)]
struct Place(Aligned<[u8; 16_384]>);

impl Place {
    fn with(model: &[u8]) -> Self {
        let mut place = Aligned([0xFF; 16_384]);
        place.0[..model.len()].copy_from_slice(model);
        Self(place)
    }

    fn state(&self, limits: ModelLimits) -> ModelState {
        let sequential = RuleSettings::Sequential(Threshold::new(0.99).unwrap());
        self.classifier(limits, sequential).state()
    }

    fn classifier(&self, limits: ModelLimits, rule: RuleSettings) -> CodeClassifier<&[u32]> {
        CodeClassifier::at_start(&self.0.0, limits, (rule, Deciding::First), 1)
    }

    fn changed(mut self, at: usize, to: u8) -> Self {
        self.0.0[at] = to;
        self
    }

    fn summed(mut self) -> Self {
        let body = MODEL.len() - CRC_BYTES;
        let sum = checksum(&self.0.0[..body]).to_le_bytes();
        self.0.0[body..MODEL.len()].copy_from_slice(&sum);
        self
    }
}

#[test]
fn the_model_at_the_beginning_is_taken() {
    let crc = u32::from_le_bytes(*MODEL.last_chunk().unwrap());
    let runs = ModelState::Runs { crc, classes: 4 };
    let place = Place::with(MODEL);
    assert_eq!(place.state(LIMITS), runs);
    let with = |contact_min| ModelLimits {
        contact_min,
        ..LIMITS
    };
    assert_eq!(place.state(with(Some(0.05))), runs);
    let refused = ModelState::Refused(Refusal::Contact);
    assert_eq!(place.state(with(Some(0.1))), refused);
    let deployed = place.classifier(LIMITS, RuleSettings::Window(40));
    assert_eq!(deployed.gate(), Some(0.05));
}

#[test]
fn whatever_is_wrong_has_its_reason() {
    let refused = |place: Place, limits, why| {
        assert_eq!(place.state(limits), ModelState::Refused(why));
    };
    let right = Place::with(MODEL);
    refused(Place::with(&[]), LIMITS, Refusal::Absent);
    refused(right.changed(0, b'w'), LIMITS, Refusal::Strange);
    refused(right.changed(4, 4), LIMITS, Refusal::Version);
    // 16 KiB and more.
    refused(right.changed(13, 0x40), LIMITS, Refusal::TooLong);
    let damaged = right.changed(5_000, !MODEL[5_000]);
    refused(damaged, LIMITS, Refusal::Damaged);
    // No table of samples; one channel of two.
    refused(right.changed(8, 0).summed(), LIMITS, Refusal::Content);
    refused(right.changed(7, 1).summed(), LIMITS, Refusal::Content);
    let few = ModelLimits {
        classes: 3,
        ..LIMITS
    };
    refused(right, few, Refusal::Classes);
    assert_eq!(Refusal::ALL.len(), 16);
    for (why, code) in Refusal::ALL.iter().zip(1..) {
        assert_eq!(why.code(), code);
        assert_eq!(Refusal::from_code(code), Some(*why));
    }
    assert_eq!(Refusal::from_code(0), None);
}

/// The same model with an opinion that has nothing against any name, of one pose and one stage.
fn objecting(whisked: [u32; 2]) -> Vec<u8> {
    // Of four classes, see `opinion/section.rs` of the crate tactile.
    const WORDS: usize = 685;
    let mut opinion = [0; WORDS];
    opinion[0] = u32::from_le_bytes([0, 1, 1, 1]);
    opinion[6..8].copy_from_slice(&whisked);
    let mut bytes = MODEL[..MODEL.len() - CRC_BYTES].to_vec();
    bytes.extend(opinion.iter().flat_map(|word: &u32| word.to_le_bytes()));
    let length = (bytes.len() + CRC_BYTES) as u32;
    bytes[4] = 3;
    bytes[12..16].copy_from_slice(&length.to_le_bytes());
    bytes[29..31].copy_from_slice(&(WORDS as u16).to_le_bytes());
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

#[test]
fn a_board_has_time_for_so_many_poses() {
    let place = Place::with(&objecting([0, 0]));
    let with = |poses| place.state(ModelLimits { poses, ..LIMITS });
    assert!(matches!(with(1), ModelState::Runs { .. }));
    assert_eq!(with(0), ModelState::Refused(Refusal::Poses));
}

#[test]
fn a_model_is_for_the_tick_rate_of_its_training() {
    let at = |rate_hz| {
        let model = ModelBuf::from_bytes(MODEL).unwrap().at_rate(rate_hz);
        Place::with(model.as_bytes())
    };
    let refused = ModelState::Refused(Refusal::Rate);
    for (trained, is_taken) in [(2000, true), (1000, false), (0, true), (65_536, true)] {
        assert_eq!(at(trained).state(LIMITS) != refused, is_taken, "{trained}");
    }
}

#[test]
fn a_model_is_for_the_whisking_of_its_training() {
    let scene = |mhz, has_rcp| ModelLimits {
        whisked: Whisked {
            frequency_mhz: Some(mhz),
            has_rcp: Some(has_rcp),
        },
        ..LIMITS
    };
    // Of 2 Hz without RCP, and of whisking that is not known.
    for (trained, limits, is_taken) in [
        ([2000, 1], scene(2_090, false), true),
        ([2000, 1], scene(2_110, false), false),
        ([2000, 1], scene(2_000, true), false),
        ([2000, 1], LIMITS, true),
        ([0, 0], scene(9_000, true), true),
    ] {
        let state = Place::with(&objecting(trained)).state(limits);
        let expected = matches!(state, ModelState::Runs { .. });
        assert_eq!(expected, is_taken, "{trained:?} {limits:?}");
        assert!(is_taken || state == ModelState::Refused(Refusal::Whisked));
    }
}

#[test]
fn a_window_must_be_whole_blocks() {
    let place = Place::with(MODEL);
    let state = |window| {
        let rule = RuleSettings::Window(window);
        place.classifier(LIMITS, rule).state()
    };
    assert!(matches!(state(40), ModelState::Runs { .. }));
    assert_eq!(state(41), ModelState::Refused(Refusal::Window));
}
