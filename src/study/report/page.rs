//! The page.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::charts::{Axis, Bar, Group, Line, bars, lines};
use super::lead::{joint_colour, labels, lead, provenance};
use super::percent;
use crate::classify::{Algorithm, Scores};
use crate::dataset::sets::STANDARD;
use crate::features::Features;
use crate::study::noise::{CONTRADICTED, WITHOUT_SIZE};
use crate::study::{Comparison, ConfusionTable, Rival, Study, letters, paper::PaperFigures, set_title};

/// The whole page: style, pictures and text in one file.
pub(super) fn page(study: &Study) -> String {
    let paper = PaperFigures::bundled();
    let paper = paper.as_ref();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Room classifiers by building typology" }
                style { (PreEscaped(include_str!("page.css"))) (PreEscaped(further_colours())) }
            }
            body {
                main {
                    (head(study))
                    (lead(study))
                    (labels(study))
                    (accuracy(study, paper))
                    (typology(study))
                    (foreign(study, paper))
                    (conditions(study))
                    (joint(study))
                    (noise(study))
                    (typologies(study))
                    (unknown(study))
                    (confusion(study, paper))
                    (rooms(study, paper))
                    (curves(study))
                    (importance(study))
                    (calibration(study))
                    (method(study))
                }
            }
        }
    };
    with_scrolling_tables(page)
}

/// A page in which each table scrolls by itself where the page is narrow, by finger and by key.
pub(super) fn with_scrolling_tables(page: Markup) -> String {
    let scrolled = "<div class=\"scroll\" role=\"region\" aria-label=\"Table\" tabindex=\"0\"><table";
    page.into_string().replace("<table", scrolled).replace("</table>", "</table></div>")
}

fn head(study: &Study) -> Markup {
    html! {
        header {
            h1 { "Room classifiers by building typology" }
            p.lead {
                "Labels of rooms predicted from " i { "F" sub { "r" } }
                " = ⟨a, rt, d, l" sub { "S" } ", l" sub { "M" } ", l" sub { "B" } ", l" sub { "C" } ", l" sub { "H" }
                "⟩ by " (in_words(Algorithm::ALL.len())) " algorithms, learned from each typology and from all together; measured as in section 4.2 of \
                 Luperto, Quattrini Li and Amigoni, and beyond. Grey figures in brackets and grey bands are the \
                 paper's, measured on its own buildings."
            }
            (provenance(&study.program, &study.about))
            p {
                "The page leads with what a new building meets: " em { "never seen" } ". All sections that do not say otherwise stand under "
                strong { (study.condition) } ", " (study.folds) " folds, seed " (study.seed) "."
            }
        }
        table.wide {
            thead { tr { th.left { "Set" } th { "Rooms" } th { "Plans" } th { "Buildings" } th { "Most frequent label, %" } } }
            tbody {
                @for set in &study.sets {
                    tr {
                        th.left { (set_title(&set.name)) }
                        td { (set.rooms) } td { (set.plans) } td { (set.buildings) } td { (percent(set.most_frequent)) }
                    }
                }
            }
        }
        @if !study.notes.is_empty() {
            ul.notes { @for note in &study.notes { li { (note) } } }
        }
    }
}

/// A small number in words: 'four'.
fn in_words(number: usize) -> String {
    let words = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"];
    words.get(number).map_or_else(|| number.to_string(), |word| (*word).to_owned())
}

/// Learners that the style sheet has colours for.
const COLOURS: usize = 4;

/// Styles of the other learners: hues a golden angle apart, so that they differ however many there are.
fn further_colours() -> String {
    let style = |index: usize| {
        let colour = format!("hsl({:.0} 35% var(--further))", (137.5 * index as f64) % 360.0);
        format!(
            ".swatch{index} {{ background: {colour} }} .fill{index} {{ fill: {colour} }} \
             .line{index} {{ fill: none; stroke-width: 1.8; stroke: {colour} }}\n"
        )
    };
    (COLOURS..=joint_colour() + 1).map(style).collect()
}

