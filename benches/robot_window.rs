//! The cost of a frame of the window while a robot explores a school of 58 rooms, on one core: `cargo bench --bench
//! robot_window`. The goal: 60 frames a second, that is 16.7 ms a frame, from the event to the triangles that go to
//! a display. The robot drives beside the frames, as it does on a screen.

use enfilade::app::{Offscreen, OffscreenOptions};

/// Processor time of this thread where the system tells it (Linux): the robot's own thread does not count.
fn now_ms() -> f64 {
    if let Ok(text) = std::fs::read_to_string("/proc/thread-self/schedstat")
        && let Some(nanoseconds) = text.split(' ').next().and_then(|word| word.parse::<f64>().ok())
    {
        return nanoseconds * 1e-6;
    }
    #[expect(clippy::disallowed_methods, reason = "a bench measures time")]
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64() * 1e3)
}

/// Frames measured at each place of the run.
const FRAMES: usize = 300;

#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn frames(window: &mut Offscreen, what: &str) {
    let (mut times, mut corners) = (Vec::new(), 0);
    for _ in 0..FRAMES {
        let before = now_ms();
        window.advance(0.0);
        corners = window.tessellate();
        times.push(now_ms() - before);
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    times.sort_by(f64::total_cmp);
    let mean = times.iter().sum::<f64>() / FRAMES as f64;
    let (late, slowest) = (times[FRAMES * 99 / 100], times[FRAMES - 1]);
    println!("  {what:28} {mean:6.2} ms, 99 of 100 {late:6.2} ms, slowest {slowest:6.2} ms; {corners} vertices");
}

/// Lets the window work until the robot has driven so far.
fn drive(window: &mut Offscreen, until: &str) -> Result<(), Box<dyn std::error::Error>> {
    window.run_command_with("robot-run-to", &[until])?;
    // The panel is read by what a screen reader would say. While the world is made its button says so too, greyed.
    let is_there =
        |window: &Offscreen| window.controls().iter().any(|control| control.name == "Run" && control.is_enabled);
    for _ in 0..100_000 {
        window.advance(0.0);
        if is_there(window) {
            return Ok(());
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    Err("the robot did not come so far".into())
}

#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut window = Offscreen::new(OffscreenOptions::default()).working_beside();
    window.open_bundled("school");
    for _ in 0..200 {
        window.advance(0.0);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    // A second wing beside the first.
    window.run_command("select-all");
    window.run_command_with("array", &["2", "1", "70,0"])?;
    window.run_command("clear-selection");
    window.run_command("fit");
    println!("{} rooms", window.app().plan().map_or(0, |plan| plan.rooms().len()));
    window.run_command("explore-plan");
    window.run_command_with("robot-speed", &["64"])?;
    for until in ["5m", "60m", "200m"] {
        drive(&mut window, until)?;
        window.run_command_with("robot-run", &["on"])?;
        frames(&mut window, &format!("driving from {until}"));
    }
    window.run_command_with("robot-sights", &["on"])?;
    frames(&mut window, "points and lines of sight");
    Ok(())
}
