//! Pictures of pixels: what the drawing library draws, and its texts in a font that comes
//! with the program, as a PNG file. The same on every machine.

use std::convert::Infallible;

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use plotters::prelude::DrawingBackend;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, DrawingErrorKind};

use super::failed;
use crate::Error;

/// Letters of DejaVu Sans; its licence lies beside it.
const FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans-part.ttf");

/// By how much the drawing library's sizes of texts exceed an em, as in its SVG.
const SIZE_OF_EM: f64 = 1.24;

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// A picture, three bytes a pixel, white before anything is drawn.
pub(super) struct Pixels {
    size: (u32, u32),
    bytes: Vec<u8>,
    font: FontRef<'static>,
}

impl Pixels {
    pub(super) fn new(size: (u32, u32)) -> Result<Self, Error> {
        let font = FontRef::try_from_slice(FONT).map_err(failed)?;
        let bytes = vec![255; 3 * size.0 as usize * size.1 as usize];
        Ok(Self { size, bytes, font })
    }

    pub(super) fn png(&self) -> Result<Vec<u8>, Error> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&self.bytes).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(file)
    }

    fn scale(&self, size: f64) -> PxScale {
        let units = self.font.units_per_em().unwrap_or(1000.0);
        let em = (size / SIZE_OF_EM) as f32;
        PxScale::from(em * self.font.height_unscaled() / units)
    }

    fn extent(&self, text: &str, size: f64) -> (f32, f32) {
        let font = self.font.as_scaled(self.scale(size));
        let advances = text.chars().map(|c| font.h_advance(font.glyph_id(c)));
        (advances.sum(), font.height())
    }
}

fn mixed(below: u8, above: u8, share: f64) -> u8 {
    let (below, above) = (f64::from(below), f64::from(above));
    (below + (above - below) * share.clamp(0.0, 1.0)).round() as u8
}

impl DrawingBackend for &mut Pixels {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        let (width, height) = self.size;
        let place = u32::try_from(x).ok().zip(u32::try_from(y).ok());
        let Some((x, y)) = place.filter(|(x, y)| *x < width && *y < height) else {
            return Ok(());
        };
        let first = 3 * (y as usize * width as usize + x as usize);
        let (red, green, blue) = color.rgb;
        let pixel = self.bytes.iter_mut().skip(first);
        for (byte, above) in pixel.zip([red, green, blue]) {
            *byte = mixed(*byte, above, color.alpha);
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let (width, height) = self.extent(text, style.size());
        Ok((width.ceil() as u32, height.ceil() as u32))
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (at_x, at_y): BackendCoord,
    ) -> Drawn {
        let (width, height) = self.extent(text, style.size());
        let left = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -width / 2.0,
            HPos::Right => -width,
        };
        let top = match style.anchor().v_pos {
            VPos::Top => 0.0,
            VPos::Center => -height / 2.0,
            VPos::Bottom => -height,
        };
        let font = self.font.clone();
        let font = font.as_scaled(self.scale(style.size()));
        let (mut x, baseline) = (left, top + font.ascent());
        let (color, turned) = (style.color(), style.transform());
        for c in text.chars() {
            let id = font.glyph_id(c);
            let glyph = id.with_scale_and_position(font.scale(), point(x, baseline));
            x += font.h_advance(id);
            // A space has no outline.
            let Some(outline) = font.outline_glyph(glyph) else {
                continue;
            };
            let corner = outline.px_bounds().min;
            let mut covered = Vec::new();
            outline.draw(|dx, dy, share| covered.push((dx, dy, share)));
            for (dx, dy, share) in covered {
                let place = (corner.x as i32 + dx as i32, corner.y as i32 + dy as i32);
                let (x, y) = turned.transform(place.0, place.1);
                let (alpha, rgb) = (color.alpha * f64::from(share), color.rgb);
                self.draw_pixel((at_x + x, at_y + y), BackendColor { alpha, rgb })?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{FONT, Pixels};
    use ab_glyph::{Font, FontRef};
    use plotters::prelude::*;

    #[test]
    fn the_font_has_every_letter_of_the_pictures() {
        let font = FontRef::try_from_slice(FONT).unwrap();
        for c in ('!'..='~').chain("θπ′°µ×−±".chars()) {
            assert_ne!(font.glyph_id(c).0, 0, "{c}");
        }
    }

    #[test]
    fn what_is_drawn_is_in_the_file_and_beyond_the_edge_nothing() {
        let mut pixels = Pixels::new((40, 20)).unwrap();
        {
            let root = (&mut pixels).into_drawing_area();
            let red = RGBColor(255, 0, 0).filled();
            root.draw(&Rectangle::new([(-5, -5), (3, 3)], red)).unwrap();
            let style = ("sans-serif", 16).into_font().color(&BLACK);
            root.draw(&Text::new("Mg", (30, 2), style)).unwrap();
            root.present().unwrap();
        }
        let file = pixels.png().unwrap();
        let mut read = png::Decoder::new(std::io::Cursor::new(file))
            .read_info()
            .unwrap();
        let mut bytes = vec![0; read.output_buffer_size().unwrap()];
        let info = read.next_frame(&mut bytes).unwrap();
        assert_eq!((info.width, info.height), (40, 20));
        let pixel = |x: usize, y: usize| &bytes[3 * (40 * y + x)..][..3];
        assert_eq!(pixel(0, 0), [255, 0, 0]);
        assert_eq!(pixel(6, 6), [255, 255, 255]);
        // A letter is dark, from its place on.
        let dark = |x: usize| (0..20).any(|y| pixel(x, y)[0] < 100);
        assert!((30..40).any(dark) && !(5..30).any(dark));
    }
}
