//! Drawing of the initial configuration: bodies with their mesh; sides in contact, supported and
//! loaded sides in colours; symbols of what is fixed and of what acts. In the plane, which is seen
//! from in front, and in space. The table beside it is in [`table`].

mod table;

use std::collections::HashMap;
use std::fmt::Write as _;

use carom_case::{BodySpec, Case, FormulaSpec, LoadKind, LoadSpec, SupportSpec, load_variables};
use carom_record::{Block, Cell, FieldSet};

use crate::again::{again, once};
use crate::axis::round_step;
use crate::bodies::{self, Instant, bezier, corners, edge_nodes, edges, fill_space, places};
use crate::chart::{WIDTH, opened, write_text};
use crate::figure::{Figure, NARROW};
use crate::labels::{capitalised, listed};
use crate::obstacles::{self, Walk};
use crate::palette::LINES;
use crate::pen::{GRID, NOTHING, Pen, Point, around, path, polyline};
use crate::place::{BODIES, fill};
use crate::recorded::Recorded;
use crate::space::{self, Facet, Paint, Place, View, cross, dot, length, minus};
use crate::symbols::{arrow, direction, plus, probe_mark, scale_bar, wall};
use crate::text;
pub(crate) use table::table;

/// Room around the bodies, and below them for axes and scale, in pixels.
const MARGIN: f64 = 48.0;
const FOOT: f64 = 64.0;
/// Largest height of the bodies in pixels, and height of a bar relative to its length.
const HIGH: f64 = 420.0;
const BAR: f64 = 0.04;
/// Length of an arrow and of the triangle of a fixed direction.
const ARROW: f64 = 26.0;
const TRIANGLE: f64 = 10.0;
/// Most symbols on a side.
const SYMBOLS: usize = 16;
/// Size and style of letters, which stand out from what they cover.
const LETTERS: f64 = 14.0;
const HALO: &str = "font-size=\"14\" stroke=\"#fff\" stroke-width=\"4\" paint-order=\"stroke\" \
    stroke-linejoin=\"round\" text-anchor=\"middle\"";
const SLANTED: &str = "font-style=\"italic\"";
/// The view of the plane.
const FRONT: View = View { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

/// The part that a side has in a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Supported,
    Loaded,
    Tied,
    Primary,
    Secondary,
}

impl Part {
    /// Colour of its line and symbols.
    pub(crate) fn line(self) -> &'static str {
        match self {
            Self::Supported => "#44607c",
            Self::Loaded => "#7a2f8f",
            Self::Tied => "#3f7d3a",
            Self::Primary => LINES[1],
            Self::Secondary => LINES[2],
        }
    }

    /// Colour of its faces in space.
    fn tint(self) -> &'static str {
        match self {
            Self::Supported => "#b7c6d4",
            Self::Loaded => "#d5bcdc",
            Self::Tied => "#b9d8b4",
            Self::Primary => "#a9cfe8",
            Self::Secondary => "#f2c6a4",
        }
    }
}

/// Sides with their parts, in the order in which they are drawn.
fn parts(case: &Case) -> Vec<(Part, &str)> {
    let supported = case.supports.iter().flat_map(|support| &support.on);
    let loaded = case.loads.iter().flat_map(LoadSpec::sides);
    let primary = case.contacts.iter().filter_map(|contact| contact.primary.side());
    let secondary = case.contacts.iter().map(|contact| contact.secondary.as_str());
    let tied = case.ties.iter().flat_map(|tie| [tie.primary.as_str(), tie.secondary.as_str()]);
    let tied = tied.map(|side| (Part::Tied, side));
    let supported = supported.map(|side| (Part::Supported, side.as_str()));
    let loaded = loaded.map(|side| (Part::Loaded, side.as_str()));
    let contact =
        primary.map(|side| (Part::Primary, side)).chain(secondary.map(|side| (Part::Secondary, side)));
    supported.chain(loaded).chain(tied).chain(contact).collect()
}

