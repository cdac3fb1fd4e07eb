//! In what poses a model can be trusted, for people.

use tactile::ModelBuf;
use tactile::train::joint::{JointModel, PoseReport, Warning};

use super::evaluation::percent;
use crate::evaluation::Evaluation;

fn poses(count: usize) -> String {
    match count {
        0 | 1 => "1 pose".to_owned(),
        count => format!("{count} poses"),
    }
}

/// In how many poses a model was trained, and what it is worth in others: as who trains it knows.
pub(super) fn of_training(model: &JointModel) -> String {
    let mut warnings = model.report.warnings.iter();
    let is_honest = !warnings.any(|warning| matches!(warning, Warning::Overstated { .. }));
    let honest = |poses: String, honest: &str| {
        if is_honest {
            format!("trained in {poses}: {honest}")
        } else {
            format!("trained in {poses}")
        }
    };
    match &model.opinion {
        Some(opinion) if opinion.names => {
            let names = names_between(&poses(opinion.poses));
            // Without one of three there are too few to name by.
            let more = if opinion.poses == 3 {
                "; train with a fourth to see what to expect of another"
            } else {
                ""
            };
            format!("{names}{more}")
        }
        Some(_) if model.poses > 1 => {
            honest(poses(model.poses), "honest in them, silent elsewhere")
        }
        Some(_) => honest(poses(1), "honest in it, silent elsewhere"),
        None if model.poses > 1 => honest(poses(model.poses), "honest there only"),
        None => honest("one pose".to_owned(), "honest there only"),
    }
}

/// The same, as its file says it, and what it is worth if the recording does not contradict it.
pub fn of_model(model: &ModelBuf, evaluation: &Evaluation) -> String {
    let is_honest = evaluation.keeps_what_it_states();
    if !model.has_opinion() {
        let honest = if is_honest { "; honest there only" } else { "" };
        return format!("trained at one pose{honest}");
    }
    match model.poses() {
        _ if !model.names_between_poses() && is_honest => {
            "honest in the poses of its training, silent elsewhere".to_owned()
        }
        _ if !model.names_between_poses() => "of other poses than its training, silent".to_owned(),
        1 => names_between("more than 12 poses"),
        count => names_between(&poses(count)),
    }
}

fn names_between(poses: &str) -> String {
    format!("trained in {poses}: names by itself between them")
}

/// What a second opinion costs and gains on a recording: figures with it, and without.
pub(crate) fn second_opinion(with: &Evaluation, without: &Evaluation) -> String {
    let of = |evaluation: &Evaluation| {
        let [found, undecided] = [evaluation.calibration.found, evaluation.undecided].map(percent);
        let stated = match evaluation.calibration.stated {
            stated if stated.is_nan() => String::new(),
            stated => format!(", stated {:.1} %", 100.0 * stated),
        };
        format!("right {found}{stated}; without a decision {undecided}")
    };
    format!(
        "second opinion     with:    {}\n                   without: {} (`train --expect same`, which \
         may decide less)",
        of(with),
        of(without)
    )
}

/// Share of presentations from which on a class was decided often enough.
const ENOUGH: f64 = 0.9;

/// The pose and class that were decided least often, if that is not often enough.
fn least<'r>(poses: &'r [PoseReport], classes: &[&'r str]) -> Option<(&'r str, &'r str, f64)> {
    let all = poses.iter().flat_map(|pose| {
        let of_class = pose.classes.iter().zip(classes);
        let of_class = of_class.filter(|(decided, _)| decided.count > 0);
        of_class.map(|(decided, class)| (pose.name.as_str(), *class, decided.share))
    });
    let least = all.min_by(|(.., a), (.., b)| a.total_cmp(b));
    least.filter(|(.., share)| *share < ENOUGH)
}

/// What to expect of each pose, and what to record next.
pub(super) fn held_out(poses: &[PoseReport], classes: &[&str]) -> String {
    let width = poses.iter().map(|pose| pose.name.chars().count());
    let width = width.max().unwrap_or(0);
    let each = poses.iter().map(|pose| {
        let [decided, right] = [pose.decided, pose.hits].map(percent);
        format!("{:>width$}: decided {decided}; right {right}\n", pose.name)
    });
    let least = least(poses, classes).map_or_else(String::new, |(pose, class, share)| {
        format!(
            "\nleast decided: {pose}, {class} ({:.0} % of presentations): a recording between it \
             and its neighbours would help {class} most\n",
            100.0 * share
        )
    });
    format!(
        "Each pose when it was held out, as what to expect of another one like it:\n\n{}{least}",
        each.collect::<Vec<_>>().concat()
    )
}
