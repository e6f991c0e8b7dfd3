//! The legend of the robot's map.

use egui::{FontId, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};

use crate::app::look::{
    theme,
    widgets::{colours, put_line},
};
use crate::app::session::robot::run::Source;
use crate::app::state::App;
use crate::base::wording::sentence;
use crate::draw::{Palette, RobotColours};
use crate::labels::Label;

/// A sign of the legend.
#[derive(Clone, Copy)]
enum Sign {
    Robot,
    Solid,
    Dashed,
    Dotted,
    Wall,
    Frontier,
    Fan,
    Doorway,
    Unknown,
    Room(Label),
}

pub(super) fn legend(app: &App, ui: &mut Ui) {
    let palette = app.session.palette(ui);
    ui.add_space(4.0);
    let mut signs = vec![
        (Sign::Robot, "Robot"),
        (Sign::Fan, "Laser"),
        (Sign::Wall, "Segments"),
        (Sign::Unknown, "Not seen yet"),
        (Sign::Frontier, "Frontier"),
        (Sign::Doorway, "Doorway"),
    ];
    if app.session.robot.settings.shows_paths {
        signs.push((Sign::Solid, "Path as estimated"));
        let knows_truth = app.session.robot_run().is_some_and(|run| matches!(run.source, Source::Plan(_)));
        if knows_truth {
            signs.push((Sign::Dashed, "True path"));
        }
        signs.push((Sign::Dotted, "By odometry alone"));
    }
    let names: Vec<(Label, String)> = Label::ALL.into_iter().map(|label| (label, sentence(label.name()))).collect();
    signs.extend(names.iter().map(|(label, name)| (Sign::Room(*label), name.as_str())));
    let half = ui.available_width() / 2.0;
    for pair in signs.chunks(2) {
        let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), 19.0), Sense::hover());
        for (column, (sign, name)) in pair.iter().enumerate() {
            let left = row.left() + column as f32 * half;
            let at = pos2(left + 11.0, row.center().y);
            paint_sign(ui, at, *sign, palette);
            let text = Rect::from_min_max(pos2(left + 28.0, row.top()), pos2(left + half - 2.0, row.bottom()));
            put_line(ui, name, FontId::proportional(theme::SMALL), colours(ui).text, text);
        }
    }
}

fn paint_sign(ui: &Ui, at: Pos2, sign: Sign, palette: &Palette) {
    let robot = RobotColours::of(palette.theme);
    let painter = ui.painter();
    let ends = [at - vec2(10.0, 0.0), at + vec2(10.0, 0.0)];
    let colour = theme::colour;
    match sign {
        Sign::Robot => {
            painter.circle(at, 6.0, colour(robot.estimate), Stroke::new(1.0, colour(robot.free)));
            let tip = |x: f32, y: f32| at + vec2(x, y);
            let arrow = vec![tip(4.0, 0.0), tip(-2.5, -3.0), tip(-2.5, 3.0)];
            painter.add(Shape::convex_polygon(arrow, colour(robot.free), Stroke::NONE));
        }
        Sign::Solid => drop(painter.line_segment(ends, Stroke::new(2.2, colour(robot.estimate)))),
        Sign::Dashed => painter.extend(Shape::dashed_line(&ends, Stroke::new(1.2, colour(robot.truth)), 5.0, 3.0)),
        Sign::Dotted => painter.extend(Shape::dotted_line(&ends, colour(robot.odometry), 4.0, 1.2)),
        Sign::Wall => drop(painter.line_segment(ends, Stroke::new(2.0, colour(robot.obstacle)))),
        Sign::Frontier => {
            painter.line_segment(ends, Stroke::new(6.0, colour(robot.frontier).gamma_multiply(0.16)));
            painter.extend(Shape::dashed_line(&ends, Stroke::new(2.4, colour(robot.frontier)), 5.0, 3.0));
        }
        Sign::Fan => {
            let fan = vec![at - vec2(9.0, 0.0), at + vec2(9.0, -6.0), at + vec2(9.0, 6.0)];
            let fill = colour(robot.laser).gamma_multiply(0.3);
            painter.add(Shape::convex_polygon(fan, fill, Stroke::new(0.8, colour(robot.laser).gamma_multiply(0.6))));
        }
        Sign::Doorway => {
            let short = [at - vec2(7.0, 0.0), at + vec2(7.0, 0.0)];
            painter.line_segment(short, Stroke::new(3.0, colour(robot.doorway)));
            for end in short {
                painter.circle_filled(end, 2.6, colour(robot.doorway));
            }
        }
        Sign::Unknown => swatch(ui, at, colour(robot.unknown)),
        Sign::Room(label) => swatch(ui, at, colour(palette.label(label))),
    }
}

fn swatch(ui: &Ui, at: Pos2, fill: egui::Color32) {
    let place = Rect::from_center_size(at, vec2(18.0, 12.0));
    ui.painter().rect_filled(place, 2.0, fill);
    let rim = Stroke::new(1.0, colours(ui).text.gamma_multiply(0.22));
    ui.painter().rect_stroke(place, 2.0, rim, egui::epaint::StrokeKind::Inside);
}
