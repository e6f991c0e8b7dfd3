//! The study of robots as a self-contained page, as a text, as tables and as JSON.

use std::fmt::Write as _;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::charts::{Axis, Line, lines};
use super::lead::provenance;
use super::page::with_scrolling_tables;
use super::tables::Table;
use super::{for_machines, percent, set_title};
use crate::study::robot::{Factor, Gap, RobotCondition, RobotStudy, View};

/// The report's files: name and content.
///
/// # Errors
/// When a table cannot be written, which only lack of memory could cause.
pub fn robot_files(study: &RobotStudy) -> Result<Vec<(String, Vec<u8>)>, std::io::Error> {
    let mut files = vec![
        ("report.html".to_owned(), page(study).into_bytes()),
        ("report.md".to_owned(), robot_text(study).into_bytes()),
        ("report.json".to_owned(), for_machines(study)?),
    ];
    for (name, table) in [("conditions", conditions(study)), ("labels", labels(study)), ("runs", runs(study))] {
        files.push((format!("{name}.csv"), table.csv().map_err(std::io::Error::other)?));
    }
    Ok(files)
}

/// The name of a set for people.
fn title(set: &str) -> String {
    if set == "all" { "All".to_owned() } else { set_title(set) }
}

fn or_dash(share: Option<f64>) -> String {
    share.map_or_else(|| "–".to_owned(), percent)
}

/// How a difference reads: '+1.2 points [-0.5, +2.9], p 0.210, 12 buildings'.
fn gap_in_words(gap: &Gap) -> String {
    let it = &gap.comparison;
    format!(
        "{:+.1} points [{:+.1}, {:+.1}], p {:.3}, {} in {}",
        100.0 * it.difference,
        100.0 * it.low,
        100.0 * it.high,
        it.p,
        crate::base::wording::count(it.rooms, "room"),
        crate::base::wording::count(it.buildings, "building")
    )
}

/// What a condition's line holds, as a row of texts: rooms, then edges, then labels.
const COLUMNS: [&str; 10] = [
    "runs",
    "rooms found, %",
    "of its rooms right, %",
    "edges found, %",
    "of its edges right, %",
    "ideal, %",
    "true plan, %",
    "robot, %",
    "standard, %",
    "joint, %",
];

fn cells(study: &RobotStudy, set: &str, condition: &RobotCondition) -> Option<[String; COLUMNS.len()]> {
    let line = study.condition(set, condition)?;
    let average = study.label(set, condition, "average")?;
    let joint = study.label(set, condition, "joint")?;
    Some([
        line.runs.to_string(),
        percent(line.room_recall),
        percent(line.room_precision),
        percent(line.edge_recall),
        percent(line.edge_precision),
        or_dash(average.own[0]),
        or_dash(average.own[1]),
        or_dash(average.own[2]),
        or_dash(average.standard[2]),
        or_dash(joint.own[2]),
    ])
}

/// What the columns mean.
const LEGEND: &str = "Rooms found: of the rooms in the robot's reach, those found with an intersection over union above 0.7. Its rooms and \
     edges right: the share of what it put into its plan. The other columns are label accuracy on the rooms it found, mean of the \
     paper's algorithms: ideal is the true plan with the neighbours' true labels given (the paper's conditions), true plan the same \
     without any label given, robot the robot's own plan without any, all three by the typology's classifiers; standard is the \
     robot's plan by the standard classifiers, joint by the joint classifier of the typology. No classifier learned from the building.";

/// The whole report as Markdown, which also reads well in a terminal.
pub fn robot_text(study: &RobotStudy) -> String {
    let mut text = String::from("# What a robot makes of labels\n\n");
    let _ = writeln!(
        text,
        "{} of {} explored, {} read; {}; seed {}, {} folds by building.\n",
        crate::base::wording::count(study.explored_plans, "plan"),
        crate::base::wording::count(study.explored_buildings, "building"),
        study.plans,
        crate::base::wording::count(study.runs.len(), "run"),
        study.options.seed,
        study.options.folds
    );
    for set in &study.sets {
        let _ = writeln!(text, "## {}\n\n| condition | {} |", title(set), COLUMNS.join(" | "));
        let _ = writeln!(text, "| --- |{}", " ---: |".repeat(COLUMNS.len()));
        for condition in study.options.conditions() {
            if let Some(cells) = cells(study, set, &condition) {
                let _ = writeln!(text, "| {} | {} |", condition.words(), cells.join(" | "));
            }
        }
        text.push('\n');
        for gap in study.gaps.iter().filter(|gap| gap.set == *set) {
            let _ = writeln!(text, "- {} against {}, {}: {}", gap.first, gap.second, gap.method, gap_in_words(gap));
        }
        text.push('\n');
    }
    let _ = writeln!(text, "{LEGEND}");
    for note in &study.notes {
        let _ = writeln!(text, "\nNote: {note}.");
    }
    if !study.about.command.is_empty() {
        let _ = writeln!(text, "\nMade by `{}`.", study.about.command);
    }
    text
}

