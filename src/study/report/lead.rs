//! What the page leads with: how good classifiers are where it counts, on a building that was not learned from and of which no label is
//! known, beside the paper's condition; and label by label.

use maud::{Markup, html};

use super::charts::{Bar, Group, bars};
use super::percent;
use crate::classify::{Algorithm, Method, Scores};
use crate::dataset::folds::Grouping;
use crate::features::NeighbourLabels;
use crate::labels::Label;
use crate::study::{About, Condition, HONEST, Study, set_title};

/// The paper's condition.
const OF_PAPER: Condition = Condition { by: Grouping::Room, neighbours: NeighbourLabels::True };

/// A row of the leading tables: a name, its colour's number, and its scores on each set.
struct Line<'a> {
    name: &'static str,
    colour: usize,
    scores: Vec<Option<&'a Scores>>,
}

/// The algorithms under a condition; under the honest one those of whole plans too.
fn lines(study: &Study, condition: Condition) -> Vec<Line<'_>> {
    let each = |algorithm: Algorithm| Line {
        name: algorithm.title(),
        colour: algorithm.index(),
        scores: study.sets.iter().map(|set| study.scores(&set.name, algorithm, condition)).collect(),
    };
    let mut lines: Vec<Line<'_>> = Algorithm::ALL.into_iter().map(each).collect();
    if condition == HONEST {
        for (index, method) in study.plan_methods().into_iter().enumerate() {
            let scores = study.sets.iter().map(|set| study.plan_scores(&set.name, method)).collect();
            lines.push(Line { name: method.title(), colour: joint_colour() + index, scores });
        }
    }
    lines
}

/// The number of the joint classifier's colour.
pub(super) fn joint_colour() -> usize {
    Algorithm::ALL.len()
}

/// The names of the algorithms with their colours, and of the methods of whole plans.
fn algorithms_legend(of_plans: &[Method]) -> Markup {
    html! {
        p.legend {
            @for (index, algorithm) in Algorithm::ALL.into_iter().enumerate() {
                span { span class=(format!("swatch swatch{index}")) {} (algorithm.title()) }
            }
            @for (index, method) in of_plans.iter().enumerate() {
                span { span class=(format!("swatch swatch{}", joint_colour() + index)) {} (method.title()) }
            }
        }
    }
}

/// In words: what a condition means for a reader.
fn in_words(condition: Condition) -> &'static str {
    match condition.neighbours {
        NeighbourLabels::True => "each room given the true labels of its neighbours",
        NeighbourLabels::Temporary => "no label given, neighbours' labels guessed from their size",
        NeighbourLabels::Predicted => "no label given",
    }
}

/// The leading section.
pub(super) fn lead(study: &Study) -> Markup {
    let Some(honest) = study.honest else { return html! {} };
    let of_honest = lines(study, honest);
    let of_paper = lines(study, OF_PAPER);
    let groups: Vec<Group> = study
        .sets
        .iter()
        .enumerate()
        .map(|(at, set)| Group {
            name: set_title(&set.name),
            bars: of_honest
                .iter()
                .filter_map(|line| {
                    let scores = line.scores[at]?;
                    let title = format!("{}, {}: {} %", set_title(&set.name), line.name, percent(scores.accuracy));
                    Some(Bar {
                        value: scores.accuracy,
                        deviation: scores.accuracy_deviation,
                        title,
                        colour: line.colour,
                    })
                })
                .collect(),
            mark: None,
        })
        .collect();
    html! {
        section {
            h2 { "A building never seen" }
            p.finding { (finding(study, &of_honest, &of_paper)) }
            (algorithms_legend(&if honest == HONEST { study.plan_methods() } else { Vec::new() }))
            (bars(&groups, "Accuracy on buildings never seen"))
            table {
                thead {
                    tr {
                        th.left rowspan="2" { "Accuracy, %" }
                        @for set in &study.sets { th.span colspan="3" { (set_title(&set.name)) } }
                    }
                    tr { @for _ in &study.sets { th { "never seen" } th { "balanced" } th { "the paper's way" } } }
                }
                tbody {
                    @for (index, line) in of_honest.iter().enumerate() {
                        tr {
                            th.left { (line.name) }
                            @for (at, scores) in line.scores.iter().enumerate() {
                                td.main { @match scores {
                                    Some(scores) => { (percent(scores.accuracy)) small { " ± " (percent(scores.accuracy_deviation)) } }
                                    None => "–"
                                } }
                                td { @match scores { Some(scores) => (percent(scores.confusion.balanced_accuracy())), None => "–" } }
                                @let printed = of_paper.get(index).and_then(|line| line.scores[at]);
                                td.paper { @match printed { Some(scores) => (percent(scores.accuracy)), None => "–" } }
                            }
                        }
                    }
                }
            }
            p.caption {
                "Never seen: folds by building, " (in_words(honest)) "; ± is the deviation over the folds. Balanced: the mean share of \
                 rooms that are right, label by label, so that frequent labels do not hide rare ones. The paper's way: folds by room, \
                 true labels of the neighbours given."
            }
        }
    }
}

