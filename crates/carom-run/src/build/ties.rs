//! Ties: the secondary nodes as points of the primary facets on which they lie.
//!
//! With mortar ties (`mortar_tie.rs`) each is a mean of points.
//!
//! A node beside the surface, by less than what the tie adjusts, is moved onto it in the mesh,
//! without stress: the force of a tie at a distance from its point would have a moment.

use std::collections::HashSet;

use carom_case::{Case, Overhang, Problem, TieMethod, TieSpec};
use carom_mechanics::model::{Circular, Points, Tie};
use carom_solid::{FacetPoint, Mesh};

use super::mortar_tie;
use super::side::{ascending, coordinates};
use super::tie_links::Links;
use super::tie_side::{BESIDE, TieSide, place_of};

/// Distance that is closed unless the tie says more, over the length of a facet.
const OFFSET: f64 = 1e-6;
/// Distance, over the length of a facet, below which moving the node may close a tie.
const ADJUSTABLE: f64 = 0.25;
/// Weight of a node that is round-off of a point's place.
const ROUND_OFF: f64 = 1e-9;

/// The ties of a case: nodes that are points, and what is recorded of each tie.
#[derive(Default)]
pub(crate) struct Ties {
    pub(crate) points: Points,
    pub(crate) list: Vec<Tie>,
    /// Facets that lie on the other side of their tie, by their nodes in ascending order. They are
    /// inside what the tie joins, and nothing meets them.
    pub(crate) closed: HashSet<Vec<usize>>,
}

/// A tied node, and the nodes of the primary side's body that carry it, in the numbers of their
/// meshes.
struct Tied {
    node: usize,
    weights: Vec<(usize, f64)>,
}

/// The nodes of a tie, in the numbers of the meshes.
struct Found {
    bodies: [usize; 2],
    tied: Vec<Tied>,
    sides: [Vec<usize>; 2],
    /// Facets of both sides that lie on the other one.
    closed: [Vec<Vec<usize>>; 2],
}

/// Finds the points of all ties, and moves the nodes of the meshes onto them.
pub(crate) fn ties(case: &Case, meshes: &mut [Mesh], problems: &mut Vec<Problem>) -> Ties {
    let first: Vec<usize> =
        meshes.iter().scan(0, |next, mesh| Some(std::mem::replace(next, *next + mesh.nodes.len()))).collect();
    let mut links = Links::default();
    let mut list = Vec::new();
    let mut closed = HashSet::new();
    for (k, spec) in case.ties.iter().enumerate() {
        match found(case, k, spec, meshes) {
            Ok(Found { bodies, tied, sides, closed: facets }) => {
                let [secondary, primary] = bodies.map(|body| first[body]);
                for (facets, first) in facets.into_iter().zip([secondary, primary]) {
                    let of_model = |facet: Vec<usize>| facet.into_iter().map(|node| first + node).collect();
                    closed.extend(facets.into_iter().map(of_model).map(ascending));
                }
                for Tied { node, weights } in tied {
                    let weights = weights.into_iter().map(|(node, weight)| (primary + node, weight));
                    links.tie(k, secondary + node, weights.collect());
                }
                let [own, other] = &sides;
                let own = own.iter().map(|node| secondary + node);
                let surface = own.chain(other.iter().map(|node| primary + node)).collect();
                list.push(Tie {
                    name: spec.name.clone(),
                    tied: Default::default(),
                    supported: Vec::new(),
                    surface,
                    bodies,
                });
            }
            Err(problem) => problems.push(problem),
        }
    }
    for (k, tie) in list.iter_mut().enumerate() {
        tie.tied = links.tied(k);
    }
    let mut places: Vec<f64> = meshes.iter().flat_map(|mesh| mesh.nodes.flat()).copied().collect();
    let d = case.dimension;
    let points = match Points::new(d, places.len() / d, links.points()) {
        Ok(points) => points,
        Err(Circular { node }) => {
            problems.push(circular(&list, node, &places[node * d..(node + 1) * d]));
            return Ties::default();
        }
    };
    points.carry(&mut places);
    for point in points.iter() {
        let body = first.partition_point(|first| *first <= point.node) - 1;
        let place = &places[point.node * d..(point.node + 1) * d];
        meshes[body].nodes[point.node - first[body]].copy_from_slice(place);
    }
    Ties { points, list, closed }
}

/// The tie that makes a node a point.
pub(super) fn tie_of(ties: &[Tie], node: usize) -> usize {
    let has = |tie: &Tie| tie.tied.iter().any(|nodes| nodes.contains(&node));
    ties.iter().position(has).unwrap_or(0)
}

fn circular(ties: &[Tie], node: usize, place: &[f64]) -> Problem {
    let at = coordinates(place);
    let what = format!("ties make the node at {at} depend on itself");
    let why = "the points that carry it are in turn tied to facets that it carries";
    let help = "exchange `secondary` and `primary` of this tie";
    Problem::new(format!("tie[{}].secondary", tie_of(ties, node)), what, why, help)
}

