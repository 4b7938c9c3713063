//! The scenes of examples/ and the answers that their titles name.

mod support;

use moorline::scene::read::{self, Loaded};
use moorline::solve::motion::Path;
use moorline::solve::simulation::{Outputs, Simulation};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use support::mooring::settled as moored;
use support::{GRAVITY, Hanging, Piece, assert_close, bisect, weight};

fn load(name: &str) -> Loaded {
    let path = format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
    read::load(std::path::Path::new(&path), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Line `index` of a scene in equilibrium.
fn settled(scene: &Loaded, index: usize) -> Simulation {
    let mut line = Simulation::new(&scene.scene, index).unwrap_or_else(|error| panic!("{error}"));
    let fairlead = Path::of_scene(scene, index).at(0.0).position;
    line.settle(fairlead, 0.0).unwrap_or_else(|error| panic!("{error}"));
    line
}

/// What the only line of a scene does, at every output time.
fn history(scene: &Loaded) -> Vec<Outputs> {
    let (mut line, path) = (settled(scene, 0), Path::of_scene(scene, 0));
    let rows = (scene.scene.run.duration / scene.scene.run.output_step).round() as usize;
    let mut outputs = vec![line.outputs()];
    for row in 1..=rows {
        line.advance(row as f64 * scene.scene.run.output_step, &path).unwrap_or_else(|error| panic!("{error}"));
        outputs.push(line.outputs());
    }
    outputs
}

/// Source: Hooke's law at rest, EA (d/L - 1); in motion the elastic bar held at one end and moved by a sin ωt at the other, whose
/// force there is EA/L · kL cot kL · a sin ωt. The last of four periods.
#[test]
fn taut_polyester_is_an_elastic_bar() {
    let (ea, mass, length, distance, amplitude) = (6.0e7, 26.0, 1470.0, 1500.0, 5.0);
    let rows = history(&load("taut-polyester.json"));
    let rest = ea * (distance / length - 1.0);
    assert_close("tension at rest", rows[0].tension, rest, 1e-9);
    let kl = TAU / 20.0 * f64::sqrt(mass / ea) * length;
    let dynamic = ea / length * amplitude * kl / kl.tan();
    let last = || rows[600..].iter().map(|row| row.tension);
    assert_close("largest", last().fold(f64::MIN, f64::max) - rest, dynamic, 2e-3);
    assert_close("smallest", rest - last().fold(f64::MAX, f64::min), dynamic, 2e-3);
}

/// Source: elastic catenary in closed form (Irvine 1981).
#[test]
fn slack_catenary_hangs_as_irvine_says() {
    let weight = 135.35 * GRAVITY - 1025.0 * GRAVITY * TAU / 8.0 * 0.076 * 0.076;
    let piece = [Piece { length: 180.0, weight, ea: 5.0e8 }];
    let exact = Hanging::spanning(&piece, 100.0, 20.0);
    let outputs = settled(&load("slack-catenary.json"), 0).outputs();
    assert_close("tension at the fairlead", outputs.tension, exact.tension(&piece, 180.0), 1e-4);
    assert_close("tension at the anchor", outputs.anchor_tension, exact.tension(&piece, 0.0), 1e-4);
    assert_close("horizontal force", outputs.force.x, exact.horizontal, 3e-4);
}

/// Source: elastic catenaries above and below a jump of the vertical force, the weight of the body less its buoyancy. In motion the
/// clump keeps the line alive: the tension stays between a half and twice that at rest.
#[test]
fn clump_weight_hangs_in_two_catenaries() {
    let scene = load("clump-weight.json");
    let per_length = 135.35 * GRAVITY - 1025.0 * GRAVITY * TAU / 8.0 * 0.076 * 0.076;
    let chain = Piece { length: 150.0, weight: per_length, ea: 5.0e8 };
    let pieces = [chain, weight((10000.0 - 1025.0 * 2.0) * GRAVITY), chain];
    let exact = Hanging::spanning(&pieces, 250.0, 60.0);
    let rows = history(&scene);
    assert_close("tension at the fairlead", rows[0].tension, exact.tension(&pieces, 300.0), 3e-4);
    assert_close("tension at the anchor", rows[0].anchor_tension, exact.tension(&pieces, 0.0), 3e-4);
    assert_close("the title", rows[0].tension, 370.0e3, 5e-4);
    assert!(rows.iter().all(|row| row.tension > 0.5 * rows[0].tension && row.tension < 2.0 * rows[0].tension));
}

/// Source: the same with a lift.
#[test]
fn lazy_wave_hangs_and_floats_in_two_catenaries() {
    let scene = load("lazy-wave.json");
    let per_length = 40.0 * GRAVITY - 1025.0 * GRAVITY * TAU / 8.0 * 0.2 * 0.2;
    let hose = |length: f64| Piece { length, weight: per_length, ea: 2.0e7 };
    let pieces = [hose(90.0), weight((300.0 - 1025.0 * 2.0) * GRAVITY), hose(130.0)];
    let exact = Hanging::spanning(&pieces, 120.0, 110.0);
    let outputs = history(&scene)[0];
    assert_close("horizontal", outputs.force.x, exact.horizontal, 3e-3);
    assert_close("tension at the fairlead", outputs.tension, exact.tension(&pieces, 220.0), 1e-3);
    assert_close("tension at the anchor", outputs.anchor_tension, exact.tension(&pieces, 0.0), 1e-3);
    assert_close("the title", outputs.force.x, 2.67e3, 3e-3);
}

/// Source: Archimedes on the wet part of a sphere, and Hooke.
#[test]
fn moored_buoy_floats_where_its_rope_lets_it() {
    let rows = history(&load("moored-buoy.json"));
    let (outputs, last) = (rows[0], rows[rows.len() - 1]);
    let radius = (0.75 * 14.137 / std::f64::consts::PI).cbrt();
    let h = outputs.fairlead.z / radius;
    let pull = 1025.0 * GRAVITY * 14.137 * (1.0 - h) * (1.0 - h) * (2.0 + h) / 4.0 - 4000.0 * GRAVITY;
    assert_close("tension below the buoy", outputs.tension, pull, 1e-5);
    let wet = 10.0 * GRAVITY - 1025.0 * GRAVITY * TAU / 8.0 * 0.1 * 0.1;
    assert_close("stretch", outputs.fairlead.z + 1.0, (pull - 0.5 * wet * 79.0) * 79.0 / 2.0e7, 1e-3);
    assert_close("it stays", last.tension, outputs.tension, 1e-4);
}

/// Source: a line without weight across a current, drag on its normal velocity only: T is constant, and with φ the angle from the
/// straight way T dφ/ds = f cos²φ, so tan φ = f s/T. This is the catenary with a = T/f, f = ½ ρ d Cn V². Half the speed, a quarter of f.
#[test]
fn two_lines_in_a_current_are_catenaries_of_constant_tension() {
    let scene = load("two-lines-in-current.json");
    let (distance, length) = (100.0, 110.0);
    let a = bisect(1.0, 1.0e4, |a| length - 2.0 * a * (0.5 * distance / a).sinh());
    for (index, speed) in [1.0_f64, 0.5].into_iter().enumerate() {
        let exact = 0.5 * 1025.0 * 0.1 * 1.2 * speed * speed * a;
        let line = settled(&scene, index);
        assert_close("tension", line.outputs().tension, exact, 1e-3);
        for node in line.nodes() {
            assert!((node.tension / exact - 1.0).abs() < 5e-3, "s = {}: {} for {exact}", node.s, node.tension);
        }
        let drift = a * ((0.5 * distance / a).cosh() - 1.0);
        let middle = line.nodes().iter().map(|node| node.position.x).fold(0.0, f64::max);
        assert!(middle <= drift * 1.001 && middle > 0.97 * drift, "deepest node {middle} for {drift}");
    }
}

/// Source: tensioned beam with pinned ends under uniform load (Timoshenko), small slopes; q = ½ ρ d Cn V², T as found. Bending takes
/// 14 % off the drift of a rope.
#[test]
fn riser_bends_as_a_tensioned_beam() {
    let line = settled(&load("riser-with-bending.json"), 0);
    let (length, ei, q, tension) = (100.0, 1.0e8, 0.5 * 1025.0 * 0.5 * 1.2 * 0.8 * 0.8, line.outputs().tension);
    let k = f64::sqrt(tension / ei);
    let beam = |x: f64| {
        let bent = 1.0 - f64::cosh(k * (0.5 * length - x)) / f64::cosh(0.5 * k * length);
        q * x * (length - x) / (2.0 * tension) - q * ei / (tension * tension) * bent
    };
    let mut compared = 0;
    for node in line.nodes().iter().filter(|node| node.s > 20.0 && node.s < 80.0) {
        assert_close(&format!("drift at s = {:.1}", node.s), node.position.x, beam(-10.0 - node.position.z), 2e-3);
        compared += 1;
    }
    assert!(compared >= 4, "{compared} nodes");
    assert_close("end force across", line.outputs().force.x, 0.5 * q * length, 2e-3);
}

/// Source: a tensioned beam, EI y⁗ = T y″, y(0) = 0, y′(0) = θ, y(L) = y″(L) = 0: M = T θ / (k coth kL - 1/L). To the square of θ = 2°.
#[test]
fn clamped_riser_turns_its_vessel_as_a_tensioned_beam() {
    let (mooring, outputs) = moored(&load("clamped-riser.json"));
    let (length, ei, theta, tension) = (100.0, 1.0e8, 2.0_f64.to_radians(), outputs[0].anchor_tension);
    let k = f64::sqrt(tension / ei);
    let moment = tension * theta / (k / f64::tanh(k * length) - 1.0 / length);
    assert_close("moment at the hang-off", outputs[0].moment.y.abs(), moment, 2e-3);
    let vessel = mooring.bodies(0.0, &[], &outputs)[0];
    assert_close("moment on the vessel", vessel.moment.y, outputs[0].moment.y, 1e-9);
    assert!(vessel.moment.y < 0.0, "it turns the vessel back");
}

/// Source: elastic wave in a bar, ΔT = v √(EA m) behind the front; the anchor sees it after L √(m/EA) = 0.52 s, doubled by its
/// reflection. The fairlead is at full speed from t = 0.54 s on. Means over the plateaus; the front itself rings a little.
#[test]
fn snapping_chain_leaps_by_the_impedance() {
    let (ea, mass, speed, length) = (5.0e8, 135.35_f64, 2.0, 999.9);
    let rows = history(&load("snapping-chain.json"));
    let leap = speed * (ea * mass).sqrt();
    let arrival = length * (mass / ea).sqrt();
    let mean = |from: f64, until: f64, of: fn(&Outputs) -> f64| {
        let here: Vec<f64> = rows.iter().filter(|row| row.time >= from && row.time <= until).map(of).collect();
        here.iter().sum::<f64>() / here.len() as f64 - of(&rows[0])
    };
    assert_close("at the fairlead", mean(0.7, 0.5 + 2.0 * arrival, |row| row.tension), leap, 1e-2);
    assert_close("at the anchor", mean(0.7 + arrival, 0.5 + 3.0 * arrival, |row| row.anchor_tension), 2.0 * leap, 1e-2);
    let before = mean(0.0, 0.4 + arrival, |row| row.anchor_tension) / leap;
    assert!(before.abs() < 1e-2, "{before} of the leap at the anchor before the wave is there");
}

/// Source: Morison's equation with Froude & Krylov's force on a fixed cylinder along the crests, velocities and accelerations by linear
/// theory, stretched after Wheeler; each end holds half. Largest and smallest of the last period; the wire itself gives way by
/// a millimetre and adds 0.2 %.
#[test]
fn wire_under_waves_feels_morison() {
    let rows = history(&load("wire-under-waves.json"));
    let (depth, amplitude, omega, length, z) = (60.0, 3.0, TAU / 9.0, 19.9, -10.0);
    let k = bisect(1e-3, 1.0, |k: f64| GRAVITY * k * (k * depth).tanh() - omega * omega);
    let drag = 0.5 * 1025.0 * 0.4 * 1.0;
    let mass = 1471.0 / GRAVITY + 1025.0 * TAU / 8.0 * 0.4 * 0.4 * 1.0;
    let force = |time: f64| {
        let (sin, cos) = (-omega * time).sin_cos();
        let above_bed = k * (z + depth) * depth / (depth + amplitude * cos);
        let speed = amplitude * omega / (k * depth).sinh();
        let (x, z) = (speed * above_bed.cosh() * cos, speed * above_bed.sinh() * sin);
        0.5 * length * (drag * x.hypot(z) * x + mass * omega * speed * above_bed.cosh() * sin)
    };
    let exact: Vec<f64> = (0..3600).map(|n| force(9.0 * f64::from(n) / 3600.0)).collect();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::MIN, f64::max);
    let last = || rows.iter().filter(|row| row.time >= 36.0).map(|row| row.force.x);
    assert_close("with the waves", largest(&mut last()), largest(&mut exact.iter().copied()), 5e-3);
    assert_close("against them", largest(&mut last().map(|x| -x)), largest(&mut exact.iter().map(|x| -x)), 5e-3);
}

/// Every scene of examples/ is tested here; the built-in case in tests/published.rs, the report's in tests/cable_1994.rs, the two
/// lines for the FMU in tests/fmu/lines.py.
#[test]
fn every_example_has_its_answer() {
    let tests = include_str!("examples.rs");
    let directory = format!("{}/examples", env!("CARGO_MANIFEST_DIR"));
    let names: Vec<String> = std::fs::read_dir(directory)
        .expect("examples/")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| {
            name.ends_with(".json")
                && !["lindahl-sjoberg.json", "ma-webster-1994.json", "two-lines.json"].contains(&name.as_str())
        })
        .collect();
    assert!(names.len() >= 5, "{names:?}");
    for name in names {
        assert!(tests.contains(&format!("load(\"{name}\")")), "{name} has no test");
    }
}

