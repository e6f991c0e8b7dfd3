//! The manual's page of commands, and `enfilade commands`, agree with the table.

use std::path::Path;

use enfilade::app::commands::COMMANDS;
use enfilade::cli::{Terminal, run};

/// What the program prints, and its exit code.
fn printed(arguments: &[&str]) -> (String, u8) {
    let out = tempfile::NamedTempFile::new().unwrap();
    let mut terminal = Terminal::new(out.reopen().unwrap(), std::io::sink());
    let words = ["enfilade", "commands"].iter().chain(arguments).map(std::ffi::OsString::from);
    let code = run(words, &mut terminal);
    drop(terminal);
    (std::fs::read_to_string(out.path()).unwrap(), code)
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
fn the_manual_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/commands.md");
    let (page, code) = printed(&["--markdown"]);
    assert_eq!(code, 0);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    let difference = page.lines().zip(written.lines()).find(|(is, was)| is != was);
    assert!(page == written, "docs/commands.md is stale at {difference:?}: run with UPDATE_GOLDEN=1");
}

#[test]
fn the_list_has_every_command() {
    let (text, code) = printed(&[]);
    assert_eq!(code, 0);
    assert_eq!(text.lines().count(), COMMANDS.len());
    assert!(text.lines().any(|line| line.starts_with("open PATH [STOREY] ") && line.contains("  Ctrl+O ")), "{text}");
    let (text, code) = printed(&["--json"]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let commands = json["commands"].as_array().unwrap();
    assert_eq!((code, commands.len()), (0, COMMANDS.len()));
    let redo = commands.iter().find(|command| command["id"] == "redo").unwrap();
    assert_eq!(redo["keys"], serde_json::json!(["Ctrl+Shift+Z", "Ctrl+Y"]));
    let towards = commands.iter().find(|command| command["id"] == "pick-towards").unwrap();
    assert_eq!(towards["arguments"][0]["words"], serde_json::json!(["left", "right", "up", "down"]));
    assert_eq!(towards["menu"], serde_json::Value::Null);
}
