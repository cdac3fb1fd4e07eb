//! Recordings depend on the seed, the data set and the job alone, and pages on
//! the recordings alone: neither on the number of cores.

use super::whole::evaluate;
use super::{Name, Request, jobs, record};
use host_sim::progress::Verbosity;

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
        let make = |request| record(request, &jobs, Verbosity::Quiet).unwrap();
        let one = on_cores(1, || make(&request));
        assert_eq!(one.len(), jobs.len());
        assert!(one.iter().all(|(_, recording)| !recording.is_empty()));
        assert_eq!(one, on_cores(3, || make(&request)), "{name:?}");
        let other = make(&Request::quick(&[name], 4));
        assert!(one.iter().zip(&other).all(|(a, b)| a.1 != b.1), "{name:?}");
    }
}

#[test]
fn the_same_recordings_give_the_same_pages_on_one_core_or_several() {
    let request = Request::quick(&[Name::Pose], 5);
    let recordings = record(&request, &jobs(&request), Verbosity::Quiet).unwrap();
    let page = |cores| {
        let page = on_cores(cores, || evaluate(&request, &recordings).unwrap());
        (page.text, page.files, page.claims)
    };
    assert_eq!(page(1), page(3));
}
