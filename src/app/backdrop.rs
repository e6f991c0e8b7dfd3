//! The picture under the plan: read off the frame's path, painted at its place.

use std::path::{Path, PathBuf};

use egui::epaint::{Mesh, Vertex};
use egui::{Color32, ColorImage, Context, Painter, Rect, Shape, TextureHandle, TextureOptions, pos2};

use super::Picture;
use super::scene_painter::on_screen;
use crate::draw::View;
use crate::geometry::Vector;
use crate::plan::Backdrop;

/// What is shown of the picture.
#[derive(Default)]
pub(super) struct BackdropView {
    state: State,
}

#[derive(Default)]
enum State {
    #[default]
    None,
    Loading(PathBuf),
    Shown(PathBuf, TextureHandle),
    Missing(PathBuf),
}

impl BackdropView {
    /// The path of a picture that a plan has and that is neither shown nor being read.
    pub(super) fn wanted(&mut self, backdrop: Option<&Backdrop>, folder: Option<&Path>) -> Option<PathBuf> {
        let Some(backdrop) = backdrop else {
            self.state = State::None;
            return None;
        };
        let path = folder.unwrap_or(Path::new("")).join(&backdrop.path);
        let known = match &self.state {
            State::None => None,
            State::Loading(path) | State::Shown(path, _) | State::Missing(path) => Some(path),
        };
        if known == Some(&path) {
            return None;
        }
        self.state = State::Loading(path.clone());
        Some(path)
    }

    /// Takes over a picture that was read.
    ///
    /// # Errors
    /// Why it cannot be shown, when it is still wanted.
    pub(super) fn set_picture(
        &mut self,
        context: &Context,
        path: &Path,
        result: Result<ColorImage, String>,
    ) -> Result<(), String> {
        if !matches!(&self.state, State::Loading(wanted) if wanted == path) {
            return Ok(());
        }
        match result {
            Ok(mut image) => {
                let limit = context.input(|input| input.max_texture_side).max(1);
                while image.size.iter().any(|side| *side > limit) {
                    image = halved(&image);
                }
                let options = TextureOptions::LINEAR.with_mipmap_mode(Some(egui::TextureFilter::Linear));
                let texture = context.load_texture("backdrop", image, options);
                self.state = State::Shown(path.to_owned(), texture);
                Ok(())
            }
            Err(what) => {
                self.state = State::Missing(path.to_owned());
                Err(what)
            }
        }
    }

    /// Paints the picture at its place in a view.
    pub(super) fn paint(&self, painter: &Painter, rect: Rect, view: &View, backdrop: &Backdrop) {
        if let State::Shown(_, texture) = &self.state {
            painter.add(Shape::mesh(backdrop_mesh(rect, view, backdrop, texture)));
        }
    }
}

/// The picture under the plan, at its place.
fn backdrop_mesh(rect: Rect, view: &View, backdrop: &Backdrop, texture: &TextureHandle) -> Mesh {
    let [width, height] = texture.size().map(|side| side as f64 * backdrop.metres_per_pixel);
    let tint = Color32::WHITE.gamma_multiply(backdrop.opacity.clamp(0.0, 1.0) as f32);
    let mut mesh = Mesh::with_texture(texture.id());
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let from_origin = Vector::new(width * u, -height * v).rotated(backdrop.rotation_rad);
        let pos = on_screen(rect, view, backdrop.origin + from_origin);
        mesh.vertices.push(Vertex { pos, uv: pos2(u as f32, v as f32), color: tint });
    }
    mesh.indices = vec![0, 1, 2, 2, 1, 3];
    mesh
}

/// No picture with more pixels is read: 16384 by 16384.
const PICTURE_PIXELS: usize = 1 << 28;

/// Reads a PNG.
///
/// # Errors
/// When there is none, or it is damaged or too large, in words.
pub(super) fn read_picture(path: &Path) -> Result<ColorImage, String> {
    let file = std::fs::File::open(path).map_err(|error| error.to_string())?;
    let picture = Picture::from_png(std::io::BufReader::new(file), PICTURE_PIXELS)?;
    let size = [picture.width_px as usize, picture.height_px as usize];
    Ok(ColorImage::from_rgba_unmultiplied(size, &picture.rgba))
}

/// A picture of half the size, each pixel the mean of four: for displays with small textures.
fn halved(image: &ColorImage) -> ColorImage {
    let [width, height] = image.size.map(|side| (side / 2).max(1));
    let at = |x: usize, y: usize| image.pixels[y.min(image.size[1] - 1) * image.size[0] + x.min(image.size[0] - 1)];
    let mean = |x: usize, y: usize| {
        let four = [at(2 * x, 2 * y), at(2 * x + 1, 2 * y), at(2 * x, 2 * y + 1), at(2 * x + 1, 2 * y + 1)];
        let channel = |i: usize| (four.iter().map(|c| u32::from(c.to_array()[i])).sum::<u32>() / 4) as u8;
        Color32::from_rgba_premultiplied(channel(0), channel(1), channel(2), channel(3))
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect();
    ColorImage::new([width, height], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_halve_to_the_mean() {
        let image = ColorImage::new([2, 2], [0, 100, 100, 200].map(Color32::from_gray).to_vec());
        assert_eq!(
            halved(&image).pixels,
            [Color32::from_gray(100).to_array()].map(|[r, g, b, _]| Color32::from_rgba_premultiplied(r, g, b, 255))
        );
        assert_eq!(halved(&ColorImage::filled([1, 9], Color32::WHITE)).size, [1, 4]);
    }
}
