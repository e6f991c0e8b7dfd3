//! One case per behaviour.

use std::path::{Path, PathBuf};

use enfilade::draw::sheet::{self, Furniture, PageSize};
use enfilade::draw::{Drawing, Fill, LabelColours, Layers, Scene, Style, Theme, View, png, svg};
use enfilade::plan::LeafSide::{Left, Right};
use enfilade::plan::OpeningKind::{Door, DoubleDoor, Passage, Window};

use super::sketch::Sketch;
use crate::support::{assert_picture, assert_text};

fn reference(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(name)
}

/// Compares a sketch, fitted into a picture, with the reference of this name.
fn looks_like(name: &str, (width, height): (f64, f64), style: &Style, sketch: Sketch) {
    let (plan, analysis) = sketch.plan();
    let drawing = Drawing::new(&plan, &analysis);
    let view = View::fitting(drawing.bounds(), width, height, 10.0);
    assert_scene(name, &drawing.scene(style, &view));
}

fn assert_scene(name: &str, scene: &Scene) {
    assert_picture(&reference(&format!("{name}.png")), &png::png(scene).expect("a picture of few pixels"));
}

const SMALL: (f64, f64) = (200.0, 160.0);

fn bare() -> Style {
    Style { layers: Layers { names: false, areas: false, ..Layers::default() }, ..Style::default() }
}

fn named() -> Style {
    Style::default()
}

/// Two offices and a corridor with walls; the base of several cases.
fn two_offices() -> Sketch {
    Sketch::new()
        .walls(0.3, &[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0), (0.0, 0.0)])
        .walls(0.12, &[(0.0, 2.0), (8.0, 2.0)])
        .walls(0.12, &[(4.0, 2.0), (4.0, 6.0)])
        .rectangle("corridor", (0.0, 0.0), (8.0, 2.0))
        .rectangle("office", (0.0, 2.0), (4.0, 6.0))
        .rectangle("shared office", (4.0, 2.0), (8.0, 6.0))
        .opening(Door, [(0.0, 2.0), (8.0, 2.0)], 3.2, 0.9)
        .opening(Door, [(0.0, 2.0), (8.0, 2.0)], 4.8, 0.9)
        .opening(Door, [(0.0, 0.0), (0.0, 6.0)], 1.0, 1.0)
        .opening(Window, [(0.0, 6.0), (8.0, 6.0)], 2.0, 1.6)
        .opening(Window, [(0.0, 6.0), (8.0, 6.0)], 6.0, 1.6)
}

#[test]
fn walls_join_in_an_l() {
    let walls = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0)];
    looks_like("walls_l", SMALL, &bare(), Sketch::new().walls(0.4, &walls));
}

#[test]
fn walls_join_in_a_t() {
    let sketch = Sketch::new().walls(0.4, &[(0.0, 0.0), (2.0, 0.0), (4.0, 0.0)]).walls(0.25, &[(2.0, 0.0), (2.0, 2.0)]);
    looks_like("walls_t", SMALL, &bare(), sketch);
}

#[test]
fn walls_join_in_a_t_without_a_common_corner() {
    let sketch = Sketch::new().walls(0.4, &[(0.0, 0.0), (4.0, 0.0)]).walls(0.25, &[(2.0, 0.0), (2.5, 2.0)]);
    looks_like("walls_t_no_corner", SMALL, &bare(), sketch);
}

#[test]
fn walls_join_in_an_x() {
    let sketch = Sketch::new().walls(0.4, &[(0.0, 0.0), (4.0, 2.4)]).walls(0.3, &[(0.4, 2.4), (3.6, 0.0)]);
    looks_like("walls_x", SMALL, &bare(), sketch);
}

#[test]
fn a_sharp_joint_is_cut_off_and_a_blunt_one_is_not() {
    let sketch = Sketch::new()
        .walls(0.3, &[(4.0, 0.5), (0.0, 0.0), (4.0, -0.4)])
        .walls(0.3, &[(0.0, -1.0), (2.0, -1.6), (4.0, -1.0)]);
    looks_like("walls_sharp", SMALL, &bare(), sketch);
}

#[test]
fn three_walls_of_different_thickness_meet() {
    let sketch = Sketch::new()
        .walls(0.5, &[(0.0, 0.0), (2.0, 1.0)])
        .walls(0.2, &[(2.0, 1.0), (4.0, 0.0)])
        .walls(0.35, &[(2.0, 1.0), (2.2, 3.0)]);
    looks_like("walls_three", SMALL, &bare(), sketch);
}