/// Source: elastic catenary in closed form, section by section, with touchdown on a rigid bed (Irvine 1981): from the end force found it
/// reaches the scene's depth and anchor, but for a bed that is soft over 0.2 m (measured 1e-3 in the depth). Tensions are the mean and the
/// maximum of Table 3.3 of the 1994 report, 98 and 102 kips; it gives neither depth nor anchor nor motion, which were chosen for them.
#[test]
fn calm_line_has_the_mean_tension_of_the_report() {
    let pieces = [
        (30.48, 220.25 * GRAVITY - 278.74, 1.77929e9),
        (335.28, 31.22 * GRAVITY - 39.4, 8.8964e8),
        (1005.84, 220.25 * GRAVITY - 278.74, 1.77929e9),
    ];
    let scene = load("calm-line.json");
    let outputs = settled(&scene, 0).outputs();
    assert_close("tension", outputs.tension, 98.0 * 4448.2216, 1e-3);
    let (h, mut v, mut x, mut z) = (outputs.force.x, -outputs.force.z, 0.0, 0.0);
    for (length, weight, ea) in pieces {
        let hanging = f64::min(length, v / weight);
        let below = v - weight * hanging;
        x += h / weight * ((v / h).asinh() - (below / h).asinh()) + h * hanging / ea + (length - hanging) * (1.0 + h / ea);
        z += (h.hypot(v) - h.hypot(below)) / weight + (v + below) / 2.0 * hanging / ea;
        v = below;
    }
    assert_close("depth", z, 85.0, 5e-3);
    assert_close("anchor", x, 1361.13, 4e-5);
    let rows = history(&scene);
    let largest = rows.iter().map(|row| row.tension).fold(0.0, f64::max);
    assert_close("largest tension", largest, 102.0 * 4448.2216, 3e-3);
}

