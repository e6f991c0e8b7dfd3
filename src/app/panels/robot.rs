//! The robot's panel: what it does and has found, its settings, the legend, the comparison with the true plan.

mod legend;

use egui::text::{LayoutJob, TextFormat};
use egui::{FontId, Margin, Rect, Role, ScrollArea, Sense, Slider, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::app::commands;
use crate::app::look::{
    theme,
    widgets::{
        ROW, Segment, caption, colours, focus_ring, follow_focus, hairline, link, put_line, right, section, segmented,
        toggle, value,
    },
};
use crate::app::paint::robot::Tone;
use crate::app::session::robot::compared::{Compared, Verdict};
use crate::app::session::robot::run::{Run, Source, State};
use crate::app::session::robot::settings::{MOST_FURNITURE, RobotSettings, SPEEDS};
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::app::value::{Call, Value};
use crate::base::wording::{count, sentence};
use crate::draw::{self, Palette, RobotColours};

/// Height in points: the initial one, and the minimum.
const USUAL_HEIGHT: f32 = 560.0;
const LEAST_HEIGHT: f32 = 200.0;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::ROBOT,
    title: "Robot",
    help: "The simulated robot: what it has found, its settings, the comparison with the true plan",
    side: Side::Right,
    height: Height::Dragged { usual: USUAL_HEIGHT, least: LEAST_HEIGHT },
    is_shown_at_first: false,
    needs_plan: true,
    has_own_command: false,
    show,
};

/// The most lines listed of a comparison.
const MOST: usize = 300;

fn show(app: &mut App, ui: &mut Ui) {
    let margin = Margin { left: 16, right: 12, top: 10, bottom: 8 };
    let mut call = None;
    egui::Frame::new().inner_margin(margin).show(ui, |ui| {
        ui.horizontal(|ui| {
            section(ui, "Robot");
            right(ui, |ui| {
                let state = app.session.robot_run().map_or("Not out", Run::state_in_words);
                caption(ui, state);
            });
        });
        ui.add_space(2.0);
        ScrollArea::vertical().id_salt("robot").auto_shrink(false).show(ui, |ui| {
            ui.set_width(ui.available_width() - 6.0);
            call = contents(app, ui);
        });
    });
    if let Some(call) = call {
        app.act_on(call, ui.ctx());
    }
}

fn contents(app: &App, ui: &mut Ui) -> Option<Call> {
    let mut call = None;
    let run = app.session.robot_run();
    let mut take = |done: Option<Call>| call = done.or(call.take());
    take(transport(app, ui));
    if let Some(run) = run {
        take(news(app, ui, run));
        figures(app, ui, run);
        if let Some(compared) = run.compared().filter(|_| run.is_compared) {
            hairline(ui);
            take(comparison(ui, compared, run.current));
        }
    } else {
        caption(
            ui,
            "A simulated robot with two laser scanners drives through the plan, maps it, and finds and labels its \
             rooms from what it sees. The plan itself stays as it is.",
        );
    }
    hairline(ui);
    take(view(app, ui));
    // What is not on the canvas needs no legend.
    if app.session.shown_run().is_some() {
        legend::legend(app, ui);
    }
    hairline(ui);
    take(settings(ui, &app.session.robot.settings, run.is_some()));
    call
}

/// A button for a command, if it can be done now.
fn button(app: &App, ui: &mut Ui, id: &'static str, text: &str, is_main: bool) -> Option<Call> {
    let command = commands::find(id)?;
    let why_not = command.why_not(app);
    let response = ui.add_enabled_ui(why_not.is_none(), |ui| compact_button(ui, text, is_main)).inner;
    let response = response.on_hover_text(command.help);
    let response = match why_not {
        Some(why_not) => response.on_disabled_hover_text(sentence(why_not)),
        None => response,
    };
    follow_focus(&response);
    response.clicked().then(|| Call::new(id, []))
}

