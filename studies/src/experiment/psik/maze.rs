//! The robot in its maze (PSIK section 3.3.2): it follows walls by the distances of its sides,
//! notices corridors by their aperture, tells them by their walls, and turns at their ends as
//! they say.

use core::f64::consts::{PI, TAU};

use anyhow::Result;
use physics::{Plate, Pose};
use rayon::prelude::*;

use crate::chart::{Mark, Series, linear, panel};
use crate::classifiers::network::{Network, largest};
use crate::experiment::{Dataset, Request};
use crate::moments::range;
use crate::page::{Page, bold, figure};
use crate::paper::psik::RATE_HZ;
use crate::rigs::{Chance, Felt, Made, Maze, Pads, Robot, Wall, plane, relief, seed_of};

/// A case's chance of the right turn, percent: two of four say right.
const CHANCE: f64 = 50.0;
/// What counts as turning right, percent (chosen).
const ENOUGH: f64 = 75.0;

#[derive(Debug, Clone, Copy)]
enum Doing {
    Following,
    /// In a corridor, with the votes for each: all, and those of `least_s` and later.
    Inside([[u32; 4]; 2]),
    /// Turns left (1) or right (−1) until it has turned so far, radians.
    Turning(f64, f64),
}

#[derive(Default)]
struct Tour {
    /// Times around the maze in the direction of the start.
    laps: f64,
    /// Corridors that it passed, how often it turned as they say, and how often it would have by
    /// the later votes alone.
    passed: u32,
    right: u32,
    right_later: u32,
    /// What was no corridor, and was taken for one.
    false_alarms: u32,
    /// Where the neck was, twice a second.
    path: Vec<(f64, f64)>,
}

/// The corridor and direction at a place, if there is one: its number in `CORRIDORS`.
fn case_at(request: &Request, robot: &Robot) -> Option<usize> {
    let (maze, corridor) = (&request.rigs.maze, &request.rigs.corridor);
    let [x, y] = robot.neck_m;
    // Its end is noticed late.
    let is_there = x.abs() < corridor.length_m && y.abs() > maze.width_m / 2.0 - corridor.width_m;
    let is_ahead = robot.heading.cos() > 0.0;
    let case = match (y > 0.0, is_ahead) {
        (true, true) => 0,
        (true, false) => 1,
        (false, false) => 2,
        (false, true) => 3,
    };
    is_there.then_some(case)
}

/// Where to turn at the end of a corridor, so as to go on around the maze: 1 is left.
const fn turn_at(case: usize) -> f64 {
    if case.is_multiple_of(2) { -1.0 } else { 1.0 }
}

/// The wall that a vibrissa points at, however far it is: a relief stands out, and touches what is
/// shorter than the way to the plane that it stands on.
fn before(request: &Request, walls: &[Wall], pose: &Pose) -> Option<Plate> {
    let shaft = pose.z();
    let base = [pose.base_m[0], pose.base_m[1]];
    let far_m = request.rigs.maze.length_m + request.rigs.maze.width_m;
    let beyond = [0, 1].map(|k| base[k] + far_m * shaft[k]);
    let crossed = walls.iter();
    let crossed = crossed.filter_map(|wall| Some((wall.crossing(base, beyond)?, wall)));
    let (_, wall) = crossed.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
    Some(plate(request, wall))
}

fn plate(request: &Request, wall: &Wall) -> Plate {
    let [x, y] = wall.normal();
    let [begin_x, begin_y] = wall.from_m;
    let (point_m, along, surface) = match wall.made {
        // Cardboard, as smooth as plastic (chosen).
        Made::Plain => {
            let along = [wall.along[0], wall.along[1], 0.0];
            let smooth = request.rigs.surfaces.of("smooth_plastic");
            ([begin_x, begin_y, 0.0], along, smooth)
        }
        // The piece that was trained on, which begins where a robot that goes around clockwise
        // comes in: at the top towards x, at the bottom against it.
        Made::Relief(number) => {
            let [far, up] = request.spot_m(Dataset::Corridor, number, request.seed);
            let way = if number < 2 { 1.0 } else { -1.0 };
            let begin = -way * request.rigs.corridor.length_m / 2.0;
            let at = [begin + way * far, begin_y, up];
            (at, [way, 0.0, 0.0], relief(request, number))
        }
    };
    plane(point_m, ([x, y, 0.0], along), surface)
}

