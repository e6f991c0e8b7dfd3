//! Sheets of paper: PDF, SVG and PNG to scale, the same from the command line and the registry.

use std::path::Path;

use enfilade::draw::paper::PX_PER_MM;
use enfilade::edit::{draw_room, set_meta};
use enfilade::formats::{FORMATS, Format, NamedPlan, Options, Refused};
use enfilade::geometry::Point;
use enfilade::labels::Schemes;
use enfilade::plan::{Meta, Plan};
use enfilade::store::bundled_plans;
use enfilade::store::pictures::{DOTS_PER_INCH, decode_picture};

use crate::support::{Picture, enfilade};

fn format(id: &str) -> &'static Format {
    FORMATS.iter().find(|format| format.id == id).unwrap()
}

fn written(id: &str, plan: &Plan, pairs: &[&str]) -> Result<Vec<u8>, Refused> {
    let exporter = format(id).exporter.unwrap();
    let pairs: Vec<String> = pairs.iter().map(ToString::to_string).collect();
    Options::check_names(exporter.options(), &pairs).unwrap();
    let options = Options::parse(exporter.options(), &pairs).unwrap();
    let plans = [NamedPlan { stem: "x", plan }];
    exporter.write(&plans, &Schemes::bundled(), &options).map(|mut export| export.files.remove(0).bytes)
}

/// A room of 10 x 8 m between walls 0.2 m thick.
fn hall() -> Plan {
    let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)].map(|(x, y)| Point::new(x, y));
    let (plan, _) = draw_room(&Plan::default(), &corners, Some(0.2)).unwrap();
    set_meta(&plan, Meta { name: "Hall".to_owned(), ..Meta::default() })
}

#[test]
fn the_bundled_office_is_a_small_pdf_and_always_the_same() {
    for (name, plan) in bundled_plans().unwrap() {
        let bytes = written("pdf", &plan, &["paper=A3"]).unwrap();
        assert!(bytes.starts_with(b"%PDF-1."), "{name}");
        assert!(bytes.len() < 150_000, "{name} has {} bytes", bytes.len());
        assert_eq!(bytes, written("pdf", &plan, &["paper=A3"]).unwrap(), "{name}");
        let text = String::from_utf8_lossy(&bytes);
        for dated in ["CreationDate", "ModDate", "/ID"] {
            assert!(!text.contains(dated), "{name} has {dated}");
        }
        // Text is text: in a font of which a part is embedded, with what each glyph means.
        for part in ["/ToUnicode", "/FontFile3", "+Inter-Regular", "+Inter-SemiBold", "/FlateDecode"] {
            assert!(text.contains(part), "{name} lacks {part}");
        }
    }
}

/// The outermost dark columns of a row of pixels, and how far apart they are in millimetres.
fn dark_span_mm(row: impl Iterator<Item = [u8; 4]>, px_per_mm: f64) -> f64 {
    let dark: Vec<usize> =
        row.enumerate().filter(|(_, pixel)| pixel[..3].iter().all(|&c| c < 110)).map(|(x, _)| x).collect();
    (dark.last().unwrap() - dark.first().unwrap() + 1) as f64 / px_per_mm
}

/// Without a frame the walls are the outermost that is dark in a row through the middle.
const BARE: [&str; 6] =
    ["title-block=no", "legend=no", "scale-bar=no", "dimensions=no", "colour=none", "orientation=landscape"];

