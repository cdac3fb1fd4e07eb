//! The picture that a run leaves.

use crate::common::{Place, says};

/// Width, height and bytes of a picture of pixels, three a pixel.
fn pixels(file: Vec<u8>) -> (usize, usize, Vec<u8>) {
    let mut read = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; read.output_buffer_size().unwrap()];
    let info = read.next_frame(&mut bytes).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    (info.width as usize, info.height as usize, bytes)
}

#[test]
fn a_run_leaves_its_picture_with_axes_and_legend() {
    let place = Place::classifying();
    place.done("run s.toml --out out");
    let svg = place.text("out/trace.svg");
    let panels = [
        "angle θ′, degrees",
        "sensor, codes",
        "contact π, z",
        "class",
    ];
    let legend = ["setpoint", "suppression z", "presented", "decision: right"];
    says(&svg, &panels);
    says(&svg, &legend);
    says(&svg, &["textured", "time, s", "unknown"]);
    assert!(!svg.contains("right side"), "there is none");
    place.done("run ideal.toml --out out");
    let both = place.text("out/trace.svg");
    assert!(both.contains("angle, right") && !both.contains("presented"));
}

/// What reached beyond the edge would leave ink on it: of one scene curves go far, of the other names
/// of classes are long.
#[test]
fn no_ink_is_at_the_edge_and_there_is_ink_in_every_panel() {
    let place = Place::classifying();
    for scene in ["s.toml", "ideal.toml"] {
        place.done(&format!("run {scene} --out out"));
        let (width, height, bytes) = pixels(place.bytes("out/trace.png"));
        assert_eq!((width, height), (1000, 760));
        let is_ink = |x: usize, y: usize| bytes[3 * (y * width + x)..][..3] != [255; 3];
        let edge = (0..width)
            .flat_map(|x| [(x, 0), (x, height - 1)])
            .chain((0..height).flat_map(|y| [(0, y), (width - 1, y)]));
        for (x, y) in edge {
            assert!(!is_ink(x, y), "{scene}: {x}, {y}");
        }
        for top in [40, 230, 410, 590] {
            let mut inside = (100..800).flat_map(|x| (top..top + 120).map(move |y| (x, y)));
            assert!(inside.any(|(x, y)| is_ink(x, y)), "{scene}: {top}");
        }
    }
}

#[test]
fn a_picture_is_the_same_each_time_where_it_is_asked_for() {
    let place = Place::classifying();
    place.done("run s.toml --out one --plot two/copy.png");
    place.done("run s.toml --out again --plot two/copy.svg");
    for file in ["trace.svg", "trace.png"] {
        let [one, again] = ["one", "again"].map(|folder| place.bytes(&format!("{folder}/{file}")));
        assert!(one == again, "{file}");
        let copy = place.bytes(&file.replace("trace", "two/copy"));
        assert!(copy == one, "{file}");
    }
    place.done("run s.toml --out none --no-plot");
    let left = std::fs::read_dir(place.path("none")).unwrap().count();
    assert_eq!(left, 2);
    place.refuses_to_write("run s.toml --plot p.pdf", &["--plot", ".svg or .png"]);
    place.refuses_to_write("run s.toml --plot p.svg --no-plot", &["--no-plot"]);
}