/// A line of one section between the ends where it was found, in closed form (Irvine 1981), hanging or partly on a rigid level bed: its tensions at
/// fairlead and anchor are those of the catenary: to 1e-4 where it hangs under water, 2e-3 where it rises out of it (and weighs more), 1e-3
/// and twice the diameter over the rise where it lies on a bed that is soft over the diameter of the line.
fn hangs_as_a_catenary(scene: &Loaded, index: usize, outputs: &Outputs) {
    let line = &scene.scene.lines[index];
    let of = &scene.scene.line_types[&line.sections[0].line_type];
    let (density, gravity) = (scene.scene.environment.water_density, scene.scene.environment.gravity);
    let piece = [Piece { length: line.length(), weight: of.weight_in_water(density, gravity), ea: of.ea }];
    let (low, high) = if outputs.fairlead.z < outputs.anchor.z {
        (outputs.fairlead, outputs.anchor)
    } else {
        (outputs.anchor, outputs.fairlead)
    };
    let (span, rise) = ((high - low).xy().norm(), high.z - low.z);
    let tensions = if outputs.fairlead.z < outputs.anchor.z {
        [outputs.anchor_tension, outputs.tension]
    } else {
        [outputs.tension, outputs.anchor_tension]
    };
    let name = &line.name;
    if outputs.grounded_length == 0.0 {
        let exact = Hanging::spanning(&piece, span, rise);
        let allowed = if high.z > 0.0 { 2e-3 } else { 1e-4 };
        assert_close(&format!("{name}, upper end"), tensions[0], exact.tension(&piece, piece[0].length), allowed);
        assert_close(&format!("{name}, lower end"), tensions[1], exact.tension(&piece, 0.0), allowed);
        return;
    }
    let Piece { length, weight, ea } = piece[0];
    let allowed = 1e-3 + 2.0 * of.diameter / rise;
    // The length that is lifted by a horizontal force carries the rise.
    let lifted = |h: f64| {
        bisect(0.0, length, |s| h / weight * ((1.0 + (weight * s / h).powi(2)).sqrt() - 1.0) + weight * s * s / (2.0 * ea) - rise)
    };
    let reach = |h: f64| {
        let s = lifted(h);
        (length - s) * (1.0 + h / ea) + h / weight * (weight * s / h).asinh() + h * s / ea
    };
    let h = bisect(0.01 * weight * rise, 100.0 * weight * rise, |h| reach(h) - span);
    assert_close(&format!("{name}, fairlead"), tensions[0], h.hypot(weight * lifted(h)), allowed);
    assert_close(&format!("{name}, anchor"), tensions[1], h, allowed);
}

