//! `manifest.json`: what was run, on which machine, and how it ended.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::{Facts, RecordError, Warning, available_memory, json, stream};

/// Bytes of memory per byte of a table that is read: its text, and its values.
const PER_BYTE: f64 = 3.0;

/// Status of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The run is being computed, or its process was killed; it can be resumed.
    Running,
    /// The run reached its end time.
    Finished,
    /// The run was interrupted by the user; it can be resumed.
    Stopped,
    /// The run could not continue, for the reason in the manifest.
    Failed,
}

/// A column of `history.csv`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Header in the file.
    pub name: String,
    /// Unit label; empty for counts and ratios.
    pub unit: String,
    /// Short description of the column.
    pub description: String,
    /// Written without a decimal point.
    pub integer: bool,
}

/// The input, to reproduce the run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Text of the case file.
    pub text: String,
    /// The `--set key=value` options, in order.
    pub sets: Vec<String>,
    /// Folder to which its paths are relative; the working directory if there is none.
    pub folder: Option<PathBuf>,
    /// Whether the run was made without a report page; `carom resume` then makes none.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub no_report: bool,
}

impl Source {
    /// BLAKE3 hash of the case text and the options, in hexadecimal. Each part is preceded by its
    /// length, so that the parts cannot be confused.
    pub fn hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for part in std::iter::once(&self.text).chain(&self.sets) {
            hasher.update(&(part.len() as u64).to_le_bytes()).update(part.as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }
}

/// Properties of a computer that may affect a result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Cores available to this process.
    pub cpus: usize,
    /// Operating system.
    pub os: String,
    /// Processor family.
    pub arch: String,
    /// Model of the processor, where the system tells it.
    pub processor: String,
}

impl Machine {
    /// The machine of this process.
    pub fn current() -> Self {
        Self {
            cpus: std::thread::available_parallelism().map_or(1, usize::from),
            os: std::env::consts::OS.into(),
            arch: std::env::consts::ARCH.into(),
            processor: processor(),
        }
    }

    /// The largest number of threads, or of concurrent runs, that is accepted. More than one per
    /// core can only cost time and memory.
    pub fn most_concurrent(&self) -> usize {
        (4 * self.cpus).max(64)
    }
}

/// Model of the first core that Linux lists; empty on other systems.
fn processor() -> String {
    use std::io::{BufRead, BufReader};
    let Ok(list) = std::fs::File::open("/proc/cpuinfo") else { return String::new() };
    let mut lines = BufReader::new(list).lines().map_while(Result::ok);
    let model =
        lines.find_map(|line| Some(line.strip_prefix("model name")?.split_once(':')?.1.trim().to_owned()));
    model.unwrap_or_default()
}

/// Outcome of one `[[expect]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Expectation {
    /// The quantity as written in the case file: `min A.uy`.
    pub what: String,
    /// The bound in words: `-0.7827 ± 0.004`.
    pub expected: String,
    /// The expected value, or the upper or lower bound.
    pub value: Option<f64>,
    /// Absolute tolerance about the expected value; none for an upper or lower bound.
    pub tolerance: Option<f64>,
    /// The value in the record; none if it cannot be evaluated.
    pub got: Option<f64>,
    /// Whether the bound is satisfied.
    pub pass: bool,
    /// Why the quantity has no value in the record.
    pub why: Option<String>,
    /// Where the expected value comes from.
    pub source: Option<String>,
    /// Whether `carom verify --fast` skips the expectation.
    pub slow: bool,
}

/// The whole manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Status of the run.
    pub status: Status,
    /// Why the run stopped or failed.
    pub reason: Option<String>,
    /// Version of Carom that wrote the record.
    pub version: String,
    /// Hash of `source`.
    pub input_hash: String,
    /// When the directory was created, UTC.
    pub created: String,
    /// When the last process that wrote the record started, UTC.
    pub started: String,
    /// The machine that the run was computed on.
    pub machine: Machine,
    /// Number of threads.
    pub threads: usize,
    /// Columns of `history.csv`, in order.
    pub columns: Vec<Column>,
    /// Named sides, `body.side`: chains of point numbers of the field files in order along the
    /// boundary, facet by facet, with interior points between the end points of a facet.
    pub sides: BTreeMap<String, Vec<Vec<usize>>>,
    /// Edges of the rigid triangulated surfaces by contact, as pairs of end points in their initial
    /// position.
    pub surfaces: BTreeMap<String, Vec<[[f64; 3]; 2]>>,
    /// Doubts about the case, and, once the run has finished, about its results.
    pub warnings: Vec<Warning>,
    /// Wall seconds per phase.
    pub timings: BTreeMap<String, f64>,
    /// Counts: steps, newton, factorisations, rejected, …
    pub counters: BTreeMap<String, u64>,
    /// BLAKE3 hashes by the name of the file: of the tables and the log once the run has ended, and
    /// of the files that a stop wrote.
    pub hashes: BTreeMap<String, String>,
    /// Outcomes of the expectations, once the run has finished.
    pub expectations: Vec<Expectation>,
    /// Properties of the case that metrics and studies depend on.
    pub facts: Facts,
    /// The case as resolved.
    pub case: serde_json::Value,
    /// The case as given.
    pub source: Source,
}

