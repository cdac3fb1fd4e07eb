//! What of a whisker can be printed, as STL in mm: the mount and the shaft, from the table of
//! docs/build.md, whose letters are those of docs/mount.svg.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::run::{Fault, read, target, top, write};

/// Corners of what is round. A bore of 8 mm is 4 µm narrower at their sides.
const CORNERS: u32 = 96;

type Point = [f64; 3];

pub(crate) fn all() -> Result<(), Fault> {
    for (name, bytes) in parts(&read(&top().join("docs/build.md"))?)? {
        let file = target().join(format!("mount/{name}.stl"));
        write(&file, bytes)?;
        println!("{}", file.display());
    }
    Ok(())
}

/// The parts by the table on `page`: names, and files.
pub(crate) fn parts(page: &str) -> Result<[(&'static str, Vec<u8>); 2], Fault> {
    let profiles = Profiles::of(&dimensions(page))?;
    Ok([
        ("mount", stl(&turned(&profiles.mount))),
        ("shaft", stl(&turned(&profiles.shaft))),
    ])
}

pub(crate) fn dimensions(page: &str) -> BTreeMap<String, f64> {
    let rows = page.split_once("| | dimension | mm | from |\n");
    let rows = rows.map_or("", |(_, rows)| rows).lines();
    let row = |line: &str| {
        let mut cells = line.split('|').skip(1).map(str::trim);
        let letter = cells.next()?.to_owned();
        Some((letter, cells.nth(1)?.parse().ok()?))
    };
    let in_table = rows.take_while(|line| !line.is_empty());
    in_table.filter_map(row).collect()
}

/// Half of what a cut through the axis shows: radius and height, anticlockwise.
struct Profiles {
    /// A tube that holds the sleeve, on a foot that stands on the sensor's board.
    mount: Vec<[f64; 2]>,
    /// From the magnet's face to the tip.
    shaft: Vec<[f64; 2]>,
}

impl Profiles {
    fn of(mm: &BTreeMap<String, f64>) -> Result<Self, Fault> {
        let get = |letter: &str| {
            let found = mm.get(letter).copied().filter(|mm| *mm > 0.0);
            found.ok_or_else(|| format!("docs/build.md has no dimension {letter} of the mount"))
        };
        let [a, b, c, e] = [get("a")?, get("b")?, get("c")?, get("e")?];
        let [f, g, h, i, j] = [get("f")?, get("g")?, get("h")?, get("i")?, get("j")?];
        // The magnet's centre, and with it the sleeve's, lies e/2 + g above the Hall elements.
        let height = i + g + e / 2.0 + h / 2.0;
        let [bore, tube, foot] = [f / 2.0, f / 2.0 + j, f / 2.0 + 3.0 * j];
        let base = b / 2.0 + (c - b) / 2.0 * (e / 2.0) / a;
        Ok(Self {
            mount: vec![
                [bore, 0.0],
                [foot, 0.0],
                [foot, j],
                [tube, j],
                [tube, height],
                [bore, height],
            ],
            shaft: vec![
                [0.0, 0.0],
                [base, 0.0],
                [c / 2.0, a - e / 2.0],
                [0.0, a - e / 2.0],
            ],
        })
    }
}

/// The surface of what a profile sweeps as it turns about the axis, in triangles that are
/// anticlockwise from outside.
fn turned(profile: &[[f64; 2]]) -> Vec<[Point; 3]> {
    let point = |[r, z]: [f64; 2], corner: u32| {
        let angle = TAU * f64::from(corner % CORNERS) / f64::from(CORNERS);
        // 0.0 is added as −0 has other bits.
        [r * angle.cos() + 0.0, r * angle.sin() + 0.0, z]
    };
    let ends = profile.iter().cycle().skip(1);
    let mut triangles = Vec::new();
    for (&from, &to) in profile.iter().zip(ends) {
        for corner in 0..CORNERS {
            let [p, q] = [point(from, corner), point(from, corner + 1)];
            let [s, r] = [point(to, corner), point(to, corner + 1)];
            // On the axis two corners are one.
            let has_area = |[a, b, c]: &[Point; 3]| a != b && b != c && c != a;
            triangles.extend([[p, q, r], [p, r, s]].into_iter().filter(has_area));
        }
    }
    triangles
}

fn stl(triangles: &[[Point; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for millimetres in triangle.as_flattened() {
            bytes.extend((*millimetres as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;
    use std::f64::consts::PI;

    use super::*;

    /// The triangles of a file, as a printer's program reads them.
    fn triangles(stl: &[u8]) -> Vec<[[f32; 3]; 3]> {
        let count = u32::from_le_bytes(stl[80..84].try_into().unwrap());
        assert_eq!(stl.len(), 84 + 50 * count as usize);
        let float = |four: &[u8]| f32::from_le_bytes(four.try_into().unwrap());
        let triangle = |bytes: &[u8]| {
            let floats: Vec<f32> = bytes[12..48].chunks(4).map(float).collect();
            [0, 3, 6].map(|at| [floats[at], floats[at + 1], floats[at + 2]])
        };
        stl[84..].chunks(50).map(triangle).collect()
    }

    /// By the divergence theorem: positive if the triangles are anticlockwise from outside.
    fn volume(triangles: &[[[f32; 3]; 3]]) -> f64 {
        let of = |[a, b, c]: &[[f32; 3]; 3]| {
            let [a, b, c] = [a, b, c].map(|point| point.map(f64::from));
            let across = [0, 1, 2].map(|n| {
                let [m, k] = [(n + 1) % 3, (n + 2) % 3];
                a[n] * (b[m] * c[k] - b[k] * c[m])
            });
            across.iter().sum::<f64>() / 6.0
        };
        triangles.iter().map(of).sum()
    }

    #[test]
    fn parts_are_closed_and_have_the_volume_of_their_dimensions() {
        let page = read(&top().join("docs/build.md")).unwrap();
        let mm = dimensions(&page);
        let [a, b, c, e] = ["a", "b", "c", "e"].map(|letter| mm[letter]);
        let [f, g, h, i, j] = ["f", "g", "h", "i", "j"].map(|letter| mm[letter]);
        let ring = |inner: f64, outer: f64| PI * (outer * outer - inner * inner);
        let height = i + g + f64::midpoint(e, h);
        let mount = ring(f / 2.0, f / 2.0 + j) * height + ring(f / 2.0 + j, f / 2.0 + 3.0 * j) * j;
        // A cone that is cut off twice, by the whole cone's height.
        let cone = |diameter: f64| PI * diameter.powi(3) / (12.0 * (b - c) / a);
        let shaft = cone(b - (b - c) / a * e / 2.0) - cone(c);
        // What a polygon has of its circle.
        let sides = f64::from(CORNERS);
        let share = sides / TAU * (TAU / sides).sin();
        for ((name, stl), expected) in parts(&page).unwrap().into_iter().zip([mount, shaft]) {
            let triangles = triangles(&stl);
            let mut edges = HashMap::new();
            for triangle in &triangles {
                for n in 0..3 {
                    let ends = [triangle[n], triangle[(n + 1) % 3]];
                    *edges
                        .entry(ends.map(|end| end.map(f32::to_bits)))
                        .or_insert(0) += 1;
                }
            }
            for (&[from, to], &count) in &edges {
                assert_eq!((count, edges.get(&[to, from])), (1, Some(&1)), "{name}");
            }
            let found = volume(&triangles) / (expected * share);
            assert!((found - 1.0).abs() < 1e-5, "{name}: {found}");
        }
    }
}
