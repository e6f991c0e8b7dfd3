//! Logs of CARMEN, the navigation toolkit of Carnegie Mellon: a text file with one message per line. The
//! usual format in archives of laser logs (Radish and its successors).
//!
//! Reads `ODOM`, `FLASER` and `RLASER` (180 degrees ahead and astern), `ROBOTLASER1` and `2`, `RAWLASER1`
//! to `4`, and the parameters with the scanners' positions. Logs from the archives are often 'corrected':
//! their first pose is the result of somebody's scan matching. It is ignored; the second is the robot's
//! own odometry.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Pose, Scan};

/// A log, as far as it could be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// In log order.
    pub readings: Vec<Reading>,
    /// Whether the odometry ever moves; if not, scans are matched only to each other.
    pub has_odometry: bool,
    /// What was skipped or repaired, with line numbers: the first few of each kind.
    pub notes: Vec<Note>,
}

/// A reading of the odometry, with the scans taken at that moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// In seconds, as in the log: since 1970, or since the start.
    pub time_s: f64,
    /// The robot's pose from its wheels, in an arbitrary frame.
    pub odometry: Pose,
    /// Empty, one, or front and rear.
    pub scans: Vec<Scan>,
}

/// A kind of skip or repair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoteKind {
    /// The line ends before its last field.
    Cut,
    /// A field is not a number, or not a finite one.
    NotANumber,
    /// More readings than any scanner returns.
    TooManyReadings,
    /// The line is longer than any message.
    TooLong,
    /// The clock runs backwards; the order of the lines is kept.
    TimeRunsBack,
    /// The odometry jumps further than a robot can drive; it continues from where it was.
    OdometryJumps,
    /// A scan before any odometry.
    NoOdometryYet,
}

impl NoteKind {
    const fn words(self) -> &'static str {
        match self {
            Self::Cut => "stops before its last field; left out",
            Self::NotANumber => "a field is not a finite number; left out",
            Self::TooManyReadings => "says it has more readings than any scanner gives; left out",
            Self::TooLong => "is longer than any message; left out",
            Self::TimeRunsBack => "its time lies before that of the line above; the order of the lines is kept",
            Self::OdometryJumps => "the odometry jumps; it is taken to go on from where it was",
            Self::NoOdometryYet => "a scan before any odometry; taken at the start",
        }
    }
}

/// All lines with one kind of note.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Note {
    pub kind: NoteKind,
    /// The first such line, counted from 1, and how many there are.
    pub first_line: usize,
    pub count: usize,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: {}", self.first_line, self.kind.words())?;
        match self.count {
            0 | 1 => Ok(()),
            2 => f.write_str(" (and one more)"),
            count => write!(f, " (and {} more)", count - 1),
        }
    }
}

/// Why a log cannot be mapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogError {
    /// No line is a CARMEN message.
    NotALog,
    /// There are messages, but no laser scans.
    NoScans,
    /// Larger than fits into memory.
    TooLarge,
}

impl std::fmt::Display for LogError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotALog => f.write_str(
                "this is no CARMEN log: no line starts with FLASER, ROBOTLASER1, ODOM or another of its messages",
            ),
            Self::NoScans => f.write_str(
                "the log has no laser scan that can be read; scans are lines that start with FLASER, RLASER, \
                 ROBOTLASER1 or RAWLASER1",
            ),
            Self::TooLarge => write!(
                f,
                "the log has more than {MOST_RANGES} laser readings or {MOST_LINES} lines; cut it into pieces"
            ),
        }
    }
}

impl std::error::Error for LogError {}

/// The most ranges in a log: a day of driving with a SICK LMS at half a degree. Keeps memory below 1 GB.
const MOST_RANGES: usize = 60_000_000;
const MOST_LINES: usize = 5_000_000;
/// The most readings per sweep of any scanner.
const MOST_READINGS: usize = 10_000;
/// The longest message in bytes: as many readings with 20 characters each.
pub const LONGEST_LINE: usize = 32 * MOST_READINGS;
/// Readings of `FLASER` lines from here on count as no return, since their maximum is not in the log. A
/// SICK LMS 200 sees 8 m in its usual mode, 32 m in others, and reports 81.83 m or 81.91 m for no return.
const OLD_MAX_RANGE_M: f64 = 30.0;
/// Scanners are on the robot: mounting positions further from its middle than this, in metres, are
/// errors.
const FURTHEST_MOUNT_M: f64 = 1.5;
/// Front and rear scans taken within this time and distance belong together.
const TOGETHER_S: f64 = 0.15;
const TOGETHER_M: f64 = 0.15;
const TOGETHER_RAD: f64 = 0.2;
/// The fastest any logged robot drives, in m/s, and the furthest one moves between two lines, in metres.
const FASTEST_M_PER_S: f64 = 5.0;
const LONGEST_STEP_M: f64 = 10.0;

