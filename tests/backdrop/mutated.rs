//! Sound files of every kind with a few bytes changed, decoded apart: read or refused in words, never without
//! an end.
//!
//! `ENFILADE_MUTATIONS=3000 cargo test --test library backdrop::mutated -- --nocapture` tries so many of each
//! kind instead of a few: some ten minutes.

use std::time::{Duration, Instant};

use enfilade::base::random::Random;
use image::{DynamicImage, ImageFormat};

use super::apart::apart;
use super::pdf::pdf;
use super::scan::{encoded, fixture, quarters};

/// Files of each kind that are tried where nothing else is said: some twenty seconds.
const USUAL: usize = 40;

/// The decoder's limit, and room for a busy machine.
const LONGEST: Duration = Duration::from_secs(60);

fn changed(sound: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(6) {
            0 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
            1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes[at] = b"0123456789[]<>(){}/-"[random.below(20)],
            // A number with more digits, in a PDF.
            3 if bytes[at].is_ascii_digit() => {
                let digits = std::iter::repeat_n(b'9', 1 + random.below(10));
                bytes.splice(at..at, digits);
            }
            4 => {
                // A piece of the file once more.
                let end = (at + 1 + random.below(30)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            5 if random.below(4) == 0 => bytes.truncate(at.max(1)),
            _ => bytes[at] = random.below(256) as u8,
        }
    }
    bytes
}

#[test]
fn a_few_wrong_bytes_are_read_or_refused_in_words() {
    let count = std::env::var("ENFILADE_MUTATIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(USUAL);
    let image = DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(quarters(24, 18)).to_rgb8());
    let formats = [
        (ImageFormat::Png, "png"),
        (ImageFormat::Tiff, "tiff"),
        (ImageFormat::Bmp, "bmp"),
        (ImageFormat::WebP, "webp"),
        (ImageFormat::Gif, "gif"),
        (ImageFormat::Jpeg, "jpeg"),
    ];
    let mut sound: Vec<(&str, Vec<u8>)> = formats.map(|(format, name)| (name, encoded(&image, format))).to_vec();
    for name in ["fax.tif", "jpeg_in.tif", "tiff-palette.tif", "tiff-ccitt-group-3.tif", "tiff-two-pages.tif"] {
        sound.push((name, fixture(name)));
    }
    let content =
        "q 0.5 0 0 0.5 10 10 cm 1 0 0 RG 2 w [3 2] 0 d 0 0 m 50 60 100 20 150 90 c S Q 0 g 10 10 40 40 re f* n";
    sound.push(("pdf", pdf(&[(200.0, 200.0, content)])));
    let (mut read, mut refused) = (0, 0);
    let start = Instant::now();
    for (name, bytes) in &sound {
        let mut random = Random::new(16);
        for round in 0..count {
            let changed = changed(bytes, &mut random);
            let before = Instant::now();
            match apart(&changed, 1) {
                Ok(_) => read += 1,
                Err(error) => {
                    assert!(!error.what.is_empty() && !error.hint.is_empty(), "{name} {round}");
                    assert!(!error.what.contains("cannot be decoded"), "{name} {round}: {error}");
                    refused += 1;
                }
            }
            assert!(before.elapsed() < LONGEST, "{name} {round} took {:?}", before.elapsed());
        }
    }
    println!("{read} read, {refused} refused in {:?}", start.elapsed());
    assert!(read > 0 && refused > 0);
}
