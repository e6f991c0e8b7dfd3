//! A study as a page, as tables, and as JSON.

use super::Study;

/// The report's files: name and content.
///
/// # Errors
/// When a table cannot be written, which memory alone could bring about.
pub fn files(study: &Study) -> Result<Vec<(String, Vec<u8>)>, std::io::Error> {
    let mut json = serde_json::to_vec_pretty(study)?;
    json.push(b'\n');
    Ok(vec![("report.json".to_owned(), json)])
}

/// The report in a few lines.
pub fn summary(study: &Study) -> String {
    let mut text = String::new();
    for cell in &study.accuracy {
        text.push_str(&format!(
            "{} {} {} {:.1}\n",
            cell.set,
            cell.algorithm.name(),
            cell.condition,
            100.0 * cell.scores.accuracy
        ));
    }
    text
}
