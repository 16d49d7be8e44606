//! What columns are called in figures.

/// Symbol of a probe's quantity: `σ_{yy}`.
pub(crate) fn symbol(quantity: &str) -> String {
    match quantity {
        "ux" | "uy" | "vx" | "vy" | "ax" | "ay" => format!("{}_{{{}}}", &quantity[..1], &quantity[1..]),
        "von_mises" => "σ_{vM}".into(),
        "det_f" => "det F".into(),
        _ => match quantity.strip_prefix("sigma_") {
            Some(component) => format!("σ_{{{component}}}"),
            None => quantity.replace('_', " "),
        },
    }
}

/// What a probe's quantity is.
pub(crate) fn words(quantity: &str) -> String {
    let axis = |c: &str| if c == "x" { "horizontal" } else { "vertical" }.to_string();
    match quantity {
        "ux" | "uy" => axis(&quantity[1..]) + " displacement",
        "vx" | "vy" => axis(&quantity[1..]) + " velocity",
        "ax" | "ay" => axis(&quantity[1..]) + " acceleration",
        "von_mises" => "von Mises stress".into(),
        "det_f" => "volume ratio".into(),
        _ if quantity.starts_with("sigma_") => "Cauchy stress".into(),
        _ => quantity.replace('_', " "),
    }
}

/// A label followed by its unit, if it has one.
pub(crate) fn with_unit(label: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { label.to_string() } else { format!("{label} ({unit})") }
}
