//! `fields.vtkhdf`: the fields of a run in one file, as an alternative to `fields.pvd` with its VTU
//! files.
//!
//! The mesh is written once. The values of a step are written first; then a single write increases
//! the number of steps, so that a killed process leaves the steps before it intact. When the file
//! is full, it is copied to a new file of twice the capacity, which is then renamed. At the end of
//! the run it is truncated to the steps it contains.

mod hdf5;
mod layout;
mod read;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use hdf5::Kind;
use layout::{BODIES, COUNT, INTEGER, Layout, STEPS, TIMES, path_of};
use read::{Contents, bytes_at};

use crate::decimal::decimal;
use crate::stream::{Hash, altered};
use crate::{Block, FieldEntry, FieldSet, RecordError, files};

const HINT: &str = "run the case again";
const FIRST_CAPACITY: u64 = 16;
/// Datasets of the mesh, which are written once.
const MESH: [&str; 8] = [
    "NumberOfPoints",
    "NumberOfCells",
    "NumberOfConnectivityIds",
    "Points",
    "Connectivity",
    "Offsets",
    "Types",
    "CellData/body",
];

/// Its path in a run directory.
pub(crate) fn path(directory: &Path) -> PathBuf {
    directory.join("fields.vtkhdf")
}

/// An open file whose headers have been read.
struct Opened<F> {
    file: F,
    path: PathBuf,
    contents: Contents,
    layout: Layout,
}

fn corrupt(path: &Path) -> impl Fn(String) -> RecordError {
    |what| RecordError::corrupt(path, None, what, HINT)
}

/// The file of a run, if it has one.
fn open(directory: &Path, write: bool) -> Result<Option<Opened<File>>, RecordError> {
    let path = path(directory);
    match OpenOptions::new().read(true).write(write).open(&path) {
        Ok(file) => Opened::new(file, &path).map(Some),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(RecordError::io("open", &path)(error)),
    }
}

/// Writes the fields of an entry at the given place among all entries, and sets the number of
/// steps to include it; returns the checksum of the entry.
pub(crate) fn put(
    directory: &Path,
    place: usize,
    entry: &FieldEntry,
    fields: &FieldSet,
) -> Result<Hash, RecordError> {
    fields.check()?;
    let place = place as u64;
    let Some(mut opened) = open(directory, true)? else {
        if place > 0 {
            return Err(corrupt(&path(directory))(format!("it is missing, but had {place} steps")));
        }
        create(&path(directory), entry, fields)?;
        return Ok(hashes(directory, 1)?[0]);
    };
    let (layout, count) = (&opened.layout, opened.layout.count);
    if Layout::of(fields, count, layout.capacity) != *layout {
        let path = opened.path.display();
        return Err(RecordError::Field { what: format!("{path} has other bodies or quantities") });
    }
    if place > count {
        return Err(corrupt(&opened.path)(format!("it has {count} steps, but had {place}")));
    }
    if place == layout.capacity {
        opened.copy(2 * place)?;
        return put(directory, place as usize, entry, fields);
    }
    let path = opened.path.clone();
    opened.write_step(place, entry, fields).map_err(RecordError::io("write", &path))?;
    opened.count(place + 1)?;
    opened.hash(place).map_err(corrupt(&path))
}

/// Checksums of the first entries; the first includes the mesh.
pub(crate) fn hashes(directory: &Path, count: usize) -> Result<Vec<Hash>, RecordError> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let path = path(directory);
    let mut opened = open(directory, false)?.ok_or_else(|| altered(&path, "it is missing"))?;
    let steps = opened.layout.count;
    if steps < count as u64 {
        return Err(altered(&path, format!("it has {steps} steps, but had {count}")));
    }
    (0..count as u64).map(|place| opened.hash(place).map_err(corrupt(&path))).collect()
}

