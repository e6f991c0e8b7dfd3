//! Icons as shapes on a grid of 16 by 16: crisp at every scale, and no font needed.

use egui::epaint::{PathShape, PathStroke};
use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

/// An icon for a command or a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Icon {
    /// One defined where it is used, such as a tool's.
    Drawn(&'static [Part]),
    Open,
    Save,
    Undo,
    Redo,
    Fit,
    ZoomToSelection,
    ZoomIn,
    ZoomOut,
    Fill,
    Graph,
    Names,
    Backdrop,
    Grid,
    Light,
    Dark,
    System,
    Close,
    Warning,
    Info,
    Plan,
    Folder,
    Door,
    DoubleDoor,
    Passage,
    Window,
    Outside,
    Check,
    ChevronDown,
    ChevronRight,
    Plus,
    Minus,
    Eye,
    EyeOff,
    Sidebar,
    Inspector,
    Search,
}

/// Part of an icon, in units of the grid: 16 by 16, y downward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    Line(&'static [(f32, f32)]),
    Loop(&'static [(f32, f32)]),
    Fill(&'static [(f32, f32)]),
    Circle(f32, f32, f32),
    Disc(f32, f32, f32),
    /// Centre, radius, first and last angle in degrees, clockwise from the right.
    Arc(f32, f32, f32, f32, f32),
}

use Part::{Arc, Circle, Disc, Fill, Line, Loop};

impl Icon {
    const fn parts(self) -> &'static [Part] {
        match self {
            Self::Drawn(parts) => parts,
            Self::Open => &[
                Line(&[(2.0, 12.5), (2.0, 3.5), (6.2, 3.5), (7.8, 5.5), (12.5, 5.5), (12.5, 7.5)]),
                Loop(&[(2.0, 12.5), (4.2, 7.5), (14.2, 7.5), (12.0, 12.5)]),
            ],
            Self::Save => &[
                Loop(&[(2.5, 2.5), (11.0, 2.5), (13.5, 5.0), (13.5, 13.5), (2.5, 13.5)]),
                Line(&[(5.0, 2.5), (5.0, 6.0), (10.0, 6.0), (10.0, 2.5)]),
                Line(&[(4.8, 13.5), (4.8, 9.0), (11.2, 9.0), (11.2, 13.5)]),
            ],
            Self::Undo => &[
                Line(&[(6.0, 3.0), (2.8, 6.2), (6.0, 9.4)]),
                Line(&[(2.8, 6.2), (9.6, 6.2)]),
                Arc(9.6, 9.6, 3.4, -90.0, 90.0),
                Line(&[(9.6, 13.0), (6.0, 13.0)]),
            ],
            Self::Redo => &[
                Line(&[(10.0, 3.0), (13.2, 6.2), (10.0, 9.4)]),
                Line(&[(13.2, 6.2), (6.4, 6.2)]),
                Arc(6.4, 9.6, 3.4, 90.0, 270.0),
                Line(&[(6.4, 13.0), (10.0, 13.0)]),
            ],
            Self::Fit => &[
                Line(&[(2.5, 5.5), (2.5, 2.5), (5.5, 2.5)]),
                Line(&[(10.5, 2.5), (13.5, 2.5), (13.5, 5.5)]),
                Line(&[(13.5, 10.5), (13.5, 13.5), (10.5, 13.5)]),
                Line(&[(5.5, 13.5), (2.5, 13.5), (2.5, 10.5)]),
                Loop(&[(5.5, 5.5), (10.5, 5.5), (10.5, 10.5), (5.5, 10.5)]),
            ],
            Self::ZoomToSelection => &[
                Line(&[(2.5, 5.5), (2.5, 2.5), (5.5, 2.5)]),
                Line(&[(10.5, 2.5), (13.5, 2.5), (13.5, 5.5)]),
                Line(&[(13.5, 10.5), (13.5, 13.5), (10.5, 13.5)]),
                Line(&[(5.5, 13.5), (2.5, 13.5), (2.5, 10.5)]),
                Disc(8.0, 8.0, 2.2),
            ],
            Self::ZoomIn => &[
                Circle(7.0, 7.0, 4.5),
                Line(&[(10.4, 10.4), (13.8, 13.8)]),
                Line(&[(5.0, 7.0), (9.0, 7.0)]),
                Line(&[(7.0, 5.0), (7.0, 9.0)]),
            ],
            Self::ZoomOut => {
                &[Circle(7.0, 7.0, 4.5), Line(&[(10.4, 10.4), (13.8, 13.8)]), Line(&[(5.0, 7.0), (9.0, 7.0)])]
            }
            Self::Fill => &[
                Loop(&[(2.5, 2.5), (13.5, 2.5), (13.5, 13.5), (2.5, 13.5)]),
                Fill(&[(2.5, 2.5), (8.5, 2.5), (8.5, 8.5), (2.5, 8.5)]),
                Line(&[(8.5, 2.5), (8.5, 13.5)]),
                Line(&[(2.5, 8.5), (13.5, 8.5)]),
            ],
            Self::Graph => &[
                Line(&[(4.0, 4.0), (11.8, 5.4), (6.8, 12.0), (4.0, 4.0)]),
                Disc(4.0, 4.0, 1.9),
                Disc(11.8, 5.4, 1.9),
                Disc(6.8, 12.0, 1.9),
            ],
            Self::Names => &[
                Line(&[(3.0, 5.0), (3.0, 3.0), (13.0, 3.0), (13.0, 5.0)]),
                Line(&[(8.0, 3.0), (8.0, 13.0)]),
                Line(&[(6.0, 13.0), (10.0, 13.0)]),
            ],
            Self::Backdrop => &[
                Loop(&[(2.0, 3.0), (14.0, 3.0), (14.0, 13.0), (2.0, 13.0)]),
                Disc(5.4, 6.2, 1.2),
                Line(&[(2.0, 11.6), (5.6, 8.6), (8.0, 10.6), (11.0, 7.4), (14.0, 10.2)]),
            ],
            Self::Grid => &[
                Loop(&[(2.5, 2.5), (13.5, 2.5), (13.5, 13.5), (2.5, 13.5)]),
                Line(&[(6.17, 2.5), (6.17, 13.5)]),
                Line(&[(9.83, 2.5), (9.83, 13.5)]),
                Line(&[(2.5, 6.17), (13.5, 6.17)]),
                Line(&[(2.5, 9.83), (13.5, 9.83)]),
            ],
            Self::Light => &[
                Circle(8.0, 8.0, 2.8),
                Line(&[(8.0, 1.6), (8.0, 3.0)]),
                Line(&[(8.0, 13.0), (8.0, 14.4)]),
                Line(&[(1.6, 8.0), (3.0, 8.0)]),
                Line(&[(13.0, 8.0), (14.4, 8.0)]),
                Line(&[(3.5, 3.5), (4.5, 4.5)]),
                Line(&[(11.5, 11.5), (12.5, 12.5)]),
                Line(&[(3.5, 12.5), (4.5, 11.5)]),
                Line(&[(11.5, 4.5), (12.5, 3.5)]),
            ],
            Self::Dark => &[Arc(7.6, 8.4, 5.4, 20.0, 250.0), Arc(11.2, 4.8, 4.9, 70.2, 200.0)],
            Self::System => &[
                Loop(&[(2.0, 3.0), (14.0, 3.0), (14.0, 10.8), (2.0, 10.8)]),
                Line(&[(8.0, 10.8), (8.0, 13.2)]),
                Line(&[(5.2, 13.2), (10.8, 13.2)]),
            ],
            Self::Close => &[Line(&[(4.0, 4.0), (12.0, 12.0)]), Line(&[(12.0, 4.0), (4.0, 12.0)])],
            Self::Warning => {
                &[Loop(&[(8.0, 2.2), (14.4, 13.4), (1.6, 13.4)]), Line(&[(8.0, 6.4), (8.0, 9.6)]), Disc(8.0, 11.5, 0.8)]
            }
            Self::Info => &[Circle(8.0, 8.0, 6.0), Line(&[(8.0, 7.4), (8.0, 11.2)]), Disc(8.0, 5.1, 0.8)],
            Self::Plan => &[
                Loop(&[(2.5, 2.5), (13.5, 2.5), (13.5, 13.5), (2.5, 13.5)]),
                Line(&[(2.5, 8.0), (6.5, 8.0)]),
                Line(&[(9.0, 2.5), (9.0, 6.0)]),
                Line(&[(9.0, 8.5), (9.0, 13.5)]),
            ],
            Self::Folder => &[Loop(&[(2.0, 12.8), (2.0, 3.5), (6.2, 3.5), (7.8, 5.4), (14.0, 5.4), (14.0, 12.8)])],
            Self::Door => &[
                Line(&[(2.0, 13.0), (4.0, 13.0)]),
                Line(&[(4.0, 13.0), (4.0, 4.0)]),
                Arc(4.0, 13.0, 9.0, 270.0, 360.0),
                Line(&[(13.0, 13.0), (14.5, 13.0)]),
            ],
            Self::DoubleDoor => &[
                Line(&[(2.0, 12.0), (2.0, 6.0)]),
                Arc(2.0, 12.0, 6.0, 270.0, 360.0),
                Line(&[(14.0, 12.0), (14.0, 6.0)]),
                Arc(14.0, 12.0, 6.0, 180.0, 270.0),
            ],
            Self::Passage => &[
                Line(&[(1.8, 8.0), (4.6, 8.0)]),
                Line(&[(4.6, 6.0), (4.6, 10.0)]),
                Line(&[(11.4, 6.0), (11.4, 10.0)]),
                Line(&[(11.4, 8.0), (14.2, 8.0)]),
            ],
            Self::Window => {
                &[Loop(&[(2.0, 6.0), (14.0, 6.0), (14.0, 10.0), (2.0, 10.0)]), Line(&[(2.0, 8.0), (14.0, 8.0)])]
            }
            Self::Outside => &[
                Line(&[(9.0, 2.5), (2.5, 2.5), (2.5, 13.5), (9.0, 13.5)]),
                Line(&[(6.5, 8.0), (13.8, 8.0)]),
                Line(&[(11.0, 5.2), (13.8, 8.0), (11.0, 10.8)]),
            ],
            Self::Search => &[Circle(7.0, 7.0, 4.5), Line(&[(10.4, 10.4), (13.8, 13.8)])],
            Self::Check => &[Line(&[(3.2, 8.4), (6.6, 11.8), (12.8, 4.6)])],
            Self::ChevronDown => &[Line(&[(4.5, 6.5), (8.0, 10.0), (11.5, 6.5)])],
            Self::ChevronRight => &[Line(&[(6.5, 4.5), (10.0, 8.0), (6.5, 11.5)])],
            Self::Plus => &[Line(&[(8.0, 3.5), (8.0, 12.5)]), Line(&[(3.5, 8.0), (12.5, 8.0)])],
            Self::Minus => &[Line(&[(3.5, 8.0), (12.5, 8.0)])],
            Self::Eye => &[
                Line(&[(1.5, 8.0), (3.4, 5.6), (5.6, 4.2), (8.0, 3.8), (10.4, 4.2), (12.6, 5.6), (14.5, 8.0)]),
                Line(&[(1.5, 8.0), (3.4, 10.4), (5.6, 11.8), (8.0, 12.2), (10.4, 11.8), (12.6, 10.4), (14.5, 8.0)]),
                Circle(8.0, 8.0, 2.1),
            ],
            Self::EyeOff => &[
                Line(&[(1.5, 7.0), (3.4, 9.0), (5.6, 10.2), (8.0, 10.6), (10.4, 10.2), (12.6, 9.0), (14.5, 7.0)]),
                Line(&[(8.0, 10.6), (8.0, 12.8)]),
                Line(&[(4.4, 9.7), (3.4, 11.6)]),
                Line(&[(11.6, 9.7), (12.6, 11.6)]),
            ],
            Self::Sidebar => {
                &[Loop(&[(2.0, 3.0), (14.0, 3.0), (14.0, 13.0), (2.0, 13.0)]), Line(&[(6.2, 3.0), (6.2, 13.0)])]
            }
            Self::Inspector => {
                &[Loop(&[(2.0, 3.0), (14.0, 3.0), (14.0, 13.0), (2.0, 13.0)]), Line(&[(9.8, 3.0), (9.8, 13.0)])]
            }
        }
    }

    /// Draws the icon in a square, in one colour.
    pub fn paint(self, painter: &Painter, square: Rect, color: Color32) {
        let unit = square.width() / 16.0;
        let place = |&(x, y): &(f32, f32)| square.min + vec2(x, y) * unit;
        let stroke = Stroke::new(1.3 * unit, color);
        for part in self.parts() {
            let shape = match part {
                Line(points) => Shape::line(points.iter().map(place).collect(), stroke),
                Loop(points) => Shape::closed_line(points.iter().map(place).collect(), stroke),
                Fill(points) => Shape::Path(PathShape {
                    points: points.iter().map(place).collect(),
                    closed: true,
                    fill: color.gamma_multiply(0.35),
                    stroke: PathStroke::NONE,
                }),
                Circle(x, y, radius) => Shape::circle_stroke(place(&(*x, *y)), radius * unit, stroke),
                Disc(x, y, radius) => Shape::circle_filled(place(&(*x, *y)), radius * unit, color),
                Arc(x, y, radius, from, to) => Shape::line(arc(place(&(*x, *y)), radius * unit, *from, *to), stroke),
            };
            painter.add(shape);
        }
    }
}

fn arc(centre: Pos2, radius: f32, from_degrees: f32, to_degrees: f32) -> Vec<Pos2> {
    // A step of ten degrees is finer than a pixel at the sizes of icons.
    let steps = ((to_degrees - from_degrees) / 10.0).ceil().max(1.0);
    (0..=steps as u32)
        .map(|i| {
            let angle = (from_degrees + (to_degrees - from_degrees) * i as f32 / steps).to_radians();
            pos2(centre.x + radius * angle.cos(), centre.y + radius * angle.sin())
        })
        .collect()
}
