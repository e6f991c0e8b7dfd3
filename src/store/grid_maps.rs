//! Grid maps from files: a `map_server` map, or a plain picture.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::robot::Pose;
use crate::robot::grid_map::GridMap;
use crate::robot::map_server::{self, MapServerError, PictureReading};
use crate::store::pictures;

/// The largest picture file read: 256 MB, several times the most cells in 16 bits.
const LARGEST_PICTURE_BYTES: u64 = 256 << 20;

/// Why a map cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapFileError {
    pub path: PathBuf,
    /// What is wrong, and what to do.
    pub what: String,
}

impl std::fmt::Display for MapFileError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.what)
    }
}

impl std::error::Error for MapFileError {}

/// Whether a file is a map's YAML file, judging by its name.
pub fn is_map_yaml(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("yaml") || ending.eq_ignore_ascii_case("yml"))
}

/// Reads a `map_server` map, given its YAML file.
///
/// # Errors
/// When the file or the picture it names cannot be read or used; the error names the file at fault.
pub fn load_map(path: &Path) -> Result<GridMap, MapFileError> {
    let bytes = bytes_of(path, map_server::LARGEST_DESCRIPTION_BYTES as u64)?;
    let fail = |error: MapServerError| MapFileError { path: path.to_owned(), what: error.0 };
    let read = map_server::description(&String::from_utf8_lossy(&bytes)).map_err(fail)?;
    let picture = path.parent().unwrap_or(Path::new("")).join(&read.image);
    if !picture.is_file() {
        let what = format!("its picture {} does not exist; put it beside the YAML file", picture.display());
        return Err(MapFileError { path: path.to_owned(), what });
    }
    map_of(&picture, read.resolution_m, read.origin, read.reading)
}

/// Reads a plain picture as a map with its lower left corner at the origin.
///
/// # Errors
/// When the picture cannot be read or used, or the resolution is invalid.
pub fn load_picture_as_map(path: &Path, resolution_m: f64, reading: PictureReading) -> Result<GridMap, MapFileError> {
    map_of(path, resolution_m, Pose::IDENTITY, reading)
}

fn map_of(path: &Path, resolution_m: f64, origin: Pose, reading: PictureReading) -> Result<GridMap, MapFileError> {
    let fail = |what: String| MapFileError { path: path.to_owned(), what };
    let bytes = bytes_of(path, LARGEST_PICTURE_BYTES)?;
    let picture = pictures::decode_pixels(&bytes).map_err(|error| {
        fail(format!("no picture that can be read: it {}; a map's picture is a PGM or PNG file", error.what))
    })?;
    let (width, height, cells) = map_server::picture_cells(&picture, reading).map_err(|error| fail(error.0))?;
    GridMap::new(width, height, resolution_m, origin, cells).map_err(|error| fail(error.to_string()))
}

fn bytes_of(path: &Path, most: u64) -> Result<Vec<u8>, MapFileError> {
    let fail = |what: String| MapFileError { path: path.to_owned(), what };
    let file = std::fs::File::open(path).map_err(|error| fail(error.to_string()))?;
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes).map_err(|error| fail(error.to_string()))?;
    if bytes.len() as u64 > most {
        return Err(fail(format!("the file is larger than {} MB; is it another file?", most >> 20)));
    }
    Ok(bytes)
}