/// Removes all entries after the given ones, which are the first ones.
pub(crate) fn keep(directory: &Path, entries: &[FieldEntry]) -> Result<(), RecordError> {
    let (path, count) = (path(directory), entries.len());
    // A partial file is as large as the file itself, and may never be overwritten.
    removed(&files::partial(&path))?;
    if count == 0 {
        return removed(&path);
    }
    let Some(mut opened) = open(directory, true)? else { return Ok(()) };
    match opened.layout.count as usize {
        more if more > count => opened.count(count as u64),
        less if less < count => Err(corrupt(&path)(format!("it has {less} steps, but had {count}"))),
        _ => Ok(()),
    }
}

fn removed(path: &Path) -> Result<(), RecordError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(RecordError::io("remove", path)(error)),
        _ => Ok(()),
    }
}

/// Truncates the file to the steps it contains.
pub(crate) fn finish(directory: &Path) -> Result<(), RecordError> {
    match open(directory, false)? {
        Some(mut opened) if opened.layout.count < opened.layout.capacity => opened.copy(opened.layout.count),
        _ => Ok(()),
    }
}

/// The steps and times of a run's file; none if it has none.
pub(crate) fn entries(directory: &Path) -> Result<Option<Vec<FieldEntry>>, RecordError> {
    let Some(mut opened) = open(directory, false)? else { return Ok(None) };
    opened.entries().map(Some).map_err(corrupt(&opened.path))
}

/// The fields of one entry.
pub(crate) fn read(directory: &Path, entry: &FieldEntry) -> Result<FieldSet, RecordError> {
    let path = path(directory);
    let file = File::open(&path).map_err(RecordError::io("open", &path))?;
    let mut opened = Opened::new(file, &path)?;
    opened.fields(entry.step).map_err(corrupt(&opened.path))
}

/// A new file with one step in it.
fn create(path: &Path, entry: &FieldEntry, fields: &FieldSet) -> Result<(), RecordError> {
    let layout = Layout::of(fields, 1, FIRST_CAPACITY);
    let whole =
        |values: &mut dyn Iterator<Item = u64>| values.flat_map(u64::to_le_bytes).collect::<Vec<u8>>();
    let cells = || fields.blocks.iter().flat_map(|b| b.cells().map(move |c| (b, c)));
    let mut ends = 0;
    let ends = cells().map(|(_, c)| {
        ends += c.len() as u64;
        ends
    });
    let bodies = fields.blocks.iter().enumerate().flat_map(|(i, b)| b.cells().map(move |_| i as i32));
    let mesh = [
        ("NumberOfPoints", layout.points.to_le_bytes().to_vec()),
        ("NumberOfCells", layout.cells.to_le_bytes().to_vec()),
        ("NumberOfConnectivityIds", layout.connectivity.to_le_bytes().to_vec()),
        ("Points", fields.points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()),
        ("Connectivity", whole(&mut cells().flat_map(|(_, c)| c).map(|&node| node as u64))),
        ("Offsets", whole(&mut std::iter::once(0).chain(ends))),
        ("Types", cells().map(|(b, _)| b.cell.file_type(b.degree)).collect()),
        ("CellData/body", bodies.flat_map(i32::to_le_bytes).collect()),
    ];
    files::replace(path, |file| {
        begin(file, &layout, mesh.map(|(name, bytes)| (format!("/VTKHDF/{name}"), bytes)))?;
        let mut opened = Opened::of(&mut *file, path.to_path_buf()).map_err(io::Error::other)?;
        opened.write_step(0, entry, fields)
    })
}

/// Writes headers, mesh, and the tables of offsets of the values of each step.
fn begin(
    file: &mut File,
    layout: &Layout,
    mesh: impl IntoIterator<Item = (String, Vec<u8>)>,
) -> io::Result<()> {
    let image = layout.image();
    file.write_all(&image.head)?;
    // Unwritten parts are zero; most file systems do not store them.
    file.set_len(image.length)?;
    let steps =
        |value: &dyn Fn(u64) -> u64| (0..layout.capacity).flat_map(|i| value(i).to_le_bytes()).collect();
    let point_tables = layout
        .arrays
        .iter()
        .map(|a| (format!("/VTKHDF/Steps/PointDataOffsets/{}", a.name), steps(&|i| i * layout.points)));
    let tables = [
        ("/VTKHDF/Steps/NumberOfParts".into(), steps(&|_| 1)),
        ("/VTKHDF/Steps/FieldDataOffsets/step".into(), steps(&|i| i)),
        (
            "/VTKHDF/Steps/FieldDataSizes/step".into(),
            [1_u64.to_le_bytes(); 2].as_flattened().repeat(layout.capacity as usize),
        ),
    ];
    for (path, bytes) in mesh.into_iter().chain(point_tables).chain(tables) {
        let at = image.data.get(&path).copied().unwrap_or_else(|| unreachable!("{path} is in every file"));
        write_at(file, at, &bytes)?;
    }
    Ok(())
}

