//! Renders a scene to a PDF page: vector shapes and real text in the bundled font, of which only the letters used are
//! embedded. The same scene always gives the same bytes: no date, no random file id.

use std::collections::{BTreeMap, BTreeSet};

use pdf_writer::types::{
    CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, TextRenderingMode, UnicodeCmap,
};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use subsetter::GlyphRemapper;

use super::Rgba;
use super::font::{CAP_HEIGHT, DESCENT, Font, Step};
use super::scene::{Anchor, Frame, Group, Item, PlacedPicture, Scene, Text, View, Weight, arc_points};
use crate::geometry::Point;

/// Points of 1/72 inch in a logical pixel of 1/96 inch.
const PT_PER_PX: f64 = 0.75;

/// What a viewer shows of the document, besides the page.
#[derive(Clone, Copy, Debug, Default)]
pub struct Facts<'a> {
    pub title: &'a str,
    pub subject: &'a str,
}

/// Renders the scene to a PDF file of one page. A logical pixel is 1/96 inch on the page. Only the part of a picture
/// that the scene's view shows at 150 dots to the inch is embedded.
pub fn pdf(scene: &Scene, facts: Facts<'_>) -> Vec<u8> {
    let mut page = Page::new(scene);
    if scene.background.a > 0 {
        let (width, height) = (page.width_pt(), page.height_pt());
        page.fill_colour(scene.background);
        page.content.rect(0.0, 0.0, width, height).fill_nonzero();
    }
    for group in &scene.groups {
        page.group(group);
    }
    page.finish(facts)
}

/// The letters of a weight that are used, with their numbers in the embedded font.
struct Letters {
    weight: Weight,
    remapper: GlyphRemapper,
    /// By the number in the embedded font: the letter and its advance in thousandths of the font size.
    used: BTreeMap<u16, (char, f32)>,
}

impl Letters {
    fn new(weight: Weight) -> Self {
        Self { weight, remapper: GlyphRemapper::new(), used: BTreeMap::new() }
    }

    /// The number of a letter in the embedded font; `None` if the font lacks it.
    fn number(&mut self, letter: char) -> Option<u16> {
        let font = Font::of(self.weight);
        let number = self.remapper.remap(font.glyph_number(letter)?);
        // Of two letters with one glyph (a hyphen and a minus, say) the first is what is copied from the page.
        self.used.entry(number).or_insert_with(|| (letter, font.advance(letter) * 1000.0));
        Some(number)
    }

    const fn name(&self) -> Name<'static> {
        match self.weight {
            Weight::Regular => Name(b"F1"),
            Weight::SemiBold => Name(b"F2"),
        }
    }

    const fn font_name(&self) -> &'static str {
        match self.weight {
            Weight::Regular => "Inter-Regular",
            Weight::SemiBold => "Inter-SemiBold",
        }
    }
}

struct Page<'a> {
    view: &'a View,
    content: Content,
    letters: [Letters; 2],
    /// The alphas used, each a graphics state.
    alphas: BTreeSet<u8>,
    /// The state that was set last.
    fill: Option<Rgba>,
    stroke: Option<Rgba>,
    width_pt: Option<f32>,
    is_dashed: bool,
    alpha: u8,
    pictures: Vec<Embedded>,
}

/// A picture's pixels, ready to be written.
struct Embedded {
    width_px: u32,
    height_px: u32,
    rgb: Vec<u8>,
    alpha: Option<Vec<u8>>,
}

/// A coordinate in points, to a hundredth: 3.5 µm on paper.
fn pt(value: f64) -> f32 {
    // `+ 0.0` turns -0.0 into 0.0.
    ((value * PT_PER_PX * 100.0).round() / 100.0 + 0.0) as f32
}

fn channel(byte: u8) -> f32 {
    (f32::from(byte) / 255.0 * 1000.0).round() / 1000.0
}

impl<'a> Page<'a> {
    fn new(scene: &'a Scene) -> Self {
        let mut content = Content::new();
        content.set_line_cap(LineCapStyle::ButtCap).set_line_join(LineJoinStyle::MiterJoin);
        Self {
            view: &scene.view,
            content,
            letters: [Letters::new(Weight::Regular), Letters::new(Weight::SemiBold)],
            alphas: BTreeSet::new(),
            fill: None,
            stroke: None,
            width_pt: None,
            is_dashed: false,
            alpha: 255,
            pictures: Vec::new(),
        }
    }

    fn width_pt(&self) -> f32 {
        pt(self.view.width_px)
    }

    fn height_pt(&self) -> f32 {
        pt(self.view.height_px)
    }