/// A button no wider than its text needs: four of them fit beside each other.
fn compact_button(ui: &mut Ui, text: &str, is_main: bool) -> egui::Response {
    let colours = colours(ui);
    let (fill, rim, ink) = if is_main {
        (colours.accent, egui::Color32::TRANSPARENT, colours.on_accent)
    } else {
        (colours.raised, colours.outline, colours.text)
    };
    let text = egui::RichText::new(text).color(ink);
    let button = egui::Button::new(text).fill(fill).stroke(Stroke::new(1.0, rim)).min_size(vec2(0.0, ROW));
    let response = ui.add(button.wrap_mode(egui::TextWrapMode::Extend));
    let around = if is_main { response.rect.expand(3.0) } else { response.rect };
    focus_ring(ui, around, &response);
    response
}

/// What makes it go.
fn transport(app: &App, ui: &mut Ui) -> Option<Call> {
    let mut call = None;
    ui.spacing_mut().item_spacing = vec2(6.0, 6.0);
    let run = app.session.robot_run();
    let is_live = run.is_some_and(|run| matches!(run.state, State::Preparing | State::Running | State::Paused));
    if is_live {
        ui.horizontal(|ui| {
            let is_running = run.is_some_and(|run| run.state == State::Running);
            let title = if is_running { "Pause" } else { "Run" };
            call = button(app, ui, "robot-run", title, !is_running).or(call.take());
            call = button(app, ui, "robot-step", "Step", false).or(call.take());
            call = button(app, ui, "robot-to-end", "To the end", false).or(call.take());
            call = button(app, ui, "robot-stop", "Stop", false).or(call.take());
        });
        let speed = app.session.robot.settings.speed;
        let texts = SPEEDS.map(|speed| format!("{speed:.0}×"));
        let names = SPEEDS.map(|speed| format!("Speed {speed:.0}"));
        let segments: Vec<Segment<'_>> = SPEEDS
            .iter()
            .zip(texts.iter().zip(&names))
            .map(|(&each, (text, name))| Segment {
                text,
                name,
                help: "So many times faster than the robot drives",
                is_on: (each - speed).abs() < 1e-6,
                colour: None,
            })
            .collect();
        if let Some(index) = segmented(ui, &segments) {
            call = Some(Call::new("robot-speed", [Value::Number(SPEEDS[index])]));
        }
        return call;
    }
    if run.is_some_and(|run| run.state == State::Finished) {
        ui.horizontal(|ui| {
            call = button(app, ui, "open-robot-map", "Open the map as a plan", true).or(call.take());
        });
        ui.horizontal(|ui| {
            let is_log = run.is_some_and(|run| matches!(run.source, Source::Log));
            let is_compared = run.is_some_and(|run| run.is_compared);
            if !is_log {
                let title = if is_compared { "Back to the map" } else { "Compare with the true plan" };
                call = button(app, ui, "compare-robot-map", title, false).or(call.take());
            }
            call = button(app, ui, "robot-stop", "Put away", false).or(call.take());
        });
    }
    ui.horizontal(|ui| {
        let title = if run.is_some() { "Explore again" } else { "Explore this plan" };
        call = button(app, ui, "explore-plan", title, run.is_none()).or(call.take());
        call = button(app, ui, "replay-log", "Replay a log…", false).or(call.take());
    });
    call
}

/// What is out of the ordinary.
fn news(app: &App, ui: &mut Ui, run: &Run) -> Option<Call> {
    let mut call = None;
    let warn = |ui: &mut Ui, text: &str| {
        let colour = colours(ui).warning;
        ui.add(egui::Label::new(egui::RichText::new(text).size(theme::SMALL).color(colour)).wrap());
    };
    if let State::Failed(why) = &run.state {
        warn(ui, why);
    }
    if app.session.shown_run().is_none() {
        let is_live = matches!(run.state, State::Preparing | State::Running | State::Paused);
        match is_live {
            true => warn(ui, &format!("The robot is in {}, which is not shown; it waits.", run.title)),
            false => drop(caption(ui, format!("This is about {}, which is not shown.", run.title))),
        }
        if link(ui, "Show its plan").clicked() {
            call = Some(Call::new("show-robots-plan", []));
        }
    } else if app.session.is_plan_changed_since_run() {
        warn(ui, "The plan was changed. The robot goes on in the plan as it was when it started.");
    }
    if let Some(trouble) = &run.trouble {
        warn(ui, trouble);
    }
    call
}