/// The names of the algorithms with their colours.
fn legend(with_paper: bool) -> Markup {
    html! {
        p.legend {
            @for (index, algorithm) in Algorithm::ALL.into_iter().enumerate() {
                span { span class=(format!("swatch swatch{index}")) {} (algorithm.title()) }
            }
            @if with_paper { span { span.swatch.paper-swatch {} "the paper, average ± deviation" } }
        }
    }
}

fn accuracy(study: &Study, paper: Option<&PaperFigures>) -> Markup {
    let groups: Vec<Group> = study
        .sets
        .iter()
        .map(|set| Group {
            name: set_title(&set.name),
            bars: Algorithm::ALL
                .into_iter()
                .filter_map(|algorithm| {
                    let scores = study.scores(&set.name, algorithm, study.condition)?;
                    Some(Bar {
                        value: scores.accuracy,
                        deviation: scores.accuracy_deviation,
                        colour: algorithm.index(),
                        title: format!("{}, {algorithm}: {} %", set_title(&set.name), percent(scores.accuracy)),
                    })
                })
                .collect(),
            mark: paper
                .and_then(|paper| paper.accuracy.get(&set.name))
                .map(|printed| (printed.mean / 100.0, printed.deviation / 100.0)),
        })
        .collect();
    html! {
        section {
            h2 { "Accuracy, " (study.condition) " (Fig. 4)" }
            (legend(true))
            (bars(&groups, "Accuracy of each algorithm on each set, with the paper's average"))
            table {
                thead { tr {
                    th.left { "Accuracy, %" }
                    @for set in &study.sets { th { (set_title(&set.name)) } }
                } }
                tbody {
                    @for algorithm in Algorithm::ALL {
                        tr {
                            th.left { (algorithm.title()) }
                            @for set in &study.sets {
                                td { (with_deviation(study.scores(&set.name, algorithm, study.condition))) }
                            }
                        }
                    }
                    tr.total {
                        th.left { "Average" }
                        @for set in &study.sets {
                            @let average = study.averages.iter().find(|average| average.set == set.name);
                            td { @if let Some(average) = average {
                                (percent(average.mean)) small { " ± " (percent(average.deviation)) }
                            } @else { "–" } }
                        }
                    }
                    tr.paper {
                        th.left { "The paper's average" }
                        @for set in &study.sets {
                            td { @if let Some(printed) = paper.and_then(|paper| paper.accuracy.get(&set.name)) {
                                (format!("{:.1}", printed.mean)) small { " ± " (format!("{:.1}", printed.deviation)) }
                            } @else { "–" } }
                        }
                    }
                }
            }
            p.caption { "± is the deviation over the folds. The standard classifiers learned from all typologies and are tested on all." }
        }
    }
}

fn with_deviation(scores: Option<&Scores>) -> Markup {
    html! {
        @if let Some(scores) = scores {
            (percent(scores.accuracy)) small { " ± " (percent(scores.accuracy_deviation)) }
        } @else { "–" }
    }
}

/// A difference of accuracies with its interval, coloured when chance does not explain it.
fn difference(comparison: &Comparison) -> Markup {
    let class = match comparison {
        _ if !is_settled(comparison) => "even",
        Comparison { difference, .. } if *difference > 0.0 => "better",
        _ => "worse",
    };
    html! {
        span class=(class) { (format!("{:+.1}", 100.0 * comparison.difference)) }
        small { (format!(" [{:+.1}, {:+.1}]", 100.0 * comparison.low, 100.0 * comparison.high)) }
    }
}

/// Whether the interval leaves out no difference, and chance alone would seldom do it: only then a sentence may say which is better.
fn is_settled(comparison: &Comparison) -> bool {
    leaves_out_zero(comparison) && comparison.p < 0.05
}

