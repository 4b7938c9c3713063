//! Orders of convergence in time and space, stated as data.
//!
//! The scene is smooth, as an order needs it: a line hanging free (no bed, no surface), taut at all times, damped in its length, its
//! fairlead moved along t⁵(T - t)⁵, so that position, velocity and acceleration start and end at rest without a jump.

mod support;

use moorline::rod::physics::Surroundings;
use moorline::rod::properties::Properties;
use moorline::rod::state::{Field, State};
use moorline::scene::types::Scheme;
use moorline::solve::motion::Path;
use moorline::solve::newton::motion;
use nalgebra::Vector3;
use support::*;

/// Duration of the motion [s].
const DURATION: f64 = 8.0;
/// The instant at which errors are taken [s], in full motion.
const UNTIL: f64 = 4.8;
/// Fairlead at rest [m].
const FAIRLEAD: [f64; 3] = [80.0, 0.0, 60.0];

/// A line of 120 m between points 100 m apart, in still water.
fn hanging(elements: usize) -> Rig {
    let properties = Properties {
        damping: 0.05,
        drag_normal: 0.5 * 1000.0 * 0.05,
        added_normal: 6.0,
        drag_tangential: 2.0,
        ..material(2.0e6, 20.0, 150.0)
    };
    let mesh = uniform(properties, 120.0, elements);
    let last = mesh.nodes() - 1;
    let around = Surroundings { current: None, ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    rig.hang(Vector3::zeros(), FAIRLEAD.into());
    rig
}

/// `amplitude` (2/T)¹⁰ t⁵ (T - t)⁵ along (1, 2, 1).
fn path(amplitude: f64) -> Path {
    let binomial = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    let direction = Vector3::new(1.0, 2.0, 1.0) * amplitude * (2.0 / DURATION).powi(10);
    let mut coefficients = vec![Vector3::zeros(); 11];
    coefficients[0] = FAIRLEAD.into();
    for (k, b) in binomial.into_iter().enumerate() {
        coefficients[5 + k] = direction * (b * DURATION.powi(5 - k as i32) * (-1.0f64).powi(k as i32));
    }
    Path::Polynomial { start: 0.0, coefficients }
}

/// State and fairlead force at the instant.
fn run(scheme: Scheme, elements: usize, step: f64) -> (State, Vector3<f64>) {
    let mut rig = hanging(elements);
    let cut = rig.run(scheme, &path(1.0), step, UNTIL, |_, _, _| ());
    assert_eq!(cut, 0, "a step was cut");
    let force = rig.line.end_force(&motion(&rig.state));
    (rig.state, force)
}

/// Largest distance between the nodes of two states [m].
fn distance(a: &Field, b: &Field) -> f64 {
    (0..a.nodes()).map(|node| (a.position(node) - b.position(node)).norm()).fold(0.0, f64::max)
}

/// Scheme, longest step [s], order wanted, and how far from it the measured one may be (below; above).
const TIME_ORDERS: [(Scheme, f64, f64, f64, f64); 3] = [
    (Scheme::AdamsMoulton, 0.1, 2.0, 0.1, 0.1),
    (Scheme::GeneralizedAlpha, 0.1, 2.0, 0.1, 0.1),
    (Scheme::Esdirk3, 0.2, 2.5, 0.0, 1.0),
];

/// Source: the theory of each scheme. Mean order of the places over four halvings of the step, against another scheme at a step 16 times
/// smaller than the smallest. Measured 2.00 (adams-moulton and generalized-alpha) and 2.59 (esdirk3: 3.0, 3.0, 1.6, 2.8, reduced by the stiff
/// axial waves, as for every method of low stage order).
#[test]
fn every_scheme_has_its_order_in_time() {
    for (scheme, longest, wanted, below, above) in TIME_ORDERS {
        let other = if scheme == Scheme::Esdirk3 { Scheme::AdamsMoulton } else { Scheme::Esdirk3 };
        let exact = run(other, 8, longest / 256.0).0;
        let errors: Vec<f64> = (0..5).map(|k| distance(&run(scheme, 8, longest / f64::from(1 << k)).0.u, &exact.u)).collect();
        let order = (errors[0] / errors[4]).log2() / 4.0;
        println!("{scheme:?}: order {order:.3}, errors {errors:?}");
        assert!(order > wanted - below && order < wanted + above, "{scheme:?}: order {order}, errors {errors:?}");
    }
}

/// Numbers of elements, and the least order wanted of the fairlead force in the element length.
const SPACE_ORDER: (&[usize], f64) = (&[4, 8, 16], 3.5);

/// Source: the theory of cubic Hermite elements (order 4 of the place); the reference has 64 elements. Measured 4.2 and
/// 5.8 in the fairlead force.
#[test]
fn moving_line_converges_in_space() {
    let (elements, wanted) = SPACE_ORDER;
    let exact = run(Scheme::Esdirk3, 64, 0.02).1;
    let errors: Vec<f64> = elements.iter().map(|n| (run(Scheme::Esdirk3, *n, 0.02).1 - exact).norm() / exact.norm()).collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        println!("order {order:.2}");
        assert!(order > wanted, "order {order}, errors {errors:?}");
    }
}