fn write_at<F: Write + Seek>(file: &mut F, at: u64, bytes: &[u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(at))?;
    file.write_all(bytes)
}

impl Opened<File> {
    fn new(file: File, path: &Path) -> Result<Self, RecordError> {
        Self::of(file, path.to_path_buf()).map_err(corrupt(path))
    }

    /// Sets the number of steps, by one write within one sector.
    fn count(&mut self, count: u64) -> Result<(), RecordError> {
        let image = Layout { count, ..self.layout.clone() }.image();
        let places = [image.data[COUNT], image.dims[TIMES]];
        let (from, to) = (places[0].min(places[1]), places[0].max(places[1]) + 8);
        write_at(&mut self.file, from, &image.head[from as usize..to as usize])
            .map_err(RecordError::io("write", &self.path))?;
        self.layout.count = count;
        Ok(())
    }

    /// Replaces the file by a copy with this capacity.
    fn copy(&mut self, capacity: u64) -> Result<(), RecordError> {
        let layout = Layout { capacity, ..self.layout.clone() };
        let path = self.path.clone();
        files::replace(&path, |file| {
            let mut parts = Vec::new();
            for name in MESH {
                parts.push((format!("/VTKHDF/{name}"), self.mesh(name).map_err(io::Error::other)?));
            }
            begin(file, &layout, parts)?;
            let mut new = Opened::of(&mut *file, path.clone()).map_err(io::Error::other)?;
            for place in 0..self.layout.count {
                for (path, per_step) in self.layout.per_step() {
                    let bytes = self.row(&path, place, per_step).map_err(io::Error::other)?;
                    new.write_row(&path, place, &bytes)?;
                }
            }
            Ok(())
        })
    }
}

impl Layout {
    /// Datasets with values for every step, with their bytes per step.
    fn per_step(&self) -> Vec<(String, u64)> {
        let arrays = self.arrays.iter().map(|a| (path_of(a), 8 * self.points * a.components as u64));
        [(TIMES.into(), 8), (STEPS.into(), 8)].into_iter().chain(arrays).collect()
    }
}

impl<F: Read + Seek> Opened<F> {
    fn of(mut file: F, path: PathBuf) -> Result<Self, String> {
        let contents = Contents::read(&mut file)?;
        let layout = Layout::found(&contents)?;
        Ok(Self { file, path, contents, layout })
    }

    fn row(&mut self, path: &str, place: u64, size: u64) -> Result<Vec<u8>, String> {
        let start = self.contents.datasets.get(path).ok_or_else(|| format!("no dataset {path}"))?.address;
        let at = place.checked_mul(size).and_then(|offset| offset.checked_add(start));
        bytes_at(&mut self.file, at.ok_or("an address out of range")?, size)
    }

    fn mesh(&mut self, name: &str) -> Result<Vec<u8>, String> {
        let dataset = self.contents.datasets.get(&format!("/VTKHDF/{name}"));
        let (address, size) =
            dataset.map(|d| (d.address, d.size)).ok_or_else(|| format!("no dataset {name}"))?;
        bytes_at(&mut self.file, address, size)
    }

    /// Checksum of the values of a step; that of the first step includes the mesh.
    fn hash(&mut self, place: u64) -> Result<Hash, String> {
        let mut hasher = blake3::Hasher::new();
        for name in MESH.iter().filter(|_| place == 0) {
            hasher.update(&self.mesh(name)?);
        }
        for (path, size) in self.layout.per_step() {
            hasher.update(&self.row(&path, place, size)?);
        }
        Ok(hasher.finalize().into())
    }

