//! The table of a case: bodies, materials, supports, loads, contacts and probes, with formulas as
//! written.

use std::collections::HashSet;

use carom_case::{
    BodySpec, Case, ContactSpec, Enforcement, FormulaSpec, Law, LoadKind, LoadSpec, MaterialSpec, Method,
    ObstacleMotion, Overhang, Plane, PlasticSpec, PrimarySpec, ProbeSpec, SupportSpec, TieSpec, Units,
};
use carom_record::FieldSet;
use carom_record::units::Labels;
use maud::{Markup, html};

use super::Part;
use crate::labels::{given_amount, listed, number, symbol};
use crate::scientific::given;
use crate::text::Label;

/// A row: name, and what is said of it.
type Row = (Markup, Markup);

/// The table; cells, nodes and extents of the bodies are those of fields.
pub(crate) fn table(case: &Case, fields: Option<&FieldSet>) -> Markup {
    let groups: [(&str, Vec<Row>); 7] = [
        ("Bodies", case.bodies.iter().map(|one| body(case, one, fields)).collect()),
        ("Materials", case.materials.iter().map(|one| material(one, &case.units)).collect()),
        ("Supports", case.supports.iter().map(|one| support(one, &case.units)).collect()),
        ("Loads", case.loads.iter().map(|one| load(one, &case.units)).collect()),
        ("Contacts", case.contacts.iter().map(|one| contact(one, &case.units)).collect()),
        ("Ties", case.ties.iter().map(tie).collect()),
        ("Probes", case.probes.iter().map(|one| probe(one, &case.units)).collect()),
    ];
    html! {
        table.setup {
            @for (title, rows) in groups.iter().filter(|(_, rows)| !rows.is_empty()) {
                tr.group { th colspan="2" { (title) } }
                @for (name, words) in rows { tr { td { (name) } td { (words) } } }
            }
        }
        @if let Some(model) = model(case) { p.small { (Label(&model)) } }
    }
}

/// The plane state, or the cross-section of bars.
fn model(case: &Case) -> Option<String> {
    let thickness = given(case.thickness);
    let length = &case.units.length;
    match (case.dimension, case.plane) {
        (1, _) => Some(format!("Bars, cross-section {thickness} {length}^2.")),
        (2, Plane::Strain) => Some(format!("Plane strain, thickness {thickness} {length}.")),
        (2, Plane::Stress) => Some(format!("Plane stress, thickness {thickness} {length}.")),
        _ => None,
    }
}

fn labels(units: &Units) -> Labels {
    Labels::of(&units.length, &units.time, &units.mass)
}

fn stress(units: &Units) -> String {
    labels(units).stress
}

/// `(0, -9.81)`; a single component without parentheses.
fn components(formulas: &[FormulaSpec]) -> String {
    let written = |formula: &FormulaSpec| match formula {
        FormulaSpec::Number(value) => number(*value),
        FormulaSpec::Text(text) => text.clone(),
    };
    let parts: Vec<String> = formulas.iter().map(written).collect();
    if let [one] = &parts[..] { one.clone() } else { format!("({})", parts.join(", ")) }
}

/// A line in the colour of a part, before a side.
fn sample(part: Part, side: &str) -> Markup {
    html! {
        svg.line width="22" height="8" { path d="M1 4h20" stroke=(part.line()) stroke-width="3.2" {} }
        " " (side)
    }
}

