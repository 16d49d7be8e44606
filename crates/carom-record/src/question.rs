//! Quantities of records, as `what = "…"` of `[[expect]]` and claims name them.
//!
//! ```text
//! question := FORM column [ of "ARM" ] | FORM [ columns ] [ by step ] | NAME [ of "ARM" ]         in any expression with numbers
//!             difference COLUMN of "ARM" and "ARM"          = peak [ COLUMN of "ARM" - COLUMN of "ARM" ];  rms difference … likewise
//! FORM     := min · max · first · last · at T (linear between rows) · time of min · time of max
//!             range (max − min) · drift (largest |c − c₀|) · peak (largest |c|) · rms (√ of the mean of c² over the rows)
//! columns  := an expression in columns, each with `of "ARM"` in a study
//! NAME     := a metric of `metrics`, COLUMN:min etc., energy_lost:N, or `stopped` (1 if the run could not continue, 0 if it ended)
//! ```
//!
//! An expression in columns of several arms uses the rows whose times occur in all records (to 1e-9
//! of the span); `by step` matches rows by step number instead, for records with different units of
//! time. Only rows with `after < time < before`, strictly, are used.

mod form;
mod names;
mod quantity;
mod records;
mod text;

pub use form::{Form, form_names};
pub use names::{column_metric_names, metric_names};
pub use quantity::{Asked, Quantity, Question, Records, Rows, Series, Window, common};
pub(crate) use records::rows;
