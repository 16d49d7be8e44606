//! Times as people write them.
//!
//! An instant of a grid is k·Δt, rounded; Δt is itself the rounded value of a decimal. Both
//! together differ from the product of the decimals by at most one unit in the last place, 2⁻⁵²
//! relative: 3 · 0.003125 is stored as 0.009375000000000001. The shortest decimal within that
//! distance is the instant's own one; where there is none, the time keeps its digits. Files for
//! viewers have these times; tables and states have k·Δt as it was computed.

/// The double nearest to the shortest decimal that rounding may have made the given instant of.
pub(crate) fn decimal(time: f64) -> f64 {
    let near = |places: usize| {
        let shorter: f64 = format!("{time:.places$e}").parse().unwrap_or(time);
        ((shorter - time).abs() <= f64::EPSILON * time.abs()).then_some(shorter)
    };
    (0..16).find_map(near).unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The decimals of k·Δt in integers: k · 3125 in units of 10⁻⁶, and so on.
    #[test]
    fn instants_of_a_grid_are_its_decimals() {
        for (mantissa, places) in [(3125_u64, 6), (1, 1), (1875, 6), (375, 5), (7, 3), (1, 4), (333, 6)] {
            let parsed = |mantissa: u64| format!("{mantissa}e-{places}").parse::<f64>().unwrap();
            let step = parsed(mantissa);
            for k in 0..5000_u64 {
                let time = decimal(k as f64 * step);
                assert_eq!(time, parsed(k * mantissa), "{k} times {step}");
            }
        }
        assert_eq!((3.0 * 0.003125_f64).to_string(), "0.009375000000000001");
        assert_eq!(decimal(3.0 * 0.003125).to_string(), "0.009375");
    }

    /// Other numbers keep their digits, up to the last one.
    #[test]
    fn other_times_remain() {
        for time in [0.0, 1.0 / 3.0, std::f64::consts::PI, 1e-300, 2.5e17] {
            assert!((decimal(time) - time).abs() <= f64::EPSILON * time, "{time}");
        }
        assert!(decimal(f64::NAN).is_nan());
    }
}
