//! Claims: comparisons of two expressions in numbers of the arms' records.

use carom_record::study::{ArmRecords, Claim, Comparison, Verdict};

fn verdict(text: &str, numbers: &[(&str, &str, f64)]) -> (Option<f64>, Option<f64>, &'static str) {
    let comparison = Comparison::parse(text).unwrap();
    let mut records = ArmRecords::default();
    for (metric, arm, value) in numbers {
        records.put_metric(arm, metric, *value);
    }
    let claim = Claim { text: String::new(), compare: text.into() };
    let v = Verdict::of(&claim, Some(&comparison), &records, &[]);
    (v.left, v.right, v.word())
}

#[test]
fn arithmetic_and_verdicts() {
    let numbers = [("r", "Hu, a", 6.0), ("q", "b > c", -0.5), ("r", "b > c", 2.0)];
    let of = |text| verdict(text, &numbers);
    assert_eq!(of("r of \"Hu, a\" > 2 * r of \"b > c\""), (Some(6.0), Some(4.0), "confirmed"));
    assert_eq!(of("r of 'Hu, a' / r of 'b > c' - 1 <= 1.5"), (Some(2.0), Some(1.5), "refuted"));
    assert_eq!(of("1 - 2 - 3 < q of 'b > c'"), (Some(-4.0), Some(-0.5), "confirmed"));
    assert_eq!(of("r of 'nobody' < 1"), (None, Some(1.0), "undecided"));
}

/// By hand: 6 against twice 2 is a ratio of 3, compared with 2; against the number 4, it is
/// itself compared with 4.
#[test]
fn ratios_are_without_constant_factors() {
    let mut records = ArmRecords::default();
    [("a", 6.0), ("b", 2.0), ("c", -8.0)]
        .into_iter()
        .for_each(|(arm, value)| records.put_metric(arm, "r", value));
    let of = |text: &str| {
        let claim = Claim { text: String::new(), compare: text.into() };
        let v = Verdict::of(&claim, Comparison::parse(text).as_ref().ok(), &records, &[]);
        (v.ratio.unwrap(), v.bound.unwrap())
    };
    assert_eq!(of("r of 'a' > 2 * r of 'b'"), (3.0, (">", 2.0)));
    assert_eq!(of("2 * r of 'a' <= r of 'b'"), (3.0, ("≤", 0.5)));
    assert_eq!(of("r of 'a' < 4"), (6.0, ("<", 4.0)));
    assert_eq!(of("r of 'a' >= r of 'b'"), (3.0, ("≥", 1.0)));
    // 6 > −8 is 6 / −8 < 1.
    assert_eq!(of("r of 'a' > r of 'c'"), (-0.75, ("<", 1.0)));
}

/// By hand: of three members with the ratios 2, 1.5 and 0.5 the claim holds in two.
#[test]
fn held_in_k_of_n() {
    let members = [2.0, 3.0, 0.5].map(|left| {
        let mut records = ArmRecords::default();
        records.put_metric("a", "r", left);
        records.put_metric("b", "r", if left == 3.0 { 2.0 } else { 1.0 });
        records
    });
    let claim = Claim { text: String::new(), compare: "r of 'a' > r of 'b'".into() };
    let comparison = Comparison::parse(&claim.compare).unwrap();
    let verdict = Verdict::of(&claim, Some(&comparison), &members[0], &members);
    let confirmed = verdict.ensemble.unwrap();
    assert_eq!(
        (confirmed.count, confirmed.of, confirmed.word(), verdict.holds),
        (2, 3, "in some", Some(true))
    );
    let ratio = confirmed.ratio.unwrap();
    assert_eq!((ratio.median(), ratio.range()), (1.5, (0.5, 2.0)));
}

/// A member in which an arm has no such metric does not confirm the claim.
#[test]
fn what_cannot_be_decided_is_not_confirmed() {
    let members = [Some(2.0), Some(3.0), None].map(|left| {
        let mut records = ArmRecords::default();
        left.into_iter().for_each(|left| records.put_metric("a", "r", left));
        records
    });
    let word = |compare: &str| {
        let claim = Claim { text: String::new(), compare: compare.into() };
        let comparison = Comparison::parse(compare).unwrap();
        let verdict = Verdict::of(&claim, Some(&comparison), &members[0], &members);
        (verdict.word(), verdict.ensemble.unwrap().words())
    };
    assert_eq!(word("r of 'a' > 1"), ("in some", "2 of 3, 1 undecided".to_owned()));
    assert_eq!(word("r of 'a' > 9"), ("undecided", "0 of 3, 1 undecided".to_owned()));
}

#[test]
fn errors_say_what_is_wrong() {
    let wrong = |text: &str| Comparison::parse(text).unwrap_err();
    assert!(wrong("r of 'a'").contains("0 comparisons"));
    assert!(wrong("r of 'a' > r of b").contains("not a valid quantity"));
    assert!(wrong("r > 1").contains("names no arm"));
    assert!(wrong("r of 'a > 1").contains("not closed"));
    assert!(wrong("r of 'a' 2 > 1").contains("not a valid quantity"));
    assert!(wrong("r of 'a' > ").contains("missing"));
}
