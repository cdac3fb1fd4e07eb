//! BIOTACT: six whisking whiskers before three textures at three distances,
//! unmodulated and with two strengths of RCP; naive Bayes and the template by
//! sum of squares after one to eight training whisks.

mod movement;
mod patterns;
mod whisks;

use anyhow::Result;
use rayon::prelude::*;

use super::{Dataset, Recordings, Request, ranges};
use crate::chart::{Mark, Series, linear, panel, percent};
use crate::page::{Page, bold, figure};
use crate::paper::biotact::{
    DISTANCES_MM, FIG10_RCP7_SEVEN, FIG11_TEXTURE, MOST_TRAINING, SAID, STRATEGIES, TEXTURES,
};
use crate::rigs::{CHANNELS, Chance, seed_of};
use whisks::{Method, Task, Visits};

/// Random choices of training whisks that a hit rate is the mean of.
const DRAWS: usize = 10;

/// What counts as all, percent, and as about equal, points (both chosen).
const NEARLY_ALL: f64 = 99.0;
const NEARLY: f64 = 10.0;

/// Hit rates, percent, of 1, 2, … training whisks.
type HitCurve = Vec<f64>;

/// Hit rates by method, task and strategy, the last the fastest.
struct Hits(Vec<HitCurve>);

impl Hits {
    fn measure(request: &Request, visits: &Visits, most: usize) -> Result<Self> {
        let whisks = request.extent.whisks;
        let mut cases = Vec::new();
        for method in Method::ALL {
            for task in Task::ALL {
                for strategy in 0..STRATEGIES.len() {
                    cases.extend((1..=most).map(|count| (method, task, strategy, count)));
                }
            }
        }
        let rate = |(method, task, strategy, count)| -> Result<f64> {
            let mut sum = 0.0;
            for draw in 0..DRAWS {
                // The same whisks for every method, task and strategy.
                let mut chance = Chance::new(seed_of(request.seed, &[10, draw as u64]));
                let order = chance.order(whisks);
                sum += visits.hit_rate(method, task, strategy, order.split_at(count))?;
            }
            Ok(100.0 * sum / DRAWS as f64)
        };
        let rates: Vec<f64> = cases.into_par_iter().map(rate).collect::<Result<_>>()?;
        let curves = rates.chunks_exact(most).map(<[f64]>::to_vec);
        Ok(Self(curves.collect()))
    }

    /// Percent after `count` training whisks; the most that there are if fewer.
    fn at(&self, method: Method, task: Task, strategy: usize, count: usize) -> f64 {
        let curve = self.curve(method, task, strategy);
        curve[count.clamp(1, curve.len()) - 1]
    }

    fn curve(&self, method: Method, task: Task, strategy: usize) -> &[f64] {
        let group = method as usize * Task::ALL.len() + task as usize;
        &self.0[group * STRATEGIES.len() + strategy]
    }
}

pub(super) fn evaluate(page: &mut Page, request: &Request, recordings: &Recordings) -> Result<()> {
    let visits = Visits::new(request, recordings);
    let most = MOST_TRAINING.min(request.extent.whisks.saturating_sub(2));
    let hits = Hits::measure(request, &visits, most)?;
    page.heading(2, "BIOTACT: active whisking");
    page.say(format_args!(
        "Six whiskers of 80, 112 and 158 mm (`studies/rigs/head.toml`), moved by the module's pattern \
         generator in closed loop with what they feel, each by a motor under the module's \
         position control, before {} textures at {} distances, {} \
         whisks each. Friction leaves motors a dead band of {:.2} degrees. A hit rate is the mean over {DRAWS} random choices of training whisks; all \
         other whisks validate. The generator steps by its exact integrator, where the paper has \
         forward Euler: free whisking peaks at 121.9 degrees in place of 122.9. The paper's curves are drawn without numbers; its text says: {}.",
        TEXTURES.len(),
        DISTANCES_MM.len(),
        request.extent.whisks,
        request.rigs.head.motor.dead_band_deg(),
        SAID.join("; ")
    ));
    if request.is_whole {
        page.is_alone = true;
        patterns::gains(page)?;
        patterns::obstacles(page)?;
        patterns::whole_head(page, request)?;
        page.is_alone = false;
    }
    for (method, figure) in Method::ALL.into_iter().zip(["10", "11"]) {
        figure_10(page, &hits, (method, figure), most)?;
    }
    claims(page, &hits, most);
    whisks::of_one_whisker(page, &visits, request.rigs.head.tick_hz, most)?;
    let of = (request, recordings);
    ranges::say(page, of, (Dataset::Head, CHANNELS), 8191.0);
    if request.is_whole {
        page.is_alone = true;
        movement::section(page, request, recordings);
        movement::histories(page, request, recordings)?;
        page.is_alone = false;
    }
    Ok(())
}

