//! The memory of runs that are computed at once: the sum of the largest ones, as many as there are
//! jobs, since any of them may run together. They share the program itself. A study with a goal
//! begins with the natural frequencies of its first arm, for which the tangent is factored whatever
//! the arm is solved with.

use carom_record::available_memory;
use carom_run::case::{Case, Memory};

use crate::error::StudyError;
use crate::plan::Plan;

/// Checks that runs fit into the memory together, `jobs` of them at once.
///
/// # Errors
/// How much they need, and how many fit; none where the system does not report its memory.
pub(crate) fn fit<'a>(cases: impl Iterator<Item = &'a Case>, jobs: usize) -> Result<(), StudyError> {
    let needs = largest_first(cases.map(Case::memory));
    let available = available_memory().unwrap_or(f64::INFINITY);
    let need = at_once(&needs, jobs);
    if need <= available {
        return Ok(());
    }
    let jobs = jobs.min(needs.len());
    let fitting = (1..jobs).take_while(|jobs| at_once(&needs, *jobs) <= available).last();
    let what = if jobs == 1 { "the run".to_owned() } else { format!("{jobs} runs at once") };
    Err(StudyError::Memory { what, need, available, fitting })
}

impl Plan {
    /// Bytes for the largest run, and for the `jobs` largest runs together.
    pub fn memory(&self, jobs: usize) -> [f64; 2] {
        let mut needs = largest_first(self.arms.iter().map(|arm| arm.case.memory()));
        // The members of an ensemble are as large as their arms, on the given mesh.
        let most = needs.first().copied().unwrap_or_default();
        needs.resize(self.manifest.runs().count(), most);
        [at_once(&needs, 1), at_once(&needs, jobs)]
    }

    /// Checks that its runs fit into the memory, `jobs` of them at once.
    ///
    /// # Errors
    /// [`StudyError::Memory`].
    pub fn fits_memory(&self, jobs: usize) -> Result<(), StudyError> {
        fit(self.arms.iter().map(|arm| &arm.case), jobs)?;
        let first = self.arms.first().filter(|_| self.manifest.goal.is_some());
        let need = first.map_or(0.0, |arm| arm.case.memory_factored().total());
        match available_memory().filter(|available| need > *available) {
            None => Ok(()),
            Some(available) => Err(StudyError::Memory {
                what: "the natural frequencies of the first arm, which a study with a goal lists,".into(),
                need,
                available,
                fitting: None,
            }),
        }
    }
}

fn largest_first(needs: impl Iterator<Item = Memory>) -> Vec<Memory> {
    let mut needs: Vec<Memory> = needs.collect();
    needs.sort_by(|a, b| b.total().total_cmp(&a.total()));
    needs
}

/// Bytes of the `jobs` largest runs together; `needs` begins with the largest.
fn at_once(needs: &[Memory], jobs: usize) -> f64 {
    let program = needs.first().map_or(0.0, |first| first.program);
    program + needs.iter().take(jobs).map(|need| need.total() - need.program).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_run_at_once_and_share_the_program() {
        let need = |model: f64| Memory { program: 10.0, model, ..Memory::default() };
        let needs = largest_first([1.0, 5.0, 3.0].map(need).into_iter());
        assert_eq!([1, 2, 9].map(|jobs| at_once(&needs, jobs)), [15.0, 18.0, 19.0]);
        assert_eq!(at_once(&[], 2), 0.0);
    }
}
