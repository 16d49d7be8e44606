//! Figures as PNG and PDF, by the libraries resvg and svg2pdf (ADR 58). Text is drawn with fonts of
//! the system: the figures contain none.

use std::path::{Path, PathBuf};

use crate::exit::Failure;

#[cfg(feature = "figures")]
use resvg::{tiny_skia, usvg};

/// A format of figures.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Format {
    /// Written with the page in any case; only the file names are printed
    Svg,
    /// Raster image; needs a build with `--features figures`
    Png,
    /// Page of the size of the figure; needs the same build as png
    Pdf,
}

/// Converts figures.
#[cfg(feature = "figures")]
pub(super) struct Converter {
    options: usvg::Options<'static>,
    scale: f32,
}

#[cfg(feature = "figures")]
impl Converter {
    /// A converter with the pixels of a PNG per pixel of a figure, and the only font or those that
    /// are installed.
    pub(super) fn new(scale: f32, font: Option<&Path>) -> Result<Self, Failure> {
        let mut options = usvg::Options::default();
        let fonts = options.fontdb_mut();
        let family = if let Some(path) = font {
            fonts.load_font_file(path).map_err(|error| {
                Failure::argument(
                    format!("the font {} cannot be read: {error}", path.display()),
                    "give a TrueType or OpenType file",
                )
            })?;
            fonts.faces().find_map(|face| Some(face.families.first()?.0.clone()))
        } else {
            fonts.load_system_fonts();
            installed(fonts)
        };
        let family = family.ok_or_else(|| match font {
            Some(path) => Failure::argument(
                format!("{} contains no font", path.display()),
                "give a TrueType or OpenType file",
            ),
            None => Failure::argument(
                format!("no font was found for the text of figures: none of {}", FONTS.join(", ")),
                "install one of them (for example the package fonts-dejavu-core), or give --font FILE",
            ),
        })?;
        fonts.set_sans_serif_family(family);
        Ok(Self { options, scale })
    }

    /// Writes a figure in the given formats beside its SVG; returns the files.
    pub(super) fn write(&self, figure: &Path, formats: &[Format]) -> Result<Vec<PathBuf>, Failure> {
        let failed = |path: &Path, error: &dyn std::fmt::Display| Failure::cannot("write", path, error);
        let svg = std::fs::read(figure).map_err(|error| failed(figure, &error))?;
        let tree = usvg::Tree::from_data(&svg, &self.options).map_err(|error| failed(figure, &error))?;
        let mut written = Vec::new();
        for (format, ending) in [(Format::Png, "png"), (Format::Pdf, "pdf")] {
            if !formats.contains(&format) {
                continue;
            }
            let path = figure.with_extension(ending);
            let bytes = match format {
                Format::Pdf => pdf(&tree).map_err(|error| failed(&path, &error))?,
                _ => self.png(&tree).map_err(|error| failed(&path, &error))?,
            };
            std::fs::write(&path, bytes).map_err(|error| failed(&path, &error))?;
            written.push(path);
        }
        Ok(written)
    }

    fn png(&self, tree: &usvg::Tree) -> Result<Vec<u8>, String> {
        let [width, height] = [tree.size().width(), tree.size().height()].map(|x| (x * self.scale).round());
        let mut pixels = tiny_skia::Pixmap::new(width as u32, height as u32).ok_or_else(|| {
            format!("a picture of {width} × {height} pixels is too large; use a smaller --scale")
        })?;
        resvg::render(tree, tiny_skia::Transform::from_scale(self.scale, self.scale), &mut pixels.as_mut());
        pixels.encode_png().map_err(|error| error.to_string())
    }
}

/// Families of text, the preferred one first; they are those that figures name.
#[cfg(feature = "figures")]
const FONTS: [&str; 5] = ["Helvetica", "Arial", "Liberation Sans", "DejaVu Sans", "Noto Sans"];

/// The first of [`FONTS`] that is installed.
#[cfg(feature = "figures")]
fn installed(fonts: &usvg::fontdb::Database) -> Option<String> {
    use usvg::fontdb::{Family, Query};

    let has =
        |name: &str| fonts.query(&Query { families: &[Family::Name(name)], ..Query::default() }).is_some();
    FONTS.into_iter().find(|name| has(name)).map(str::to_owned)
}

/// The figure as a page of its size: a pixel is 1/96 inch.
#[cfg(feature = "figures")]
fn pdf(tree: &usvg::Tree) -> Result<Vec<u8>, String> {
    let page = svg2pdf::PageOptions { dpi: 96.0 };
    svg2pdf::to_pdf(tree, svg2pdf::ConversionOptions::default(), page).map_err(|error| error.to_string())
}

/// A program that was built without the libraries has none.
#[cfg(not(feature = "figures"))]
pub(super) enum Converter {}

#[cfg(not(feature = "figures"))]
impl Converter {
    pub(super) fn new(_: f32, _: Option<&Path>) -> Result<Self, Failure> {
        Err(Failure::argument(
            "this program was built without PNG and PDF, whose libraries take minutes to compile",
            "cargo install --path crates/carom --features figures, in a clone of Carom; or draw the figure \
                   with carom.plot (Python, matplotlib), or print report.html to PDF in a browser",
        ))
    }

    pub(super) fn write(&self, _: &Path, _: &[Format]) -> Result<Vec<PathBuf>, Failure> {
        match *self {}
    }
}
