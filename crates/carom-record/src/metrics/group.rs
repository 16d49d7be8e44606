//! Subjects of metrics: the headings under which pages list them.

use super::run_table::{PRESSURE, WORK};

/// A heading, and the metrics below it.
struct Group {
    title: &'static str,
    names: &'static [&'static str],
}

const GROUPS: [Group; 7] = [
    Group {
        title: "Contact",
        names: &[
            "contact_start",
            "contact_end",
            "contact_duration",
            "contact_episodes",
            "turning_time",
            "chatter",
            "penetration",
            "penetration_mean",
        ],
    },
    Group {
        title: "Impulse and rebound",
        names: &["impulse_x", "impulse_y", "impulse_z", "restitution", "apex", "apex_time"],
    },
    Group { title: "Peak of the contact force", names: &["peak_force", "peak_mean_force"] },
    Group { title: "Roughness of the contact force", names: &["force_roughness", "force_high_frequency"] },
    Group {
        title: "Energy",
        names: &[
            "energy_lost",
            "energy_lost_impact",
            "energy_created",
            "energy_drift",
            "energy_error",
            "dissipated_integrator",
            "plastic_lost",
            "permanent_set",
            "dissipated_contact",
        ],
    },
    Group { title: "Friction", names: &["friction_lost", "slip_distance", "stick_share"] },
    Group { title: "Measured data", names: &["overlay_rms", "overlay_peak", "overlay_shift"] },
];

/// The headings of [`group`] in the order of pages.
pub const TITLES: [&str; 10] = [
    GROUPS[0].title,
    GROUPS[1].title,
    GROUPS[2].title,
    GROUPS[3].title,
    GROUPS[4].title,
    GROUPS[5].title,
    GROUPS[6].title,
    "Contact pressure at rest",
    "Probes",
    "Computational work",
];

/// The heading of a metric.
pub fn group(name: &str) -> &'static str {
    let base = name.split_once(':').map_or(name, |(base, _)| base);
    if let Some(group) = GROUPS.iter().find(|group| group.names.contains(&base)) {
        return group.title;
    }
    if PRESSURE.iter().any(|definition| definition.name == name) {
        return TITLES[7];
    }
    if WORK.iter().any(|definition| definition.name == name) { TITLES[9] } else { TITLES[8] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::OVERLAY;
    use crate::metrics::run_table::REBOUND;
    use crate::metrics::table::HISTORY;

    /// Every metric of a history has a heading of its own kind; what has none is of a probe.
    #[test]
    fn every_metric_has_a_heading() {
        for definition in &HISTORY {
            assert_ne!(group(definition.name), "Probes", "{}", definition.name);
        }
        assert_eq!(group("energy_lost:3"), "Energy");
        assert_eq!(group("A.sigma_yy:peak_mean"), "Probes");
        assert_eq!(group("cpu_time"), "Computational work");
        let names = GROUPS.iter().flat_map(|group| group.names);
        let known = |name: &&&str| HISTORY.iter().chain(&REBOUND).chain(&OVERLAY).any(|d| d.name == **name);
        assert!(names.clone().all(|name| known(&name)));
        assert_eq!(names.count(), HISTORY.len() + REBOUND.len() + OVERLAY.len());
    }
}