    fn all<const B: usize>(&mut self, path: &str, kind: Kind, count: u64) -> Result<Vec<[u8; B]>, String> {
        self.contents.dataset(path, kind)?;
        let bytes = self.row(path, 0, count.checked_mul(B as u64).ok_or("too many values")?)?;
        Ok(bytes.as_chunks::<B>().0.to_vec())
    }

    fn entries(&mut self) -> Result<Vec<FieldEntry>, String> {
        let count = self.layout.count;
        let times = self.all(TIMES, Kind::Real, count)?;
        let steps = self.all(STEPS, INTEGER, count)?;
        let entry =
            |(step, time)| FieldEntry { step: u64::from_le_bytes(step), time: f64::from_le_bytes(time) };
        Ok(steps.into_iter().zip(times).map(entry).collect())
    }

    fn fields(&mut self, step: u64) -> Result<FieldSet, String> {
        let layout = self.layout.clone();
        let place =
            self.entries()?.iter().position(|e| e.step == step).ok_or_else(|| format!("no step {step}"))?
                as u64;
        let n = layout.points;
        let coordinates =
            self.all::<8>("/VTKHDF/Points", Kind::Real, n.checked_mul(3).ok_or("too many points")?)?;
        let coordinates: Vec<f64> = coordinates.into_iter().map(f64::from_le_bytes).collect();
        let nodes = self.all::<8>("/VTKHDF/Connectivity", INTEGER, layout.connectivity)?;
        let nodes: Vec<usize> = nodes.into_iter().map(|b| u64::from_le_bytes(b) as usize).collect();
        if let Some(node) = nodes.iter().find(|&&node| node as u64 >= n) {
            return Err(format!("a cell refers to node {node}, but there are {n} points"));
        }
        let ends =
            self.all::<8>("/VTKHDF/Offsets", INTEGER, layout.cells.checked_add(1).ok_or("too many cells")?)?;
        let ends: Vec<usize> = ends.into_iter().map(|b| u64::from_le_bytes(b) as usize).collect();
        let types = self.all::<1>("/VTKHDF/Types", Kind::Byte, layout.cells)?;
        let bodies = self.all::<4>("/VTKHDF/CellData/body", Kind::Integer(4), layout.cells)?;
        let names = self.contents.texts(BODIES);
        let cells = ends.windows(2).zip(types).zip(bodies).map(|((ends, [kind]), body)| {
            let cell = nodes.get(ends[0]..ends[1]).ok_or("cells reach beyond the connectivity")?;
            Ok((i32::from_le_bytes(body) as usize, kind, cell))
        });
        let blocks = Block::gather(cells.collect::<Result<Vec<_>, String>>()?, &names)?;
        let mut arrays = layout.arrays.clone();
        for (array, (path, size)) in arrays.iter_mut().zip(layout.per_step().into_iter().skip(2)) {
            let bytes = self.row(&path, place, size)?;
            array.values = bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
        }
        Ok(FieldSet { points: coordinates.as_chunks::<3>().0.to_vec(), blocks, arrays })
    }
}

impl<F: Read + Write + Seek> Opened<F> {
    fn write_row(&mut self, path: &str, place: u64, bytes: &[u8]) -> io::Result<()> {
        let start = self.contents.datasets.get(path).map_or(0, |d| d.address);
        write_at(&mut self.file, start + place * bytes.len() as u64, bytes)
    }

    /// Writes the values of a step, without increasing the number of steps.
    fn write_step(&mut self, place: u64, entry: &FieldEntry, fields: &FieldSet) -> io::Result<()> {
        self.write_row(TIMES, place, &decimal(entry.time).to_le_bytes())?;
        self.write_row(STEPS, place, &entry.step.to_le_bytes())?;
        for array in &fields.arrays {
            let bytes: Vec<u8> = array.values.iter().flat_map(|v| v.to_le_bytes()).collect();
            self.write_row(&path_of(array), place, &bytes)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
