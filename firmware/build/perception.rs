//! The scene's classifier as Rust source: with the model that is linked, or with the one that
//! will lie apart from the program.

use databake::{CrateEnv, TokenStream, quote};
use scene::{ClassifierSection, Deciding, Rule, Scene};
use tactile::ModelBuf;
use whisking::{Real, Source};

use crate::part::{Part, nothing};

/// The classifier and its model.
pub(crate) fn perception<R: Real>(
    scene: &Scene,
    model: Option<&ModelBuf>,
    contact_min: Option<f64>,
) -> Part {
    let Some(classifier) = &scene.classifier else {
        return absent();
    };
    let (rule, rule_type, rule_value) = rule(classifier.rule);
    let contact_min = contact_min.map(R::from_f64);
    let contact_min = match model {
        Some(_) => Source::optional(
            contact_min.as_ref(),
            &quote! { Number },
            &CrateEnv::default(),
        ),
        // The model's, unless the scene has one.
        None => at_run_time(contact_min),
    };
    let (contact_min_type, contact_min) = (contact_min.of_type, contact_min.value);
    let items = match model {
        Some(model) => linked(scene, classifier, &rule, model),
        None => deployed(scene, classifier, &rule),
    };
    let config = Source {
        of_type: quote! { firmware::ClassifyingConfig<#contact_min_type, #rule_type> },
        value: quote! {
            firmware::ClassifyingConfig {
                contact_min: #contact_min,
                rule: #rule_value,
            }
        },
    };
    Part { items, config }
}

/// No perception.
fn absent() -> Part {
    let items = vec![
        quote! { pub(crate) const DECIDES: bool = false; },
        quote! { pub(crate) const AWAITS_MODEL: bool = false; },
        quote! { pub(crate) const HEARS_SEVERAL: bool = false; },
        quote! { pub(crate) type Perception = (); },
        quote! { pub(crate) struct Names; },
        quote! {
            pub(crate) fn names(_: &Perception) -> Names {
                Names
            }
        },
        quote! {
            pub(crate) fn class_name(_: &Names, _: usize) -> Option<&str> {
                None
            }
        },
        quote! {
            pub(crate) fn constants(_: &Perception) -> [super::integrity::Span; 3] {
                [super::integrity::Span::of(&()); 3]
            }
        },
        quote! {
            pub(crate) fn model(_: &Perception) -> firmware::ModelState {
                firmware::ModelState::NotHere
            }
        },
        quote! {
            pub(crate) fn start_perception() -> Option<Perception> {
                Some(())
            }
        },
        not_adapted(),
    ];
    let config = nothing();
    Part { items, config }
}

/// Of a program that has its model linked in.
fn linked(
    scene: &Scene,
    classifier: &ClassifierSection,
    rule: &TokenStream,
    model: &ModelBuf,
) -> Vec<TokenStream> {
    let names = model.names();
    // A model that knows no touches needs no code for them.
    let (words, into_words) = match model.view().into_single() {
        Some(_) => (quote! { tactile::Single }, quote! { .into_single()? }),
        None => (quote! { &'static [u32] }, quote! {}),
    };
    let (mut items, [sides, each]) = common(scene, classifier, rule, &words);
    items.extend([
        quote! { pub(crate) const AWAITS_MODEL: bool = false; },
        quote! { const CLASS_NAMES: &[&str] = &[#(#names),*]; },
        quote! { pub(crate) struct Names; },
        quote! {
            pub(crate) fn names(_: &Perception) -> Names {
                Names
            }
        },
        quote! {
            pub(crate) fn class_name(_: &Names, class: usize) -> Option<&str> {
                CLASS_NAMES.get(class).copied()
            }
        },
        quote! {
            pub(crate) type Perception =
                firmware::Classifying<firmware::CodeClassifier<Bayes>, #sides, #each>;
        },
        quote! {
            fn model_bytes() -> &'static [u8] {
                tactile::include_model!(concat!(env!("OUT_DIR"), "/touch.model"))
            }
        },
        quote! {
            pub(crate) fn constants(perception: &Perception) -> [super::integrity::Span; 3] {
                let (classifier, factors) = perception.classifier().constants();
                [
                    super::integrity::Span::of(model_bytes()),
                    super::integrity::Span::of(classifier),
                    super::integrity::Span::of(factors),
                ]
            }
        },
        quote! {
            pub(crate) fn model(perception: &Perception) -> firmware::ModelState {
                firmware::ModelState::of(tactile::Streams::model(perception.classifier().bayes()))
            }
        },
        quote! {
            pub(crate) fn start_perception() -> Option<Perception> {
                let model = tactile::Model::linked(model_bytes()).ok()? #into_words;
                let bayes = Bayes::new(model, SETTINGS.perception.rule).ok()?;
                let classifier = firmware::CodeClassifier::new(bayes).ok()?;
                Some(firmware::Classifying::new(classifier))
            }
        },
        not_adapted(),
    ]);
    items
}

/// Of a program whose model lies apart from it.
fn deployed(scene: &Scene, classifier: &ClassifierSection, rule: &TokenStream) -> Vec<TokenStream> {
    let (mut items, [sides, each]) = common(scene, classifier, rule, &quote! { &'static [u32] });
    let contact_min = if let Some(least) = classifier.contact_min {
        let least = least as f32;
        quote! { Some(#least) }
    } else {
        quote! { None }
    };
    items.extend([
        quote! { pub(crate) const AWAITS_MODEL: bool = true; },
        quote! { pub(crate) type Names = Option<tactile::Model>; },
        quote! {
            pub(crate) fn names(perception: &Perception) -> Names {
                perception.classifier().model().copied()
            }
        },
        quote! {
            pub(crate) fn class_name(names: &Names, class: usize) -> Option<&str> {
                names.as_ref()?.name(class)
            }
        },
        quote! {
            pub(crate) type Perception =
                firmware::Classifying<firmware::Deployed<Bayes>, #sides, #each>;
        },
        quote! {
            pub(crate) fn constants(perception: &Perception) -> [super::integrity::Span; 3] {
                let deployed = perception.classifier();
                match (deployed.model(), deployed.classifier()) {
                    (Some(model), Some(classifier)) => {
                        let (classifier, factors) = classifier.constants();
                        [
                            super::integrity::Span::of(model.as_bytes()),
                            super::integrity::Span::of(classifier),
                            super::integrity::Span::of(factors),
                        ]
                    }
                    // It stays as it is: without a model nothing is classified.
                    _ => [
                        super::integrity::Span::of(deployed),
                        super::integrity::Span::of(&()),
                        super::integrity::Span::of(&()),
                    ],
                }
            }
        },
        quote! {
            pub(crate) fn model(perception: &Perception) -> firmware::ModelState {
                perception.classifier().state()
            }
        },
        quote! {
            pub(crate) fn start_perception() -> Option<Perception> {
                let limits = firmware::ModelLimits {
                    classes: crate::here::MAX_CLASSES,
                    contact_min: #contact_min,
                };
                let rule = SETTINGS.perception.rule;
                let deployed = firmware::Deployed::new(super::model_place::model_place(), limits, |model| {
                    Bayes::new(model, rule)
                });
                Some(firmware::Classifying::new(deployed))
            }
        },
        quote! {
            pub(crate) fn adapt(settings: &mut Settings, perception: &Perception) {
                let least = &mut settings.perception.contact_min;
                if let (None, Some(gate)) = (&least, perception.classifier().gate()) {
                    *least = Some(<Number as whisking::Real>::from_f64(f64::from(gate)));
                }
            }
        },
    ]);
    items
}

/// What both have, and how many whiskers are heard: of so many sides so many each.
fn common(
    scene: &Scene,
    classifier: &ClassifierSection,
    rule: &TokenStream,
    words: &TokenStream,
) -> (Vec<TokenStream>, [usize; 2]) {
    let (sides, each) = match classifier.whiskers {
        Deciding::First => (1, 1),
        Deciding::Each | Deciding::Together => {
            (scene.head.sides.count(), scene.head.whiskers_per_side)
        }
    };
    let heard = sides * each;
    let bayes = match classifier.whiskers {
        Deciding::First => quote! { tactile::NaiveBayes<#rule, #words> },
        Deciding::Each => quote! { tactile::Each<#rule, #words, #heard> },
        Deciding::Together => quote! { tactile::Together<#words, #heard> },
    };
    let hears_several = heard > 1;
    let items = vec![
        quote! { pub(crate) const DECIDES: bool = true; },
        quote! { pub(crate) const HEARS_SEVERAL: bool = #hears_several; },
        quote! { type Bayes = #bayes; },
    ];
    (items, [sides, each])
}

/// The rule, the type of its settings and these.
fn rule(of: Rule) -> (TokenStream, TokenStream, TokenStream) {
    let (rule, settings, value) = match of {
        Rule::Sequential { threshold } => (
            quote! { SequentialRule },
            quote! { tactile::Threshold },
            quote! {
                match tactile::Threshold::new(#threshold) {
                    Ok(threshold) => threshold,
                    Err(_) => panic!("the build script has checked it"),
                }
            },
        ),
        Rule::Window { samples } => (quote! { WindowRule }, quote! { u32 }, quote! { #samples }),
    };
    (quote! { tactile::#rule }, settings, value)
}

/// A part that is there or not when the program starts.
fn at_run_time<R: Real>(part: Option<R>) -> Source {
    let env = CrateEnv::default();
    let value = if let Some(part) = part {
        let part = part.bake(&env);
        quote! { Some(#part) }
    } else {
        quote! { None }
    };
    Source {
        of_type: quote! { Option<Number> },
        value,
    }
}

/// Settings that no model changes.
fn not_adapted() -> TokenStream {
    quote! {
        pub(crate) fn adapt(_: &mut Settings, _: &Perception) {}
    }
}
