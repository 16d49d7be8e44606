//! A figure of a run with the files beside it.

/// Width in pixels of a picture for a narrow window.
pub(crate) const NARROW: f64 = 440.0;

/// A figure of a report.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without extension.
    pub name: &'static str,
    /// Caption, with `σ_{yy}` for subscripts and backticks around code.
    pub caption: String,
    /// The picture.
    pub svg: String,
    /// The picture for a narrow window; empty where it would be the same.
    pub narrow: String,
    /// Further files: endings and contents.
    pub files: Vec<(&'static str, String)>,
}

impl Figure {
    pub(crate) fn new(name: &'static str, caption: impl Into<String>, svg: String) -> Self {
        Self { name, caption: caption.into(), svg, narrow: String::new(), files: Vec::new() }
    }

    /// With a picture for a narrow window, of which the page shows one or the other.
    pub(crate) fn with_narrow(mut self, svg: String) -> Self {
        self.narrow = svg;
        self
    }

    /// The pictures on the page.
    pub(crate) fn pictures(&self) -> String {
        pictures(&self.svg, &self.narrow)
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

/// A picture with that for a narrow window, which may be empty.
pub(crate) fn pictures(broad: &str, narrow: &str) -> String {
    let named = |svg: &str, name: &str| svg.replacen("<svg class=\"", &format!("<svg class=\"{name} "), 1);
    match narrow {
        "" => broad.to_owned(),
        narrow => named(broad, "broad") + &named(narrow, "narrow"),
    }
}
