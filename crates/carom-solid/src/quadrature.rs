//! Quadrature, Σ w f(ξ) = ∫f dξ exactly for polynomials of a total degree, all weights positive.
//!
//! - Lines: Gauss–Legendre; nodes are the roots of Pₙ by Newton's method, w = 2/((1 − x²) P′ₙ(x)²),
//!   exact to degree 2n − 1.
//! - Triangles: D. A. Dunavant, "High degree efficient symmetrical Gaussian quadrature rules for
//!   the triangle", IJNME 21 (1985) 1129–1148, degrees 1, 2, 4, 6, 8 and 10 (1, 3, 6, 12, 16 and 25
//!   points), the printed digits continued by Newton's method on the moments. Odd degrees use the
//!   next even rule: Dunavant's of degrees 3 and 7 have negative weights.
//! - Tetrahedra: degree 2, 4 points (P. C. Hammer, A. H. Stroud, MTAC 10 (1956) 137–139); degrees 5
//!   and 6, 14 and 24 points (the latter by P. Keast, CMAME 55 (1986) 339–348), both computed by
//!   Newton's method on the moments; above, products of Gauss–Legendre rules on the collapsed cube
//!   (A. H. Stroud, Approximate Calculation of Multiple Integrals, 1971, §2.5).

use carom_algebra::Vector;

/// Points and weights on a reference domain; the weights sum to its measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule<const R: usize> {
    /// Reference coordinates.
    pub points: Vec<Vector<R>>,
    /// Weights.
    pub weights: Vec<f64>,
}

impl<const R: usize> Rule<R> {
    /// Points with their weights.
    pub fn iter(&self) -> impl Iterator<Item = (&Vector<R>, f64)> {
        self.points.iter().zip(self.weights.iter().copied())
    }
}

/// Gauss–Legendre rule of a degree on −1..1.
pub fn line(degree: usize) -> Rule<1> {
    let n = degree / 2 + 1;
    let mut rule = Rule { points: Vec::with_capacity(n), weights: Vec::with_capacity(n) };
    for k in 0..n {
        let mut x = -(std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..8 {
            let (p, slope) = legendre(n, x);
            x -= p / slope;
        }
        let (_, slope) = legendre(n, x);
        rule.points.push(Vector([x]));
        rule.weights.push(2.0 / ((1.0 - x * x) * slope * slope));
    }
    rule
}

/// Pₙ(x) and P′ₙ(x) by the three-term recurrence, |x| < 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let mut before = 1.0;
    let mut p = x;
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (before - x * p) / (1.0 - x * x))
}

/// A symmetric triangle rule by orbits: weight (relative to the area) of the centre; (weight, a) of
/// the three points (a, a, 1 − 2a); (weight, a, b) of the six permutations of (a, b, 1 − a − b).
struct Orbits {
    centre: &'static [f64],
    threes: &'static [(f64, f64)],
    sixes: &'static [(f64, f64, f64)],
}

const DEGREE_1: Orbits = Orbits { centre: &[1.0], threes: &[], sixes: &[] };
const DEGREE_2: Orbits = Orbits { centre: &[], threes: &[(1.0 / 3.0, 1.0 / 6.0)], sixes: &[] };
const DEGREE_4: Orbits = Orbits {
    centre: &[],
    threes: &[(0.22338158967801147, 0.4459484909159649), (0.10995174365532187, 0.09157621350977074)],
    sixes: &[],
};
const DEGREE_6: Orbits = Orbits {
    centre: &[],
    threes: &[(0.11678627572637937, 0.24928674517091043), (0.05084490637020682, 0.06308901449150223)],
    sixes: &[(0.08285107561837357, 0.3103524510337844, 0.053145049844816945)],
};
const DEGREE_8: Orbits = Orbits {
    centre: &[0.14431560767778717],
    threes: &[
        (0.10321737053471824, 0.1705693077517602),
        (0.03245849762319808, 0.05054722831703098),
        (0.09509163426728462, 0.4592925882927232),
    ],
    sixes: &[(0.027230314174434993, 0.2631128296346381, 0.008394777409957605)],
};
const DEGREE_10: Orbits = Orbits {
    centre: &[0.09081799038275358],
    threes: &[(0.036725957756466705, 0.4855776333836574), (0.04532105943552794, 0.10948157548503705)],
    sixes: &[
        (0.07275791684542011, 0.14170721941487996, 0.30793983876412095),
        (0.028327242531057485, 0.025003534762686387, 0.2466725606399027),
        (0.009421666963732823, 0.009540815400299458, 0.06680325101220026),
    ],
};

