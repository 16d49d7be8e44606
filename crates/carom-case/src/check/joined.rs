//! Bodies of one Gmsh file that have common facets, and neither contact nor tie: every body has
//! nodes of its own, so that cells of one conforming mesh come apart where two bodies meet. Whether
//! they are to be one body or two that touch, the file does not say; a contact between them does.

use carom_solid::gmsh::{Joint, MshFile};

use super::Check;
use crate::{BodySpec, FileMesh, MeshSpec};

/// Mesh file of a body, its name, and the dimension in which it is read.
struct Source<'a> {
    mesh: &'a FileMesh,
    name: std::borrow::Cow<'a, str>,
    dimension: usize,
}

impl<'a> Source<'a> {
    fn of(body: &'a BodySpec, dimension: usize) -> Option<Self> {
        let MeshSpec::File(mesh) = body.mesh.source() else { return None };
        let dimension = if matches!(body.mesh, MeshSpec::File(_)) { dimension } else { 2 };
        Some(Self { mesh, name: mesh.file.file_name()?.to_string_lossy(), dimension })
    }
}

impl Check<'_> {
    pub(super) fn joined(&mut self) {
        // A contact or tie that cannot be read may be the one between them.
        let Some(dimension) = self.draft.dimension else { return };
        if self.draft.contact.iter().any(Option::is_none) || self.draft.tie.iter().any(Option::is_none) {
            return;
        }
        let bodies: Vec<(usize, &BodySpec)> =
            self.draft.body.iter().enumerate().filter_map(|(k, body)| Some((k, body.as_ref()?))).collect();
        // The file read last: those of a case are mostly one.
        let mut read: Option<(&str, MshFile)> = None;
        for (place, &(k, second)) in bodies.iter().enumerate() {
            for &(_, first) in &bodies[..place] {
                let sources = [first, second].map(|body| Source::of(body, dimension));
                let [Some(a), Some(b)] = sources else { continue };
                let together = first.place == second.place && first.position == second.position;
                if a.mesh.hash != b.mesh.hash || !together || self.in_contact(first, second) {
                    continue;
                }
                if read.as_ref().is_none_or(|(hash, _)| *hash != b.mesh.hash) {
                    read = b.mesh.again().map(|file| (b.mesh.hash.as_str(), file));
                }
                let Some((_, file)) = &read else { continue };
                let groups = [a.mesh.group(), b.mesh.group()];
                // Bodies of several groups are no groups of the file.
                let united = [&a, &b].into_iter().filter(|of| of.mesh.surface.is_empty());
                let united = united.map(|of| of.mesh).collect::<Vec<_>>();
                let united =
                    united.iter().try_fold(file.clone(), |file, of| of.with_group(file, a.dimension));
                let Ok(file) = united else { continue };
                if let Ok(Some(joint)) = file.joint(a.dimension, groups.each_ref().map(String::as_str)) {
                    self.report(k, [first, second], &b.name, a.dimension, &joint);
                }
            }
        }
    }

    fn in_contact(&self, a: &BodySpec, b: &BodySpec) -> bool {
        let contacts =
            self.draft.contact.iter().flatten().map(|contact| contact.bodies().collect::<Vec<_>>());
        let ties = self.draft.tie.iter().flatten().map(|tie| tie.bodies().to_vec());
        let has = |bodies: &[&str], body: &BodySpec| bodies.contains(&body.name.as_str());
        contacts.chain(ties).any(|bodies| has(&bodies, a) && has(&bodies, b))
    }

    fn report(&mut self, k: usize, bodies: [&BodySpec; 2], file: &str, dimension: usize, joint: &Joint) {
        let [a, b] = bodies.map(|body| body.name.as_str());
        let [low, high] = joint.extent.map(|x| format!("{:?}", &x[..dimension]));
        let at = if low == high { format!("at {low}") } else { format!("from {low} to {high}") };
        let nodes = if joint.nodes == 1 { "a node".to_owned() } else { format!("{} nodes", joint.nodes) };
        let what =
            format!("bodies `{a}` and `{b}` have {nodes} of {file} in common, {at}, and no contact or tie");
        let facets = match (joint.facets, dimension) {
            (1, 1) => "point".to_owned(),
            (count, 1) => format!("{count} points"),
            (1, 2) => "edge".to_owned(),
            (count, 2) => format!("{count} edges"),
            (1, _) => "face".to_owned(),
            (count, _) => format!("{count} faces"),
        };
        let why = format!(
            "every body has nodes of its own: without a contact or a tie the two come apart, or pass through each other, at the {facets} between them"
        );
        let group = ["point", "curve", "surface", "volume"][dimension.min(3)];
        let side = joint.sides.first().map_or("SIDE", String::as_str);
        let unnamed = match (joint.sides.is_empty(), dimension) {
            (false, _) => "",
            (true, 1) => ", where SIDE is a physical point there",
            (true, 2) => ", where SIDE is a physical curve there",
            (true, _) => ", where SIDE is a physical surface there",
        };
        let help = format!(
            "to connect them, put the cells of both into one physical {group}, which is one body, make one body of both groups with `materials`, or add a [[tie]] of these sides; to let them touch and part, add a [[contact]] with secondary = \"{a}.{side}\" and primary = \"{b}.{side}\"{unnamed}"
        );
        self.add(format!("body[{k}].mesh"), what, why, help);
    }
}
