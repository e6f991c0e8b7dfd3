//! Charts as inline SVG. Colours come from the page's style sheet, so that they follow its theme and
//! print in dark ink.

use maud::{Markup, html};

/// A bar of a group with its deviation.
pub(super) struct Bar {
    pub value: f64,
    pub deviation: f64,
    pub title: String,
    /// Its colour's number.
    pub colour: usize,
}

/// Related bars, side by side.
pub(super) struct Group {
    pub name: String,
    pub bars: Vec<Bar>,
    /// A reference value and its deviation, drawn as a line and a band across the group.
    pub mark: Option<(f64, f64)>,
}

/// A line through points, and the index of its colour.
pub(super) struct Line {
    pub colour: usize,
    pub points: Vec<(f64, f64)>,
}

/// A coordinate with at most one decimal.
fn at(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Grouped bars of shares, 0..=1, on an axis from 0 to 100 %. Who cannot see the chart hears its name and what each bar says.
pub(super) fn bars(groups: &[Group], name: &str) -> Markup {
    let told: Vec<&str> = groups.iter().flat_map(|group| &group.bars).map(|bar| bar.title.as_str()).collect();
    let told = format!("{name}. {}", told.join("; "));
    const HEIGHT: f64 = 300.0;
    const TOP: f64 = 12.0;
    const LEFT: f64 = 44.0;
    const FLOOR: f64 = HEIGHT - 30.0;
    let width = 920.0;
    let y = |share: f64| FLOOR - (FLOOR - TOP) * share.clamp(0.0, 1.0);
    let group_width = (width - LEFT) / groups.len().max(1) as f64;
    let bar_width = |group: &Group| (group_width * 0.72 / group.bars.len().max(1) as f64).min(44.0);
    html! {
        svg.chart viewBox=(format!("0 0 {width} {HEIGHT}")) role="img" aria-label=(told) {
            @for step in 0..=5 {
                @let share = f64::from(step) / 5.0;
                line.grid x1=(LEFT) x2=(width) y1=(at(y(share))) y2=(at(y(share))) {}
                text.axis x=(LEFT - 8.0) y=(at(y(share) + 4.0)) text-anchor="end" { (step * 20) }
            }
            @for (index, group) in groups.iter().enumerate() {
                @let middle = LEFT + group_width * (index as f64 + 0.5);
                @let start = middle - bar_width(group) * group.bars.len() as f64 / 2.0;
                @let end = 2.0 * middle - start;
                @if let Some((mark, deviation)) = group.mark {
                    rect.paper-band x=(at(start - 12.0)) width=(at(end - start + 24.0)) y=(at(y(mark + deviation)))
                        height=(at(y(mark - deviation) - y(mark + deviation))) {}
                }
                @for (number, bar) in group.bars.iter().enumerate() {
                    @let x = start + bar_width(group) * number as f64;
                    @let centre = x + bar_width(group) / 2.0;
                    g {
                        title { (bar.title) }
                        rect class=(format!("fill{}", bar.colour)) x=(at(x + 2.0)) width=(at(bar_width(group) - 4.0))
                            y=(at(y(bar.value))) height=(at(FLOOR - y(bar.value))) rx="2" {}
                        line.whisker x1=(at(centre)) x2=(at(centre)) y1=(at(y(bar.value - bar.deviation)))
                            y2=(at(y(bar.value + bar.deviation))) {}
                        text.value x=(at(centre)) y=(at(FLOOR - 8.0)) text-anchor="middle" {
                            (format!("{:.0}", 100.0 * bar.value))
                        }
                    }
                }
                @if let Some((mark, _)) = group.mark {
                    line.paper-mark x1=(at(start - 12.0)) x2=(at(end + 12.0)) y1=(at(y(mark))) y2=(at(y(mark))) {}
                }
                text.name x=(at(middle)) y=(at(HEIGHT - 8.0)) text-anchor="middle" { (group.name) }
            }
        }
    }
}

/// The labels of an axis of a [`lines`] chart.
pub(super) struct Axis {
    pub title: &'static str,
    pub from: f64,
    pub to: f64,
    /// The ticks: position and number.
    pub ticks: Vec<(f64, String)>,
}

/// Lines in a small square chart; with `diagonal`, the line on which both axes are equal.
/// `name` says what it shows to who cannot see it; the figures stand in tables beside.
pub(super) fn lines(lines: &[Line], across: &Axis, up: &Axis, diagonal: bool, name: &str) -> Markup {
    const WIDTH: f64 = 300.0;
    const HEIGHT: f64 = 230.0;
    const LEFT: f64 = 40.0;
    const BOTTOM: f64 = HEIGHT - 40.0;
    const TOP: f64 = 10.0;
    const RIGHT: f64 = WIDTH - 12.0;
    let share = |axis: &Axis, value: f64| ((value - axis.from) / (axis.to - axis.from).max(1e-12)).clamp(0.0, 1.0);
    let x = |value: f64| LEFT + (RIGHT - LEFT) * share(across, value);
    let y = |value: f64| BOTTOM - (BOTTOM - TOP) * share(up, value);
    let path = |points: &[(f64, f64)]| {
        let points: Vec<String> = points.iter().map(|&(p, q)| format!("{},{}", at(x(p)), at(y(q)))).collect();
        points.join(" ")
    };
    html! {
        svg.chart viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label=(name) {
            @for (value, text) in &up.ticks {
                line.grid x1=(LEFT) x2=(RIGHT) y1=(at(y(*value))) y2=(at(y(*value))) {}
                text.axis x=(LEFT - 6.0) y=(at(y(*value) + 4.0)) text-anchor="end" { (text) }
            }
            @for (value, text) in &across.ticks {
                line.tick x1=(at(x(*value))) x2=(at(x(*value))) y1=(BOTTOM) y2=(BOTTOM + 4.0) {}
                text.axis x=(at(x(*value))) y=(BOTTOM + 16.0) text-anchor="middle" { (text) }
            }
            line.tick x1=(LEFT) x2=(RIGHT) y1=(BOTTOM) y2=(BOTTOM) {}
            text.axis-title x=(at((LEFT + RIGHT) / 2.0)) y=(HEIGHT - 6.0) text-anchor="middle" { (across.title) }
            @if diagonal {
                line.diagonal x1=(LEFT) y1=(BOTTOM) x2=(RIGHT) y2=(TOP) {}
            }
            @for line in lines {
                polyline class=(format!("line{}", line.colour)) points=(path(&line.points)) {}
                @for &(p, q) in &line.points {
                    circle class=(format!("fill{}", line.colour)) cx=(at(x(p))) cy=(at(y(q))) r="2.6" {}
                }
            }
        }
    }
}
