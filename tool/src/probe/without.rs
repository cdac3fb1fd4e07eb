//! What there is without probe-rs.

use std::path::Path;

use host_sim::Error;
use host_sim::progress::Verbosity;

use super::SeenProbe;
use crate::source::{BoardName, Laying, Source};

const WITHOUT: &str = "this whisker was built without probes; the build that has them: cargo run -p \
                       whisker --features probe -- …";

fn without<T>() -> Result<T, Error> {
    Err(Error::Input(WITHOUT.to_owned()))
}

pub(crate) fn open(
    _: &str,
    _: BoardName,
    _: Option<&Path>,
    _: Laying,
) -> Result<Box<dyn Source>, Error> {
    without()
}

pub(crate) fn flash(_: &str, _: BoardName, _: &Path, _: bool, _: Verbosity) -> Result<(), Error> {
    without()
}

pub(crate) fn is_there(_: &str) -> Result<(), Error> {
    without()
}

pub(crate) fn seen(_: BoardName) -> Result<Vec<SeenProbe>, String> {
    Err(WITHOUT.to_owned())
}