/// Source: the public data of the OC4 semi-submersible's mooring, on a rigid bed: 1105.7 kN at the fairleads, 907.8 kN at the anchors.
#[test]
fn semi_submersible_pulls_as_its_data_say() {
    let scene = load("semi-submersible.json");
    let (_, outputs) = moored(&scene);
    for (index, line) in outputs.iter().enumerate() {
        assert_close("fairlead", line.tension, 1105.7e3, 1e-4);
        assert_close("anchor", line.anchor_tension, 907.8e3, 1e-4);
        hangs_as_a_catenary(&scene, index, line);
    }
}

/// Source: catenaries on a bed in closed form; the stiffness is that of the catenaries' forces, by differences of their closed form.
#[test]
fn spread_moored_ship_hangs_on_eight_catenaries() {
    let scene = load("spread-moored-ship.json");
    let (mut mooring, outputs) = moored(&scene);
    for (index, line) in outputs.iter().enumerate() {
        assert_close("tension", line.tension, 361.7e3, 1e-3);
        hangs_as_a_catenary(&scene, index, line);
    }
    let stiffness = mooring.stiffness(0, 0.0).expect("a stiffness");
    assert_close("surge", stiffness[0][0], 83.2e3, 3e-3);
    assert_close("sway", stiffness[1][1], 60.6e3, 3e-3);
}

