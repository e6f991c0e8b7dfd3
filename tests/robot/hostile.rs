//! Logs and maps as they come from a broken disk or an unfriendly hand, through the commands: each ends with a result
//! or with a message that names the file and the line or key.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]

use std::path::Path;

use enfilade::base::random::Random;

use crate::support::enfilade;

/// What `enfilade map` says of a log.
fn map(text: &str) -> (u8, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let (log, out) = (folder.path().join("drive.log"), folder.path().join("out"));
    std::fs::write(&log, text).unwrap();
    enfilade(["map", log.to_str().unwrap(), "-o", out.to_str().unwrap()])
}

/// A scan of 90 beams in a square room, from so far along, at so many seconds.
fn scan(message: &str, x: f64, time: f64) -> String {
    let ranges: Vec<String> = (0..90)
        .map(|beam| {
            let angle = f64::from(beam).mul_add(2.0, -89.0).to_radians();
            let (to_end, to_side) = ((4.0 - x) / angle.cos(), 2.0 / angle.sin().abs().max(1e-3));
            format!("{:.3}", to_end.min(to_side))
        })
        .collect();
    format!("{message} 90 {} {x} 0 0 {x} 0 0 {time} host {time}\n", ranges.join(" "))
}

#[test]
fn each_break_in_a_log_is_told_with_file_and_line() {
    let sound: Vec<String> = (0..5).map(|at| scan("FLASER", 0.2 * f64::from(at), f64::from(at))).collect();
    let with = |line: &str| format!("{}{line}{}", sound[..2].concat(), sound[2..].concat());
    let cut = &sound[1][..sound[1].len() / 2];
    // No number where the robot stands; in a reading it is one beam without return.
    let nan = sound[1].replace("0 0 1 host", "nan 0 1 host");
    let cases = [
        (with(&format!("{cut}\n")), "line 3: stops before its last field"),
        (with(&nan), "line 3: a field is not a finite number"),
        (with("FLASER 999999999 1 2 3\n"), "line 3: says it has more readings than any scanner gives"),
        (with(&scan("FLASER", 0.3, -50.0)), "line 3: its time lies before that of the line above"),
        (with("ODOM 900 0 0 0 0 0 1.5 host 0\n"), "the odometry jumps"),
    ];
    for (text, what) in cases {
        let (code, out, err) = map(&text);
        assert!(code == 0 && err.contains("drive.log: ") && err.contains(what), "{what}: {out}{err}");
    }
    // Another scanner amid the scans, with another number of beams, is one more scanner.
    let mixed = with(&format!("RLASER 3 1 1 1 0.2 0 0 0.2 0 0 1.2 host 1.2\n{}", scan("RLASER", 0.3, 1.4)));
    assert_eq!(map(&mixed).0, 0);
    let still = sound.concat().replace(" 0.2 0 0", " 0 0 0").replace(" 0.4 0 0", " 0 0 0");
    let still = still.replace(" 0.6000000000000001 0 0", " 0 0 0").replace(" 0.8 0 0", " 0 0 0");
    let (code, _, err) = map(&still);
    assert!(code == 0 && err.contains("drive.log: the odometry never moves"), "{err}");
    for (text, what) in [
        (String::new(), "no CARMEN log"),
        ("hello\nworld\n".to_owned(), "no CARMEN log"),
        ("ODOM 0 0 0 0 0 0 1 host 1\n".repeat(9), "no laser scan"),
        (format!("{cut}\n"), "no laser scan"),
    ] {
        let (code, _, err) = map(&text);
        assert!(code == 1 && err.contains("drive.log") && err.contains(what), "{what}: {err}");
    }
}

const YAML: &str = "image: floor.png\nresolution: 0.05\norigin: [-2.0, 1.0, 0.1]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n";

