//! Decoding pictures in a process of its own: decoders are others' work and files are of any making, and
//! one that never ends, overflows the stack or takes all memory can only be stopped from outside.
//!
//! The process is the same program, called with [`WORD`]. It reads the picture's bytes from its standard
//! input, lowers its own limits, and writes a line and the pixels to its standard output:
//!
//! ```text
//! picture WIDTH HEIGHT BYTES_OF_A_PIXEL PAGES\n  and the pixels, rows from the top
//! refused\nWHAT\nHINT                            and nothing else
//! ```
#![cfg_attr(not(feature = "cli"), allow(dead_code, reason = "the program, which has a command line, is who answers"))]
#![expect(
    clippy::disallowed_methods,
    reason = "a decoder that hangs is known by the clock alone; what is decoded never depends on it"
)]

use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Read, Write as _};
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use super::decode;
use super::pixels::Decoded;
use super::{LARGEST_FILE_BYTES, PictureError, check_size};
use crate::base::work::Work;
use crate::picture::{Level, Samples};

/// The program's first argument when it is to decode a picture; the second is the page.
const WORD: &str = "decode-one-picture";

/// How the process ends when the picture took too long.
const TOO_LONG: u8 = 41;

/// A picture may take so much of a processor's time, and this more for each megabyte of its file and
/// for what it is known to decode to. A page of a building's plan takes a tenth of it.
const BASE_TIME: Duration = Duration::from_millis(1250);
const TIME_A_FILE_MB: Duration = Duration::from_secs(1);
const TIME_A_DECODED_MB: Duration = Duration::from_millis(20);

/// Should a decoder wait for something instead of working, it is ended after so long by the clock.
const LONGEST_WAIT: Duration = Duration::from_secs(300);

/// The process may use so much memory beside the file and the pixels, in which the program itself is
/// contained.
const BASE_BYTES: u64 = 640 << 20;

/// The decoders' stack. They take less than 1 MB for what is sound.
const STACK_BYTES: usize = 16 << 20;

/// How often it is looked whether the picture is still wanted, or took too long.
const TICK: Duration = Duration::from_millis(20);

/// Where pictures are decoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Decoding {
    /// In this process: quick, and at the mercy of the file. A PDF made for it may never end.
    Here,
    /// In a process of its own, which this program (`enfilade`) becomes: with limits on time, memory
    /// and stack, and ended when the picture is no longer wanted.
    Apart(PathBuf),
}

static DECODING: OnceLock<Decoding> = OnceLock::new();

/// Has all pictures decoded apart from now on, by the given `enfilade` program. The program itself begins
/// with this; a program that uses the library decodes in its own process until it calls it. Only the
/// first call counts.
pub fn decode_apart(program: PathBuf) {
    let _ = DECODING.set(Decoding::Apart(program));
}

/// As [`decode_apart`], by the running program.
pub(crate) fn decode_by_this_program() {
    // The running program itself, even where its file has been replaced by a newer one.
    let own = PathBuf::from("/proc/self/exe");
    let program = if own.exists() { Some(own) } else { std::env::current_exe().ok() };
    if let Some(program) = program {
        decode_apart(program);
    }
}

/// Where [`super::load_picture`] decodes.
pub(super) fn chosen() -> &'static Decoding {
    DECODING.get().unwrap_or(&Decoding::Here)
}

impl Decoding {
    /// A page as pixels, and how many there are.
    pub(super) fn decode(&self, bytes: &[u8], page: u32, work: &Work<'_>) -> Result<Decoded, PictureError> {
        match self {
            Self::Here => decode::decode(bytes, page, &mut |_| {}),
            Self::Apart(program) => decode_by(program, bytes, page, work),
        }
    }
}

// The side that asks.

