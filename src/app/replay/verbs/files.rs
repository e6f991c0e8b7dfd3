//! Plans, and answers to dialogs that ask for files.

use std::path::Path;

use super::{Group, Verb};
use crate::app::replay::script::Act;
use crate::app::replay::words::{Words, written};

pub(super) const GROUP: Group = Group {
    title: "Files",
    verbs: &[
        Verb {
            name: "drop",
            form: "drop PATH",
            help: "Drops a copy of a file on the window.",
            parse: |words| {
                let path = words.text("the path")?.to_owned();
                Ok(Box::new(move |stage| {
                    let copy = stage.folders.brought_in(&path)?;
                    stage.window.drop_file(&copy);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "hover-file",
            form: "hover-file [PATH]",
            help: "Holds a file over the window; without a path takes it away.",
            parse: |words| {
                let path = words.next().map(|word| word.text.clone());
                Ok(Box::new(move |stage| {
                    stage.window.hover_file(path.as_deref().map(Path::new));
                    Ok(())
                }))
            },
        },
        Verb {
            name: "file-dialog",
            form: "file-dialog open PATH | save PATH | cancel",
            help: "What the next dialog that asks for a file will be told; stands before the step that brings it up.",
            parse: file_dialog,
        },
        Verb {
            name: "open-missing",
            form: "open-missing PATH",
            help: "Opens a file that is not there, to see what the window says.",
            parse: |words| {
                let path = words.text("the path")?.to_owned();
                Ok(Box::new(move |stage| {
                    stage.window.open(&stage.folders.work.join(&path));
                    Ok(())
                }))
            },
        },
    ],
};

fn file_dialog(words: &mut Words<'_>) -> Result<Act, String> {
    if words.keyword("cancel") {
        return Ok(Box::new(|stage| {
            stage.window.answer_dialog(None);
            Ok(())
        }));
    }
    let is_open = match words.text("what is answered")? {
        "open" => true,
        "save" => false,
        other => return Err(format!("a dialog is told open PATH, save PATH or cancel, not {}", written(other))),
    };
    let path = words.text("the path")?.to_owned();
    Ok(Box::new(move |stage| {
        let path = if is_open { stage.folders.brought_in(&path)? } else { stage.folders.to_write(&path)? };
        stage.window.answer_dialog(Some(path));
        Ok(())
    }))
}
