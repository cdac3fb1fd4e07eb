//! How much each table weighs: samples are not independent of one another, nor
//! tables of one another.
//!
//! The weights minimise the mean of −log₂ p(class | stretch) over stretches of blocks, p
//! being proportional to 2^(Σ wₜ Fₜ) with Fₜ the table's sum over the stretch. Each class
//! and each length counts alike. The loss is convex in w: Newton.
//!
//! One recording of a few trials says little of the weights; so their sum is drawn to what
//! textures ask for in the mean ([`Prior`]), the more the more trials differ in what they
//! ask for. Floors refuse the strangest stretches, which would make the rest look less
//! certain than it is: where there are floors, what they refuse is left out ([`Known`]).

use core::f64::consts::LN_2;
use std::vec;
use std::vec::Vec;

use super::floors::Floor;
use super::pieces::Folded;
use super::run::Rule;
use super::tables::Evidence;
use crate::format::ENTRY_OFFSET_BITS;

/// Most that a table may weigh; an entry, w · (log₂ p + 20) · 1024, then fits 16 bits.
pub const MAX_WEIGHT: f64 = 3.0;

const STEPS: usize = 60;

/// Where the sum of the weights lies before anything is known of the data: normal. It says how
/// far samples depend on one another; how tables share it is the data's affair.
#[derive(Clone, Copy)]
pub(super) struct Prior {
    pub(super) mean: f64,
    pub(super) deviation: f64,
}

impl Prior {
    /// Chosen by the scenes `textures` and `whisker` (docs/decisions.md, record 25).
    pub(super) const TEXTURES: Self = Self {
        mean: 1.2,
        deviation: 0.3,
    };
}

#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub(super) rule: &'a Rule,
    pub(super) floors: &'a [Floor],
}

impl Known<'_> {
    /// Whether the leader of a stretch of so many blocks is one that the floors let pass.
    fn passes(&self, stretch: &Stretch, length: usize) -> bool {
        let classes = self.floors.len();
        let weighted = |class: usize| {
            let sums = stretch.sums.iter().skip(class).step_by(classes);
            sums.zip(&self.rule.weights)
                .map(|(sum, weight)| weight * sum)
        };
        let total = |class: &usize| weighted(*class).sum::<f64>();
        let leader = (0..classes).max_by(|a, b| total(a).total_cmp(&total(b)));
        let Some(leader) = leader else {
            return true;
        };
        let mut entries = [0.0; 2];
        let tables = weighted(leader).zip(&self.rule.weights);
        for ((sum, weight), entry) in tables.zip(&mut entries) {
            *entry = sum / length as f64 + weight * f64::from(ENTRY_OFFSET_BITS);
        }
        !self.floors[leader].refuses(entries)
    }
}

struct Stretch {
    class: usize,
    /// What is held out together with it.
    fold: usize,
    /// What it counts for.
    share: f64,
    /// Sums, `[table][class]`.
    sums: Vec<f64>,
}

/// Lengths of stretches, doubled from the shortest to the longest that each class has. What
/// sets recordings apart stays the same within one, and shows only in stretches that are
/// long: where those are held out, the shortest is four blocks instead of one. Where trials
/// are, the longest is 32 blocks, well above what a decision takes: what goes on for longer
/// sets these very trials apart.
pub(super) fn lengths(folded: &Folded<'_>, classes: usize) -> Vec<usize> {
    let of_class = |class| {
        let pieces = folded
            .pieces
            .iter()
            .filter(move |piece| piece.class == class);
        pieces.map(|piece| piece.blocks.len()).max()
    };
    let longest = (0..classes).filter_map(of_class).min().unwrap_or(1);
    let [shortest, most] = if folded.by_recording {
        [4, usize::MAX]
    } else {
        [1, 32]
    };
    let longest = longest.min(most);
    let first = Some(shortest.min(longest));
    let doubled = core::iter::successors(first, |length| Some(2 * length));
    doubled.take_while(|&length| length <= longest).collect()
}

