//! What classifiers keep in memory and in flash, as their documentation says.

use classifiers::features::FeaturesState;
use classifiers::polynomial::Term;
use classifiers::spectral_template::SpectralState;
use classifiers::spectrum::{Bank, BankState};
use classifiers::template::TemplateState;

#[test]
fn states_and_tables_have_their_sizes() {
    assert_eq!(size_of::<TemplateState<9>>(), 8 * 9 + 8);
    assert_eq!(size_of::<BankState<120>>(), 8 * 120 + 4);
    assert_eq!(size_of::<SpectralState<2, 48>>(), 2 * (8 * 48 + 4));
    assert_eq!(size_of::<FeaturesState<332>>(), 8 * 332 + 20);
    assert_eq!(size_of::<Term<3>>(), 8);
    // Where a pointer has four bytes: on a PC the two counts are wider.
    assert!(size_of::<Bank<120>>() <= 4 * 120 + 16);
}
