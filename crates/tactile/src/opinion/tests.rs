use super::section::MEANS;
use super::*;
use crate::decision::Posterior;

/// A section of two classes that has means, of which nothing else is known.
fn head() -> [u32; 1] {
    [u32::from_le_bytes([MEANS | 2, 1, 8, 9])]
}

/// By hand: all of the first part, half of the second, a quarter of each that follows.
#[test]
fn scores_of_parts_are_averaged_and_a_touch_begins_for_itself() {
    let head = head();
    let section = Section::new(&head, 2);
    let mut opinion = Opinion::new();
    for _ in 0..2 {
        opinion.begin();
        for (score, mean) in [(8192, 8192), (4096, 6144), (2048, 5120), (-3072, 3072)] {
            opinion.scores[0] = score;
            opinion.begin_again(section, 2);
            assert_eq!(opinion.means[..2], [[mean, 0], [0, 0]]);
            // Two thirds of its patience, and two parts.
            opinion.blocks = 6;
            assert_eq!(opinion.is_early(section), opinion.parts < 2);
        }
    }
}

/// A lead of two bits is odds of 1 to 4, of √2 times as many 1 to 7, and of twice as many 1 to 16.
#[test]
fn near_parts_weigh_by_the_root_of_their_number() {
    let mut opinion = Opinion::new();
    opinion.scores[..2].copy_from_slice(&[0, 4096]);
    opinion.means[..2].copy_from_slice(&[[2048, 0], [0, 0]]);
    let [of_two, of_more] = WEIGHTS;
    let cases = [
        (Nearness::Between, 4.0),
        (Nearness::Near(of_two), 2.0_f64.powf(2.0 * 2.0_f64.sqrt())),
        (Nearness::Near(of_more), 16.0),
    ];
    for (nearness, odds) in cases {
        let most = |share: f64| (share * f64::from(1 << 26) / odds) as u32;
        assert_eq!(opinion.rival((most(0.95), nearness), 2, 0), Some(1));
        assert_eq!(opinion.rival((most(1.05), nearness), 2, 0), None);
    }
    // Without means the scores of the open part count, by which the other leads.
    let rival = opinion.rival((1 << 26, Nearness::Unknown), 2, 0);
    assert_eq!(rival, None, "odds of 1 to 1 at most are counted");
    let rival = opinion.rival((1 << 25, Nearness::Unknown), 2, 0);
    assert_eq!(rival, Some(1));
}

#[test]
fn what_names_none_is_said_as_the_first_second_or_third_in_a_row() {
    use Reason::{Between, Pose, Unknown};
    let said = |row: &[Option<Reason>]| {
        let mut judge = Judge::new();
        let decision = Decision::new(1, 9, Posterior::from_odds_against(0, 0));
        let row = row.iter().map(|reason| decision.in_touch(1, *reason));
        row.map(|decision| judge.say(decision).is_some())
            .collect::<Vec<_>>()
    };
    let [pose, unknown, between] = [Pose, Unknown, Between(0)].map(Some);
    assert_eq!(said(&[pose, None, pose, pose]), [true; 4]);
    assert_eq!(said(&[unknown, unknown, unknown]), [false, true, false]);
    assert_eq!(said(&[between, between, between]), [false, false, true]);
    assert_eq!(said(&[between, None, unknown]), [false, true, false]);
    assert_eq!(said(&[between, unknown, between]), [false, true, false]);
}
