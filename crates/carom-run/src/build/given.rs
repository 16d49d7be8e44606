//! Formulas of position and time, and the functions of a program that may take their place.

use carom_case::{Case, FormulaSpec, Problem, load_variables};
use carom_formula::Formula;

/// A formula of position and time, or the function that it names.
pub(super) fn in_space_and_time(case: &Case, spec: &FormulaSpec, path: &str) -> Result<Formula, Problem> {
    let variables = load_variables(case.dimension);
    let Some(name) = spec.function() else {
        return spec.formula(&variables).map_err(|error| Problem::new(path, error.to_string(), "", ""));
    };
    let function = case.functions.0.get(name).ok_or_else(|| {
        Problem::new(
            path,
            format!("the function `{name}` is not given"),
            "it is a function of the program that made the case, which no file contains",
            "run or resume the case from that program, with the same function, or write a formula",
        )
    })?;
    Ok(Formula::given(name, function.clone(), &variables))
}