/// Rule of a degree up to 10 on the triangle (0,0) (1,0) (0,1).
///
/// # Panics
/// For a degree above 10: cells of degree 3 need no more.
pub fn triangle(degree: usize) -> Rule<2> {
    let orbits = match degree {
        0 | 1 => DEGREE_1,
        2 => DEGREE_2,
        3 | 4 => DEGREE_4,
        5 | 6 => DEGREE_6,
        7 | 8 => DEGREE_8,
        9 | 10 => DEGREE_10,
        _ => panic!("no triangle rule of degree {degree}"),
    };
    let mut rule = Rule { points: Vec::new(), weights: Vec::new() };
    let mut add = |weight: f64, points: &[[f64; 2]]| {
        rule.points.extend(points.iter().map(|p| Vector(*p)));
        rule.weights.extend(points.iter().map(|_| 0.5 * weight));
    };
    for &weight in orbits.centre {
        add(weight, &[[1.0 / 3.0; 2]]);
    }
    for &(weight, a) in orbits.threes {
        let b = 1.0 - 2.0 * a;
        add(weight, &[[a, a], [b, a], [a, b]]);
    }
    for &(weight, a, b) in orbits.sixes {
        let c = 1.0 - a - b;
        add(weight, &[[a, b], [b, c], [c, a], [b, a], [c, b], [a, c]]);
    }
    rule
}

/// Gauss–Legendre rule of a degree along every axis on the square or cube −1..1.
pub fn tensor<const R: usize>(degree: usize) -> Rule<R> {
    let along = line(degree);
    let n = along.points.len();
    let mut rule = Rule { points: Vec::new(), weights: Vec::new() };
    for code in 0..n.pow(R as u32) {
        let place = |axis: usize| code / n.pow(axis as u32) % n;
        rule.points.push(Vector(std::array::from_fn(|axis| along.points[place(axis)][0])));
        rule.weights.push((0..R).map(|axis| along.weights[place(axis)]).product());
    }
    rule
}

/// Rule of a degree on the tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1).
///
/// ```
/// let rule = carom_solid::quadrature::tetrahedron(6);
/// let moment: f64 = rule.iter().map(|(x, w)| w * x[0].powi(4) * x[1] * x[2]).sum();
/// assert!((moment - 24.0 / 362_880.0).abs() < 1e-18); // 4! 1! 1! / 9!
/// ```
pub fn tetrahedron(degree: usize) -> Rule<3> {
    let mut rule = Rule { points: Vec::new(), weights: Vec::new() };
    let mut add = |weight: f64, points: &[[f64; 3]]| {
        rule.points.extend(points.iter().map(|p| Vector(*p)));
        rule.weights.extend(points.iter().map(|_| weight / 6.0));
    };
    // The points with barycentric coordinates (a, a, a, ·), (a, a, b, b) and (a, a, b, c).
    let corner = |a: f64| {
        let b = 1.0 - 3.0 * a;
        [[a, a, a], [b, a, a], [a, b, a], [a, a, b]]
    };
    let edge = |a: f64| {
        let b = 0.5 - a;
        [[a, a, b], [a, b, a], [b, a, a], [a, b, b], [b, a, b], [b, b, a]]
    };
    let general = |a: f64, b: f64| {
        let c = 1.0 - 2.0 * a - b;
        let ends = [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]];
        let pairs = [[a, a, b], [a, a, c], [a, b, a], [a, c, a], [b, a, a], [c, a, a]];
        [ends, pairs].concat()
    };
    match degree {
        0 | 1 => add(1.0, &[[0.25; 3]]),
        2 => add(0.25, &corner((5.0 - 5.0_f64.sqrt()) / 20.0)),
        3..=5 => {
            add(0.112_687_925_718_015_85, &corner(0.310_885_919_263_300_6));
            add(0.073_493_043_116_361_95, &corner(0.092_735_250_310_891_23));
            add(0.042_546_020_777_081_47, &edge(0.045_503_704_125_649_65));
        }
        6 => {
            add(0.039_922_750_258_167_49, &corner(0.214_602_871_259_152_03));
            add(0.010_077_211_055_320_643, &corner(0.040_673_958_534_611_35));
            add(0.055_357_181_543_654_72, &corner(0.322_337_890_142_275_5));
            add(27.0 / 560.0, &general(0.063_661_001_875_017_53, 0.269_672_331_458_315_8));
        }
        _ => return collapsed(degree),
    }
    rule
}

/// The cube of Gauss–Legendre points collapsed to the tetrahedron, ξ = (u(1−v)(1−w), v(1−w), w).
/// The map raises the degree by 1 along v and 2 along w; the rules there are that much higher.
fn collapsed(degree: usize) -> Rule<3> {
    let on_unit = |degree: usize| {
        let rule = line(degree);
        rule.iter().map(|(x, weight)| (0.5 * (1.0 + x[0]), 0.5 * weight)).collect::<Vec<_>>()
    };
    let along_u = on_unit(degree);
    let along_v = on_unit(degree + 1);
    let along_w = on_unit(degree + 2);
    let mut rule = Rule { points: Vec::new(), weights: Vec::new() };
    for &(w, weight_w) in &along_w {
        for &(v, weight_v) in &along_v {
            for &(u, weight_u) in &along_u {
                rule.points.push(Vector([u * (1.0 - v) * (1.0 - w), v * (1.0 - w), w]));
                rule.weights.push(weight_u * weight_v * weight_w * (1.0 - v) * (1.0 - w).powi(2));
            }
        }
    }
    rule
}