/// The page.
fn page(study: &RobotStudy) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Labels of rooms that a robot found" }
                style { (PreEscaped(include_str!("page.css"))) }
            }
            body {
                main {
                    header {
                        h1 { "Labels of rooms that a robot found" }
                        p.lead {
                            "A simulated robot explores each plan by itself, and the rooms of its map are labelled by classifiers that did \
                             not learn from the building. What sensor noise, odometry noise and furniture cost, beside the true plan: \
                             the paper's ideal conditions (section 4.1)."
                        }
                        (provenance(&study.program, &study.about))
                        p {
                            (crate::base::wording::count(study.explored_plans, "plan")) " of "
                            (crate::base::wording::count(study.explored_buildings, "building")) " explored, " (study.plans)
                            " read; " (crate::base::wording::count(study.runs.len(), "run")) "; " (study.options.folds)
                            " folds by building; seed " (study.options.seed) "."
                        }
                        @if !study.notes.is_empty() { ul.notes { @for note in &study.notes { li { (note) } } } }
                    }
                    @for factor in Factor::ALL { (along(study, factor)) }
                    (everything(study))
                    (gaps(study))
                }
            }
        }
    };
    with_scrolling_tables(page)
}

/// Charts of what changes along a factor.
fn along(study: &RobotStudy, factor: Factor) -> Markup {
    let levels: Vec<f64> =
        study.sets.first().map(|set| study.along(set, factor)).into_iter().flatten().map(|at| at.0).collect();
    let (Some(&from), Some(&to)) = (levels.first(), levels.last()) else { return html! {} };
    if from == to {
        return html! {};
    }
    let across = Axis {
        title: factor.title(),
        from,
        to,
        ticks: levels.iter().map(|level| (*level, level.to_string())).collect(),
    };
    let up = Axis {
        title: "%",
        from: 0.0,
        to: 1.0,
        ticks: (0..=5).map(|step| (f64::from(step) / 5.0, (step * 20).to_string())).collect(),
    };
    // What is drawn, of a line of a condition and a line of labels.
    type Drawn = fn(&crate::study::robot::ConditionLine, Option<&crate::study::robot::LabelLine>) -> Option<f64>;
    let charts: [(&str, Drawn); 4] = [
        ("Rooms found", |line, _| Some(line.room_recall)),
        ("Its rooms that are right", |line, _| Some(line.room_precision)),
        ("Edges found", |line, _| Some(line.edge_recall)),
        ("Labels right, of rooms found", |_, labels| labels?.own[2]),
    ];
    html! {
        section {
            h2 { (factor.title()) }
            p.legend {
                @for (index, set) in study.sets.iter().enumerate() {
                    span { span class=(format!("swatch swatch{}", index % 4)) {} (title(set)) }
                }
            }
            div.small-charts {
                @for (name, drawn) in charts {
                    figure {
                        figcaption { (name) ", %" }
                        @let drawn_lines: Vec<Line> = study.sets.iter().enumerate().map(|(index, set)| Line {
                            colour: index % 4,
                            points: study.along(set, factor).into_iter()
                                .filter_map(|(level, line, labels)| Some((level, drawn(line, labels)?))).collect(),
                        }).collect();
                        (lines(&drawn_lines, &across, &up, false, &format!("{name} by {}", factor.title())))
                    }
                }
            }
        }
    }
}

/// All conditions of all sets.
fn everything(study: &RobotStudy) -> Markup {
    html! {
        section {
            h2 { "All conditions" }
            @for set in &study.sets {
                h3 { (title(set)) }
                table {
                    thead { tr { th.left { "Condition" } @for column in COLUMNS { th { (column) } } } }
                    tbody {
                        @for condition in study.options.conditions() {
                            @if let Some(cells) = cells(study, set, &condition) {
                                tr { th.left { (condition.words()) } @for cell in cells { td { (cell) } } }
                            }
                        }
                    }
                }
            }
            p.caption { (LEGEND) }
        }
    }
}

