//! Shared by tests: running the program in memory, and comparing with references beside the tests,
//! pictures pixel for pixel, texts byte for byte.
//!
//! If they differ, the actual result is written beside the reference (`….out.png`, `….diff.png`,
//! `….out.svg`); once they agree again it is removed. `UPDATE_GOLDEN=1 cargo test` makes the results the
//! new references: look at them before committing.
#![allow(dead_code, reason = "each test binary uses a part")]
#![allow(clippy::disallowed_methods, reason = "a test's output is no user's file")]

pub mod large_school;

use std::ffi::OsString;
use std::io::{Cursor, Write};
use std::path::Path;
use std::sync::{Arc, Mutex};

use enfilade::cli::{self, Terminal};

/// Whether to measure on all real data, which takes minutes, and not on a part of it: with `ENFILADE_WHOLE` set.
pub fn is_whole() -> bool {
    std::env::var_os("ENFILADE_WHOLE").is_some()
}

/// What was written, kept in memory.
#[derive(Clone, Default)]
struct Sink(Arc<Mutex<Vec<u8>>>);

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Sink {
    fn text(&self) -> String {
        String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
    }
}

/// Calls the program as with these words behind its name, and gives its exit code, stdout and stderr.
pub fn enfilade(words: impl IntoIterator<Item = impl Into<OsString>>) -> (u8, String, String) {
    let (out, err) = (Sink::default(), Sink::default());
    let mut terminal = Terminal::new(out.clone(), err.clone());
    let words = std::iter::once(OsString::from("enfilade")).chain(words.into_iter().map(Into::into));
    let code = cli::run(words, &mut terminal);
    (code, out.text(), err.text())
}

/// A picture as 8-bit RGBA.
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Decodes a PNG file's bytes.
    pub fn decode(bytes: &[u8]) -> Self {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
        let mut reader = decoder.read_info().unwrap();
        let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgba).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgba, "colour type after normalising");
        rgba.truncate(info.buffer_size());
        Self { width: info.width, height: info.height, rgba }
    }

    fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header().unwrap().write_image_data(&self.rgba).unwrap();
        bytes
    }

    /// Where the two differ: magenta on a pale copy of this one. `None` where nothing does.
    fn difference(&self, other: &Self) -> Option<(usize, Self)> {
        if (self.width, self.height) != (other.width, other.height) {
            let rgba = [255, 0, 255, 255].repeat((self.width * self.height) as usize);
            return Some(((self.width * self.height) as usize, Self { rgba, ..*self }));
        }
        let mut differing = 0;
        let pixels = self.rgba.chunks_exact(4).zip(other.rgba.chunks_exact(4));
        let rgba = pixels
            .flat_map(|(p, q)| {
                if p == q {
                    let pale = |byte: u8| 192 + byte / 4;
                    [pale(p[0]), pale(p[1]), pale(p[2]), 255]
                } else {
                    differing += 1;
                    [255, 0, 255, 255]
                }
            })
            .collect();
        (differing > 0).then_some((differing, Self { rgba, ..*self }))
    }
}

fn is_updating() -> bool {
    std::env::var_os("UPDATE_GOLDEN").is_some()
}

/// No reference picture is larger: they stay in the repository for good.
const MOST_BYTES: usize = 200_000;

/// Compares a PNG file's bytes with the reference picture, pixel for pixel.
pub fn assert_picture(reference: &Path, actual: &[u8]) {
    let (out, diff) = (reference.with_extension("out.png"), reference.with_extension("diff.png"));
    if is_updating() {
        assert!(actual.len() <= MOST_BYTES, "{}: {} bytes are too many", reference.display(), actual.len());
        std::fs::write(reference, actual).unwrap();
    }
    let picture = Picture::decode(actual);
    let difference = match std::fs::read(reference) {
        Ok(bytes) => picture.difference(&Picture::decode(&bytes)),
        Err(_) => Some((0, Picture { rgba: picture.rgba.clone(), ..picture })),
    };
    match difference {
        None => {
            let _ = std::fs::remove_file(&out);
            let _ = std::fs::remove_file(&diff);
        }
        Some((pixels, difference)) => {
            std::fs::write(&out, actual).unwrap();
            std::fs::write(&diff, difference.encode()).unwrap();
            panic!(
                "{pixels} pixels of {} differ from {}: look at both and at {}, then run with UPDATE_GOLDEN=1",
                out.display(),
                reference.display(),
                diff.display()
            );
        }
    }
}

/// Compares a text with the reference, byte for byte.
pub fn assert_text(reference: &Path, actual: &str) {
    let extension = reference.extension().unwrap_or_default().to_string_lossy();
    let out = reference.with_extension(format!("out.{extension}"));
    if is_updating() {
        std::fs::write(reference, actual).unwrap();
    }
    if std::fs::read_to_string(reference).unwrap_or_default() == actual {
        let _ = std::fs::remove_file(&out);
        return;
    }
    std::fs::write(&out, actual).unwrap();
    panic!("{} differs from {}: look at both, then run with UPDATE_GOLDEN=1", out.display(), reference.display());
}