    /// A point of the page, in points from its lower left corner.
    fn at(&self, frame: Frame, point: Point) -> (f32, f32) {
        let screen = match frame {
            Frame::Plan => self.view.screen_from_plan(point),
            Frame::Screen => point,
        };
        (pt(screen.x), pt(self.view.height_px - screen.y))
    }

    fn set_alpha(&mut self, alpha: u8) {
        if self.alpha != alpha {
            self.alpha = alpha;
            self.alphas.insert(alpha);
            self.content.set_parameters(Name(alpha_name(alpha).as_bytes()));
        }
    }

    fn fill_colour(&mut self, colour: Rgba) {
        self.set_alpha(colour.a);
        if self.fill.replace(colour).is_none_or(|before| before.with_alpha(0) != colour.with_alpha(0)) {
            self.content.set_fill_rgb(channel(colour.r), channel(colour.g), channel(colour.b));
        }
    }

    fn stroke_colour(&mut self, colour: Rgba, width_pt: f32) {
        self.set_alpha(colour.a);
        if self.stroke.replace(colour).is_none_or(|before| before.with_alpha(0) != colour.with_alpha(0)) {
            self.content.set_stroke_rgb(channel(colour.r), channel(colour.g), channel(colour.b));
        }
        if self.width_pt.replace(width_pt) != Some(width_pt) {
            self.content.set_line_width(width_pt);
        }
    }

    fn dash(&mut self, lengths: Option<[f32; 2]>) {
        if lengths.is_some() || self.is_dashed {
            self.is_dashed = lengths.is_some();
            self.content.set_dash_pattern(lengths.into_iter().flatten(), 0.0);
        }
    }

    fn path(&mut self, frame: Frame, points: &[Point]) {
        for (index, &point) in points.iter().enumerate() {
            let (x, y) = self.at(frame, point);
            if index == 0 {
                self.content.move_to(x, y);
            } else {
                self.content.line_to(x, y);
            }
        }
    }

    fn group(&mut self, group: &Group) {
        for item in &group.items {
            self.item(group.frame, item);
        }
    }

    fn item(&mut self, frame: Frame, item: &Item) {
        match item {
            Item::Polygon { outer, holes, colour } => {
                if outer.len() < 3 || colour.a == 0 {
                    return;
                }
                self.fill_colour(*colour);
                for ring in std::iter::once(outer).chain(holes) {
                    self.path(frame, ring);
                    self.content.close_path();
                }
                self.content.fill_even_odd();
            }
            Item::Line { points, closed, colour, width, dash } => {
                if points.len() < 2 {
                    return;
                }
                self.stroke_colour(*colour, pt(self.view.px(*width)));
                let px = |length| pt(self.view.px(length));
                self.dash(dash.map(|dash| [px(dash.dash), px(dash.gap)]));
                self.path(frame, points);
                if *closed {
                    self.content.close_and_stroke();
                } else {
                    self.content.stroke();
                }
            }
            Item::Arc { centre, from, to, colour, width } => {
                self.stroke_colour(*colour, pt(self.view.px(*width)));
                self.dash(None);
                self.arc(frame, *centre, &arc_points(*centre, *from, *to, 1));
                self.content.stroke();
            }
            Item::Disc { centre, radius, fill, outline } => {
                let reach = self.view.px(*radius) / if frame == Frame::Plan { self.view.px_per_m } else { 1.0 };
                let quarter = |x: f64, y: f64| Point::new(centre.x + x * reach, centre.y + y * reach);
                let around =
                    [quarter(1.0, 0.0), quarter(0.0, 1.0), quarter(-1.0, 0.0), quarter(0.0, -1.0), quarter(1.0, 0.0)];
                if let Some(colour) = fill {
                    self.fill_colour(*colour);
                    self.arc(frame, *centre, &around);
                    self.content.fill_nonzero();
                }
                if let Some((colour, width)) = outline {
                    self.stroke_colour(*colour, pt(self.view.px(*width)));
                    self.dash(None);
                    self.arc(frame, *centre, &around);
                    self.content.close_and_stroke();
                }
            }
            Item::Text(text) => self.text(frame, text),
            Item::Picture(picture) => self.picture(frame, picture),
        }
    }