/// How far it is.
fn figures(app: &App, ui: &mut Ui, run: &Run) {
    let units = app.session.units();
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.add_space(4.0);
    let secs = run.time_s.round() as u64;
    let driven = units.length(run.driven_m());
    value(ui, "Driven", &format!("{driven} in {}:{:02} min", secs / 60, secs % 60));
    let frontiers = count(run.map.frontiers.len(), "frontier");
    value(ui, "Known floor", &format!("{}, {frontiers}", units.area(run.map.known_m2)));
    let doorways = count(run.map.rooms.doorways.len(), "doorway");
    value(ui, "Found", &format!("{}, {doorways}", count(run.map.rooms.rooms.len(), "room")));
    if let (Some(error_m), Some(drift_m)) = (run.error_m(), run.drift_m()) {
        value(ui, "Estimate off", &units.length(error_m)).on_hover_text("How far the estimate is from the truth");
        value(ui, "Odometry off", &units.length(drift_m)).on_hover_text("How far odometry alone is from the truth");
    } else {
        value(ui, "Loops closed", &run.closures().to_string());
    }
    if let Some((done, all)) = run.progress.filter(|(_, all)| *all > 0) {
        value(ui, "Log", &format!("{:.0} %", 100.0 * done as f64 / all as f64));
    }
    if let Some(choice) = run.choice() {
        value(ui, "Labels by", &format!("{} ({})", sentence(&choice.set), choice.because));
    }
    if let Some(compared) = run.compared() {
        ui.add_space(4.0);
        for (name, figure) in ["Rooms", "Connections", "Labels"].iter().zip(&compared.figures) {
            value(ui, name, figure);
        }
    }
}

fn view(app: &App, ui: &mut Ui) -> Option<Call> {
    let settings = &app.session.robot.settings;
    let mut call = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (id, text, is_on) in [
            ("robot-paths", "Paths", settings.shows_paths),
            ("robot-sights", "Points and lines of sight", settings.shows_sights),
        ] {
            let Some(command) = commands::find(id).filter(|command| command.why_not(app).is_none()) else { continue };
            let help = command.help;
            if toggle(ui, text, is_on).on_hover_text(help).clicked() {
                call = Some(Call::new(id, [Value::Switch(!is_on)]));
            }
        }
    });
    call
}

/// A slider for a setting: its name, its value in words.
struct Setting {
    name: &'static str,
    command: &'static str,
    value: f64,
    most: f64,
    step: f64,
    shown: String,
    is_whole: bool,
}

/// The world and the noise of the next run.
fn settings(ui: &mut Ui, settings: &RobotSettings, is_out: bool) -> Option<Call> {
    ui.horizontal(|ui| {
        section(ui, "World and noise");
        if is_out {
            right(ui, |ui| {
                caption(ui, "for the next run");
            });
        }
    });
    let times = |factor: f64| if factor == 0.0 { "none".to_owned() } else { format!("{factor:.1}×") };
    let sliders = [
        Setting {
            name: "Scanner noise",
            command: "robot-noise",
            value: settings.scanner_noise,
            most: 5.0,
            step: 0.1,
            shown: times(settings.scanner_noise),
            is_whole: false,
        },
        Setting {
            name: "Odometry drift",
            command: "robot-drift",
            value: settings.drift,
            most: 5.0,
            step: 0.1,
            shown: times(settings.drift),
            is_whole: false,
        },
        Setting {
            name: "Furniture a room",
            command: "robot-furniture",
            value: settings.furniture as f64,
            most: MOST_FURNITURE as f64,
            step: 1.0,
            shown: settings.furniture.to_string(),
            is_whole: true,
        },
        Setting {
            name: "Doors ajar",
            command: "robot-doors-ajar",
            value: settings.ajar_percent,
            most: 100.0,
            step: 5.0,
            shown: format!("{:.0} %", settings.ajar_percent),
            is_whole: false,
        },
        Setting {
            name: "Doors closed",
            command: "robot-doors-closed",
            value: settings.closed_percent,
            most: 100.0,
            step: 5.0,
            shown: format!("{:.0} %", settings.closed_percent),
            is_whole: false,
        },
        Setting {
            name: "Seed",
            command: "robot-seed",
            value: settings.seed as f64,
            most: 99.0,
            step: 1.0,
            shown: settings.seed.to_string(),
            is_whole: true,
        },
    ];
    let mut call = None;
    ui.spacing_mut().item_spacing.y = 0.0;
    for setting in sliders {
        call = slider(ui, &setting).or(call.take());
    }
    call
}

