//! The cost of a snapshot and of a script on one core: `cargo bench --bench replay`.
//!
//! The goals: a snapshot of the window at 1280x800 in under 30 ms, a script of 100 steps in under a
//! second. Prints the mean of 25 runs.

use std::hint::black_box;
use std::path::Path;

use enfilade::app::{
    Offscreen, OffscreenOptions,
    replay::{ReplayOptions, ScriptFile, replay},
};
use enfilade::picture::Picture;

/// Milliseconds that one of 25 runs takes on average, of wall-clock time.
fn mean_ms(mut run: impl FnMut()) -> f64 {
    const RUNS: u32 = 25;
    run();
    let before = now_s();
    for _ in 0..RUNS {
        run();
    }
    (now_s() - before) * 1e3 / f64::from(RUNS)
}

/// Of processor time where the system tells it (Linux), so that other programs do not disturb.
fn now_s() -> f64 {
    if let Ok(text) = std::fs::read_to_string("/proc/thread-self/schedstat")
        && let Some(nanoseconds) = text.split(' ').next().and_then(|word| word.parse::<f64>().ok())
    {
        return nanoseconds * 1e-9;
    }
    #[expect(clippy::disallowed_methods, reason = "a bench measures time")]
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

/// A script of 100 steps of all kinds, with ten snapshots.
fn script() -> String {
    let mut text = "open-sample school\n".to_owned();
    for round in 0..9 {
        text.push_str(&format!(
            "next-room\nlabel-big\nexpect unsaved yes\nkey H\nmove pixel {},300\nzoom-in\nundo\nscroll -1\nclick pixel \
             600,{}\nfit\nsnapshot s{round}\n",
            400 + round * 20,
            300 + round * 10
        ));
    }
    text
}

#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    for stem in ["dwelling", "school", "office"] {
        let mut window = Offscreen::new(OffscreenOptions::default());
        window.open_bundled(stem);
        window.settle()?;
        let picture = window.picture();
        let png = picture.to_png()?;
        println!("{stem}, 1280x800");
        println!("  frame           {:6.2} ms", mean_ms(|| window.settle().unwrap_or_default()));
        println!("  picture         {:6.2} ms", mean_ms(|| drop(black_box(window.picture()))));
        println!("  PNG written     {:6.2} ms, {} kB", mean_ms(|| drop(black_box(picture.to_png()))), png.len() / 1000);
        println!(
            "  PNG read        {:6.2} ms",
            mean_ms(|| {
                drop(black_box(Picture::from_png(std::io::Cursor::new(&png), 1 << 24)));
            })
        );
        println!("  compared        {:6.2} ms", mean_ms(|| drop(black_box(picture.difference(&picture.clone())))));
    }
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("bench.replay");
    #[expect(clippy::disallowed_methods, reason = "a bench's script is no user's file")]
    std::fs::write(&path, script())?;
    let file = ScriptFile { path, title: "bench".to_owned() };
    let update = ReplayOptions { update: true, ..ReplayOptions::default() };
    let report = replay(&file, &update);
    println!("script of {} steps, {} snapshots", report.steps, report.snapshots);
    if let Some(failure) = report.failures.first() {
        return Err(format!("the script fails: {failure:?}").into());
    }
    println!(
        "  first run, written {:6.2} ms",
        mean_ms(|| {
            for snapshot in 0..9 {
                let _ = std::fs::remove_file(Path::new(folder.path()).join(format!("s{snapshot}.png")));
            }
            drop(black_box(replay(&file, &update)));
        })
    );
    println!("  compared           {:6.2} ms", mean_ms(|| drop(black_box(replay(&file, &ReplayOptions::default())))));
    Ok(())
}
