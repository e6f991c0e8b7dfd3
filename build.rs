//! Lists what comes with the program, so that putting a file into a folder of `assets` is all it takes.

#![allow(clippy::print_stdout, reason = "this is how a build script talks to cargo")]

use std::path::{Path, PathBuf};

/// Folders of `assets`, the ending of the files taken from each, and whether they are packed, as zlib does.
/// `OUT_DIR/{folder}.rs` becomes a list of them: the name without the ending, and the text or the packed bytes.
const LISTS: [(&str, &str, bool); 3] =
    [("models", ".model.json", true), ("schemes", ".scheme.toml", false), ("words", ".words.toml", false)];

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
    println!("cargo::rustc-env=ENFILADE_VERSION={}", version(&root)?);
    Ok(())
}

/// '0.1.0 (commit 1a2b3c4d5e6f)': the package's version and, where it is known, the commit it is built from.
/// In a debug build the commit is the one of the day when this script last ran, since running it at each commit
/// would build all anew.
fn version(root: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let package = std::env::var("CARGO_PKG_VERSION")?;
    let is_debug = std::env::var("PROFILE")? == "debug";
    let Some(commit) = packaged_commit(root).or_else(|| git_commit(root, !is_debug)) else { return Ok(package) };
    let short = &commit[..commit.len().min(12)];
    Ok(if is_debug {
        format!("{package} (debug build, commit {short} or later)")
    } else {
        format!("{package} (commit {short})")
    })
}

/// What `cargo package` notes.
fn packaged_commit(root: &Path) -> Option<String> {
    let text = std::fs::read_to_string(root.join(".cargo_vcs_info.json")).ok()?;
    let (_, rest) = text.split_once("\"sha1\"")?;
    hash(rest.split('"').nth(1)?)
}

/// What git says, if it is there and this is the root of a repository of its own. `watches`: build again at a
/// commit.
fn git_commit(root: &Path, watches: bool) -> Option<String> {
    // A copy of the sources within another's repository is not of that one's commit.
    root.join(".git").exists().then_some(())?;
    let git = |arguments: &[&str]| {
        let output = std::process::Command::new("git").arg("-C").arg(root).args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        (output.status.success() && !text.is_empty()).then_some(text)
    };
    if watches {
        let branch = git(&["symbolic-ref", "-q", "HEAD"]);
        for name in ["HEAD", "packed-refs"].into_iter().chain(branch.as_deref()) {
            if let Some(path) = git(&["rev-parse", "--git-path", name]).map(|path| root.join(path))
                && path.exists()
            {
                println!("cargo::rerun-if-changed={}", path.display());
            }
        }
    }
    hash(&git(&["rev-parse", "HEAD"])?)
}

fn hash(text: &str) -> Option<String> {
    (text.len() >= 12 && text.bytes().all(|byte| byte.is_ascii_hexdigit())).then(|| text.to_owned())
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
