//! Every file type that scans come in, and damaged or hostile files.

use enfilade::picture::{Level, Samples};
use enfilade::store::pictures::{PictureError, decode_picture, load_picture};
use image::{DynamicImage, ImageFormat};

use super::scan::{encoded, fixture, quarters, walls};

fn full(bytes: &[u8]) -> Level {
    decode_picture(bytes, 1).unwrap().levels.all()[0].clone()
}

fn refused(bytes: &[u8]) -> PictureError {
    decode_picture(bytes, 1).expect_err("it is refused")
}

#[test]
fn every_kind_gives_the_same_pixels() {
    let image = DynamicImage::ImageRgba8(quarters(30, 20));
    let colour = DynamicImage::ImageRgb8(image.to_rgb8());
    let expected = colour.to_rgb8().into_raw();
    for format in [ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Bmp, ImageFormat::WebP, ImageFormat::Gif] {
        let source = if format == ImageFormat::Gif { &image } else { &colour };
        let level = full(&encoded(source, format));
        assert_eq!((level.width_px, level.height_px, level.samples), (30, 20, Samples::Rgb), "{format:?}");
        assert_eq!(level.data, expected, "{format:?}");
    }
    let level = full(&encoded(&colour, ImageFormat::Jpeg));
    assert_eq!((level.width_px, level.height_px), (30, 20));
    assert!(level.pixel(3, 3)[0] > 230 && level.pixel(3, 3)[2] < 30, "{:?}", level.pixel(3, 3));
}

#[test]
fn depths_and_channels_become_eight_bits() {
    let deep = DynamicImage::ImageLuma16(walls().to_luma16());
    assert_eq!(full(&encoded(&deep, ImageFormat::Png)), full(&encoded(&walls(), ImageFormat::Png)));
    // A grey scan saved in colour takes a byte a pixel.
    let coloured = DynamicImage::ImageRgb8(walls().to_rgb8());
    assert_eq!(full(&encoded(&coloured, ImageFormat::Png)).samples, Samples::Grey);
    let mut clear = quarters(8, 8);
    clear.put_pixel(0, 0, image::Rgba([9, 9, 9, 0]));
    let level = full(&encoded(&DynamicImage::ImageRgba8(clear), ImageFormat::Png));
    assert_eq!((level.samples, level.pixel(0, 0)), (Samples::Rgba, [9, 9, 9, 0]));
}

#[test]
fn what_printers_and_scanners_write_is_read() {
    // Four inks: red left, blue right.
    let level = full(&fixture("cmyk.jpg"));
    let (left, right) = (level.pixel(3, 8), level.pixel(12, 8));
    assert!(left[0] > 200 && left[1] < 60 && left[2] < 60, "{left:?}");
    assert!(right[2] > 150 && right[0] < 60, "{right:?}");
    // Fax compression of a sheet in black and white: an upright and a level line.
    let level = full(&fixture("fax.tif"));
    assert_eq!((level.width_px, level.height_px, level.samples), (64, 48, Samples::Grey));
    assert_eq!([level.pixel(10, 3), level.pixel(40, 20), level.pixel(40, 21)].map(|pixel| pixel[0]), [0, 0, 255]);
    let level = full(&fixture("jpeg_in.tif"));
    assert!(level.pixel(20, 5)[0] < 60 && level.pixel(20, 20)[0] > 200);
}

/// A JPEG with an EXIF orientation.
fn turned(orientation: u8) -> Vec<u8> {
    let jpeg =
        encoded(&DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(quarters(32, 16)).to_rgb8()), ImageFormat::Jpeg);
    // TIFF header, one entry: tag 0x0112, SHORT, one value (EXIF 2.3, 4.6.4).
    let mut exif = b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([orientation, 0, 0, 0, 0, 0, 0]);
    let length = (exif.len() + 2) as u16;
    let head = [&jpeg[..2], &[0xff, 0xe1], &length.to_be_bytes(), &exif].concat();
    [head, jpeg[2..].to_vec()].concat()
}

