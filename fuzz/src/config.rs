use std::mem::swap;
use std::sync::LazyLock;

use firmware::{
    AngleInput, BoardCode, BusError, ClassifierConfig, CodeClassifier, Config, ConfigError,
    FrameSource, HEADER_BYTES, Hardware, Module, Refusal, VERSION, WhiskerParts, decode, encode,
    take_over,
};
use host_sim::bench::NoClock;
use host_sim::motor::IdealMotor;
use mlx90333::{FRAME_LEN, Faults, SumRule, Word};
use tactile::{ClassSettings, ModelBuf};
use whisking::{Fix, Number};

/// Ticks of a module by a configuration that is taken.
const TICKS: u8 = 40;

const BOARD: BoardCode = BoardCode::Simulation;

/// The reader of configurations in every number format, and the ticks of a module by what it
/// takes; as the bytes are, and with the header that belongs to them. Where another
/// configuration follows that a module may go on by, it does.
///
/// # Panics
/// If a refusal is nameless, or if what is taken is not what is written and read again.
pub fn config(data: &[u8]) {
    of::<f32>(data);
    of::<f64>(data);
    of::<Fix>(data);
}

fn of<R: Number>(data: &[u8]) {
    let _ = taken::<R>(data);
    // Two configurations, if they have as many bytes as they say.
    let length = data.get(8..12).and_then(|bytes| bytes.try_into().ok());
    let length = length.map_or(0, u32::from_le_bytes) as usize;
    let end = length.saturating_add(HEADER_BYTES);
    let (first, second) = data.split_at_checked(end).unwrap_or((data, &[]));
    let Some(mut config) = mended::<R>(first) else {
        return;
    };
    let mut module = module(&config, data);
    let tick = |module: &mut Module<R, Hostile>, config: &Config<R>| {
        for number in 0..TICKS {
            module.arm(number % 16 != 15);
            module.tick(config, &mut |_| {});
        }
    };
    tick(&mut module, &config);
    if let Some(mut next) = mended(second) {
        // Armed, and not armed.
        for is_armed in [true, false] {
            module.arm(is_armed);
            match take_over(&mut module, &config, &next) {
                Ok(()) => swap(&mut config, &mut next),
                Err(refused) => named(refused),
            }
            tick(&mut module, &config);
        }
    }
}

fn named(refused: ConfigError) {
    assert!(!refused.to_string().is_empty());
    let code = firmware::refusal_code(refused);
    assert_eq!(firmware::refusal_of(code), Some(refused));
}

/// What is taken of a configuration as it stands.
fn taken<R: Number>(bytes: &[u8]) -> Option<Config<R>> {
    let config = decode::<R>(bytes, BOARD).map_err(named).ok()?;
    assert_eq!(config.check(), Ok(()));
    let written = encode(&config, BOARD);
    // No number is other than itself.
    let again = written.map(|bytes| decode(&bytes, BOARD));
    assert!(again == Ok(Ok(config.clone())) || again == Err(ConfigError::TooLong));
    Some(config)
}

/// The same with the header that belongs to what follows it.
fn mended<R: Number>(bytes: &[u8]) -> Option<Config<R>> {
    let body = bytes.get(HEADER_BYTES..)?;
    let [low, high] = VERSION.to_le_bytes();
    let first = [low, high, BOARD as u8, R::FORMAT as u8];
    let summed = [&first, &(body.len() as u32).to_le_bytes()[..], body].concat();
    // The same sum as in a model's file.
    let sum = tactile::checksum(&summed).to_le_bytes();
    let (head, body) = summed.split_at(8);
    taken(&[b"WCFG", head, &sum, body].concat())
}

/// Hardware that says whatever the bytes do.
struct Hostile;

impl Hardware for Hostile {
    type Source = Bytes;
    type Motor = IdealMotor;
    type Angle = Bytes;
    type Classifier = CodeClassifier<Box<[u32]>>;
    type Clock = NoClock;
}

