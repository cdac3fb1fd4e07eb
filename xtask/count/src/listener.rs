//! A classifier of one or two channels and what it heard.

use tactile::{Classes, Model, Sequential, SequentialEvidence, State, Supported, Threshold};

/// Posterior at which a decision falls.
pub const THRESHOLD: Threshold = match Threshold::new(0.99) {
    Ok(threshold) => threshold,
    Err(_) => panic!("0.99 is a threshold"),
};

/// A model of the build script.
macro_rules! model {
    ($name:literal) => {
        tactile::include_model!(concat!(env!("OUT_DIR"), "/", $name, ".model"))
    };
}

/// A model of four classes whose block does not end during a count.
pub fn open_4() -> &'static [u8] {
    model!("open4")
}

/// The same of one channel.
pub fn single_4() -> &'static [u8] {
    model!("single4")
}

/// The same of two channels and nine classes.
pub fn open_9() -> &'static [u8] {
    model!("open9")
}

/// A model of four classes in which every sample ends a block.
pub fn block_4() -> &'static [u8] {
    model!("block4")
}

/// The same of nine classes.
pub fn block_9() -> &'static [u8] {
    model!("block9")
}

/// A classifier of `K` classes by `C` channels and its state.
#[derive(Debug)]
pub struct Listener<const K: usize, const C: usize = 2>
where
    Classes<K>: Supported,
{
    classifier: Sequential<'static, C, K>,
    state: State<SequentialEvidence<K>, K>,
}

impl<const K: usize, const C: usize> Listener<K, C>
where
    Classes<K>: Supported,
{
    /// Listens by a model of `K` classes.
    ///
    /// # Panics
    /// If the build script made another.
    pub fn new(model: &'static [u8]) -> Self {
        let model = Model::parse(model).expect("a model");
        let classifier = Sequential::new(&model, THRESHOLD).expect("C channels, K classes");
        let state = classifier.state();
        Self { classifier, state }
    }

    /// The samples that a decision used; 0: none fell.
    #[inline]
    pub fn push(&mut self, codes: [i32; C]) -> u32 {
        let decision = self.classifier.push(&mut self.state, &codes);
        decision.map_or(0, |decision| decision.samples())
    }
}
