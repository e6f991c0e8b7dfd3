//! Plans, and answers to dialogs that ask for files.

use std::path::Path;

use super::{Group, Verb};
use crate::app::replay::act::Act;
use crate::app::replay::fault::Fault;
use crate::app::replay::words::{Words, written};
use crate::formats;
use crate::store::save_bytes_fast;

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
            form: "file-dialog open PATH | save PATH | cancel | none",
            help: "What the next dialog that asks for a file will be told; stands before the step that brings it up. \
                   With `none` the system has no such dialogs from now on.",
            parse: file_dialog,
        },
        Verb {
            name: "journal",
            form: "journal",
            help: "Keeps a journal of unsaved changes from now on, in the script's own folder.",
            parse: |_| {
                Ok(Box::new(|stage| {
                    stage.keep_journal();
                    Ok(())
                }))
            },
        },
        Verb {
            name: "settings",
            form: "settings [FROM]",
            help: "Keeps settings from now on, in the script's own folder; at first those of the file FROM beside the \
                   script.",
            parse: |words| {
                let from = words.next().map(|word| word.text.clone());
                Ok(Box::new(move |stage| {
                    if let Some(from) = &from {
                        stage.folders.brought_in_as(from, super::super::stage::SETTINGS)?;
                    }
                    stage.keep_settings();
                    Ok(())
                }))
            },
        },
        Verb {
            name: "restart",
            form: "restart",
            help: "Closes the window and starts the program again, with the settings and journals that are kept.",
            parse: |_| Ok(Box::new(|stage| stage.restart())),
        },
        Verb {
            name: "crash",
            form: "crash",
            help: "Ends the program as a power cut does, and starts it again; with a journal, as after `journal`.",
            parse: |_| {
                Ok(Box::new(|stage| {
                    stage.crash();
                    Ok(())
                }))
            },
        },
        Verb {
            name: "somebody-saves",
            form: "somebody-saves PATH FROM",
            help: "Puts what the file FROM beside the script holds into a file that the script opened or saved, as \
                   another program does.",
            parse: |words| {
                let (path, from) = (words.text("the path")?.to_owned(), words.text("the other file")?.to_owned());
                Ok(Box::new(move |stage| {
                    let target = stage.folders.to_write(&path)?;
                    let fault = |what: String| Fault::new(format!("{from}: {what}"));
                    let source = stage.folders.script.join(&from);
                    let bytes = formats::read_bytes(&source).map_err(|error| fault(error.to_string()))?;
                    save_bytes_fast(&target, &bytes).map_err(|error| fault(error.to_string()))
                }))
            },
        },
        Verb {
            name: "somebody-removes",
            form: "somebody-removes PATH",
            help: "Removes a file that the script opened or saved, as another program does.",
            parse: |words| {
                let path = words.text("the path")?.to_owned();
                Ok(Box::new(move |stage| {
                    let target = stage.folders.to_write(&path)?;
                    std::fs::remove_file(target).map_err(|error| Fault::new(format!("{path}: {error}")))
                }))
            },
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
    if words.keyword("none") {
        return Ok(Box::new(|stage| {
            stage.window.be_without_dialogs();
            Ok(())
        }));
    }
    let is_open = match words.text("what is answered")? {
        "open" => true,
        "save" => false,
        other => return Err(format!("a dialog is told open PATH, save PATH, cancel or none, not {}", written(other))),
    };
    let path = words.text("the path")?.to_owned();
    Ok(Box::new(move |stage| {
        let path = if is_open { stage.folders.brought_in(&path)? } else { stage.folders.to_write(&path)? };
        stage.window.answer_dialog(Some(path));
        Ok(())
    }))
}
