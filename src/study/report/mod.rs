//! A study as a self-contained page, as tables, and as JSON.

mod charts;
mod lead;
mod page;
mod robot;
mod tables;

use serde::Serialize;

pub use robot::{robot_files, robot_text};

use super::{Condition, HONEST, Study, set_title};
use crate::classify::Algorithm;

/// The report's files: name and content.
///
/// # Errors
/// When a table cannot be written, which only lack of memory could cause.
pub fn files(study: &Study) -> Result<Vec<(String, Vec<u8>)>, std::io::Error> {
    let json = for_machines(study)?;
    let mut files = vec![("report.html".to_owned(), page::page(study).into_bytes()), ("report.json".to_owned(), json)];
    for (name, table) in tables::tables(study) {
        files.push((format!("{name}.csv"), table.csv().map_err(std::io::Error::other)?));
    }
    Ok(files)
}

/// The report of a study for machines.
fn for_machines<T: Serialize>(study: &T) -> Result<Vec<u8>, std::io::Error> {
    #[derive(Serialize)]
    struct Versioned<'a, T> {
        /// Of the form of `report.json`.
        version: u32,
        #[serde(flatten)]
        study: &'a T,
    }
    let mut json = serde_json::to_vec_pretty(&Versioned { version: 1, study })?;
    json.push(b'\n');
    Ok(json)
}

/// The accuracies under the main condition in a few lines of text, for a terminal.
pub fn summary(study: &Study) -> String {
    let mut text = String::new();
    if let Some(honest) = study.honest.filter(|honest| *honest != study.condition) {
        text.push_str(&format!("Buildings never seen: accuracy in %, {honest}\n\n"));
        accuracies(study, honest, &mut text);
        text.push('\n');
    }
    text.push_str(&format!("Accuracy in %, {} folds by {}", study.folds, study.condition.by.name()));
    text.push_str(&format!(", {} neighbour labels\n\n", study.condition.neighbours.name()));
    accuracies(study, study.condition, &mut text);
    for note in &study.notes {
        text.push_str(&format!("\n{note}"));
    }
    text
}

/// A line an algorithm under a condition.
fn accuracies(study: &Study, condition: Condition, text: &mut String) {
    let width = 24;
    text.push_str(&format!("{:<width$}", ""));
    for set in &study.sets {
        text.push_str(&format!("{:>16}", set_title(&set.name)));
    }
    text.push('\n');
    let mut line = |title: &str, cell: &dyn Fn(&str) -> Option<(f64, f64)>| {
        text.push_str(&format!("{title:<width$}"));
        for set in &study.sets {
            let cell =
                cell(&set.name).map(|(mean, deviation)| format!("{:.1} ± {:.1}", 100.0 * mean, 100.0 * deviation));
            text.push_str(&format!("{:>16}", cell.unwrap_or_else(|| "–".to_owned())));
        }
        text.push('\n');
    };
    for algorithm in Algorithm::ALL {
        line(algorithm.title(), &|set| {
            study.scores(set, algorithm, condition).map(|scores| (scores.accuracy, scores.accuracy_deviation))
        });
    }
    for method in study.plan_methods().into_iter().filter(|_| condition == HONEST) {
        line(method.title(), &|set| {
            study.plan_scores(set, method).map(|scores| (scores.accuracy, scores.accuracy_deviation))
        });
    }
    if condition == study.condition {
        let average =
            |set: &str| study.averages.iter().find(|average| average.set == set).map(|of| (of.mean, of.deviation));
        line("average", &average);
    }
}

/// A share in percent with one decimal.
fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}