/// The weights of the tables, each from 0 to [`MAX_WEIGHT`].
pub(super) fn fitted(
    evidence: &[Evidence],
    lengths: &[usize],
    prior: Option<Prior>,
    known: Option<Known<'_>>,
) -> Vec<f64> {
    let Some(first) = evidence.first() else {
        return Vec::new();
    };
    let mut problem = Problem {
        tables: first.tables,
        classes: first.classes,
        stretches: stretches(evidence, lengths, first.classes, known),
        expected: 0.0,
        stiffness: 0.0,
    };
    let alone = problem.solved();
    let Some(prior) = prior else {
        return alone;
    };
    // One recording's trials share what differs from one recording to another, which no
    // comparison among them shows: each counts for one observation at most.
    let least = 1.0 / (evidence.len() as f64 * LN_2);
    let spread = problem.spread(&alone).max(least);
    problem.stiffness = spread / (prior.deviation * prior.deviation);
    problem.expected = prior.mean;
    problem.solved()
}

fn stretches(
    evidence: &[Evidence],
    lengths: &[usize],
    classes: usize,
    known: Option<Known<'_>>,
) -> Vec<Stretch> {
    let mut all = Vec::new();
    for &length in lengths {
        let from = all.len();
        for piece in evidence {
            let stretches = sums(piece, length).map(|sums| Stretch {
                class: piece.class,
                fold: piece.fold,
                share: 0.0,
                sums,
            });
            all.extend(stretches.filter(|stretch| {
                known
                    .as_ref()
                    .is_none_or(|known| known.passes(stretch, length))
            }));
        }
        let mut counts = vec![0_u32; classes];
        for stretch in &all[from..] {
            counts[stretch.class] += 1;
        }
        for stretch in &mut all[from..] {
            stretch.share = 1.0 / f64::from(counts[stretch.class]);
        }
    }
    let total: f64 = all.iter().map(|stretch| stretch.share).sum();
    for stretch in &mut all {
        stretch.share /= total;
    }
    all
}

/// The sums of runs of `length` blocks of a piece, `[table][class]`: of all, or where they
/// are longer than eight blocks of those that begin an eighth of their length apart.
pub(super) fn sums(piece: &Evidence, length: usize) -> impl Iterator<Item = Vec<f64>> {
    let width = piece.tables * piece.classes;
    // Of all blocks before each.
    let mut total = vec![0.0; width];
    let mut before = total.clone();
    for block in piece.blocks() {
        for (total, mean) in total.iter_mut().zip(block) {
            *total += mean;
        }
        before.extend(&total);
    }
    let blocks = piece.blocks().count();
    let firsts = (0..(blocks + 1).saturating_sub(length)).step_by(length.div_ceil(8));
    firsts.map(move |first| {
        let [from, to] = [first, first + length].map(|at| &before[at * width..][..width]);
        to.iter().zip(from).map(|(to, from)| to - from).collect()
    })
}

struct Problem {
    tables: usize,
    classes: usize,
    stretches: Vec<Stretch>,
    /// Sum of the weights that the prior expects, and by how much the loss grows with the
    /// square of the distance from it, bits.
    expected: f64,
    stiffness: f64,
}

struct Local {
    loss: f64,
    gradient: Vec<f64>,
    curvature: Vec<Vec<f64>>,
}

impl Problem {
    fn solved(&self) -> Vec<f64> {
        let mut weights = vec![0.5; self.tables];
        let mut here = self.local(&weights);
        for _ in 0..STEPS {
            // Weights at an end of their range from which the loss falls outwards stay.
            let held: Vec<bool> = weights
                .iter()
                .zip(&here.gradient)
                .map(|(&w, &g)| (w <= 0.0 && g > 0.0) || (w >= MAX_WEIGHT && g < 0.0))
                .collect();
            let step = newton(&here, &held);
            let Some((next, there)) = self.better(&weights, &step, here.loss) else {
                break;
            };
            let gained = here.loss - there.loss;
            (weights, here) = (next, there);
            if gained < 1e-12 {
                break;
            }
        }
        weights
    }

    /// The first point along a step, halved until it is, with a smaller loss.
    fn better(&self, from: &[f64], step: &[f64], loss: f64) -> Option<(Vec<f64>, Local)> {
        let mut scale = 1.0;
        for _ in 0..40 {
            let point = from.iter().zip(step);
            let point: Vec<f64> = point
                .map(|(w, s)| (w + scale * s).clamp(0.0, MAX_WEIGHT))
                .collect();
            let there = self.local(&point);
            if there.loss < loss {
                return Some((point, there));
            }
            scale /= 2.0;
        }
        None
    }

