//! The window as a whole, and time.

use super::{Group, Verb};
use crate::app::offscreen::OffscreenOptions;
use crate::app::replay::fault::Fault;
use crate::app::replay::stage::Stage;
use crate::app::replay::words::{Words, in_quotes, number, told, written};

pub(super) const GROUP: Group = Group {
    title: "Window and time",
    verbs: &[
        Verb {
            name: "size",
            form: "size WIDTHxHEIGHT",
            help: "Makes the window so large, in logical pixels; 1280x800 at first.",
            parse: |words| {
                let (width, height) = size(words)?;
                Ok(Box::new(move |stage| {
                    let options = OffscreenOptions { width, height, ..stage.window.options() };
                    stage.set_options(options)
                }))
            },
        },
        Verb {
            name: "scale",
            form: "scale NUMBER",
            help: "Physical pixels per logical one: `scale 2` for a display of high density.",
            parse: |words| {
                let scale = scale(words)?;
                Ok(Box::new(move |stage| {
                    let options = OffscreenOptions { scale, ..stage.window.options() };
                    stage.set_options(options)
                }))
            },
        },
        Verb {
            name: "theme",
            form: "theme light|dark",
            help: "What the system asks for, which the window follows until told otherwise.",
            parse: |words| {
                let is_dark = is_dark(words)?;
                Ok(Box::new(move |stage| {
                    let options = OffscreenOptions { is_dark, ..stage.window.options() };
                    stage.set_options(options)
                }))
            },
        },
        Verb {
            name: "slow",
            form: "slow on|off",
            help: "The window gets slow: what is typed and clicked from `slow on` to `slow off` comes in one frame.",
            parse: |words| {
                let is_slow = match words.text("on or off")? {
                    "on" => true,
                    "off" => false,
                    other => return Err(format!("{} is neither on nor off", told(other))),
                };
                Ok(Box::new(move |stage| {
                    if is_slow {
                        stage.window.be_slow()
                    } else {
                        stage.window.be_quick()
                    }
                    Ok(())
                }))
            },
        },
        Verb {
            name: "close-window",
            form: "close-window",
            help: "Asks the window to close, as its title bar does.",
            parse: |_| {
                Ok(Box::new(|stage| {
                    stage.window.ask_to_close();
                    Ok(())
                }))
            },
        },
        Verb {
            name: "wait",
            form: "wait [SECONDS]",
            help: "Waits until all work in the background is done, which every step does; or lets time pass on the \
                   script's own clock, at most 60 seconds.",
            parse: |words| {
                let secs = if words.is_empty() { 0.0 } else { words.number("the time in seconds", 0.0, 60.0)? };
                Ok(Box::new(move |stage| {
                    stage.window.settle().map_err(|error| Fault::new(error.to_string()))?;
                    if secs > 0.0 {
                        stage.window.advance(secs);
                    }
                    Ok(())
                }))
            },
        },
        Verb {
            name: "stop-job",
            form: "stop-job NAME PERCENT [N]",
            help: "The next job in the background of this name stops when so much of it is done, 0 before it begins; or the \
                   Nth from here. To see the window while it works: `stop-job \"train models\" 40`.",
            parse: |words| {
                let name = words.text("the name of the job")?.to_owned();
                let percent = percent(words)?;
                let number = if words.is_empty() { 1 } else { words.number("which of them", 1.0, 1000.0)? as usize };
                Ok(Box::new(move |stage| {
                    if let Some(waiting) = stage.window.job_to_stop() {
                        let what = format!("the job {} was to stop and has not started", in_quotes(waiting));
                        return Err(Fault::new(what).hint(job_hint(stage)));
                    }
                    stage.window.stop_job(&name, percent, number - 1);
                    Ok(())
                }))
            },
        },
        Verb {
            name: "let-jobs-go",
            form: "let-jobs-go [PERCENT]",
            help: "The jobs that stopped go on until so much of them is done, or to their ends.",
            parse: |words| {
                let percent = if words.is_empty() { None } else { Some(percent(words)?) };
                Ok(Box::new(move |stage| match stage.window.let_jobs_go(percent) {
                    0 => Err(Fault::new("no job has stopped").hint(job_hint(stage))),
                    _ => Ok(()),
                }))
            },
        },
    ],
};

/// How much of a job is done.
fn percent(words: &mut Words<'_>) -> Result<usize, String> {
    Ok(words.number("how much of it is done, in percent", 0.0, 100.0)? as usize)
}

/// Which jobs could stop.
fn job_hint(stage: &Stage<'_>) -> String {
    let names: Vec<String> = stage.window.job_names().into_iter().map(in_quotes).collect();
    format!("these have started so far: {}", names.join(", "))
}

/// The size of a window, in logical pixels.
pub(super) fn size(words: &mut Words<'_>) -> Result<(u32, u32), String> {
    let text = words.text("the size")?;
    let side = |text: &str| number(text, "a side of the window", 1.0, 8192.0).ok().filter(|side| side.fract() == 0.0);
    let sides = text.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?)));
    let (width, height) = sides.ok_or_else(|| {
        format!("a size is WIDTHxHEIGHT in whole pixels up to 8192, like 1280x800, not {}", written(text))
    })?;
    Ok((width as u32, height as u32))
}

pub(super) fn scale(words: &mut Words<'_>) -> Result<f32, String> {
    Ok(words.number("the scale", 0.5, 4.0)? as f32)
}

pub(super) fn is_dark(words: &mut Words<'_>) -> Result<bool, String> {
    match words.text("the theme")? {
        "light" => Ok(false),
        "dark" => Ok(true),
        other => Err(format!("a theme is light or dark, not {}", written(other))),
    }
}
