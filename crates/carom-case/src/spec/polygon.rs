//! How much of a circle lies in a polygon, estimated from points of equal shares of its area.

/// Numbers of circles and directions at which points are sampled.
const CIRCLES: usize = 12;
const DIRECTIONS: usize = 24;

/// The area of a circle that lies in a polygon.
pub fn area_within(corners: &[[f64; 2]], center: [f64; 2], radius: f64) -> f64 {
    let places = (0..CIRCLES * DIRECTIONS).map(|k| {
        let distance = radius * ((0.5 + (k / DIRECTIONS) as f64) / CIRCLES as f64).sqrt();
        let angle = std::f64::consts::TAU * (0.5 + (k % DIRECTIONS) as f64) / DIRECTIONS as f64;
        [center[0] + distance * angle.cos(), center[1] + distance * angle.sin()]
    });
    let inside = places.filter(|place| is_inside(corners, *place)).count();
    std::f64::consts::PI * radius * radius * inside as f64 / (CIRCLES * DIRECTIONS) as f64
}

/// Whether a ray from a point leaves the polygon an odd number of times.
fn is_inside(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let next = corners.iter().cycle().skip(1);
    let crosses = |(p, q): &(&[f64; 2], &[f64; 2])| {
        (p[1] > y) != (q[1] > y) && x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0])
    };
    corners.iter().zip(next).filter(crosses).count() % 2 == 1
}
