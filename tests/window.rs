//! Pictures of the window, taken without a display.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use enfilade::app::{Offscreen, OffscreenOptions};
use std::path::Path;

fn save(window: &mut Offscreen, name: &str) {
    let picture = window.picture();
    let file =
        std::fs::File::options().create(true).truncate(true).write(true).open(format!("/tmp/win/{name}.png")).unwrap();
    let mut encoder = png::Encoder::new(file, picture.width_px, picture.height_px);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&picture.rgba).unwrap();
}

#[test]
fn look() {
    std::fs::create_dir_all("/tmp/win").unwrap();
    for is_dark in [false, true] {
        let mut window = Offscreen::new(OffscreenOptions { is_dark, ..OffscreenOptions::default() });
        window.settle().unwrap();
        let theme = if is_dark { "dark" } else { "light" };
        save(&mut window, &format!("empty-{theme}"));
        for plan in ["office", "school", "dwelling"] {
            assert!(window.open_bundled(plan));
            window.settle().unwrap();
            save(&mut window, &format!("{plan}-{theme}"));
            window.run_command("next-room");
            window.run_command("next-room");
            window.run_command("next-room");
            window.run_command("next-room");
            window.settle().unwrap();
            save(&mut window, &format!("{plan}-{theme}-room"));
        }
        window.open(Path::new("/nowhere/plan.xml"));
        window.settle().unwrap();
        save(&mut window, &format!("error-{theme}"));
        window.click_control("Dismiss message");
        window.click_control("View");
        window.settle().unwrap();
        save(&mut window, &format!("menu-{theme}"));
        window.key(egui::Modifiers::NONE, egui::Key::Escape);
        window.run_command("graph");
        window.run_command("fill-function");
        window.settle().unwrap();
        window.run_command("label-hall");
        assert!(window.click_control("Function"));
        window.settle().unwrap();
        save(&mut window, &format!("function-{theme}"));
        window.text("x");
        window.settle().unwrap();
        window.click_control("Function");
        window.ask_to_close();
        window.settle().unwrap();
        save(&mut window, &format!("question-{theme}"));
        let control = window.control("Grid").unwrap();
        window.key(egui::Modifiers::NONE, egui::Key::Escape);
        window.move_to(control.rect.center());
        window.advance(1.0);
        window.settle().unwrap();
        save(&mut window, &format!("tooltip-{theme}"));
        let mut window = Offscreen::new(OffscreenOptions {
            is_dark,
            scale: 2.0,
            width: 1000,
            height: 640,
            ..OffscreenOptions::default()
        });
        window.open_bundled("office");
        window.settle().unwrap();
        window.run_command("next-room");
        window.settle().unwrap();
        save(&mut window, &format!("fine-{theme}"));
    }
}
