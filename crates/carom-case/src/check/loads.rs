//! Checks of loads, supports and initial states against the rest of the case: their sides and
//! bodies, the time that tables cover, what a static run may have.

use super::super::tree::Node;
use super::Check;

impl Check<'_> {
    pub(super) fn loads(&mut self) {
        let tables = self.tables("load");
        for (i, table) in tables.iter().enumerate() {
            let Some(table) = table.table() else { continue };
            let on = table.get("on").and_then(Node::list).unwrap_or(&[]);
            for (j, side) in on.iter().enumerate().filter_map(|(j, n)| Some((j, n.text()?))) {
                self.side(side, format!("load[{i}].on[{j}]"));
            }
            if let Some(body) = table.get("body").and_then(Node::text) {
                self.reference("body", body, format!("load[{i}].body"));
                if let Some(material) = table.get("material").and_then(Node::text) {
                    self.material_of(body, material, format!("load[{i}].material"));
                }
            }
        }
        let draft = self.draft;
        let Some(end) = draft.time.as_ref().map(|t| t.end) else { return };
        for (i, load) in draft.load.iter().enumerate() {
            let Some(table) = load.as_ref().and_then(|l| l.table.as_ref()) else { continue };
            let first = table.times[0];
            let last = table.times[table.times.len() - 1];
            // The times n·Δt of the grid are rounded.
            if first > 0.0 || last < end * (1.0 - 1e-12) {
                let what = format!("the table \"{}\" does not cover the run", table.file);
                let lines = format!("its first line is t = {first}, its last t = {last}");
                let why = format!("{}: {lines}; the run goes from 0 to {end}", table.file);
                self.add(format!("load[{i}].table"), what, why, "extend the table, or end the run earlier");
            }
        }
    }

    pub(super) fn motions(&mut self) {
        for (i, table) in self.tables("support").iter().enumerate() {
            let Some(table) = table.table() else { continue };
            let moved = table.get("move").and_then(Node::table);
            let fixed: Vec<_> =
                table.get("fix").and_then(Node::list).unwrap_or(&[]).iter().filter_map(Node::text).collect();
            if table.get("fix").is_none()
                && moved.is_none_or(|m| m.0.is_empty())
                && table.get("move").is_none_or(|m| m.table().is_some())
            {
                let what = "the support has neither `fix` nor `move`";
                let why = "a support needs directions in `fix`, in `move`, or in both";
                self.problems.push(
                    super::Problem::new(format!("support[{i}]"), what, why, "add `fix = [\"x\", \"y\"]`")
                        .at_key(),
                );
            }
            for entry in moved.map_or(&[][..], |m| &m.0) {
                let path = format!("support[{i}].move.{}", entry.key);
                if fixed.contains(&entry.key.as_str()) {
                    let what = format!("the direction {} is both fixed and moved", entry.key);
                    self.add(
                        path,
                        what,
                        "a direction is either fixed or has a prescribed displacement",
                        "remove it from `fix`",
                    );
                } else if let Some(d) = self.draft.dimension
                    && ["y", "z"].iter().position(|axis| *axis == entry.key).is_some_and(|axis| axis + 2 > d)
                {
                    let what = format!("there is no direction {}", entry.key);
                    self.add(path, what, format!("the case has dimension = {d}"), "use move = { x = … }");
                }
            }
        }
    }

    /// Reports loads, supports, contacts and initial states beside a manufactured solution, which
    /// excludes them.
    pub(super) fn manufactured(&mut self) {
        let root = self.document.root();
        if root.get("manufactured").is_none() {
            return;
        }
        let why =
            "[manufactured] prescribes the motion; load, boundary motion and initial state follow from it";
        for (key, path) in [
            ("support", "support[0]"),
            ("load", "load[0]"),
            ("contact", "contact[0]"),
            ("initial", "initial"),
        ] {
            if root.get(key).is_some() {
                self.add(path, format!("`{key}` cannot be used with [manufactured]"), why, "leave it out");
            }
        }
        for (i, body) in self.draft.body.iter().enumerate() {
            let Some(body) = body else { continue };
            if body.material_names().len() > 1 {
                let what = "several materials cannot be used with [manufactured]";
                let why = "the tractions of a smooth motion jump where materials meet, and its load lacks the forces there";
                self.add(format!("body[{i}].materials"), what, why, "give all groups one material");
            }
            let given = [
                ("gravity", body.gravity.iter().any(|g| !g.is_zero())),
                ("velocity", body.starts_moving()),
                ("position", body.position.is_some()),
            ];
            for (key, _) in given.into_iter().filter(|(_, given)| *given) {
                let what = format!("`{key}` cannot be used with [manufactured]");
                self.add(format!("body[{i}].{key}"), what, why, "leave it out");
            }
        }
    }

    /// Reports initial velocities without inertia, and initial velocities or positions where
    /// [initial] takes them from another run.
    pub(super) fn starts(&mut self) {
        let initial = self.document.root().get("initial").is_some();
        let why = match (self.is_static(), initial) {
            (true, _) => "the scheme \"static\" has no velocities",
            (false, true) => "[initial] sets the velocities",
            (false, false) => return,
        };
        for (i, body) in self.draft.body.iter().enumerate() {
            let Some(body) = body else { continue };
            if body.starts_moving() {
                let what = "the body has an initial velocity";
                self.add(format!("body[{i}].velocity"), what, why, "leave it out");
            }
            if initial && body.position.is_some() {
                let what = "the body has an initial position";
                let why = "[initial] sets the positions";
                self.add(format!("body[{i}].position"), what, why, "leave it out");
            }
        }
    }
}