/// The figure with its table; nothing without cells.
pub(crate) fn figure(run: &Recorded, fields: &FieldSet) -> Option<Figure> {
    let [broad, narrow] = [WIDTH, NARROW].map(|width| Drawing::new(run, fields, width));
    let (broad, narrow) = broad.zip(narrow)?;
    let pictures = [broad.drawn(WIDTH, None), narrow.drawn(NARROW, Some(broad.rectangle()))];
    let view = if broad.is_solid {
        format!(" View: {}; dashed: turned away.", View::words())
    } else {
        String::new()
    };
    let caption = format!("Initial configuration.{}{view}", symbols(&run.case));
    let mut figure = Figure::new("setup", caption, pictures);
    figure.key = table(&run.case, Some(fields));
    Some(figure)
}

/// The sentence of the caption on the symbols that the case has.
fn symbols(case: &Case) -> String {
    let is_any = |formulas: &dyn Fn(&BodySpec) -> &[FormulaSpec]| {
        case.bodies.iter().any(|body| !formulas(body).iter().all(FormulaSpec::is_zero))
    };
    let arrows = [
        (!case.loads.is_empty(), "loads"),
        (is_any(&|body| &body.gravity), "gravity g"),
        (is_any(&|body| &body.velocity), "initial velocity v_{0}"),
    ];
    let arrows: Vec<&str> = arrows.into_iter().filter(|(has, _)| *has).map(|(_, what)| what).collect();
    let all = [
        (
            case.supports.iter().any(|s| s.normal || !s.fix.is_empty()),
            "triangles: fixed directions".to_owned(),
        ),
        (case.supports.iter().any(|s| !s.moves.is_empty()), "double arrows: prescribed motion".to_owned()),
        (!arrows.is_empty(), format!("arrows: {}", listed(&arrows))),
        (!case.probes.is_empty(), "diamonds: probes".to_owned()),
    ];
    let all: Vec<String> = all.into_iter().filter(|(has, _)| *has).map(|(_, words)| words).collect();
    if all.is_empty() { String::new() } else { format!(" {}.", capitalised(&all.join("; "))) }
}

/// The middle of a facet of a side.
struct Spot {
    at: Place,
    /// Outward unit normal.
    normal: Place,
    is_seen: bool,
}

/// A side of a body.
#[derive(Default)]
struct Side {
    spots: Vec<Spot>,
    /// Nodes of the edges of its outline, or in the plane of all its edges, and whether each is
    /// seen.
    edges: Vec<(Vec<Place>, bool)>,
}

impl Side {
    /// Some of its places: those that are seen, unless it is turned away.
    fn spots(&self) -> impl Iterator<Item = &Spot> {
        let is_any_seen = self.spots.iter().any(|spot| spot.is_seen);
        let shown: Vec<&Spot> = self.spots.iter().filter(|spot| spot.is_seen || !is_any_seen).collect();
        let every = shown.len().div_ceil(SYMBOLS).max(1);
        shown.into_iter().skip((every - 1) / 2).step_by(every)
    }
}

