//! Files that cannot be read: a clear error for each, and no panics.

use enfilade::formats::{Import, ReadError, authors_xml, plan_json};
use proptest::prelude::*;

use super::cases::cases;
use super::golden::fixture;

fn read(bytes: &[u8]) -> Result<Import, ReadError> {
    authors_xml::from_bytes(bytes, "file")
}

fn plain() -> String {
    std::fs::read_to_string(fixture("cases/plain.xml")).unwrap()
}

/// The plain case with one thing replaced, which must be there.
fn plain_with(from: &str, to: &str) -> Vec<u8> {
    let plain = plain();
    assert!(plain.contains(from), "{from}");
    plain.replacen(from, to, 1).into_bytes()
}

#[test]
fn broken_files_say_what_where_and_what_to_do() {
    let utf_16 = |big_endian: bool| -> Vec<u8> {
        let units = std::iter::once(0xfeff).chain(plain().encode_utf16().collect::<Vec<u16>>());
        units.flat_map(|unit| if big_endian { unit.to_be_bytes() } else { unit.to_le_bytes() }).collect()
    };
    let latin_1: Vec<u8> = plain()
        .replace("UTF-8", "ISO-8859-1")
        .replace("Town", "Stra\u{df}e")
        .chars()
        .map(|letter| u8::try_from(u32::from(letter)).unwrap())
        .collect();
    let nested = format!("<building id=\"b\">{}", "<floor>".repeat(100_000));
    let corners: String = (0..1_000_000).map(|i| format!("<point x=\"{}\" y=\"{}\"/>", i % 1000, i / 1000)).collect();
    let some_corners: String = corners.split_inclusive("/>").take(9000).collect();
    let portals: String = (0..1000)
        .map(|i| format!("<portal><linesegment>{i}</linesegment><target><id>A</id><id>B</id></target></portal>"))
        .collect();
    let bomb = r#"<?xml version="1.0"?>
<!DOCTYPE building [
  <!ENTITY a "aaaaaaaaaaaaaaaa">
  <!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">
]>
<building id="b"><name>&b;</name></building>"#;
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        ("empty", vec![], "is empty; restore it from a copy"),
        ("blank", b" \n\t".to_vec(), "is empty; restore it from a copy"),
        ("no XML", b"rooms: 7\n".to_vec(), "line 1: is not XML; a plan starts with <building>"),
        ("binary", vec![0x89, b'P', b'N', b'G', 0xff, 0x00], "line 1: is not UTF-8; save it again as UTF-8"),
        (
            "another root",
            b"<svg><g/></svg>".to_vec(),
            "line 1: is XML, but no plan of the authors' program: its root is <svg>; a plan starts with <building>",
        ),
        ("no rooms", b"<building id='b'><floor><spaces/></floor></building>".to_vec(), "holds no room"),
        (
            "cut off between tags",
            plain().split_once("<portals>").unwrap().0.into(),
            "is never closed; restore it from a complete copy",
        ),
        ("cut off in a tag", plain_with("<floor>", "<floor")[..530].to_vec(), "restore it from a complete copy"),
        (
            "tags crossed",
            plain_with("</spaces>", "</floor>"),
            "line 91: is not well-formed XML: expected `</spaces>`, but `</floor>` was found",
        ),
        ("text behind the end", [plain().as_bytes(), b"<building/>"].concat(), "line 94: goes on behind </building>"),
        ("not a number", plain_with("x=\"10\"", "x=\"NaN\""), "line 26, space A: x=\"NaN\" of a point is no number"),
        ("infinite", plain_with("y=\"10\"", "y=\"-inf\""), "line 26, space A: y=\"-inf\" of a point is no number"),
        (
            "far away",
            plain_with("x=\"10\"", "x=\"1e9\""),
            "line 26, space A: x=\"1e9\" of a point is no number within ±1000000",
        ),
        ("no y", plain_with(" y=\"10\"", ""), "line 26, space A: a point lacks its x or y"),
        ("no id", plain_with(" id=\"A\"", ""), "line 20: a <space> has no id"),
        (
            "id twice",
            plain_with("<space id=\"B\">", "<space id=\"A\">"),
            "line 56, space A: two rooms have this id; the first is on line 20",
        ),
        ("deep nesting", nested.into_bytes(), "line 1: elements lie deeper in each other than 64 levels"),
        (
            "a million corners",
            plain_with("<point x=\"10\" y=\"10\"/>", &corners),
            "space A: the boundary has more than 10000 corners",
        ),
        (
            "too many portals",
            [
                "<building><floor><spaces>".to_owned(),
                ["A", "B"]
                    .map(|id| {
                        format!(
                            "<space id='{id}'><bounding_polygon>{}</bounding_polygon><portals>{}</portals></space>",
                            some_corners, portals
                        )
                    })
                    .concat(),
                "</spaces></floor></building>".to_owned(),
            ]
            .concat()
            .into_bytes(),
            "line 1: has too many portals in rooms with too many corners; simplify the boundaries",
        ),
        ("an entity bomb", bomb.as_bytes().to_vec(), "line 2: declares entities of its own, which are not read"),
        ("an unknown entity", plain_with("&amp;", "&bomb;"), "line 14: '&bomb;' stands for nothing known"),
        ("a lone ampersand", plain_with("&amp;", "&"), "line 14: is not well-formed XML"),
        ("Latin-1", latin_1, "line 14: is not UTF-8; save it again as UTF-8"),
        (
            "said to be Latin-1",
            plain_with("UTF-8", "ISO-8859-1").iter().copied().chain("<!--\u{e8}-->".bytes()).collect(),
            "line 1: says that it is in ISO-8859-1",
        ),
        ("UTF-16", utf_16(false), "is UTF-16 or UTF-32, not UTF-8; save it again as UTF-8"),
        ("UTF-16, big endian", utf_16(true), "is UTF-16 or UTF-32, not UTF-8; save it again as UTF-8"),
    ];
    let mut wrong = Vec::new();
    for (name, bytes, expected) in cases {
        let found =
            read(&bytes).map_or_else(|error| error.to_string(), |import| format!("read, with {:?}", import.notes));
        if !found.contains(expected) {
            wrong.push(format!("{name}: {found:?} lacks {expected:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A change to a file, each number taken modulo what there is.
#[derive(Clone, Debug)]
pub enum Mutation {
    Cut(usize),
    Delete(usize, usize),
    Repeat(usize, usize),
    Byte(usize, u8),
    Number(usize, &'static str),
    /// Deletes, or says twice, the how-manieth line.
    Line(usize, bool),
    Word(usize, &'static str, &'static str),
}

pub fn mutation() -> impl Strategy<Value = Mutation> {
    let numbers = ["NaN", "1e9", "-1e9", "1e-300", "0", "-0", "", "1e999999", "0.5", "١", "999999", "1,5"];
    let words = [
        ("space", "spac"),
        ("PORTAL", "WALL"),
        ("EXPLICIT", ""),
        ("cm", "m"),
        ("cm", "furlong"),
        ("<id>A</id>", "<id>B</id>"),
        ("<id>B</id>", ""),
        ("d1", "d2"),
        ("point", "value"),
        ("<", "&lt;"),
        ("\"", "'"),
        ("id=", "ID="),
        ("Portal", "Window"),
        ("Wall", "Portal"),
        ("type=", "kind="),
        ("B1_200", "B1_201"),
    ];
    let at = any::<usize>;
    prop_oneof![
        at().prop_map(Mutation::Cut),
        (at(), 1..200usize).prop_map(|(at, length)| Mutation::Delete(at, length)),
        (at(), 1..2000usize).prop_map(|(at, length)| Mutation::Repeat(at, length)),
        (at(), any::<u8>()).prop_map(|(at, byte)| Mutation::Byte(at, byte)),
        (at(), proptest::sample::select(numbers.to_vec())).prop_map(|(at, number)| Mutation::Number(at, number)),
        (at(), any::<bool>()).prop_map(|(at, twice)| Mutation::Line(at, twice)),
        (at(), proptest::sample::select(words.to_vec())).prop_map(|(at, (from, to))| Mutation::Word(at, from, to)),
    ]
}

impl Mutation {
    pub fn apply(&self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        let length = bytes.len();
        let find = |bytes: &[u8], at: usize, wanted: &[u8]| {
            let start = at % length;
            let from = |range: std::ops::Range<usize>| {
                let mut windows = bytes[range.clone()].windows(wanted.len());
                windows.position(|window| window == wanted).map(|found| range.start + found)
            };
            from(start..length).or_else(|| from(0..length))
        };
        match *self {
            Self::Cut(at) => bytes.truncate(at % length),
            Self::Delete(at, count) => drop(bytes.drain(at % length..(at % length + count).min(length))),
            Self::Repeat(at, count) => {
                let piece = bytes[at % length..(at % length + count).min(length)].to_vec();
                bytes.splice(at % length..at % length, piece);
            }
            Self::Byte(at, byte) => bytes[at % length] = byte,
            Self::Number(at, number) => {
                let start = at % length;
                let Some(from) = bytes[start..].iter().position(u8::is_ascii_digit).map(|from| start + from) else {
                    return;
                };
                let digits = bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
                bytes.splice(from..from + digits, number.bytes());
            }
            Self::Line(at, twice) => {
                let start = bytes[..at % length].iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
                let end = bytes[start..].iter().position(|&byte| byte == b'\n').map_or(length, |end| start + end + 1);
                let line = bytes[start..end].to_vec();
                bytes.splice(start..end, if twice { [line.clone(), line].concat() } else { Vec::new() });
            }
            Self::Word(at, from, to) => {
                if let Some(found) = find(bytes, at, from.as_bytes()) {
                    bytes.splice(found..found + from.len(), to.bytes());
                }
            }
        }
    }
}

/// What must hold of whatever comes out of a file.
pub fn assert_sound(bytes: &[u8], read: fn(&[u8]) -> Result<Import, ReadError>) {
    match read(bytes) {
        Ok(import) => {
            assert!(!import.plans.is_empty());
            for plan in &import.plans {
                assert_eq!(plan.violations(), []);
                let saved = plan_json::to_bytes(plan);
                assert_eq!(plan_json::from_bytes(&saved).as_ref(), Ok(plan));
            }
            assert!(import.notes.iter().all(|note| !note.what.is_empty()));
            assert_eq!(read(bytes).as_ref(), Ok(&import));
        }
        Err(error) => assert!(!error.what.is_empty() && !error.hint.is_empty(), "{error:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_cases_are_read_soundly_or_refused(
        case in any::<proptest::sample::Index>(),
        mutations in proptest::collection::vec(mutation(), 1..6),
    ) {
        let cases = cases();
        let mut bytes = std::fs::read(&cases[case.index(cases.len())]).unwrap();
        for mutation in mutations {
            mutation.apply(&mut bytes);
        }
        assert_sound(&bytes, read);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_real_files_are_read_soundly_or_refused(
        file in any::<proptest::sample::Index>(),
        mutations in proptest::collection::vec(mutation(), 1..4),
    ) {
        let files = super::real::files();
        if !files.is_empty() {
            let mut bytes = std::fs::read(&files[file.index(files.len())]).unwrap();
            for mutation in mutations {
                mutation.apply(&mut bytes);
            }
            assert_sound(&bytes, read);
        }
    }
}
