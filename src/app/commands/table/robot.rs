//! The simulated robot, and logs of real ones.

use super::*;
use crate::app::session::robot::run::{Source, State};
use crate::app::session::robot::settings::{MOST_FURNITURE, MOST_NOISE, MOST_SEED};

fn done(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Refused, |()| Outcome::Done)
}

fn has_run(app: &App) -> Availability {
    when(app.session.robot_run().is_some(), "let a robot explore first, or replay a log")
}

/// A run that can go on.
fn can_drive(app: &App) -> Availability {
    has_run(app)?;
    let state = app.session.robot_run().map(|run| &run.state);
    when(state != Some(&State::Preparing), "wait until the robot's world is made")?;
    when(matches!(state, Some(State::Running | State::Paused)), "the robot has nothing left to do")
}

fn can_hurry(app: &App) -> Availability {
    if app.session.robot_run().is_some_and(|run| run.state == State::Preparing) { Ok(()) } else { can_drive(app) }
}

fn has_map(app: &App) -> Availability {
    has_run(app)?;
    when(app.session.has_robot_map(), "wait until the robot has found rooms, or pause it")
}

fn has_comparison(app: &App) -> Availability {
    has_run(app)?;
    when(
        app.session.robot_run().is_some_and(|run| run.compared().is_some()),
        "wait until the robot has explored a plan to the end",
    )
}

/// Rooms are found by random points, except those of a log.
fn has_points(app: &App) -> Availability {
    let is_log = app.session.robot_run().is_some_and(|run| matches!(run.source, Source::Log));
    when(!is_log, "the rooms of a log are found in its grid map, without points")
}

