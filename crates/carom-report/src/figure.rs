//! A figure of a run with the files beside it.

use maud::{Markup, PreEscaped};

/// Width in pixels of a picture for a narrow window.
pub(crate) const NARROW: f64 = 440.0;

/// A figure of a report.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// File name without extension.
    pub(crate) name: String,
    /// Caption, with `σ_{yy}` for subscripts and backticks around code.
    pub(crate) caption: String,
    /// The picture.
    pub(crate) svg: String,
    /// The picture for a narrow window, of which the page shows one or the other.
    pub(crate) narrow: String,
    /// Heading on the page of a run.
    pub(crate) title: String,
    /// Numbers for the script of the page.
    pub(crate) data: Option<serde_json::Value>,
    /// The drawn numbers, as the text of a `.csv` file.
    pub(crate) table: Option<String>,
    /// Content of the page below the picture.
    pub(crate) key: Markup,
}

impl Figure {
    pub(crate) fn new(
        name: impl Into<String>,
        caption: impl Into<String>,
        [svg, narrow]: [String; 2],
    ) -> Self {
        Self {
            name: name.into(),
            caption: caption.into(),
            svg,
            narrow,
            title: String::new(),
            data: None,
            table: None,
            key: Markup::default(),
        }
    }

    /// The pictures on the page.
    pub(crate) fn pictures(&self) -> Markup {
        let named =
            |svg: &str, name: &str| svg.replacen("<svg class=\"", &format!("<svg class=\"{name} "), 1);
        PreEscaped(named(&self.svg, "broad") + &named(&self.narrow, "narrow"))
    }

    /// The figure with a table of its numbers.
    pub(crate) fn with_table(mut self, table: String) -> Self {
        self.table = Some(table);
        self
    }
}
