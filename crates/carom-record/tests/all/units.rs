//! Unit labels, and factors between two of them.

use carom_record::units::{Labels, factor, metres_per_second, stress};

/// NIST SP 811, appendix B.8: 1 lbf = 4.448 222 N, 1 psi = 6.894 757 kPa, 1 ft lbf = 1.355 818
/// J, 1 pdl (lb ft/s²) = 0.138 255 0 N; and 1 N/mm² = 1 MPa, 1 km/h = 0.277 777 8 m/s.
#[test]
fn published_factors() {
    for (from, to, published) in [
        ("lbf", "N", 4.448_222),
        ("lbf/in^2", "kPa", 6.894_757),
        ("ft lbf", "J", 1.355_818),
        ("lb ft/s^2", "N", 0.138_255_0),
        ("N/mm^2", "Pa", 1e6),
        ("km/h", "m/s", 0.277_777_8),
        ("1/ms", "1/s", 1e3),
        ("slug", "lb", 32.174_05),
    ] {
        let found = factor(from, to).unwrap();
        assert!((found / published - 1.0).abs() < 5e-7, "{from}: {found}");
    }
}

/// Labels that records have; kilograms are not metres.
#[test]
fn every_label_of_a_system_is_known() {
    let all = |l: &Labels| {
        [&l.time, &l.length, &l.velocity, &l.acceleration, &l.force, &l.moment, &l.momentum]
            .into_iter()
            .chain([&l.angular_momentum, &l.energy, &l.stress, &l.none])
            .cloned()
            .collect::<Vec<_>>()
    };
    let si = all(&Labels::of("m", "s", "kg"));
    for system in
        [["mm", "ms", "g"], ["in", "s", "lb"], ["mm", "s", "t"], ["cm", "s", "g"], ["µm", "µs", "µg"]]
    {
        let own = all(&Labels::of(system[0], system[1], system[2]));
        assert!(own.iter().zip(&si).all(|(from, to)| factor(from, to).is_some()), "{own:?}");
    }
    assert_eq!((factor("kg", "m"), factor("slinch", "kg"), factor("a", "a")), (None, None, Some(1.0)));
    assert_eq!((factor("m/s/s", "m/s^2"), factor("m^x", "m")), (None, None));
}

/// The Brochure of the SI, 9th edition, tables 4 and 7: 1 N = 1 kg m/s², 1 Pa = 1 kg/(m s²),
/// 1 J = 1 kg m²/s².
#[test]
fn derived_units_have_their_names() {
    let of = |l: &str, t: &str, m: &str| {
        let labels = Labels::of(l, t, m);
        [labels.force, labels.stress, labels.energy, labels.momentum]
    };
    assert_eq!(of("m", "s", "kg"), ["N", "Pa", "J", "N s"]);
    // 1e-3 kg · 1e-3 m/(1e-3 s)² = 1 N; 1 N/(1e-3 m)² = 1e6 Pa; 1 N · 1e-3 m = 1e-3 J.
    assert_eq!(of("mm", "ms", "g"), ["N", "MPa", "mJ", "N ms"]);
    assert_eq!(of("mm", "s", "t"), ["N", "MPa", "mJ", "N s"]);
    assert_eq!(of("mm", "ms", "kg"), ["kN", "GPa", "J", "kN ms"]);
    // 1e-5 N has no prefix (it is the dyne); the others are composed too where they have none.
    assert_eq!(of("cm", "s", "g"), ["g cm/s^2", "g/(cm s^2)", "g cm^2/s^2", "g cm/s"]);
    assert_eq!(of("in", "s", "lb")[1], "lb/(in s^2)");
}

#[test]
fn velocities_are_told_where_both_labels_are_known() {
    // 1 mm/ms = 1 m/s; 1 mm/s = 0.001 m/s; 1 km/s = 1000 m/s.
    let of = |labels: [&str; 2]| metres_per_second(labels[0], labels[1]);
    assert_eq!([["mm", "ms"], ["mm", "s"], ["km", "s"]].map(of), [Some(1.0), Some(1e-3), Some(1e3)]);
    assert_eq!([["in", "s"], ["cubit", "s"], ["", ""]].map(of), [Some(0.0254), None, None]);
}

/// One run has one unit of stress, wherever the label comes from. Where only the force has a
/// name the mass is not known: stresses of 1e15 Pa and more.
#[test]
fn stress_belongs_to_force_and_length() {
    for l in ["km", "m", "dm", "cm", "mm", "µm", "um", "nm", "in"] {
        for t in ["s", "ms", "µs", "us", "ns", "min"] {
            for m in ["t", "Mg", "kg", "g", "mg", "µg", "lb"] {
                let labels = Labels::of(l, t, m);
                let found = stress(&labels.force, l, t);
                assert!(found == labels.stress || found.ends_with(&format!("N/{l}^2")), "{labels:?}");
            }
        }
    }
    assert_eq!(stress("mN", "mm", "s"), "kPa");
    assert_eq!((stress("", "m", "s"), stress("lbf", "in", "s")), (String::new(), "lbf/in^2".to_owned()));
}
