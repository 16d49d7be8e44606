//! Times as people write them.
//!
//! An instant of a grid is k·Δt, rounded; Δt is itself the rounded value of a decimal. Both
//! together differ from the product of the decimals by at most one unit in the last place, 2⁻⁵²
//! relative: 3 · 0.003125 is stored as 0.009375000000000001. The shortest decimal within that
//! distance is the instant's own one; where there is none, the time keeps its digits. Files for
//! viewers have these times; tables and states have k·Δt as it was computed.

/// The double nearest to the shortest decimal that rounding may have made the given instant of.
pub fn decimal(time: f64) -> f64 {
    let near = |places: usize| {
        let shorter: f64 = format!("{time:.places$e}").parse().unwrap_or(time);
        ((shorter - time).abs() <= f64::EPSILON * time.abs()).then_some(shorter)
    };
    (0..16).find_map(near).unwrap_or(time)
}
