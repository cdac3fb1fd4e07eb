//! BIOTACT: six whisking whiskers before three textures at three distances,
//! unmodulated and with two strengths of RCP; naive Bayes and the template by
//! sum of squares after one to eight training whisks.

mod figures;
mod histories;
mod movement;
mod patterns;
mod whisks;
mod why;

use rayon::prelude::*;

use super::picture::{Curve, panel, percent};
use super::recording::Recordings;
use super::request::Request;
use crate::chart::{Mark, linear};
use crate::page::{Page, row};
use crate::paper::biotact::{
    DISTANCES_MM, FIG10_RCP7_SEVEN, FIG11_TEXTURE, MOST_TRAINING, SAID, STRATEGIES, TEXTURES,
};
use crate::rigs::{Chance, seed_of};
use host_sim::Error;
use whisks::{Method, Task, Visits};

/// Random choices of training whisks that a hit rate is the mean of.
const DRAWS: usize = 10;

/// Hit rates, percent, of 1, 2, … training whisks.
type HitCurve = Vec<f64>;

/// Hit rates by method, task and strategy, the last the fastest.
struct Hits(Vec<HitCurve>);

impl Hits {
    fn measure(request: &Request, visits: &Visits, most: usize) -> Result<Self, Error> {
        let whisks = request.extent.whisks();
        let mut cases = Vec::new();
        for method in Method::ALL {
            for task in Task::ALL {
                for strategy in 0..STRATEGIES.len() {
                    cases.extend((1..=most).map(|count| (method, task, strategy, count)));
                }
            }
        }
        let rates: Result<Vec<f64>, Error> = cases
            .into_par_iter()
            .map(|(method, task, strategy, count)| {
                let mut sum = 0.0;
                for draw in 0..DRAWS {
                    // The same whisks for every method, task and strategy.
                    let mut chance = Chance::new(seed_of(request.seed, &[10, draw as u64]));
                    let order = chance.order(whisks);
                    sum += visits.hit_rate(method, task, strategy, order.split_at(count))?;
                }
                Ok(100.0 * sum / DRAWS as f64)
            })
            .collect();
        let rates = rates?;
        let curves = rates.chunks_exact(most).map(<[f64]>::to_vec);
        Ok(Self(curves.collect()))
    }

    /// Percent after `count` training whisks; the most that there are if fewer.
    fn at(&self, method: Method, task: Task, strategy: usize, count: usize) -> f64 {
        let curve = self.curve(method, task, strategy);
        let place = count.clamp(1, curve.len().max(1)) - 1;
        curve.get(place).copied().unwrap_or(0.0)
    }

    fn curve(&self, method: Method, task: Task, strategy: usize) -> &[f64] {
        let group = method as usize * Task::ALL.len() + task as usize;
        let found = self.0.get(group * STRATEGIES.len() + strategy);
        found.map_or(&[], Vec::as_slice)
    }
}

