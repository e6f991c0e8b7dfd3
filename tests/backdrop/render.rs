//! `enfilade render` shows the backdrop.

use std::path::Path;
use std::sync::Arc;

use enfilade::geometry::Point;
use enfilade::plan::{Backdrop, Builder, Meta, Plan, Room};
use enfilade::store::{pictures, save_plan};
use image::{DynamicImage, ImageFormat};

use super::scan::{encoded, put, quarters};
use crate::support;

/// Runs `enfilade render` and gives its exit code and what it said of trouble.
fn render(arguments: &[&str]) -> (u8, String) {
    let (code, _, said) = support::enfilade(["render"].iter().chain(arguments));
    (code, said)
}

/// A room of 8 by 4 metres, with a picture of 40 by 20 pixels under it, 0.2 m each.
pub fn traced(path: &str, hash: &str) -> Plan {
    let mut builder = Builder::new(Meta::default());
    let ring = builder.ring([(0.0, 0.0), (8.0, 0.0), (8.0, -4.0), (0.0, -4.0)].map(|(x, y)| Point::new(x, y)));
    builder.room("room", Room { outer: ring, ..Room::default() });
    builder.set_backdrop(Backdrop { metres_per_pixel: 0.2, ..Backdrop::new(path, hash) });
    builder.finish().unwrap()
}

fn colour_at(picture: &Path, x: f64, y: f64) -> [u8; 3] {
    let image = image::open(picture).unwrap().to_rgb8();
    image.get_pixel((f64::from(image.width()) * x) as u32, (f64::from(image.height()) * y) as u32).0
}

#[test]
fn a_jpeg_lies_under_the_plan() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let image = DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(quarters(40, 20)).to_rgb8());
    put(root, "scans/a.jpg", &encoded(&image, ImageFormat::Jpeg));
    let plan_path = root.join("a.plan.json");
    save_plan(&plan_path, &traced("scans/a.jpg", "")).unwrap();
    let (plan, png) = (plan_path.to_string_lossy(), root.join("a.png"));
    let call = [&plan, "-o", &png.to_string_lossy(), "--bare", "--colour", "none", "--no-names", "--size", "400"];
    assert_eq!(render(&call), (0, String::new()));
    let is = |colour: [u8; 3], expected: [u8; 3]| colour.iter().zip(expected).all(|(p, q)| p.abs_diff(q) < 40);
    for (x, y, expected) in [(0.3, 0.3, [255, 0, 0]), (0.7, 0.3, [0, 255, 0]), (0.3, 0.7, [0, 0, 255])] {
        assert!(is(colour_at(&png, x, y), expected), "{:?} at {x}, {y}", colour_at(&png, x, y));
    }
    let without = [&call[..], &["--no-picture"]].concat();
    assert_eq!(render(&without).0, 0);
    assert_eq!(colour_at(&png, 0.3, 0.3), [255, 255, 255]);
    // As SVG it is part of the file.
    let svg = root.join("a.svg");
    assert_eq!(render(&[&plan, "-o", &svg.to_string_lossy()]).0, 0);
    let text = std::fs::read_to_string(&svg).unwrap();
    assert!(text.contains("<g id=\"picture\">\n<image width=\"40\" height=\"20\" transform=\"matrix("), "{text}");
    // One that is gone is said, and the plan drawn.
    save_plan(&plan_path, &traced("gone.jpg", "")).unwrap();
    let (code, said) = render(&call);
    assert_eq!(code, 0);
    assert!(said.contains("gone.jpg") && said.contains("left out"), "{said}");
}

#[test]
fn a_turned_picture_lies_where_the_plan_says() {
    use enfilade::draw::{Drawing, Style, View, png};
    use enfilade::features::{NeighbourLabels, analyse};
    use enfilade::labels::Schemes;
    let image = DynamicImage::ImageRgba8(quarters(400, 200));
    let loaded = pictures::decode_picture(&encoded(&image, ImageFormat::Png), 1).unwrap();
    let backdrop = Backdrop {
        origin: Point::new(1.0, 2.0),
        metres_per_pixel: 0.02,
        rotation_rad: 0.5,
        ..Backdrop::new("a.png", "")
    };
    let plan = Plan::default();
    let analysis = analyse(&plan, &Schemes::bundled(), NeighbourLabels::True);
    let drawing = Drawing::new(&plan, &analysis).with_picture(Arc::new(loaded.levels), &backdrop);
    for (px_per_m, centre) in
        [(20.0, drawing.bounds().center()), (300.0, backdrop.plan_from_picture(Point::new(200.0, 100.0)))]
    {
        let view = View { width_px: 200.0, height_px: 160.0, px_per_m, centre, pixel_ratio: 1.0 };
        let pixmap = png::paint(&drawing.scene(&Style::default(), &view)).unwrap();
        // A little inside of each quarter, seen from the middle.
        let middle = Point::new(200.0, 100.0);
        let reach = 20.0 / px_per_m / backdrop.metres_per_pixel;
        for (x, y, expected) in
            [(-1.0, -1.0, [255, 0, 0]), (1.0, -1.0, [0, 255, 0]), (-1.0, 1.0, [0, 0, 255]), (1.0, 1.0, [255; 3])]
        {
            let pixel = Point::new(middle.x + x * reach, middle.y + y * reach);
            let at = view.screen_from_plan(backdrop.plan_from_picture(pixel));
            let found = pixmap.pixel(at.x as u32, at.y as u32).unwrap();
            assert_eq!([found.red(), found.green(), found.blue()], expected, "{px_per_m} {x} {y}");
        }
    }
}