fn found(case: &Case, k: usize, tie: &TieSpec, meshes: &[Mesh]) -> Result<Found, Problem> {
    let (secondary, own) = looked_up(case, &tie.secondary, format!("tie[{k}].secondary"))?;
    let (primary, other) = looked_up(case, &tie.primary, format!("tie[{k}].primary"))?;
    let missing = |key: &str, name: &str, mesh: &Mesh| {
        let sides = mesh.sides.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        let what = format!("there is no side \"{name}\"");
        let why = format!("the sides of this body are: {sides}");
        Problem::new(format!("tie[{k}].{key}"), what, why, "use one of them")
    };
    let nodes = meshes[secondary].side_nodes(own);
    let nodes = nodes.ok_or_else(|| missing("secondary", &tie.secondary, &meshes[secondary]))?;
    let target = TieSide::new(&meshes[primary], other);
    let target = target.ok_or_else(|| missing("primary", &tie.primary, &meshes[primary]))?;
    let carriers = meshes[primary].side_nodes(other).unwrap_or_default();
    let reach = |target: &TieSide, facet: usize| tie.adjust.unwrap_or(OFFSET * target.length(facet));
    let mut tied = Vec::new();
    for &node in &nodes {
        if secondary == primary && carriers.contains(&node) {
            // The end of a slit belongs to both of its sides.
            continue;
        }
        let place = place_of(&meshes[secondary], node);
        let Some((facet, point)) = target.nearest(place) else { continue };
        if point.distance > reach(&target, facet) {
            if point.beside > BESIDE * point.distance {
                if tie.overhang == Overhang::Free {
                    continue;
                }
                return Err(beside(case, k, tie, place, &point));
            }
            let is_near = point.distance < ADJUSTABLE * target.length(facet);
            return Err(apart(case, k, tie, place, point.distance, is_near));
        }
        tied.push(Tied { node, weights: weights(&target.facets[facet], &point.values) });
    }
    if tie.method == TieMethod::Mortar
        && let Some(side) = TieSide::new(&meshes[secondary], own)
    {
        let of_ends = tied.into_iter().map(|Tied { node, weights }| (node, weights)).collect();
        let found = mortar_tie::weights(&side, &target, of_ends);
        tied = found.into_iter().map(|(node, weights)| Tied { node, weights }).collect();
    }
    if tied.is_empty() {
        let what = format!("tie `{}` has no nodes", tie.name);
        let why = format!("no node of {} lies on {}", tie.secondary, tie.primary);
        let help = "name the two sides that touch, or `place` one of the bodies there";
        return Err(Problem::new(format!("tie[{k}].secondary"), what, why, help));
    }
    let source = TieSide::new(&meshes[secondary], own);
    let closed = match &source {
        Some(source) => [source.on(&target, reach), target.on(source, reach)],
        None => Default::default(),
    };
    Ok(Found { bodies: [secondary, primary], tied, sides: [nodes, carriers], closed })
}

/// Nodes with their weights of sum 1, without those that are round-off.
fn weights(nodes: &[usize], values: &[f64]) -> Vec<(usize, f64)> {
    let mut weights: Vec<(usize, f64)> = nodes.iter().copied().zip(values.iter().copied()).collect();
    weights.retain(|(_, weight)| weight.abs() > ROUND_OFF);
    let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
    weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
    weights
}

/// The body and the side of a name.
fn looked_up<'a>(case: &Case, name: &'a str, path: String) -> Result<(usize, &'a str), Problem> {
    let (body, side) = name.split_once('.').unwrap_or((name, ""));
    let found = case.bodies.iter().position(|spec| spec.name == body);
    let missing = || {
        let bodies = case.bodies.iter().map(|spec| spec.name.as_str()).collect::<Vec<_>>().join(", ");
        let what = format!("there is no side \"{name}\"");
        Problem::new(path, what, "a side is written body.side", format!("the bodies are: {bodies}"))
    };
    Ok((found.ok_or_else(missing)?, side))
}

fn beside(case: &Case, k: usize, tie: &TieSpec, place: [f64; 3], point: &FacetPoint) -> Problem {
    let at = coordinates(&place[..case.dimension]);
    let what = format!("a node of {} at {at} has no partner on {}", tie.secondary, tie.primary);
    let why = format!("it lies beside the primary side, {:.3e} from its nearest point", point.distance);
    let points = if tie.method == TieMethod::Mortar { "`method = \"points\"` with " } else { "" };
    let help = format!(
        "exchange `secondary` and `primary` if the other side is the smaller one, or give {points}\
         `overhang = \"free\"`, which leaves such nodes free"
    );
    Problem::new(format!("tie[{k}].secondary"), what, why, help)
}

fn apart(case: &Case, k: usize, tie: &TieSpec, place: [f64; 3], distance: f64, is_near: bool) -> Problem {
    let at = coordinates(&place[..case.dimension]);
    let what = format!(
        "a node of {} at {at} is {distance:.3e} away from {}: the tie has a gap there",
        tie.secondary, tie.primary
    );
    let why = "a force at a distance from its point would have a moment that nothing balances";
    let help = if is_near {
        format!(
            "place the bodies so that the sides touch, use meshes of higher degree where they are curved, or \
             give `adjust = {:.2e}`: nodes up to so far away are then moved onto the primary side, without \
             stress",
            1.01 * distance
        )
    } else {
        "name the two sides that touch, or place the bodies so that they do".to_owned()
    };
    let key = if tie.adjust.is_some() { "adjust" } else { "secondary" };
    Problem::new(format!("tie[{k}].{key}"), what, why, help)
}
