//! Ties: the secondary nodes as points of the primary facets on which they lie.
//!
//! A node beside the surface, by less than what the tie adjusts, is moved onto it in the mesh,
//! without stress: the force of a tie at a distance from its point would have a moment.

use std::collections::{BTreeMap, HashMap};

use carom_case::{Case, Overhang, Problem, TieSpec};
use carom_mechanics::model::{BodyInstance, Circular, Point, Points, Tie};
use carom_solid::{Bounds, FacetPoint, FacetShape, Mesh, Tree};

use super::motions::Moves;
use super::side::coordinates;

/// Distance that is closed unless the tie says more, over the length of a facet.
const OFFSET: f64 = 1e-6;
/// Distance along the nearest facet, as a share of the distance from it, from which on a node is
/// beside the primary side and not above it.
const BESIDE: f64 = 0.1;
/// Part of a facet's size by which a curved one may leave the box of its nodes.
const BULGE: f64 = 0.5;

/// A tied node: its body and number there, and the nodes of the primary side's body that carry it.
struct Tied {
    node: usize,
    weights: Vec<(usize, f64)>,
}

/// The nodes of a tie, in the numbers of the meshes.
pub(super) struct Found {
    bodies: [usize; 2],
    tied: Vec<Tied>,
}

/// The primary side of a tie.
struct Primary {
    shape: FacetShape,
    facets: Vec<Vec<usize>>,
    places: Vec<Vec<[f64; 3]>>,
    tree: Tree,
}

impl Primary {
    fn new(mesh: &Mesh, side: &str) -> Option<Self> {
        let facets: Vec<Vec<usize>> = mesh.sides.get(side)?.iter().map(|facet| facet.nodes.clone()).collect();
        let places: Vec<Vec<[f64; 3]>> =
            facets.iter().map(|nodes| nodes.iter().map(|&node| place_of(mesh, node)).collect()).collect();
        let bounds = |facet: usize| {
            let mut bounds = Bounds::EMPTY;
            places[facet].iter().for_each(|place| bounds.add(place));
            let size = bounds.size();
            bounds.grown(BULGE * size)
        };
        let tree = Tree::new(facets.len(), bounds);
        Some(Self { shape: mesh.element.facet_shape(), facets, places, tree })
    }

    /// The nearest facet and its nearest point.
    fn nearest(&self, place: [f64; 3]) -> Option<(usize, FacetPoint)> {
        let distance = |facet: usize| Some(self.shape.closest(&self.places[facet], place).distance);
        let (facet, _) = self.tree.nearest(&place, None, distance)?;
        Some((facet, self.shape.closest(&self.places[facet], place)))
    }

    /// Largest extent of a facet.
    fn length(&self, facet: usize) -> f64 {
        let mut bounds = Bounds::EMPTY;
        self.places[facet].iter().for_each(|place| bounds.add(place));
        bounds.size()
    }
}

fn place_of(mesh: &Mesh, node: usize) -> [f64; 3] {
    let place = &mesh.nodes[node];
    std::array::from_fn(|i| place.get(i).copied().unwrap_or(0.0))
}

/// Finds the points of all ties, and moves the nodes of the meshes onto them.
pub(super) fn found(case: &Case, meshes: &mut [Mesh], problems: &mut Vec<Problem>) -> Vec<Found> {
    let mut all = Vec::new();
    for (k, tie) in case.ties.iter().enumerate() {
        match found_by(case, k, tie, meshes) {
            Ok(found) => all.push(found),
            Err(problem) => problems.push(problem),
        }
    }
    all
}

