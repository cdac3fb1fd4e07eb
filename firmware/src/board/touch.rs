//! What the module decides, as the scene names it: its type, its constants,
//! and the names of the classes.

#[cfg(perception = "none")]
mod perception {
    /// No perception.
    pub(crate) type Perception = ();

    /// Its constants.
    pub(crate) const CONFIG: () = ();
}

#[cfg(not(perception = "none"))]
mod perception {
    use firmware::{Stream, Touch, TouchConfig};
    use tactile::Model;

    use crate::board::scene;

    #[cfg(perception = "sequential")]
    type Rule = tactile::SequentialRule;
    #[cfg(perception = "window")]
    type Rule = tactile::WindowRule;

    /// One whisker and a classifier that reads its model in flash.
    pub(crate) type Perception = Touch<Stream<'static, Rule, { scene::CLASSES }>>;

    /// Its constants.
    pub(crate) const CONFIG: TouchConfig<f32> = TouchConfig {
        contact_min: scene::CONTACT_MIN,
    };

    /// The classifier before its first sample, and its model; `None` if the
    /// flash is damaged: the build has checked everything else.
    pub(crate) fn listen() -> Option<(Perception, Model<'static>)> {
        let model = Model::parse(scene::model()).ok()?;
        let stream = Stream::new(&model, classifier(&model)?).ok()?;
        Some((Touch::new(stream), model))
    }

    #[cfg(perception = "sequential")]
    fn classifier(
        model: &Model<'static>,
    ) -> Option<tactile::Sequential<'static, 2, { scene::CLASSES }>> {
        tactile::Sequential::new(model, scene::THRESHOLD).ok()
    }

    #[cfg(perception = "window")]
    fn classifier(
        model: &Model<'static>,
    ) -> Option<tactile::Window<'static, 2, { scene::CLASSES }>> {
        tactile::Window::new(model, scene::WINDOW).ok()
    }
}

#[cfg(not(perception = "none"))]
pub(crate) use perception::listen;
pub(crate) use perception::{CONFIG, Perception};