fn decode_by(program: &std::path::Path, bytes: &[u8], page: u32, work: &Work<'_>) -> Result<Decoded, PictureError> {
    let mut command = Command::new(program);
    command.arg(WORD).arg(page.to_string());
    // A trace of a broken decoder helps nobody here, and takes its time.
    command.env("RUST_BACKTRACE", "0");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let cannot = |error: &std::io::Error| {
        PictureError::new(format!("cannot be decoded: {error}"), "free memory, or restart Enfilade")
    };
    let mut child = command.spawn().map_err(|error| cannot(&error))?;
    let (input, output) = (child.stdin.take(), child.stdout.take());
    let (sender, receiver) = channel();
    let outcome = std::thread::scope(|scope| {
        scope.spawn(move || {
            // Where it ends early it says why on its output, or not at all.
            let _ = input.map(|mut input| input.write_all(bytes));
        });
        scope.spawn(move || {
            let _ = sender.send(output.map_or(Err(NoAnswer), answer_from));
        });
        let start = Instant::now();
        let answer = loop {
            match receiver.recv_timeout(TICK) {
                Ok(answer) => break Some(answer),
                Err(RecvTimeoutError::Disconnected) => break Some(Err(NoAnswer)),
                Err(RecvTimeoutError::Timeout) if work.goes_on().is_err() || start.elapsed() > LONGEST_WAIT => {
                    break None;
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        };
        if answer.as_ref().is_none_or(Result::is_err) {
            // Both pipes end with it, and so do the threads. One that has ended cannot be killed.
            let ended = child.try_wait();
            if !matches!(ended, Ok(Some(_))) && answer.is_none() {
                let _ = child.kill();
            }
        }
        answer
    });
    match outcome {
        Some(Ok(answer)) => {
            let _ = child.wait();
            answer
        }
        Some(Err(NoAnswer)) => {
            // It has closed its output: it is ending, or does not know what it does.
            let status = waited_for(&mut child).map_err(|error| cannot(&error))?;
            let mut said = String::new();
            let _ = child.stderr.take().map(|stderr| stderr.take(4096).read_to_string(&mut said));
            Err(broken(status, &said))
        }
        None => {
            let _ = child.wait();
            match work.goes_on() {
                Err(_) => Err(PictureError::new("is no longer wanted", "read it again")),
                Ok(()) => Err(took_too_long()),
            }
        }
    }
}

/// The process ended without a whole answer.
struct NoAnswer;

/// Waits for a process that is ending; one that is not is ended.
fn waited_for(child: &mut Child) -> std::io::Result<ExitStatus> {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(1) {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill()?;
    child.wait()
}

/// Reads what the process writes. Nothing in it is believed before it is checked.
fn answer_from(output: impl Read) -> Result<Result<Decoded, PictureError>, NoAnswer> {
    const LONGEST_LINE: u64 = 80;
    const LONGEST_WORDS: u64 = 64 << 10;
    let mut output = BufReader::with_capacity(1 << 16, output);
    let mut line = String::new();
    (&mut output).take(LONGEST_LINE).read_line(&mut line).map_err(|_| NoAnswer)?;
    let words: Vec<&str> = line.strip_suffix('\n').ok_or(NoAnswer)?.split(' ').collect();
    let number = |text: &str| text.parse::<u32>().map_err(|_| NoAnswer);
    match words.as_slice() {
        ["refused"] => {
            let mut text = String::new();
            output.take(LONGEST_WORDS).read_to_string(&mut text).map_err(|_| NoAnswer)?;
            let (what, hint) = text.split_once('\n').ok_or(NoAnswer)?;
            Ok(Err(PictureError::new(what, hint)))
        }
        ["picture", width, height, samples, pages] => {
            let (width_px, height_px, pages) = (number(width)?, number(height)?, number(pages)?);
            let kinds = [Samples::Grey, Samples::Rgb, Samples::Rgba];
            let samples = *samples;
            let samples = kinds.into_iter().find(|kind| kind.bytes().to_string() == samples).ok_or(NoAnswer)?;
            check_size(width_px, height_px).map_err(|_| NoAnswer)?;
            let mut data = vec![0; width_px as usize * height_px as usize * samples.bytes()];
            output.read_exact(&mut data).map_err(|_| NoAnswer)?;
            let is_over = output.read(&mut [0]).map_err(|_| NoAnswer)? == 0;
            if !is_over || pages == 0 {
                return Err(NoAnswer);
            }
            Ok(Ok(Decoded { full: Level { width_px, height_px, samples, data }, pages }))
        }
        _ => Err(NoAnswer),
    }
}

fn took_too_long() -> PictureError {
    PictureError::new("takes too long to decode", "save it anew, or its page as PNG")
}

/// What became of a process that ended without an answer.
fn broken(status: ExitStatus, said: &str) -> PictureError {
    #[cfg(unix)]
    let signal = std::os::unix::process::ExitStatusExt::signal(&status);
    #[cfg(not(unix))]
    let signal: Option<i32> = None;
    #[cfg(unix)]
    let (of_time, killed) = (rustix::process::Signal::XCPU.as_raw(), rustix::process::Signal::KILL.as_raw());
    #[cfg(not(unix))]
    let (of_time, killed) = (-1, -1);
    if status.code() == Some(i32::from(TOO_LONG)) || signal == Some(of_time) {
        return took_too_long();
    }
    let hint = "save it anew, or its page as PNG";
    if said.contains("memory allocation") || said.contains("out of memory") || signal == Some(killed) {
        return PictureError::new("takes more memory to decode than it may", hint);
    }
    if said.contains("overflowed its stack") {
        return PictureError::new("is nested too deeply to be decoded", hint);
    }
    PictureError::new("cannot be decoded", hint)
}

// The side that answers.

/// Where the program was called to decode a picture, does it and gives the exit code.
pub(crate) fn answer_if_asked() -> Option<u8> {
    let arguments: Vec<OsString> = std::env::args_os().take(4).collect();
    let [_, word, page] = arguments.as_slice() else { return None };
    if word != WORD {
        return None;
    }
    let page = page.to_str()?.parse().ok()?;
    Some(answer(page))
}

/// Milliseconds of a processor's time that the picture may take.
static ALLOWED_MS: AtomicU64 = AtomicU64::new(0);

fn allow_time(more: Duration) {
    ALLOWED_MS.fetch_add(more.as_millis() as u64, Ordering::Relaxed);
}

/// `bytes` of the file or of pixels, in time.
fn time_for(bytes: u64, a_mb: Duration) -> Duration {
    a_mb.mul_f64(bytes as f64 / f64::from(1 << 20))
}

fn answer(page: u32) -> u8 {
    std::panic::set_hook(Box::new(|_| {}));
    let mut bytes = Vec::new();
    if std::io::stdin().lock().take(LARGEST_FILE_BYTES + 1).read_to_end(&mut bytes).is_err() {
        return 1;
    }
    allow_time(BASE_TIME + time_for(bytes.len() as u64, TIME_A_FILE_MB));
    let mut allowed_bytes = BASE_BYTES + bytes.len() as u64;
    limit_memory(allowed_bytes);
    // A small stack: address space is limited.
    if std::thread::Builder::new().stack_size(256 << 10).spawn(end_in_time).is_err() {
        return 1;
    }
    let decode = move || {
        let decoded = decode::decode(&bytes, page, &mut |decoded_bytes| {
            allow_time(time_for(decoded_bytes, TIME_A_DECODED_MB));
            // The pixels as they are decoded, and once more in another form.
            allowed_bytes = allowed_bytes.saturating_add(decoded_bytes.saturating_mul(2));
            limit_memory(allowed_bytes);
        });
        write(decoded).is_ok()
    };
    let is_written =
        std::thread::Builder::new().stack_size(STACK_BYTES).spawn(decode).map(std::thread::JoinHandle::join);
    u8::from(!matches!(is_written, Ok(Ok(true))))
}

fn write(decoded: Result<Decoded, PictureError>) -> std::io::Result<()> {
    let mut output = std::io::stdout().lock();
    match decoded {
        Ok(Decoded { full, pages }) => {
            let Level { width_px, height_px, samples, data } = full;
            writeln!(output, "picture {width_px} {height_px} {} {pages}", samples.bytes())?;
            output.write_all(&data)?;
        }
        Err(PictureError { what, hint }) => {
            write!(output, "refused\n{}\n{}", what.replace('\n', " "), hint.replace('\n', " "))?;
        }
    }
    output.flush()
}

/// Ends the process once its time is over.
fn end_in_time() {
    let start = Instant::now();
    loop {
        std::thread::sleep(TICK);
        if time_used(start) > Duration::from_millis(ALLOWED_MS.load(Ordering::Relaxed)) {
            std::process::exit(i32::from(TOO_LONG));
        }
    }
}

/// The processor's time that this process has taken: on a busy machine a sound picture is not refused.
#[cfg(unix)]
fn time_used(_start: Instant) -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Duration::new(u64::try_from(time.tv_sec).unwrap_or(0), u32::try_from(time.tv_nsec).unwrap_or(0))
}

#[cfg(not(unix))]
fn time_used(start: Instant) -> Duration {
    start.elapsed()
}

/// The process gets no more memory than this; what asks for more is told that there is none, and ends it.
#[cfg(unix)]
fn limit_memory(bytes: u64) {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    // No image of a broken decoder on the disk.
    let _ = setrlimit(Resource::Core, Rlimit { current: Some(0), maximum: Some(0) });
    let maximum = getrlimit(Resource::As).maximum;
    let current = Some(maximum.map_or(bytes, |most| most.min(bytes)));
    let _ = setrlimit(Resource::As, Rlimit { current, maximum });
}

#[cfg(not(unix))]
fn limit_memory(_bytes: u64) {}
