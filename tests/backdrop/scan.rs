//! Small generated pictures.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, Rgba, RgbaImage};

/// A picture of four coloured quarters: red, green; blue, white.
pub fn quarters(width: u32, height: u32) -> RgbaImage {
    RgbaImage::from_fn(width, height, |x, y| {
        Rgba(match (x < width / 2, y < height / 2) {
            (true, true) => [255, 0, 0, 255],
            (false, true) => [0, 255, 0, 255],
            (true, false) => [0, 0, 255, 255],
            (false, false) => [255, 255, 255, 255],
        })
    })
}

/// A scan of a plan: dark walls about three rooms on white paper, 10 pixels a metre.
pub fn walls() -> DynamicImage {
    let is_wall = |x: u32, y: u32| {
        let frame = (20..=180).contains(&x) && (20..=120).contains(&y);
        let inner = (23..=177).contains(&x) && (23..=117).contains(&y);
        let between = (99..=101).contains(&x) && !(60..=69).contains(&y);
        let across = x > 101 && (69..=71).contains(&y) && !(130..=139).contains(&x);
        frame && (!inner || between || across)
    };
    let image = image::GrayImage::from_fn(200, 140, |x, y| image::Luma([if is_wall(x, y) { 30 } else { 255 }]));
    DynamicImage::ImageLuma8(image)
}

pub fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// The bytes of a file beside these tests.
pub fn fixture(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/backdrop").join(name)).unwrap()
}

pub fn put(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, bytes).unwrap();
    path
}