fn found_by(case: &Case, k: usize, tie: &TieSpec, meshes: &mut [Mesh]) -> Result<Found, Problem> {
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
    let target = Primary::new(&meshes[primary], other);
    let target = target.ok_or_else(|| missing("primary", &tie.primary, &meshes[primary]))?;
    let mut tied = Vec::new();
    let mut moved = Vec::new();
    for node in nodes {
        let place = place_of(&meshes[secondary], node);
        let Some((facet, point)) = target.nearest(place) else { continue };
        if secondary == primary && target.facets.iter().any(|facet| facet.contains(&node)) {
            // The end of a slit belongs to both of its sides.
            continue;
        }
        let reach = tie.adjust.unwrap_or(OFFSET * target.length(facet));
        if point.distance > reach {
            if point.beside > BESIDE * point.distance {
                if tie.overhang == Overhang::Free {
                    continue;
                }
                return Err(beside(case, k, tie, place, &point));
            }
            return Err(apart(case, k, tie, place, &point));
        }
        let weights = target.facets[facet].iter().copied().zip(point.values.iter().copied()).collect();
        tied.push(Tied { node, weights });
        moved.push((node, point.position));
    }
    if tied.is_empty() {
        let what = format!("tie `{}` has no nodes", tie.name);
        let why = format!("no node of {} lies on {}", tie.secondary, tie.primary);
        let help = "name the two sides that touch, or move one of the bodies with `at`";
        return Err(Problem::new(format!("tie[{k}].secondary"), what, why, help));
    }
    let d = case.dimension;
    for (node, position) in moved {
        meshes[secondary].nodes[node].copy_from_slice(&position[..d]);
    }
    Ok(Found { bodies: [secondary, primary], tied })
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
    let help = "exchange `secondary` and `primary` if the other side is the smaller one, or give \
        `overhang = \"free\"`, which leaves such nodes free";
    Problem::new(format!("tie[{k}].secondary"), what, why, help)
}

fn apart(case: &Case, k: usize, tie: &TieSpec, place: [f64; 3], point: &FacetPoint) -> Problem {
    let at = coordinates(&place[..case.dimension]);
    let what = format!(
        "a node of {} at {at} is {:.3e} away from {}, which is not closed",
        tie.secondary, point.distance, tie.primary
    );
    let why = "a force at a distance from its point would have a moment that nothing balances";
    let help = format!(
        "place the bodies so that the sides touch, use meshes of higher degree where they are curved, or give \
         `adjust = {:.2e}`: nodes up to so far away are then moved onto the primary side, without stress",
        1.01 * point.distance
    );
    Problem::new(format!("tie[{k}].adjust"), what, why, help)
}

/// The points and ties of a model.
pub(super) struct Tying<'a> {
    pub(super) case: &'a Case,
    pub(super) parts: &'a [BodyInstance],
    pub(super) reference: &'a [f64],
}

