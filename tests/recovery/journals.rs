//! Journals: whatever was recorded comes back, however the file was damaged.

use std::path::{Path, PathBuf};

use enfilade::base::random::Random;
use enfilade::edit;
use enfilade::formats::plan_json;
use enfilade::geometry::Point;
use enfilade::plan::{Builder, ElementId, History, Meta, Plan, Room, Step};
use enfilade::store::{Journal, JournalStart, Predecessor, Recovered, leftovers, read_journal};

use super::house;

fn begin(folder: &Path, base: &Plan, replaces: Option<Predecessor>) -> Journal {
    Journal::begin(folder, JournalStart::default(), base.clone(), replaces, || {})
}

/// The journals in a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|entries| entries.map(|entry| entry.unwrap().path()).collect())
        .unwrap_or_default();
    files.sort();
    files
}

fn named(plan: &Plan, name: &str) -> Plan {
    edit::set_meta(plan, Meta { name: name.to_owned(), ..plan.meta().clone() })
}

/// A room of four corners.
fn small() -> Plan {
    let mut builder = Builder::new(Meta { name: "Small".to_owned(), ..Meta::default() });
    let ring = builder.ring([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(x, y)| Point::new(x, y)));
    builder.room("room", Room { outer: ring, ..Room::default() });
    builder.finish().unwrap()
}

/// The bytes of a journal with steps of all kinds, and every plan that it leads to, in their order.
fn written() -> (Vec<u8>, Vec<Plan>) {
    let folder = tempfile::tempdir().unwrap();
    let mut history = History::new("Open", small());
    let mut journal = begin(folder.path(), history.plan(), None);
    let mut states = vec![history.plan().clone()];
    let mut note = |history: &History, journal: &mut Journal| {
        journal.note(history);
        states.push(history.plan().clone());
    };
    let corners: Vec<_> = history.plan().corners().map(|(id, _)| id).collect();
    let walled = edit::add_wall(history.plan(), corners[0], corners[1], 0.1).unwrap().0;
    history.push("Draw wall", walled);
    note(&history, &mut journal);
    history.push("Move corner", edit::move_corners(history.plan(), &[(corners[0], Point::new(9.0, 9.0))]).unwrap());
    note(&history, &mut journal);
    history.undo();
    note(&history, &mut journal);
    history.redo();
    note(&history, &mut journal);
    history.undo();
    note(&history, &mut journal);
    history.push("Name", named(history.plan(), "Näme \"quoted\"\n"));
    note(&history, &mut journal);
    journal.wait().unwrap();
    let bytes = std::fs::read(&files(folder.path())[0]).unwrap();
    (bytes, states)
}

#[test]
fn what_is_noted_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = History::new("Open", house());
    let mut journal = begin(folder.path(), history.plan(), None);
    assert_eq!(files(folder.path()), Vec::<PathBuf>::new(), "nothing to keep, nothing written");
    let mut random = Random::new(7);
    for round in 0..200 {
        match random.below(10) {
            0 | 1 => drop(history.undo()),
            2 => drop(history.redo()),
            3 => history.jump_to(random.below(history.steps().len())),
            kind => {
                // At times several steps between two looks.
                for _ in 0..=usize::from(kind == 9) {
                    let plan = random_edit(history.plan(), &mut random, round);
                    history.push(format!("Edit {round}"), plan);
                }
            }
        }
        journal.note(&history);
    }
    journal.wait().unwrap();
    assert!(leftovers(folder.path()).is_empty(), "it is being written");
    drop(journal);
    let [leftover] = leftovers(folder.path()).try_into().unwrap();
    let recovered = leftover.content.as_ref().unwrap();
    assert_eq!(recovered.history.plan(), history.plan());
    assert_eq!(recovered.base(), &house());
    assert!(!recovered.is_cut);
    assert!(leftovers(folder.path()).is_empty(), "it is offered to one program at a time");
    leftover.remove().unwrap();
    assert!(files(folder.path()).is_empty());
}

