//! What this machine has left for a case.

/// Assumed where the system does not report its memory.
const ASSUMED: f64 = 8.0 * 1024.0 * 1024.0 * 1024.0;

/// Memory in bytes that this process may still use: what is free on the machine, and what is left
/// of the limits of its address space (`ulimit -v`) and of its control group.
pub(crate) fn available_memory() -> f64 {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let kibibytes = |text: &str, name: &str| Some(1024.0 * after(text, name)?);
    let free = kibibytes(&read("/proc/meminfo"), "MemAvailable:");
    let limit = after(&read("/proc/self/limits"), "Max address space");
    let used = kibibytes(&read("/proc/self/status"), "VmSize:").unwrap_or(0.0);
    let number = |path: &str| read(path).trim().parse::<f64>().ok();
    let group = number("/sys/fs/cgroup/memory.max").map(|limit| {
        limit - in_use(number("/sys/fs/cgroup/memory.current"), &read("/sys/fs/cgroup/memory.stat"))
    });
    [free, limit.map(|limit| limit - used), group]
        .into_iter()
        .flatten()
        .reduce(f64::min)
        .map_or(ASSUMED, |bytes| bytes.max(0.0))
}

/// Bytes of a control group that cannot be reclaimed: its files that were not read lately make room
/// for a process.
fn in_use(current: Option<f64>, stat: &str) -> f64 {
    (current.unwrap_or(0.0) - after(stat, "inactive_file ").unwrap_or(0.0)).max(0.0)
}

/// The number after a name at the start of a line; none for a word such as `unlimited`.
fn after(text: &str, name: &str) -> Option<f64> {
    text.lines().find_map(|line| line.strip_prefix(name))?.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_the_system() {
        let limits =
            "Limit          Soft Limit  Hard Limit  Units\nMax address space   2048  unlimited  bytes\n";
        assert_eq!(after(limits, "Max address space"), Some(2048.0));
        assert_eq!(after("Max address space   unlimited  unlimited  bytes", "Max address space"), None);
        let stat = "anon 7\ninactive_anon 9\ninactive_file 300\nactive_file 20\ntotal_inactive_file 1\n";
        assert_eq!([Some(1000.0), Some(200.0), None].map(|current| in_use(current, stat)), [700.0, 0.0, 0.0]);
        assert_eq!(in_use(Some(1000.0), ""), 1000.0);
        assert_eq!(after("MemTotal: 5 kB\nMemAvailable:  3 kB\n", "MemAvailable:"), Some(3.0));
    }
}