fn leaves_out_zero(comparison: &Comparison) -> bool {
    comparison.low > 0.0 || comparison.high < 0.0
}

fn p_value(p: f64) -> String {
    if p < 0.001 { "< 0.001".to_owned() } else { format!("{p:.3}") }
}

fn algorithm_title(algorithm: Option<Algorithm>) -> &'static str {
    algorithm.map_or("average", Algorithm::title)
}

fn typology(study: &Study) -> Markup {
    if study.own_against_standard.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "Does knowing the typology help?" }
            @if let Some(honest) = study.honest.filter(|_| !study.own_against_standard_honest.is_empty()) {
                h3 { "On buildings never seen (" (honest) ")" }
                (own_against_standard(&study.own_against_standard_honest))
                h3 { "Under " (study.condition) }
            }
            (own_against_standard(&study.own_against_standard))
            p.caption {
                "Both are tested on the same rooms and learned without the same rooms. Intervals are bootstrapped over \
                 buildings, p-values come from a paired permutation test that flips whole buildings: rooms of one \
                 building are not independent. A sentence says which is better only where the interval leaves out 0 and p is below 0.05."
            }
        }
    }
}

fn own_against_standard(rivals: &[Rival]) -> Markup {
    html! {
        @for rival in rivals.iter().filter(|rival| rival.algorithm.is_none()) { p.finding { (verdict(rival)) } }
        table {
            thead { tr {
                th.left { "Rooms of" } th.left { "Algorithm" } th { "Own, %" } th { "Standard, %" }
                th { "Difference [95 %]" } th { "p" }
            } }
            tbody {
                @for rival in rivals {
                    @let first = rival.algorithm == Some(Algorithm::ALL[0]);
                    tr.total[rival.algorithm.is_none()].first[first] {
                        th.left { @if first { (set_title(&rival.rooms_of)) } }
                        td.left { (algorithm_title(rival.algorithm)) }
                        td { (percent(rival.comparison.first)) }
                        td { (percent(rival.comparison.second)) }
                        td { (difference(&rival.comparison)) }
                        td { (p_value(rival.comparison.p)) }
                    }
                }
            }
        }
    }
}

fn verdict(rival: &Rival) -> Markup {
    let comparison = &rival.comparison;
    let Comparison { difference, p, low, high, buildings, .. } = *comparison;
    let set = set_title(&rival.rooms_of);
    let points =
        format!("{:.1} points {}", 100.0 * difference.abs(), if difference < 0.0 { "worse" } else { "better" });
    let interval = format!(
        "95 % interval {:+.1} to {:+.1}, p {}, {}",
        100.0 * low,
        100.0 * high,
        p_value(p),
        crate::base::wording::count(buildings, "building")
    );
    html! {
        @if is_settled(comparison) && difference > 0.0 {
            strong { (set) ": it helps. " }
            "The typology's own classifiers are " (points) " on average (" (interval) ")."
        } @else if is_settled(comparison) {
            strong { (set) ": it hurts. " }
            "The typology's own classifiers are " (points) " on average (" (interval)
            "): the rooms of other typologies teach them something."
        } @else if leaves_out_zero(comparison) || p < 0.05 {
            strong { (set) ": not settled. " }
            "The typology's own classifiers are " (points) " on average, and interval and test do not agree whether chance explains it ("
            (interval) ")."
        } @else {
            strong { (set) ": no effect shown. " }
            "The typology's own classifiers are " (points) " on average, which chance may explain: the interval holds 0 (" (interval) ")."
        }
    }
}