fn body(case: &Case, body: &BodySpec, fields: Option<&FieldSet>) -> Row {
    let Units { length, time, .. } = &case.units;
    let block = fields.and_then(|fields| fields.blocks.iter().find(|block| block.body == body.name));
    let size = block.zip(fields).map(|(block, fields)| {
        let nodes: HashSet<usize> = block.connectivity.iter().copied().collect();
        let extent = |i: usize| {
            let (low, high) = crate::axis::range(nodes.iter().map(|&k| &fields.points[k][i]));
            format!("{} = {} to {}", ["x", "y", "z"][i], given(low), given(high))
        };
        let extents: Vec<String> = (0..case.dimension.min(3)).map(extent).collect();
        format!("{} cells, {} nodes, {} {length}", block.cells().count(), nodes.len(), extents.join(", "))
    });
    let moved = |formulas: &[FormulaSpec], symbol: &str, unit: &str| {
        let is_zero = formulas.iter().all(FormulaSpec::is_zero);
        (!is_zero)
            .then(|| html! { "; " (Label(symbol)) " = " code { (components(formulas)) } " " (Label(unit)) })
    };
    let words = html! {
        (body.material_names().join(", ")) ", " (format!("{:?}", body.element))
        @if let Some(size) = size { ": " (Label(&size)) }
        (moved(&body.gravity, "g", &format!("{length}/{time}^2")).unwrap_or_default())
        (moved(&body.velocity, "v_{0}", &format!("{length}/{time}")).unwrap_or_default())
    };
    (html! { (body.name) }, words)
}

fn material(material: &MaterialSpec, units: &Units) -> Row {
    let &MaterialSpec { density, lambda, mu, .. } = material;
    let law = match material.law {
        Law::NeoHookean => "neo-Hookean",
        Law::SaintVenantKirchhoff => "Saint Venant–Kirchhoff",
        Law::LinearElastic => "linear elastic",
        Law::Hencky => "Hencky",
        Law::MooneyRivlin => "Mooney–Rivlin",
        Law::Yeoh => "Yeoh",
    };
    let poisson = lambda / (2.0 * (lambda + mu));
    let [young, lambda, shear] =
        [2.0 * mu * (1.0 + poisson), lambda, mu].map(|x| given_amount(x, &stress(units)));
    let words = format!(
        "{law}, ρ = {} {}/{}^3, E = {young}, ν = {} (λ = {lambda}, G = {shear})",
        given(density),
        units.mass,
        units.length,
        given(poisson)
    );
    let yields = material.plastic.as_ref().map(|plastic| yields(plastic, units)).unwrap_or_default();
    (html! { (material.name) }, html! { (Label(&words)) (Label(&yields)) })
}

/// Yield stress and hardening.
fn yields(plastic: &PlasticSpec, units: &Units) -> String {
    let amount = |x: f64| given_amount(x, &stress(units));
    match plastic {
        PlasticSpec::Formula { yield_stress, hardening, rise, rate } => {
            let hardens = (*hardening > 0.0).then(|| format!(", hardening {}", amount(*hardening)));
            let rises =
                (*rise > 0.0).then(|| format!(", rise {} at the rate {}", amount(*rise), given(*rate)));
            let [hardens, rises] = [hardens, rises].map(Option::unwrap_or_default);
            format!(", yields at {}{hardens}{rises}", amount(*yield_stress))
        }
        PlasticSpec::Table(points) => {
            let ends = [points.first(), points.last()].map(|point| point.map_or(0.0, |point| point[1]));
            format!(", yields at {} to {} (table)", amount(ends[0]), amount(ends[1]))
        }
    }
}

/// `u_{x}`, by the number of its direction.
fn displacement(axis: usize) -> &'static str {
    ["u_{x}", "u_{y}", "u_{z}"][axis.min(2)]
}

fn moves(moves: &[(usize, FormulaSpec)], length: &str) -> Markup {
    html! {
        @for (k, (axis, formula)) in moves.iter().enumerate() {
            @if k > 0 { ", " }
            (Label(displacement(*axis))) " = " code { (formula) } " " (length)
        }
    }
}

fn support(support: &SupportSpec, units: &Units) -> Row {
    let fixed: Vec<&str> = support.fix.iter().map(|axis| displacement(*axis)).collect();
    let fixed: Vec<&str> = fixed.into_iter().chain(support.normal.then_some("u_{n}")).collect();
    let words = html! {
        @if let Some(name) = &support.name { (name) ": " }
        @if !fixed.is_empty() { (Label(&fixed.join(" = "))) " = 0" }
        @if !fixed.is_empty() && !support.moves.is_empty() { ", " }
        (moves(&support.moves, &units.length))
    };
    (sample(Part::Supported, &support.on.join(", ")), words)
}

