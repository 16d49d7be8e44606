//! Groups, attributes and datasets of an HDF5 file, only for files written by `hdf5.rs`; other HDF5
//! files are an error.

use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom};

use super::hdf5::{ATTRIBUTE, Attribute, DATASPACE, DATATYPE, Kind, LAYOUT, LINK, ROOT, SIGNATURE, datatype};

/// A dataset, by its path.
#[derive(Clone, Debug)]
pub(super) struct Dataset {
    pub(super) kind: Kind,
    pub(super) dims: Vec<u64>,
    /// Address of its values.
    pub(super) address: u64,
    /// Bytes reserved for it.
    pub(super) size: u64,
}

/// Contents of a file.
#[derive(Clone, Debug, Default)]
pub(super) struct Contents {
    /// `/group/name`.
    pub(super) datasets: BTreeMap<String, Dataset>,
    /// `/group@name`.
    pub(super) attributes: BTreeMap<String, Attribute>,
    /// Groups and datasets in the order of their group.
    pub(super) order: Vec<String>,
}

/// Removes the first bytes and returns them as a little-endian number.
fn take(bytes: &mut &[u8], count: usize) -> Result<u64, String> {
    let (head, tail) = bytes.split_at_checked(count).ok_or("a header ends too early")?;
    *bytes = tail;
    Ok(head.iter().rev().fold(0, |sum, &b| sum << 8 | u64::from(b)))
}

/// Reads `count` bytes at an address of the file.
pub(super) fn bytes_at<F: Read + Seek>(file: &mut F, at: u64, count: u64) -> Result<Vec<u8>, String> {
    let words = |e: std::io::Error| e.to_string();
    let length = file.seek(SeekFrom::End(0)).map_err(words)?;
    if at.checked_add(count).is_none_or(|end| end > length) {
        return Err(format!("{count} bytes at {at} reach beyond the end of the file, {length}"));
    }
    let mut bytes = vec![0; count as usize];
    file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(&mut bytes)).map_err(words)?;
    Ok(bytes)
}

impl Contents {
    /// Reads every header.
    ///
    /// # Errors
    /// What is wrong or not supported.
    pub(super) fn read<F: Read + Seek>(file: &mut F) -> Result<Self, String> {
        let superblock = bytes_at(file, 0, 96)?;
        if !superblock.starts_with(SIGNATURE) || superblock[8] != 0 {
            return Err("it is not a file written by Carom".into());
        }
        let mut contents = Self::default();
        contents.object(file, "", take(&mut &superblock[ROOT..], 8)?, 0)?;
        Ok(contents)
    }

    fn object<F: Read + Seek>(
        &mut self,
        file: &mut F,
        path: &str,
        address: u64,
        depth: usize,
    ) -> Result<(), String> {
        let prefix = bytes_at(file, address, 16)?;
        let mut remaining = &prefix[..];
        let (version, count) = (take(&mut remaining, 2)?, take(&mut remaining, 2)?);
        let _references = take(&mut remaining, 4)?;
        if version != 1 || depth > 4 {
            return Err(format!("`{path}` is not an object written by Carom"));
        }
        let body = bytes_at(file, address.saturating_add(16), take(&mut remaining, 4)?)?;
        let mut remaining = &body[..];
        let (mut kind, mut dims, mut layout) = (None, None, None);
        for _ in 0..count {
            let (message, size) = (take(&mut remaining, 2)? as u16, take(&mut remaining, 2)? as usize);
            take(&mut remaining, 4)?;
            let (mut message_bytes, after) =
                remaining.split_at_checked(size).ok_or("a header ends too early")?;
            remaining = after;
            let bytes = &mut message_bytes;
            match message {
                DATASPACE => dims = Some(dataspace(bytes)?),
                DATATYPE => kind = Some(kind_of(bytes)?),
                LAYOUT => {
                    if take(bytes, 2)? != 0x0103 {
                        return Err(format!("`{path}` is not stored contiguously"));
                    }
                    layout = Some((take(bytes, 8)?, take(bytes, 8)?));
                }
                ATTRIBUTE => {
                    let attribute = attribute(bytes)?;
                    self.attributes.insert(format!("{path}@{}", attribute.name), attribute);
                }
                LINK => {
                    take(bytes, 3)?;
                    let length = take(bytes, 1)? as usize;
                    let (name, mut address) =
                        bytes.split_at_checked(length).ok_or("a link ends too early")?;
                    let name = format!("{path}/{}", String::from_utf8_lossy(name));
                    self.order.push(name.clone());
                    self.object(file, &name, take(&mut address, 8)?, depth + 1)?;
                }
                _ => {}
            }
        }
        if let (Some(kind), Some(dims), Some((address, size))) = (kind, dims, layout) {
            let length = file.seek(SeekFrom::End(0)).map_err(|e| e.to_string())?;
            let used = dims.iter().try_fold(kind.size() as u64, |n, &d| n.checked_mul(d));
            if used.is_none_or(|used| used > size) || address.checked_add(size).is_none_or(|end| end > length)
            {
                return Err(format!("`{path}` reaches beyond its reserved space or the end of the file"));
            }
            self.datasets.insert(path.into(), Dataset { kind, dims, address, size });
        }
        Ok(())
    }