fn gaps(study: &RobotStudy) -> Markup {
    if study.gaps.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "What chance may explain" }
            table {
                thead { tr {
                    th.left { "Set" } th.left { "First" } th.left { "Second" } th.left { "By" } th { "First, %" } th { "Second, %" }
                    th { "Difference [95 %]" } th { "p" } th { "Rooms" } th { "Buildings" }
                } }
                tbody {
                    @for gap in &study.gaps {
                        @let it = &gap.comparison;
                        tr {
                            th.left { (title(&gap.set)) } td.left { (gap.first) } td.left { (gap.second) } td.left { (gap.method) }
                            td { (percent(it.first)) } td { (percent(it.second)) }
                            td { (format!("{:+.1} [{:+.1}, {:+.1}]", 100.0 * it.difference, 100.0 * it.low, 100.0 * it.high)) }
                            td { (format!("{:.3}", it.p)) } td { (it.rooms) } td { (it.buildings) }
                        }
                    }
                }
            }
            p.caption {
                "Labels right on the same rooms, under the usual noise. Intervals are bootstrapped over buildings, p-values come from a \
                 permutation test that flips whole buildings: an interval that holds 0 shows no difference."
            }
        }
    }
}

fn number(value: f64) -> String {
    format!("{value:.4}")
}

fn optional(value: Option<f64>) -> String {
    value.map(number).unwrap_or_default()
}

fn condition_cells(condition: &RobotCondition) -> [String; 3] {
    [condition.sensor_noise.to_string(), condition.odometry_noise.to_string(), condition.furniture.to_string()]
}

fn conditions(study: &RobotStudy) -> Table {
    let mut table = Table::new(&[
        "set",
        "sensor_noise",
        "odometry_noise",
        "furniture",
        "runs",
        "ended",
        "rooms",
        "found",
        "split",
        "merged",
        "missed",
        "found_rooms",
        "room_recall",
        "room_precision",
        "iou",
        "true_edges",
        "right_edges",
        "wrong_edges",
        "edge_recall",
        "edge_precision",
        "driven_m",
        "collisions",
        "path_error_m",
    ]);
    for line in &study.conditions {
        let counts =
            [line.runs, line.ended, line.rooms, line.found, line.split, line.merged, line.missed, line.found_rooms];
        table.push(
            std::iter::once(line.set.clone())
                .chain(condition_cells(&line.condition))
                .chain(counts.map(|count| count.to_string()))
                .chain([line.room_recall, line.room_precision, line.iou].map(number))
                .chain([line.true_edges, line.right_edges, line.wrong_edges].map(|count| count.to_string()))
                .chain([line.edge_recall, line.edge_precision].map(number))
                .chain([number(line.driven_m), line.collisions.to_string(), number(line.path_error_m)]),
        );
    }
    table
}

fn labels(study: &RobotStudy) -> Table {
    let mut table = Table::new(&[
        "set",
        "sensor_noise",
        "odometry_noise",
        "furniture",
        "method",
        "seen_as",
        "rooms",
        "typology_classifier",
        "standard_classifier",
        "found_and_right",
    ]);
    for line in &study.labels {
        for (at, view) in View::ALL.into_iter().enumerate() {
            let last = if view == View::Robot { line.found_and_right } else { None };
            table.push(
                std::iter::once(line.set.clone())
                    .chain(condition_cells(&line.condition))
                    .chain([line.method.clone(), view.title().to_owned(), line.rooms.to_string()])
                    .chain([line.own[at], line.standard[at], last].map(optional)),
            );
        }
    }
    table
}

fn runs(study: &RobotStudy) -> Table {
    let mut table = Table::new(&[
        "file",
        "plan",
        "building",
        "typology",
        "sensor_noise",
        "odometry_noise",
        "furniture",
        "seed",
        "outcome",
        "rooms",
        "found",
        "found_rooms",
        "unreachable",
        "true_edges",
        "right_edges",
        "wrong_edges",
        "driven_m",
        "collisions",
        "path_error_m",
        "labelled",
        "labels_right_average",
        "labels_right_joint",
    ]);
    for line in &study.runs {
        let texts = [&line.file, &line.plan, &line.building, &line.typology].map(Clone::clone);
        let counts = [
            line.rooms,
            line.found,
            line.found_rooms,
            line.unreachable,
            line.true_edges,
            line.right_edges,
            line.wrong_edges,
        ];
        table.push(
            texts
                .into_iter()
                .chain(condition_cells(&line.condition))
                .chain([line.seed.to_string(), line.outcome.to_owned()])
                .chain(counts.map(|count| count.to_string()))
                .chain([number(line.driven_m), line.collisions.to_string(), number(line.path_error_m)])
                .chain([line.labelled.to_string(), optional(line.right)])
                .chain([line.right_joint.map(|right| right.to_string()).unwrap_or_default()]),
        );
    }
    table
}
