//! Friction, slope and damping of the bed against closed forms.

mod support;

use moorline::rod::element::{Table, scatter_to_nodes};
use moorline::rod::friction::Friction;
use moorline::rod::line::Supports;
use moorline::rod::mesh::Mesh;
use moorline::rod::motion::Motion;
use moorline::rod::physics::{self, Surroundings};
use moorline::rod::properties::Properties;
use moorline::rod::seabed::{Plane, Resistance};
use moorline::rod::state::Field;
use moorline::rod::touching::Ground;
use moorline::scene::read::{self, Loaded};
use moorline::scene::types::Scheme;
use moorline::sea::clock::Clock;
use moorline::solve::motion::Path;
use moorline::solve::simulation::Simulation;
use moorline::solve::snapshot::Snapshot;
use nalgebra::Vector3;
use serde_json::json;
use support::*;

const WEIGHT: f64 = 1157.1590775;
const EA: f64 = 5.0e8;

fn built_in(sets: &[String]) -> Loaded {
    read::built_in(sets).unwrap_or_else(|error| panic!("{error}"))
}

fn settled(loaded: &Loaded) -> Simulation {
    let mut simulation = Simulation::new(&loaded.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    simulation.settle(loaded.scene.lines[0].fairlead.into(), 0.0).unwrap_or_else(|error| panic!("{error}"));
    simulation
}

/// Tension at the fairlead and at the anchor, and length on the bed, of the built-in chain on a rigid bed with friction: elastic catenary
/// (Irvine 1981), and on the bed H falling by μ w per metre until nothing is left (Jonkman 2007).
fn catenary_with_friction(mu: f64) -> [f64; 3] {
    let (length, distance, depth) = (1200.0, 1183.97, 120.0);
    let lift = |h: f64| bisect(0.0, 1e7, |v| v * v / (2.0 * WEIGHT * EA) + (h.hypot(v) - h) / WEIGHT - depth);
    let on_bed = |h: f64| length - lift(h) / WEIGHT;
    let reach = |h: f64| {
        let taut = on_bed(h).min(h / (mu * WEIGHT));
        let stretch = (h * taut - 0.5 * mu * WEIGHT * taut * taut) / EA;
        h / EA * lift(h) / WEIGHT + h / WEIGHT * (lift(h) / h).asinh() + on_bed(h) + stretch
    };
    let h = bisect(1e4, 1e7, |h| reach(h) - distance);
    [h.hypot(lift(h)), (h - mu * WEIGHT * on_bed(h)).max(0.0), on_bed(h)]
}

/// Source: closed form above. The bed is 1000 times stiffer than the built-in one (5e6 Pa), 100 elements. Measured: end tension 1.2e-5; anchor
/// tension 1.4e-5 of the end tension where it is not zero, and less than 1e-6 of it where the friction takes all; length on the bed 3e-3, a sixth
/// of an element, where the mesh cannot resolve the touchdown of a stiff bed.
#[test]
fn friction_takes_its_share_of_the_tension_for_every_metre_on_the_bed() {
    for mu in [0.3, 1.0, 2.0, 5.0] {
        let simulation = settled(&built_in(&[
            format!("environment.seabed.friction={mu}"),
            "environment.seabed.stiffness=5.0752591e6".into(),
            "lines[0].sections[0].elements=100".into(),
        ]));
        let (found, [tension, anchor, on_bed]) = (simulation.outputs(), catenary_with_friction(mu));
        assert_close(&format!("end tension, μ = {mu}"), found.tension, tension, 1e-4);
        assert_small("anchor tension over end tension", (found.anchor_tension - anchor) / tension, 1e-4);
        assert_close("length on the bed", found.grounded_length, on_bed, 6e-3);
    }
}

/// Source: balance of forces along a bed that rises by 8° towards the fairlead, or falls: the tension changes by w (sin a ± μ cos a)
/// per metre; both ends on the bed. Pulled from below as from above, μ = 0.5. The whole line is about to slide,
/// so nothing is left to the mesh; measured 4e-12.
#[test]
fn on_a_slope_weight_and_friction_add_up() {
    for slope in [8.0, -8.0] {
        let (sine, cosine) = f64::to_radians(slope).sin_cos();
        let end = 501.5;
        let simulation = settled(&built_in(&[
            "motion={\"kind\":\"fixed\"}".into(),
            format!("environment.seabed={}", json!({"friction": 0.5, "slope_deg": [slope, 0.0]})),
            format!("lines[0].anchor={}", json!([0.0, 0.0, -120.0 + 1e-12])),
            format!("lines[0].fairlead={}", json!([end * cosine, 0.0, -120.0 + end * sine + 1e-12])),
            "lines[0].sections[0].length=500".into(),
            "lines[0].sections[0].elements=25".into(),
        ]));
        let found = simulation.outputs();
        let exact = 500.0 * WEIGHT * (sine + 0.5 * cosine);
        assert_close(&format!("change of tension at {slope}°"), found.tension - found.anchor_tension, exact, 1e-10);
        assert_close("length on the bed", found.grounded_length, 500.0, 1e-9);
    }
}

/// A line at rest stays at rest: with the fairlead still for a minute, the built-in chain with all its friction in use keeps its tensions.
/// Without the spring the anchor tension would be that of a line without friction in the end.
/// Measured: 2e-12 of the end tension, with every scheme; 1e-10 is a thousandth of what statics leaves unbalanced.
#[test]
fn a_line_at_rest_does_not_creep() {
    for scheme in ["adams-moulton", "esdirk3", "generalized-alpha"] {
        let loaded = built_in(&[
            "environment.seabed.friction=1".into(),
            "motion={\"kind\":\"fixed\"}".into(),
            format!("solver.scheme={scheme}"),
        ]);
        let mut simulation = settled(&loaded);
        let (before, path) = (simulation.outputs(), Path::of_scene(&loaded, 0));
        for k in 1..=60 {
            simulation.advance(k as f64, &path).unwrap_or_else(|error| panic!("{error}"));
            let now = simulation.outputs();
            assert_small("change of the anchor tension", (now.anchor_tension - before.anchor_tension) / before.tension, 1e-10);
            assert_small("change of the end tension", now.tension / before.tension - 1.0, 1e-10);
        }
    }
}

/// Source: a line thrown along the bed, lengthwise, sideways or askew, is slowed down by a = 1.01 μ w/m (bound in time): x = v t - a t²/2,
/// which the end is made to do as well; the line is so soft (1 kN) that the end has no say in the rest. Allowed is the distance d/10
/// within which the friction comes up (measured: 0.1 to 6.9 mm, by how the steps of 2 ms fall into it).
#[test]
fn a_line_thrown_along_the_bed_is_slowed_down_by_friction() {
    let (speed, slowing) = (2.0, 1.01 * 0.5 * WEIGHT / 135.35);
    for direction in [Vector3::x(), Vector3::y(), Vector3::new(0.6, 0.8, 0.0)] {
        let mesh = uniform(Properties { ea: 1.0e3, ..chain() }, 50.0, 5);
        let mut ground = bed(&mesh, 0.0, 1.0e5, WEIGHT / 1.0e5);
        ground.friction = Some(Friction::new(0.5, &ground.plane, &mesh));
        let mut rig = on_a_line_along_x(mesh, ground, Holding::none());
        for node in 0..=rig.last() {
            rig.state.v.set_position(node, &(direction * speed));
        }
        let end = rig.state.u.position(rig.last());
        let path = Path::Polynomial { start: 0.0, coefficients: vec![end, direction * speed, direction * (-0.5 * slowing)] };
        let time = 0.9 * speed / slowing;
        rig.run(Scheme::AdamsMoulton, &path, 0.002, time, |_, _, _| ());
        let exact = speed * time - 0.5 * slowing * time * time;
        for node in 0..=rig.last() {
            let start = Vector3::new(10.0 * node as f64, 0.0, 0.0);
            assert_small("off the closed form, m", (rig.state.u.position(node) - start - direction * exact).norm(), 0.0076);
        }
    }
}

/// Source: a line let go across a slope of angle β is pulled down it by w sin β and held by springs of k_t = μ w/δ, so that it moves by
/// y = y₀ (1 - cos ωt), y₀ = w sin β/k_t, ω² = k_t/m, up to y₁ = 1.01 μ w cos β/k_t (bound in time). Where 2 y₀ < y₁ it stays there, and where
/// tan β > 1.01 μ it slides on from y₁ with a = (w sin β - 1.01 μ w cos β)/m. The end does what the closed form says from y₁ on; the line is so
/// soft (1 kN) that the end has no say in the rest. In still air; allowed is a fiftieth of δ, by how the steps of 2 ms fall into the first swing
/// (measured: 3e-6 to 6e-5 m of δ = 0.01 m, having slid 1 to 6 m).
#[test]
fn a_line_across_a_slope_holds_or_slides_down_as_the_closed_form_says() {
    let (mu, mass) = (0.5, 135.35);
    for angle in [8.0_f64, 14.0, 30.0, 45.0] {
        let beta = angle.to_radians();
        let mesh = uniform(material(1.0e3, mass, WEIGHT), 50.0, 5);
        let mut ground = bed(&mesh, 0.0, 1.0e5, WEIGHT * beta.cos() / 1.0e5);
        ground.plane = Plane { normal: Vector3::new(0.0, -beta.sin(), beta.cos()), offset: 0.0 };
        let friction = Friction::new(mu, &ground.plane, &mesh);
        let delta = friction.breakaway();
        ground.friction = Some(friction);
        let (stiffness, pulls, most) = (mu * WEIGHT / delta, WEIGHT * beta.sin(), 1.01 * mu * WEIGHT * beta.cos());
        let (y0, y1, omega) = (pulls / stiffness, most / stiffness, (stiffness / mass).sqrt());
        let (slides, time) = (2.0 * y0 > y1, 2.0);
        assert_eq!(slides, angle > 15.0);
        // Time and speed at which the springs give way.
        let gives = if slides { (1.0 - y1 / y0).acos() / omega } else { 0.0 };
        let (speed, faster) = (y0 * omega * (omega * gives).sin(), (pulls - most) / mass);
        let after = time - gives;
        let exact = if slides { y1 + speed * after + 0.5 * faster * after * after } else { y0 * (1.0 - (omega * time).cos()) };

        let mut rig = on_a_line_along_x(mesh, ground, Holding::none());
        let down = Vector3::new(0.0, -beta.cos(), -beta.sin());
        let end = rig.state.u.position(rig.last());
        let by = if slides { vec![y1 - speed * gives, speed, 0.0] } else { vec![y0, 0.0, 0.0] };
        let acceleration = if slides { 0.5 * faster } else { 0.0 };
        let coefficients = vec![end + down * by[0], down * by[1], down * acceleration];
        rig.run(Scheme::AdamsMoulton, &Path::Polynomial { start: 0.0, coefficients }, 0.002, time, |_, _, _| ());
        for node in 0..rig.last() {
            let start = Vector3::new(10.0 * node as f64, 0.0, 0.0);
            let off = rig.state.u.position(node) - start - down * exact;
            assert_small(&format!("{angle} degrees: off the closed form, m"), off.norm(), 0.02 * delta);
        }
    }
}

/// A line of equal elements stretched out on the bed along x, free but for `holding`.
fn on_a_line_along_x(mesh: Mesh, ground: Ground, holding: Holding) -> Rig {
    let mut rig = Rig::new(mesh, Surroundings { ground: Some(ground), ..nothing() }, holding);
    for node in 0..=rig.last() {
        let s = rig.line.mesh().node_arc_length(node);
        rig.state.u.set_position(node, &Vector3::new(s, 0.0, 0.0));
        rig.state.u.set_slope(node, &Vector3::x());
    }
    rig.state.holds = Field::new(rig.line.holding_nodes());
    rig.line.lay(&rig.state.u, &mut rig.state.holds);
    rig
}

/// Source: damped oscillator, ζ = c/(2 √(k m)): a line that bobs on a damped bed by a thousandth of its depth loses a factor
/// exp(-2π ζ/√(1 - ζ²)) in a period. The damper is eased in with depth, which a bob of a thousandth sees as a thousandth.
#[test]
fn bobbing_on_a_damped_bed_dies_away_as_the_closed_form_says() {
    let (k, m, zeta) = (5075.2591, 135.35, 0.05);
    let onset = WEIGHT / k;
    let mesh = uniform(material(EA, m, WEIGHT), 100.0, 4);
    let mut ground = bed(&mesh, 0.0, k, onset);
    ground.resistance.iter_mut().for_each(|r| (r.damping, r.easing) = (2.0 * zeta * f64::sqrt(k * m), onset));
    let holding = Holding::none().hold_all(&mesh, &[X, Y, 3, 4, 5]);
    let mut rig = on_a_line_along_x(mesh, ground, holding);
    let depth = 1e-3 * onset;
    for node in 0..=rig.last() {
        rig.state.u.set_position(node, &Vector3::new(25.0 * node as f64, 0.0, depth));
    }
    // The end does what the closed form says, as a power series: z″ = -ω² z - 2 ζ ω z′.
    let omega = f64::sqrt(k / m);
    let mut series = vec![depth, 0.0];
    for n in 2..60 {
        let (n_1, n_2) = (series[n - 1], series[n - 2]);
        let product = (n * (n - 1)) as f64;
        series.push((-omega * omega * n_2 - 2.0 * zeta * omega * (n - 1) as f64 * n_1) / product);
    }
    let mut coefficients: Vec<Vector3<f64>> = series.iter().map(|z| Vector3::new(0.0, 0.0, *z)).collect();
    coefficients[0].x = 100.0;
    let period = 2.0 * std::f64::consts::PI / (omega * f64::sqrt(1.0 - zeta * zeta));
    rig.run(Scheme::AdamsMoulton, &Path::Polynomial { start: 0.0, coefficients }, period / 2000.0, period, |_, _, _| ());
    let exact = (-zeta * omega * period).exp();
    assert_close("what is left after a period", rig.state.u.position(2).z / depth, exact, 2e-3);
}

/// A state with friction goes into bytes and back, and goes on to the same bits.
#[test]
fn what_friction_holds_on_to_is_part_of_the_snapshot() {
    let loaded = built_in(&["environment.seabed.friction=0.7".into()]);
    let (mut simulation, path) = (settled(&loaded), Path::of_scene(&loaded, 0));
    simulation.advance(20.0, &path).unwrap_or_else(|error| panic!("{error}"));
    let mut bytes = Vec::new();
    simulation.snapshot().to_bytes(&mut bytes);
    simulation.advance(25.0, &path).unwrap_or_else(|error| panic!("{error}"));
    let first = simulation.outputs();
    assert!(simulation.restore(&Snapshot::from_bytes(&bytes).expect("a snapshot")));
    simulation.advance(25.0, &path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(first, simulation.outputs());
    let smooth = settled(&built_in(&["environment.seabed.friction=0".into()])).snapshot();
    assert!(!simulation.restore(&smooth), "a state without friction belongs to another line");
}

/// Derivatives of a step with friction against differences of two steps from the same state, the fairlead's acceleration varied by ± 2e-3 m/s².
/// Measured: 1.4e-8, what the differences leave.
#[test]
fn the_derivative_of_a_step_knows_what_friction_holds_on_to() {
    let loaded = built_in(&["environment.seabed.friction=0.7".into(), "solver.tolerance=1e-5".into()]);
    let (mut simulation, path) = (settled(&loaded), Path::of_scene(&loaded, 0));
    simulation.advance(20.0, &path).unwrap_or_else(|error| panic!("{error}"));
    let (from, now) = (simulation.snapshot(), path.at(20.0));
    let way = |d: f64| Path::Polynomial {
        start: 20.0,
        coefficients: vec![now.position, now.velocity, Vector3::new(d, 0.0, 0.0) + now.acceleration * 0.5],
    };
    let change = Path::Polynomial { start: 20.0, coefficients: vec![Vector3::zeros(), Vector3::zeros(), Vector3::x()] };
    let steps = simulation.linearise(20.1, &way(0.0)).unwrap_or_else(|error| panic!("{error}"));
    let exact = [simulation.derivative(&steps, &change).unwrap_or_else(|error| panic!("{error}"))];
    let mut after = |d: f64| {
        assert!(simulation.restore(&from));
        simulation.advance(20.1, &way(d)).unwrap_or_else(|error| panic!("{error}"));
        simulation.outputs()
    };
    let (up, down) = (after(1e-3), after(-1e-3));
    assert_close("tension", exact[0].tension, (up.tension - down.tension) / 2e-3, 1e-6);
}

/// Elements side by side feel the same bed as one by one: random states of lines that lie all along, in part and not at all, deep in the
/// bed and at its skin, moving and at rest, on beds with and without dampers, friction and slope. Rounding alone may differ (1e-12 of the largest).
#[test]
fn a_bed_is_the_same_for_elements_side_by_side_and_one_by_one() {
    let mut random = random::Random::new(5);
    let mut lying = 0;
    for (damping, mu, tilt) in
        [(0.0, 0.0, 0.0), (150.0, 0.0, 0.2), (0.0, 0.6, 0.2), (150.0, 0.6, 0.0), (150.0, 0.6, 0.2), (0.0, 0.6, 0.0)]
    {
        for laid in (0..20).map(|number| number % 2 == 1) {
            // Two sections: between them is a joint, which has no length.
            let (rope, chain) = (material(2.0e4, 12.0, 70.0), material(3.0e4, 20.0, 110.0));
            let mesh = Mesh::new(vec![rope, chain], &[vec![3.0, 2.0, 4.0, 3.0], vec![2.0, 2.5, 3.5, 1.5, 3.0, 2.0, 4.0]]);
            let joints: Vec<usize> = (0..mesh.elements.len()).filter(|e| mesh.elements[*e].is_joint()).collect();
            assert_eq!(joints.len(), 1);
            let plane = Plane { normal: Vector3::new(-tilt, 0.5 * tilt, 1.0).normalize(), offset: -2.0 };
            let resistance = Resistance { stiffness: 900.0, damping, onset: 0.08, easing: 0.1 };
            let friction = (mu > 0.0).then(|| Friction::new(mu, &plane, &mesh));
            let friction = if laid { friction.map(|friction| friction.laid(&mesh)) } else { friction };
            let ground = Ground { plane, resistance: vec![resistance; mesh.elements.len()], friction };
            let around = |ground: Option<Ground>| Surroundings {
                stretch: moorline::scene::types::Stretch::Exact,
                current: None,
                waves: None,
                ground,
                surface: None,
                planar: false,
            };
            let line = physics::build(mesh.clone(), around(Some(ground.clone())), Supports::default());
            let free = physics::build(mesh.clone(), around(None), Supports::default());
            let mut fields =
                [Field::new(mesh.nodes()), Field::new(mesh.nodes()), Field::new(mesh.nodes()), Field::new(mesh.nodes())];
            let depth = 10.0f64.powf(random.between(-3.0, 0.0));
            for node in 0..mesh.nodes() {
                let s = mesh.node_arc_length(node);
                let flat = Vector3::new(s, 0.1 * random.between(-1.0, 1.0), 0.0);
                let height = depth * random.between(-1.0, 0.3) - plane.height(&flat);
                fields[0].set_position(node, &(flat + plane.normal * height));
                let along = (Vector3::x() - plane.normal * plane.normal.x).normalize();
                fields[0].set_slope(node, &(along + plane.normal * (0.1 * depth * random.between(-1.0, 1.0))));
                let any = |random: &mut random::Random| Vector3::from_fn(|_, _| random.between(-0.3, 0.3));
                fields[1].set_position(node, &any(&mut random));
                fields[1].set_slope(node, &any(&mut random));
            }
            for e in &joints {
                let place = fields[0].position(*e);
                fields[0].set_position(e + 1, &place);
            }
            let mut holds = Field::new(line.holding_nodes());
            line.hold(&fields[0], &fields[1], &mut holds);
            if line.holding_nodes() > 0 {
                for c in 0..6 {
                    holds.component_mut(c).iter_mut().for_each(|hold| *hold += 0.1 * random.between(-1.0, 1.0));
                }
            }
            let [u, v, a, one_by_one] = &mut fields;
            let at = Motion { clock: Clock::at_rest(0.0), u, v, a, holds: &holds, frames: &[] };
            let (mut side_by_side, mut without) = (Field::new(mesh.nodes()), Field::new(mesh.nodes()));
            line.residual(&at, &mut side_by_side);
            free.residual(&at, &mut without);
            side_by_side.add(-1.0, &without);
            let table = Table::new(&mesh, None);
            for e in 0..mesh.elements.len() {
                if let Some(push) = ground.forces(&table, &at, e) {
                    lying += usize::from(ground.touching_length(&table, u, e) == mesh.elements[e].length);
                    scatter_to_nodes(one_by_one, e, mesh.elements[e].length, &push);
                }
            }
            for e in &joints {
                // Forces on tied nodes go to the second of them.
                one_by_one.set_position(e + 1, &(one_by_one.position(*e) + one_by_one.position(e + 1)));
                one_by_one.set_position(*e, &Vector3::zeros());
            }
            let scale = one_by_one.data().iter().fold(1.0e-9f64, |most, x| most.max(x.abs()));
            side_by_side.add(-1.0, one_by_one);
            let error = side_by_side.data().iter().fold(0.0f64, |most, x| most.max(x.abs())) / scale;
            // What the line itself has (some 1e4 N) rounds to 1e-11 N.
            assert!(error < 1e-12 + 1e-9 / scale, "damping {damping}, friction {mu}, slope {tilt}: {error:e} of {scale} N");
        }
    }
    assert!(lying > 100, "{lying} elements lay all along");
}