fn random_edit(plan: &Plan, random: &mut Random, round: usize) -> Plan {
    let rooms: Vec<_> = plan.rooms().map(|(id, _)| id).collect();
    let corners: Vec<_> = plan.corners().map(|(id, _)| id).collect();
    let walls: Vec<_> = plan.walls().map(|(id, _)| id).collect();
    let point = Point::new(random.unit() * 30.0, random.unit() * 30.0);
    let changed = match random.below(6) {
        0 => edit::set_name(plan, rooms[random.below(rooms.len())], &format!("Room {round}")),
        1 => edit::move_corners(plan, &[(corners[random.below(corners.len())], point)]),
        2 => edit::add_corner(plan, point).map(|(plan, _)| plan),
        3 => edit::add_wall(plan, corners[random.below(corners.len())], corners[random.below(corners.len())], 0.2)
            .map(|(plan, _)| plan),
        4 if !walls.is_empty() => edit::remove(plan, &[ElementId::Wall(walls[random.below(walls.len())])]),
        _ => Ok(named(plan, &format!("Plan {round}"))),
    };
    changed.unwrap_or_else(|_| named(plan, &format!("Round {round}")))
}

#[test]
fn the_history_comes_back_with_it() {
    let (bytes, states) = written();
    let recovered = read_journal(&bytes).unwrap();
    let titles: Vec<&str> = recovered.history.steps().iter().map(|step: &Step| step.title.as_str()).collect();
    assert_eq!(titles, ["Open", "Draw wall", "Name"]);
    assert_eq!(recovered.history.position(), 2);
    assert_eq!(recovered.history.plan(), states.last().unwrap());
    let mut history = recovered.history;
    assert_eq!(history.undo(), Some("Name"));
    assert_eq!(history.plan(), &states[1]);
}

/// What a damaged journal may give: an error, or a plan as it was after one of the steps.
fn is_one_of(result: &Result<Recovered, String>, states: &[Plan]) -> Option<usize> {
    let recovered = result.as_ref().ok()?;
    let at = states.iter().rposition(|state| state == recovered.history.plan());
    assert!(at.is_some(), "a plan that never was");
    at
}

#[test]
fn cut_off_anywhere_the_last_whole_step_comes_back() {
    let (bytes, states) = written();
    let mut steps_seen = 0;
    let mut last: Option<usize> = None;
    for length in 0..=bytes.len() {
        let result = read_journal(&bytes[..length]);
        let at = is_one_of(&result, &states);
        if at.is_some() && at != last {
            steps_seen += 1;
        }
        assert!(last.is_none() || at.is_some(), "more of it gives no less");
        last = at;
        let is_whole = result.is_ok_and(|recovered| !recovered.is_cut);
        let ends_record = length == bytes.len() || bytes[..length].ends_with(b"\n");
        assert!(!is_whole || ends_record, "at {length} something is missing");
    }
    assert_eq!(last, Some(states.len() - 1));
    // Undone and redone states are the same plans as before them.
    assert!(steps_seen >= 4, "{steps_seen}");
}

#[test]
fn a_flipped_bit_never_gives_a_plan_that_never_was() {
    let (bytes, states) = written();
    for index in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[index] ^= 1 << (index % 8);
        let result = read_journal(&damaged);
        is_one_of(&result, &states);
        assert!(!result.is_ok_and(|recovered| !recovered.is_cut), "byte {index} was not missed");
    }
}

