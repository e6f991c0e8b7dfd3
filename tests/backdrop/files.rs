//! Finding a picture that is not at its plan's path.

use enfilade::plan::Backdrop;
use enfilade::store::pictures::{Found, content_hash, find_picture, is_picture_name};
use image::ImageFormat;

use super::scan::{encoded, put, walls};

#[test]
fn a_picture_that_moved_is_found_by_its_content_then_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let bytes = encoded(&walls(), ImageFormat::Png);
    let backdrop = Backdrop::new("scans/ground.png", content_hash(&bytes));
    assert_eq!(find_picture(&backdrop, root), None);
    // Not by a name's end, nor in a file that is no picture.
    put(root, "notes.txt", &bytes);
    put(root, "underground.png", b"another");
    assert_eq!(find_picture(&backdrop, root), None);
    let namesake = put(root, "old/Ground.PNG", b"another");
    assert_eq!(find_picture(&backdrop, root), Some(Found { path: namesake, is_same: false }));
    let renamed = put(root, "new/deep/er/renamed.png", &bytes);
    assert_eq!(find_picture(&backdrop, root), Some(Found { path: renamed, is_same: true }));
    // Of a plan that never knew its picture's content, the name is all there is.
    let unknown = Backdrop::new("ground.png", "");
    assert_eq!(find_picture(&unknown, root).map(|found| found.is_same), Some(false));
    let too_deep = tempfile::tempdir().unwrap();
    put(too_deep.path(), "1/2/3/4/5/ground.png", &bytes);
    assert_eq!(find_picture(&backdrop, too_deep.path()), None);
}

#[test]
fn hashes_are_those_of_sha256sum() {
    // FIPS 180-2, appendix B.1.
    let expected = "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
    assert_eq!(content_hash(b"abc"), expected);
    assert!(is_picture_name("a/Scan.JPEG".as_ref()) && !is_picture_name("a/plan.json".as_ref()));
}
