//! How long a picture of a 100-room plan takes on one core: `cargo bench --bench render`.
//!
//! The goal is 60 ms at 2000 x 2000 pixels, from the plan to the PNG file's bytes. Prints the best of
//! 25 runs of each step.

use std::hint::black_box;

use enfilade::draw::sheet::{self, Furniture, PageSize};
use enfilade::draw::{Drawing, Style, png, svg};
use enfilade::features::{NeighbourLabels, analyse};
use enfilade::geometry::Point;
use enfilade::labels::{Schemes, Typology};
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};

const FUNCTIONS: [&str; 5] = ["office", "shared office", "corridor", "washroom", "conference room"];

/// A storey of 10 by 10 rooms with walls, a door and a window each.
fn storey() -> Plan {
    let meta = Meta { name: "Bench".to_owned(), typology: Typology::new("office"), ..Meta::default() };
    let mut builder = Builder::new(meta);
    let (width, depth) = (4.2, 5.4);
    for row in 0..10 {
        for column in 0..10 {
            let (x, y) = (f64::from(column) * width, f64::from(row) * depth);
            let ring = builder
                .ring([(x, y), (x + width, y), (x + width, y + depth), (x, y + depth)].map(|(x, y)| Point::new(x, y)));
            let [a, b, c, d] = [ring[0], ring[1], ring[2], ring[3]];
            builder.wall(a, b, 0.15);
            builder.wall(d, a, 0.15);
            if row == 9 {
                builder.wall(c, d, 0.3);
            }
            if column == 9 {
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

fn best_ms(mut run: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..25)
        .map(|_| {
            #[expect(clippy::disallowed_methods, reason = "a bench measures time")]
            let start = std::time::Instant::now();
            run();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[0]
}

#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn main() {
    let plan = storey();
    let schemes = Schemes::bundled();
    let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
    let drawing = Drawing::new(&plan, &analysis);
    let style = Style::default();
    let page = || sheet::page(&drawing, &style, PageSize::Exact(2000.0, 2000.0), Furniture::default());
    let scene = page();
    let Ok(pixmap) = png::paint(&scene) else { return };
    println!("rooms {}, openings {}", plan.rooms().len(), plan.openings().len());
    println!("analysis     {:6.2} ms", best_ms(|| drop(black_box(analyse(&plan, &schemes, NeighbourLabels::True)))));
    println!("drawing      {:6.2} ms", best_ms(|| drop(black_box(Drawing::new(&plan, &analysis)))));
    println!("scene        {:6.2} ms", best_ms(|| drop(black_box(page()))));
    println!("painting     {:6.2} ms", best_ms(|| drop(black_box(png::paint(&scene)))));
    println!("PNG encoding {:6.2} ms", best_ms(|| drop(black_box(png::encode(&pixmap)))));
    println!("SVG          {:6.2} ms", best_ms(|| drop(black_box(svg::svg(&scene)))));
    println!(
        "plan to PNG  {:6.2} ms",
        best_ms(|| {
            let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
            let drawing = Drawing::new(&plan, &analysis);
            let scene = sheet::page(&drawing, &style, PageSize::Exact(2000.0, 2000.0), Furniture::default());
            drop(black_box(png::png(&scene)));
        })
    );
}