    /// A path along a circle through points at most a quarter turn apart, as Bézier curves: off by a quarter of a
    /// thousandth of the radius.
    fn arc(&mut self, frame: Frame, centre: Point, points: &[Point]) {
        let Some(&first) = points.first() else { return };
        let (x, y) = self.at(frame, first);
        self.content.move_to(x, y);
        for pair in points.windows(2) {
            let (u, v) = (pair[0] - centre, pair[1] - centre);
            let radius_2 = u.dot(u);
            if radius_2 <= 0.0 {
                continue;
            }
            // Four thirds of the tangent of a quarter of the angle, by half angles: no platform's sine function.
            let cosine = (u.dot(v) / radius_2).clamp(-1.0, 1.0);
            let (half_cosine, half_sine) = (((1.0 + cosine) / 2.0).sqrt(), ((1.0 - cosine) / 2.0).sqrt());
            let reach = 4.0 / 3.0 * half_sine / (1.0 + half_cosine);
            let turn = if u.cross(v) >= 0.0 { reach } else { -reach };
            let (x1, y1) = self.at(frame, pair[0] + u.left() * turn);
            let (x2, y2) = self.at(frame, pair[1] - v.left() * turn);
            let (x3, y3) = self.at(frame, pair[1]);
            self.content.cubic_to(x1, y1, x2, y2, x3, y3);
        }
    }