/// Source: every bridle a catenary between the places found, and nothing left over at the points where they meet.
#[test]
fn crowfoot_bridles_meet_in_balance() {
    let scene = load("crowfoot.json");
    let (mut mooring, outputs) = moored(&scene);
    for foot in 0..3 {
        let [one, two, line] = [0, 1, 2].map(|k: usize| &outputs[3 * foot + k]);
        assert!((one.anchor - line.fairlead).norm() < 1e-9, "they do not meet");
        let left = one.anchor_force + two.anchor_force + line.force;
        assert!(left.norm() < 1e-5 * line.tension, "{left:?} N is left");
        assert_close("bridle", one.tension, 1180.0e3, 1e-3);
    }
    (0..9).for_each(|index| hangs_as_a_catenary(&scene, index, &outputs[index]));
    let stiffness = mooring.stiffness(0, 0.0).expect("a stiffness");
    assert_close("yaw", stiffness[5][5], 163.0e6, 5e-3);
}

/// Source: elastic catenary between two ships.
#[test]
fn towline_hangs_between_two_ships() {
    let scene = load("towline.json");
    let (_, outputs) = moored(&scene);
    hangs_as_a_catenary(&scene, 0, &outputs[0]);
    assert_close("tug", outputs[0].tension, 157.0e3, 1e-3);
    assert_close("barge", outputs[0].anchor_tension, 157.6e3, 1e-3);
}

