//! Kinds of TIFF that scanners, fax machines and drawing programs write.

use enfilade::picture::{Level, Samples};
use enfilade::store::pictures::{PictureError, decode_picture};
use image::{DynamicImage, ImageFormat};

use super::scan::{encoded, fixture, walls};

/// A field: its tag and its values.
type Field = (u16, Vec<u32>);

/// How a file is written.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Little,
    Big,
    BigTiff,
}

/// A TIFF of pages, each of one strip: the fields, of SHORTs where they fit, and the strip's bytes.
fn tiff(kind: Kind, pages: &[(Vec<Field>, Vec<u8>)]) -> Vec<u8> {
    let number = |size: usize, value: u64| -> Vec<u8> {
        let bytes = value.to_be_bytes()[8 - size..].to_vec();
        if kind == Kind::Big { bytes } else { bytes.into_iter().rev().collect() }
    };
    let wide = if kind == Kind::BigTiff { 8 } else { 4 };
    let mut file = if kind == Kind::Big { b"MM".to_vec() } else { b"II".to_vec() };
    if kind == Kind::BigTiff {
        file.extend([number(2, 43), number(2, 8), number(2, 0)].concat());
    } else {
        file.extend(number(2, 42));
    }
    let mut link = file.len();
    file.extend(number(wide, 0));
    for (fields, strip) in pages {
        let at = file.len() as u32;
        file.extend(strip);
        let mut fields = fields.clone();
        fields.extend([(273, vec![at]), (279, vec![strip.len() as u32])]);
        fields.sort();
        let mut entries = Vec::new();
        for (tag, values) in &fields {
            let (of, size) = if values.iter().all(|&value| value < 1 << 16) { (3, 2) } else { (4, 4) };
            let mut data: Vec<u8> = values.iter().flat_map(|&value| number(size, u64::from(value))).collect();
            if data.len() > wide {
                let place = file.len() as u64;
                file.extend(&data);
                data = number(wide, place);
            }
            data.resize(wide, 0);
            entries
                .extend([number(2, u64::from(*tag)), number(2, of), number(wide, values.len() as u64), data].concat());
        }
        let start = file.len() as u64;
        file.splice(link..link + wide, number(wide, start));
        file.extend(number(if kind == Kind::BigTiff { 8 } else { 2 }, fields.len() as u64));
        file.extend(entries);
        link = file.len();
        file.extend(number(wide, 0));
    }
    file
}

/// The fields of a page of so many pixels, whose samples have so many bits; `photometric`: 0 white is zero,
/// 1 black is zero, 2 colours, 3 a palette.
fn fields(width: u32, height: u32, bits: &[u32], compression: u32, photometric: u32) -> Vec<Field> {
    vec![
        (256, vec![width]),
        (257, vec![height]),
        (258, bits.to_vec()),
        (259, vec![compression]),
        (262, vec![photometric]),
        (277, vec![bits.len() as u32]),
        (278, vec![height]),
    ]
}

/// Samples of so many bits one after the other, the highest bit first.
fn packed(bits: u32, samples: &[u32]) -> Vec<u8> {
    let digits: Vec<u32> =
        samples.iter().flat_map(|sample| (0..bits).rev().map(move |bit| sample >> bit & 1)).collect();
    digits.chunks(8).map(|byte| byte.iter().enumerate().map(|(i, bit)| (bit << (7 - i)) as u8).sum()).collect()
}

fn full(bytes: &[u8]) -> Level {
    decode_picture(bytes, 1).unwrap_or_else(|error| panic!("{error}")).levels.all()[0].clone()
}

fn refused(bytes: &[u8], page: u32) -> PictureError {
    decode_picture(bytes, page).expect_err("it is refused")
}

const KINDS: [Kind; 3] = [Kind::Little, Kind::Big, Kind::BigTiff];

#[test]
fn files_of_other_programs_are_read() {
    for name in ["tiff-palette.tif", "tiff-ccitt-group-3.tif"] {
        let level = full(&fixture(name));
        assert_eq!((level.width_px, level.height_px), (160, 120), "{name}");
        // A drawing in dark lines on light paper.
        let light = (0..120).flat_map(|y| (0..160).map(move |x| (x, y))).filter(|&(x, y)| level.pixel(x, y)[0] > 128);
        let share = light.count() as f64 / (160.0 * 120.0);
        assert!((0.5..0.99).contains(&share), "{name}: {share} of it is light");
    }
}

