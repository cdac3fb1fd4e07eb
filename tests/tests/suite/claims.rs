//! Every row of the claims table by the product: firmware tick, sensor words
//! on the bus and all.

use crate::common;
use crate::reference::claims::{Figure, Quantity, RUN_S, TABLE};

#[test]
fn every_claim_holds() {
    for claim in &TABLE {
        let settings = claim.figure.settings();
        let rows = common::trace(&settings, "euler", RUN_S);
        let value = claim.quantity.measure(&settings, &rows);
        let value = value.unwrap_or_else(|| panic!("{claim:?}: whisks differ"));
        assert!(claim.is_near(value, claim.value), "{value} for {claim:?}");
    }
}

/// With the exact integrator the claims' words still hold, though the figures
/// are those of an oscillator that sits on its circle.
#[test]
fn the_claims_in_words_hold_with_the_exact_integrator() {
    let run = |figure: Figure| {
        let settings = figure.settings();
        let rows = common::trace(&settings, "exact", RUN_S);
        move |quantity: Quantity| quantity.measure(&settings, &rows).unwrap()
    };
    let tops = [0.5, 1.0, 1.5, 2.0].map(|g| run(Figure::Fig6(g))(Quantity::MaxTheta(0)));
    // Higher g, higher θ', never unity.
    assert!(tops.is_sorted() && tops[3] < 150.0, "{tops:?}");
    let (fig7, fig8, fig9) = (run(Figure::Fig7), run(Figure::Fig8), run(Figure::Fig9));
    // The left is suppressed, the right is not.
    let [left, right] = [0, 1].map(|side| fig7(Quantity::MaxTheta(side)));
    assert!(left < tops[1] - 10.0, "{left}");
    assert!((right - tops[1]).abs() < 1e-3, "{right}");
    assert_eq!(fig8(Quantity::PeaksPerWhisk(0)), 2.0);
    assert_eq!(fig8(Quantity::ContactsPerWhisk(0)), 2.0);
    // The right finds its obstacle.
    assert_eq!(fig9(Quantity::ContactsPerWhisk(1)), 1.0);
}
