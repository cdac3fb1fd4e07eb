//! Samples in a simulated world: the scene's textures.

use host_sim::Error;
use scene::{Scene, Texture};

pub(crate) fn texture(sample: &str, scene: &Scene) -> Result<Texture, Error> {
    let Some(textured) = &scene.plant.textured else {
        let fault = "the scene has no textures to lay before the whisker; allowed: plant.kind = \
                     \"textured\" or \"whisker\", with plant.textures, or --world SCENE with such \
                     a scene";
        return Err(Error::Input(fault.to_owned()));
    };
    let mut known = textured.textures.iter();
    let found = known.find(|texture| texture.name() == sample);
    found.copied().ok_or_else(|| {
        let names: Vec<_> = textured.textures.iter().map(|of| of.name()).collect();
        Error::Input(format!(
            "--label: found {sample:?}, which is none of the scene's textures; allowed: {}, or \
             LABEL=TEXTURE with one of them",
            names.join(", ")
        ))
    })
}
