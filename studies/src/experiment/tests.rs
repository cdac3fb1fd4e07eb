//! Recordings depend on the seed, the data set and the job alone: neither on
//! the number of cores nor on how the jobs were shared out.

use super::part::bytes;
use super::{Job, Name, Request, Shard, jobs, join, record, report, share, write_part};
use host_sim::progress::Verbosity;
use std::path::PathBuf;

/// The first jobs of every data set.
fn some(request: &Request, count: usize) -> Vec<Job> {
    let mut jobs = jobs(request);
    jobs.retain(|job| job.number < count);
    jobs
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_one_core_or_several() {
    for name in [Name::Lep12, Name::Biotact, Name::Pose] {
        let request = Request::quick(&[name], 3);
        let jobs = some(&request, 3);
        let make = |cores| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(cores);
            let pool = pool.build().unwrap();
            pool.install(|| record(&request, &jobs, Verbosity::Quiet).unwrap())
        };
        let one = make(1);
        assert_eq!(one.len(), jobs.len());
        assert!(one.iter().all(|(_, recording)| !recording.is_empty()));
        assert_eq!(bytes(&request, &one), bytes(&request, &make(3)), "{name}");
        let mut other = request.clone();
        other.seed = 4;
        let other = record(&other, &jobs, Verbosity::Quiet).unwrap();
        assert!(
            one.iter().zip(other.iter()).all(|(a, b)| a.1 != b.1),
            "{name}"
        );
    }
}

/// Shards, written and joined in another order, give the pages of a run in one
/// go, byte for byte; a part that is damaged, doubled, missing or of another
/// request is refused.
#[test]
fn shards_join_to_the_same_bytes_and_bad_ones_are_refused() {
    let request = Request::quick(&[Name::Pose], 5);
    let whole = record(&request, &jobs(&request), Verbosity::Quiet).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut paths: Vec<PathBuf> = Vec::new();
    for index in (1..=3).rev() {
        let shard = Shard { index, count: 3 };
        let jobs = share(&request, shard);
        let part = record(&request, &jobs, Verbosity::Quiet).unwrap();
        let path = folder.path().join(format!("{index}.part"));
        write_part(&path, &request, &part).unwrap();
        paths.push(path);
    }
    let joined = join(&paths, &request).unwrap();
    assert_eq!(joined, whole);
    assert_eq!(
        report(&request, &joined).unwrap(),
        report(&request, &whole).unwrap()
    );

    let fault = |paths: &[PathBuf], request: &Request| {
        let error = join(paths, request).unwrap_err();
        assert_eq!(error.exit_status(), 2);
        error.to_string()
    };
    assert!(fault(&paths[..2], &request).contains("in no part"));
    let doubled = [&paths[..], &paths[..1]].concat();
    assert!(fault(&doubled, &request).contains("there twice"));
    let mut other = request.clone();
    other.seed = 6;
    assert!(fault(&paths, &other).contains("another request"));
    let mut damaged = std::fs::read(&paths[0]).unwrap();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    std::fs::write(&paths[0], damaged).unwrap();
    assert!(fault(&paths, &request).contains("checksum"));
}
