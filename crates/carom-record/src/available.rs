//! The memory that is left for this process.

use std::path::Path;

/// Bytes of memory that this process may still use: what is free on the machine, what is left of
/// its limits of address space and data (`ulimit -v`, `-d`), and of the control groups that it
/// belongs to. None where the system reports nothing of this (it is read from `/proc`).
pub fn available_memory() -> Option<f64> {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let status = read("/proc/self/status");
    let limits = read("/proc/self/limits");
    let kibibytes = |text: &str, name: &str| Some(1024.0 * after(text, name)?);
    let left =
        |limit: &str, used: &str| Some(after(&limits, limit)? - kibibytes(&status, used).unwrap_or_default());
    [
        kibibytes(&read("/proc/meminfo"), "MemAvailable:"),
        left("Max address space", "VmSize:"),
        left("Max data size", "VmData:"),
    ]
    .into_iter()
    .flatten()
    .chain(groups(&read("/proc/self/cgroup"), Path::new("/sys/fs/cgroup")))
    .reduce(f64::min)
    .map(|bytes| bytes.max(0.0))
}

/// Memory left to every limited control group in `/proc/self/cgroup`, and to those that contain
/// it. In a container the mounted tree begins at the group, and its path there may not exist.
pub fn groups(own: &str, mounted: &Path) -> Vec<f64> {
    let mut left = Vec::new();
    for line in own.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
        let names = match controllers {
            "" => ["memory.max", "memory.current", "inactive_file "],
            list if list.split(',').any(|name| name == "memory") => {
                ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "]
            }
            _ => continue,
        };
        let root = if controllers.is_empty() { mounted.to_owned() } else { mounted.join("memory") };
        let path = path.trim_start_matches('/');
        let folders = Path::new(path).ancestors().map(|folder| root.join(folder));
        left.extend(folders.filter_map(|folder| left_of_group(&folder, names)));
    }
    left
}

/// The limit of a group minus what cannot be reclaimed: its files that were not read lately make
/// room for a process.
fn left_of_group(folder: &Path, [limit, used, cached]: [&str; 3]) -> Option<f64> {
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    let number = |name: &str| read(name)?.trim().parse::<f64>().ok();
    let cached = after(&read("memory.stat").unwrap_or_default(), cached).unwrap_or_default();
    Some(number(limit)? - (number(used).unwrap_or_default() - cached).max(0.0))
}

/// The number after a name at the start of a line; none for a word such as `unlimited`.
pub fn after(text: &str, name: &str) -> Option<f64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}
