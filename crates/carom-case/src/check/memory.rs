//! Checks that the model fits into memory, by an estimate made before anything is allocated.
//!
//! Per node of degree-k cells in dimension D, with c nodes coupled to it (mean over a large mesh:
//! 3, 4, 5 for L2 L3 L4; 7, 12, 19 for T3 T6 T10; 9, 16 for Q4 Q9; 15, 29, 51 for Tet4 Tet10
//! Tet20; 27, 64 for Hex8 Hex27): half the matrix
//! with 8-byte values and indices, 16·D²·c/2; its factor, a fill of c·log₂n/2 by nested dissection
//! in the plane, c·n^(1/3)/2 in space and c/2 on a line, twice (numbers and scratch); a dozen state
//! vectors. Solved by iteration: the whole matrix in 4 bytes, that of the mass with its indices,
//! 4·D²·c + 16·c, and three dozen vectors.

use carom_solid::Element;

use super::Check;
use crate::machine::available_memory;
use crate::{BodySpec, MeshSpec, Problem};

/// Bytes that a body of n nodes needs, solved directly or by iteration.
fn bytes(element: Element, nodes: f64, iterates: bool) -> f64 {
    let coupled = match element {
        Element::L2 => 3.0,
        Element::L3 => 4.0,
        Element::L4 => 5.0,
        Element::T3 => 7.0,
        Element::T6 => 12.0,
        Element::T10 => 19.0,
        Element::Q4 => 9.0,
        Element::Q9 => 16.0,
        Element::Hex8 => 27.0,
        Element::Hex27 => 64.0,
        Element::Tet4 => 15.0,
        Element::Tet10 => 29.0,
        Element::Tet20 => 51.0,
    };
    let d = element.dimension() as f64;
    if iterates {
        return nodes * ((4.0 * d * d + 16.0) * coupled + 36.0 * 8.0 * d);
    }
    let levels = match element.dimension() {
        1 => 1.0,
        2 => nodes.max(2.0).log2(),
        _ => nodes.cbrt(),
    };
    nodes * (16.0 * d * d * coupled * (0.5 + levels) + 12.0 * 8.0 * d)
}

impl Check<'_> {
    pub(super) fn memory(&mut self) {
        let bodies = || self.draft.bodies.iter().enumerate().filter_map(|(i, b)| Some((i, b.as_ref()?)));
        let nodes = |body: &BodySpec| body.mesh.estimate(body.element).1;
        // A case that cannot be read has other errors.
        let Some(dimension) = self.draft.dimension else { return };
        let unknowns = bodies().map(|(_, b)| nodes(b)).sum::<f64>() * dimension as f64;
        let contacts = || self.draft.contacts.iter().flatten();
        let iterates = |time| self.linear_rule().iterates(dimension, unknowns, time, contacts());
        let iterates = self.draft.time.as_ref().is_none_or(iterates);
        let need = |body: &BodySpec| bytes(body.element, nodes(body), iterates);
        let total: f64 = bodies().map(|(_, b)| need(b)).sum();
        let available = available_memory();
        let largest = bodies().max_by(|(_, a), (_, b)| need(a).total_cmp(&need(b)));
        let Some((i, body)) = largest.filter(|_| total > available) else { return };
        let mesh = format!("body[{i}].mesh");
        // A size of zero is an error by itself.
        if self.problems.iter().any(|problem| problem.path.starts_with(&mesh)) {
            return;
        }
        let (cells, nodes) = body.mesh.estimate(body.element);
        let key = match body.mesh {
            MeshSpec::File { .. } => "file",
            MeshSpec::Interval { .. } | MeshSpec::Rectangle { .. } | MeshSpec::Box { .. } => "cells",
            MeshSpec::Extrusion { .. } => "layers",
            _ => "size",
        };
        let what = format!(
            "the mesh of `{}` is too large for the memory: {nodes:.3e} nodes in {cells:.3e} cells",
            body.name
        );
        let why =
            format!("the model needs about {}, and {} are available", gibibytes(total), gibibytes(available));
        let path = format!("{mesh}.{key}");
        let lower = if body.element.degree() > 1 { " or an element of lower degree" } else { "" };
        let help = format!("use a coarser mesh{lower}, or give the process more memory");
        self.problems.push(Problem::new(path, what, why, help).of_system());
    }
}

fn gibibytes(bytes: f64) -> String {
    let gib = bytes / (1024.0 * 1024.0 * 1024.0);
    if gib < 1e6 { format!("{gib:.1} GiB") } else { format!("{gib:.1e} GiB") }
}
