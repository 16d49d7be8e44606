//! Writes the small part of HDF5 that a VTKHDF file needs: groups, attributes, contiguous datasets.
//!
//! Superblock of version 0 and object headers of version 1 (without checksums, so that a count can
//! be changed in place), links as messages of their group, one contiguous extent per dataset: "HDF5
//! File Format Specification Version 3.0", The HDF Group, sections II.A, IV.A. More bytes may be
//! reserved for a dataset than its dimensions use.

use std::collections::BTreeMap;

pub(super) const SIGNATURE: &[u8; 8] = b"\x89HDF\r\n\x1a\n";
/// Offset in the superblock of the address of the root group.
pub(super) const ROOT: usize = 64;
const SUPERBLOCK: usize = 96;
const NOWHERE: u64 = u64::MAX;

/// Types of the messages of an object header.
pub(super) const DATASPACE: u16 = 1;
const LINK_INFO: u16 = 2;
pub(super) const DATATYPE: u16 = 3;
const FILL_VALUE: u16 = 5;
pub(super) const LINK: u16 = 6;
pub(super) const LAYOUT: u16 = 8;
const GROUP_INFO: u16 = 10;
pub(super) const ATTRIBUTE: u16 = 12;

/// Type of a value, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Signed integer of this many bytes.
    Integer(usize),
    /// `u8`.
    Byte,
    /// `f64`.
    Real,
    /// UTF-8 string of this many bytes, padded with zeros.
    Text(usize),
}

impl Kind {
    /// Bytes of a value.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Integer(n) | Self::Text(n) => n,
            Self::Byte => 1,
            Self::Real => 8,
        }
    }
}

/// A small array stored in the header of its object.
#[derive(Clone, Debug)]
pub(super) struct Attribute {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Empty for a scalar.
    pub(super) dims: Vec<u64>,
    pub(super) data: Vec<u8>,
}

/// An object to be written.
#[derive(Clone, Debug)]
pub(super) enum Node {
    Group {
        attributes: Vec<Attribute>,
        children: Vec<(String, Node)>,
    },
    /// `rows`: the first dimension that space is reserved for, at least `dims[0]`.
    Dataset {
        kind: Kind,
        dims: Vec<u64>,
        rows: u64,
        attributes: Vec<Attribute>,
    },
}

/// A file without the values of its datasets.
#[derive(Debug)]
pub(super) struct Image {
    /// All headers, from the first byte of the file.
    pub(super) head: Vec<u8>,
    /// Length of the file in bytes.
    pub(super) length: u64,
    /// Addresses of the values of datasets (`/group/name`) and attributes (`/group@name`).
    pub(super) data: BTreeMap<String, u64>,
    /// Addresses of the first dimensions of datasets.
    pub(super) dims: BTreeMap<String, u64>,
}

impl Image {
    /// The file of a root group, with its headers moved by `shift` bytes, a multiple of 8.
    pub(super) fn new(root: &Node, shift: usize) -> Self {
        // First pass: the length of the headers. Second pass: the addresses after them.
        let data_start = Self::laid_out(root, shift, 0).head.len() as u64;
        Self::laid_out(root, shift, data_start)
    }

    fn laid_out(root: &Node, shift: usize, data_start: u64) -> Self {
        let head = vec![0; SUPERBLOCK + shift];
        let mut image = Self { head, length: data_start, data: BTreeMap::new(), dims: BTreeMap::new() };
        let address = image.object("", root);
        let mut superblock = SIGNATURE.to_vec();
        // Versions; 8-byte addresses and lengths; sizes of trees that this file does not have.
        superblock.extend([0, 0, 0, 0, 0, 8, 8, 0, 4, 0, 16, 0, 0, 0, 0, 0]);
        for word in [0, NOWHERE, image.length, NOWHERE, 0, address] {
            superblock.extend(word.to_le_bytes());
        }
        image.head[..superblock.len()].copy_from_slice(&superblock);
        image
    }

