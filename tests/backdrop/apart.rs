//! Pictures decoded in a process of their own: the same pixels, and files made to hurt are stopped.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use enfilade::base::work::Work;
use enfilade::store::pictures::{Decoding, LoadedPicture, PictureError, decode_picture_by};
use image::{DynamicImage, ImageFormat};

use super::pdf::{file_of, pdf};
use super::scan::{encoded, fixture, put, quarters, walls};

/// The program.
pub fn program() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_enfilade"))
}

pub fn apart(bytes: &[u8], page: u32) -> Result<LoadedPicture, PictureError> {
    decode_picture_by(&Decoding::Apart(program()), bytes, page, &Work::quiet())
}

/// A PDF whose page is shaded by a function of 200,000 nested blocks.
fn nested() -> Vec<u8> {
    let dictionary = |entries: &str| format!("<< {entries} >>");
    let stream =
        |entries: &str, data: &str| format!("<< {entries} /Length {} >>\nstream\n{data}\nendstream", data.len());
    file_of(&[
        dictionary("/Type /Catalog /Pages 2 0 R"),
        dictionary("/Type /Pages /Kids [3 0 R] /Count 1"),
        dictionary(
            "/Type /Page /Parent 2 0 R /MediaBox [0 0 200 200] /Contents 4 0 R /Resources << /Shading << /S 5 0 R >> >>",
        ),
        stream("", "/S sh"),
        dictionary("/ShadingType 2 /ColorSpace /DeviceGray /Coords [0 0 200 0] /Function 6 0 R"),
        stream("/FunctionType 4 /Domain [0 1] /Range [0 1]", &"{".repeat(200_000)),
    ])
}

#[test]
fn pixels_are_the_same_as_decoded_here() {
    let colour = DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(quarters(30, 20)).to_rgb8());
    let mut clear = quarters(8, 8);
    clear.put_pixel(0, 0, image::Rgba([9, 9, 9, 0]));
    let formats =
        [ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Bmp, ImageFormat::WebP, ImageFormat::Gif, ImageFormat::Jpeg];
    let mut files: Vec<(Vec<u8>, u32)> = formats.map(|format| (encoded(&colour, format), 1)).to_vec();
    files.push((encoded(&walls(), ImageFormat::Png), 1));
    files.push((encoded(&DynamicImage::ImageRgba8(clear), ImageFormat::Png), 1));
    files.extend(["cmyk.jpg", "fax.tif", "jpeg_in.tif", "tiff-palette.tif"].map(|name| (fixture(name), 1)));
    files.push((fixture("tiff-two-pages.tif"), 2));
    files.push((pdf(&[(72.0, 36.0, "0 g 0 18 72 18 re f"), (36.0, 36.0, "1 0 0 rg 0 0 36 36 re f")]), 2));
    for (index, (bytes, page)) in files.iter().enumerate() {
        let here = decode_picture_by(&Decoding::Here, bytes, *page, &Work::quiet()).unwrap();
        let there = apart(bytes, *page).unwrap();
        assert_eq!(here.levels.all(), there.levels.all(), "file {index}");
        assert_eq!((here.content_hash, here.pages), (there.content_hash, there.pages), "file {index}");
    }
    // What is refused is refused in the same words.
    for bytes in [&b"<svg/>"[..], b"\x89PNG\r\n\x1a\n", b"%PDF-1.4 and nothing else", b"II*\0"] {
        let here = decode_picture_by(&Decoding::Here, bytes, 1, &Work::quiet()).unwrap_err();
        assert_eq!(apart(bytes, 1).unwrap_err(), here);
    }
}

#[test]
fn files_made_to_hurt_are_stopped_and_say_why() {
    for (bytes, words) in [
        (fixture("endless.pdf"), "too long"),
        (nested(), "nested too deeply"),
        (fixture("unbounded-memory.pdf"), "more memory"),
    ] {
        let error = apart(&bytes, 1).unwrap_err();
        assert!(error.what.contains(words), "{error}");
    }
}

#[test]
fn a_picture_that_is_no_longer_wanted_is_not_waited_for() {
    let cancelled = AtomicBool::new(true);
    let progress = |_: usize, _: usize| {};
    let work = Work::quiet().watched(&progress, &cancelled);
    let start = Instant::now();
    let error = decode_picture_by(&Decoding::Apart(program()), &fixture("endless.pdf"), 1, &work).unwrap_err();
    assert!(error.what.contains("no longer wanted"), "{error}");
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
}

#[test]
fn a_program_that_is_none_is_said() {
    let nowhere = Decoding::Apart(PathBuf::from("/nowhere/enfilade"));
    let error = decode_picture_by(&nowhere, &fixture("fax.tif"), 1, &Work::quiet()).unwrap_err();
    assert!(error.what.contains("cannot be decoded"), "{error}");
    // One that answers something else, or nothing.
    #[cfg(unix)]
    for other in ["/bin/cat", "/bin/echo", "/bin/true"] {
        let other = Decoding::Apart(PathBuf::from(other));
        let error = decode_picture_by(&other, &fixture("fax.tif"), 1, &Work::quiet()).unwrap_err();
        assert!(error.what.contains("cannot be decoded"), "{error}");
    }
}

/// A plan over a picture of its folder.
fn over(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    put(folder, name, bytes);
    let plan = format!(
        r#"{{"format":"enfilade plan","version":1,"backdrop":{{"path":"{name}","x":0,"y":0,"metres_per_pixel":0.01}}}}"#
    );
    put(folder, &format!("{name}.plan.json"), plan.as_bytes())
}

#[test]
fn such_a_picture_is_left_out_of_a_render() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [
        ("endless.pdf", fixture("endless.pdf")),
        ("nested.pdf", nested()),
        ("memory.pdf", fixture("unbounded-memory.pdf")),
    ] {
        let plan = over(folder.path(), name, &bytes);
        let png = folder.path().join(format!("{name}.png"));
        let output = Command::new(program()).arg("render").arg(&plan).arg("-o").arg(&png).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(said.contains("left out: the picture") && said.lines().count() == 1, "{said}");
        assert!(png.is_file());
    }
}

#[cfg(feature = "gui")]
#[test]
fn the_window_opens_the_plan_without_such_a_picture_and_says_why() {
    let folder = tempfile::tempdir().unwrap();
    over(folder.path(), "endless.pdf", &fixture("endless.pdf"));
    over(folder.path(), "nested.pdf", &nested());
    let script = "open endless.pdf.plan.json\nexpect message \"not shown: endless.pdf takes too long to decode\"\n\
                  dismiss-message\nopen nested.pdf.plan.json\nexpect message \"nested too deeply\"\n";
    let script = put(folder.path(), "hostile.replay", script.as_bytes());
    let output = Command::new(program()).arg("replay").arg(&script).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
