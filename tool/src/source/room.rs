//! What a model has to fit before it is written.

use std::path::Path;

use host_sim::Error;
use host_sim::loaded::Loaded;
use tactile::ModelBuf;

/// What a board has for a model.
#[derive(Debug, Clone, Copy)]
pub(super) struct ModelRoom {
    /// Of flash.
    pub(super) bytes: usize,
    /// Most classes.
    pub(super) classes: usize,
}

impl ModelRoom {
    /// Whether the model in `path` fits into it.
    pub(super) fn takes(self, board: &str, path: &Path, model: &ModelBuf) -> Result<(), Error> {
        let (bytes, classes) = (model.as_bytes().len(), model.classes());
        if classes > self.classes {
            let most = self.classes;
            let fault = format!("found {classes} classes, allowed on the {board}: 2 to {most}");
            return Err(Error::file(path, fault));
        }
        if bytes > self.bytes {
            let most = self.bytes;
            let fault = format!("found {bytes} bytes, allowed on the {board}: at most {most}");
            return Err(Error::file(path, fault));
        }
        Ok(())
    }
}

/// Whether the model in `path` fits the scene of a module.
pub(super) fn fits(loaded: &Loaded, path: &Path, model: &ModelBuf) -> Result<(), Error> {
    loaded.takes_model()?;
    let with = loaded.clone().with_deployed(path, Some(model.clone()));
    with.classifier().map(drop)
}