struct Behaviour<'r> {
    maze: &'r Maze,
    network: &'r Network,
    doing: Doing,
    /// How long the aperture has been other than what the robot is about takes it to be, and how
    /// long it has been in a corridor, s.
    other_s: f64,
    inside_s: f64,
}

impl Behaviour<'_> {
    /// A tick: the corridor that the robot has just left, as it takes it, and as it would by the
    /// later votes alone.
    fn tick(&mut self, felt: &Felt, turned_rad: f64, dt_s: f64) -> Result<Option<[usize; 2]>> {
        let is_narrow = felt.distance_mm.iter().sum::<f64>() < self.maze.aperture_mm;
        let is_inside = matches!(self.doing, Doing::Inside(_));
        let is_other = is_narrow != is_inside;
        self.other_s = if is_other { self.other_s + dt_s } else { 0.0 };
        let is_over = self.other_s >= self.maze.detect_s;
        match &mut self.doing {
            Doing::Following => {
                if is_over {
                    self.doing = Doing::Inside([[0; 4]; 2]);
                    (self.other_s, self.inside_s) = (0.0, 0.0);
                }
            }
            Doing::Turning(side, left_rad) => {
                *left_rad -= turned_rad * *side;
                if *left_rad <= 0.0 {
                    self.doing = Doing::Following;
                    self.other_s = 0.0;
                }
            }
            Doing::Inside([votes, later]) => {
                self.inside_s += dt_s;
                if let Some(window) = &felt.window {
                    let row: Vec<f64> = window.iter().map(|x| f64::from(*x)).collect();
                    let named = self.network.classify(&row)?;
                    votes[named] += 1;
                    later[named] += u32::from(self.inside_s >= self.maze.least_s);
                }
                if is_over {
                    let (case, by_later) = (largest(votes), largest(later));
                    self.other_s = 0.0;
                    if self.inside_s < self.maze.least_s {
                        self.doing = Doing::Following;
                        return Ok(None);
                    }
                    self.doing = Doing::Turning(turn_at(case), self.maze.turn_deg.to_radians());
                    return Ok(Some([case, by_later]));
                }
            }
        }
        Ok(None)
    }
}

/// A tour from the top wall, heading right or left.
fn tour(request: &Request, network: &Network, heads_right: bool) -> Result<Tour> {
    let (maze, rig) = (&request.rigs.maze, &request.rigs.corridor);
    let seed = seed_of(request.seed, &[9, u64::from(heads_right)]);
    let mut chance = Chance::new(seed_of(seed, &[0]));
    let walls = maze.walls(rig);
    let way = if heads_right { 1.0 } else { -1.0 };
    let top = (maze.width_m - rig.width_m) / 2.0;
    let off = rig.start_spread_deg.to_radians();
    let aside = chance.between(-rig.start_spread_m, rig.start_spread_m);
    let back = if heads_right { 0.0 } else { PI };
    let mut robot = Robot {
        neck_m: [-way * maze.start_m, top + aside],
        heading: chance.between(-off, off) + back,
    };
    let mut pads = Pads::new(rig, [1, 2].map(|side| seed_of(seed, &[side])))?;
    let mut behaviour = Behaviour {
        maze,
        network,
        doing: Doing::Following,
        other_s: 0.0,
        inside_s: 0.0,
    };
    let mut tour = Tour::default();
    let dt_s = 1.0 / RATE_HZ;
    let body_m = rig.width_m / 2.0 - rig.slack_m;
    let mut turned_rad = 0.0;
    for tick in 0..(maze.tour_s * RATE_HZ) as usize {
        let felt = pads.step(&robot, |_, pose| before(request, &walls, pose));
        if let Some([decided, by_later]) = behaviour.tick(&felt, turned_rad, dt_s)? {
            match case_at(request, &robot) {
                Some(case) => {
                    tour.passed += 1;
                    tour.right += u32::from(turn_at(case) == turn_at(decided));
                    tour.right_later += u32::from(turn_at(case) == turn_at(by_later));
                }
                None => tour.false_alarms += 1,
            }
        }
        let [left, right] = felt.distance_mm;
        let across = match behaviour.doing {
            Doing::Turning(side, _) => side * rig.most_m_s,
            _ => rig.across_m_s(left, right),
        };
        let before = robot;
        rig.go(&mut robot, across, dt_s);
        robot.neck_m = (walls.iter()).fold(robot.neck_m, |at, wall| wall.kept_off(at, body_m));
        turned_rad = robot.heading - before.heading;
        let bearing = |robot: &Robot| libm::atan2(robot.neck_m[1], robot.neck_m[0]);
        let turn = bearing(&robot) - bearing(&before);
        // Clockwise is a start to the right.
        tour.laps -= way * (turn - TAU * (turn / TAU).round()) / TAU;
        if tick % (RATE_HZ as usize / 2) == 0 {
            tour.path.push(robot.neck_m.into());
        }
    }
    Ok(tour)
}

