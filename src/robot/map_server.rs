//! Maps in the format of the ROS `map_server`: a YAML description and a picture, from bytes and to bytes.
//! Format: wiki.ros.org/map_server and `nav2_map_server` (map_io.cpp).

use serde::Deserialize;

use super::Pose;
use super::grid_map::{Cell, GridMap, GridMapError};
use crate::picture::{Level, Samples};

/// The contents of a map's YAML file.
#[derive(Clone, Debug, PartialEq)]
pub struct MapDescription {
    /// The picture's file, beside the YAML file.
    pub image: String,
    /// Side of a pixel in metres.
    pub resolution_m: f64,
    /// The pose of the picture's lower left corner in the map's frame.
    pub origin: Pose,
    pub reading: PictureReading,
}

/// How pixels are turned into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureReading {
    /// Cells more likely occupied than this are occupied, 0..=1.
    pub occupied_thresh: f64,
    /// Cells less likely occupied than this are free, 0..=1.
    pub free_thresh: f64,
    /// Inverted: light pixels are occupied, dark ones free.
    pub negate: bool,
    pub mode: MapMode,
}

impl PictureReading {
    /// The defaults of `map_server`.
    pub const MAP_SERVER: Self =
        Self { occupied_thresh: 0.65, free_thresh: 0.196, negate: false, mode: MapMode::Trinary };

    /// For plain pictures: only white is free. Furniture and unknown space are often drawn in light greys
    /// that `map_server` would take as free.
    pub const PLAIN_PICTURE: Self = Self { free_thresh: 0.02, ..Self::MAP_SERVER };
}

/// How probabilities between the thresholds are interpreted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MapMode {
    /// They are unknown.
    #[default]
    Trinary,
    /// Like trinary, and pixels that are not opaque are unknown.
    Scale,
    /// Pixels are percentages, 0 to 100; others are unknown.
    Raw,
}

/// Why a map cannot be read: what is wrong, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapServerError(pub String);

impl std::fmt::Display for MapServerError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for MapServerError {}

impl From<GridMapError> for MapServerError {
    fn from(error: GridMapError) -> Self {
        Self(error.to_string())
    }
}

fn wrong<T>(what: impl Into<String>) -> Result<T, MapServerError> {
    Err(MapServerError(what.into()))
}

/// The maximum size in bytes: a map's YAML file has a dozen lines, so a larger file is something else.
pub const LARGEST_DESCRIPTION_BYTES: usize = 1 << 20;

/// The file as written. Unknown keys are ignored, as in `map_server`.
#[derive(Deserialize)]
struct Keys {
    image: String,
    resolution: f64,
    origin: Vec<f64>,
    occupied_thresh: Option<f64>,
    free_thresh: Option<f64>,
    negate: Option<Flag>,
    mode: Option<MapMode>,
}

/// 0 and 1 are usual; newer files use true and false.
#[derive(Deserialize)]
#[serde(untagged)]
enum Flag {
    Bool(bool),
    Number(i64),
}

/// Reads a map's YAML file.
///
/// # Errors
/// When it is not valid YAML, a key is missing or out of range, or the picture it names is not in its
/// folder.
pub fn description(text: &str) -> Result<MapDescription, MapServerError> {
    if text.len() > LARGEST_DESCRIPTION_BYTES {
        return wrong("this is too large for the YAML file of a map; is it another file?");
    }
    let keys: Keys = serde_saphyr::from_str(text).map_err(|error| {
        let error = error.to_string();
        let first = error.lines().next().unwrap_or_default().trim_start_matches("error: ");
        MapServerError(format!("no map of map_server: {first}; the file must give image, resolution and origin"))
    })?;
    let standard = PictureReading::MAP_SERVER;
    let reading = PictureReading {
        occupied_thresh: keys.occupied_thresh.unwrap_or(standard.occupied_thresh),
        free_thresh: keys.free_thresh.unwrap_or(standard.free_thresh),
        negate: match keys.negate {
            None => false,
            Some(Flag::Bool(negate)) => negate,
            Some(Flag::Number(number @ (0 | 1))) => number == 1,
            Some(Flag::Number(number)) => return wrong(format!("negate is {number}; it can be 0 or 1")),
        },
        mode: keys.mode.unwrap_or_default(),
    };
    reading.check()?;
    let (x, y, yaw) = match keys.origin.as_slice() {
        &[x, y] => (x, y, 0.0),
        &[x, y, yaw] => (x, y, yaw),
        other => return wrong(format!("the origin has {} numbers; it must be [x, y, yaw]", other.len())),
    };
    check_is_beside(&keys.image)?;
    let origin = Pose::new(x, y, yaw);
    // Resolution and origin are checked before looking for the picture.
    GridMap::new(1, 1, keys.resolution, origin, vec![Cell::Unknown])?;
    Ok(MapDescription { image: keys.image, resolution_m: keys.resolution, origin, reading })
}