fn module<R: Number>(config: &Config<R>, data: &[u8]) -> Module<R, Hostile> {
    let whiskers = config.head.whiskers();
    let parts = (0..whiskers).map(|n| {
        let bytes = |from: usize| Bytes {
            bytes: data.iter().rev().take(256).copied().collect(),
            next: from,
        };
        WhiskerParts {
            source: bytes(8 * n),
            motor: (config.motion.is_some()).then(|| (IdealMotor::new(1.0), bytes(7 * n))),
        }
    });
    let classes = &ClassSettings::of(&config.classes);
    let decides = config.classifier.as_ref().map(|config| {
        let heard = config.deciding.heard(whiskers);
        let refused = || CodeClassifier::refused(Refusal::Absent, heard);
        classifier(config, classes, whiskers).unwrap_or_else(refused)
    });
    Module::new(config, parts, decides, (NoClock, 0))
}

/// By a model, where the rule fits it.
fn classifier<R: Number>(
    config: &ClassifierConfig<R>,
    classes: &ClassSettings,
    whiskers: usize,
) -> Option<CodeClassifier<Box<[u32]>>> {
    static MODEL: LazyLock<Option<ModelBuf>> = LazyLock::new(|| {
        ModelBuf::from_bytes(include_bytes!("../../scenes/models/textures.model")).ok()
    });
    let model = MODEL.clone()?;
    let classifier = tactile::StreamClassifier::new(model, config.rule?, config.deciding, whiskers);
    let mut classifier = classifier.ok()?;
    classifier.set_classes(classes);
    CodeClassifier::new(classifier).ok()
}

/// Frames or counts from bytes that come again and again.
struct Bytes {
    bytes: Vec<u8>,
    next: usize,
}

impl Bytes {
    fn next<const N: usize>(&mut self) -> [u8; N] {
        [(); N].map(|()| {
            self.next = (self.next + 1) % self.bytes.len().max(1);
            self.bytes.get(self.next).copied().unwrap_or_default()
        })
    }
}

impl FrameSource for Bytes {
    fn take(&mut self) -> Result<Option<[u8; FRAME_LEN]>, BusError> {
        // Words of their own in frames that are good, but for one in eight.
        let [first, second, third, fourth, is_bad] = self.next();
        if is_bad % 8 == 0 {
            return Ok(Some(self.next()));
        }
        let [x, y] = [[first, second], [third, fourth]].map(u16::from_le_bytes);
        let [x, y] = [x, y].map(Word::new);
        let frame = mlx90333::encode::alpha_beta(x, y, Faults::NONE, SumRule::SumB1B6);
        Ok(Some(frame))
    }
}

impl AngleInput for Bytes {
    fn counts(&mut self) -> i32 {
        let bytes = self.next();
        // Now and then far away.
        i32::from_le_bytes(bytes) >> if bytes[0].is_multiple_of(8) { 0 } else { 18 }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use ::config::{RunsOn, Target, build};
    use ::scene::Scene;
    use firmware::encode;
    use whisking::Number;

    use super::{BOARD, Fix, taken};

    fn bytes<R: Number>(scene: &str) -> Vec<u8> {
        let scene = Path::new("../scenes").join(scene).with_extension("toml");
        let scene = Scene::load(&scene).unwrap();
        let config = build::<R>(&scene, Target::of(RunsOn::Board)).unwrap();
        encode(&config, BOARD).unwrap().to_vec()
    }

    /// Where the layout has changed they are encoded again, by `WHISKER_RENEW=1`.
    #[test]
    fn every_first_input_is_taken() {
        let first = [
            ("double", bytes::<f64>("full")),
            ("euler", bytes::<f32>("rcp")),
            ("fixed", bytes::<Fix>("both")),
            ("passive", bytes::<f32>("passive")),
            ("single", bytes::<f32>("full")),
            // One that another follows, which a module may go on by.
            ("two", bytes::<f32>("textures").repeat(2)),
        ];
        for (name, now) in first {
            let path = Path::new("corpus/config").join(name);
            if std::env::var_os("WHISKER_RENEW").is_some() {
                std::fs::write(&path, &now).unwrap();
            }
            let bytes = std::fs::read(&path).unwrap();
            let single = taken::<f32>(&bytes).is_some();
            let double = taken::<f64>(&bytes).is_some();
            assert!(single || double || taken::<Fix>(&bytes).is_some(), "{name}");
        }
    }
}
