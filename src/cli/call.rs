//! The call that is being served, as manifests and models tell it.

use std::cell::RefCell;
use std::ffi::OsString;

thread_local! {
    /// The call that is being served, as one would type it.
    static COMMAND: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Remembers the words of the call (the program's name first).
pub fn remember_command(words: &[OsString]) {
    let words: Vec<String> = words.iter().skip(1).map(|word| quoted(&word.to_string_lossy())).collect();
    COMMAND.with_borrow_mut(|command| {
        *command = ["enfilade".to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
    });
}

/// The call that is being served, as one would type it into a POSIX shell.
pub fn command() -> String {
    COMMAND.with_borrow(String::clone)
}

/// A word as a POSIX shell takes it.
pub fn quoted(word: &str) -> String {
    let is_plain = !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "/._-,:=".contains(c));
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}