#[test]
fn a_wall_without_thickness_is_a_line() {
    let sketch = Sketch::new()
        .walls(0.2, &[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)])
        .walls(0.0, &[(0.0, 0.0), (4.0, 3.0)]);
    looks_like("walls_line", SMALL, &bare(), sketch);
}

#[test]
fn doors_swing_as_the_plan_says() {
    let wall = [(0.0, 0.0), (6.4, 0.0)];
    let sketch = Sketch::new()
        .walls(0.15, &wall)
        .swung(wall, 0.8, true, Left)
        .swung(wall, 2.4, false, Left)
        .swung(wall, 4.0, true, Right)
        .swung(wall, 5.6, false, Right);
    looks_like("door_swings", SMALL, &bare(), sketch);
}

#[test]
fn doors_swing_into_the_smaller_room_along_the_nearer_wall() {
    looks_like("door_default_swings", SMALL, &bare(), two_offices());
}

#[test]
fn a_leaf_is_hollow_where_it_is_large_enough() {
    let wall = [(0.0, 0.0), (1.6, 0.0)];
    let sketch = Sketch::new().walls(0.15, &wall).swung(wall, 0.8, true, Left);
    looks_like("door_hollow_leaf", SMALL, &bare(), sketch);
}

#[test]
fn double_doors_have_two_leaves_and_very_wide_ones_slide() {
    let wall = [(0.0, 0.0), (8.0, 0.0)];
    let sketch = Sketch::new()
        .walls(0.2, &wall)
        .opening(DoubleDoor, wall, 1.4, 1.6)
        .opening(Door, wall, 4.0, 1.8)
        .opening(DoubleDoor, wall, 6.6, 2.0);
    looks_like("door_double_and_sliding", SMALL, &bare(), sketch);
}

#[test]
fn passages_are_gaps_with_dashed_lintels_and_windows_have_panes() {
    let wall = [(0.0, 0.0), (5.0, 0.0)];
    let sketch = Sketch::new().walls(0.3, &wall).opening(Passage, wall, 1.3, 1.6).opening(Window, wall, 3.7, 1.6);
    looks_like("passage_and_window", SMALL, &bare(), sketch);
}

#[test]
fn an_opening_beyond_the_edges_end_is_moved_in() {
    let sketch = Sketch::new()
        .walls(0.3, &[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)])
        .rectangle("office", (0.0, 0.0), (4.0, 3.0))
        .opening(Door, [(0.0, 0.0), (4.0, 0.0)], 3.9, 0.9)
        .opening(Door, [(0.0, 3.0), (4.0, 3.0)], 0.1, 0.9);
    looks_like("door_overhanging", SMALL, &bare(), sketch);
}

#[test]
fn an_opening_beside_its_wall_is_seated_in_it() {
    let sketch = Sketch::new().walls(0.3, &[(0.0, 0.0), (4.0, 0.0)]).free(Door, (0.6, 0.3), (1.5, 0.3)).free(
        Window,
        (2.4, -0.25),
        (3.4, -0.25),
    );
    looks_like("opening_seated", SMALL, &bare(), sketch);
}

#[test]
fn a_room_has_holes() {
    let hole = [(2.0, 1.5), (4.0, 1.5), (4.0, 3.0), (2.0, 3.0)];
    let sketch =
        Sketch::new().room_with_holes("corridor", "Round", &[(0.0, 0.0), (6.0, 0.0), (6.0, 4.5), (0.0, 4.5)], &[&hole]);
    looks_like("hole", SMALL, &named(), sketch);
}

#[test]
fn rooms_that_meet_on_centre_lines_get_thin_walls() {
    let sketch = Sketch::new()
        .rectangle("office", (0.0, 0.0), (3.0, 3.0))
        .rectangle("washroom", (3.0, 0.0), (4.5, 1.5))
        .rectangle("corridor", (3.0, 1.5), (6.0, 3.0))
        .opening(Door, [(3.0, 1.5), (3.0, 3.0)], 0.7, 0.9)
        .free(Door, (3.4, 1.5), (4.2, 1.5));
    looks_like("unwalled_centre_lines", SMALL, &bare(), sketch);
}

#[test]
fn rooms_drawn_to_the_faces_of_walls_get_those_walls() {
    let sketch = Sketch::new()
        .rectangle("office", (0.0, 0.0), (3.0, 3.0))
        .rectangle("office", (3.2, 0.0), (6.0, 1.4))
        .rectangle("corridor", (3.2, 1.6), (6.0, 3.0))
        .free(Door, (3.0, 1.9), (3.0, 2.8))
        .free(Passage, (4.0, 1.5), (5.2, 1.5));
    looks_like("unwalled_faces", SMALL, &bare(), sketch);
}