    /// 1/(n ln 2), n the number of independent observations that the data are worth. Were
    /// the loss the mean over n of them, in natural units, the squares of their gradients
    /// would sum up to its curvature over n (the information equality). What is of one
    /// class and held out together is one of those that are added.
    fn spread(&self, weights: &[f64]) -> f64 {
        let curvature = self.of(weights, self.stretches.iter()).curvature;
        let trace: f64 = (0..self.tables).map(|t| curvature[t][t]).sum();
        if trace <= 0.0 {
            // Nothing is said of the weights.
            return 1.0;
        }
        let last = self.stretches.iter().map(|stretch| stretch.fold).max();
        let observations = (0..=last.unwrap_or(0))
            .flat_map(|fold| (0..self.classes).map(move |class| (fold, class)));
        let squares = observations.map(|observation| {
            let own = |stretch: &&Stretch| (stretch.fold, stretch.class) == observation;
            let gradient = self.of(weights, self.stretches.iter().filter(own)).gradient;
            gradient.iter().map(|g| g * g).sum::<f64>()
        });
        squares.sum::<f64>() / trace
    }

    /// With the prior.
    fn local(&self, weights: &[f64]) -> Local {
        let mut local = self.of(weights, self.stretches.iter());
        let off = weights.iter().sum::<f64>() - self.expected;
        local.loss += 0.5 * self.stiffness * off * off;
        for (gradient, row) in local.gradient.iter_mut().zip(&mut local.curvature) {
            *gradient += self.stiffness * off;
            for entry in row {
                *entry += self.stiffness;
            }
        }
        local
    }

    /// Of some of the stretches.
    fn of<'s>(&self, weights: &[f64], stretches: impl Iterator<Item = &'s Stretch>) -> Local {
        let mut local = Local {
            loss: 0.0,
            gradient: vec![0.0; self.tables],
            curvature: vec![vec![0.0; self.tables]; self.tables],
        };
        let mut p = vec![0.0; self.classes];
        let mut means = vec![0.0; self.tables];
        for stretch in stretches {
            let table = |t: usize| &stretch.sums[t * self.classes..][..self.classes];
            p.fill(0.0);
            for (t, w) in weights.iter().enumerate() {
                for (z, sum) in p.iter_mut().zip(table(t)) {
                    *z += w * sum;
                }
            }
            let own = p[stretch.class];
            let highest = p.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            for z in &mut p {
                *z = (*z - highest).exp2();
            }
            let total: f64 = p.iter().sum();
            local.loss += stretch.share * (total.log2() + highest - own);
            for z in &mut p {
                *z /= total;
            }
            for (t, mean) in means.iter_mut().enumerate() {
                *mean = p.iter().zip(table(t)).map(|(p, sum)| p * sum).sum();
                local.gradient[t] += stretch.share * (*mean - table(t)[stretch.class]);
            }
            for t in 0..self.tables {
                for u in 0..=t {
                    let products = table(t).iter().zip(table(u)).zip(&p);
                    let product: f64 = products.map(|((a, b), p)| a * b * p).sum();
                    local.curvature[t][u] += stretch.share * LN_2 * (product - means[t] * means[u]);
                }
            }
        }
        for t in 0..self.tables {
            for u in 0..t {
                local.curvature[u][t] = local.curvature[t][u];
            }
        }
        local
    }
}

/// The step to where the local quadratic is least, with some weights held. A
/// trace of a ridge makes tables that say the same share their weight.
fn newton(local: &Local, held: &[bool]) -> Vec<f64> {
    let free: Vec<usize> = (0..held.len()).filter(|&t| !held[t]).collect();
    let trace: f64 = free.iter().map(|&t| local.curvature[t][t]).sum();
    let ridge = 1e-9 * trace + 1e-300;
    // Rows of the system, the right side last.
    let mut rows: Vec<Vec<f64>> = free
        .iter()
        .map(|&t| {
            let entries = free.iter();
            let mut row: Vec<f64> = entries
                .map(|&u| local.curvature[t][u] + if t == u { ridge } else { 0.0 })
                .collect();
            row.push(-local.gradient[t]);
            row
        })
        .collect();
    // Positive definite: no pivoting is needed.
    let n = rows.len();
    for pivot in 0..n {
        let top = rows[pivot].clone();
        for row in rows.iter_mut().skip(pivot + 1) {
            let factor = row[pivot] / top[pivot];
            for (x, t) in row.iter_mut().zip(&top) {
                *x -= factor * t;
            }
        }
    }
    let mut step = vec![0.0; held.len()];
    for at in (0..n).rev() {
        let known: f64 = (at + 1..n).map(|u| rows[at][u] * step[free[u]]).sum();
        step[free[at]] = (rows[at][n] - known) / rows[at][at];
    }
    step
}