/// A room of 60 by 40 cells with a wall across.
fn picture() -> Vec<u8> {
    let mut image = image::GrayImage::from_pixel(70, 50, image::Luma([205]));
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        let is_free = (5..65).contains(&x) && (5..45).contains(&y) && (!(33..35).contains(&x) || (20..38).contains(&y));
        let is_near = (3..67).contains(&x) && (3..47).contains(&y);
        pixel.0 = [if is_free {
            254
        } else if is_near {
            0
        } else {
            205
        }];
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// What `enfilade segment` says of a map.
fn segment(folder: &Path, yaml: &[u8], picture: &[u8]) -> (u8, String, String) {
    let (map, out) = (folder.join("floor.yaml"), folder.join("out"));
    std::fs::write(&map, yaml).unwrap();
    std::fs::write(folder.join("floor.png"), picture).unwrap();
    enfilade(["segment", map.to_str().unwrap(), "--typology", "office", "--force", "-o", out.to_str().unwrap()])
}

#[test]
fn every_key_counts_in_every_mode() {
    let folder = tempfile::tempdir().unwrap();
    let rooms = |yaml: &str| {
        let (code, out, err) = segment(folder.path(), yaml.as_bytes(), &picture());
        assert_eq!(code, 0, "{yaml}: {err}");
        out.split(": ")
            .nth(1)
            .and_then(|rest| rest.split(' ').next())
            .and_then(|word| word.parse::<usize>().ok())
            .unwrap()
    };
    assert_eq!(rooms(YAML), 2);
    assert_eq!(rooms(&YAML.replace("trinary", "scale")), 2);
    // As percentages, black is free and every other shade of this picture is none: the band of the walls is a floor.
    assert_eq!(rooms(&YAML.replace("trinary", "raw")), 1);
    // The same the other way round: dark is free.
    assert_eq!(rooms(&YAML.replace("negate: 0", "negate: true")), 1);
    // Unknown space counts as free, too; walls still do not.
    assert!(rooms(&YAML.replace("free_thresh: 0.196", "free_thresh: 0.3")) >= 2);
    for (from, to, what) in [
        ("image: floor.png", "image: other.png", "other.png"),
        ("resolution: 0.05", "resolution: 0", "resolution"),
        ("resolution: 0.05", "resolution: .nan", "resolution"),
        ("origin: [-2.0, 1.0, 0.1]", "origin: [-2.0]", "origin"),
        ("origin: [-2.0, 1.0, 0.1]", "origin: [1e9, 0, 0]", "origin"),
        ("negate: 0", "negate: 7", "negate"),
        ("occupied_thresh: 0.65", "occupied_thresh: 0.1", "occupied_thresh"),
        ("free_thresh: 0.196", "free_thresh: -1", "free_thresh"),
        ("mode: trinary", "mode: fancy", "fancy"),
    ] {
        let (code, _, err) = segment(folder.path(), YAML.replace(from, to).as_bytes(), &picture());
        assert!(
            code == 1 && err.contains("floor.yaml") | err.contains("other.png") && err.contains(what),
            "{to}: {err}"
        );
    }
}

/// Whatever becomes of a map's two files, and of the semantic map beside them, the command ends in words.
#[test]
fn mutated_maps_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(segment(folder.path(), YAML.as_bytes(), &picture()).0, 0);
    let semantics = std::fs::read(folder.path().join("out/floor_semantics.yaml")).unwrap();
    let words: [&[u8]; 9] =
        [b"nan", b".inf", b"-1", b"1e308", b"[[[[", b"&a *a", b"\xff", b"99999999999999999999", b"raw"];
    for round in 0..120 {
        let mut random = Random::new(round);
        let mut mutated = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            for _ in 0..=random.below(3) {
                let at = random.below(bytes.len().max(1)).min(bytes.len());
                match random.below(4) {
                    0 => bytes.truncate(at),
                    1 if at < bytes.len() => bytes[at] = random.bits() as u8,
                    2 => drop(bytes.drain(at..(at + random.below(40)).min(bytes.len()))),
                    _ => drop(bytes.splice(at..at, words[random.below(words.len())].iter().copied())),
                }
            }
            bytes
        };
        let (yaml, pixels) = match round % 3 {
            0 => (mutated(YAML.as_bytes()), picture()),
            1 => (YAML.as_bytes().to_vec(), mutated(&picture())),
            _ => {
                std::fs::write(folder.path().join("out/floor_semantics.yaml"), mutated(&semantics)).unwrap();
                (YAML.as_bytes().to_vec(), picture())
            }
        };
        let (code, out, err) = segment(folder.path(), &yaml, &pixels);
        assert!(code == 0 || (code == 1 && err.contains("floor")), "round {round}: {code} {out}{err}");
        std::fs::write(folder.path().join("out/floor_semantics.yaml"), &semantics).unwrap();
    }
}
