//! Subjects of metrics: the headings under which pages list them.

use super::run_table::{PRESSURE, WORK};

/// A heading, and the metrics below it.
pub struct Group {
    /// The heading.
    pub title: &'static str,
    /// Names of its metrics, without what follows a colon.
    pub names: &'static [&'static str],
}

/// All headings but that of probes.
pub const GROUPS: [Group; 7] = [
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
            "penetration_secondary",
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