    /// Appends the header of an object after those of its children; returns its address.
    fn object(&mut self, path: &str, node: &Node) -> u64 {
        let mut messages = Messages::default();
        let (Node::Group { attributes, .. } | Node::Dataset { attributes, .. }) = node;
        let values: Vec<usize> = attributes.iter().map(|a| messages.attribute(a)).collect();
        let mut dims_at = None;
        match node {
            Node::Group { children, .. } => {
                let mut info = vec![0, 0];
                info.extend([NOWHERE.to_le_bytes(); 2].as_flattened());
                messages.add(LINK_INFO, &info);
                messages.add(GROUP_INFO, &[0, 0]);
                for (name, child) in children {
                    let address = self.object(&format!("{path}/{name}"), child);
                    // Version 1, a hard link, its name in UTF-8 with a length of one byte.
                    let mut link = vec![1, 1 << 4, 1, name.len() as u8];
                    link.extend(name.as_bytes());
                    link.extend(address.to_le_bytes());
                    messages.add(LINK, &link);
                }
            }
            Node::Dataset { kind, dims, rows, .. } => {
                dims_at = Some(messages.add(DATASPACE, &dataspace(dims)) + 8);
                messages.add(DATATYPE, &datatype(*kind));
                // Version 2; space allocated late, filled if set, and nothing set.
                messages.add(FILL_VALUE, &[2, 2, 2, 0]);
                let size = rows * dims[1..].iter().product::<u64>() * kind.size() as u64;
                let mut layout = vec![3, 1];
                layout.extend(self.length.to_le_bytes());
                layout.extend(size.to_le_bytes());
                messages.add(LAYOUT, &layout);
                self.data.insert(path.into(), self.length);
                self.length += size.next_multiple_of(8);
            }
        }
        let address = self.head.len() as u64;
        let body = address + 16;
        self.dims.extend(dims_at.map(|at| (path.to_owned(), body + at as u64)));
        for (attribute, at) in attributes.iter().zip(values) {
            self.data.insert(format!("{path}@{}", attribute.name), body + at as u64);
        }
        // Version 1, messages, references, bytes, and padding to 16.
        self.head.extend([1, 0]);
        self.head.extend(messages.count.to_le_bytes());
        self.head.extend(1_u32.to_le_bytes());
        self.head.extend((messages.bytes.len() as u64).to_le_bytes());
        self.head.append(&mut messages.bytes);
        address
    }
}

/// Body of an object header under construction.
#[derive(Default)]
struct Messages {
    count: u16,
    bytes: Vec<u8>,
}

impl Messages {
    /// Appends a message; returns the offset of its contents.
    fn add(&mut self, kind: u16, contents: &[u8]) -> usize {
        self.count += 1;
        self.bytes.extend(kind.to_le_bytes());
        self.bytes.extend((contents.len().next_multiple_of(8) as u16).to_le_bytes());
        self.bytes.extend([0; 4]);
        let at = self.bytes.len();
        self.bytes.extend(contents);
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        at
    }

    /// Appends an attribute; returns the offset of its values.
    fn attribute(&mut self, attribute: &Attribute) -> usize {
        let name = [attribute.name.as_bytes(), &[0]].concat();
        let (kind, space) = (datatype(attribute.kind), dataspace(&attribute.dims));
        let mut contents = vec![1, 0];
        for part in [&name, &kind, &space] {
            contents.extend((part.len() as u16).to_le_bytes());
        }
        for part in [&name, &kind, &space] {
            contents.extend(part);
            contents.resize(contents.len().next_multiple_of(8), 0);
        }
        let values = contents.len();
        contents.extend(&attribute.data);
        self.add(ATTRIBUTE, &contents) + values
    }
}

fn dataspace(dims: &[u64]) -> Vec<u8> {
    let mut bytes = vec![1, dims.len() as u8, 0, 0, 0, 0, 0, 0];
    dims.iter().for_each(|d| bytes.extend(d.to_le_bytes()));
    bytes
}

/// Class and version, three bytes of flags, size, and for numbers the positions of their bits.
pub(super) fn datatype(kind: Kind) -> Vec<u8> {
    let (class_and_flags, properties): ([u8; 4], Vec<u8>) = match kind {
        Kind::Integer(bytes) => ([0x10, 0x08, 0, 0], vec![0, 0, bytes as u8 * 8, 0]),
        Kind::Byte => ([0x10, 0, 0, 0], vec![0, 0, 8, 0]),
        // Sign at 63, eleven bits of exponent at 52 with bias 1023, 52 bits of mantissa at 0,
        // leading one implied.
        Kind::Real => ([0x11, 0x20, 63, 0], vec![0, 0, 64, 0, 52, 11, 0, 52, 0xff, 0x03, 0, 0]),
        Kind::Text(_) => ([0x13, 0x11, 0, 0], Vec::new()),
    };
    [&class_and_flags[..], &(kind.size() as u32).to_le_bytes(), &properties].concat()
}
