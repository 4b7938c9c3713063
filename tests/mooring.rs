//! The mooring as a whole: driven bodies, stiffness, networks and free bodies against laws, closed forms and a monolithic integration.

use moorline::rod::pose::PosePath;
use moorline::scene::bodies::Mount;
use moorline::scene::motion_file::Table;
use moorline::scene::read::{self, Loaded};
use moorline::solve::group::{EndOf, Group};
use moorline::solve::loads;
use moorline::solve::motion::{Ends, Path};
use moorline::solve::part::Part;
use moorline::solve::partition;
use moorline::solve::simulation::{Outputs, Simulation};
use nalgebra::{Matrix3, Vector3};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::sync::Arc;
use support::mooring::settled;

mod support;

fn load(scene: &Value) -> Loaded {
    read::parse(&scene.to_string(), "test", std::path::Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn example(name: &str, sets: &[&str]) -> Loaded {
    let path = format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    read::load(std::path::Path::new(&path), &sets).unwrap_or_else(|error| panic!("{error}"))
}

fn chain() -> Value {
    json!({"ea": 5.0e8, "mass": 135.35, "diameter": 0.076, "submerged_weight": 1157.16, "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0},
        "damping": 1e-3})
}

/// The built-in line on a body that moves without turning is the line whose fairlead moves so: equal to rounding. The body is turned by a
/// constant attitude, and its reference point is elsewhere.
#[test]
fn a_line_on_a_driven_body_is_the_line_on_the_path_of_its_fairlead() {
    let motion = |sine: &[f64]| json!({"kind": "sinusoidal", "period": 15.0, "sine": sine, "ramp": 10.0});
    let scene = |fairlead: Value, of_scene: Value, bodies: Value| {
        json!({
            "environment": {"depth": 120.0}, "line_types": {"chain": chain()},
            "lines": [{"fairlead": fairlead, "anchor": [1183.97, 0, -120], "sections": [{"type": "chain", "length": 1200.0, "elements": 40}]}],
            "motion": of_scene, "bodies": bodies, "run": {"duration": 20.0}
        })
    };
    let alone = load(&scene(json!([0, 0, 0]), motion(&[5.08, 2.1, 0.5]), json!([])));
    let at = [12.0, -7.0, 3.0];
    let body = json!([{"name": "ship", "position": [0, 0, 0], "attitude_deg": [10, -20, 135], "motion": motion(&[5.08, 2.1, 0.5, 0.0, 0.0, 0.0])}]);
    let mut mounted = load(&scene(json!({"body": "ship", "at": at}), json!({"kind": "fixed"}), body));
    // Put so that the fairlead is at the origin.
    let away = mounted.scene.bodies[0].place(&at);
    mounted.scene.bodies[0].position = (-away).into();
    mounted.scene.place_ends();
    let run = |loaded: &Loaded| {
        let mut part = Part::of_scene(loaded, &partition::parts(&loaded.scene)[0]).unwrap_or_else(|error| panic!("{error}"));
        part.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
        (1..=200)
            .map(|k| {
                part.advance(0.1 * f64::from(k)).unwrap_or_else(|error| panic!("{error}"));
                part.outputs(0)
            })
            .collect::<Vec<_>>()
    };
    for (a, b) in run(&alone).iter().zip(run(&mounted)) {
        assert!((a.tension / b.tension - 1.0).abs() < 1e-9 && (a.fairlead - b.fairlead).norm() < 1e-9, "{a:?} {b:?}");
    }
}

/// Stiffness of a mooring against a body: the formula by condensed lines against central differences of statics with the body moved (Richardson,
/// steps of 2 and 4 mm), 1e-6 of the largest of its block.
#[test]
fn stiffness_is_the_difference_of_statics() {
    let sets = [
        "solver.tolerance=1e-6",
        "bodies[0].position=[1.5,-2,0.4]",
        "bodies[0].attitude_deg=[2,-1,4]",
        "bodies[0].motion.sine=[0,0,0,0,0,0]",
    ];
    let loaded = example("semi-submersible.json", &sets);
    let (mut mooring, _) = settled(&loaded);
    let stiffness = mooring.stiffness(0, 0.0).expect("a stiffness");
    let ends = loads::hanging(&loaded.scene, 0);
    let body = &loaded.scene.bodies[0];
    let (position, angles) = (Vector3::from(body.position), body.attitude());
    let moved = |axis: usize, by: f64| {
        let (mut place, mut turn) = (position, Vector3::zeros());
        if axis < 3 {
            place[axis] += by
        } else {
            turn[axis - 3] = by
        }
        let rotation = moorline::algebra::rotation::exp(&turn) * moorline::algebra::rotation::of_angles(&angles);
        // On the meshes of the unmoved mooring: what differs is the place alone.
        let mut outputs = Vec::new();
        for (part, line) in mooring.parts.iter_mut().zip(&loaded.scene.lines) {
            let Part::Alone { simulation, .. } = part else { panic!("lines stand alone") };
            let Some(moorline::scene::bodies::Mount::Body { at, .. }) = &line.fairlead_on else { panic!("on a body") };
            simulation.settle(place + rotation * Vector3::from(*at), 0.0).unwrap_or_else(|error| panic!("{error}"));
            outputs.push(simulation.outputs());
        }
        loads::on(&place, &ends, &outputs)
    };
    let mut moved = moved;
    for axis in 0..6 {
        let h = if axis < 3 { 2e-3 } else { 5e-5 };
        let mut difference = |h: f64| {
            let ((f, m), (g, n)) = (moved(axis, h), moved(axis, -h));
            [(g - f) / (2.0 * h), (n - m) / (2.0 * h)]
        };
        let (one, two) = (difference(h), difference(2.0 * h));
        for block in 0..2 {
            let best = (one[block] * 4.0 - two[block]) / 3.0;
            let largest = (0..3)
                .map(|row| {
                    (0..6)
                        .map(|c| if (c < 3) == (axis < 3) { stiffness[3 * block + row][c].abs() } else { 0.0 })
                        .fold(0.0, f64::max)
                })
                .fold(0.0, f64::max);
            for row in 0..3 {
                let error = (best[row] - stiffness[3 * block + row][axis]).abs() / largest;
                assert!(
                    error < 1e-6,
                    "row {}, column {axis}: {} by formula, {} by differences ({error:.1e})",
                    3 * block + row,
                    stiffness[3 * block + row][axis],
                    best[row]
                );
            }
        }
    }
}

/// A taut line alone between a body and the bed is as stiff across as its tension over its length: a line solved in its plane, too.
#[test]
fn a_line_in_a_plane_is_stiff_across_it() {
    let loaded = example("towline.json", &[]);
    let (mut mooring, outputs) = settled(&loaded);
    let stiffness = mooring.stiffness(0, 0.0).expect("a stiffness");
    let span = (outputs[0].fairlead - outputs[0].anchor).xy().norm();
    let across = outputs[0].force.x.abs() / span;
    assert!((stiffness[1][1] / across - 1.0).abs() < 1e-3, "{} N/m, not {across} N/m", stiffness[1][1]);
}

/// Two bodies in empty space, joined by a line and nothing else: momentum and its moment stay what they are, whatever goes on between them.
#[test]
fn two_free_bodies_and_a_line_keep_their_momentum() {
    let body = |name: &str, x: f64, mass: f64| {
        json!({"name": name, "position": [x, 0, 0], "motion": {"kind": "free"}, "mass": mass, "centre_of_mass": [0.5, -0.3, 0.2],
            "inertia": [mass * 2.0, mass * 3.0, mass * 4.0]})
    };
    let scene = json!({
        "environment": {"depth": 1000.0, "gravity": 1e-9, "water_density": 0.0, "surface": "none"},
        "line_types": {"rope": {"ea": 1.0e6, "mass": 2.0, "diameter": 0.05, "submerged_weight": 0.0}},
        "lines": [{"fairlead": {"body": "one", "at": [2, 1, 0]}, "anchor": {"body": "two", "at": [-2, 0, 1]},
            "sections": [{"type": "rope", "length": 97.0, "elements": 10}]}],
        "bodies": [body("one", 0.0, 4000.0), body("two", 100.0, 9000.0)],
        "solver": {"tolerance": 1e-4, "max_step": 0.1}
    });
    let loaded = load(&scene);
    let part = partition::parts(&loaded.scene).remove(0);
    let ends = vec![Ends::of_scene(&loaded, 0)];
    let mut group = Group::new(&loaded, &part, &ends).unwrap_or_else(|error| panic!("{error}"));
    // Nothing weighs anything, so that nothing is out of balance that anybody could measure.
    let _ = group.settle(0.0);
    group.push(0, Vector3::new(0.3, 0.5, -0.2), Vector3::new(0.1, 0.2, -0.1));
    group.push(1, Vector3::new(0.8, -0.4, 0.1), Vector3::new(-0.1, 0.05, 0.2));
    let of = |group: &mut Group| {
        let (mut momentum, mut turning) = group.line_momentum(0);
        for (number, mass) in [(0, 4000.0), (1, 9000.0)] {
            let body = group.body(number);
            let at = body.place(&Vector3::new(0.5, -0.3, 0.2));
            let inertia = Matrix3::from_diagonal(&(Vector3::new(2.0, 3.0, 4.0) * mass));
            momentum += at.velocity * mass;
            turning +=
                at.position.cross(&(at.velocity * mass)) + body.rotation * inertia * body.rotation.transpose() * body.omega;
        }
        (momentum, turning)
    };
    group.advance(0.01).unwrap_or_else(|error| panic!("{error}"));
    let (momentum, turning) = of(&mut group);
    let (mut worst, mut most) = ([0.0_f64; 2], 0.0_f64);
    for k in 1..=300 {
        group.advance(0.01 + 0.1 * f64::from(k)).unwrap_or_else(|error| panic!("{error}"));
        let (p, l) = of(&mut group);
        worst = [worst[0].max((p - momentum).norm() / momentum.norm()), worst[1].max((l - turning).norm() / turning.norm())];
        most = most.max(group.outputs(0).tension);
    }
    println!("momentum {:.1e}, its moment {:.1e}, tension up to {most:.0} N", worst[0], worst[1]);
    assert!(most > 1.0e3, "the line never pulled");
    assert!(worst[0] < 1e-4 && worst[1] < 1e-3, "{worst:?}");
}

/// A ship with stiffness and damping of its own on four chains, drawn aside and let go: as a free body of the scene, and as a body outside that moves
/// the lines as driven ones, integrated here in steps of 5 ms. Within 0.1 % of the offset, over five minutes.
#[test]
fn a_vessel_inside_moves_as_one_outside() {
    let (mass, inertia) = (2.0e7, [8.0e8, 3.0e10, 3.05e10]);
    let damping = [2.0e5, 3.0e5, 2.0e6, 1.0e8, 2.0e9, 1.0e9];
    let hydrostatic = [0.0, 0.0, 3.0e7, 9.0e8, 1.5e10, 0.0];
    let diagonal =
        |d: [f64; 6]| -> Vec<Vec<f64>> { (0..6).map(|r| (0..6).map(|c| if r == c { d[r] } else { 0.0 }).collect()).collect() };
    let scene = |force: [f64; 3], moment: [f64; 3]| {
        let line = |name: &str, x: f64, y: f64, far: f64, wide: f64| {
            json!({"name": name, "fairlead": {"body": "ship", "at": [x, y, -5.0]}, "anchor": [far, wide, -100.0],
                "sections": [{"type": "chain", "length": 720.0, "elements": 30}]})
        };
        json!({
            "environment": {"depth": 100.0}, "line_types": {"chain": chain()},
            "lines": [line("a", 90.0, 10.0, 640.0, 420.0), line("b", 90.0, -10.0, 640.0, -420.0), line("c", -90.0, 10.0, -640.0, 420.0), line("d", -90.0, -10.0, -640.0, -420.0)],
            "bodies": [{"name": "ship", "motion": {"kind": "free"}, "mass": mass, "inertia": inertia, "damping": diagonal(damping),
                "stiffness": diagonal(hydrostatic), "force": force, "moment": moment}],
            "solver": {"tolerance": 1e-4, "max_step": 0.2}
        })
    };
    let (pull, turn) = ([6.0e5, 2.0e5, 0.0], [0.0, 0.0, 2.0e7]);
    let loaded = load(&scene(pull, turn));
    let part = partition::parts(&loaded.scene).remove(0);
    let ends: Vec<Ends> = (0..4).map(|index| Ends::of_scene(&loaded, index)).collect();
    let mut inside = Group::new(&loaded, &part, &ends).unwrap_or_else(|error| panic!("{error}"));
    inside.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
    let start = inside.body(0);
    inside.apply(0, -Vector3::from(pull), -Vector3::from(turn));

    // Outside: explicit midpoint steps for the ship, lines on polynomials from step to step.
    let mut lines: Vec<Simulation> = Vec::new();
    let at: Vec<Vector3<f64>> =
        [(90.0, 10.0), (90.0, -10.0), (-90.0, 10.0), (-90.0, -10.0)].map(|(x, y)| Vector3::new(x, y, -5.0)).to_vec();
    for index in 0..4 {
        let mut line = Simulation::new(&loaded.scene, index).unwrap_or_else(|error| panic!("{error}"));
        line.settle(start.place(&at[index]).position, 0.0).unwrap_or_else(|error| panic!("{error}"));
        lines.push(line);
    }
    let (mut x, mut r, mut v, mut w) = (start.reference.position, start.rotation, Vector3::zeros(), Vector3::zeros());
    let of_body = Matrix3::from_diagonal(&Vector3::from(inertia));
    let outputs = |lines: &[Simulation]| -> Vec<Outputs> { lines.iter().map(Simulation::outputs).collect() };
    let ends_of: Vec<(usize, bool)> = (0..4).map(|index| (index, false)).collect();
    let rates = |x: &Vector3<f64>,
                 r: &Matrix3<f64>,
                 v: &Vector3<f64>,
                 w: &Vector3<f64>,
                 (force, moment): (Vector3<f64>, Vector3<f64>)| {
        let split = |d: [f64; 6]| {
            (Matrix3::from_diagonal(&Vector3::new(d[0], d[1], d[2])), Matrix3::from_diagonal(&Vector3::new(d[3], d[4], d[5])))
        };
        let ((d1, d2), (k1, k2)) = (split(damping), split(hydrostatic));
        let q = moorline::rod::rigid::rotation_vector(r);
        let force = force - r * d1 * r.transpose() * v - k1 * x;
        let moment = moment - r * d2 * r.transpose() * w - k2 * q;
        let i = r * of_body * r.transpose();
        (force / mass, i.try_inverse().expect("an inertia") * (moment - w.cross(&(i * w))))
    };
    let (h, mut time) = (0.005, 0.0);
    let mut loads_before = loads::on(&x, &ends_of, &outputs(&lines));
    let mut loads_now = loads_before;
    let (mut worst, size) = (0.0_f64, (start.reference.position).norm());
    let angles = |r: &Matrix3<f64>| moorline::algebra::rotation::angles(r);
    let turned = angles(&start.rotation).z;
    for k in 1..=60_000 {
        // Loads at the middle by extrapolation.
        let middle = (loads_now.0 * 1.5 - loads_before.0 * 0.5, loads_now.1 * 1.5 - loads_before.1 * 0.5);
        let (a, b) = rates(&x, &r, &v, &w, loads_now);
        let (vm, wm) = (v + a * (0.5 * h), w + b * (0.5 * h));
        let (xm, rm) = (x + v * (0.5 * h), moorline::algebra::rotation::exp(&(w * (0.5 * h))) * r);
        let (am, bm) = rates(&xm, &rm, &vm, &wm, middle);
        let (x0, q0) = (x, angles(&r));
        x += vm * h;
        r = moorline::algebra::rotation::exp(&(wm * h)) * r;
        let (v0, w0) = (v, w);
        (v, w) = (v + am * h, w + bm * h);
        let q1 = angles(&r);
        let rate = |q: &Vector3<f64>, w: &Vector3<f64>| moorline::algebra::rotation::omega_to_rates(q, w);
        let cubic = |x0: Vector3<f64>, v0: Vector3<f64>, x1: Vector3<f64>, v1: Vector3<f64>| {
            let chord = (x1 - x0) / h;
            vec![x0, v0, (chord * 3.0 - v0 * 2.0 - v1) / h, (v0 + v1 - chord * 2.0) / (h * h)]
        };
        let path = Arc::new(PosePath::Polynomial {
            start: time,
            position: cubic(x0, v0, x, v),
            angles: cubic(q0, rate(&q0, &w0), q1, rate(&q1, &w)),
        });
        time = h * f64::from(k);
        for (line, at) in lines.iter_mut().zip(&at) {
            line.advance(time, &Path::OnBody { body: Arc::clone(&path), at: *at }).unwrap_or_else(|error| panic!("{error}"));
        }
        (loads_before, loads_now) = (loads_now, loads::on(&x, &ends_of, &outputs(&lines)));
        if k % 200 == 0 {
            inside.advance(time).unwrap_or_else(|error| panic!("{error}"));
            let body = inside.body(0);
            worst = worst.max((body.reference.position - x).norm() / size).max((angles(&body.rotation).z - q1.z).abs() / turned);
        }
    }
    println!("offset {size:.2} m, {:.2} deg; apart by {worst:.1e} of it", turned.to_degrees());
    assert!(worst < 1e-3, "{worst:.2e}");
}

/// Anchor ends on driven bodies: a hawser held at both ends by ships that move as one is the hawser at rest.
#[test]
fn a_line_between_two_ships_that_move_as_one_hangs_still() {
    let motion = json!({"kind": "sinusoidal", "period": 30.0, "sine": [4.0, 3.0, 0.0, 0.0, 0.0, 0.0], "ramp": 60.0});
    let scene = json!({
        "environment": {"depth": 500.0, "water_density": 0.0, "surface": "none"},
        "line_types": {"wire": {"ea": 1.0e8, "mass": 20.0, "diameter": 0.05, "submerged_weight": 150.0}},
        "lines": [{"fairlead": {"body": "tug", "at": [0, 0, 2]}, "anchor": {"body": "barge", "at": [0, 5, 3]}, "sections": [{"type": "wire", "length": 320.0}]}],
        "bodies": [{"name": "tug", "position": [300, 0, 0], "motion": motion}, {"name": "barge", "motion": motion}],
        "run": {"duration": 30.0}
    });
    let loaded = load(&scene);
    let mut part = Part::of_scene(&loaded, &partition::parts(&loaded.scene)[0]).unwrap_or_else(|error| panic!("{error}"));
    part.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
    // Accelerated as one, the line feels a weight that is tilted by a/g.
    let rest = part.outputs(0);
    let ends = Ends::of_scene(&loaded, 0);
    let mut most = 0.0_f64;
    for k in 1..=300 {
        let time = 0.1 * f64::from(k);
        part.advance(time).unwrap_or_else(|error| panic!("{error}"));
        let now = part.outputs(0);
        assert!((now.fairlead - now.anchor - (rest.fairlead - rest.anchor)).norm() < 1e-9);
        let inertia = ends.fairlead.at(time).acceleration * (20.0 * 320.0);
        let balance = now.force + now.anchor_force + Vector3::z() * (150.0 * 320.0) + inertia;
        most = most.max(balance.norm());
        assert!((now.tension / rest.tension - 1.0).abs() < 0.2, "{now:?}");
    }
    // Forces on the line's ends are its weight and inertia but for its own swing.
    assert!(most < 0.1 * 150.0 * 320.0, "{most} N");
}

/// A group whose ends a scene drives goes the same way whoever sets the paths.
#[test]
fn ends_of_a_group_follow_the_paths_that_are_set() {
    let loaded = example("wave-energy-floats.json", &["solver.tolerance=1e-3"]);
    let part = partition::parts(&loaded.scene).remove(0);
    let ends: Vec<Ends> = part.lines.iter().map(|index| Ends::of_scene(&loaded, *index)).collect();
    let make = || Group::new(&loaded, &part, &ends).unwrap_or_else(|error| panic!("{error}"));
    let (mut one, mut other) = (make(), make());
    for group in [&mut one, &mut other] {
        group.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
    }
    for k in 1..=50 {
        other.drive(0, EndOf::Fairlead, &ends[0].fairlead);
        for group in [&mut one, &mut other] {
            group.advance(0.1 * f64::from(k)).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    assert_eq!(one.outputs(0), other.outputs(0));
    assert!((one.outputs(0).fairlead - ends[0].fairlead.at(5.0).position).norm() < 1e-12 && TAU > 6.0);
}

/// Points in a row, each held by a rope to the bed, joined by ropes to the next, the first by a rope to a ship that moves.
fn farm(points: usize) -> Value {
    let rope = json!({"ea": 2e8, "mass": 30.0, "diameter": 0.14, "submerged_weight": 140.0, "drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}});
    let (mut lines, mut held) = (Vec::new(), Vec::new());
    let rope_of = |length: f64| json!([{"type": "rope", "length": length, "elements": 20}]);
    for k in 0..points {
        let (x, name) = (-200.0 * k as f64, format!("p{k}"));
        held.push(json!({"name": name, "position": [x, 0, -40], "mass": 3000.0, "volume": 25.0, "drag_area": 6.0, "added_mass": 8000.0}));
        lines.push(json!({"name": format!("leg{k}"), "fairlead": {"point": name}, "anchor": [x, 60.0, -150.0], "sections": rope_of(124.0)}));
        let (from, length) = match k {
            0 => (json!({"body": "ship", "at": [0, 0, 0]}), 212.0),
            _ => (json!({"point": format!("p{}", k - 1)}), 206.0),
        };
        lines.push(json!({"name": format!("span{k}"), "fairlead": from, "anchor": {"point": name}, "sections": rope_of(length)}));
    }
    let motion = json!({"kind": "sinusoidal", "period": 12.0, "sine": [2.0, 1.0, 0.7, 0, 0, 0], "ramp": 24.0});
    json!({"environment": {"depth": 150.0}, "line_types": {"rope": rope}, "lines": lines, "points": held,
        "bodies": [{"name": "ship", "position": [200.0, 0, -10.0], "motion": motion}]})
}

/// Twenty lines and ten points, of which one end is moved: every line pulls as it does alone with its ends on the way that they go here, to a thousandth of its
/// tension at rest (that is the tolerance of both). All go by the steps of the one that is moved; elements of lines that are done are not looked at: 2.2 times
/// what the lines cost alone would be too much in these 40 s of easing in, and is more than that if all are looked at every time.
#[test]
fn lines_that_meet_pull_as_each_alone_and_cost_little_more() {
    let loaded = load(&farm(10));
    let together = &partition::parts(&loaded.scene)[0];
    let mut group = match Part::of_scene(&loaded, together) {
        Ok(Part::Group(group)) => group,
        Ok(_) => panic!("no group"),
        Err(error) => panic!("{error}"),
    };
    group.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
    let (rows, count) = (400, loaded.scene.lines.len());
    let (mut pulls, mut ways) = (vec![Vec::new(); count], vec![Vec::new(); 10]);
    let mut placed = loaded.scene.clone();
    group.place_in(&mut placed);
    let at_rest: Vec<Outputs> = (0..count).map(|local| group.outputs(local)).collect();
    for row in 0..=rows {
        if row > 0 {
            group.advance(0.1 * f64::from(row)).unwrap_or_else(|error| panic!("{error}"));
        }
        (0..count).for_each(|local| pulls[local].push(group.outputs(local)));
        (0..10).for_each(|point| ways[point].push(group.point(point)));
    }
    let joined = group.counters().element_iterations;
    let times: Vec<f64> = (0..=rows).map(|row| 0.1 * f64::from(row)).collect();
    let path_of = |on: &Option<Mount>, own: Path| match on {
        Some(Mount::Point { point }) => {
            let way = &ways[loaded.scene.point(point).unwrap_or_else(|| panic!("a point"))];
            let (positions, velocities) = (way.iter().map(|at| at.position.into()), way.iter().map(|at| at.velocity.into()));
            Path::Table(Arc::new(Table {
                times: times.clone(),
                positions: positions.collect(),
                velocities: velocities.collect(),
            }))
        }
        _ => own,
    };
    let mut apart = 0;
    for (index, line) in loaded.scene.lines.iter().enumerate() {
        let own = Ends::of_scene(&loaded, index);
        let ends = Ends { fairlead: path_of(&line.fairlead_on, own.fairlead), anchor: path_of(&line.anchor_on, own.anchor) };
        let mut alone = Simulation::on_ends(&placed, index, Some(&ends)).unwrap_or_else(|error| panic!("{error}"));
        alone
            .settle_between(ends.fairlead.at(0.0).position, ends.anchor.at(0.0).position, 0.0)
            .unwrap_or_else(|error| panic!("{error}"));
        for (time, here) in times.iter().zip(&pulls[index]).skip(1) {
            alone.advance_ends(*time, &ends).unwrap_or_else(|error| panic!("{error}"));
            let off = (alone.observe().tension - here.tension).abs() / at_rest[index].tension;
            assert!(off < 1.0e-3, "line {index} at {time} s is off by {off:.1e} of its tension at rest");
        }
        apart += alone.counters().element_iterations;
    }
    println!("{joined} elements looked at together, {apart} apart");
    assert!((joined as f64) < 2.2 * apart as f64, "{joined} elements looked at together, {apart} apart");
}

/// Where the line that is moved is the last of its group, and looked at alone, its elements begin anywhere in the rows that are read side by side, and end
/// with them: of any number of elements it pulls as it does as the second of them, to a thousandth of its tension at rest.
#[test]
fn a_line_pulls_the_same_wherever_it_stands_among_those_it_meets() {
    for elements in 3..=11 {
        let tensions = |last: bool| {
            let mut scene = farm(3);
            let lines = scene["lines"].as_array_mut().unwrap_or_else(|| panic!("lines"));
            lines.iter_mut().for_each(|line| line["sections"][0]["elements"] = json!(elements));
            if last {
                let moved = lines.remove(1);
                lines.push(moved);
            }
            let moved = if last { lines.len() - 1 } else { 1 };
            let loaded = load(&scene);
            let Ok(Part::Group(mut group)) = Part::of_scene(&loaded, &partition::parts(&loaded.scene)[0]) else {
                panic!("no group")
            };
            group.settle(0.0).unwrap_or_else(|error| panic!("{error}"));
            let rows = 1..=150;
            rows.map(|row| {
                group.advance(0.1 * f64::from(row)).unwrap_or_else(|error| panic!("{error}"));
                group.outputs(moved).tension
            })
            .collect::<Vec<f64>>()
        };
        let (second, last) = (tensions(false), tensions(true));
        let off = second.iter().zip(&last).map(|(one, other)| (one - other).abs() / second[0]).fold(0.0, f64::max);
        assert!(off < 1.0e-3, "{elements} elements: {off:.1e} of its tension at rest");
    }
}
