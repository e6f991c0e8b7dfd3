//! What must hold for every plan: the real ones (if available), and random, degenerate ones.

use std::path::{Path, PathBuf};

use enfilade::draw::sheet::{self, Furniture, PageSize};
use enfilade::draw::{Drawing, Group, Item, Layer, Layers, SMALLEST_TEXT_PX, Style, font, png, svg};
use enfilade::features::{NeighbourLabels, analyse};
use enfilade::formats;
use enfilade::geometry::{Bounds, Point};
use enfilade::labels::Schemes;
use enfilade::plan::OpeningKind;
use proptest::prelude::*;

use super::sketch::Sketch;

/// The box of each text of a group on the screen.
fn text_boxes(group: &Group, view: &enfilade::draw::View) -> Vec<Bounds> {
    let texts = group.items.iter().filter_map(|item| match item {
        Item::Text(text) => Some(text),
        _ => None,
    });
    texts
        .map(|text| {
            assert!(text.size_px >= SMALLEST_TEXT_PX, "{} px: {}", text.size_px, text.content);
            let anchor = view.screen_from_plan(text.at) + text.offset_px;
            let half = font::Font::of(text.weight).width_px(&text.content, text.size_px) / 2.0;
            let (rise, fall) = (text.size_px * font::CAP_HEIGHT, text.size_px * font::DESCENT);
            let corners = if text.upright {
                [Point::new(anchor.x - rise, anchor.y - half), Point::new(anchor.x + fall, anchor.y + half)]
            } else {
                [Point::new(anchor.x - half, anchor.y - rise), Point::new(anchor.x + half, anchor.y + fall)]
            };
            Bounds::of(corners)
        })
        .collect()
}

#[test]
fn names_of_real_plans_are_legible_and_never_overlap() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if !data.is_dir() {
        println!("skipped: no real plans beside this checkout");
        return;
    }
    let schemes = Schemes::bundled();
    let mut plans = 0;
    // Every office and storey; of the many schools and dwellings every fourth and fortieth.
    for (folder, step) in [("authors/office", 1), ("authors/school", 4), ("houses/archilyse", 1), ("houses/r2v", 40)] {
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(data.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files.iter().step_by(step) {
            for plan in formats::read_file(file).unwrap().plans {
                let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
                let drawing = Drawing::new(&plan, &analysis);
                let style = Style::default();
                let scene = sheet::page(&drawing, &style, PageSize::Longest(1200.0), Furniture::default());
                let mut boxes: Vec<(Bounds, &str)> = Vec::new();
                let mut named = 0;
                for group in scene.groups.iter().filter(|group| group.layer == Layer::Names) {
                    named += 1;
                    for text_box in text_boxes(group, &scene.view) {
                        // Half a pixel for rounding to whole ones.
                        let shrunk = text_box.inflated(-0.5);
                        for (other, whose) in &boxes {
                            assert!(!shrunk.intersects(*other), "{}: {} {whose}", file.display(), group.element);
                        }
                        boxes.push((text_box, &group.element));
                    }
                }
                let rooms = plan.rooms().len();
                assert!(named * 2 >= rooms, "{}: {named} of {rooms} rooms named", file.display());
                plans += 1;
            }
        }
    }
    assert!(plans >= 40, "{plans} plans");
}

/// A place on a coarse grid, so that points coincide, lines overlap and rings cross themselves.
fn place() -> impl Strategy<Value = (f64, f64)> {
    (0..7_i32, 0..7_i32).prop_map(|(x, y)| (f64::from(x) * 1.3, f64::from(y) * 1.3))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn degenerate_plans_are_drawn(
        rings in prop::collection::vec(prop::collection::vec(place(), 3..8), 0..6),
        walls in prop::collection::vec((place(), place(), 0..4_i32), 0..6),
        openings in prop::collection::vec((place(), place(), 0..4_usize), 0..6),
    ) {
        let mut sketch = Sketch::new();
        for ring in &rings {
            let mut ring = ring.clone();
            ring.dedup();
            if ring.first() == ring.last() {
                ring.pop();
            }
            if ring.len() >= 3 {
                sketch = sketch.named_room("office", "Any room at all", &ring);
            }
        }
        for &(from, to, thickness) in &walls {
            if from != to {
                sketch = sketch.walls(f64::from(thickness) * 0.2, &[from, to]);
            }
        }
        for &(from, to, kind) in &openings {
            if from != to {
                sketch = sketch.free(OpeningKind::ALL[kind], from, to);
            }
        }
        let (plan, analysis) = sketch.plan();
        let drawing = Drawing::new(&plan, &analysis);
        let style = Style { layers: Layers { graph: true, grid: true, ..Layers::default() }, ..Style::default() };
        for size in [PageSize::Longest(330.0), PageSize::Exact(64.0, 20.0)] {
            let scene = sheet::page(&drawing, &style, size, Furniture::default());
            prop_assert!(png::png(&scene).is_ok());
            let text = svg::svg(&scene);
            prop_assert!(!text.contains("NaN") && !text.contains("inf"));
            prop_assert_eq!(text, svg::svg(&sheet::page(&Drawing::new(&plan, &analysis), &style, size, Furniture::default())));
        }
    }
}