/// Reads a log line by line.
#[derive(Clone, Debug, Default)]
pub struct LogReader {
    log: Log,
    line: usize,
    ranges: usize,
    messages: usize,
    front_mount_m: f64,
    rear_mount_m: f64,
    /// The odometry as in the log, and as repaired after jumps.
    last: Option<(Pose, Pose)>,
    /// The scanner of the latest scan.
    latest: Option<Scanner>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scanner {
    Front,
    Rear,
    Numbered(u8),
}

impl LogReader {
    pub fn new() -> Self {
        Self::default()
    }

    /// Processes the next line, without its line ending. `None` stands for one longer than
    /// [`LONGEST_LINE`].
    ///
    /// # Errors
    /// [`LogError::TooLarge`].
    pub fn line(&mut self, line: Option<&str>) -> Result<(), LogError> {
        self.line += 1;
        if self.line > MOST_LINES || self.ranges > MOST_RANGES {
            return Err(LogError::TooLarge);
        }
        let Some(line) = line else {
            self.note(NoteKind::TooLong);
            return Ok(());
        };
        let mut words = line.split_ascii_whitespace();
        let Some(name) = words.next() else { return Ok(()) };
        let mut fields = Fields { words };
        let read = match name {
            "ODOM" => self.odometry(&mut fields),
            "FLASER" => self.old_laser(Scanner::Front, &mut fields),
            "RLASER" => self.old_laser(Scanner::Rear, &mut fields),
            "ROBOTLASER1" => self.robot_laser(Scanner::Front, &mut fields),
            "ROBOTLASER2" => self.robot_laser(Scanner::Rear, &mut fields),
            "RAWLASER1" => self.raw_laser(Scanner::Numbered(1), &mut fields),
            "RAWLASER2" => self.raw_laser(Scanner::Numbered(2), &mut fields),
            "RAWLASER3" => self.raw_laser(Scanner::Numbered(3), &mut fields),
            "RAWLASER4" => self.raw_laser(Scanner::Numbered(4), &mut fields),
            "PARAM" => {
                self.parameter(&mut fields);
                Ok(())
            }
            _ => return Ok(()),
        };
        self.messages += 1;
        if let Err(kind) = read {
            self.note(kind);
        }
        Ok(())
    }

    /// The log, if there is anything to map in it.
    ///
    /// # Errors
    /// [`LogError::NotALog`], [`LogError::NoScans`].
    pub fn finish(mut self) -> Result<Log, LogError> {
        if self.messages == 0 {
            return Err(LogError::NotALog);
        }
        if self.log.readings.iter().all(|reading| reading.scans.is_empty()) {
            return Err(LogError::NoScans);
        }
        let first = self.log.readings.first().map_or(Pose::IDENTITY, |reading| reading.odometry);
        self.log.has_odometry = self.log.readings.iter().any(|reading| reading.odometry != first);
        self.log.notes.sort_by_key(|note| (note.first_line, note.kind));
        Ok(self.log)
    }

    fn note(&mut self, kind: NoteKind) {
        match self.log.notes.iter_mut().find(|note| note.kind == kind) {
            Some(note) => note.count += 1,
            None => self.log.notes.push(Note { kind, first_line: self.line, count: 1 }),
        }
    }

    /// `ODOM x y theta tv rv accel time host logger_time`
    fn odometry(&mut self, fields: &mut Fields<'_>) -> Result<(), NoteKind> {
        let odometry = fields.pose()?;
        fields.skip(3)?;
        let time_s = fields.time()?;
        self.push(time_s, odometry, None);
        Ok(())
    }