impl PictureReading {
    /// # Errors
    /// When the thresholds are out of order or outside 0..=1.
    pub fn check(&self) -> Result<(), MapServerError> {
        let (free, occupied) = (self.free_thresh, self.occupied_thresh);
        if 0.0 <= free && free < occupied && occupied <= 1.0 {
            return Ok(());
        }
        wrong(format!(
            "free_thresh {free} and occupied_thresh {occupied} are not possible; they must be between 0 and 1, free_thresh the smaller"
        ))
    }
}

/// A picture must be in the folder of the file that names it, or below: a map from elsewhere cannot make
/// us read other files.
fn check_is_beside(image: &str) -> Result<(), MapServerError> {
    use std::path::{Component, Path};
    let is_plain = |component| matches!(component, Component::Normal(_) | Component::CurDir);
    let leaves = image.contains('\\') || image.contains('\0') || !Path::new(image).components().all(is_plain);
    if image.trim().is_empty() {
        return wrong("image names no file; give the picture's name");
    }
    if leaves {
        return wrong(format!(
            "the picture '{image}' is not in the map's folder; put it beside the YAML file and name it without folders"
        ));
    }
    Ok(())
}

/// The cells of a map's picture.
///
/// # Errors
/// When it has too many pixels.
pub fn picture_cells(picture: &Level, reading: PictureReading) -> Result<(usize, usize, Vec<Cell>), MapServerError> {
    reading.check()?;
    let (width, height) = (picture.width_px as usize, picture.height_px as usize);
    GridMap::check_size(width, height)?;
    // The mean of the channels, as map_server takes it.
    let mean = |red: u8, green: u8, blue: u8| (f64::from(red) + f64::from(green) + f64::from(blue)) / (3.0 * 255.0);
    let cells = match picture.samples {
        Samples::Grey => {
            // One lookup a shade: most maps are grey with 8 bits.
            let of_shade: Vec<Cell> =
                (0..=u8::MAX).map(|shade| cell(f64::from(shade) / 255.0, true, reading)).collect();
            picture.data.iter().map(|&shade| of_shade[usize::from(shade)]).collect()
        }
        Samples::Rgb => picture.data.chunks_exact(3).map(|p| cell(mean(p[0], p[1], p[2]), true, reading)).collect(),
        Samples::Rgba => {
            picture.data.chunks_exact(4).map(|p| cell(mean(p[0], p[1], p[2]), p[3] == u8::MAX, reading)).collect()
        }
    };
    Ok((width, height, cells))
}

/// `shade` is from 0, black, to 1, white.
fn cell(shade: f64, is_opaque: bool, reading: PictureReading) -> Cell {
    let taken = match reading.mode {
        MapMode::Trinary => None,
        MapMode::Scale if !is_opaque => return Cell::Unknown,
        MapMode::Scale => None,
        MapMode::Raw => match (shade * 255.0).round() {
            percent if percent <= 100.0 => Some(percent / 100.0),
            _ => return Cell::Unknown,
        },
    };
    let taken = taken.unwrap_or(if reading.negate { shade } else { 1.0 - shade });
    if taken > reading.occupied_thresh {
        Cell::Occupied
    } else if taken < reading.free_thresh {
        Cell::Free
    } else {
        Cell::Unknown
    }
}