#[test]
fn palettes_of_every_depth_are_read() {
    // Red, green, blue, white; the rest black.
    let colours = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]];
    for kind in KINDS {
        for bits in [2, 4, 8] {
            for scale in [257, 1] {
                let levels = |channel: usize| {
                    (0..1usize << bits).map(move |i| colours.get(i).map_or(0, |colour| colour[channel]) * scale)
                };
                let mut fields = fields(4, 2, &[bits], 1, 3);
                fields.push((320, (0..3).flat_map(levels).collect()));
                let rows = [packed(bits, &[0, 1, 2, 3]), packed(bits, &[3, 2, 1, 0])].concat();
                let level = full(&tiff(kind, &[(fields, rows)]));
                assert_eq!((level.width_px, level.height_px, level.samples), (4, 2, Samples::Rgb));
                let expected: Vec<u8> = [0usize, 1, 2, 3, 3, 2, 1, 0]
                    .into_iter()
                    .flat_map(|i| colours[i].map(|value| value as u8))
                    .collect();
                assert_eq!(level.data, expected, "{bits} bits");
            }
        }
    }
    let mut short = fields(4, 1, &[8], 1, 3);
    short.push((320, vec![0; 300]));
    assert!(refused(&tiff(Kind::Little, &[(short, vec![0; 4])]), 1).what.contains("palette"));
}

#[test]
fn scans_of_any_depth_reach_from_black_to_white() {
    for kind in KINDS {
        for bits in [2, 4, 10, 12, 14] {
            let most = (1 << bits) - 1;
            for (photometric, expected) in [(1, [0, 127, 255, 255]), (0, [255, 128, 0, 0])] {
                let fields = fields(4, 2, &[bits], 1, photometric);
                let row = packed(bits, &[0, most / 2, most, most]);
                let level = full(&tiff(kind, &[(fields, [row.clone(), row].concat())]));
                assert_eq!(level.samples, Samples::Grey);
                for (value, expected) in level.data[..4].iter().zip(expected) {
                    assert!(value.abs_diff(expected) <= if bits < 8 { 43 } else { 1 }, "{bits}: {:?}", level.data);
                }
                assert_eq!((level.data[0], level.data[2]), (expected[0], expected[2]));
            }
        }
        // In colour, and in words of 16 bits of which only 12 are used.
        let level = full(&tiff(kind, &[(fields(2, 1, &[12; 3], 1, 2), packed(12, &[4095, 0, 0, 0, 4095, 4095]))]));
        assert_eq!(level.data, [255, 0, 0, 0, 255, 255]);
        for (photometric, expected) in [(1, [0, 127, 255]), (0, [255, 128, 0])] {
            let words: Vec<u8> = [0u16, 2047, 4095]
                .iter()
                .flat_map(|word| if kind == Kind::Big { word.to_be_bytes() } else { word.to_le_bytes() })
                .collect();
            let level = full(&tiff(kind, &[(fields(3, 1, &[16], 1, photometric), words)]));
            assert_eq!(level.data, expected);
        }
    }
    // The same in a PNG; one that uses all of its bits, or is all black, stays as it is.
    let png = |values: [u16; 3]| {
        let image = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(3, 1, values.to_vec()).unwrap();
        full(&encoded(&DynamicImage::ImageLuma16(image), ImageFormat::Png)).data
    };
    assert_eq!(png([0, 2048, 4095]), [0, 128, 255]);
    assert_eq!(png([0, 2048, 65_535]), [0, 8, 255]);
    assert_eq!(png([0, 0, 0]), [0, 0, 0]);
}

/// Bits as bytes, with zeros behind them.
fn bits(text: &str) -> Vec<u8> {
    let digits: Vec<u32> = text.chars().filter_map(|digit| digit.to_digit(2)).collect();
    packed(1, &digits)
}