/// Fig. 10 or 11, by method.
fn figure_10(
    page: &mut Page,
    hits: &Hits,
    (method, number): (Method, &str),
    most: usize,
) -> Result<()> {
    let (what, in_scores) = method.names();
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for task in Task::ALL {
        let mut curves = Vec::new();
        for (strategy, (name, _)) in STRATEGIES.iter().enumerate() {
            let curve = hits.curve(method, task, strategy);
            let points = curve.iter().enumerate();
            let points = points.map(|(n, hit)| ((n + 1) as f64, *hit));
            curves.push(Series::curve(name, points.collect()));
            let shown = curve.iter().map(|hit| figure(*hit, 0));
            rows.push(bold(format!("{} | {name}", task.text()), shown));
        }
        let x = linear("training whisks", 0.0, most as f64 + 1.0);
        panels.push(panel(task.text(), x, percent("%"), &curves, Mark::Dot));
        let on = format!("{}, RCP7, {most} whisks", task.text());
        let hit = hits.at(method, task, 1, most);
        page.score(in_scores, on, hit, task.chance());
    }
    page.say(format_args!("**Fig. {number}**: {what}, hit rate in %."));
    let name = format!("biotact-fig{number}.svg");
    page.panels(&name, &format!("Hit rate of {what}"), &panels)?;
    let counts: Vec<String> = (1..=most).map(|n| n.to_string()).collect();
    page.table(&format!("task | whisking | {}", counts.join(" | ")), rows);
    Ok(())
}

fn claims(page: &mut Page, hits: &Hits, most: usize) {
    let by_strategy = |method, task, count| [0, 1, 2].map(|n| hits.at(method, task, n, count));
    let said = |rates: [f64; 3]| {
        let [plain, rcp7, rcp9] = rates.map(|rate| figure(rate, 1));
        format!("unmodulated {plain}, RCP7 {rcp7}, RCP9 {rcp9} %")
    };
    for method in Method::ALL {
        let (how, _) = method.names();
        for count in [1, 2] {
            let rates @ [plain, rcp7, rcp9] = by_strategy(method, Task::Both, count);
            page.claim(
                format_args!(
                    "BIOTACT: after {count} training whisk(s) RCP7 is best and unmodulated \
                     whisking worst (texture and distance, {how})"
                ),
                "so",
                said(rates),
                ((rcp7 - rcp9).min(rcp9 - plain), "points"),
            )
            .rests_on_both(rcp7, Task::Both.chance());
        }
    }
    let whisks = 7.min(most);
    let seven = hits.at(Method::Bayes, Task::Both, 1, whisks);
    page.claim(
        format_args!(
            "BIOTACT: naive Bayes with RCP7 reaches {NEARLY_ALL} % after {whisks} training whisks"
        ),
        format_args!("{FIG10_RCP7_SEVEN:.0} %"),
        format_args!("{} %", figure(seven, 1)),
        (seven - NEARLY_ALL, "points"),
    )
    .rests_on_both(seven, Task::Both.chance());
    let [joint, texture, distance] = Task::ALL.map(|task| hits.at(Method::Bayes, task, 0, most));
    let product = texture * distance / 100.0;
    let template = hits.at(Method::Template, Task::Texture, 0, most);
    let [of_joint, of_texture, of_distance, of_product, of_template] =
        [joint, texture, distance, product, template].map(|rate| figure(rate, 1));
    page.claim(
        format_args!(
            "BIOTACT: the joint hit rate is within {NEARLY} points of the product of texture's and \
             distance's (naive Bayes, unmodulated)"
        ),
        "about equal",
        format_args!("{of_joint} against {of_texture} x {of_distance} = {of_product} %"),
        (NEARLY - (joint - product).abs(), "points"),
    )
    .rests_on_both(joint, Task::Both.chance());
    page.claim(
        "BIOTACT: on texture alone naive Bayes beats the template (unmodulated)",
        format_args!("about 100 against {FIG11_TEXTURE:.0} %"),
        format_args!("{of_texture} against {of_template} %"),
        (texture - template, "points"),
    )
    .rests_on_both(texture, Task::Texture.chance());
    let rates @ [plain, rcp7, rcp9] = by_strategy(Method::Template, Task::Distance, most);
    page.claim(
        format_args!(
            "BIOTACT: with the template, RCP is worse than unmodulated whisking on distance \
             ({most} training whisks)"
        ),
        "so, after more than three",
        said(rates),
        (plain - rcp7.max(rcp9), "points"),
    )
    .rests_on_both(plain, Task::Distance.chance());
}
