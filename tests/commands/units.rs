//! Units and the grid's spacing are kept with the settings; lengths in calls may have any unit.

use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::base::units::Units;
use enfilade::plan::GuideAxis;

use super::{refusal, run, window_with};

#[test]
fn units_and_grid_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.json");
    let open = || {
        let mut window = Offscreen::new(OffscreenOptions::default());
        window.use_settings(&file);
        window
    };
    let mut window = open();
    assert_eq!(window.app().units(), Units::Metric);
    run(&mut window, "units-imperial", &[]);
    run(&mut window, "grid-spacing", &["2'"]);
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.contains(r#""units": "imperial""#) && text.contains(r#""grid_m": 0.6096"#), "{text}");
    assert_eq!(open().app().units(), Units::Imperial);
    run(&mut window, "grid-spacing", &["auto"]);
    run(&mut window, "units-metric", &[]);
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(!text.contains("grid_m"), "{text}");
    // What another version wrote is no error.
    #[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
    std::fs::write(&file, r#"{"version": 1, "units": "cubits", "grid_m": -4}"#).unwrap();
    assert_eq!(open().app().units(), Units::Metric);
}

#[test]
fn lengths_have_the_units_that_are_set_or_their_own() {
    let mut window = window_with("dwelling");
    window.watch_commands(true);
    run(&mut window, "add-guide", &["vertical", "3.25"]);
    run(&mut window, "units-imperial", &[]);
    run(&mut window, "add-guide", &["vertical", "10"]);
    run(&mut window, "add-guide", &["horizontal", "50cm*3"]);
    let guides = window.app().guides();
    let at = |axis| guides.iter().filter(|guide| guide.axis == axis).map(|guide| guide.at_m).collect::<Vec<_>>();
    assert_eq!(at(GuideAxis::Vertical), [3.048, 3.25]);
    assert_eq!(at(GuideAxis::Horizontal), [1.5]);
    // Recorded with its unit, so that it means the same whatever is set.
    let recorded = window.take_executed();
    assert_eq!(recorded[2].arguments, ["vertical", "3.048m"]);
    run(&mut window, "move-guide", &["vertical", "3.048m", "4m"]);
    let error = refusal(&mut window, "remove-guide", &["vertical", "3.048m"]);
    assert!(error.contains("there is no vertical guide at 3.048 m"), "{error}");
    let error = refusal(&mut window, "add-guide", &["vertical", "3 parsec"]);
    assert!(error.contains("'parsec' is not understood; a length is"), "{error}");
    run(&mut window, "clear-guides", &[]);
    run(&mut window, "undo", &[]);
    assert_eq!(window.app().guides().len(), 3);
}
