//! The lines of the palette: their contents and appearance.

use super::*;

/// Shows a line of the list. The keyboard stays in the text field.
pub(super) fn row(ui: &Ui, rect: Rect, index: usize, line: &Line, is_chosen: bool) -> Response {
    let response = ui.interact(rect, ui.scope_id().with(("line", index)), Sense::CLICK);
    let name = match (line.detail.as_str(), line.is_available) {
        ("", _) => line.title.clone(),
        (detail, true) => format!("{}, {detail}", line.title),
        (detail, false) => format!("{}, not available: {detail}", line.title),
    };
    response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, line.is_available, is_chosen, &name));
    let colours = colours(ui);
    let ground = match (is_chosen, response.hovered()) {
        (true, _) => colours.accent_soft,
        (false, true) => colours.hover,
        (false, false) => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, theme::RADIUS, ground);
    let fade = if line.is_available { 1.0 } else { 0.6 };
    let text = if line.is_available { colours.text } else { colours.text_weak };
    let mut left = rect.left() + 10.0;
    let middle = rect.center().y;
    match line.lead {
        LineLead::None => {}
        LineLead::Tick => {
            let square = Rect::from_center_size(pos2(left + ICON / 2.0, middle), Vec2::splat(ICON));
            Icon::Check.paint(ui.painter(), square, text.gamma_multiply(fade));
        }
        LineLead::Icon(icon) => {
            let square = Rect::from_center_size(pos2(left + ICON / 2.0, middle), Vec2::splat(ICON));
            icon.paint(ui.painter(), square, colours.text_weak);
        }
        LineLead::Swatch(colour) => swatch(ui, pos2(left + 8.0, middle), colour),
    }
    left += ICON + 8.0;
    let small = FontId::proportional(theme::SMALL);
    let trail = ui.painter().layout_no_wrap(line.trail.clone(), small.clone(), colours.text_weak);
    let right = rect.right() - 10.0 - trail.rect.width();
    let trail_rect = Rect::from_min_max(pos2(right, rect.top()), pos2(rect.right() - 10.0, rect.bottom()));
    put_line(ui, &line.trail, small.clone(), colours.text_weak.gamma_multiply(fade), trail_rect);
    let limit = if line.trail.is_empty() { right } else { right - 12.0 };
    // If both are long, the title gets two thirds.
    let most = if line.detail.is_empty() { limit - left } else { (limit - left) * 0.66 };
    let job =
        highlighted(&line.title, &line.characters, text, if line.is_available { colours.accent } else { text }, most);
    let galley = ui.painter().layout_job(job);
    let width = galley.rect.width();
    let at = pos2(left, (middle - galley.rect.height() / 2.0).round());
    ui.painter().galley(at, galley, text);
    let detail = Rect::from_min_max(pos2(left + width + 10.0, rect.top()), pos2(limit, rect.bottom()));
    put_line(ui, &line.detail, small, colours.text_weak, detail);
    response
}

/// A text with its matching characters highlighted.
fn highlighted(text: &str, characters: &[u32], colour: Color32, accent: Color32, width: f32) -> LayoutJob {
    let plain = TextFormat::simple(FontId::proportional(theme::BODY), colour);
    let marked = TextFormat::simple(FontId::new(theme::BODY, theme::semibold()), accent);
    let mut job = LayoutJob::default();
    for (index, letter) in (0u32..).zip(text.chars()) {
        let is_marked = characters.binary_search(&index).is_ok();
        job.append(letter.encode_utf8(&mut [0; 4]), 0.0, if is_marked { marked.clone() } else { plain.clone() });
    }
    job.wrap.max_width = width.max(0.0);
    job.wrap.max_rows = 1;
    job.wrap.break_anywhere = true;
    job
}

pub(super) fn command_lines(app: &App, ui: &Ui, search: &mut Search) -> Vec<Line> {
    // First by where the letters matched, then how well, then whether it is available and was recently
    // used; of equally good titles, the shortest has the least that did not match.
    type Rank = (u8, std::cmp::Reverse<u32>, usize, bool, usize, usize);
    let mut found: Vec<(Rank, Line)> = Vec::new();
    for (index, command) in COMMANDS.iter().enumerate() {
        let Some((menu, _)) = command.menu.filter(|_| command.id != "commands") else { continue };
        let title = command.plain_title();
        let why_not = command.why_not(app);
        let (tier, hit) = match search.hit(title) {
            Some(hit) => (0, hit),
            None => {
                let elsewhere = [format!("{} {title}", menu.title()), command.id.replace('-', " ")];
                let Some(hit) = elsewhere.iter().filter_map(|text| search.hit(text)).max_by_key(|hit| hit.score) else {
                    continue;
                };
                (1, Hit { characters: Vec::new(), ..hit })
            }
        };
        let recent = app.panels.recent.iter().position(|id| *id == command.id).unwrap_or(usize::MAX);
        let length = if search.is_empty() { 0 } else { title.chars().count() };
        let rank = (tier, std::cmp::Reverse(hit.score), length, why_not.is_some(), recent, index);
        let line = Line {
            title: command.title.to_owned(),
            characters: hit.characters,
            detail: why_not.unwrap_or(menu.title()).to_owned(),
            trail: app.keys_text(command, ui.ctx()),
            lead: if command.is_on(app) == Some(true) { LineLead::Tick } else { LineLead::None },
            is_available: why_not.is_none(),
            taken: Taken::Command(command),
        };
        found.push((rank, line));
    }
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, line)| line).collect()
}

pub(super) fn argument_lines(app: &App, ui: &Ui, choices: &[Choice], search: &mut Search) -> Vec<Line> {
    let palette = app.session.palette(ui);
    let mut found: Vec<(std::cmp::Reverse<u32>, Line)> = Vec::new();
    for choice in choices {
        let Choice { word, title, detail, trail, status } = choice;
        let Some(hit) = search.hit(title) else { continue };
        let lead = status.map_or(LineLead::None, |status| LineLead::Swatch(theme::colour(palette.status(status))));
        let line = Line {
            title: title.clone(),
            characters: hit.characters,
            detail: detail.clone(),
            trail: trail.clone(),
            lead,
            is_available: true,
            taken: Taken::Argument(word.clone()),
        };
        found.push((std::cmp::Reverse(hit.score), line));
    }
    // Stable: ties stay in their own order.
    if !search.is_empty() {
        found.sort_by_key(|(score, _)| *score);
    }
    found.into_iter().map(|(_, line)| line).collect()
}