fn foreign(study: &Study, paper: Option<&PaperFigures>) -> Markup {
    if study.own_against_foreign.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "Classifiers of another typology" }
            table {
                thead { tr {
                    th.left { "Rooms of" } th.left { "Classifiers of" } th.left { "Algorithm" } th { "Foreign, %" }
                    th { "Paper, %" } th { "Own, %" } th { "Own less foreign [95 %]" } th { "p" }
                } }
                tbody {
                    @for rival in &study.own_against_foreign {
                        @let algorithm = rival.algorithm.map_or("average", Algorithm::name);
                        @let first = rival.algorithm == Some(Algorithm::ALL[0]);
                        tr.total[rival.algorithm.is_none()].first[first] {
                            th.left { @if first { (set_title(&rival.rooms_of)) } }
                            td.left { @if first { (set_title(&rival.rival)) } }
                            td.left { (algorithm_title(rival.algorithm)) }
                            td { (percent(rival.comparison.second)) small { " ± " (percent(rival.rival_deviation)) } }
                            td.paper { @match paper.and_then(|paper| paper.cross(&rival.rooms_of, &rival.rival, algorithm)) {
                                Some([mean, deviation]) => { (format!("{mean:.1}")) small { (format!(" ± {deviation:.1}")) } }
                                None => "–"
                            } }
                            td { (percent(rival.comparison.first)) }
                            td { (difference(&rival.comparison)) }
                            td { (p_value(rival.comparison.p)) }
                        }
                    }
                }
            }
            p.caption { "Foreign classifiers learned from all rooms of their typology; ± is the deviation over the folds of the tested rooms." }
        }
    }
}

