//! A figure of a run with the files beside it.

/// A figure of a report.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without extension.
    pub name: &'static str,
    /// Caption, with `σ_{yy}` for subscripts and backticks around code.
    pub caption: String,
    /// The picture.
    pub svg: String,
    /// Further files: endings and contents.
    pub files: Vec<(&'static str, String)>,
}

impl Figure {
    pub(crate) fn new(name: &'static str, caption: impl Into<String>, svg: String) -> Self {
        Self { name, caption: caption.into(), svg, files: Vec::new() }
    }

    /// With its data as a table, and a script that redraws it.
    pub(crate) fn with(mut self, table: String, script: String) -> Self {
        self.files.extend([("csv", table), ("py", script)]);
        self
    }

    /// Endings of all its files.
    pub(crate) fn endings(&self) -> Vec<&'static str> {
        std::iter::once("svg").chain(self.files.iter().map(|(ending, _)| *ending)).collect()
    }
}
