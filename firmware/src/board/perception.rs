//! What decides, by the model of the scene's slot, and the names of its classes.

use firmware::{CodeClassifier, ModelLimits, ModelState, Part, Refusal};
use tactile::Model;
use whisking::Real;

use super::integrity::Span;
use super::scene::Deployed;
use super::slots::{self, SLOTS};
use super::types::{Inner, Number, Settings};
use crate::here::FACTS;

type Classifier = CodeClassifier<&'static [u32]>;

/// The classifier of a scene that has one, before a model was [found](find) for it; none where the
/// whiskers that decide are those of another board.
pub(crate) fn start(settings: &Settings, node: u8) -> Option<Classifier> {
    let config = settings.classifier.as_ref();
    let config = config.filter(|_| Part::Classifier.is_built())?;
    let heard = config.deciding.heard(settings.head.whiskers());
    let heard = of_node(heard, settings, node);
    if Part::Bus.is_built() && heard == 0 {
        return None;
    }
    Some(CodeClassifier::refused(Refusal::Absent, heard))
}

/// How many of the whiskers that are heard, the first of all, are this board's.
fn of_node(heard: usize, settings: &Settings, node: u8) -> usize {
    if !Part::Bus.is_built() {
        return heard;
    }
    let own = settings.head.of_node(node);
    heard.saturating_sub(own.start).min(own.len())
}

/// Refuses the model, if it is not the one that the scene was deployed with, or nothing for it.
#[inline(never)]
pub(crate) fn find(inner: &mut Inner, settings: &Settings, node: u8, deployed: Option<Deployed>) {
    let (Some(perception), Some(config), Some(deployed)) =
        (inner.perception_mut(), &settings.classifier, deployed)
    else {
        return;
    };
    let (Some(rule), Some(slot)) = (config.rule, SLOTS.get(deployed.slot)) else {
        return;
    };
    let classifier = perception.classifier_mut();
    let heard = config.deciding.heard(settings.head.whiskers());
    let whiskers = if Part::Bus.is_built() {
        of_node(heard, settings, node)
    } else {
        settings.head.whiskers()
    };
    let limits = ModelLimits {
        classes: FACTS.max_classes,
        poses: FACTS.poses_of_each(config.deciding.heard(whiskers)),
        // Compared below, in the number format of the settings.
        contact_min: None,
        whisked: settings.whisked(),
        tick_hz: settings.head.tick_hz,
    };
    let rule = (rule, config.deciding);
    let model = slots::model(slot);
    classifier.find(model, limits, rule, &settings.classes, whiskers);
    let crc = classifier.model().map(Model::crc);
    if crc.is_some_and(|crc| crc != deployed.model) {
        classifier.refuse(Refusal::Other);
    }
    if let (Some(least), Some(gate)) = (config.contact_min, gate(classifier))
        && least != gate
    {
        classifier.refuse(Refusal::Contact);
    }
}

fn gate(classifier: &Classifier) -> Option<Number> {
    let gate = classifier.gate()?;
    Some(Number::from_f32(gate))
}

pub(crate) fn gate_of(inner: &Inner) -> Option<Number> {
    gate(inner.perception()?.classifier())
}

/// Samples count from the contact that the model was trained from, unless the scene says another.
pub(crate) fn adapt(settings: &mut Settings, gate: Option<Number>) {
    if let Some(classifier) = &mut settings.classifier {
        classifier.contact_min = classifier.contact_min.or(gate);
    }
}

pub(crate) fn state(inner: &Inner) -> ModelState {
    let perception = inner.perception();
    perception.map_or(ModelState::NotHere, |found| found.classifier().state())
}

/// What no sample changes: the model, what the classifier has made of it, the factors of its codes.
pub(crate) fn constants(inner: &Inner) -> [Span; 3] {
    let found = inner.perception().and_then(|perception| {
        let classifier = perception.classifier();
        let (constants, factors) = classifier.constants()?;
        let model = classifier.model()?;
        Some([
            Span::of(model.as_bytes()),
            Span::of(constants),
            Span::of(factors),
        ])
    });
    found.unwrap_or([Span::NONE; 3])
}

pub(crate) struct Names(Option<Model<&'static [u32]>>);

impl Names {
    pub(crate) fn of(inner: &Inner) -> Self {
        let perception = inner.perception();
        Self(perception.and_then(|found| found.classifier().model().copied()))
    }

    pub(crate) fn find(&self, class: usize) -> Option<&str> {
        let model = self.0.as_ref().filter(|_| Part::Classifier.is_built());
        model?.name(class)
    }

    pub(crate) fn class(&self, class: usize) -> &str {
        self.find(class).unwrap_or("unknown")
    }
}
