//! Charts of labelled rooms: how their labels are shared out, how their features are, and how well they are told.

use super::{Axis, Bar, Chart, Dot, Ink, Marks, Point, Scale, Series};
use crate::base::wording::{count, sentence};
use crate::base::work::Round;
use crate::dataset::{Row, Statistics};
use crate::features::Features;
use crate::labels::Label;

/// Which of these charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChartKind {
    Balance,
    Histogram,
    Scatter,
    LearningCurve,
    ByBuilding,
}

/// Bins of a histogram of a measure.
const BINS: usize = 24;

/// The features as people read them, in the order of [`Features::NAMES`]: a name, and the axis.
pub const FEATURES: [&str; 8] = [
    "Area (m²)",
    "Length over width",
    "Openings",
    "Openings to small rooms",
    "Openings to medium rooms",
    "Openings to big rooms",
    "Openings to corridors",
    "Openings to halls",
];

fn axis(feature: usize) -> Axis {
    // Areas and ratios span decades, and equal ratios matter equally.
    let scale = if feature < 2 { Scale::Log } else { Scale::Whole };
    Axis::new(FEATURES[feature.min(FEATURES.len() - 1)], scale)
}

fn value(features: &Features, feature: usize) -> f64 {
    features.values().get(feature).copied().unwrap_or(f64::NAN)
}

fn titled(label: Label) -> String {
    sentence(label.name())
}

/// The share of each label, with the share in another collection beside, 0..=1.
pub fn balance(of: &str, statistics: &Statistics, beside: Option<(&str, [f64; 5])>) -> Chart {
    let place = |label: Label| [label.index() as f64 - 0.32, label.index() as f64 + 0.32];
    let mut series: Vec<Series> = Label::ALL
        .into_iter()
        .map(|label| {
            let line = &statistics.labels[label.index()];
            let said = format!("{}: {} ({:.0} %)", titled(label), count(line.rooms, "room"), 100.0 * line.share);
            let bar = Bar { across: place(label), up: [0.0, line.share], said };
            Series { name: titled(label), ink: Ink::Label(label), marks: Marks::Bars(vec![bar]) }
        })
        .collect();
    if let Some((name, shares)) = beside {
        let level = |label: Label| {
            let share = shares[label.index()];
            let said = format!("{}, {name}: {:.0} %", titled(label), 100.0 * share);
            Bar { across: place(label), up: [0.0, share], said }
        };
        let marks = Marks::Levels(Label::ALL.map(level).to_vec());
        series.push(Series { name: sentence(name), ink: Ink::Muted, marks });
    }
    Chart {
        title: format!("Labels of {of}"),
        note: beside.map(|(name, _)| format!("The lines are the shares of {name}.")).unwrap_or_default(),
        across: Axis::new("", Scale::Named(Label::ALL.map(titled).to_vec())),
        up: Axis::new("Share of the rooms", Scale::Share),
        series,
        has_legend: beside.is_some(),
    }
}

/// How often the values of a feature occur, stacked by label.
pub fn histogram(of: &str, rows: &[&Row], feature: usize) -> Chart {
    let axis = axis(feature);
    let values: Vec<(f64, Label)> = rows
        .iter()
        .map(|row| (value(&row.features, feature), row.label))
        .filter(|(value, _)| value.is_finite() && (axis.scale != Scale::Log || *value > 0.0))
        .collect();
    let edges = edges(&axis.scale, values.iter().map(|(value, _)| *value));
    let mut bins = vec![[0usize; 5]; edges.len().saturating_sub(1)];
    for &(value, label) in &values {
        let at = edges.partition_point(|edge| *edge <= value).saturating_sub(1).min(bins.len().saturating_sub(1));
        if let Some(bin) = bins.get_mut(at) {
            bin[label.index()] += 1;
        }
    }
    let bar = |label: Label, at: usize| {
        let below: usize = bins[at][..label.index()].iter().sum();
        let rooms = bins[at][label.index()];
        let span = match axis.scale {
            Scale::Whole => format!("{}", edges[at].ceil()),
            _ => format!("{:.1} to {:.1}", edges[at], edges[at + 1]),
        };
        let said = format!("{span}: {}, {}", titled(label), count(rooms, "room"));
        let up = [below as f64, (below + rooms) as f64];
        (rooms > 0).then_some(Bar { across: [edges[at], edges[at + 1]], up, said })
    };
    let series: Vec<Series> = Label::ALL
        .into_iter()
        .map(|label| Series {
            name: titled(label),
            ink: Ink::Label(label),
            marks: Marks::Bars((0..bins.len()).filter_map(|at| bar(label, at)).collect()),
        })
        .collect();
    let most = bins.iter().map(|bin| bin.iter().sum::<usize>()).max().unwrap_or_default();
    let ends = edges.first().zip(edges.last()).map(|(&from, &to)| [from, to]);
    Chart {
        title: format!("{} of {of}", FEATURES[feature.min(7)]),
        note: count(values.len(), "room"),
        across: Axis { range: ends, ..axis },
        up: Axis::new("Rooms", Scale::Linear).from_to(0.0, (most.max(1) as f64) * 1.05),
        series,
        has_legend: true,
    }
}