    /// A dataset of the given kind.
    pub(super) fn dataset(&self, path: &str, kind: Kind) -> Result<&Dataset, String> {
        self.datasets
            .get(path)
            .filter(|d| d.kind == kind)
            .ok_or_else(|| format!("there is no dataset {path} of the expected type"))
    }

    /// An integer stored as an attribute.
    pub(super) fn number(&self, path: &str) -> Result<u64, String> {
        let attribute = self.attributes.get(path).ok_or_else(|| format!("no attribute {path}"))?;
        take(&mut &attribute.data[..], 8)
    }

    /// Strings stored as an attribute; one if it is a scalar.
    pub(super) fn texts(&self, path: &str) -> Vec<String> {
        let Some(attribute) = self.attributes.get(path) else { return Vec::new() };
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned();
        attribute.data.chunks_exact(attribute.kind.size().max(1)).map(text).collect()
    }
}

fn dataspace(bytes: &mut &[u8]) -> Result<Vec<u64>, String> {
    let (version, rank) = (take(bytes, 1)?, take(bytes, 1)?);
    take(bytes, 6)?;
    if version != 1 || rank > 2 {
        return Err("a dataspace is not supported".into());
    }
    (0..rank).map(|_| take(bytes, 8)).collect()
}

fn kind_of(bytes: &[u8]) -> Result<Kind, String> {
    let size = take(&mut bytes.get(4..).unwrap_or_default(), 4)? as usize;
    let kinds = [Kind::Integer(4), Kind::Integer(8), Kind::Byte, Kind::Real, Kind::Text(size)];
    let same = |kind: &Kind| size > 0 && bytes.starts_with(&datatype(*kind));
    kinds.into_iter().find(same).ok_or_else(|| "a datatype is not supported".into())
}

fn attribute(bytes: &mut &[u8]) -> Result<Attribute, String> {
    if take(bytes, 2)? != 1 {
        return Err("an attribute is not supported".into());
    }
    let lengths = [take(bytes, 2)?, take(bytes, 2)?, take(bytes, 2)?];
    let [name, kind, space] = lengths.map(|length| {
        let part = bytes.split_at_checked((length as usize).next_multiple_of(8));
        part.map(|(part, remaining)| {
            *bytes = remaining;
            part
        })
    });
    let (Some(name), Some(kind), Some(mut space)) = (name, kind, space) else {
        return Err("an attribute ends too early".into());
    };
    let (kind, dims) = (kind_of(kind)?, dataspace(&mut space)?);
    let count = dims.iter().try_fold(kind.size(), |n, &d| n.checked_mul(d as usize));
    let data = count.and_then(|n| bytes.get(..n)).ok_or("an attribute ends too early")?.to_vec();
    let name = String::from_utf8_lossy(name).trim_end_matches('\0').to_owned();
    Ok(Attribute { name, kind, dims, data })
}