    /// `FLASER n r1..rn x y theta odom_x odom_y odom_theta time host logger_time`
    fn old_laser(&mut self, scanner: Scanner, fields: &mut Fields<'_>) -> Result<(), NoteKind> {
        let ranges_m = fields.ranges()?;
        let _corrected = fields.pose()?;
        let odometry = fields.pose()?;
        let time_s = fields.time()?;
        let step_rad = old_step_rad(ranges_m.len());
        let robot_from_scanner = match scanner {
            Scanner::Rear => Pose::new(self.rear_mount_m, 0.0, PI),
            _ => Pose::new(self.front_mount_m, 0.0, 0.0),
        };
        // 401 readings at a quarter of a degree cover 100 degrees; all others 180.
        let start_rad = if ranges_m.len() == 401 { -50_f64.to_radians() } else { -FRAC_PI_2 };
        let scan = Scan { ranges_m, start_rad, step_rad, max_range_m: OLD_MAX_RANGE_M, robot_from_scanner };
        self.push(time_s, odometry, Some((scanner, scan)));
        Ok(())
    }

    /// `ROBOTLASER1 type start fov resolution max_range accuracy remission_mode n r1..rn m e1..em
    /// laser_x laser_y laser_theta robot_x robot_y robot_theta tv rv forward side turn time host logger_time`
    fn robot_laser(&mut self, scanner: Scanner, fields: &mut Fields<'_>) -> Result<(), NoteKind> {
        let mut scan = fields.configured_scan()?;
        let laser = fields.pose()?;
        let odometry = fields.pose()?;
        fields.skip(5)?;
        let time_s = fields.time()?;
        let mount = odometry.between(laser);
        scan.robot_from_scanner = if mount.x_m.hypot(mount.y_m) <= FURTHEST_MOUNT_M {
            mount
        } else if scanner == Scanner::Rear {
            Pose::new(self.rear_mount_m, 0.0, PI)
        } else {
            Pose::new(self.front_mount_m, 0.0, 0.0)
        };
        self.push(time_s, odometry, Some((scanner, scan)));
        Ok(())
    }

    /// `RAWLASER1 type start fov resolution max_range accuracy remission_mode n r1..rn m e1..em time host
    /// logger_time`, taken at the last odometry pose.
    fn raw_laser(&mut self, scanner: Scanner, fields: &mut Fields<'_>) -> Result<(), NoteKind> {
        let mut scan = fields.configured_scan()?;
        let time_s = fields.time()?;
        if scanner == Scanner::Numbered(2) {
            scan.robot_from_scanner = Pose::new(self.rear_mount_m, 0.0, PI);
        } else {
            scan.robot_from_scanner = Pose::new(self.front_mount_m, 0.0, 0.0);
        }
        if self.last.is_none() {
            self.note(NoteKind::NoOdometryYet);
        }
        let odometry = self.last.map_or(Pose::IDENTITY, |(raw, _)| raw);
        self.push(time_s, odometry, Some((scanner, scan)));
        Ok(())
    }

    /// `PARAM name value`
    fn parameter(&mut self, fields: &mut Fields<'_>) {
        let (Some(name), Ok(value)) = (fields.words.next(), fields.number()) else { return };
        if value.abs() > FURTHEST_MOUNT_M {
            return;
        }
        match name {
            "robot_frontlaser_offset" => self.front_mount_m = value,
            "robot_rearlaser_offset" => self.rear_mount_m = value,
            _ => {}
        }
    }

    fn push(&mut self, time_s: f64, raw: Pose, scan: Option<(Scanner, Scan)>) {
        let before_s = self.log.readings.last().map(|reading| reading.time_s);
        if before_s.is_some_and(|before_s| time_s < before_s) {
            self.note(NoteKind::TimeRunsBack);
        }
        let odometry = match self.last {
            None => raw,
            Some((last_raw, last)) => {
                let step = last_raw.between(raw);
                let passed_s = (time_s - before_s.unwrap_or(time_s)).max(0.0);
                let farthest_m = (1.0 + FASTEST_M_PER_S * passed_s).min(LONGEST_STEP_M);
                if step.x_m.hypot(step.y_m) > farthest_m {
                    self.note(NoteKind::OdometryJumps);
                    last
                } else {
                    last.compose(step)
                }
            }
        };
        self.last = Some((raw, odometry));
        let mut scans = Vec::new();
        if let Some((scanner, mut scan)) = scan {
            self.ranges += scan.ranges_m.len();
            // The other scanner's sweep of the same moment joins the previous reading.
            let partner = self.log.readings.iter_mut().rev().take(2).find(|reading| !reading.scans.is_empty());
            let partner = partner.filter(|reading| {
                let way = reading.odometry.between(odometry);
                reading.scans.len() == 1
                    && self.latest.is_some_and(|latest| latest != scanner)
                    && (time_s - reading.time_s).abs() <= TOGETHER_S
                    && way.x_m.hypot(way.y_m) <= TOGETHER_M
                    && way.heading_rad.abs() <= TOGETHER_RAD
            });
            self.latest = Some(scanner);
            match partner {
                Some(reading) => {
                    scan.robot_from_scanner = reading.odometry.between(odometry).compose(scan.robot_from_scanner);
                    reading.scans.push(scan);
                }
                None => scans.push(scan),
            }
        }
        self.log.readings.push(Reading { time_s, odometry, scans });
    }
}

/// The angle between readings of a 180-degree sweep: SICKs return 180 or 181 at one degree, 360 or 361 at
/// half a degree, and 401 at a quarter (CARMEN's `laser` module guesses by the same numbers).
fn old_step_rad(count: usize) -> f64 {
    match count {
        180 | 181 => 1_f64.to_radians(),
        360 | 361 => 0.5_f64.to_radians(),
        401 => 0.25_f64.to_radians(),
        _ => PI / (count.max(2) - 1) as f64,
    }
}

/// The unread fields of a line.
struct Fields<'a> {
    words: std::str::SplitAsciiWhitespace<'a>,
}