/// The edges of bins.
fn edges(scale: &Scale, values: impl Iterator<Item = f64>) -> Vec<f64> {
    let (from, to) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), it| (from.min(it), to.max(it)));
    if from > to {
        return vec![0.0, 1.0];
    }
    match scale {
        Scale::Whole => {
            let (first, last) = (from.floor() as i64, (to.floor() as i64).min(from.floor() as i64 + 200));
            (first..=last + 1).map(|at| at as f64 - 0.5).collect()
        }
        _ => {
            let (from, to) = (from / 1.02, to * 1.02);
            let ratio = (to / from).max(1.2);
            (0..=BINS).map(|at| from * ratio.powf(at as f64 / BINS as f64)).collect()
        }
    }
}

/// Rooms by two features, a dot each; the key of a dot is the row's index.
pub fn scatter(of: &str, rows: &[(usize, &Row)], across: usize, up: usize) -> Chart {
    let series = Label::ALL.into_iter().map(|label| {
        let of_label = rows.iter().filter(|(_, row)| row.label == label);
        let dot = |&(key, row): &(usize, &Row)| Dot {
            across: value(&row.features, across),
            up: value(&row.features, up),
            key,
        };
        Series { name: titled(label), ink: Ink::Label(label), marks: Marks::Dots(of_label.map(dot).collect()) }
    });
    Chart {
        title: sentence(of),
        note: count(rows.len(), "room"),
        across: axis(across),
        up: axis(up),
        series: series.collect(),
        has_legend: true,
    }
}

/// Learning curves: accuracy against the rooms learned from; of each the rooms, the accuracy and its deviation.
pub fn learning_curves(curves: &[(String, Vec<[f64; 3]>)]) -> Chart {
    let series = curves.iter().enumerate().map(|(number, (name, points))| {
        let point = |&[across, up, deviation]: &[f64; 3]| Point { across, up, deviation };
        let marks = Marks::Line(points.iter().map(point).collect());
        Series { name: name.clone(), ink: Ink::Number(number), marks }
    });
    Chart {
        title: "Learning curve".to_owned(),
        note: "Accuracy on rooms that were not learned from, after learning from a part of the others.".to_owned(),
        across: Axis::new("Rooms learned from", Scale::Log),
        up: Axis::new("Accuracy", Scale::Share).from_to(0.0, 1.0),
        series: series.collect(),
        has_legend: curves.len() > 1,
    }
}

/// The accuracy of each building's rooms: its name, its rooms, and how many of them are right; the worst first.
pub fn by_building(buildings: &[(String, usize, usize)]) -> Chart {
    let mut sorted: Vec<&(String, usize, usize)> = buildings.iter().filter(|(_, rooms, _)| *rooms > 0).collect();
    let share = |&(_, rooms, right): &(String, usize, usize)| right as f64 / rooms.max(1) as f64;
    // The upright axis begins at the bottom, where the best stand.
    sorted.sort_by(|p, q| share(q).total_cmp(&share(p)).then_with(|| q.0.cmp(&p.0)));
    let bar = |(at, building): (usize, &&(String, usize, usize))| {
        let (name, rooms, right) = *building;
        let said = format!("{name}: {right} of {} right ({:.0} %)", count(*rooms, "room"), 100.0 * share(building));
        Bar { across: [0.0, share(building)], up: [at as f64 - 0.36, at as f64 + 0.36], said }
    };
    let names: Vec<String> = sorted.iter().map(|(name, ..)| name.clone()).collect();
    let bars: Vec<Bar> = sorted.iter().enumerate().map(bar).collect();
    Chart {
        title: "Accuracy by building".to_owned(),
        note: "Each building's rooms were labelled by a classifier that had not seen it. The worst stand on top."
            .to_owned(),
        across: Axis::new("Share of the rooms that are right", Scale::Share).from_to(0.0, 1.0),
        up: Axis::new("", Scale::Named(names)),
        series: vec![Series { name: "Right".to_owned(), ink: Ink::Accent, marks: Marks::Bars(bars) }],
        has_legend: false,
    }
}

