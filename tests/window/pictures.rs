//! Snapshots of the window do not depend on how it reached its state. Their appearance is compared by the
//! scripts of `tests/replay/cases`.

use super::window_with;

/// Nothing of a picture depends on what was done before, or on when it is taken.
#[test]
fn the_same_state_gives_the_same_picture() {
    let picture = window_with("dwelling").picture();
    let mut window = window_with("office");
    window.run_command("graph");
    window.wheel(2.0);
    window.advance(3.0);
    window.run_command("graph");
    window.run_command("close");
    window.open_bundled("dwelling");
    window.settle().unwrap();
    window.run_command("zoom-in");
    window.settle().unwrap();
    window.run_command("fit");
    window.settle().unwrap();
    let difference = picture.difference(&window.picture());
    assert_eq!(difference.map(|difference| difference.pixels), None);
}
