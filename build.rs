//! Lists what comes with the program, so that putting a file into a folder of `assets` is all it takes.

#![allow(clippy::print_stdout, reason = "this is how a build script talks to cargo")]

use std::path::{Path, PathBuf};

/// Folders of `assets`, and the ending of the files taken from each. `OUT_DIR/{folder}.rs` becomes a list of
/// them: the name without the ending, and the text.
const LISTS: [(&str, &str); 2] = [("models", ".model.json"), ("schemes", ".scheme.toml")];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    for (name, ending) in LISTS {
        let folder = root.join("assets").join(name);
        println!("cargo::rerun-if-changed={}", folder.display());
        let file = |(stem, path): (String, PathBuf)| format!("({stem:?}, include_str!({path:?})),\n");
        let list: String = files(&folder, ending)?.into_iter().map(file).collect();
        #[allow(clippy::disallowed_methods, reason = "the build's own file: nobody's work is lost with it")]
        std::fs::write(out.join(format!("{name}.rs")), format!("&[\n{list}]\n"))?;
    }
    Ok(())
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
