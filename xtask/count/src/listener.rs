//! A classifier of one or two channels and what it heard.

use tactile::{Model, Sequential, Threshold};

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

/// A joint model of four classes, with bins and block by default.
pub fn joint_4() -> &'static [u8] {
    model!("joint4")
}

/// A sequential classifier of samples of `C` channels.
#[derive(Debug)]
pub struct Listener<const C: usize>(Sequential);

impl<const C: usize> Listener<C> {
    /// With this model.
    ///
    /// # Panics
    /// If the build script made another.
    pub fn new(model: &'static [u8]) -> Self {
        let model = Model::parse(model).expect("a model");
        assert_eq!(model.channels(), C);
        Self(Sequential::new(model, THRESHOLD).expect("any model has this rule"))
    }

    /// A sample in the air.
    #[inline]
    pub fn pass(&mut self, codes: [i32; C]) -> u32 {
        self.0.pass(&codes).is_ok().into()
    }

    /// The samples that a decision used; 0: none fell.
    #[inline]
    pub fn push(&mut self, codes: [i32; C]) -> u32 {
        let decision = self.0.push(&codes).ok().flatten();
        decision.map_or(0, |decision| decision.samples())
    }
}
