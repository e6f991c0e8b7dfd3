//! Renders a scene to SVG: real text, one group with id and title per room and opening, numbers as short
//! as possible. The same scene always gives the same bytes.

use crate::picture::png::encode_level;
use std::fmt::Write as _;

use base64::Engine as _;

use super::Rgba;
use super::scene::{Anchor, Dash, Frame, Group, Item, Layer, Length, PlacedPicture, Scene, Text, View, Weight};
use crate::geometry::Point;

/// The font fallbacks: the bundled one, then metrically similar ones.
const FONTS: &str = "Inter,'Helvetica Neue',Helvetica,Arial,sans-serif";

/// Renders the scene to an SVG document.
pub fn svg(scene: &Scene) -> String {
    let (width, height) = (number(scene.view.width_px), number(scene.view.height_px));
    document(scene, &width, &height)
}

/// The same, of a size in millimetres when printed.
pub fn svg_in_mm(scene: &Scene, [width_mm, height_mm]: [f64; 2]) -> String {
    document(scene, &format!("{}mm", number(width_mm)), &format!("{}mm", number(height_mm)))
}

fn document(scene: &Scene, shown_width: &str, shown_height: &str) -> String {
    let view = &scene.view;
    let (width, height) = (number(view.width_px), number(view.height_px));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{shown_width}\" height=\"{shown_height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{FONTS}\">\n"
    );
    if scene.background.a > 0 {
        let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\"{}/>", fill(scene.background));
    }
    for layer in Layer::ALL {
        let mut groups = scene.groups.iter().filter(|group| group.layer == layer && !group.items.is_empty()).peekable();
        if groups.peek().is_none() {
            continue;
        }
        let _ = writeln!(out, "<g id=\"{}\">", layer.name());
        for group in groups {
            write_group(&mut out, view, group);
        }
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

fn write_group(out: &mut String, view: &View, group: &Group) {
    let named = !group.element.is_empty();
    if named {
        // A room has groups in two layers: that of the name refers to the room.
        let attribute = if group.layer == Layer::Names { "data-room" } else { "id" };
        let _ = write!(out, "<g {attribute}=\"{}\">", escaped(&group.element));
        if !group.title.is_empty() {
            let _ = write!(out, "<title>{}</title>", escaped(&group.title));
        }
        out.push('\n');
    }
    for item in &group.items {
        write_item(out, view, group.frame, item);
    }
    if named {
        out.push_str("</g>\n");
    }
}

fn write_item(out: &mut String, view: &View, frame: Frame, item: &Item) {
    let at = |point: Point| match frame {
        Frame::Plan => view.screen_from_plan(point),
        Frame::Screen => point,
    };
    // Writing to a string does not fail.
    let _ = match item {
        Item::Polygon { outer, holes, colour } => {
            let mut data = String::new();
            for ring in std::iter::once(outer).chain(holes) {
                push_points(&mut data, ring.iter().map(|&point| at(point)));
                data.push('Z');
            }
            let rule = if holes.is_empty() { "" } else { " fill-rule=\"evenodd\"" };
            writeln!(out, "<path d=\"{data}\"{}{rule}/>", fill(*colour))
        }
        Item::Line { points, closed, colour, width, dash } => {
            let mut data = String::new();
            push_points(&mut data, points.iter().map(|&point| at(point)));
            if *closed {
                data.push('Z');
            }
            writeln!(out, "<path d=\"{data}\"{}{}/>", stroke(view, *colour, *width), dashes(view, *dash))
        }
        Item::Arc { centre, from, to, colour, width } => {
            let (centre, from, to) = (at(*centre), at(*from), at(*to));
            let radius = number(centre.distance(from));
            let sweep = u8::from((from - centre).cross(to - centre) > 0.0);
            writeln!(
                out,
                "<path d=\"M{} {}A{radius} {radius} 0 0 {sweep} {} {}\"{}/>",
                number(from.x),
                number(from.y),
                number(to.x),
                number(to.y),
                stroke(view, *colour, *width)
            )
        }
        Item::Disc { centre, radius, fill: inside, outline } => {
            let centre = at(*centre);
            let inside = inside.map_or_else(|| " fill=\"none\"".to_owned(), fill);
            let outline = outline.map_or_else(String::new, |(colour, width)| {
                stroke(view, colour, width).replacen(" fill=\"none\"", "", 1)
            });
            writeln!(
                out,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{inside}{outline}/>",
                number(centre.x),
                number(centre.y),
                number(view.px(*radius))
            )
        }
        Item::Text(text) => write_text(out, at(text.at), text),
        Item::Picture(picture) => write_picture(out, view, picture, at),
    };
}

/// A picture, embedded: at twice the page's resolution, so that zooming in shows more detail.
fn write_picture(
    out: &mut String,
    view: &View,
    picture: &PlacedPicture,
    at: impl Fn(Point) -> Point,
) -> std::fmt::Result {
    let place = |x: f64, y: f64| at(picture.at(x, y));
    let start = place(0.0, 0.0);
    let index = picture.levels.index_for(start.distance(place(1.0, 0.0)) * view.pixel_ratio).saturating_sub(1);
    let Some(level) = picture.levels.all().get(index) else { return Ok(()) };
    let Ok(data) = encode_level(level) else { return Ok(()) };
    // From pixels of this size to the page.
    let stride = (index as f64).exp2();
    let (x_way, y_way) = (place(stride, 0.0) - start, place(0.0, stride) - start);
    writeln!(
        out,
        "<image width=\"{}\" height=\"{}\" transform=\"matrix({} {} {} {} {} {})\"{} href=\"data:image/png;base64,{}\"/>",
        level.width_px,
        level.height_px,
        // A matrix needs more digits than a position: it is multiplied by thousands of pixels.
        fine_number(x_way.x),
        fine_number(x_way.y),
        fine_number(y_way.x),
        fine_number(y_way.y),
        number(start.x),
        number(start.y),
        if picture.opacity < 1.0 { format!(" opacity=\"{}\"", number(picture.opacity)) } else { String::new() },
        base64::engine::general_purpose::STANDARD.encode(data)
    )
}

fn write_text(out: &mut String, at: Point, text: &Text) -> std::fmt::Result {
    let at = at + text.offset_px;
    let (x, y) = (number(at.x), number(at.y));
    let anchor = match text.anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let weight = match text.weight {
        Weight::Regular => "",
        Weight::SemiBold => " font-weight=\"600\"",
    };
    let turn = if text.upright { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
    let halo = text.halo.map_or_else(String::new, |halo| {
        format!(
            " stroke=\"{}\"{} stroke-width=\"{}\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
            halo.css(),
            opacity("stroke-opacity", halo),
            number(text.size_px * 0.28)
        )
    });
    writeln!(
        out,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"{weight}{anchor}{turn}{}{halo}>{}</text>",
        number(text.size_px),
        fill(text.colour),
        escaped(&text.content)
    )
}

/// `M` and the points, separated by spaces, each number to a hundredth of a pixel.
fn push_points(data: &mut String, points: impl Iterator<Item = Point>) {
    for (i, point) in points.enumerate() {
        data.push_str(match i {
            0 => "M",
            1 => "L",
            _ => " ",
        });
        let _ = write!(data, "{} {}", number(point.x), number(point.y));
    }
}

fn fill(colour: Rgba) -> String {
    format!(" fill=\"{}\"{}", colour.css(), opacity("fill-opacity", colour))
}

fn stroke(view: &View, colour: Rgba, width: Length) -> String {
    format!(
        " fill=\"none\" stroke=\"{}\"{} stroke-width=\"{}\"",
        colour.css(),
        opacity("stroke-opacity", colour),
        number(view.px(width))
    )
}

fn dashes(view: &View, dash: Option<Dash>) -> String {
    dash.map_or_else(String::new, |dash| {
        format!(" stroke-dasharray=\"{} {}\"", number(view.px(dash.dash)), number(view.px(dash.gap)))
    })
}

fn opacity(attribute: &str, colour: Rgba) -> String {
    if colour.a == 255 { String::new() } else { format!(" {attribute}=\"{}\"", number(f64::from(colour.a) / 255.0)) }
}

/// A number to two decimals, without trailing zeros.
fn number(value: f64) -> String {
    // `+ 0.0` turns -0.0 into 0.0.
    let text = format!("{:.2}", (value * 100.0).round() / 100.0 + 0.0);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number to eight decimals, without trailing zeros.
fn fine_number(value: f64) -> String {
    let text = format!("{:.8}", value + 0.0);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Text for XML 1.0: markup escaped, disallowed characters replaced.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push(' '),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(character),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([number(1.0), number(0.125), number(-0.001), number(100.0)], ["1", "0.13", "0", "100"]);
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("A&B <\"C\">\u{1}\n"), "A&amp;B &lt;&quot;C&quot;&gt;\u{fffd} ");
    }
}