    fn text(&mut self, frame: Frame, text: &Text) {
        let anchor = match frame {
            Frame::Plan => self.view.screen_from_plan(text.at),
            Frame::Screen => text.at,
        } + text.offset_px;
        let font = Font::of(text.weight);
        let shift = font.width_px(&text.content, text.size_px)
            * match text.anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5,
                Anchor::End => 1.0,
            };
        // Stretches of letters that the font has, each with the distance from the start; others are drawn as boxes.
        let index = usize::from(text.weight == Weight::SemiBold);
        let mut stretches: Vec<(f64, Vec<u8>)> = Vec::new();
        let mut boxes: Vec<f64> = Vec::new();
        let (mut along, mut goes_on) = (0.0, false);
        for letter in text.content.chars() {
            match self.letters[index].number(letter) {
                Some(number) => {
                    if !goes_on {
                        stretches.push((along, Vec::new()));
                    }
                    if let Some((_, bytes)) = stretches.last_mut() {
                        bytes.extend(number.to_be_bytes());
                    }
                    goes_on = true;
                }
                None => {
                    boxes.push(along);
                    goes_on = false;
                }
            }
            along += f64::from(font.advance(letter)) * text.size_px;
        }
        // From the start of the text to a point along its baseline and above it, on the page.
        let place = |along: f64, above: f64| {
            let (right, up) = if text.upright { (-above, along - shift) } else { (along - shift, above) };
            (pt(anchor.x + right), pt(self.view.height_px - anchor.y + up))
        };
        let places: Vec<(f32, f32)> = stretches.iter().map(|(along, _)| place(*along, 0.0)).collect();
        let outlines: Vec<Vec<(f32, f32)>> = boxes
            .iter()
            .flat_map(|along| {
                let mut rings: Vec<Vec<(f32, f32)>> = Vec::new();
                for step in font.outline('\u{10ffff}') {
                    let (x, y) = match step {
                        Step::Move(x, y) => {
                            rings.push(Vec::new());
                            (x, y)
                        }
                        Step::Line(x, y) | Step::Quad(_, _, x, y) | Step::Cubic(_, _, _, _, x, y) => (x, y),
                        Step::Close => continue,
                    };
                    let at = place(along + f64::from(x) * text.size_px, f64::from(y) * text.size_px);
                    if let Some(ring) = rings.last_mut() {
                        ring.push(at);
                    }
                }
                rings
            })
            .collect();
        let size = pt(text.size_px);
        let name = self.letters[index].name();
        let layers = text.halo.map(|halo| (halo, true)).into_iter().chain([(text.colour, false)]);
        for (colour, is_halo) in layers {
            if is_halo {
                self.stroke_colour(colour, pt(text.size_px * 0.28));
                self.dash(None);
                self.content.set_line_join(LineJoinStyle::RoundJoin);
            } else {
                self.fill_colour(colour);
            }
            if !stretches.is_empty() {
                let mode = if is_halo { TextRenderingMode::Stroke } else { TextRenderingMode::Fill };
                self.content.begin_text().set_font(name, size).set_text_rendering_mode(mode);
                for ((_, bytes), &(x, y)) in stretches.iter().zip(&places) {
                    let [a, b, c, d] = if text.upright { [0.0, 1.0, -1.0, 0.0] } else { [1.0, 0.0, 0.0, 1.0] };
                    self.content.set_text_matrix([a, b, c, d, x, y]).show(Str(bytes));
                }
                self.content.end_text();
            }
            for ring in &outlines {
                for (index, &(x, y)) in ring.iter().enumerate() {
                    if index == 0 {
                        self.content.move_to(x, y);
                    } else {
                        self.content.line_to(x, y);
                    }
                }
                self.content.close_path();
            }
            match (outlines.is_empty(), is_halo) {
                (true, _) => {}
                (false, true) => drop(self.content.stroke()),
                (false, false) => drop(self.content.fill_nonzero()),
            }
            if is_halo {
                self.content.set_line_join(LineJoinStyle::MiterJoin);
            }
        }
    }

    fn picture(&mut self, frame: Frame, picture: &PlacedPicture) {
        // Dots to a pixel of the page at 150 to the inch.
        const DOTS: f64 = 150.0 / 96.0;
        let [start, right, below] = picture.corners.map(|corner| match frame {
            Frame::Plan => self.view.screen_from_plan(corner),
            Frame::Screen => corner,
        });
        let across_px = f64::from(picture.levels.size_px()[0]).max(1.0);
        let index = picture.levels.index_for(start.distance(right) / across_px * DOTS);
        let Some(level) = picture.levels.all().get(index) else { return };
        let (width_px, height_px) = (level.width_px, level.height_px);
        let count = width_px as usize * height_px as usize;
        let (mut rgb, mut alpha) = (Vec::with_capacity(3 * count), Vec::with_capacity(count));
        for y in 0..height_px {
            for x in 0..width_px {
                let [r, g, b, a] = level.pixel(i64::from(x), i64::from(y));
                rgb.extend([r, g, b]);
                alpha.push(a);
            }
        }
        let is_opaque = alpha.iter().all(|&a| a == 255);
        self.pictures.push(Embedded { width_px, height_px, rgb, alpha: (!is_opaque).then_some(alpha) });
        let name = picture_name(self.pictures.len() - 1);
        self.set_alpha((picture.opacity.clamp(0.0, 1.0) * 255.0).round() as u8);
        // The unit square of an image stands on its lower left corner.
        let (x_way, y_way) = (right - start, start - below);
        self.content.save_state();
        self.content.transform([
            pt(x_way.x),
            pt(-x_way.y),
            pt(y_way.x),
            pt(-y_way.y),
            pt(below.x),
            pt(self.view.height_px - below.y),
        ]);
        self.content.x_object(Name(name.as_bytes()));
        self.content.restore_state();
    }

    fn finish(mut self, facts: Facts<'_>) -> Vec<u8> {
        let (width, height) = (self.width_pt(), self.height_pt());
        let content = std::mem::replace(&mut self.content, Content::new()).finish();
        let mut next = 0;
        let mut fresh = || {
            next += 1;
            Ref::new(next)
        };
        let (catalog, pages, page, stream, info) = (fresh(), fresh(), fresh(), fresh(), fresh());
        let mut pdf = Pdf::new();
        let mut root = pdf.catalog(catalog);
        root.pages(pages).lang(TextStr("en"));
        root.viewer_preferences().display_doc_title(true);
        root.finish();
        let mut told = pdf.document_info(info);
        for (text, is_title) in [(facts.title, true), (facts.subject, false)] {
            if !text.is_empty() {
                if is_title {
                    told.title(TextStr(text))
                } else {
                    told.subject(TextStr(text))
                };
            }
        }
        told.producer(TextStr("Enfilade"));
        told.finish();
        pdf.pages(pages).kids([page]).count(1);
        let alphas: Vec<(u8, Ref)> = self.alphas.iter().map(|&alpha| (alpha, fresh())).collect();
        let fonts: Vec<(&Letters, Ref)> = self
            .letters
            .iter()
            .filter(|letters| !letters.used.is_empty())
            .map(|letters| (letters, write_font(&mut pdf, letters, &mut fresh)))
            .collect();
        let pictures: Vec<Ref> =
            self.pictures.iter().map(|picture| write_picture(&mut pdf, picture, &mut fresh)).collect();
        let mut sheet = pdf.page(page);
        sheet.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(stream);
        let mut resources = sheet.resources();
        let mut named = resources.fonts();
        for (letters, font) in &fonts {
            named.pair(letters.name(), *font);
        }
        named.finish();
        let mut named = resources.ext_g_states();
        for (alpha, state) in &alphas {
            named.pair(Name(alpha_name(*alpha).as_bytes()), *state);
        }
        named.finish();
        let mut named = resources.x_objects();
        for (index, picture) in pictures.iter().enumerate() {
            named.pair(Name(picture_name(index).as_bytes()), *picture);
        }
        named.finish();
        resources.finish();
        sheet.finish();
        for (alpha, state) in alphas {
            let opacity = channel(alpha);
            pdf.ext_graphics(state).non_stroking_alpha(opacity).stroking_alpha(opacity);
        }
        let content = deflated(&content);
        pdf.stream(stream, &content).filter(Filter::FlateDecode);
        pdf.finish()
    }
}

