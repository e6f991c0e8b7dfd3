//! The study's tables as rows of cells, for CSV.

use super::percent;
use crate::classify::{Algorithm, Method};
use crate::features::Features;
use crate::labels::Label;
use crate::study::paper::PaperFigures;
use crate::study::{HONEST, Rival, Study, letters};

/// A table with a header.
pub(super) struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(|&cell| cell.to_owned()).collect(), rows: Vec::new() }
    }

    pub fn push(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// The table as CSV.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.header)?;
        for row in &self.rows {
            writer.write_record(row)?;
        }
        writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
    }
}

/// Four decimals: more than the folds can distinguish.
fn number(value: f64) -> String {
    format!("{value:.4}")
}

/// A figure of the paper; empty where it has none.
fn printed(value: Option<f64>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

/// All tables with their names.
pub(super) fn tables(study: &Study) -> Vec<(&'static str, Table)> {
    let paper = PaperFigures::bundled();
    vec![
        ("accuracy", accuracy(study, paper.as_ref())),
        ("labels", labels(study)),
        ("confusion", confusion(study, paper.as_ref())),
        ("rooms", rooms(study, paper.as_ref())),
        ("own_against_standard", rivals(&study.own_against_standard, None)),
        ("own_against_standard_never_seen", rivals(&study.own_against_standard_honest, None)),
        ("own_against_foreign", rivals(&study.own_against_foreign, paper.as_ref())),
        ("learning_curves", learning_curves(study)),
        ("importance", importance(study)),
        ("reliability", reliability(study)),
        ("joint", joint(study)),
        ("noise", noise(study)),
        ("typologies", typologies(study)),
        ("typology_ways", typology_ways(study)),
        ("unknown", unknown(study)),
    ]
}

fn accuracy(study: &Study, paper: Option<&PaperFigures>) -> Table {
    let mut table = Table::new(&[
        "set",
        "algorithm",
        "folds_by",
        "neighbour_labels",
        "folds",
        "rooms",
        "accuracy",
        "deviation",
        "balanced_accuracy",
        "log_loss",
        "brier",
        "calibration_error",
        "paper_mean_percent",
    ]);
    for cell in &study.accuracy {
        let scores = &cell.scores;
        table.push([
            cell.set.clone(),
            cell.algorithm.name().to_owned(),
            cell.condition.by.name().to_owned(),
            cell.condition.neighbours.name().to_owned(),
            cell.fold_count.to_string(),
            scores.rooms.to_string(),
            number(scores.accuracy),
            number(scores.accuracy_deviation),
            number(scores.confusion.balanced_accuracy()),
            number(scores.log_loss),
            number(scores.brier),
            number(scores.calibration_error),
            printed(paper.and_then(|paper| Some(paper.accuracy.get(&cell.set)?.mean))),
        ]);
    }
    table
}

fn labels(study: &Study) -> Table {
    let mut table = Table::new(&[
        "set",
        "algorithm",
        "folds_by",
        "neighbour_labels",
        "label",
        "rooms",
        "recall",
        "precision",
        "f1",
    ]);
    let of_learners =
        study.accuracy.iter().map(|cell| (&cell.set, cell.algorithm.name(), cell.condition, &cell.scores));
    let of_joint = study.joint.iter().map(|cell| (&cell.set, cell.method.name(), HONEST, &cell.scores));
    for (set, algorithm, condition, scores) in of_learners.chain(of_joint) {
        for label in Label::ALL {
            let rates = scores.confusion.label_rates(label);
            let head = [set.as_str(), algorithm, condition.by.name(), condition.neighbours.name(), label.letter()];
            let numbers = [rates.recall, rates.precision, rates.f1].map(number);
            table.push(head.map(str::to_owned).into_iter().chain([rates.rooms.to_string()]).chain(numbers));
        }
    }
    table
}

fn typology_ways(study: &Study) -> Table {
    let of: Vec<String> = study.typologies.iter().map(|line| format!("plans_right_{}", line.typology)).collect();
    let header: Vec<&str> =
        ["way", "plans_right", "buildings_right"].into_iter().chain(of.iter().map(String::as_str)).collect();
    let mut table = Table::new(&header);
    for way in &study.typology_ways {
        let numbers = [way.plan_accuracy, way.building_accuracy].into_iter().chain(way.plans_of.iter().copied());
        table.push([way.way.clone()].into_iter().chain(numbers.map(number)));
    }
    table
}

fn confusion(study: &Study, paper: Option<&PaperFigures>) -> Table {
    let mut table = Table::new(&[
        "set", "true", "S", "M", "B", "C", "H", "TP", "FP", "TN", "FN", "paper_S", "paper_M", "paper_B", "paper_C",
        "paper_H", "paper_TN", "paper_FN",
    ]);
    for of_set in &study.confusion {
        let printed_set = paper.and_then(|paper| paper.confusion(&of_set.set));
        for (index, letter) in letters().into_iter().enumerate() {
            let rates = of_set.rates[index];
            let ours = of_set.shares[index].into_iter().chain([rates.tp, rates.fp, rates.tn, rates.fn_]).map(percent);
            let theirs = (0..5)
                .map(|column| printed_set.map(|set| set.rows[index][column]))
                .chain([
                    printed_set.map(|set| set.true_negatives[index]),
                    printed_set.map(|set| set.false_negatives[index]),
                ])
                .map(printed);
            table.push([of_set.set.clone(), letter.to_owned()].into_iter().chain(ours).chain(theirs));
        }
    }
    table
}

fn rooms(study: &Study, paper: Option<&PaperFigures>) -> Table {
    let mut table = Table::new(&[
        "set",
        "label",
        "rooms",
        "share_percent",
        "a_mean_m2",
        "a_deviation_m2",
        "d_mean",
        "d_deviation",
        "rt_mean",
        "paper_share_percent",
        "paper_a_mean_m2",
        "paper_a_deviation_m2",
        "paper_d_mean",
        "paper_d_deviation",
        "paper_rt_mean",
    ]);
    for of_set in &study.rooms {
        for line in &of_set.labels {
            let theirs = paper.and_then(|paper| paper.rooms.get(&of_set.set)?.get(&line.label));
            let theirs = [
                theirs.map(|of| of.share),
                theirs.map(|of| of.area_m2[0]),
                theirs.map(|of| of.area_m2[1]),
                theirs.map(|of| of.doors[0]),
                theirs.map(|of| of.doors[1]),
                theirs.map(|of| of.axes_ratio),
            ];
            let ours = [
                of_set.set.clone(),
                line.label.clone(),
                line.rooms.to_string(),
                percent(line.share),
                number(line.area_mean_m2),
                number(line.area_deviation_m2),
                number(line.doors_mean),
                number(line.doors_deviation),
                number(line.axes_ratio_mean),
            ];
            table.push(ours.into_iter().chain(theirs.map(printed)));
        }
    }
    table
}

fn rivals(rivals: &[Rival], paper: Option<&PaperFigures>) -> Table {
    let mut table = Table::new(&[
        "rooms_of",
        "rival",
        "algorithm",
        "rooms",
        "buildings",
        "own",
        "by_rival",
        "rival_deviation",
        "difference",
        "low_95",
        "high_95",
        "p",
        "paper_rival_percent",
    ]);
    for rival in rivals {
        let algorithm = rival.algorithm.map_or("average", Algorithm::name);
        let theirs = paper.and_then(|paper| paper.cross(&rival.rooms_of, &rival.rival, algorithm));
        let comparison = &rival.comparison;
        table.push([
            rival.rooms_of.clone(),
            rival.rival.clone(),
            algorithm.to_owned(),
            comparison.rooms.to_string(),
            comparison.buildings.to_string(),
            number(comparison.first),
            number(comparison.second),
            number(rival.rival_deviation),
            number(comparison.difference),
            number(comparison.low),
            number(comparison.high),
            number(comparison.p),
            printed(theirs.map(|[mean, _]| mean)),
        ]);
    }
    table
}

fn learning_curves(study: &Study) -> Table {
    let mut table = Table::new(&["set", "algorithm", "training_rooms", "accuracy", "deviation"]);
    for curve in &study.learning_curves {
        for point in &curve.points {
            table.push([
                curve.set.clone(),
                curve.algorithm.name().to_owned(),
                format!("{:.1}", point.training_rooms),
                number(point.accuracy),
                number(point.deviation),
            ]);
        }
    }
    for curve in &study.joint_curves {
        for point in &curve.points {
            table.push([
                curve.set.clone(),
                Method::Joint.name().to_owned(),
                format!("{:.1}", point.training_rooms),
                number(point.accuracy),
                number(point.deviation),
            ]);
        }
    }
    table
}

fn importance(study: &Study) -> Table {
    let header: Vec<&str> = ["set", "algorithm"].into_iter().chain(Features::NAMES).collect();
    let mut table = Table::new(&header);
    for of in &study.importance {
        let head = [of.set.clone(), of.algorithm.name().to_owned()];
        table.push(head.into_iter().chain(of.accuracy_lost.map(number)));
    }
    table
}

fn joint(study: &Study) -> Table {
    let mut table = Table::new(&[
        "set",
        "algorithm",
        "rooms",
        "buildings",
        "right",
        "best_of_four",
        "which",
        "difference",
        "low_95",
        "high_95",
        "p",
        "log_loss",
        "brier",
        "calibration_error",
    ]);
    for cell in &study.joint {
        let comparison = &cell.comparison;
        table.push([
            cell.set.clone(),
            cell.method.name().to_owned(),
            comparison.rooms.to_string(),
            comparison.buildings.to_string(),
            number(comparison.first),
            number(comparison.second),
            cell.best.name().to_owned(),
            number(comparison.difference),
            number(comparison.low),
            number(comparison.high),
            number(comparison.p),
            number(cell.scores.log_loss),
            number(cell.scores.brier),
            number(cell.scores.calibration_error),
        ]);
    }
    table
}

fn noise(study: &Study) -> Table {
    let mut table = Table::new(&[
        "set",
        "rooms",
        "contradicted",
        "ceiling",
        "accuracy",
        "rooms_clear",
        "accuracy_clear",
        "rooms_without_size",
        "accuracy_without_size",
    ]);
    for of in &study.noise {
        table.push([
            of.set.clone(),
            of.rooms.to_string(),
            number(of.contradicted),
            number(of.ceiling),
            number(of.accuracy),
            of.rooms_clear.to_string(),
            number(of.accuracy_clear),
            of.rooms_without_size.to_string(),
            of.accuracy_without_size.map(number).unwrap_or_default(),
        ]);
    }
    table
}

fn unknown(study: &Study) -> Table {
    let header = ["set", "openings", "buildings", "right", "most_frequent", "difference", "low_95", "high_95", "p"];
    let mut table = Table::new(&header);
    for cell in &study.unknown {
        let comparison = &cell.comparison;
        let shares = [comparison.first, comparison.second, comparison.difference, comparison.low, comparison.high];
        let counts = [cell.set.clone(), comparison.rooms.to_string(), comparison.buildings.to_string()];
        table.push(counts.into_iter().chain(shares.map(number)).chain([number(comparison.p)]));
    }
    table
}

fn typologies(study: &Study) -> Table {
    let taken_for = study.typologies.first().map(|line| line.plans.as_slice()).unwrap_or_default();
    let columns: Vec<String> = taken_for.iter().map(|count| format!("taken_for_{}", count.taken_for)).collect();
    let header: Vec<&str> = std::iter::once("plans_of")
        .chain(columns.iter().map(String::as_str))
        .chain(["plans_right", "buildings", "buildings_right"])
        .collect();
    let mut table = Table::new(&header);
    for line in &study.typologies {
        let counts = line.plans.iter().map(|count| count.plans.to_string());
        let ends = [number(line.plan_accuracy), line.buildings.to_string(), number(line.building_accuracy)];
        table.push(std::iter::once(line.typology.clone()).chain(counts).chain(ends));
    }
    table
}

fn reliability(study: &Study) -> Table {
    let mut table = Table::new(&["set", "algorithm", "from", "to", "rooms", "mean_probability", "right"]);
    for cell in study.accuracy.iter().filter(|cell| cell.condition == study.condition) {
        for bin in cell.scores.reliability.iter().filter(|bin| bin.rooms > 0) {
            table.push([
                cell.set.clone(),
                cell.algorithm.name().to_owned(),
                format!("{:.1}", bin.from),
                format!("{:.1}", bin.to),
                bin.rooms.to_string(),
                number(bin.probability),
                number(bin.right),
            ]);
        }
    }
    table
}
