//! A sample towards the features of a contact, and the polynomial of three of
//! them; the last sample of a block takes the features.
#![cfg_attr(target_os = "none", no_std, no_main)]

use classifiers::features::{Feature, FeatureRule, Features, FeaturesState};
use classifiers::polynomial::{Polynomial, Term};
use classifiers::spectrum::Bank;
use count::samples::{number, spread};

/// 6 Hz to 1 kHz in steps of 3 Hz.
const BINS: usize = 332;

static FEATURES: Features<BINS> = Features {
    rest: 0.0,
    onset: 0.1,
    rate_hz: 4000.0,
    bank: Bank::from_parts(
        {
            let mut factors = [0.0; BINS];
            let mut i = 0;
            while i < BINS {
                factors[i] = -1e-5 * ((i + 1) * (i + 1)) as f32;
                i += 1;
            }
            factors
        },
        BINS,
        // Of the thousand calls one takes the features.
        800,
    ),
    first_hz: 6.0,
    step_hz: 3.0,
};

/// All products of three features up to the second degree.
static TERMS: [Term<3>; 10] = {
    let powers = [
        [0, 0, 0],
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
        [2, 0, 0],
        [1, 1, 0],
        [1, 0, 1],
        [0, 2, 0],
        [0, 1, 1],
        [0, 0, 2],
    ];
    let mut terms = [Term {
        powers: [0; 3],
        coefficient: 0.1,
    }; 10];
    let mut i = 0;
    while i < terms.len() {
        terms[i].powers = powers[i];
        i += 1;
    }
    terms
};

static RULE: FeatureRule<'_, 3> = FeatureRule {
    chosen: [
        Feature::Centroid,
        Feature::CentroidMagnitude,
        Feature::TotalMagnitude,
    ],
    polynomial: Polynomial {
        centre: [100.0, 1.0, 10.0],
        scale: [0.01, 1.0, 0.1],
        terms: &TERMS,
    },
    classes: 4,
};

count::program!(
    ("f32": "features push B=332",
        (x: f32, state: &mut FeaturesState<BINS>) -> f32 {
            FEATURES.push(state, x).map_or(0.0, |[_, _, f3, _, _]| f3)
        },
        number::<f32>(-1.0, 1.0), FEATURES.state()),
    ("f32": "polynomial F=3 degree 2",
        (x: f32, features: &mut [f32; 5]) -> u32 {
            features[2] = x;
            RULE.estimate(features).class as u32
        },
        |call| spread(call, 6.0, 1000.0) as f32, [1.0_f32; 5]),
);
