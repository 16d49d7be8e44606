//! `carom report`: figures and page, made from the records alone.

mod convert;

use std::path::{Path, PathBuf};

use carom_record::study::StudyManifest;
use carom_report::ReportSummary;
use convert::{Converter, Format};

use crate::exit::{Exit, Failure};
use crate::out;

/// Rebuild the figures and the report page of a run or a study from its data files alone
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  carom report runs/impact
  carom report runs/impact --format pdf
  carom report runs/impact --format png,pdf --scale 4

Text of PNG and PDF is drawn with the first of Helvetica, Arial, Liberation Sans, DejaVu Sans
and Noto Sans that is installed; characters that it lacks are taken from other installed fonts.")]
pub(crate) struct Arguments {
    /// The directory of the run or study
    directory: PathBuf,
    /// Also write every figure of the page in these formats, beside its SVG, and print the file
    /// names; for a study, the figures of its individual runs are not written
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FORMAT")]
    format: Vec<Format>,
    /// Pixels of a PNG per pixel of the figure, 0.1 to 10; 3 gives 288 dpi
    #[arg(long, value_name = "X", default_value = "3", value_parser = scale)]
    scale: f32,
    /// Use only this TrueType or OpenType font file for text
    #[arg(long, value_name = "FILE")]
    font: Option<PathBuf>,
}

fn scale(text: &str) -> Result<f32, String> {
    let scale = text.parse::<f32>().ok().filter(|x| (0.1..=10.0).contains(x));
    scale.ok_or_else(|| "must be a number from 0.1 to 10".to_owned())
}

pub(crate) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let Arguments { directory, format, scale, font } = arguments;
    // What cannot be written is refused before the page is made.
    let others = format.iter().any(|format| *format != Format::Svg);
    let converter = others.then(|| Converter::new(*scale, font.as_deref())).transpose()?;
    let ReportSummary { page, figures, .. } = if StudyManifest::is_in(directory) {
        crate::study_summary::report(directory)?
    } else {
        run_directory(directory)?;
        carom_report::report(directory)?
    };
    out::line(&page.display().to_string())?;
    for figure in figures.iter().filter(|_| !format.is_empty()) {
        if format.contains(&Format::Svg) {
            out::line(&figure.display().to_string())?;
        }
        if let Some(converter) = &converter {
            for written in converter.write(figure, format)? {
                out::line(&written.display().to_string())?;
            }
        }
    }
    Ok(Exit::Done)
}

/// Checks that a directory is that of a run.
pub(super) fn run_directory(directory: &Path) -> Result<(), Failure> {
    if directory.join("manifest.json").is_file() {
        return Ok(());
    }
    let path = directory.display();
    let what = if directory.exists() {
        format!("{path} is not the directory of a run or a study: it has no manifest.json")
    } else {
        format!("there is no directory {path}")
    };
    Err(Failure::argument(
        what,
        "give a directory that `carom run` or `carom study` created, for example runs/impact",
    ))
}