fn slider(ui: &mut Ui, setting: &Setting) -> Option<Call> {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW - 2.0), Sense::hover());
    let name_width = (rect.width() * 0.42).min(120.0);
    let weak = colours(ui).text_weak;
    put_line(ui, setting.name, FontId::proportional(theme::BODY), weak, rect);
    let text_width = 46.0;
    let from = pos2(rect.left() + name_width + 8.0, rect.top());
    let slot = Rect::from_min_max(from, pos2(rect.right() - text_width, rect.bottom()));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(slot).id_salt(setting.command));
    child.spacing_mut().slider_width = slot.width();
    let mut value = setting.value;
    let slider =
        Slider::new(&mut value, 0.0..=setting.most).step_by(setting.step).show_value(false).trailing_fill(true);
    let response = child.add_sized(slot.size(), slider);
    follow_focus(&response);
    response.widget_info(|| WidgetInfo::slider(true, value, setting.name));
    let font = FontId::proportional(theme::BODY);
    ui.painter().text(rect.right_center(), egui::Align2::RIGHT_CENTER, &setting.shown, font, colours(ui).text);
    let value = if setting.is_whole { value.round() } else { (value * 100.0).round() / 100.0 };
    (value != setting.value).then(|| {
        let value = if setting.is_whole { Value::Count(value as usize) } else { Value::Number(value) };
        Call::new(setting.command, [value])
    })
}

/// The lines of the comparison, by kind; a click goes to the place.
fn comparison(ui: &mut Ui, compared: &Compared, current: Option<usize>) -> Option<Call> {
    let mut call = None;
    ui.spacing_mut().item_spacing.y = 1.0;
    let mut first = 0;
    for verdict in Verdict::ALL {
        let number = compared.count(verdict);
        if number == 0 {
            continue;
        }
        section(ui, &format!("{} ({number})", verdict.title()));
        for index in (first..first + number).take_while(|&index| index < MOST) {
            let line = &compared.list[index];
            if row(ui, verdict, &line.text, index, current == Some(index)).clicked() {
                call = Some(Call::new("robot-go-to", [Value::Count(index + 1)]));
            }
        }
        ui.add_space(5.0);
        first += number;
    }
    call
}

fn row(ui: &mut Ui, verdict: Verdict, text: &str, index: usize, is_current: bool) -> egui::Response {
    let own = colours(ui);
    let palette =
        Palette::of(if ui.visuals().dark_mode { draw::Theme::Dark } else { draw::Theme::Light }, Default::default());
    let tone = theme::colour(match verdict.tone() {
        Tone::Good => RobotColours::of(palette.theme).doorway,
        Tone::Bad => palette.error,
        Tone::Weak => palette.ink_muted,
    });
    let width = ui.available_width();
    let mut job =
        LayoutJob::single_section(text.to_owned(), TextFormat::simple(FontId::proportional(theme::BODY), own.text));
    job.wrap.max_width = (width - 30.0).max(40.0);
    let galley = ui.painter().layout_job(job);
    let (rect, response) = ui.allocate_exact_size(vec2(width, galley.rect.height() + 6.0), Sense::click());
    follow_focus(&response);
    if ui.is_rect_visible(rect) {
        let ground = if is_current {
            Some(own.accent_soft)
        } else if response.hovered() {
            Some(own.hover)
        } else {
            None
        };
        if let Some(ground) = ground {
            ui.painter().rect_filled(rect, theme::RADIUS, ground);
        }
        let mark = rect.left_top() + vec2(6.0, 3.0);
        let font = FontId::new(theme::BODY, theme::semibold());
        ui.painter().text(mark, egui::Align2::LEFT_TOP, verdict.sign(), font, tone);
        ui.painter().galley(rect.left_top() + vec2(24.0, 3.0), galley, own.text);
        focus_ring(ui, rect, &response);
    }
    let name = format!("{}, {}: {text}", index + 1, verdict.title());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_current, &name));
    response
}