/// Labels with the places where they should be.
#[derive(Default)]
struct Labels(Vec<(Point, &'static str, String)>);

impl Labels {
    fn add(&mut self, at: Point, style: &'static str, label: &str) {
        self.0.push((at, style, label.to_owned()));
    }

    /// Draws them, each as near to its place as it covers no earlier one.
    fn draw(&self, out: &mut String, width: f64) {
        let mut taken: Vec<[f64; 4]> = Vec::new();
        for (at, style, label) in &self.0 {
            let half = 0.5 * LETTERS * text::width(label) + 2.0;
            let x = at[0].clamp(half, (width - half).max(half));
            let rectangle = |by: f64| [x - half, x + half, at[1] + by - LETTERS, at[1] + by + 4.0];
            let is_free = |by: &f64| {
                let [left, right, top, bottom] = rectangle(*by);
                !taken.iter().any(|t| t[0] < right && left < t[1] && t[2] < bottom && top < t[3])
            };
            let near = (0..12).map(|k| f64::from(k / 2 + k % 2) * if k % 2 == 0 { 18.0 } else { -18.0 });
            let by = near.into_iter().find(is_free).unwrap_or(0.0);
            write_text(out, x, at[1] + by, &format!("{HALO} {style}"), label);
            taken.push(rectangle(by));
        }
    }
}

/// A case and its mapping to the page.
struct Drawing<'a> {
    run: &'a Recorded,
    fields: &'a FieldSet,
    /// Current positions of the points of `fields`.
    places: Vec<Place>,
    view: View,
    is_solid: bool,
    /// Left, right, bottom and top on the page in units of length.
    frame: [f64; 4],
    /// Half the height of a bar.
    half: f64,
    scale: f64,
    /// Left and top of the frame in pixels.
    corner: Point,
    walls: Vec<Walk>,
    wires: Vec<[Place; 2]>,
}

impl<'a> Drawing<'a> {
    fn new(run: &'a Recorded, fields: &'a FieldSet, width: f64) -> Option<Self> {
        let is_solid = fill_space(fields);
        let view = if is_solid { View::axonometric() } else { FRONT };
        let places: Vec<Place> = places(fields);
        let used = || fields.blocks.iter().flat_map(|block| &block.connectivity).map(|&k| places[k]);
        let mut bodies = around(NOTHING, used().map(|place| view.on_page(place)));
        let half = 0.5 * BAR * (bodies[1] - bodies[0]);
        if fields.blocks.iter().all(|block| block.cell == Cell::Curve) {
            bodies = [bodies[0], bodies[1], -half, half];
        }
        let mut frame = bodies;
        let mut walls = Vec::new();
        let mut wires = Vec::new();
        if is_solid {
            let obstacles = space::wires(run, space::box_around(used()));
            wires = obstacles.iter().flat_map(|wire| wire.at_first().to_vec()).collect();
            frame = around(frame, wires.iter().flatten().map(|place| view.on_page(*place)));
        } else {
            for obstacle in obstacles::all(run, bodies) {
                let walk = obstacle.at(run, 0.0);
                frame = obstacle.shown_in(&walk, frame, bodies);
                // The point of a plane that is nearest to the bodies.
                let middle = walk.get(walk.len() / 2).filter(|_| obstacle.is_plane);
                frame = around(frame, middle.map(|(point, _)| *point));
                walls.push(walk);
            }
        }
        let [x0, x1, y0, y1] = frame;
        let scale = ((width - 2.0 * MARGIN) / (x1 - x0)).min(HIGH / (y1 - y0));
        if !(x1 > x0 && scale > 0.0 && scale.is_finite()) {
            return None;
        }
        let air = 0.5 * MARGIN / scale;
        let shown = [x0 - air, x1 + air, y0 - air, y1 + air];
        let walls = walls.iter().flat_map(|walk| obstacles::clipped(walk, shown)).collect();
        let corner = [0.5 * (width - (x1 - x0) * scale), MARGIN];
        Some(Self { run, fields, places, view, is_solid, frame, half, scale, corner, walls, wires })
    }

    /// The rectangle of the frame in pixels.
    fn rectangle(&self) -> [f64; 4] {
        let [x0, x1, y0, y1] = self.frame;
        [self.corner[0], self.corner[1], (x1 - x0) * self.scale, (y1 - y0) * self.scale]
    }

    /// The pixel of a point of the view.
    fn pixel(&self, [x, y]: Point) -> Point {
        [self.corner[0] + (x - self.frame[0]) * self.scale, self.corner[1] + (self.frame[3] - y) * self.scale]
    }

    fn to(&self, place: Place) -> Point {
        self.pixel(self.view.on_page(place))
    }

    /// Unit vector of the page along a vector; zero along the line of sight.
    fn along(&self, vector: Place) -> Point {
        let [x, y] = self.view.on_page(vector);
        if x.hypot(y) < 0.2 * length(vector) { [0.0; 2] } else { direction([0.0; 2], [x, -y]) }
    }

    /// The drawing; the image of bodies in space is that of the broad picture if its place is
    /// given.
    fn drawn(&self, width: f64, broad: Option<[f64; 4]>) -> String {
        let case = &self.run.case;
        let place = self.rectangle();
        let bottom = place[1] + place[3] + MARGIN;
        // In the plane there are no shades: a dark page shows it on dark ground.
        let class = if self.is_solid { "picture" } else { "picture sketch" };
        let mut out = opened(class, "Initial configuration", width, bottom + FOOT);
        space::underlay(&mut out, &self.wires, &self.view, &|point| self.pixel(point));
        match (self.is_solid, broad) {
            (true, Some(broad)) => again(&mut out, "setup-bodies", broad, place),
            (true, None) => once(&mut out, "setup-bodies", "picture", &self.solids()),
            (false, _) => self.meshes(&mut out),
        }
        for walk in &self.walls {
            let line: Vec<_> = walk.iter().map(|&(p, n)| (self.pixel(p), [-n[0], n[1]])).collect();
            wall(&mut out, &line, 0.0);
        }
        for (part, name) in parts(case) {
            self.outline(&mut out, part, &self.side(name));
        }
        let mut labels = Labels::default();
        case.supports.iter().for_each(|support| self.support(&mut out, support));
        case.loads.iter().for_each(|load| self.load(&mut out, load, &mut labels));
        self.probes(&mut out, &mut labels);
        self.bodies(&mut out, &mut labels);
        labels.draw(&mut out, width);
        self.view.triad(&mut out, [36.0, bottom + 28.0], 28.0);
        let bar = round_step(self.frame[1] - self.frame[0], 3.0);
        scale_bar(&mut out, [110.0, bottom + 26.0], bar * self.scale, (bar, &case.units.length));
        out.push_str("</svg>\n");
        out
    }

    /// Bodies in the plane and on a line, with their cells.
    fn meshes(&self, out: &mut String) {
        for (k, block) in self.fields.blocks.iter().enumerate() {
            let mut cells = Pen::default();
            let [mut inside, mut outline] = [Pen::default(), Pen::default()];
            if block.cell == Cell::Curve {
                for cell in block.cells() {
                    let [a, b] = [cell[0], cell[1]].map(|node| self.places[node][0]);
                    let corners = [[a, -self.half], [b, -self.half], [b, self.half], [a, self.half]];
                    cells.polygon(&corners.map(|corner| self.pixel(corner)));
                    inside.polygon(&corners.map(|corner| self.pixel(corner)));
                }
            } else {
                let instant = Instant::of_block(self.fields, block);
                [inside, outline] = edges(&instant, &|point| self.pixel(point));
                for (degree, nodes) in &instant.cells {
                    bodies::outline(&mut cells, *degree, nodes, &|node| self.to(self.places[node]));
                }
            }
            let fill = fill(k);
            path(out, &cells, &format!("fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"10\""));
            path(out, &inside, "fill=\"none\" stroke=\"#98a2ad\" stroke-width=\"11\"");
            path(out, &outline, "fill=\"none\" stroke=\"#222\" stroke-width=\"24\" stroke-linecap=\"round\"");
        }
    }

    /// The image of bodies in space, on which sides have the tint of their part.
    fn solids(&self) -> String {
        let mut colors: Vec<&str> = BODIES.to_vec();
        let mut of_face: HashMap<Vec<usize>, usize> = HashMap::new();
        for (part, name) in parts(&self.run.case) {
            let faces = self.run.manifest.sides.get(name).into_iter().flatten();
            of_face.extend(faces.map(|nodes| (space::corners(nodes), colors.len())));
            colors.push(part.tint());
        }
        let skin = space::skin(self.fields);
        let color = |facet: &Facet, _| {
            of_face.get(&facet.face).map_or((facet.block % BODIES.len()) as f64, |color| *color as f64)
        };
        let to = |point: Point| self.pixel(point);
        let pieces = space::pieces(&skin, &self.places, &color, &self.view, &to, self.scale);
        space::image(&pieces, &Paint::Parts(&colors), self.rectangle())
    }

    /// The block of a body.
    fn block(&self, body: &str) -> Option<&Block> {
        self.fields.blocks.iter().find(|block| block.body == body)
    }

    /// A side, whose facets have the body on their left or are counterclockwise seen from outside.
    fn side(&self, name: &str) -> Side {
        let mut side = Side::default();
        let Some(block) = name.split_once('.').and_then(|(body, _)| self.block(body)) else { return side };
        let mut found: Vec<([usize; 2], Vec<Place>, bool)> = Vec::new();
        let places = |nodes: &[usize]| -> Vec<Place> { nodes.iter().map(|&k| self.places[k]).collect() };
        for nodes in self.run.manifest.sides.get(name).into_iter().flatten() {
            if self.is_solid {
                let corner = places(&nodes[..corners(nodes)]);
                let normal = cross(minus(corner[1], corner[0]), minus(corner[corner.len() - 1], corner[0]));
                let normal = normal.map(|x| x / length(normal));
                let is_seen = self.view.of(normal)[2] > 1e-9;
                side.spots.push(Spot { at: mean(&corner), normal, is_seen });
                for e in 0..corner.len() {
                    let edge: Vec<usize> = edge_nodes(block.degree, nodes, e).collect();
                    let ends = [edge[0], edge[edge.len() - 1]];
                    found.push(([ends[0].min(ends[1]), ends[0].max(ends[1])], places(&edge), is_seen));
                }
            } else if let [node] = nodes[..] {
                let at = self.places[node];
                let normal = [(at[0] - self.middle(block)[0]).signum(), 0.0, 0.0];
                side.spots.push(Spot { at, normal, is_seen: true });
                found.push(([node; 2], [-self.half, self.half].map(|y| [at[0], y, 0.0]).to_vec(), true));
            } else {
                for edge in nodes.windows(block.degree + 1).step_by(block.degree) {
                    let along = minus(self.places[edge[block.degree]], self.places[edge[0]]);
                    let normal = [along[1], -along[0], 0.0].map(|x| x / length(along));
                    let middle = [edge[block.degree / 2], edge[block.degree.div_ceil(2)]];
                    side.spots.push(Spot { at: mean(&places(&middle)), normal, is_seen: true });
                    found.push(([edge[0], edge[block.degree]], places(edge), true));
                }
            }
        }
        // An edge of two facets in space is within the side.
        let mut count: HashMap<[usize; 2], usize> = HashMap::new();
        found.iter().for_each(|(ends, ..)| *count.entry(*ends).or_default() += 1);
        found.retain(|(ends, ..)| count[ends] == 1);
        side.edges = found.into_iter().map(|(_, edge, is_seen)| (edge, is_seen)).collect();
        side
    }

    /// The outline of a side in the colour of its part, dashed where it is turned away.
    fn outline(&self, out: &mut String, part: Part, side: &Side) {
        // Both sides of a body in contact with itself are seen.
        let width = if part == Part::Primary { 4.6 } else { 2.6 };
        for (is_seen, width, dashes) in [(true, width, ""), (false, 1.2, " stroke-dasharray=\"80 60\"")] {
            let mut pen = Pen::default();
            for (edge, _) in side.edges.iter().filter(|(_, seen)| *seen == is_seen) {
                bezier(&mut pen, &edge.iter().map(|place| self.to(*place)).collect::<Vec<_>>(), true);
            }
            if !pen.is_empty() {
                let line = format!("stroke=\"{}\" stroke-width=\"{}\"", part.line(), width * GRID);
                path(out, &pen, &format!("fill=\"none\" {line} stroke-linecap=\"round\"{dashes}"));
            }
        }
    }

    /// A triangle for each fixed direction, a double arrow for each prescribed one.
    fn support(&self, out: &mut String, support: &SupportSpec) {
        let axis = |axis: usize| [0, 1, 2].map(|i| if i == axis { 1.0 } else { 0.0 });
        for side in support.on.iter().map(|name| self.side(name)) {
            for spot in side.spots() {
                for i in &support.fix {
                    self.triangle(out, spot, axis(*i));
                }
                if support.normal {
                    self.triangle(out, spot, spot.normal);
                }
                for (i, _) in &support.moves {
                    let at = plus(self.to(spot.at), 8.0, self.along(spot.normal));
                    for by in [14.0, -14.0] {
                        arrow(out, at, plus(at, by, self.along(axis(*i))), Part::Supported.line());
                    }
                }
            }
        }
    }

    /// A triangle along a fixed direction, outside the body.
    fn triangle(&self, out: &mut String, spot: &Spot, fixed: Place) {
        let outwards = dot(spot.normal, fixed);
        let aside = if outwards.abs() < 0.3 { 0.6 * TRIANGLE } else { 0.0 };
        let tip = plus(self.to(spot.at), aside, self.along(spot.normal));
        let along = self.along(fixed);
        let foot = plus(tip, if outwards < 0.0 { -TRIANGLE } else { TRIANGLE }, along);
        let [a, b] = [0.45, -0.45].map(|s| plus(foot, s * TRIANGLE, [-along[1], along[0]]));
        let style = format!("fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.8\"", Part::Supported.line());
        let _ = writeln!(out, "<path d=\"{}z\" {style}/>", polyline(&[tip, a, b]));
    }

    /// The values of formulas at a place, at the last of some instants when they are not all zero.
    fn values(&self, formulas: &[FormulaSpec], place: Place) -> Place {
        let dimension = self.run.case.dimension.min(3);
        let names = load_variables(dimension);
        let at = |share: f64| {
            let variables = [&place[..dimension], &[share * self.run.case.time.end]].concat();
            let value = |given: &FormulaSpec| given.formula(&names).map_or(0.0, |f| f.value(&variables));
            [0, 1, 2].map(|i| formulas.get(i).map_or(0.0, value))
        };
        let is_drawn = |v: &Place| *v != [0.0; 3] && v.iter().all(|x| x.is_finite());
        [1.0, 0.75, 0.5, 0.25, 0.125, 0.03, 0.0].map(at).into_iter().find(is_drawn).unwrap_or_default()
    }

    /// Arrows of a load on sides or in a body.
    fn load(&self, out: &mut String, load: &LoadSpec, labels: &mut Labels) {
        let color = Part::Loaded.line();
        let of_spot = |spot: &Spot| match &load.kind {
            LoadKind::Pressure { value, .. } => {
                let [pressure, ..] = self.values(std::slice::from_ref(value), spot.at);
                spot.normal.map(|x| -x * pressure)
            }
            LoadKind::Traction { value, .. } | LoadKind::BodyForce { value, .. } => {
                self.values(value, spot.at)
            }
        };
        if let LoadKind::BodyForce { body, value, .. } = &load.kind
            && let Some(block) = self.block(body)
        {
            let middle = self.middle(block);
            let end = self.vector(out, [middle, self.values(value, middle)], 0.0, color);
            end.into_iter().for_each(|end| labels.add(end, SLANTED, "b"));
        }
        for side in load.sides().iter().map(|name| self.side(name)) {
            for spot in side.spots() {
                let towards = of_spot(spot);
                let along = self.along(towards);
                // A compressive load ends at the side, a tensile one begins there.
                let ends = if dot(towards, spot.normal) < 0.0 { [-ARROW, 0.0] } else { [0.0, ARROW] };
                let [from, to] = ends.map(|by| plus(self.to(spot.at), by, along));
                if from != to {
                    arrow(out, from, to, color);
                }
            }
        }
    }

    /// Draws an arrow from a place along a vector, moved aside by some pixels, and returns the
    /// place of its label; nothing for zero.
    fn vector(&self, out: &mut String, [from, vector]: [Place; 2], aside: f64, color: &str) -> Option<Point> {
        let along = self.along(vector);
        let from = plus(plus(self.to(from), 8.0, along), aside, [-along[1], along[0]]);
        let end = plus(from, 1.4 * ARROW, along);
        (from != end).then(|| {
            arrow(out, from, end, color);
            plus(plus(end, 11.0, along), 4.0, [0.0, 1.0])
        })
    }

    /// The mean of the nodes of a body.
    fn middle(&self, block: &Block) -> Place {
        mean(&block.connectivity.iter().map(|&k| self.places[k]).collect::<Vec<_>>())
    }

    /// Names of bodies, gravity and initial velocities.
    fn bodies(&self, out: &mut String, labels: &mut Labels) {
        for body in &self.run.case.bodies {
            let Some(block) = self.block(&body.name) else { continue };
            let middle = self.middle(block);
            labels.add(plus(self.to(middle), -8.0, [0.0, 1.0]), "", &body.name);
            for (values, aside, symbol) in [(&body.gravity, 10.0, "g"), (&body.velocity, -10.0, "v_{0}")] {
                let end = self.vector(out, [middle, self.values(values, middle)], aside, "#222");
                end.into_iter().for_each(|end| labels.add(end, SLANTED, symbol));
            }
        }
    }

    fn probes(&self, out: &mut String, labels: &mut Labels) {
        for probe in &self.run.case.probes {
            let at: Place = std::array::from_fn(|i| probe.at.get(i).copied().unwrap_or(0.0));
            let distance = |point: &Place| length(minus(*point, at));
            let points = self.fields.points.iter().zip(&self.places);
            let near = points.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
            // Moved like the nearest node.
            let Some((from, to)) = near else { continue };
            let [x, y] = self.to([0, 1, 2].map(|i| at[i] + to[i] - from[i]));
            out.push_str(&probe_mark([x, y]));
            labels.add([x + 10.0, y - 8.0], "font-weight=\"bold\"", &probe.name);
        }
    }
}

fn mean(places: &[Place]) -> Place {
    [0, 1, 2].map(|i| places.iter().map(|place| place[i]).sum::<f64>() / places.len() as f64)
}
