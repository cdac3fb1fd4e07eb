//! Recordings depend on the seed, the data set and the job alone, and pages on
//! the recordings alone: neither on the number of cores.

use super::recording::{Dataset, Record, jobs, record};
use super::request::{Arm, Name, Request};
use super::runs::evaluate;
use crate::rigs::RobotMotion;
use crate::rigs::whiskers::TABLE;
use crate::rigs::{corridor, floor, head, pad, table};

fn on_cores<T: Send>(cores: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(cores).build();
    pool.unwrap().install(work)
}

#[test]
fn the_same_seed_gives_the_same_recordings_on_one_core_or_several() {
    for name in [Name::Lep12, Name::Biotact, Name::Pose] {
        let request = Request::quick(&[name], 3);
        let mut jobs = jobs(&request);
        jobs.retain(|job| job.number < 3);
        let make = |request| record(request, &jobs).unwrap();
        let one = on_cores(1, || make(&request));
        assert_eq!(one.len(), jobs.len());
        assert!(one.iter().all(|(_, recording)| recording.len() > 0));
        assert_eq!(one, on_cores(3, || make(&request)), "{name:?}");
        let other = make(&Request::quick(&[name], 4));
        assert!(one.iter().zip(&other).all(|(a, b)| a.1 != b.1), "{name:?}");
    }
}

#[test]
fn the_same_recordings_give_the_same_pages_on_one_core_or_several() {
    let request = Request::quick(&[Name::Pose], 5);
    let recordings = record(&request, &jobs(&request)).unwrap();
    let page = |cores| {
        let page = on_cores(cores, || evaluate(&request, &recordings).unwrap());
        (page.text, page.files, page.claims)
    };
    assert_eq!(page(1), page(3));
}

/// Of two jobs that differ in their classes alone, from one seed: recordings differ, and in a
/// placebo they are the same to the last bit, so that nothing is left that tells classes apart.
#[test]
fn in_a_placebo_a_label_is_all_that_differs() {
    let request = Request::quick(Name::ALL, 1);
    let placebo = Request {
        arm: Arm::LABELS,
        ..request.clone()
    };
    let extent = request.extent;
    let trials = floor::trials(extent);
    let of_floor = |of| (of, RobotMotion::Clockwise, 0);
    let spot = |of| trials.iter().position(|trial| *trial == of_floor(of));
    let spot = |of| spot(of).unwrap();
    let sweeps = pad::jobs(extent) / pad::PAPERS;
    let runs = corridor::jobs(extent) / 4;
    let all: [(Record, [usize; 2]); 7] = [
        (floor::record, [spot(0), spot(3)]),
        // Another texture, and another distance.
        (head::record, [head::number(1, 0, 0), head::number(1, 2, 0)]),
        (head::record, [head::number(1, 0, 0), head::number(1, 0, 2)]),
        // Another texture, and another angle and speed.
        (table::record, [0, 3]),
        (table::record, [0, table::jobs(extent) / 2 - 4]),
        (pad::record, [0, 7 * sweeps]),
        // The way back.
        (corridor::record, [0, runs]),
    ];
    for (n, (record, jobs)) in all.into_iter().enumerate() {
        let [true_one, true_other] = jobs.map(|job| record(&request, job, 9).unwrap());
        assert_ne!(true_one, true_other, "{n}");
        let [one, other] = jobs.map(|job| record(&placebo, job, 9).unwrap());
        assert_eq!(one, other, "{n}");
    }
}

/// As in the paper two recordings of a class differ by noise and the arm alone; drawn again they
/// do not; spots of one texture differ, and keep what else there is.
#[test]
fn a_class_keeps_its_spot_as_in_the_paper_and_none_where_things_are_drawn_again() {
    let of = |arm: Arm| Request {
        arm,
        ..Request::quick(&[Name::Pose], 1)
    };
    let spot = |arm: Arm, label, recording| of(arm).spot_m(Dataset::Table, label, recording);
    assert_eq!(spot(Arm::MAIN, 2, 7), spot(Arm::MAIN, 2, 8));
    assert_ne!(spot(Arm::MAIN, 2, 7), spot(Arm::MAIN, 3, 7));
    assert_ne!(spot(Arm::AGAIN, 2, 7), spot(Arm::AGAIN, 2, 8));
    assert_eq!(spot(Arm::LABELS, 2, 7), spot(Arm::LABELS, 3, 7));
    assert_ne!(spot(Arm::SPOTS, 2, 7), spot(Arm::SPOTS, 3, 7));
    let spots = of(Arm::SPOTS);
    let first = spots.surface(&TABLE, 0, 0);
    assert_eq!(
        [2, 3].map(|texture| spots.surface(&TABLE, texture, 0)),
        [first; 2]
    );
    assert_eq!([2, 3].map(|angle| spots.place(angle, 4)), [2, 3]);
}