/// One sentence that says what the table says.
fn finding(study: &Study, honest: &[Line<'_>], paper: &[Line<'_>]) -> Markup {
    let best = |lines: &[Line<'_>], at: usize| -> Option<(&'static str, f64)> {
        let of_set = lines.iter().filter_map(|line| Some((line.name, line.scores[at]?.accuracy)));
        of_set.max_by(|p, q| p.1.total_cmp(&q.1))
    };
    html! {
        @for (at, set) in study.sets.iter().enumerate() {
            @if let Some((name, accuracy)) = best(honest, at) {
                strong { (set_title(&set.name)) ": " (percent(accuracy)) " %" }
                " by the " (name)
                @if let Some((_, accuracy)) = best(paper, at) { ", where the paper's way of testing gives " (percent(accuracy)) " % at best" }
                ". "
            }
        }
    }
}

/// Label by label, under the honest condition: of the joint classifier where it was tested, else of the best algorithm.
pub(super) fn labels(study: &Study) -> Markup {
    let Some(honest) = study.honest else { return html! {} };
    let lines = lines(study, honest);
    let best = |at: usize| {
        let tested = lines.iter().filter_map(|line| Some((line.name, line.scores[at]?)));
        tested.max_by(|p, q| p.1.accuracy.total_cmp(&q.1.accuracy))
    };
    html! {
        section {
            h2 { "Label by label" }
            table {
                thead { tr {
                    th.left { "Set" } th.left { "By" } th.left { "Label" } th { "Rooms" } th { "Found, %" } th { "Precision, %" } th { "F1, %" }
                } }
                tbody {
                    @for (at, set) in study.sets.iter().enumerate() {
                        @if let Some((name, scores)) = best(at) {
                            @for (index, label) in Label::ALL.into_iter().enumerate() {
                                @let rates = scores.confusion.label_rates(label);
                                tr.first[index == 0] {
                                    th.left { @if index == 0 { (set_title(&set.name)) } }
                                    td.left { @if index == 0 { (name) } }
                                    td.left { (label.name()) }
                                    td { (rates.rooms) }
                                    td { (percent(rates.recall)) }
                                    td { (percent(rates.precision)) }
                                    td { (percent(rates.f1)) }
                                }
                            }
                        }
                    }
                }
            }
            p.caption {
                "The best classifier of each set on buildings never seen. Found: of the rooms with the label, those that got it (recall). \
                 Precision: of the rooms that got the label, those that have it. labels.csv has all classifiers and conditions."
            }
        }
    }
}

/// What the report was made from, and how.
pub(super) fn provenance(program: &str, about: &About) -> Markup {
    html! {
        p.provenance {
            (program)
            @if let Some(date) = &about.date { ", " (date) }
            @if !about.data.is_empty() {
                ", on " (crate::base::wording::count(about.files, "file")) " of "
                @for (index, path) in about.data.iter().enumerate() { @if index > 0 { ", " } code { (path) } }
            }
            @if !about.command.is_empty() { ". Made by " code { (about.command) } }
            "."
        }
    }
}