/// As a robot measures them: walls a few millimetres askew leave no stubs.
#[test]
fn rooms_that_stand_askew_have_plain_walls_between_them() {
    let sketch = Sketch::new()
        .room("bedroom", &[(4.7299, 8.7275), (0.0768, 8.7249), (0.0725, 5.0782), (4.7293, 5.0699)])
        .room("bedroom", &[(9.1304, 5.0701), (9.1299, 8.7296), (4.8704, 8.7298), (4.8701, 5.0699)])
        .room("living room", &[(11.9264, 0.0814), (11.931, 8.7218), (9.2691, 8.7186), (9.2728, 0.0765)]);
    looks_like("unwalled_askew", SMALL, &bare(), sketch);
}

#[test]
fn where_rooms_overlap_by_less_than_a_wall_the_wall_is() {
    let sketch = Sketch::new()
        .room("office", &[(0.0, 0.0), (3.1, 0.0), (3.3, 3.0), (0.0, 3.0)])
        .rectangle("corridor", (3.0, 0.0), (6.0, 3.0))
        .rectangle("closet", (4.2, 0.8), (5.4, 2.0));
    looks_like("unwalled_overlap", SMALL, &bare(), sketch);
}

#[test]
fn a_room_open_to_its_neighbour_ends_in_a_thin_line() {
    let sketch = Sketch::new()
        .walls(0.2, &[(0.0, 0.0), (6.0, 0.0), (6.0, 3.0), (0.0, 3.0), (0.0, 0.0)])
        .rectangle("openspace", (0.0, 0.0), (3.5, 3.0))
        .rectangle("kitchen", (3.5, 0.0), (6.0, 3.0))
        .opening(Passage, [(3.5, 0.0), (3.5, 3.0)], 1.5, 1.2);
    looks_like("open_boundary", SMALL, &bare(), sketch);
}

#[test]
fn a_name_stands_in_the_wide_part_of_an_l() {
    let outline = [(0.0, 0.0), (6.0, 0.0), (6.0, 1.2), (3.0, 1.2), (3.0, 4.5), (0.0, 4.5)];
    looks_like("name_l", SMALL, &named(), Sketch::new().room("conference room", &outline));
}

#[test]
fn a_name_in_a_narrow_tall_room_reads_upwards() {
    let sketch =
        Sketch::new().rectangle("corridor", (0.0, 0.0), (1.0, 5.0)).rectangle("office", (1.0, 0.0), (6.0, 5.0));
    looks_like("name_upright", SMALL, &named(), sketch);
}

#[test]
fn long_names_wrap_then_shrink_then_are_cut_off() {
    let square = |x: f64, side: f64| [(x, 0.0), (x + side, 0.0), (x + side, 3.0), (x, 3.0)];
    let name = "Reading room of the library";
    let sketch = Sketch::new()
        .named_room("office", name, &square(0.0, 3.0))
        .named_room("office", name, &square(3.0, 1.7))
        .named_room("office", "Kanzleileitung", &square(4.7, 1.2));
    looks_like("name_long", (300.0, 160.0), &named(), sketch);
}

#[test]
fn a_name_keeps_off_doors_or_stands_clear_of_them() {
    let sketch = Sketch::new()
        .walls(0.1, &[(0.0, 0.0), (3.0, 0.0), (3.0, 1.6), (0.0, 1.6), (0.0, 0.0)])
        .walls(0.1, &[(1.4, 0.0), (1.4, 1.6)])
        .rectangle("office", (0.0, 0.0), (1.4, 1.6))
        .rectangle("washroom", (1.4, 0.0), (3.0, 1.6))
        .swung([(0.0, 0.0), (1.4, 0.0)], 0.7, true, Left)
        .swung([(1.4, 0.0), (3.0, 0.0)], 0.55, true, Left);
    looks_like("name_and_door", SMALL, &named(), sketch);
}

#[test]
fn characters_the_font_does_not_have_are_boxes() {
    let outline = [(0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0)];
    looks_like("name_missing_glyphs", SMALL, &named(), Sketch::new().named_room("office", "和室 Ñ Ω Ж", &outline));
}

#[test]
fn dark_theme() {
    looks_like("dark", (300.0, 240.0), &Style { theme: Theme::Dark, ..named() }, two_offices());
}

#[test]
fn colour_blind_safe_labels() {
    let style = Style { label_colours: LabelColours::ColourBlindSafe, ..named() };
    looks_like("colour_blind_safe", (300.0, 240.0), &style, two_offices());
}