#[test]
fn photographs_stand_upright() {
    let is = |pixel: [u8; 4], expected: [u8; 3]| pixel.iter().zip(expected).all(|(p, q)| p.abs_diff(q) < 40);
    // The upper left corner, and the size, for each orientation of EXIF 2.3, table 4.6.4 A.
    let red = [255, 0, 0];
    let (green, blue, white) = ([0, 255, 0], [0, 0, 255], [255, 255, 255]);
    let cases = [
        (1, red, 32),
        (2, green, 32),
        (3, white, 32),
        (4, blue, 32),
        (5, red, 16),
        (6, blue, 16),
        (7, white, 16),
        (8, green, 16),
    ];
    for (orientation, first, width_px) in cases {
        let level = full(&turned(orientation));
        assert_eq!(level.width_px, width_px, "orientation {orientation}");
        assert!(is(level.pixel(2, 2), first), "orientation {orientation}: {:?}", level.pixel(2, 2));
    }
}

#[test]
fn damaged_files_are_refused_in_words() {
    let image = DynamicImage::ImageRgb8(walls().to_rgb8());
    for format in [ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Bmp, ImageFormat::WebP, ImageFormat::Gif] {
        let bytes = encoded(&image, format);
        for part in [2, 3] {
            let error = refused(&bytes[..bytes.len() / part]);
            assert!(!error.what.is_empty() && !error.hint.is_empty(), "{format:?}: {error}");
        }
    }
    // Of a photograph, what is there is shown: cameras leave files unfinished. Without a head it is none.
    let jpeg = encoded(&image, ImageFormat::Jpeg);
    assert!(refused(&jpeg[..40]).what.contains("damaged"));
    for (bytes, word) in [(&b""[..], "no known kind"), (b"<svg/>", "no known kind"), (b"\x89PNG\r\n\x1a\n", "damaged")]
    {
        let error = refused(bytes);
        assert!(error.what.contains(word), "{error}");
    }
    let folder = tempfile::tempdir().unwrap();
    let error = load_picture(&folder.path().join("gone.png"), 1).expect_err("it is gone");
    assert!(error.what.contains("not there"), "{error}");
    assert!(load_picture(folder.path(), 1).expect_err("a folder").what.contains("folder"));
}

/// A PNG's head that promises so many pixels.
fn promising(width: u32, height: u32) -> Vec<u8> {
    let mut png = encoded(&walls(), ImageFormat::Png);
    png[16..20].copy_from_slice(&width.to_be_bytes());
    png[20..24].copy_from_slice(&height.to_be_bytes());
    // The check sum of the chunk, type and data (PNG, 5.3).
    let mut crc = u32::MAX;
    for byte in &png[12..29] {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    png[29..33].copy_from_slice(&(!crc).to_be_bytes());
    png
}

#[test]
fn promises_of_too_many_pixels_are_refused_before_memory_is_taken() {
    for (width, height) in [(100_000, 100_000), (70_000, 10), (60_000, 60_000), (16_385, 16_384)] {
        let error = refused(&promising(width, height));
        assert!(error.what.contains("pixels"), "{width} x {height}: {error}");
    }
    // A TIFF: the tags 256 and 257, width and height, in entries of 12 bytes (TIFF 6.0, section 2).
    let mut tiff = encoded(&walls(), ImageFormat::Tiff);
    let start = u32::from_le_bytes(tiff[4..8].try_into().unwrap()) as usize;
    let count = usize::from(u16::from_le_bytes([tiff[start], tiff[start + 1]]));
    for entry in (0..count).map(|i| start + 2 + 12 * i) {
        if matches!(u16::from_le_bytes([tiff[entry], tiff[entry + 1]]), 256 | 257) {
            tiff[entry + 2..entry + 4].copy_from_slice(&4u16.to_le_bytes());
            tiff[entry + 8..entry + 12].copy_from_slice(&60_000u32.to_le_bytes());
        }
    }
    assert!(!refused(&tiff).what.is_empty());
}

#[test]
fn a_changed_byte_never_breaks_the_program() {
    let image = DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(quarters(12, 9)).to_rgb8());
    for format in
        [ImageFormat::Png, ImageFormat::Tiff, ImageFormat::Bmp, ImageFormat::WebP, ImageFormat::Gif, ImageFormat::Jpeg]
    {
        let bytes = encoded(&image, format);
        for at in 0..bytes.len().min(400) {
            for value in [0, 0x7f, 0xff] {
                let mut changed = bytes.clone();
                changed[at] = value;
                // Read or refused, both will do.
                let _ = decode_picture(&changed, 1);
            }
        }
    }
}