fn load(load: &LoadSpec, units: &Units) -> Row {
    let (kind, place, value) = match &load.kind {
        LoadKind::Traction { on, value } => ("traction", on.join(", "), components(value)),
        LoadKind::Pressure { on, value } => ("pressure", on.join(", "), value.to_string()),
        LoadKind::BodyForce { body, material, value } => {
            let cells = material.as_ref().map_or_else(String::new, |material| format!(", {material}"));
            ("body force", format!("{body}{cells}"), components(value))
        }
    };
    let unit = match &load.kind {
        LoadKind::BodyForce { .. } => match labels(units).force {
            named if named.ends_with('N') => format!("{named}/{}^3", units.length),
            _ => format!("{}/({}^2 {}^2)", units.mass, units.length, units.time),
        },
        LoadKind::Traction { .. } | LoadKind::Pressure { .. } => stress(units),
    };
    let words = html! {
        @if let Some(name) = &load.name { (name) ": " }
        (kind) " " code { (value) } " " (Label(&unit))
        @if let Some(table) = &load.table { " × " code { (table.file) } }
    };
    (sample(Part::Loaded, &place), words)
}

fn tie(tie: &TieSpec) -> Row {
    let beside = if tie.overhang == Overhang::Free { "; nodes beside it are free" } else { "" };
    let words = html! {
        (sample(Part::Tied, &tie.secondary)) " (secondary) to " (sample(Part::Tied, &tie.primary)) " (primary)" (beside)
    };
    (html! { (tie.name) }, words)
}

fn contact(contact: &ContactSpec, units: &Units) -> Row {
    let rigid = match &contact.primary {
        PrimarySpec::Side(_) => "",
        PrimarySpec::Plane { .. } => "rigid plane",
        PrimarySpec::Circle { center, .. } if center.len() == 3 => "rigid sphere",
        PrimarySpec::Circle { .. } => "rigid circle",
        PrimarySpec::Cylinder { .. } => "rigid cylinder",
        PrimarySpec::Surface(_) => "rigid surface",
        PrimarySpec::Polyline { .. } => "rigid polyline",
    };
    let motion = match &contact.motion {
        ObstacleMotion::Fixed => Markup::default(),
        ObstacleMotion::Free { mass, .. } => html! { ", free, mass " (given(*mass)) " " (units.mass) },
        ObstacleMotion::Prescribed { moves: moved, rotate, axis } => html! {
            @if !moved.is_empty() { ", " (moves(moved, &units.length)) }
            @if let Some((angle, _)) = rotate { ", angle = " code { (angle) } " degrees" }
            @if let Some(axis) = axis { " about " (format!("{axis:?}")) }
        },
    };
    let friction = &contact.friction;
    let words = html! {
        (sample(Part::Secondary, &contact.secondary)) " (secondary) on "
        @match contact.primary.side() {
            Some(side) => { (sample(Part::Primary, side)) " (primary)" },
            None => (rigid),
        }
        (motion)
        @if contact.method == Method::Mortar { ", mortar method" }
        @match contact.enforcement {
            Enforcement::Multiplier => {}
            Enforcement::Penalty => { ", penalty" }
            Enforcement::Augmented => { ", augmented Lagrangian" }
        }
        @if friction.exists() {
            @if let Some(mu) = &friction.mu { ", μ = " code { (mu) } }
            @if let Some(mu) = friction.mu_dynamic { ", sliding " (given(mu)) }
            @if let Some(shear) = friction.shear { ", at most " (given_amount(shear, &stress(units))) }
        } @else { ", without friction" }
    };
    (html! { (contact.name) }, words)
}

fn probe(probe: &ProbeSpec, units: &Units) -> Row {
    let at: Vec<String> = probe.at.iter().map(|x| given(*x)).collect();
    let at = if at.len() == 1 { format!("x\u{a0}=\u{a0}{}", at[0]) } else { format!("({})", at.join(", ")) };
    let quantities: Vec<String> = probe.record.iter().map(|quantity| symbol(quantity.word())).collect();
    let words = html! {
        (probe.body) " at " (at) " " (units.length) ": " (Label(&listed(&quantities)))
    };
    (html! { (probe.name) }, words)
}