/// Evaluates the recordings.
pub(super) fn evaluate(
    page: &mut Page,
    request: &Request,
    recordings: &Recordings,
) -> Result<(), Error> {
    let visits = Visits::new(request, recordings);
    let most = MOST_TRAINING.min(request.extent.whisks().saturating_sub(2));
    let hits = Hits::measure(request, &visits, most)?;
    page.heading(2, "BIOTACT: active whisking");
    page.say(format_args!(
        "Six whiskers of 80, 112 and 158 mm (`studies/rigs/head.toml`), moved by the module's pattern \
         generator in closed loop with what they feel, each by a motor under the module's \
         position control, before {} textures at {} distances, {} \
         whisks each. A hit rate is the mean over {DRAWS} random choices of training whisks; all \
         other whisks validate. The paper's curves are drawn without numbers; its text says: {}.",
        TEXTURES.len(),
        DISTANCES_MM.len(),
        request.extent.whisks(),
        SAID.join("; ")
    ));
    patterns::section(page)?;
    for (method, figure) in Method::ALL.into_iter().zip(["10", "11"]) {
        let mut panels = Vec::new();
        for task in Task::ALL {
            let curves: Vec<Curve> = STRATEGIES
                .iter()
                .enumerate()
                .map(|(strategy, (name, _))| {
                    let points = hits.curve(method, task, strategy).iter().enumerate();
                    let points = points.map(|(n, hit)| ((n + 1) as f64, *hit));
                    Curve::new(name, points.collect())
                })
                .collect();
            let x = linear("training whisks", 0.0, most as f64 + 1.0);
            panels.push(panel(task.text(), x, percent("%"), &curves, Mark::Dot));
        }
        page.say(format_args!(
            "**Fig. {figure}**: {}, hit rate in %.",
            method.text()
        ));
        let name = format!("biotact-fig{figure}.svg");
        let what = format!("Hit rate of {}", method.text());
        page.panels(&name, &what, &panels)?;
        table(page, &hits, method, most);
        for task in Task::ALL {
            let name = method.score_name();
            let what = format!("{}, RCP7, {most} whisks", task.text());
            page.score(name, what, hits.at(method, task, 1, most));
        }
    }
    let why = why::section(page, request, recordings, most)?;
    claims(page, &hits, most, &why.hits);
    movement::section(page, request, recordings, &why.biphasic);
    histories::section(page, request, recordings)?;
    Ok(())
}

fn table(page: &mut Page, hits: &Hits, method: Method, most: usize) {
    let counts: Vec<String> = (1..=most).map(|n| n.to_string()).collect();
    let mut rows = Vec::new();
    for task in Task::ALL {
        for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
            let cells = hits.curve(method, task, strategy).iter();
            let cells = cells.map(|hit| format!("**{hit:.0}**"));
            rows.push(row(format!("{} | {name}", task.text()), cells));
        }
    }
    let header = format!("task | whisking | {}", counts.join(" | "));
    page.table(&header, rows);
}

fn claims(page: &mut Page, hits: &Hits, most: usize, why: &str) {
    let bayes = |strategy, count| hits.at(Method::Bayes, Task::Both, strategy, count);
    for count in [1, 2] {
        page.claim(
            format_args!(
                "BIOTACT: after {count} training whisk(s) RCP7 beats unmodulated (naive \
            Bayes, both)"
            ),
            "RCP7 the highest",
            format_args!(
                "unmodulated {:.1}, RCP7 {:.1}, RCP9 {:.1} %",
                bayes(0, count),
                bayes(1, count),
                bayes(2, count)
            ),
            bayes(1, count) > bayes(0, count),
            why,
        );
    }
    let seven = bayes(1, 7.min(most));
    page.claim(
        format_args!(
            "BIOTACT: naive Bayes with RCP7 reaches 100 % after {} training whisks",
            7.min(most)
        ),
        format_args!("{FIG10_RCP7_SEVEN:.0} %"),
        format_args!("{seven:.1} %"),
        seven > 99.0,
        why,
    );
    let joint = bayes(0, most);
    let texture = hits.at(Method::Bayes, Task::Texture, 0, most);
    let distance = hits.at(Method::Bayes, Task::Distance, 0, most);
    let product = texture * distance / 100.0;
    page.claim(
        "BIOTACT: the joint hit rate is about the product of texture's and distance's (naive \
        Bayes, unmodulated)",
        "about equal",
        format_args!("{joint:.1} against {texture:.1} x {distance:.1} = {product:.1} %"),
        (joint - product).abs() < 10.0,
        why,
    );
    let template = hits.at(Method::Template, Task::Texture, 0, most);
    page.claim(
        "BIOTACT: on texture alone naive Bayes beats the template (unmodulated)",
        format_args!("about 100 against {FIG11_TEXTURE:.0} %"),
        format_args!("{texture:.1} against {template:.1} %"),
        texture > template,
        why,
    );
}