/// The accuracy of each fold as it is tested, of several classifiers; and their means so far.
pub fn folds(of: &[(String, Vec<f64>)], set: &str, count: usize) -> Chart {
    let most = of.iter().map(|(_, folds)| folds.len()).max().unwrap_or_default().max(count);
    let series = of.iter().enumerate().map(|(number, (name, folds))| {
        let point = |(fold, &up): (usize, &f64)| Point { across: (fold + 1) as f64, up, deviation: 0.0 };
        let marks = Marks::Line(folds.iter().enumerate().map(point).collect());
        Series { name: name.clone(), ink: Ink::Number(number), marks }
    });
    Chart {
        title: format!("Folds tested, {set}"),
        note: "Accuracy of each fold that was tested so far.".to_owned(),
        across: Axis::new("Fold", Scale::Whole).from_to(0.5, most.max(2) as f64 + 0.5),
        up: Axis::new("Accuracy", Scale::Share).from_to(0.0, 1.0),
        series: series.collect(),
        has_legend: true,
    }
}

/// How a net learns: its loss by round.
pub fn rounds(of: &[Round]) -> Chart {
    let line = |name: &str, number: usize, loss: &dyn Fn(&Round) -> Option<f64>| {
        let point = |it: &Round| Some(Point { across: (it.round + 1) as f64, up: loss(it)?, deviation: 0.0 });
        let points = of.iter().filter_map(point).collect();
        Series { name: name.to_owned(), ink: Ink::Number(number), marks: Marks::Line(points) }
    };
    let (learned, held_out) = (line("Training", 0, &|it| Some(it.loss)), line("Held out", 1, &|it| it.held_out_loss));
    let most = of.iter().map(|it| it.loss.max(it.held_out_loss.unwrap_or_default())).fold(0.1, f64::max);
    Chart {
        title: "Loss of the perceptron that learns".to_owned(),
        note: "Loss over the rooms that the net learns from, and over those held out to see when to stop.".to_owned(),
        across: Axis::new("Epoch", Scale::Whole),
        up: Axis::new("Cross-entropy", Scale::Linear).from_to(0.0, most),
        series: [learned, held_out]
            .into_iter()
            .filter(|it| !matches!(&it.marks, Marks::Line(of) if of.is_empty()))
            .collect(),
        has_legend: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(label: Label, area_m2: f64, doors: u32) -> Row {
        Row::new(label, Features { area_m2, axes_ratio: 1.5, doors, doors_to: [0; 5] })
    }

    #[test]
    fn a_histogram_counts_every_room_once() {
        let rows: Vec<Row> = (1..=60)
            .map(|it| row(if it % 3 == 0 { Label::Corridor } else { Label::SmallRoom }, f64::from(it), it % 7))
            .collect();
        let rows: Vec<&Row> = rows.iter().collect();
        for (feature, name) in FEATURES.iter().enumerate() {
            let chart = histogram("all", &rows, feature);
            let mut rooms = 0.0;
            for series in &chart.series {
                let Marks::Bars(bars) = &series.marks else { panic!("bars") };
                rooms += bars.iter().map(|bar| bar.up[1] - bar.up[0]).sum::<f64>();
            }
            assert_eq!(rooms, 60.0, "{name}");
        }
    }

    #[test]
    fn nothing_makes_empty_charts() {
        assert!(histogram("nothing", &[], 0).is_empty());
        assert!(scatter("nothing", &[], 0, 2).is_empty());
        assert!(by_building(&[]).is_empty() && learning_curves(&[]).is_empty());
        assert!(folds(&[], "school plans", 10).is_empty() && rounds(&[]).is_empty());
    }

    #[test]
    fn the_table_of_a_scatter_plot_has_a_line_for_each_room() {
        let rows = [row(Label::Hall, 61.5, 3), row(Label::SmallRoom, 6.0, 1)];
        let rows: Vec<(usize, &Row)> = rows.iter().enumerate().collect();
        let csv = scatter("all", &rows, 0, 2).csv(&["room"], &|key| vec![format!("R{key}")]).unwrap();
        let text = String::from_utf8(csv).unwrap();
        assert_eq!(text, "series,Area (m²),Openings,deviation,room\nSmall room,6,1,,R1\nHall,61.5,3,,R0\n");
    }
}