fn alpha_name(alpha: u8) -> String {
    format!("A{alpha}")
}

fn picture_name(index: usize) -> String {
    format!("P{index}")
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, 9)
}

/// Writes the used part of a font: a composite font whose codes are the glyphs' numbers in it, with what each means,
/// so that text can be searched and copied.
fn write_font(pdf: &mut Pdf, letters: &Letters, fresh: &mut impl FnMut() -> Ref) -> Ref {
    let (font, descendant, descriptor, cmap, file) = (fresh(), fresh(), fresh(), fresh(), fresh());
    let source = match letters.weight {
        Weight::Regular => super::font::REGULAR,
        Weight::SemiBold => super::font::SEMIBOLD,
    };
    // Six capitals that differ where the letters do, as the format asks for parts of a font.
    let text: String = letters.used.values().map(|(letter, _)| *letter).collect();
    let hash = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    let tag: String = (0..6).map(|place| char::from(b'A' + (hash >> (8 * place)) as u8 % 26)).collect();
    let name = format!("{tag}+{}", letters.font_name());
    let system = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
    pdf.type0_font(font)
        .base_font(Name(name.as_bytes()))
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(descendant)
        .to_unicode(cmap);
    let mut cid = pdf.cid_font(descendant);
    cid.subtype(CidFontType::Type0).base_font(Name(name.as_bytes())).system_info(system).font_descriptor(descriptor);
    cid.default_width(0.0);
    let mut widths = cid.widths();
    // Numbers are consecutive from 1; 0 is the box.
    widths.consecutive(1, letters.used.values().map(|&(_, advance)| (advance * 10.0).round() / 10.0));
    widths.finish();
    cid.finish();
    let (em, cap, descent) = (1000.0, (CAP_HEIGHT * 1000.0) as f32, (DESCENT * 1000.0) as f32);
    pdf.font_descriptor(descriptor)
        .name(Name(name.as_bytes()))
        .flags(FontFlags::SYMBOLIC)
        .bbox(Rect::new(-em, -em / 2.0, 2.0 * em, em * 1.2))
        .italic_angle(0.0)
        .ascent(em * 0.97)
        .descent(-descent)
        .cap_height(cap)
        .stem_v(if letters.weight == Weight::Regular { 90.0 } else { 130.0 })
        .font_file3(file);
    let mut meanings = UnicodeCmap::new(Name(b"Enfilade-UCS"), system);
    for (&number, &(letter, _)) in &letters.used {
        meanings.pair(number, letter);
    }
    let meanings = deflated(&meanings.finish());
    pdf.stream(cmap, &meanings).filter(Filter::FlateDecode);
    let part = subsetter::subset(source, 0, &letters.remapper).ok();
    let outlines = part.as_deref().and_then(|part| {
        ttf_parser::RawFace::parse(part, 0).ok()?.table(ttf_parser::Tag::from_bytes(b"CFF ")).map(deflated)
    });
    // The bundled bytes are subset (tested); if they were broken, viewers would take a font of their own.
    let outlines = outlines.unwrap_or_else(|| deflated(&[]));
    pdf.stream(file, &outlines).filter(Filter::FlateDecode).pair(Name(b"Subtype"), Name(b"CIDFontType0C"));
    font
}

fn write_picture(pdf: &mut Pdf, picture: &Embedded, fresh: &mut impl FnMut() -> Ref) -> Ref {
    let (id, mask) = (fresh(), picture.alpha.as_ref().map(|alpha| (fresh(), alpha)));
    let (width, height) = (picture.width_px as i32, picture.height_px as i32);
    let pixels = deflated(&picture.rgb);
    let mut image = pdf.image_xobject(id, &pixels);
    image.filter(Filter::FlateDecode);
    image.width(width).height(height).bits_per_component(8);
    image.color_space().device_rgb();
    if let Some((mask, _)) = mask {
        image.s_mask(mask);
    }
    image.finish();
    if let Some((mask, alpha)) = mask {
        let alpha = deflated(alpha);
        let mut image = pdf.image_xobject(mask, &alpha);
        image.filter(Filter::FlateDecode);
        image.width(width).height(height).bits_per_component(8);
        image.color_space().device_gray();
    }
    id
}
