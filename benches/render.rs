//! The time to render a 100-room plan on one core: `cargo bench --bench render`.
//!
//! The goal is 60 ms at 2000 x 2000 pixels, from the plan to the PNG file's bytes. Prints the mean of
//! 25 runs of each step.

use std::hint::black_box;

use enfilade::draw::sheet::{self, Furniture, PageSize};
use enfilade::draw::{Drawing, Layer, Scene, Style, View, png, svg};
use enfilade::features::{NeighbourLabels, analyse};
use enfilade::geometry::Point;
use enfilade::labels::{Schemes, Typology};
use enfilade::picture::png::encode_pixmap;
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};

const FUNCTIONS: [&str; 5] = ["office", "shared office", "corridor", "washroom", "conference room"];

/// A storey of `n` by `n` rooms with walls, a door and a window each.
fn storey(n: i32) -> Plan {
    let meta = Meta { name: "Bench".to_owned(), typology: Typology::new("office"), ..Meta::default() };
    let mut builder = Builder::new(meta);
    let (width, depth) = (4.2, 5.4);
    for row in 0..n {
        for column in 0..n {
            let (x, y) = (f64::from(column) * width, f64::from(row) * depth);
            let ring = builder
                .ring([(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)].map(|(x, y)| Point::new(x, y)));
            let [a, b, c, d] = [ring[0], ring[1], ring[2], ring[3]];
            builder.wall(a, b, 0.15);
            builder.wall(d, a, 0.15);
            if row + 1 == n {
                builder.wall(c, d, 0.3);
            }
            if column + 1 == n {
                builder.wall(b, c, 0.3);
            }
            let function = FUNCTIONS[(row * 3 + column) as usize % FUNCTIONS.len()].to_owned();
            let name = format!("{}.{:02} {function}", row + 1, column + 1);
            builder.room("", Room { outer: ring, name, function, ..Room::default() });
            let at = |from, to, at_m, width_m| Place::Hosted { from, to, at_m, width_m };
            builder.opening("", Opening::new(OpeningKind::Door, at(a, b, 1.0, 0.9)));
            builder.opening("", Opening::new(OpeningKind::Window, at(d, a, 2.7, 1.8)));
        }
    }
    builder.finish().unwrap_or_default()
}

/// Milliseconds that one of 25 runs takes on average: of processor time where the system tells it
/// (Linux), so that other programs do not disturb, else of wall-clock time.
fn mean_ms(mut run: impl FnMut()) -> f64 {
    const RUNS: u32 = 25;
    run();
    let before = now_s();
    for _ in 0..RUNS {
        run();
    }
    (now_s() - before) * 1e3 / f64::from(RUNS)
}

fn now_s() -> f64 {
    if let Ok(text) = std::fs::read_to_string("/proc/thread-self/schedstat")
        && let Some(nanoseconds) = text.split(' ').next().and_then(|word| word.parse::<f64>().ok())
    {
        return nanoseconds * 1e-9;
    }
    #[expect(clippy::disallowed_methods, reason = "a bench measures time")]
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn main() {
    let plan = storey(10);
    let schemes = Schemes::bundled();
    let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
    let drawing = Drawing::new(&plan, &analysis);
    let style = Style::default();
    let page = || sheet::page(&drawing, &style, PageSize::Exact(2000.0, 2000.0), Furniture::default());
    let scene = page();
    let Ok(pixmap) = png::paint(&scene) else { return };
    println!("rooms {}, openings {}", plan.rooms().len(), plan.openings().len());
    println!("analysis     {:6.2} ms", mean_ms(|| drop(black_box(analyse(&plan, &schemes, NeighbourLabels::True)))));
    println!("drawing      {:6.2} ms", mean_ms(|| drop(black_box(Drawing::new(&plan, &analysis)))));
    println!("scene        {:6.2} ms", mean_ms(|| drop(black_box(page()))));
    println!("painting     {:6.2} ms", mean_ms(|| drop(black_box(png::paint(&scene)))));
    for layer in Layer::ALL {
        let groups: Vec<_> = scene.groups.iter().filter(|group| group.layer == layer).cloned().collect();
        if !groups.is_empty() {
            let part = Scene { groups, ..scene.clone() };
            println!("  {:10} {:6.2} ms", layer.name(), mean_ms(|| drop(black_box(png::paint(&part)))));
        }
    }
    println!("PNG encoding {:6.2} ms", mean_ms(|| drop(black_box(encode_pixmap(&pixmap)))));
    println!("SVG          {:6.2} ms", mean_ms(|| drop(black_box(svg::svg(&scene)))));
    println!(
        "plan to PNG  {:6.2} ms",
        mean_ms(|| {
            let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
            let drawing = Drawing::new(&plan, &analysis);
            let scene = sheet::page(&drawing, &style, PageSize::Exact(2000.0, 2000.0), Furniture::default());
            drop(black_box(png::png(&scene)));
        })
    );
    // What the window does after an edit and after zooming, on a plan of 2,500 rooms.
    let plan = storey(50);
    let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
    let drawing = Drawing::new(&plan, &analysis);
    println!("rooms {}, openings {}", plan.rooms().len(), plan.openings().len());
    println!("drawing      {:6.2} ms", mean_ms(|| drop(black_box(Drawing::new(&plan, &analysis)))));
    for (part, px_per_m) in [("whole", 8.0), ("a tenth", 80.0)] {
        let view =
            View { width_px: 1600.0, height_px: 1000.0, px_per_m, ..View::fitting(drawing.bounds(), 1.0, 1.0, 0.0) };
        println!("scene        {:6.2} ms, {part} seen", mean_ms(|| drop(black_box(drawing.scene(&style, &view)))));
    }
}