#[test]
fn a_metre_at_1_to_100_is_a_centimetre_on_paper() {
    // Over the outer faces of the walls.
    const WIDTH_M: f64 = 10.2;
    for (scale, mm_per_m) in [("scale=1:100", 10.0), ("scale=1:50", 20.0), ("scale=1:200", 5.0)] {
        let pairs: Vec<&str> = BARE.into_iter().chain([scale]).collect();
        let pdf = written("pdf", &hall(), &pairs).unwrap();
        let page = decode_picture(&pdf, 1).unwrap();
        let level = &page.levels.all()[0];
        let dots = DOTS_PER_INCH / 25.4;
        assert_eq!(page.levels.size_px(), [297.0, 210.0].map(|mm: f64| (mm * dots) as u32), "{scale}");
        let middle = i64::from(level.height_px / 2) + 20;
        let row = (0..i64::from(level.width_px)).map(|x| level.pixel(x, middle));
        let shown = dark_span_mm(row, dots);
        assert!((shown - WIDTH_M * mm_per_m).abs() < 0.15, "{scale}: {shown} mm in the PDF");

        let pairs: Vec<&str> = pairs.into_iter().chain(["dpi=200"]).collect();
        let png = Picture::decode(&written("png", &hall(), &pairs).unwrap());
        let dots = 200.0 / 25.4;
        let row = (png.height / 2 + 20) as usize * png.width as usize;
        let pixels = png.rgba[4 * row..4 * (row + png.width as usize)].chunks_exact(4);
        let shown = dark_span_mm(pixels.map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]), dots);
        assert!((shown - WIDTH_M * mm_per_m).abs() < 0.2, "{scale}: {shown} mm in the PNG");
    }
}

#[test]
fn an_svg_has_its_size_in_millimetres_and_text_as_text() {
    let svg = String::from_utf8(written("svg", &hall(), &["paper=A4", "orientation=landscape"]).unwrap()).unwrap();
    assert!(svg.contains("width=\"297mm\" height=\"210mm\""), "{}", &svg[..300]);
    let width = 297.0 * PX_PER_MM;
    assert!(svg.contains(&format!("viewBox=\"0 0 {width:.2} ")), "{}", &svg[..300]);
    for text in [">Hall<", ">10.20 m<", ">8.20 m<", ">A4 landscape<"] {
        assert!(svg.contains(text), "{text} is missing");
    }
}

#[test]
fn letters_that_the_font_lacks_are_told() {
    let plan = set_meta(&hall(), Meta { name: "和室".to_owned(), ..Meta::default() });
    let exporter = format("pdf").exporter.unwrap();
    let plans = [NamedPlan { stem: "x", plan: &plan }];
    let export = exporter.write(&plans, &Schemes::bundled(), &Options::default()).unwrap();
    assert_eq!(export.lost[0].what, "letters that its font lacks, drawn as boxes: 和 室");
    assert!(decode_picture(&export.files[0].bytes, 1).is_ok());
}

#[test]
fn an_empty_plan_is_a_sheet_too() {
    for id in ["pdf", "svg", "png"] {
        assert!(!written(id, &Plan::default(), &[]).unwrap().is_empty(), "{id}");
    }
}

#[test]
fn what_does_not_fit_is_refused_with_what_does() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("office.pdf");
    let office = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans/office.plan.json");
    let call = |options: &[&str]| {
        let words = ["export", office.to_str().unwrap(), "-o", file.to_str().unwrap()];
        let options = options.iter().flat_map(|option| ["--option", option]);
        enfilade(words.into_iter().chain(options))
    };
    let (code, _, err) = call(&["scale=1:20"]);
    assert_eq!(code, 1, "{err}");
    assert!(err.contains("at 1:20 the plan is") && err.contains("take 1:"), "{err}");
    assert!(!file.exists());
    let (code, _, err) = call(&["scale=1:21"]);
    assert_eq!(code, 2, "{err}");
    assert!(err.contains("'scale' cannot be '1:21'"), "{err}");
    assert_eq!(call(&["scale=1:100", "paper=A2"]).0, 0);
    assert_eq!(std::fs::read(&file).unwrap(), written("pdf", &plan_of(&office), &["scale=1:100", "paper=A2"]).unwrap());
    let refused = written("png", &hall(), &["paper=A0", "dpi=600"]).unwrap_err();
    assert!(refused.0.contains("take up to dpi="), "{refused}");
}

fn plan_of(path: &Path) -> Plan {
    enfilade::formats::read_file(path).unwrap().plans.remove(0)
}