#[test]
fn every_compression_of_fax_machines_is_read() {
    // Runs of 4 white, 8 black, 4 white (ITU-T T.4, tables 2 and 3), twice.
    let row = "1011 000101 1011";
    let (end, pass) = ("000000000001", "111");
    let group_3 = format!("{end}{row}{end}{row}{}", end.repeat(6));
    // The second row is the first one, said by its changes: each right below (T.4, table 4).
    let two_way = format!("{end}1{row}{end}0{pass}{}", format!("{end}1").repeat(6));
    let runs = [bits(row), bits(row)].concat();
    let sheet = |compression: u32, options: &[Field], data: Vec<u8>, photometric: u32| {
        let mut fields = fields(16, 2, &[1], compression, photometric);
        fields.extend_from_slice(options);
        tiff(Kind::Little, &[(fields, data)])
    };
    let reversed = |bytes: &[u8]| bytes.iter().map(|byte| byte.reverse_bits()).collect::<Vec<u8>>();
    // The changes of both rows, the first against a white one: horizontal mode, then right below (T.6).
    let group_4 = bits(&format!("001 1011 000101 1 {pass} 000000000001 000000000001"));
    let row: Vec<u8> = [[255; 4], [0; 4], [0; 4], [255; 4]].concat();
    let expected = [row.clone(), row].concat();
    let negative: Vec<u8> = expected.iter().map(|level| 255 - level).collect();
    for (name, file, expected) in [
        ("runs", sheet(2, &[], runs.clone(), 0), &expected),
        ("group 3", sheet(3, &[], bits(&group_3), 0), &expected),
        ("group 3, negative", sheet(3, &[], bits(&group_3), 1), &negative),
        ("group 3, both ways", sheet(3, &[(292, vec![1])], bits(&two_way), 0), &expected),
        ("group 3, lowest bit first", sheet(3, &[(266, vec![2])], reversed(&bits(&group_3)), 0), &expected),
        ("group 4", sheet(4, &[], group_4.clone(), 0), &expected),
        ("group 4, lowest bit first", sheet(4, &[(266, vec![2])], reversed(&group_4), 0), &expected),
    ] {
        let level = full(&file);
        assert_eq!((level.width_px, level.height_px), (16, 2), "{name}");
        assert_eq!(level.data, *expected, "{name}");
    }
    let error = refused(&sheet(2, &[], runs[..2].to_vec(), 0), 1);
    assert!(error.what.contains("1 of its 2 rows are missing"), "{error}");
}

#[test]
fn pages_are_counted_and_shown() {
    let file = fixture("tiff-two-pages.tif");
    let pages = [1, 2].map(|page| decode_picture(&file, page).unwrap());
    assert_eq!(pages.each_ref().map(|page| page.pages), [2, 2]);
    assert_ne!(pages[0].levels.all()[0].data, pages[1].levels.all()[0].data);
    for page in [0, 3, 9] {
        let error = refused(&file, page);
        assert!(error.what.contains(&format!("2 pages, and none with the number {page}")), "{error}");
    }
    // So for kinds that have no pages.
    let png = encoded(&walls(), ImageFormat::Png);
    assert!(refused(&png, 2).what.contains("one page"));
    // A small copy for previews is no page.
    for kind in KINDS {
        let page = |value: u8| (fields(2, 1, &[8], 1, 1), vec![value; 2]);
        let mut small = page(9);
        small.0.push((254, vec![1]));
        let file = tiff(kind, &[page(1), small, page(2)]);
        let read = |number: u32| decode_picture(&file, number).unwrap();
        assert_eq!((read(1).pages, read(2).pages), (2, 2));
        assert_eq!([read(1), read(2)].map(|page| page.levels.all()[0].data[0]), [1, 2]);
    }
}

#[test]
fn directories_that_go_round_or_nowhere_end() {
    let page = (fields(2, 1, &[8], 1, 1), vec![7; 2]);
    let sound = tiff(Kind::Little, &[page.clone(), page]);
    for at in 0..sound.len() {
        for value in [0, 1, 8, 0xff] {
            let mut changed = sound.clone();
            changed[at] = value;
            for page in [1, 2] {
                let _ = decode_picture(&changed, page);
            }
        }
    }
    for length in 0..sound.len() {
        let _ = decode_picture(&sound[..length], 2);
    }
}
