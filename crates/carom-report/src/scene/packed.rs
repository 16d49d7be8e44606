//! The numbers of a scene as text: integers over their ranges, compressed (RFC 1950), in base 64.
//!
//! The numbers of a frame are stored as their differences from what the two frames before let
//! expect, and these as differences from node to node: mostly small numbers, which compress well.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use super::mesh::Mesh;
use crate::space::Place;

/// Steps of a displacement on either side of zero, of a reference position, and of other numbers
/// within their range.
const MOVED: f64 = 32_767.0;
const PLACED: f64 = 65_535.0;
const LEVELS: f64 = 1000.0;

/// The numbers of one field file: for each channel, one of each kept node.
pub(super) struct Frame {
    pub(super) values: Vec<Vec<f32>>,
}

impl Frame {
    pub(super) fn nodes(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }
}

/// Range of the numbers of a channel in all frames.
fn range(frames: &[Frame], channel: usize) -> [f64; 2] {
    let all = frames.iter().flat_map(|frame| &frame.values[channel]).copied().filter(|x| x.is_finite());
    let [low, high] =
        all.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    if low <= high { [f64::from(low), f64::from(high)] } else { [0.0, 0.0] }
}

/// A mesh with its numbers, for the script.
pub(super) struct Packed {
    /// Ranges and counts.
    pub(super) data: Value,
    /// Everything else.
    pub(super) text: String,
}

/// Packs a mesh, the reference positions of its nodes, and the chosen frames; the first channels
/// are the displacement in so many dimensions.
pub(super) fn packed(
    mesh: &Mesh,
    places: &[Place],
    frames: &[Frame],
    chosen: &[usize],
    dimension: usize,
) -> Packed {
    let mut bytes = Vec::new();
    let nodes = mesh.facets.iter().flat_map(|facet| &facet.nodes).chain(mesh.cells.values().flatten());
    nodes.for_each(|&node| bytes.extend((node as u32).to_le_bytes()));
    put(&mut bytes, mesh.flags.iter().copied());
    let ends = |d: usize| {
        places
            .iter()
            .map(|place| place[d])
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    let box_of = [0, 1, 2].map(ends);
    for (d, [low, high]) in box_of.into_iter().enumerate() {
        let scale = if high > low { PLACED / (high - low) } else { 0.0 };
        put(&mut bytes, places.iter().map(|place| ((place[d] - low) * scale).round() as u16));
    }
    let count = frames.first().map_or(0, |frame| frame.values.len());
    let mut ranges: Vec<[f64; 2]> = (0..count).map(|channel| range(frames, channel)).collect();
    let largest = ranges[..dimension].iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    ranges[..dimension].fill([-largest, largest]);
    let integer = |x: f32, channel: usize| {
        let [low, high] = ranges[channel];
        let share = (f64::from(x) - low) / (high - low);
        match (x.is_finite(), high > low) {
            (true, true) if channel < dimension => ((2.0 * share - 1.0) * MOVED).round() as i16,
            (true, true) => (share * LEVELS).round() as i16,
            (true, false) => 0,
            (false, _) => -1,
        }
    };
    let mut before = vec![[vec![0i16; places.len()], vec![0i16; places.len()]]; count];
    for (k, frame) in chosen.iter().map(|&k| &frames[k]).enumerate() {
        for (channel, values) in frame.values.iter().enumerate() {
            let now: Vec<i16> = values.iter().map(|x| integer(*x, channel)).collect();
            let [last, older] = &mut before[channel];
            let mut left = 0i16;
            let differs = (0..now.len()).map(|i| {
                // From the third frame on, displacements are extrapolated linearly.
                let is_moved = channel < dimension && k > 1;
                let expected =
                    if is_moved { last[i].wrapping_mul(2).wrapping_sub(older[i]) } else { last[i] };
                let error = now[i].wrapping_sub(expected);
                let step = error.wrapping_sub(left);
                left = error;
                // Small numbers of either sign become small numbers.
                ((step << 1) ^ (step >> 15)) as u16
            });
            put(&mut bytes, differs);
            *older = std::mem::replace(last, now);
        }
    }
    let degrees = [1, 2, 3].map(|degree| mesh.facets.iter().filter(|facet| facet.degree == degree).count());
    let cells: Vec<Value> =
        mesh.cells.iter().map(|((is_cube, degree), list)| json!([is_cube, degree, list.len()])).collect();
    let data = json!({
        "nodes": places.len(), "facets": degrees, "cells": cells, "places": box_of, "ranges": ranges,
        "moved": MOVED, "placed": PLACED, "levels": LEVELS, "dimension": dimension,
    });
    Packed { data, text: STANDARD.encode(miniz_oxide::deflate::compress_to_vec_zlib(&bytes, 6)) }
}

/// Adds the low bytes of numbers, then their high bytes.
fn put(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = u16>) {
    let numbers: Vec<u16> = numbers.collect();
    bytes.extend(numbers.iter().map(|n| n.to_le_bytes()[0]));
    bytes.extend(numbers.iter().map(|n| n.to_le_bytes()[1]));
}
