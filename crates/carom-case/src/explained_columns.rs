//! Columns of `history.csv` and `contact.csv` in words, for `carom explain COLUMN`.

use std::fmt;

use carom_record::units::Labels;
use carom_record::{ContactColumns, ContactRow};
use serde::Serialize;

use crate::columns::Recorded;
use crate::{Case, Document, Fallback, read};

/// A case with all that columns are named after.
const SAMPLE: &str = r#"
dimension = 3
material = [
    { name = "m", law = "hencky", density = 1.0, young = 1.0, poisson = 0.3, plastic = { yield = 1.0 } },
    { name = "elastic", law = "hencky", density = 1.0, young = 1.0, poisson = 0.3 },
]
body = [
    { name = "BODY", material = "m", element = "Hex27", mesh = { shape = "box", min = [0, 0, 0], max = [1, 1, 1], cells = [1, 1, 1] } },
    { name = "other", material = "elastic", element = "Hex27", mesh = { shape = "box", min = [1, 0, 0], max = [2, 1, 1], cells = [1, 1, 1] } },
]
support = [{ name = "SUPPORT", on = ["other.right"], fix = ["x"], moment_about = [0, 0, 0] }]
tie = [{ name = "TIE", secondary = "BODY.right", primary = "other.left" }]
probe = [{ name = "PROBE", at = [1.5, 0.5, 0.5], body = "other", record = [
    "ux", "uy", "uz", "vx", "vy", "vz", "ax", "ay", "az", "sigma_xx", "sigma_yy", "sigma_zz", "sigma_xy", "sigma_yz", "sigma_xz",
    "von_mises", "det_f", "plastic_strain", "yielded", "strain_xx", "strain_yy", "strain_zz", "strain_xy", "strain_yz", "strain_xz",
] }]
time = { end = 1.0, step = 0.5, scheme = { kind = "bathe", rho_inf = 0.5 } }
[[contact]]
name = "CONTACT"
secondary = "BODY.bottom"
mu = 0.1
primary = { plane = { point = [0, 0, -1], normal = [0, 0, 1] }, motion = { x = "t", rotate = "t", about = [0, 0, 0], axis = [0, 0, 1] } }
"#;

/// Columns of one meaning.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExplainedColumn {
    /// Names; `BODY`, `CONTACT`, `TIE`, `SUPPORT` and `PROBE` stand for names of the case.
    pub names: Vec<String>,
    /// The file that has them.
    pub file: &'static str,
    /// Meaning.
    pub meaning: String,
    /// Unit, in the units of the case; empty if none.
    pub unit: String,
}

impl ExplainedColumn {
    /// Whether a word is a name, that of a vector without its axis, or the part of one that does
    /// not depend on the case.
    fn is_named(&self, word: &str) -> bool {
        let quantity = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
        let is_same = |name: &String| {
            let stem = name.strip_suffix(['x', 'y', 'z']).and_then(|name| name.strip_suffix('_'));
            [Some(name.as_str()), stem].into_iter().flatten().any(|name| {
                let is_of_case = name.contains('.') && quantity(word) == quantity(name);
                name == word || is_of_case && !self.stands_for_another(word)
            })
        };
        self.names.iter().any(is_same)
    }

    /// Whether a word begins with a placeholder that these names do not have.
    fn stands_for_another(&self, word: &str) -> bool {
        let owner = word.split_once('.').map_or("", |(owner, _)| owner);
        let own = self.names.first().and_then(|name| name.split_once('.')).map_or("", |(own, _)| own);
        PLACEHOLDERS.contains(&owner) && owner != own
    }
}

const PLACEHOLDERS: [&str; 5] = ["BODY", "CONTACT", "TIE", "SUPPORT", "PROBE"];

/// The columns that a word names: `contact_force_y`, `contact_force`, `ball.center_x`, `center_x`.
pub fn explained_columns(word: &str) -> Vec<ExplainedColumn> {
    every_column().into_iter().filter(|column| column.is_named(word)).collect()
}

/// All columns, in the order of the files; components of a vector are one.
pub fn every_column() -> Vec<ExplainedColumn> {
    let sample: Option<Case> = Document::parse("sample", SAMPLE, &[]).ok().and_then(|text| read(&text).ok());
    let mut all: Vec<ExplainedColumn> = Vec::new();
    let mut add = |file, name: String, meaning: String, unit: String| match all.last_mut() {
        Some(last) if last.file == file && last.meaning == meaning && last.unit == unit => {
            last.names.push(name);
        }
        _ => all.push(ExplainedColumn { names: vec![name], file, meaning, unit }),
    };
    if let Some(case) = &sample {
        let fallback = Fallback::Velocity;
        let recorded = Recorded { by_contact: true, manufactured: true, fallback, ..Recorded::of(case) };
        for column in recorded.columns(&Labels::of("length", "time", "mass")) {
            if !column.name.starts_with("other.") {
                add("history.csv", column.name, column.description, column.unit);
            }
        }
    }
    for cell in ContactRow::default().cells(ContactColumns { axes: 3, has_field: true }) {
        let unit = if cell.unit == carom_record::metrics::Unit::None { "" } else { cell.unit.word() };
        add("contact.csv", cell.name.to_owned(), cell.meaning.to_owned(), unit.to_owned());
    }
    all
}

impl fmt::Display for ExplainedColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { names, file, meaning, unit } = self;
        let plural = if names.len() > 1 { "columns" } else { "column" };
        write!(f, "{}   {plural} of {file}\n  {meaning}", names.join(", "))?;
        if unit.is_empty() { Ok(()) } else { write!(f, "\n\nunit\n  {unit}") }
    }
}