fn conditions(study: &Study) -> Markup {
    let conditions = study.conditions();
    if conditions.len() < 2 {
        return html! {};
    }
    html! {
        section {
            h2 { "Buildings never seen, neighbours not known" }
            p {
                "The paper deals rooms to folds, so that rooms of one building stand on both sides, and gives each room \
                 the true labels of its neighbours. In use, neither holds. " em { "By building" } " no building is on \
                 both sides; " em { "temporary" } " labels are the naive classifier's; " em { "predicted" } " ones are \
                 the classifier's own, repeated until nothing changes, of a building of which no label is given."
            }
            table {
                thead {
                    tr {
                        th.left rowspan="2" { "Set" } th.left rowspan="2" { "Algorithm" }
                        @for by in ["room", "building"] {
                            @let columns = conditions.iter().filter(|condition| condition.by.name() == by).count();
                            @if columns > 0 { th.span colspan=(columns) { "folds by " (by) } }
                        }
                    }
                    tr { @for condition in &conditions { th { (condition.neighbours.name()) } } }
                }
                tbody {
                    @for set in &study.sets {
                        @for (index, algorithm) in Algorithm::ALL.into_iter().enumerate() {
                            tr.first[index == 0] {
                                th.left { @if index == 0 { (set_title(&set.name)) } }
                                td.left { (algorithm.title()) }
                                @for condition in &conditions {
                                    td.main[*condition == study.condition] {
                                        @match study.scores(&set.name, algorithm, *condition) {
                                            Some(scores) => (percent(scores.accuracy)),
                                            None => "–"
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
            p.caption { "Accuracy in %. The shaded column is the condition of the other tables." }
        }
    }
}

fn joint(study: &Study) -> Markup {
    if study.joint.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "All rooms of a plan together" }
            p {
                "The joint classifier looks at each room in relation to the others of its plan, and at what is believed of \
                 its neighbours. The blend is the mean of what the joint classifier and the perceptron say, those of the \
                 typology and those of all. Both know no label and no room of the tested buildings; beside them stands the \
                 best of the four under the same condition."
            }
            table {
                thead { tr {
                    th.left { "Set" } th.left { "By" } th { "Right, %" } th { "Best of the four, %" } th.left { "which is" }
                    th { "Difference [95 %]" } th { "p" } th { "Log loss" } th { "Calibration error, %" }
                } }
                tbody {
                    @for cell in &study.joint {
                        tr {
                            th.left { (set_title(&cell.set)) }
                            td.left { (cell.method.title()) }
                            td { (percent(cell.scores.accuracy)) small { " ± " (percent(cell.scores.accuracy_deviation)) } }
                            td { (percent(cell.comparison.second)) }
                            td.left { (cell.best.title()) }
                            td { (difference(&cell.comparison)) }
                            td { (p_value(cell.comparison.p)) }
                            td { (format!("{:.3}", cell.scores.log_loss)) }
                            td { (percent(cell.scores.calibration_error)) }
                        }
                    }
                }
            }
        }
    }
}

fn noise(study: &Study) -> Markup {
    if study.noise.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "What the labels allow" }
            p {
                "Rooms of one building are alike if their areas and axes ratios are within 10 % and they have as many openings. \
                 Where such rooms bear different labels, nobody can label all of them correctly from the drawing alone."
            }
            table {
                thead { tr {
                    th.left { "Set" } th { "Rooms" } th { "Contradicted by one alike, %" } th { "Ceiling among those alike, %" }
                    th { "The blend, %" } th { "without contradicted functions, %" } th { "functions without a size, %" }
                } }
                tbody {
                    @for of in &study.noise {
                        tr {
                            th.left { (set_title(&of.set)) }
                            td { (of.rooms) }
                            td { (percent(of.contradicted)) }
                            td { (percent(of.ceiling)) }
                            td { (percent(of.accuracy)) }
                            td { (percent(of.accuracy_clear)) small { " of " (of.rooms_clear) } }
                            td {
                                @match of.accuracy_without_size {
                                    Some(accuracy) => { (percent(accuracy)) small { " of " (of.rooms_without_size) } }
                                    None => "–"
                                }
                            }
                        }
                    }
                }
            }
            p.caption {
                "Contradicted functions: " (CONTRADICTED.join(", ")) ". The size that their names state is not the one drawn. \
                 Functions without a size: " (WITHOUT_SIZE.join(", ")) ". The authors' own vocabularies give them none; their \
                 labels are Enfilade's."
            }
        }
    }
}

fn unknown(study: &Study) -> Markup {
    if study.unknown.is_empty() {
        return html! {};
    }
    html! {
        section {
            h2 { "Behind a door not yet opened" }
            table {
                thead { tr {
                    th.left { "Set" } th { "Openings, both sides" } th { "Right, %" } th { "Most frequent label, %" }
                    th { "Difference [95 %]" } th { "p" }
                } }
                tbody {
                    @for cell in &study.unknown {
                        tr {
                            th.left { (set_title(&cell.set)) }
                            td { (cell.comparison.rooms) }
                            td { (percent(cell.comparison.first)) }
                            td { (percent(cell.comparison.second)) }
                            td { (difference(&cell.comparison)) }
                            td { (p_value(cell.comparison.p)) }
                        }
                    }
                }
            }
            p.caption {
                "The label of the room behind an opening, predicted from the room on this side, whose label and other \
                 neighbours are known; folds that never split a building."
            }
        }
    }
}

fn typologies(study: &Study) -> Markup {
    let Some(first) = study.typologies.first() else { return html! {} };
    html! {
        section {
            h2 { "Inferring the typology" }
            table {
                thead { tr {
                    th.left { "Plans of" }
                    @for count in &first.plans { th { "taken for " (count.taken_for) } }
                    th { "Plans right, %" } th { "Buildings" } th { "Buildings right, %" }
                } }
                tbody {
                    @for line in &study.typologies {
                        tr {
                            th.left { (set_title(&line.typology)) }
                            @for count in &line.plans { td { (count.plans) } }
                            td { (percent(line.plan_accuracy)) }
                            td { (line.buildings) }
                            td { (percent(line.building_accuracy)) }
                        }
                    }
                }
            }
            p.caption { "From measures of the plan alone, no label known, folds that never split a building." }
            @if !study.typology_ways.is_empty() {
                h3 { "By several ways" }
                table {
                    thead { tr {
                        th.left { "Way" } th { "Plans right, %" } th { "Buildings right, %" }
                        @for line in &study.typologies { th { (set_title(&line.typology)) ", %" } }
                    } }
                    tbody {
                        @for way in &study.typology_ways {
                            tr {
                                th.left { (way.way) }
                                td { (percent(way.plan_accuracy)) }
                                td { (percent(way.building_accuracy)) }
                                @for share in &way.plans_of { td { (percent(*share)) } }
                            }
                        }
                    }
                }
                p.caption { "Means over the typologies, which count alike however many plans they have; plans right by typology behind them." }
            }
        }
    }
}

fn confusion(study: &Study, paper: Option<&PaperFigures>) -> Markup {
    html! {
        section {
            h2 { "Confusion (Table 1)" }
            div.pair { @for of_set in &study.confusion { (matrix(of_set, paper)) } }
            p.caption {
                "Rows are true labels, columns predicted ones, in % of the row, averaged over the algorithms; below each the \
                 paper's. As in the paper, of the rooms with a label TP got it and FP did not; of those without it TN did not \
                 get it and FN did."
            }
        }
    }
}

fn matrix(of_set: &ConfusionTable, paper: Option<&PaperFigures>) -> Markup {
    let printed = paper.and_then(|paper| paper.confusion(&of_set.set));
    let shade = |share: f64| format!("--share:{share:.3}");
    html! {
        div {
            h3 { (set_title(&of_set.set)) }
            table.matrix {
                thead { tr {
                    th {}
                    @for letter in letters() { th { (letter) } }
                    @for rate in ["TP", "FP", "TN", "FN"] { th.rate { (rate) } }
                } }
                tbody {
                    @for (row, letter) in letters().into_iter().enumerate() {
                        @let rates = of_set.rates[row];
                        @let theirs = printed.map(|of| {
                            let tp = of.rows[row][row];
                            [tp, 100.0 - tp, of.true_negatives[row], of.false_negatives[row]]
                        });
                        tr {
                            th { (letter) }
                            @for column in 0..5 {
                                td.cell.hit[row == column] style=(shade(of_set.shares[row][column])) {
                                    (percent(of_set.shares[row][column]))
                                    @if let Some(of) = printed { br; small { (format!("{:.1}", of.rows[row][column])) } }
                                }
                            }
                            @for (index, rate) in [rates.tp, rates.fp, rates.tn, rates.fn_].into_iter().enumerate() {
                                td.rate {
                                    (percent(rate))
                                    @if let Some(theirs) = theirs { br; small { (format!("{:.1}", theirs[index])) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn rooms(study: &Study, paper: Option<&PaperFigures>) -> Markup {
    html! {
        section {
            h2 { "The rooms (Table 2)" }
            table {
                thead { tr {
                    th.left { "Set" } th { "Label" } th { "Rooms" } th { "Share, %" } th { "a, m²" } th { "d" } th { "rt" }
                } }
                tbody {
                    @for of_set in &study.rooms {
                        @for (index, line) in of_set.labels.iter().enumerate() {
                            @let theirs = paper.and_then(|paper| paper.rooms.get(&of_set.set)?.get(&line.label));
                            tr.first[index == 0] {
                                th.left { @if index == 0 { (set_title(&of_set.set)) } }
                                td { (line.label) }
                                td { (line.rooms) }
                                td { (percent(line.share)) (in_brackets(theirs.map(|of| format!("{:.1}", of.share)))) }
                                td {
                                    (format!("{:.1} ± {:.1}", line.area_mean_m2, line.area_deviation_m2))
                                    (in_brackets(theirs.map(|of| format!("{:.1} ± {:.1}", of.area_m2[0], of.area_m2[1]))))
                                }
                                td {
                                    (format!("{:.1} ± {:.1}", line.doors_mean, line.doors_deviation))
                                    (in_brackets(theirs.map(|of| format!("{:.1} ± {:.1}", of.doors[0], of.doors[1]))))
                                }
                                td {
                                    (format!("{:.1}", line.axes_ratio_mean))
                                    (in_brackets(theirs.map(|of| format!("{:.1}", of.axes_ratio))))
                                }
                            }
                        }
                    }
                }
            }
            p.caption { "Mean ± deviation; the paper's in brackets." }
        }
    }
}

fn in_brackets(text: Option<String>) -> Markup {
    html! { @if let Some(text) = text { small.printed { " (" (text) ")" } } }
}

fn percent_axis(title: &'static str, from: f64, to: f64) -> Axis {
    let steps = ((to - from) / 0.2).round() as usize;
    let ticks = (0..=steps).map(|step| from + 0.2 * step as f64).map(|at| (at, format!("{:.0}", 100.0 * at))).collect();
    Axis { title, from, to, ticks }
}

fn curves(study: &Study) -> Markup {
    if study.learning_curves.is_empty() {
        return html! {};
    }
    let lowest = study.learning_curves.iter().flat_map(|curve| &curve.points).map(|point| point.accuracy);
    let from = (lowest.fold(1.0, f64::min) / 0.2).floor() * 0.2;
    html! {
        section {
            h2 { "Learning curves" }
            (legend(false))
            div.small-charts {
                @for set in &study.sets {
                    @let of_set: Vec<_> = study.learning_curves.iter().filter(|curve| curve.set == set.name).collect();
                    @let most = of_set.iter().flat_map(|curve| &curve.points).map(|point| point.training_rooms).fold(1.0, f64::max);
                    @let least = of_set.iter().flat_map(|curve| &curve.points).map(|point| point.training_rooms).fold(most, f64::min);
                    @let axis = Axis {
                        title: "training rooms",
                        from: least.ln(),
                        to: most.ln(),
                        ticks: ticks_of_rooms(least, most),
                    };
                    @let drawn: Vec<Line> = of_set.iter().map(|curve| Line {
                        colour: curve.algorithm.index(),
                        points: curve.points.iter().map(|point| (point.training_rooms.ln(), point.accuracy)).collect(),
                    }).collect();
                    figure {
                        figcaption { (set_title(&set.name)) }
                        (lines(&drawn, &axis, &percent_axis("accuracy, %", from, 1.0), false, &format!("{}: accuracy by number of training rooms, one line an algorithm; the figures are in learning_curves.csv", set_title(&set.name))))
                    }
                }
            }
            @if !study.joint_curves.is_empty() {
                table {
                    thead { tr {
                        th.left { "Joint classifier, buildings never seen" } th { "from a quarter of the others" } th { "half" } th { "all" }
                    } }
                    tbody {
                        @for curve in &study.joint_curves {
                            tr {
                                th.left { (set_title(&curve.set)) }
                                @for point in &curve.points {
                                    td { (percent(point.accuracy)) small { (format!(" {:.0} rooms", point.training_rooms)) } }
                                }
                            }
                        }
                    }
                }
            }
            p.caption { "Accuracy in % on the same tested rooms after learning from 5 % to all of the others." }
        }
    }
}

/// Round numbers between two, for a logarithmic axis: a few of 1, 2, 5 times powers of ten.
fn ticks_of_rooms(least: f64, most: f64) -> Vec<(f64, String)> {
    let round = (0..7).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power)));
    let mut inside: Vec<f64> = round.filter(|rooms| (least..=most).contains(rooms)).collect();
    while inside.len() > 5 {
        inside = inside.into_iter().step_by(2).collect();
    }
    inside.into_iter().map(|rooms| (rooms.ln(), format!("{rooms}"))).collect()
}

fn importance(study: &Study) -> Markup {
    if study.importance.is_empty() {
        return html! {};
    }
    let most = study.importance.iter().flat_map(|of| of.accuracy_lost).fold(0.01, f64::max);
    html! {
        section {
            h2 { "What each feature is worth" }
            table {
                thead { tr {
                    th.left { "Set" } th.left { "Algorithm" }
                    @for name in Features::NAMES { th { (feature_name(name)) } }
                } }
                tbody {
                    @for of in &study.importance {
                        @let first = of.algorithm == Algorithm::ALL[0];
                        tr.first[first] {
                            th.left { @if first { (set_title(&of.set)) } }
                            td.left { (of.algorithm.title()) }
                            @for lost in of.accuracy_lost {
                                td.cell style=(format!("--share:{:.3}", (lost / most).clamp(0.0, 1.0))) {
                                    (points(lost))
                                }
                            }
                        }
                    }
                }
            }
            p.caption { "Points of accuracy lost when the feature's values are shuffled among the tested rooms." }
        }
    }
}

/// Percentage points with one decimal, without a minus sign before zero.
fn points(share: f64) -> String {
    let rounded = (share * 1000.0).round() / 10.0;
    format!("{:.1}", if rounded == 0.0 { 0.0 } else { rounded })
}

fn feature_name(name: &str) -> Markup {
    html! {
        @match name.split_once('_') {
            Some((letter, label)) => { (letter) sub { (label) } }
            None => (name)
        }
    }
}

fn calibration(study: &Study) -> Markup {
    html! {
        section {
            h2 { "Can the probabilities be believed?" }
            (legend(false))
            div.small-charts {
                @for set in &study.sets {
                    @let drawn: Vec<Line> = Algorithm::ALL.into_iter().filter_map(|algorithm| {
                        let scores = study.scores(&set.name, algorithm, study.condition)?;
                        let bins = scores.reliability.iter().filter(|bin| bin.rooms >= LEAST_IN_BIN);
                        Some(Line {
                            colour: algorithm.index(),
                            points: bins.map(|bin| (bin.probability, bin.right)).collect(),
                        })
                    }).collect();
                    figure {
                        figcaption { (set_title(&set.name)) }
                        (lines(&drawn, &percent_axis("probability said, %", 0.0, 1.0), &percent_axis("right, %", 0.0, 1.0), true, &format!("{}: share of rooms right by the probability said, one line an algorithm; the figures are in reliability.csv", set_title(&set.name))))
                    }
                }
            }
            table {
                thead { tr {
                    th.left { "Set" } th.left { "Algorithm" } th { "Log loss" } th { "Brier" } th { "Calibration error, %" }
                } }
                tbody {
                    @for set in &study.sets {
                        @for algorithm in Algorithm::ALL {
                            @if let Some(scores) = study.scores(&set.name, algorithm, study.condition) {
                                tr.first[algorithm == Algorithm::ALL[0]] {
                                    th.left { @if algorithm == Algorithm::ALL[0] { (set_title(&set.name)) } }
                                    td.left { (algorithm.title()) }
                                    td { (format!("{:.3}", scores.log_loss)) }
                                    td { (format!("{:.3}", scores.brier)) }
                                    td { (percent(scores.calibration_error)) }
                                }
                            }
                        }
                    }
                }
            }
            p.caption {
                "Of the rooms whose label is said with a probability of 80 %, 80 % should be right: on the diagonal. Bins of fewer \
                 than " (LEAST_IN_BIN) " rooms are not drawn. Knowing nothing has log loss 1.61 and Brier score 0.80."
            }
        }
    }
}

/// The fewest rooms in a bin of the reliability diagram for it to be meaningful.
const LEAST_IN_BIN: usize = 10;

fn method(study: &Study) -> Markup {
    let standard = study.sets.iter().any(|set| set.name == STANDARD);
    html! {
        section.method {
            h2 { "How this was measured" }
            ul {
                li { (study.program) ", seed " (study.seed) ": the same data and seed give the same report, byte for byte." }
                @if standard {
                    li { "The standard set's folds are the typologies' folds put together: own and standard classifiers are \
                          tested on the same rooms." }
                }
                li { "The same numbers stand in report.json and in the CSV files beside this page." }
                @for set in &study.sets {
                    li { "Data of " (set.name) ": fingerprint " code { (set.fingerprint) } }
                }
            }
        }
    }
}