#[test]
fn fill_by_function_and_none() {
    looks_like("fill_function", SMALL, &Style { fill: Fill::Function, ..bare() }, two_offices());
    looks_like("fill_none", SMALL, &Style { fill: Fill::None, ..bare() }, two_offices());
}

#[test]
fn graph_over_the_plan() {
    let layers = Layers { graph: true, ..Layers::default() };
    looks_like("graph", (300.0, 240.0), &Style { layers, ..named() }, two_offices());
}

#[test]
fn grid_under_the_plan() {
    let layers = Layers { grid: true, rooms: false, ..bare().layers };
    looks_like("grid", SMALL, &Style { layers, ..named() }, two_offices());
}

#[test]
fn translucent_fills_and_halos_over_a_backdrop() {
    looks_like("over_backdrop", SMALL, &Style { fill_opacity: 0.5, halo: true, ..named() }, two_offices());
}

#[test]
fn a_fine_screen_gets_the_same_finer() {
    let (plan, analysis) = two_offices().plan();
    let drawing = Drawing::new(&plan, &analysis);
    let view = View { pixel_ratio: 2.0, ..View::fitting(drawing.bounds(), 150.0, 120.0, 8.0) };
    assert_scene("pixel_ratio_2", &drawing.scene(&named(), &view));
}

#[test]
fn part_of_a_plan_is_clipped() {
    let (plan, analysis) = two_offices().plan();
    let drawing = Drawing::new(&plan, &analysis);
    let whole = View::fitting(drawing.bounds(), 200.0, 160.0, 0.0);
    let view = View { px_per_m: whole.px_per_m * 3.0, centre: drawing.bounds().max, ..whole };
    assert_scene("clipped", &drawing.scene(&named(), &view));
}

fn page(sketch: Sketch, size: PageSize, style: &Style) -> Scene {
    let (plan, analysis) = sketch.plan();
    sheet::page(&Drawing::new(&plan, &analysis), style, size, Furniture::default())
}

fn titled_offices() -> Sketch {
    let mut sketch = Sketch::titled("Town hall", "Town hall", "Level 2");
    for i in 0..4 {
        let x = f64::from(i) * 3.0;
        let function = ["office", "shared office", "stairs", "lobby"][i as usize];
        sketch = sketch.rectangle(function, (x, 2.0), (x + 3.0, 6.0)).free(Door, (x + 1.0, 2.0), (x + 1.9, 2.0));
    }
    sketch.rectangle("corridor", (0.0, 0.0), (12.0, 2.0))
}

#[test]
fn pages_have_title_legend_and_scale_and_invent_no_north() {
    let size = PageSize::Longest(480.0);
    assert_scene("page", &page(titled_offices(), size, &named()));
    let narrow = PageSize::Exact(330.0, 360.0);
    assert_scene("page_narrow", &page(titled_offices(), narrow, &Style { theme: Theme::Dark, ..named() }));
    assert_scene("page_thumbnail", &page(titled_offices(), PageSize::Longest(64.0), &named()));
    assert_scene("page_empty", &page(Sketch::titled("Nothing yet", "", ""), PageSize::Exact(330.0, 200.0), &named()));
}

#[test]
fn svg_has_text_ids_and_titles() {
    let layers = Layers { graph: true, ..Layers::default() };
    let scene = page(titled_offices(), PageSize::Longest(480.0), &Style { layers, ..named() });
    let text = svg::svg(&scene);
    assert!(!text.contains(">N<"), "a north that the plan does not tell");
    assert_text(&reference("page.svg"), &text);
}

#[test]
fn svg_escapes_what_people_write() {
    let sketch = Sketch::titled("R&D <\"Nord\">", "", "").named_room(
        "office",
        "Müller & Söhne <1>",
        &[(0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0)],
    );
    assert_text(&reference("escaped.svg"), &svg::svg(&page(sketch, PageSize::Longest(340.0), &named())));
}

#[test]
fn hostile_sizes_are_refused() {
    let (plan, analysis) = two_offices().plan();
    let drawing = Drawing::new(&plan, &analysis);
    for (width, height) in [(0.0, 10.0), (10.0, f64::NAN), (1e9, 10.0), (8192.0, 8193.0), (-5.0, 5.0)] {
        let view = View { width_px: width, height_px: height, ..View::fitting(drawing.bounds(), 100.0, 100.0, 0.0) };
        let error = png::png(&drawing.scene(&bare(), &view)).expect_err("refused").to_string();
        assert!(error.contains("1 to 8192"), "{error}");
    }
}