/// A journal with these records behind its first line, as docs/recovery.md describes it.
fn with_records(records: &[Vec<u8>]) -> Vec<u8> {
    let fnv = |start: u64, bytes: &[u8]| {
        bytes.iter().fold(start, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
    };
    let mut bytes = b"enfilade journal 2\n".to_vec();
    let mut checksum: u64 = 0xcbf2_9ce4_8422_2325;
    for record in records {
        checksum = fnv(fnv(checksum, &checksum.to_le_bytes()), record);
        bytes.extend_from_slice(format!("{} {checksum:016x}\n", record.len()).as_bytes());
        bytes.extend_from_slice(record);
        bytes.push(b'\n');
    }
    bytes
}

fn start() -> Vec<u8> {
    let mut record = b"{\"do\":\"start\"}\n".to_vec();
    record.extend_from_slice(&plan_json::to_bytes(&small()));
    record
}

fn step(change: &str) -> Vec<u8> {
    format!("{{\"do\":\"step\",\"title\":\"Step\"}}\n{change}").into_bytes()
}

#[test]
fn hostile_journals_do_no_harm() {
    let sound = with_records(&[start(), step("{\"meta\":{\"name\":\"Sound\"}}")]);
    let recovered = read_journal(&sound).unwrap();
    assert_eq!((recovered.history.plan().meta().name.as_str(), recovered.is_cut), ("Sound", false));
    // A sound step, then one that is not: all before it comes back.
    let deep = format!("{{\"extra\":{}1{}}}", "[".repeat(100_000), "]".repeat(100_000));
    for wrong in [
        b"{\"do\":\"jump\",\"to\":2}\n".to_vec(),
        b"{\"do\":\"jump\",\"to\":18446744073709551615}\n".to_vec(),
        b"{\"do\":\"jump\",\"to\":-1}\n".to_vec(),
        b"{\"do\":\"format the disk\"}\n".to_vec(),
        b"no line".to_vec(),
        b"\xff\xfe\n".to_vec(),
        Vec::new(),
        start(),
        step(""),
        step("[]"),
        step("{\"unknown\":1}"),
        step("{\"gone\":[\"x123\"]}"),
        step("{\"gone\":[\"c\"]}"),
        step("{\"corners\":[{\"id\":\"c000000000000\",\"x\":1e99,\"y\":0}]}"),
        step(&deep),
        // It reads, but breaks an invariant: a wall between corners that do not exist.
        step(
            "{\"walls\":[{\"id\":\"w000000000000\",\"from\":\"c000000000000\",\"to\":\"c000000000001\",\"thickness\":0.1}]}",
        ),
    ] {
        let bytes = with_records(&[start(), step("{\"meta\":{\"name\":\"Sound\"}}"), wrong.clone()]);
        let recovered = read_journal(&bytes).unwrap();
        let shown = String::from_utf8_lossy(&wrong[..wrong.len().min(60)]).into_owned();
        assert_eq!(recovered.history.plan().meta().name, "Sound", "{shown}");
        assert!(recovered.is_cut, "{shown}");
    }
    // Lengths that are not there are no reason to make room for them.
    for length in ["9999999999", "18446744073709551616", "-1", "", "0x10", "00000000000000000000000000001"] {
        let mut bytes = sound.clone();
        bytes.extend_from_slice(format!("{length} 0123456789abcdef\n").as_bytes());
        let recovered = read_journal(&bytes).unwrap();
        assert_eq!((recovered.history.plan().meta().name.as_str(), recovered.is_cut), ("Sound", true));
    }
    for (bytes, words) in [
        (Vec::new(), "no journal"),
        (b"PK\x03\x04".to_vec(), "no journal"),
        (b"enfilade journal 2\n".to_vec(), "damaged"),
        (b"enfilade journal 3\nanything".to_vec(), "another version"),
        (with_records(&[b"{\"do\":\"start\"}\n{}".to_vec()]), "damaged"),
        (with_records(&[step("{}")]), "damaged"),
    ] {
        let error = read_journal(&bytes).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn what_is_in_its_file_is_not_offered() {
    let folder = tempfile::tempdir().unwrap();
    let mut history = History::new("Open", small());
    let mut journal = begin(folder.path(), history.plan(), None);
    history.push("Name", named(history.plan(), "Other"));
    journal.note(&history);
    history.undo();
    journal.note(&history);
    drop(journal);
    assert_eq!(files(folder.path()).len(), 1);
    assert!(leftovers(folder.path()).is_empty());
    assert!(files(folder.path()).is_empty(), "it is removed");
    // What cannot be read is offered, and never removed unasked; what is no journal is left alone.
    std::fs::write(folder.path().join("damaged.journal"), "enfilade jour").unwrap();
    std::fs::write(folder.path().join("other.txt"), "mine").unwrap();
    let [damaged] = leftovers(folder.path()).try_into().unwrap();
    assert!(damaged.content.is_err());
    assert_eq!(files(folder.path()).len(), 2);
}

#[test]
fn a_journal_takes_the_place_of_another_only_when_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let mut history = History::new("Open", small());
    let mut first = begin(folder.path(), history.plan(), None);
    history.push("Name", named(history.plan(), "One"));
    first.note(&history);
    first.wait().unwrap();
    // Where the second cannot be written, the first stays.
    let blocked = elsewhere.path().join("blocked");
    std::fs::write(&blocked, "").unwrap();
    let mut second = begin(&blocked, history.plan(), Some(Predecessor::Journal(first)));
    history.push("Name", named(history.plan(), "Two"));
    second.note(&history);
    let failure = second.wait().unwrap_err();
    assert!(failure.folder == blocked && !failure.what.is_empty(), "{failure:?}");
    assert_eq!(files(folder.path()).len(), 1);
    // Once it can be, it is, with all that waited.
    std::fs::remove_file(&blocked).unwrap();
    history.push("Name", named(history.plan(), "Three"));
    second.note(&history);
    for _ in 0..500 {
        if second.failure().is_none() && second.wait().is_ok() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert!(files(folder.path()).is_empty());
    drop(second);
    let [leftover] = leftovers(&blocked).try_into().unwrap();
    assert_eq!(leftover.content.as_ref().unwrap().history.plan(), history.plan());
    // Removing ends it for good.
    let mut third = begin(folder.path(), &small(), None);
    third.note(&history);
    third.wait().unwrap();
    third.remove();
    assert!(files(folder.path()).is_empty());
}

/// A plan of so many walls in squares.
fn of_walls(number: usize) -> Plan {
    let mut builder = Builder::new(Meta { name: "Large".to_owned(), ..Meta::default() });
    for square in 0..number / 4 {
        let (x, y) = ((square % 120) as f64 * 2.0, (square / 120) as f64 * 2.0);
        let corners =
            [(x, y), (x + 1.5, y), (x + 1.5, y + 1.5), (x, y + 1.5)].map(|(x, y)| builder.corner(Point::new(x, y)));
        for side in 0..4 {
            builder.wall(corners[side], corners[(side + 1) % 4], 0.1);
        }
    }
    builder.finish().unwrap()
}

#[test]
fn a_step_that_is_not_sound_ends_the_recovery() {
    // A step, rightly signed, gives a room without its corners; the next makes it good again.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recovery/undo-invalid.journal");
    let bytes = std::fs::read(path).unwrap();
    let recovered = read_journal(&bytes).unwrap();
    assert!(recovered.is_cut);
    assert!(recovered.unsound.as_ref().is_some_and(|what| what.starts_with("Bad room: ")), "{:?}", recovered.unsound);
    for step in recovered.history.steps() {
        assert_eq!(step.plan.violations(), []);
    }
    // It is offered, though nothing is left of it, and stays.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("plan-a.journal"), &bytes).unwrap();
    assert_eq!(leftovers(folder.path()).len(), 1);
    assert_eq!(files(folder.path()).len(), 1);
}

#[test]
fn whatever_a_step_breaks_is_noticed() {
    let plan = small();
    let room = plan.rooms().next().unwrap().0;
    let corners: Vec<_> = plan.corners().map(|(id, corner)| (id, corner.position)).collect();
    let walled = edit::add_wall(&plan, corners[0].0, corners[1].0, 0.1).unwrap().0;
    let mut start = b"{\"do\":\"start\",\"storey\":0}\n".to_vec();
    start.extend(plan_json::to_bytes(&walled));
    let step = |change: &str| format!("{{\"do\":\"step\",\"title\":\"s\"}}\n{change}").into_bytes();
    let (first, at) = corners[0];
    let hosted = |at: f64| {
        format!(
            r#""openings":[{{"id":"o000000000001","kind":"door","on":["{first}","{}"],"at":{at},"width":0.9}}]"#,
            corners[1].0
        )
    };
    let door = step(&format!("{{{}}}", hosted(1.0)));
    let pinned = step(&format!(
        r#"{{"openings":[{{"id":"o000000000002","kind":"door","from":[1,0],"to":[2,0],"joins":["{room}",null]}}]}}"#
    ));
    let picture =
        |size: &str| step(&format!(r#"{{"backdrop":[{{"path":"a.png","x":0,"y":0,"metres_per_pixel":{size}}}]}}"#));
    for (before, wrong, words) in [
        (Vec::new(), step(&format!(r#"{{"gone":["{first}"]}}"#)), "does not exist"),
        (Vec::new(), step(&format!("{{{}}}", hosted(99.0))), "beyond its edge"),
        // What depends on what changed: the door's edge, the room that it joins.
        (
            vec![door.clone()],
            step(&format!(r#"{{"corners":[{{"id":"{}","x":{},"y":{}}}]}}"#, corners[1].0, at.x, at.y)),
            "has no length",
        ),
        (vec![pinned], step(&format!(r#"{{"gone":["{room}"]}}"#)), "is pinned to the room"),
        (vec![door], picture("0"), "metres_per_pixel"),
        (vec![picture("0.01")], picture("1e308"), "metres_per_pixel"),
        (Vec::new(), picture("-1"), "metres_per_pixel"),
    ] {
        let sound = before.len();
        let records = [vec![start.clone()], before, vec![wrong, step(r#"{"meta":{"name":"later"}}"#)]].concat();
        let recovered = read_journal(&with_records(&records)).unwrap();
        assert_eq!(recovered.history.steps().len(), 1 + sound, "{words}");
        assert!(
            recovered.unsound.as_ref().is_some_and(|what| what.contains(words)),
            "{words}: {:?}",
            recovered.unsound
        );
    }
}

#[test]
#[ignore = "prints how long reading a large journal takes"]
fn what_reading_costs() {
    use std::time::Instant;
    for walls in [40, 4_000, 50_000] {
        let folder = tempfile::tempdir().unwrap();
        let mut history = History::new("Open", of_walls(walls));
        let corners: Vec<_> = history.plan().corners().map(|(id, position)| (id, position.position)).collect();
        let mut journal = begin(folder.path(), history.plan(), None);
        for edit in 0..5_000 {
            let (id, at) = corners[edit * 7 % corners.len()];
            let to = Point::new(at.x + 0.1, at.y + 0.001 * (edit % 400) as f64);
            history.push("Move corner", edit::move_corners(history.plan(), &[(id, to)]).unwrap());
            journal.note(&history);
        }
        journal.wait().unwrap();
        let bytes = std::fs::read(&files(folder.path())[0]).unwrap();
        let began = Instant::now();
        let recovered = read_journal(&bytes).unwrap();
        let took = began.elapsed();
        println!("{walls} walls: {} steps of {} bytes in {took:.1?}", recovered.history.steps().len(), bytes.len());
    }
}

#[test]
#[ignore = "prints the figures of docs/recovery.md"]
fn what_noting_costs() {
    use std::time::{Duration, Instant};
    const EDITS: u32 = 500;
    for walls in [40, 50_000] {
        let folder = tempfile::tempdir().unwrap();
        let mut history = History::new("Open", of_walls(walls));
        let corners: Vec<_> = history.plan().corners().map(|(id, position)| (id, position.position)).collect();
        let mut journal = begin(folder.path(), history.plan(), None);
        let (mut noting, mut on_disk, mut first) = (Duration::ZERO, Duration::ZERO, Duration::ZERO);
        let mut bytes = 0;
        for edit in 0..=EDITS {
            let (id, at) = corners[edit as usize * 7 % corners.len()];
            let to = Point::new(at.x + 0.1, at.y + 0.01 * f64::from(edit));
            history.push("Move corner", edit::move_corners(history.plan(), &[(id, to)]).unwrap());
            let began = Instant::now();
            journal.note(&history);
            let noted = began.elapsed();
            journal.wait().unwrap();
            let written = began.elapsed();
            if edit == 0 {
                first = written;
                bytes = std::fs::metadata(&files(folder.path())[0]).unwrap().len();
            } else {
                noting += noted;
                on_disk += written;
            }
        }
        let grown = (std::fs::metadata(&files(folder.path())[0]).unwrap().len() - bytes) / u64::from(EDITS);
        println!(
            "{walls} walls: {:.1?} of the window's time an edit, on the disk after {:.1?}, {grown} bytes; the first one, \
             with the plan of {bytes} bytes, after {first:.1?}",
            noting / EDITS,
            on_disk / EDITS
        );
    }
}
