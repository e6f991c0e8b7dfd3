//! Plans, and answers to dialogs that ask for files.

use std::path::Path;

use super::{Group, Verb};
use crate::app::replay::words::{Words, did_you_mean, written};
use crate::formats::file_stem;
use crate::store::BUNDLED;

pub(super) const GROUP: Group = Group {
    title: "Files",
    verbs: &[
        Verb {
            name: "sample",
            form: "sample NAME",
            help: "Opens a plan that comes with the program: office, school or dwelling.",
            parse: |words| {
                let name = words.text("the sample's name")?.to_owned();
                let names = || BUNDLED.iter().map(|(file, _)| file_stem(file));
                if !names().any(|known| known == name) {
                    let near = did_you_mean(&name, names());
                    return Err(format!("there is no sample {} ({near})", written(&name)).replace(" ()", ""));
                }
                Ok(Box::new(move |stage| {
                    stage.window.open_bundled(&name);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "load",
            form: "load PATH [missing]",
            help: "Opens a file or a folder, as from the command line: a copy of it, which the script may change and \
                   save. With `missing` there need be none.",
            parse: |words| {
                let path = words.text("the path")?.to_owned();
                let may_miss = words.keyword("missing");
                Ok(Box::new(move |stage| {
                    match stage.folders.brought_in(&path) {
                        Ok(copy) => stage.window.open(&copy),
                        Err(_) if may_miss => stage.window.open(&stage.folders.work.join(&path)),
                        Err(fault) => return Err(fault),
                    }
                    Ok(())
                }))
            },
        },
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
            name: "answer",
            form: "answer open PATH | save PATH | cancel",
            help: "What the next dialog that asks for a file will be told; stands before the step that brings it up.",
            parse: answer,
        },
    ],
};

fn answer(words: &mut Words<'_>) -> Result<crate::app::replay::script::Act, String> {
    if words.keyword("cancel") {
        return Ok(Box::new(|stage| {
            stage.window.answer_dialog(None);
            Ok(())
        }));
    }
    let is_open = match words.text("what is answered")? {
        "open" => true,
        "save" => false,
        other => return Err(format!("an answer is open PATH, save PATH or cancel, not {}", written(other))),
    };
    let path = words.text("the path")?.to_owned();
    Ok(Box::new(move |stage| {
        let path = if is_open { stage.folders.brought_in(&path)? } else { stage.folders.to_write(&path)? };
        stage.window.answer_dialog(Some(path));
        Ok(())
    }))
}