/// Source: Archimedes on a cut cylinder: its volume is that of the wet length of its axis, its centre off the axis by r² tan β/(4L) and at L/2 + r² tan² β/(8L)
/// from the bottom; weight, buoyancy and lines leave neither force nor moment.
#[test]
fn calm_buoy_floats_by_archimedes() {
    let scene = load("calm-buoy.json");
    let (mooring, outputs) = moored(&scene);
    for index in 0..6 {
        hangs_as_a_catenary(&scene, index, &outputs[index]);
    }
    let poses: Vec<_> = mooring.parts.iter().flat_map(|part| part.bodies()).collect();
    let body = mooring.bodies(0.0, &poses, &outputs)[0];
    let beta = -body.pose.angles.y;
    let (radius, mass) = (5.5_f64, 150.0e3);
    let wet = 3.0 - body.pose.position.z / beta.cos();
    let volume = TAU / 2.0 * radius * radius * wet;
    let up = 1025.0 * GRAVITY * volume;
    assert_close("draught", up, mass * GRAVITY - body.force.z, 1e-5);
    let tan = beta.tan();
    let turned = moorline::algebra::rotation::of_angles(&body.pose.angles);
    // The side that leans down is wetter.
    let centre = turned
        * Vector3::new(-radius * radius * tan / (4.0 * wet), 0.0, wet / 2.0 + radius * radius * tan * tan / (8.0 * wet) - 3.0);
    let weight = turned * Vector3::new(0.0, 0.0, -0.8);
    let left = centre.cross(&(Vector3::z() * up)) - weight.cross(&(Vector3::z() * mass * GRAVITY)) + body.moment;
    assert!(left.norm() < 1e-2 * body.moment.norm(), "{left:?} N m is left of {:?}", body.moment);
    assert!((body.pose.position.z - 0.45).abs() < 0.005 && (beta.to_degrees() - 2.0).abs() < 0.02, "{body:?}");
}

/// Source: catenaries, and the balance of each float: what it displaces less what it weighs, and two lines.
#[test]
fn floats_of_a_wave_energy_device_carry_their_lines() {
    let scene = load("wave-energy-floats.json");
    let (_, outputs) = moored(&scene);
    for (index, line) in outputs.iter().enumerate() {
        hangs_as_a_catenary(&scene, index, line);
    }
    for leg in 0..3 {
        let (upper, lower) = (&outputs[2 * leg], &outputs[2 * leg + 1]);
        let z = upper.anchor.z;
        // The float counts as a sphere of its volume.
        let diameter = (6.0 * 33.5 / (TAU / 2.0)).cbrt();
        let zeta = (2.0 * z / diameter).clamp(-1.0, 1.0);
        let wet = 0.25 * (1.0 - zeta) * (1.0 - zeta) * (2.0 + zeta);
        let net = Vector3::z() * (1025.0 * GRAVITY * 33.5 * wet - 16755.0 * GRAVITY);
        let left = net + upper.anchor_force + lower.force;
        assert!(left.norm() < 1e-5 * net.norm().max(lower.tension), "{left:?} N is left at z = {z}");
        assert_close("tension", upper.tension, 70.7e3, 1e-3);
    }
}