impl App {
    /// Shows the robot's panel: what it does is seen there.
    fn show_robot_panel(&mut self) {
        self.panels.set_shown(panels::ROBOT, true);
    }
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "explore-plan",
        "Explore this plan",
        "Let a simulated robot explore the plan and find its rooms; the plan itself stays as it is",
        has_rooms,
        &given0(|app, _| {
            app.show_robot_panel();
            done(app.session.explore_plan())
        }),
        None,
    )
    .menu(Menu::Robot, 0),
    with(
        "replay-log",
        "Replay a laser log…",
        "Replay the laser log of a robot (CARMEN, .log or .log.gz) over an empty plan, and map it",
        always,
        &given1(needed("PATH", LOG_FILE, "the log"), |app, path, _| {
            app.show_robot_panel();
            app.session.replay_log(path);
            Outcome::Done
        }),
        Some(|app, _| app.session.choose_log()),
    )
    .typed_path()
    .menu(Menu::Robot, 0),
    switch(
        "robot-run",
        "Run",
        "Let the robot go on, or pause it",
        can_drive,
        |app| app.session.robot_run().is_some_and(|run| run.state == State::Running),
        |app, is_on| app.session.set_robot_running(is_on),
    )
    .keys(&[key(Key::F5)])
    .menu(Menu::Robot, 1),
    command("robot-step", "One step", "Go on by one scan, and pause there", can_drive, |app, _| {
        app.session.step_robot();
    })
    .keys(&[shift(Key::F5)])
    .menu(Menu::Robot, 1),
    with(
        "robot-run-to",
        "Run until…",
        "Go on without showing each step until the robot has driven so far, and pause there",
        can_hurry,
        &given1(needed("DISTANCE", length(0.0, 1e5), "how far from the start of the run"), |app, until_m, _| {
            app.session.hurry_robot(Some(until_m));
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 1),
    command("robot-to-end", "Run to the end", "Go on to the end without showing each step", can_hurry, |app, _| {
        app.session.hurry_robot(None)
    })
    .menu(Menu::Robot, 1),
    command("robot-stop", "Put the robot away", "End the run and show the plan alone again", has_run, |app, _| {
        app.session.stop_robot();
    })
    .menu(Menu::Robot, 1),
    with(
        "robot-speed",
        "Speed…",
        "Show the run so many times faster than the robot drives",
        always,
        &given1(needed("FACTOR", ratio(0.25, 256.0), "times faster than the robot"), |app, speed, _| {
            app.session.robot.settings.speed = speed;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 2),
    switch(
        "robot-sights",
        "Points and lines of sight",
        "Show how rooms are found: random points, those that see each other, and the segments visible from one",
        has_points,
        |app| app.session.robot.settings.shows_sights,
        |app, is_on| app.session.robot.settings.shows_sights = is_on,
    )
    .menu(Menu::Robot, 2),
    switch(
        "robot-paths",
        "Paths",
        "Show the robot's path as estimated, the true one, and that by odometry alone",
        always,
        |app| app.session.robot.settings.shows_paths,
        |app, is_on| app.session.robot.settings.shows_paths = is_on,
    )
    .menu(Menu::Robot, 2),
    with(
        "robot-noise",
        "Scanner noise…",
        "Set the noise of the laser scanners for the next run",
        always,
        &given1(needed("FACTOR", ratio(0.0, MOST_NOISE), "times the usual; 0 for none"), |app, noise, _| {
            app.session.robot.settings.scanner_noise = noise;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 3),
    with(
        "robot-drift",
        "Odometry drift…",
        "Set the drift of the odometry for the next run",
        always,
        &given1(needed("FACTOR", ratio(0.0, MOST_NOISE), "times the usual; 0 for none"), |app, drift, _| {
            app.session.robot.settings.drift = drift;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 3),
    with(
        "robot-furniture",
        "Furniture…",
        "Put so many pieces of furniture into each room for the next run, as far as they fit",
        always,
        &given1(needed("NUMBER", whole(MOST_FURNITURE), "pieces a room"), |app, furniture, _| {
            app.session.robot.settings.furniture = furniture;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 3),
    with(
        "robot-doors-ajar",
        "Doors ajar…",
        "Leave so many of the inner doors ajar for the next run: the robot sees through but cannot pass",
        always,
        &given1(needed("PERCENT", PERCENT, "how many of the inner doors"), |app, percent, _| {
            app.session.robot.settings.ajar_percent = percent;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 3),
    with(
        "robot-doors-closed",
        "Doors closed…",
        "Close so many of the inner doors for the next run",
        always,
        &given1(needed("PERCENT", PERCENT, "how many of the inner doors"), |app, percent, _| {
            app.session.robot.settings.closed_percent = percent;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 3),
    with(
        "robot-seed",
        "Seed…",
        "Set where the next run starts, its noise, its furniture and its doors: the same seed gives the same run",
        always,
        &given1(needed("NUMBER", whole(MOST_SEED), "any number"), |app, seed, _| {
            app.session.robot.settings.seed = seed as u64;
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Robot, 3),
    with(
        "open-robot-map",
        "Open the map as a plan",
        "Open the rooms found, their labels and doorways as a plan of its own",
        has_map,
        &given0(|app, _| done(app.session.open_robot_map())),
        None,
    )
    .menu(Menu::Robot, 4),
    switch(
        "compare-robot-map",
        "Compare with the true plan",
        "List and show what was found, missed, split and merged, and wrong connections and labels",
        has_comparison,
        |app| app.session.robot_run().is_some_and(|run| run.is_compared),
        |app, is_on| {
            app.session.show_robots_plan();
            app.show_robot_panel();
            app.session.set_robot_compared(is_on);
        },
    )
    .menu(Menu::Robot, 4),
    command(
        "show-robots-plan",
        "Show the robot's plan",
        "Show the plan that the robot drives in",
        has_run,
        |app, _| app.session.show_robots_plan(),
    ),
    with(
        "robot-go-to",
        "Go to a difference",
        "Bring a line of the comparison with the true plan into view",
        has_comparison,
        &given1(needed("NUMBER", COUNT, "its number in the panel"), |app, number, _| {
            done(app.session.go_to_difference(number))
        }),
        None,
    ),
];