pub(super) fn section(page: &mut Page, request: &Request, network: &Network) -> Result<()> {
    let starts = [true, false].into_par_iter();
    let tours = starts.map(|right| tour(request, network, right));
    let tours = tours.collect::<Result<Vec<Tour>>>()?;
    let (maze, rig) = (&request.rigs.maze, &request.rigs.corridor);
    page.say(format_args!(
        "**The maze** (`studies/rigs/maze.toml`): {} by {} m, an island in the middle, which leaves \
         a corridor along the wall at the top and at the bottom. The robot follows walls by V_y \
         alone, takes itself to be in a corridor where D_left + D_right is below {} mm, counts the \
         votes of the network of Table 3 there, and turns by {} degrees at its end, to the side \
         that goes on around the maze. Fig. 9, which has the maze's form, gives no measures of it: \
         island and corners are ours. {} s from either start at the top.",
        maze.length_m, maze.width_m, maze.aperture_mm, maze.turn_deg, maze.tour_s
    ));
    let names = ["to the right", "to the left"];
    let rows = names.iter().zip(&tours).map(|(name, tour)| {
        let counts = [tour.passed, tour.right, tour.right_later, tour.false_alarms];
        let counts = counts.map(|count| figure(count.into(), 1));
        bold(*name, [figure(tour.laps, 2)].into_iter().chain(counts))
    });
    page.table(
        "start | tours around | corridors passed | turned as they say | by the later votes | taken for one",
        rows,
    );
    let (a, b) = (maze.length_m / 2.0, maze.width_m / 2.0);
    let walls = maze.walls(rig).into_iter();
    let outline: Vec<(f64, f64)> = walls.map(|wall| wall.from_m.into()).collect();
    let mut panels = Vec::new();
    for (name, tour) in names.iter().zip(&tours) {
        let curves = [
            Series::curve("walls", outline.clone()),
            Series::curve("neck", tour.path.clone()),
        ];
        let (x, y) = (linear("m", -a, a), linear("m", -b, b));
        panels.push(panel(&format!("start {name}"), x, y, &curves, Mark::Dot));
    }
    page.say("**Fig. 10**: the robot's way, twice a second; walls by where their parts begin.");
    page.panels("psik-fig10.svg", "The robot's way in the maze", &panels)?;

    let (least, _) = range(tours.iter().map(|tour| tour.laps));
    page.claim(
        "PSIK: the robot circulates around the maze, from either start (a whole tour or more)",
        "several tours in a row",
        format_args!("at least {} tours in {} s", figure(least, 2), maze.tour_s),
        (least - 1.0, "tours over one"),
    );
    let passed: u32 = tours.iter().map(|tour| tour.passed).sum();
    let share = |right: fn(&Tour) -> u32| {
        let right: u32 = tours.iter().map(right).sum();
        if passed == 0 {
            CHANCE
        } else {
            100.0 * f64::from(right) / f64::from(passed)
        }
    };
    let (whole, later) = (share(|tour| tour.right), share(|tour| tour.right_later));
    page.say(format_args!(
        "Votes of the whole corridor, as in the paper, turn it as the walls say in **{} %**; those \
         from {} s on alone would in **{} %** (looked at after a first run was seen). The robot \
         comes out of a bend; the training begins in front of a corridor.",
        figure(whole, 1),
        maze.least_s,
        figure(later, 1)
    ));
    page.claim(
        format_args!(
            "PSIK: at the ends of corridors the robot turns as their walls say \
                 ({ENOUGH:.0} % or more)"
        ),
        "so",
        format_args!("{} %", figure(whole, 1)),
        (whole - ENOUGH, "points"),
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use physics::Plate;
    use physics::vector::cross;

    use super::{PI, before, plate};
    use crate::experiment::request::{Name, Request};
    use crate::rigs::corridor;
    use crate::rigs::{Corridor, Made, Robot};

    /// Whichever way it goes through a corridor, it meets the pieces of its training, each from
    /// the same end and the same way up.
    #[test]
    fn walls_of_the_maze_are_those_of_the_corridors() {
        let request = Request::quick(&[Name::Psikharpax], 5);
        let half = request.rigs.corridor.length_m / 2.0;
        let walls = request.rigs.maze.walls(&request.rigs.corridor);
        let at = |plate: &Plate, x: f64| plate.along[0] * (x - plate.point_m[0]);
        for (case, side) in (0..4).flat_map(|case| [(case, 0), (case, 1)]) {
            let made = Made::Relief(corridor::walls(case)[side]);
            let wall = walls.iter().find(|wall| wall.made == made).unwrap();
            let met = plate(&request, wall);
            let trained = corridor::plate(&request, side, case, 9);
            for gone_m in [0.0, 0.3, 1.0] {
                let ahead = matches!(case, 0 | 3);
                let x = if ahead { gone_m - half } else { half - gone_m };
                let off = at(&met, x) - at(&trained, gone_m);
                assert!(off.abs() < 1e-12, "{case} {side} {gone_m}: {off}");
            }
            let up = |of: &Plate| (cross(of.normal, of.along)[2], of.point_m[2]);
            assert_eq!(up(&met), up(&trained));
            assert_eq!(met.surface, trained.surface);
        }
    }

    /// In the middle of a corridor vibrissae have the walls of the training before them: those, too,
    /// whose tips are short of the plane that a relief stands on.
    #[test]
    fn in_a_corridor_vibrissae_have_its_walls_before_them() {
        let request = Request::quick(&[Name::Psikharpax], 5);
        let (maze, rig) = (&request.rigs.maze, &request.rigs.corridor);
        let walls = maze.walls(rig);
        let middle_m = (maze.width_m - rig.width_m) / 2.0;
        for (case, side) in (0..4).flat_map(|case| [(case, 0), (case, 1)]) {
            let robot = Robot {
                neck_m: [0.0, if case < 2 { middle_m } else { -middle_m }],
                heading: if matches!(case, 0 | 3) { 0.0 } else { PI },
            };
            let made = Made::Relief(corridor::walls(case)[side]);
            let wall = walls.iter().find(|wall| wall.made == made).unwrap();
            let mut are_short = 0;
            for vibrissa in rig.layout.vibrissae() {
                let pose = Corridor::pose(&robot, side, &vibrissa);
                let tip_m = pose.base_m[1] + vibrissa.length_m * pose.z()[1];
                let short_m = rig.width_m / 2.0 - (tip_m - robot.neck_m[1]).abs();
                if short_m < 0.03 {
                    are_short += u32::from(short_m > 0.0);
                    let met = before(&request, &walls, &pose).unwrap();
                    assert_eq!(met, plate(&request, wall), "{case} {side}: {vibrissa:?}");
                }
            }
            assert!(are_short > 0);
        }
    }
}