impl Fields<'_> {
    /// The next field as a number, which may be infinite or NaN.
    fn reading(&mut self) -> Result<f64, NoteKind> {
        self.words.next().ok_or(NoteKind::Cut)?.parse().map_err(|_| NoteKind::NotANumber)
    }

    fn number(&mut self) -> Result<f64, NoteKind> {
        let number = self.reading()?;
        // Beyond any coordinate or time: sums and squares would overflow.
        if number.abs() < 1e12 { Ok(number) } else { Err(NoteKind::NotANumber) }
    }

    fn pose(&mut self) -> Result<Pose, NoteKind> {
        Ok(Pose::new(self.number()?, self.number()?, self.number()?))
    }

    fn skip(&mut self, count: usize) -> Result<(), NoteKind> {
        for _ in 0..count {
            self.words.next().ok_or(NoteKind::Cut)?;
        }
        Ok(())
    }

    /// `time host logger_time`: the first is the time of measurement.
    fn time(&mut self) -> Result<f64, NoteKind> {
        let time_s = self.number()?;
        self.skip(1)?;
        // The last field of the line: a truncation inside it cannot be detected, and is harmless.
        self.number()?;
        Ok(time_s)
    }

    /// `n r1..rn`; allocates for the readings present, not for the number promised.
    fn ranges(&mut self) -> Result<Vec<f64>, NoteKind> {
        let count = self.count()?;
        let mut ranges = Vec::new();
        for _ in 0..count {
            ranges.push(self.reading()?);
        }
        Ok(ranges)
    }

    fn count(&mut self) -> Result<usize, NoteKind> {
        let word = self.words.next().ok_or(NoteKind::Cut)?;
        let is_digits = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
        match word.parse() {
            Ok(count) if count <= MOST_READINGS => Ok(count),
            Ok(_) => Err(NoteKind::TooManyReadings),
            Err(_) if is_digits => Err(NoteKind::TooManyReadings),
            Err(_) => Err(NoteKind::NotANumber),
        }
    }

    /// `type start fov resolution max_range accuracy remission_mode n r1..rn m e1..em`
    fn configured_scan(&mut self) -> Result<Scan, NoteKind> {
        self.skip(1)?;
        let start_rad = self.number()?;
        let _field_of_view = self.number()?;
        let step_rad = self.number()?;
        let max_range_m = self.number()?;
        self.skip(2)?;
        let ranges_m = self.ranges()?;
        let remissions = self.count()?;
        self.skip(remissions)?;
        let turned = step_rad * ranges_m.len() as f64;
        if start_rad.abs() > 7.0 || step_rad == 0.0 || turned.abs() > 7.0 || max_range_m <= 0.0 {
            return Err(NoteKind::NotANumber);
        }
        Ok(Scan { ranges_m, start_rad, step_rad, max_range_m, robot_from_scanner: Pose::IDENTITY })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Log, LogError> {
        let mut reader = LogReader::new();
        for line in text.lines() {
            reader.line(Some(line))?;
        }
        reader.finish()
    }

    fn kinds(log: &Log) -> Vec<(NoteKind, usize, usize)> {
        log.notes.iter().map(|note| (note.kind, note.first_line, note.count)).collect()
    }

    #[test]
    fn scans_carry_the_raw_odometry_and_not_the_corrected_pose() {
        let log =
            read("FLASER 3 1.5 81.83 2 9 9 9 0.1 0.2 0.3 12.5 host 0.5\nODOM 0.2 0.2 0.3 0 0 0 13 host 1").unwrap();
        assert_eq!(log.readings.len(), 2);
        let scan = &log.readings[0];
        assert_eq!((scan.time_s, scan.odometry), (12.5, Pose::new(0.1, 0.2, 0.3)));
        assert_eq!(scan.scans[0].points().map(|(beam, _)| beam).collect::<Vec<_>>(), [0, 2]);
        assert!(log.has_odometry && log.notes.is_empty());
    }

    #[test]
    fn front_and_rear_are_one_look() {
        let log = read(
            "PARAM robot_frontlaser_offset 0.1 host 0\nPARAM robot_rearlaser_offset -0.2 host 0\n\
             FLASER 3 1 1 1 0 0 0 0 0 0 5 h 5\nRLASER 3 2 2 2 0 0 0 0.05 0 0 5.05 h 5\nODOM 1 0 0 0 0 0 6 h 6",
        )
        .unwrap();
        assert_eq!(log.readings.iter().map(|reading| reading.scans.len()).collect::<Vec<_>>(), [2, 0, 0]);
        let rear = log.readings[0].scans[1].robot_from_scanner;
        assert!((rear.x_m + 0.15).abs() < 1e-12 && (rear.heading_rad - PI).abs() < 1e-12);
        assert!((log.readings[0].scans[0].robot_from_scanner.x_m - 0.1).abs() < 1e-12);
    }

    #[test]
    fn robot_and_raw_lasers_say_where_they_look() {
        let log = read(
            "ROBOTLASER1 0 -1.57 3.14 0.0174 81.9 0.01 0 3 1 2 3 0 1.2 2 0.5 1 2 0.5 0 0 0 0 0 7 h 7\n\
             ODOM 1.5 2 0.5 0 0 0 8 h 8\nRAWLASER1 0 -1.57 3.14 0.0174 81.9 0.01 0 2 1 2 1 9 8.5 h 8",
        )
        .unwrap();
        let mount = log.readings[0].scans[0].robot_from_scanner;
        assert!((mount.x_m - 0.2 * 0.5_f64.cos()).abs() < 1e-9 && mount.heading_rad == 0.0);
        assert_eq!(log.readings[2].odometry, log.readings[1].odometry);
        assert_eq!(log.readings[2].scans[0].ranges_m, [1.0, 2.0]);
    }

    #[test]
    fn what_is_broken_is_passed_over_with_its_line() {
        let log = read(
            "FLASER 3 1 nan 1 0 0 0 0 0 0 5 h 5\n\
             FLASER 3 1 1 1 0 0 0 0 0 nan 6 h 6\n\
             FLASER 99999999999999999999999 1\n\
             FLASER 4000000000 1\n\
             FLASER 3 1 1 1 0 0 0 0 0 0\n\
             FLASER 3 1 1 1 0 0 0 0.1 0 0 4 h 4\n\
             FLASER 3 1 x 1 0 0 0 0.1 0 0 7 h 7\n\
             FLASER 3 1 1 1 0 0 0 900 0 0 8 h 8\n\
             FLASER 3 1 1 1 0 0 0 900.5 0 0 9 h 9",
        )
        .unwrap();
        use NoteKind::{Cut, NotANumber, OdometryJumps, TimeRunsBack, TooManyReadings};
        let expected =
            [(NotANumber, 2, 2), (TooManyReadings, 3, 2), (Cut, 5, 1), (TimeRunsBack, 6, 1), (OdometryJumps, 8, 1)];
        assert_eq!(kinds(&log), expected);
        let places: Vec<f64> = log.readings.iter().map(|reading| reading.odometry.x_m).collect();
        assert!((places[3] - 0.6).abs() < 1e-9 && places[..3] == [0.0, 0.1, 0.1], "{places:?}");
        assert_eq!(log.notes[0].to_string(), "line 2: a field is not a finite number; left out (and one more)");
    }

    #[test]
    fn no_log_and_no_scans_are_told_apart() {
        assert_eq!(read("{\"a\": 1}\n"), Err(LogError::NotALog));
        assert_eq!(read(""), Err(LogError::NotALog));
        assert_eq!(read("ODOM 1 0 0 0 0 0 6 h 6"), Err(LogError::NoScans));
        assert!(!read("RAWLASER1 0 -1.57 3.14 0.0174 81.9 0.01 0 2 1 2 0 8.5 h 8").unwrap().has_odometry);
    }
}