/// A map's picture as written by `map_server`: PGM (P5), free 254, occupied 0, unknown 205.
pub fn pgm(map: &GridMap) -> Vec<u8> {
    let mut bytes = format!("P5\n{} {}\n255\n", map.width(), map.height()).into_bytes();
    bytes.extend(map.cells().iter().map(|cell| match cell {
        Cell::Free => 254u8,
        Cell::Occupied => 0,
        Cell::Unknown => 205,
    }));
    bytes
}

/// The YAML file for [`pgm`]. `semantics` names the file that says what the rooms are; `map_server`
/// ignores that key.
pub fn yaml(map: &GridMap, image: &str, semantics: &str) -> Result<String, MapServerError> {
    #[derive(serde::Serialize)]
    struct Written<'a> {
        image: &'a str,
        mode: &'a str,
        resolution: f64,
        origin: [f64; 3],
        negate: u8,
        occupied_thresh: f64,
        free_thresh: f64,
        semantics: &'a str,
    }
    let reading = PictureReading::MAP_SERVER;
    let origin = map.map_from_grid;
    let written = Written {
        image,
        mode: "trinary",
        resolution: map.resolution_m,
        origin: [origin.x_m, origin.y_m, origin.heading_rad],
        negate: 0,
        occupied_thresh: reading.occupied_thresh,
        free_thresh: reading.free_thresh,
        semantics,
    };
    serde_saphyr::to_string(&written).map_err(|error| MapServerError(error.to_string()))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use proptest::prelude::*;

    use super::*;

    /// The cells of a picture's file.
    fn cells_of(bytes: &[u8], reading: PictureReading) -> Result<(usize, usize, Vec<Cell>), String> {
        let picture = crate::store::pictures::decode_pixels(bytes).map_err(|error| error.to_string())?;
        picture_cells(&picture, reading).map_err(|error| error.to_string())
    }

    const YAML: &str = "image: floor.pgm\nresolution: 0.05\norigin: [-10.0, -2.5, 0.1]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\nmode: scale\n";

    #[test]
    fn all_keys_are_read() {
        let read = description(YAML).unwrap();
        assert_eq!(read.image, "floor.pgm");
        assert_eq!(read.origin, Pose::new(-10.0, -2.5, 0.1));
        let reading = PictureReading { occupied_thresh: 0.65, free_thresh: 0.25, negate: false, mode: MapMode::Scale };
        assert_eq!(read.reading, reading);
    }

    #[test]
    fn what_a_map_cannot_be_is_refused_with_the_reason() {
        let said = |change: (&str, &str)| description(&YAML.replace(change.0, change.1)).unwrap_err().0;
        for (change, word) in [
            (("image: floor.pgm\n", ""), "image"),
            (("floor.pgm", "../secret.pgm"), "folder"),
            (("floor.pgm", "/etc/passwd"), "folder"),
            (("floor.pgm", "a/../../b.pgm"), "folder"),
            (("floor.pgm", "''"), "no file"),
            (("resolution: 0.05", "resolution: 0"), "resolution"),
            (("resolution: 0.05", "resolution: .nan"), "resolution"),
            (("resolution: 0.05", "resolution: wide"), "no map"),
            (("[-10.0, -2.5, 0.1]", "[-10.0]"), "origin"),
            (("[-10.0, -2.5, 0.1]", "[.inf, 0, 0]"), "origin"),
            (("[-10.0, -2.5, 0.1]", "[0, 0, 0, 0]"), "origin"),
            (("free_thresh: 0.25", "free_thresh: 0.9"), "free_thresh"),
            (("negate: 0", "negate: 7"), "negate"),
            (("mode: scale", "mode: fancy"), "no map"),
        ] {
            assert!(said(change).contains(word), "{change:?}: {}", said(change));
        }
        assert!(description("").is_err() && description("[1, 2]").is_err() && description("\0").is_err());
        assert!(description(&"#".repeat(LARGEST_DESCRIPTION_BYTES + 1)).unwrap_err().0.contains("too large"));
    }

    #[test]
    fn both_kinds_of_pgm_give_the_same_cells() {
        let plain = b"P2\n# a comment\n3 1\n255\n254 0 205\n";
        let raw = b"P5\n3 1\n255\n\xfe\x00\xcd";
        let cells = vec![Cell::Free, Cell::Occupied, Cell::Unknown];
        for bytes in [&plain[..], &raw[..]] {
            assert_eq!(cells_of(bytes, PictureReading::MAP_SERVER).unwrap(), (3, 1, cells.clone()));
        }
    }

    #[test]
    fn modes_and_negation_are_those_of_map_server() {
        let of = |shade: u8, reading| cell(f64::from(shade) / 255.0, true, reading);
        let standard = PictureReading::MAP_SERVER;
        let negated = PictureReading { negate: true, ..standard };
        assert_eq!((of(254, standard), of(254, negated)), (Cell::Free, Cell::Occupied));
        let raw = PictureReading { mode: MapMode::Raw, ..standard };
        assert_eq!(
            [0, 50, 100, 205].map(|shade| of(shade, raw)),
            [Cell::Free, Cell::Unknown, Cell::Occupied, Cell::Unknown]
        );
        let scale = PictureReading { mode: MapMode::Scale, ..standard };
        assert_eq!(cell(1.0, false, scale), Cell::Unknown);
        assert_eq!(cell(1.0, true, scale), Cell::Free);
    }

    #[test]
    fn a_huge_picture_is_refused_before_it_is_read() {
        let error = cells_of(b"P5\n20000 20000\n255\n\x00", PictureReading::MAP_SERVER).unwrap_err();
        assert!(error.contains("20000 x 20000"), "{error}");
    }

    #[test]
    fn what_is_written_is_read_again() {
        let cells = vec![Cell::Free, Cell::Occupied, Cell::Unknown, Cell::Free, Cell::Free, Cell::Unknown];
        let map = GridMap::new(3, 2, 0.05, Pose::new(-1.5, 2.0, 0.25), cells).unwrap();
        let read = description(&yaml(&map, "a b.pgm", "a b_semantics.yaml").unwrap()).unwrap();
        assert_eq!((read.image.as_str(), read.resolution_m, read.origin), ("a b.pgm", 0.05, map.map_from_grid));
        let (width, height, cells) = cells_of(&pgm(&map), read.reading).unwrap();
        assert_eq!((width, height, cells.as_slice()), (3, 2, map.cells()));
    }

    proptest! {
        // Mutations of valid files: a result or an error, never a panic.
        #[test]
        fn changed_bytes_never_panic(
            changes in proptest::collection::vec((0usize..400, any::<u8>()), 1..12), cut in 0usize..400,
        ) {
            let map = GridMap::new(16, 8, 0.05, Pose::IDENTITY, vec![Cell::Free; 128]).unwrap();
            let mut png = Vec::new();
            image::GrayImage::from_pixel(9, 7, image::Luma([254]))
                .write_to(&mut Cursor::new(&mut png), image::ImageFormat::Png)
                .unwrap();
            let plain = b"P2\n4 2\n255\n254 0 205 254\n254 0 205 254\n".to_vec();
            for mut bytes in [YAML.as_bytes().to_vec(), pgm(&map), plain, png] {
                for &(at, byte) in &changes {
                    let at = at % bytes.len();
                    bytes[at] = byte;
                }
                bytes.truncate(if cut < bytes.len() / 2 { bytes.len() } else { cut });
                if let Ok(read) = description(&String::from_utf8_lossy(&bytes)) {
                    // 'floor..pgm' is a name like any other.
                    let leads_out = read.image.split(['/', '\\']).any(|part| part == "..");
                    prop_assert!(read.resolution_m.is_finite() && !leads_out, "{}", read.image);
                }
                for mode in [MapMode::Trinary, MapMode::Scale, MapMode::Raw] {
                    let reading = PictureReading { mode, ..PictureReading::MAP_SERVER };
                    if let Ok((width, height, cells)) = cells_of(&bytes, reading) {
                        prop_assert_eq!(width * height, cells.len());
                    }
                }
            }
        }
    }
}