impl Tying<'_> {
    /// The points of all ties in the numbers of the model. A node that an earlier tie ties is left
    /// out of later ones, and so is one whose point an earlier tie ties to the node itself.
    pub(super) fn points(&self, found: Vec<Found>, problems: &mut Vec<Problem>) -> (Points, Vec<Tie>) {
        let mut given: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        let mut ties = Vec::new();
        for (tie, Found { bodies, tied }) in self.case.ties.iter().zip(found) {
            let [first, other] = bodies.map(|body| self.parts[body].first_node);
            let mut nodes = Vec::new();
            for Tied { node, weights } in tied {
                let node = node + first;
                let weights =
                    weights.into_iter().map(|(carrier, weight)| (carrier + other, weight)).collect();
                if given.contains_key(&node) || leads_to(&given, &weights, node) {
                    continue;
                }
                given.insert(node, weights);
                nodes.push(node);
            }
            ties.push(Tie { name: tie.name.clone(), nodes, bodies });
        }
        let given = given.into_iter().map(|(node, weights)| Point { node, weights }).collect();
        let count = self.reference.len() / self.case.dimension;
        match Points::new(self.case.dimension, count, given) {
            Ok(points) => (points, ties),
            Err(Circular { node }) => {
                let at = coordinates(self.place(node));
                let what = format!("ties make the node at {at} depend on itself");
                let why = "its tie leads through the points of other ties back to it";
                let help = "exchange `secondary` and `primary` of one of these ties";
                problems.push(Problem::new("tie[0].secondary", what, why, help));
                (Points::default(), ties)
            }
        }
    }

    fn place(&self, node: usize) -> &[f64] {
        let d = self.case.dimension;
        &self.reference[node * d..(node + 1) * d]
    }

    /// Frees the dofs of points whose carriers have the same support; any other support of a point
    /// is a problem.
    pub(super) fn release(
        &self,
        points: &Points,
        fixed: &mut [bool],
        moves: &mut Moves,
        problems: &mut Vec<Problem>,
    ) {
        let d = self.case.dimension;
        for point in points.iter() {
            for axis in 0..d {
                let support = |node: usize| (fixed[node * d + axis], moves.text(node * d + axis));
                let own = support(point.node);
                if own == (false, None) {
                    continue;
                }
                if point.weights.iter().any(|(carrier, _)| support(*carrier) != own) {
                    problems.push(self.overconstrained(point));
                    return;
                }
                fixed[point.node * d + axis] = false;
                moves.by_dof.remove(&(point.node * d + axis));
            }
        }
    }

    fn overconstrained(&self, point: &Point) -> Problem {
        let at = coordinates(self.place(point.node));
        let part = self.parts.iter().find(|part| part.nodes().contains(&point.node));
        let body = part.map_or("", |part| part.name.as_str());
        let k = self.case.ties.iter().position(|tie| tie.secondary.split('.').next() == Some(body));
        let what = format!("the node of body \"{body}\" at {at} is tied and also on a support");
        let why = "a tied node moves with the primary side, which this support does not hold in the same way";
        let help = "exchange `secondary` and `primary`, give the primary side the same support there, or leave \
            the node's side out of the support";
        Problem::new(format!("tie[{}].secondary", k.unwrap_or(0)), what, why, help)
    }

    /// Reports initial positions and velocities that differ across ties.
    pub(super) fn check_start(
        &self,
        points: &Points,
        position: &[f64],
        velocity: &[f64],
        problems: &mut Vec<Problem>,
    ) {
        for (what, key, values) in
            [("initial positions", "position", position), ("initial velocities", "velocity", velocity)]
        {
            let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            let mut carried = values.to_vec();
            points.carry(&mut carried);
            let differs = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-9 * largest;
            if let Some(dof) = carried.iter().zip(values).position(differs) {
                let node = dof / self.case.dimension;
                let body = self.parts.iter().position(|part| part.nodes().contains(&node)).unwrap_or(0);
                let at = coordinates(self.place(node));
                let what = format!("the {what} of the tied sides differ at {at}");
                let why = format!("{} there, and {} on the primary side", values[dof], carried[dof]);
                let help = "give both bodies the same, in the points of the tie at least";
                problems.push(Problem::new(format!("body[{body}].{key}"), what, why, help));
            }
        }
    }

    /// Reports points of which only one side has mass.
    pub(super) fn check_masses(&self, points: &Points, massless: &[bool], problems: &mut Vec<Problem>) {
        let d = self.case.dimension;
        let has_mass: HashMap<usize, bool> =
            points.iter().map(|point| (point.node, !massless[point.node * d])).collect();
        let differs = |point: &&Point| {
            point.weights.iter().any(|(carrier, _)| massless[carrier * d] == has_mass[&point.node])
        };
        if self.case.time.scheme.is_static() {
            return;
        }
        if let Some(point) = points.iter().find(differs) {
            let at = coordinates(self.place(point.node));
            let what = format!("only one side of a tie has mass at {at}");
            let why = "the balance of nodes without mass holds at the end of a step, that of others as a mean over it";
            let help =
                "use mass = \"consistent\" for bodies whose contact sides are tied, or density > 0 for both";
            problems.push(Problem::new("tie[0].secondary", what, why, help));
        }
    }
}

/// Whether a point is carried by one node alone, itself or through other points.
fn leads_to(given: &BTreeMap<usize, Vec<(usize, f64)>>, weights: &Vec<(usize, f64)>, node: usize) -> bool {
    let mut weights = weights;
    for _ in 0..=given.len() {
        let Some((carrier, _)) = weights.iter().find(|(_, weight)| (weight - 1.0).abs() < 1e-9) else {
            return false;
        };
        if *carrier == node {
            return true;
        }
        match given.get(carrier) {
            Some(next) => weights = next,
            None => return false,
        }
    }
    true
}