/// Phases of a run whose wall seconds are in `timings`, in the order of a step, with descriptions.
pub const PHASES: [(&str, &str); 5] = [
    ("assembly", "forces and tangents of cells"),
    ("contact", "detection, gaps and their derivatives"),
    ("factor", "filling, ordering and factorising the linear system"),
    ("solve", "solving with the factorisation"),
    ("output", "writing the record"),
];

impl Manifest {
    /// Creates the manifest of a run that starts now on this machine.
    pub fn new(
        version: &str,
        facts: Facts,
        case: serde_json::Value,
        source: Source,
        columns: Vec<Column>,
        threads: usize,
    ) -> Self {
        let input_hash = source.hash();
        let started = now();
        Self {
            status: Status::Running,
            reason: None,
            version: version.into(),
            input_hash,
            created: started.clone(),
            started,
            machine: Machine::current(),
            threads,
            columns,
            sides: BTreeMap::new(),
            surfaces: BTreeMap::new(),
            warnings: Vec::new(),
            timings: BTreeMap::new(),
            counters: BTreeMap::new(),
            hashes: BTreeMap::new(),
            expectations: Vec::new(),
            facts,
            case,
            source,
        }
    }

    /// Name, description and wall seconds of each measured phase; the last one is the remainder of
    /// the total. Empty before a run has ended.
    pub fn phases(&self) -> Vec<(&'static str, &'static str, f64)> {
        let Some(total) = self.timings.get("total") else { return Vec::new() };
        let known = PHASES.iter().filter_map(|&(name, what)| Some((name, what, *self.timings.get(name)?)));
        let mut phases: Vec<_> = known.collect();
        let remainder = total - phases.iter().map(|(.., seconds)| seconds).sum::<f64>();
        phases.push(("other", "sums, energies, projections, control logic", remainder.max(0.0)));
        phases
    }

    /// Reads `manifest.json` of a run directory.
    pub fn read(directory: &Path) -> Result<Self, RecordError> {
        let hint = "run the case again, or use the version of Carom that wrote it";
        let found = json::read(&directory.join("manifest.json"), hint)?;
        found.ok_or_else(|| RecordError::NotARun { path: directory.to_path_buf() })
    }

    /// Reads a file of the run directory; it must be the one that the manifest describes, if it
    /// does.
    pub(crate) fn file(&self, directory: &Path, name: &str) -> Result<Vec<u8>, RecordError> {
        let path = directory.join(name);
        let length = path.metadata().map_or(0, |facts| facts.len());
        if let Some(available) = available_memory().filter(|left| PER_BYTE * length as f64 > *left) {
            let why = format!("it has {length} bytes, and {available:.0} bytes of memory are available");
            let error = std::io::Error::new(std::io::ErrorKind::OutOfMemory, why);
            return Err(RecordError::io("read", &path)(error));
        }
        let bytes = std::fs::read(&path).map_err(|error| stream::unreadable(&path, error))?;
        match self.hashes.get(name) {
            Some(hash) if blake3::hash(&bytes).to_hex().as_str() != hash => {
                Err(stream::altered(&path, "it has changed since it was written"))
            }
            _ => Ok(bytes),
        }
    }

    /// Replaces `manifest.json` of a run directory.
    ///
    /// # Errors
    /// Input/output or system error.
    pub fn write(&self, directory: &Path) -> Result<(), RecordError> {
        json::write(&directory.join("manifest.json"), self)
    }
}

/// The current time, UTC, to the second: `2026-03-01T12:00:00Z`.
pub fn now() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs() as i64);
    timestamp(seconds)
}

/// Civil date from days since 1970 (H. Hinnant, "chrono-compatible low-level date algorithms").
pub fn timestamp(seconds: i64) -> String {
    let days = seconds.div_euclid(86400);
    let second = seconds.rem_euclid(86400);
    let z = days + 719_468;
    let era = z.div_euclid(146_097);
    let doe = z.rem_euclid(146_097);
    let yoe = (doe - doe / 1460 + doe / 36_524 - doe / 146_096) / 365;
    let doy = doe - (365 * yoe + yoe / 4 - yoe / 100);
    let mp = (5 * doy + 2) / 153;
    let day = doy - (153 * mp + 2) / 5 + 1;
    let month = if mp < 10 { mp + 3 } else { mp - 9 };
    let year = yoe + era * 400 + i64::from(month <= 2);
    let h = second / 3600;
    let m = second / 60 % 60;
    let s = second % 60;
    format!("{year:04}-{month:02}-{day:02}T{h:02}:{m:02}:{s:02}Z")
}
