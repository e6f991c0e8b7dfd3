//! Pages of PDF files.

use enfilade::store::pictures::{DOTS_PER_INCH, decode_picture};

use super::scan::fixture;

/// A PDF whose pages have a size in points and a content each.
pub fn pdf(pages: &[(f64, f64, &str)]) -> Vec<u8> {
    let kids: Vec<String> = (0..pages.len()).map(|i| format!("{} 0 R", 3 + 2 * i)).collect();
    let mut objects = vec![
        "<< /Type /Catalog /Pages 2 0 R >>".to_owned(),
        format!("<< /Type /Pages /Kids [{}] /Count {} >>", kids.join(" "), pages.len()),
    ];
    for (i, (width, height, content)) in pages.iter().enumerate() {
        let of = 4 + 2 * i;
        objects.push(format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Resources << >> /Contents {of} 0 R >>"
        ));
        objects.push(format!("<< /Length {} >>\nstream\n{content}\nendstream", content.len()));
    }
    file_of(&objects)
}

/// A PDF of objects, the first of which is its catalogue.
pub fn file_of(objects: &[String]) -> Vec<u8> {
    let mut file = "%PDF-1.4\n".to_owned();
    let mut places = Vec::new();
    for (i, object) in objects.iter().enumerate() {
        places.push(file.len());
        file.push_str(&format!("{} 0 obj\n{object}\nendobj\n", i + 1));
    }
    let start = file.len();
    file.push_str(&format!("xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1));
    for place in places {
        file.push_str(&format!("{place:010} 00000 n \n"));
    }
    file.push_str(&format!("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{start}\n%%EOF\n", objects.len() + 1));
    file.into_bytes()
}

#[test]
fn a_page_is_drawn_at_a_known_resolution() {
    // The upper half black, on a page of an inch by half of one; and a red page.
    let bytes = pdf(&[(72.0, 36.0, "0 g 0 18 72 18 re f"), (36.0, 36.0, "1 0 0 rg 0 0 36 36 re f")]);
    let first = decode_picture(&bytes, 1).unwrap();
    assert_eq!((first.levels.size_px(), first.pages), ([DOTS_PER_INCH as u32, DOTS_PER_INCH as u32 / 2], 2));
    let level = &first.levels.all()[0];
    assert_eq!([level.pixel(150, 30)[0], level.pixel(150, 120)[0]], [0, 255]);
    let second = decode_picture(&bytes, 2).unwrap();
    assert_eq!(second.levels.all()[0].pixel(75, 75), [255, 0, 0, 255]);
    let error = decode_picture(&bytes, 3).expect_err("there are two");
    assert!(error.what.contains("2 pages"), "{error}");
}

#[test]
fn a_page_may_count_in_units_of_its_own() {
    // 8.5 by 11 units of an inch each.
    let sheet = decode_picture(&fixture("pdf-letter-page-in-inches.pdf"), 1).unwrap();
    assert_eq!(sheet.levels.size_px(), [2550, 3300]);
}

#[test]
fn a_pdf_with_a_password_is_refused_in_words() {
    let mut objects: Vec<String> =
        ["<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>"].map(str::to_owned).to_vec();
    objects.push("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 72 72] >>".to_owned());
    // No password opens it: neither of the two checks is met (ISO 32000-1, 7.6.3).
    let digits = "00".repeat(32);
    objects.push(format!("<< /Filter /Standard /V 1 /R 2 /O <{digits}> /U <{digits}> /P -4 >>"));
    let text = String::from_utf8(file_of(&objects)).unwrap();
    let encrypted = text.replace("/Root 1 0 R", "/Root 1 0 R /Encrypt 4 0 R /ID [<00> <00>]");
    let error = decode_picture(encrypted.as_bytes(), 1).expect_err("there is no password");
    assert!(error.what.contains("needs a password"), "{error}");
}

#[test]
fn large_pages_are_drawn_coarser_and_damaged_ones_refused() {
    // Seven metres long: at 300 dots an inch 83,333 pixels, at a quarter of them as many as can be drawn.
    let long = decode_picture(&pdf(&[(20_000.0, 20.0, "")]), 1).unwrap();
    assert_eq!(long.levels.size_px(), [20_833, 20]);
    for page in [(1e9, 0.01, ""), (0.0, 72.0, "")] {
        // Read as some usual size, or refused; never in unbounded memory.
        if let Ok(picture) = decode_picture(&pdf(&[page]), 1) {
            assert!(picture.levels.size_px().into_iter().map(u64::from).product::<u64>() <= 1 << 26);
        }
    }
    let bytes = pdf(&[(72.0, 72.0, "0 g 0 0 36 36 re f")]);
    for length in (8..bytes.len()).step_by(40) {
        let _ = decode_picture(&bytes[..length], 1);
    }
    assert!(decode_picture(b"%PDF-1.4 and nothing else", 1).is_err());
}
