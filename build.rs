//! Lists what comes with the program, so that putting a file into a folder of `assets` is all it takes.

#![allow(clippy::print_stdout, reason = "this is how a build script talks to cargo")]

use std::path::{Path, PathBuf};

/// Folders of `assets`, the ending of the files taken from each, and whether they are packed, as zlib does.
/// `OUT_DIR/{folder}.rs` becomes a list of them: the name without the ending, and the text or the packed bytes.
const LISTS: [(&str, &str, bool); 2] = [("models", ".model.json", true), ("schemes", ".scheme.toml", false)];

/// How hard to pack, 1..=10: above 6 takes several times as long for a twentieth less.
const LEVEL: u8 = 6;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    for (name, ending, is_packed) in LISTS {
        let folder = root.join("assets").join(name);
        println!("cargo::rerun-if-changed={}", folder.display());
        let mut list = String::new();
        for (stem, path) in files(&folder, ending)? {
            if is_packed {
                let packed = out.join(format!("{stem}.zlib"));
                write(&packed, &miniz_oxide::deflate::compress_to_vec_zlib(&std::fs::read(&path)?, LEVEL))?;
                list += &format!("({stem:?}, include_bytes!({packed:?})),\n");
            } else {
                list += &format!("({stem:?}, include_str!({path:?})),\n");
            }
        }
        write(&out.join(format!("{name}.rs")), format!("&[\n{list}]\n").as_bytes())?;
    }
    Ok(())
}

/// Writes a file of the build's own: nobody's work is lost with it.
#[allow(clippy::disallowed_methods, reason = "see above")]
fn write(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    std::fs::write(path, bytes)
}

/// The files of a folder with an ending, by name.
fn files(folder: &Path, ending: &str) -> std::io::Result<Vec<(String, PathBuf)>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if let Some(stem) = name.strip_suffix(ending) {
            files.push((stem.to_owned(), path));
        }
    }
    files.sort();
    Ok(files)
}
