//! The memory that is left for this process.

use carom_record::available::{after, groups};

#[test]
fn limits_of_the_system() {
    let limits = "Limit          Soft Limit  Hard Limit  Units\nMax address space   2048  unlimited  bytes\n";
    assert_eq!(after(limits, "Max address space"), Some(2048.0));
    assert_eq!(after("Max address space   unlimited  unlimited  bytes", "Max address space"), None);
    assert_eq!(after("MemTotal: 5 kB\nMemAvailable:  3 kB\n", "MemAvailable:"), Some(3.0));
}

/// Files of the kernel as a group of version 2, in a group with a smaller limit, and as groups
/// of version 1 have them.
#[test]
fn groups_and_those_around_them() {
    let folder = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("user/job/memory.max", "9000\n");
    write("user/job/memory.current", "1000\n");
    write("user/job/memory.stat", "anon 7\ninactive_anon 9\ninactive_file 300\nactive_file 20\n");
    write("user/memory.max", "5000\n");
    write("user/memory.current", "1500\n");
    write("memory.max", "max\n");
    assert_eq!(groups("0::/user/job\n", folder.path()), [9000.0 - 700.0, 5000.0 - 1500.0]);
    assert_eq!(groups("0::/\n", folder.path()), [0.0; 0]);
    // The path of a container's group does not exist inside it.
    write("memory.max", "4000\n");
    assert_eq!(groups("0::/elsewhere/x\n", folder.path()), [4000.0]);

    write("memory/batch/memory.limit_in_bytes", "800\n");
    write("memory/batch/memory.usage_in_bytes", "100\n");
    write("memory/batch/memory.stat", "inactive_file 1\ntotal_inactive_file 40\n");
    assert_eq!(groups("3:cpu,cpuacct:/batch\n4:memory:/batch\n", folder.path()), [740.0]);
}
