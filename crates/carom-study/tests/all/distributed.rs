//! A study in separate processes: in any order, interrupted, started twice.

use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};

use carom_record::Status;
use carom_study::{Plan, StudyError, arm, collect, plan, start};

use crate::common;
use crate::study::CASE;

const STUDY: &str = "case = \"bar.toml\"\n[grid]\n\"time.step\" = [0.01, 0.005, 0.002]\n";

#[test]
fn runs_in_any_order_give_the_table_of_one_process() {
    let (folder, path) = common::folder(&[("bar.toml", CASE)], STUDY);
    let (one, many) = (folder.path().join("one"), folder.path().join("many"));
    let read = Plan::read(&path).unwrap();
    let go = AtomicBool::new(false);
    start(&read, &one, 1, &mut |_| (), &go).unwrap();
    plan(&read, &many).unwrap();
    assert!(matches!(plan(&read, &many), Err(StudyError::Exists { .. })));
    assert!(matches!(arm(&many, 0, &mut |_| (), &go), Err(StudyError::NoRun { .. })));
    assert!(matches!(arm(&many, 4, &mut |_| (), &go), Err(StudyError::NoRun { count: 3, .. })));

    // Interrupted after 20 steps, and continued.
    let stop = AtomicBool::new(false);
    let ended = arm(&many, 3, &mut |p| stop.store(p.step >= 20, Ordering::Relaxed), &stop).unwrap();
    assert_eq!(ended.status, Status::Stopped);
    let half = collect(&many, &go).unwrap();
    assert!(half.interrupted);
    assert_eq!(half.study.rows.iter().filter(|row| row.status.is_none()).count(), 2);
    for number in [3, 1, 2, 2] {
        assert_eq!(arm(&many, number, &mut |_| (), &go).unwrap().status, Status::Finished);
    }
    assert!(!collect(&many, &go).unwrap().interrupted);
    let [of_many, of_one] = [&many, &one].map(|place| fs::read(place.join("study.csv")).unwrap());
    assert!(of_many == of_one);
}

#[test]
fn a_run_that_is_being_computed_is_left_alone() {
    let (folder, path) = common::folder(&[("bar.toml", CASE)], STUDY);
    let directory = folder.path().join("study");
    plan(&Plan::read(&path).unwrap(), &directory).unwrap();
    let go = AtomicBool::new(false);
    let mut second = None;
    let ended = arm(
        &directory,
        1,
        &mut |p| {
            if p.step == 5 {
                second = Some(arm(&directory, 1, &mut |_| (), &go));
            }
        },
        &go,
    );
    assert_eq!(ended.unwrap().status, Status::Finished);
    let refused = second.unwrap().unwrap_err().to_string();
    assert!(refused.contains("is being written by another process"), "{refused}");
}

#[test]
fn steps_of_matched_cost_are_not_planned() {
    let study = "case = \"bar.toml\"\ndesign = \"matched-cost\"\n[[arm]]\nname = \"a\"\n[[arm]]\nname = \"b\"\n\
                 set = { \"time.scheme\" = { kind = \"hu\" } }\n";
    let (folder, path) = common::folder(&[("bar.toml", CASE)], study);
    let directory = folder.path().join("study");
    let refused = plan(&Plan::read(&path).unwrap(), &directory).unwrap_err();
    assert!(matches!(refused, StudyError::Unsettled { ref arm } if arm == "b"), "{refused}");
    assert!(!directory.exists());
}
