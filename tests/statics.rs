//! Statics against closed forms. Numbers named "reference" come from tests/data/reference-cases.json (12 digits, computed from the
//! closed forms cited at each test); each tolerance is about three times the error measured when the test was written.

mod support;

use moorline::algebra::shape::{GAUSS3, Shape};
use moorline::rod::awash::Surface;
use moorline::rod::mesh::Mesh;
use moorline::rod::physics::Surroundings;
use moorline::rod::properties::Properties;
use moorline::rod::state::{Field, State};
use moorline::scene::read::parse;
use moorline::scene::types::{CurrentPoint, Stretch};
use moorline::sea::current::Current;
use moorline::solve::newton::motion;
use moorline::solve::rounding;
use moorline::solve::simulation::Simulation;
use moorline::solve::start::{self, Bounds};
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::path::Path;
use support::*;

fn settled(scene: &Value) -> Simulation {
    let loaded = parse(&scene.to_string(), "test.json", Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&loaded.scene, 0).unwrap_or_else(|error| panic!("{error}"));
    let fairlead = Vector3::from(loaded.scene.lines[0].fairlead);
    simulation.settle(fairlead, 0.0).unwrap_or_else(|error| panic!("{error}"));
    simulation
}

/// A line of one section hanging free of everything, in equal elements.
fn free_span(case: &str, ea: f64, elements: usize, stretch: Stretch) -> Rig {
    let given = |name: &str| reference(&format!("/{case}/given/{name}"));
    let mesh = uniform(material(ea, 10.0, given("w")), given("L"), elements);
    let last = mesh.nodes() - 1;
    let surroundings = Surroundings { stretch, ..nothing() };
    let mut rig = Rig::new(mesh, surroundings, Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    rig.hang(Vector3::zeros(), Vector3::new(given("X"), 0.0, given("drop")));
    rig
}

/// Source: inextensible catenary, free of the bed (reference a1). EA = 1e11 N stands for inextensible. Measured 1.1e-6 in H at 20
/// elements, each a seventh of the smallest radius of curvature; less in the tensions.
#[test]
fn inextensible_catenary_has_the_end_forces_of_the_closed_form() {
    let rig = free_span("a1_inextensible_suspended", 1.0e11, 20, Stretch::Exact);
    let (top, bottom) = (rig.fairlead_force(), rig.node_forces()[0]);
    let exact = |name: &str| reference(&format!("/a1_inextensible_suspended/{name}"));
    assert_close("T top", top.norm(), exact("T_top"), 2e-6);
    assert_close("T bottom", bottom.norm(), exact("T_bottom"), 3e-6);
    assert_close("H", -top.x, exact("H"), 4e-6);
    assert_close("V top", -top.z, exact("V_top"), 3e-6);
    assert_close("V bottom", bottom.z, exact("V_bottom"), 4e-6);
}

/// Source: elastic catenary (Irvine 1981; reference a3), 1.2 % stretch. Measured at 20 elements: 4e-8 in the forces, 1e-7 of the length in
/// the places.
#[test]
fn elastic_catenary_has_the_end_forces_and_shape_of_the_closed_form() {
    let rig = free_span("a3_elastic_suspended", 3.0e7, 20, Stretch::Exact);
    let (top, bottom) = (rig.fairlead_force(), rig.node_forces()[0]);
    let exact = |name: &str| reference(&format!("/a3_elastic_suspended/{name}"));
    assert_close("H", -top.x, exact("H"), 1.2e-7);
    assert_close("T top", top.norm(), exact("T_top"), 1.2e-7);
    assert_close("T bottom", bottom.norm(), exact("T_bottom"), 1.2e-7);
    for k in 0..3 {
        let point = references(&format!("/a3_elastic_suspended/points_s_x_y_T/{k}"));
        let (s, exact) = (point[0], Vector3::new(400.0 - point[1], 0.0, 250.0 + point[2]));
        assert_small(&format!("place at s = {s}, of the length"), (rig.at(500.0 - s) - exact).norm() / 500.0, 3e-7);
    }
}

/// Source: elastic catenary at 13 % stretch (reference j). Measured at 20 elements: 2e-9 and less.
#[test]
fn large_stretch_obeys_hooke_in_engineering_strain() {
    let rig = free_span("j_large_stretch", 5.0e4, 20, Stretch::Exact);
    let exact = |name: &str| reference(&format!("/j_large_stretch/{name}"));
    assert_close("H", -rig.fairlead_force().x, exact("H"), 6e-9);
    assert_close("T top", rig.fairlead_force().norm(), exact("T_top"), 6e-9);
    assert_close("T bottom", rig.node_forces()[0].norm(), exact("T_bottom"), 6e-9);
    let middle = rig.at(50.0);
    assert_close("x in the middle", 100.0 - middle.x, exact("mid_s_x"), 6e-9);
    assert_close("z in the middle", middle.z - 50.0, exact("mid_s_y"), 6e-9);
}

/// Source: the same line with the report's law, λ r′ = F, r′·r′ = 1 + 2λ/EA (reference j, `first_order_law`): tension 16 % higher.
/// Measured 3e-11.
#[test]
fn large_stretch_with_the_law_of_the_report_is_as_stiff_as_the_report_has_it() {
    let rig = free_span("j_large_stretch", 5.0e4, 20, Stretch::Report);
    let exact = |name: &str| reference(&format!("/j_large_stretch/first_order_law_{name}"));
    assert_close("H", -rig.fairlead_force().x, exact("H"), 6e-9);
    assert_close("V top", -rig.fairlead_force().z, exact("V_top"), 6e-9);
    assert_close("T top", rig.fairlead_force().norm(), exact("T_top"), 6e-9);
}

/// Source: inextensible catenary with touchdown on a rigid bed (reference a2). The bed is 200 times stiffer than the default; EA = 3e11 N,
/// whose stretch of 1.7 mm is the larger part of the error: 7e-5 in T, 9e-5 in H. Touchdown is smeared over √(H/k) = 0.6 m.
#[test]
fn inextensible_catenary_on_a_hard_bed_lifts_off_where_the_closed_form_does() {
    let case = "/a2_inextensible_touchdown";
    let exact = |name: &str| reference(&format!("{case}/{name}"));
    let simulation = settled(&json!({
        "environment": {"depth": 200.0, "surface": "none", "seabed": {"stiffness": 2.0e6}},
        "line_types": {"rope": {"ea": 3.0e11, "mass": 120.0, "diameter": 0.1, "submerged_weight": 1000.0}},
        "lines": [{"fairlead": [0, 0, 0], "anchor": [800, 0, -200], "sections": [{"type": "rope", "length": 850, "elements": 200}]}],
    }));
    let outputs = simulation.outputs();
    assert_close("T top", outputs.tension, exact("T_top"), 2e-4);
    assert_close("H", outputs.force.x, exact("H"), 3e-4);
    assert_close("H at the anchor", -outputs.anchor_force.x, exact("H"), 3e-4);
    assert_close("suspended length", 850.0 - outputs.grounded_length, exact("suspended_length"), 3e-3);
    assert_close("angle", outputs.declination.to_degrees(), 90.0 - exact("top_angle_deg"), 1e-4);
}

/// Source: elastic catenary with touchdown on a rigid bed (reference a4), the built-in line on a bed 1000 times stiffer than its own.
/// Measured 1.8e-6 in the tensions; places to 2e-5 m, and to 9e-5 m next to the touchdown.
#[test]
fn elastic_catenary_on_a_stiff_bed_has_the_tension_and_shape_of_the_closed_form() {
    let exact = |name: &str| reference(&format!("/a4_elastic_touchdown/{name}"));
    let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the built-in scene");
    scene["environment"]["seabed"]["stiffness"] = json!(5.0752591e6);
    scene["environment"]["surface"] = json!("none");
    scene["lines"][0]["sections"][0]["elements"] = json!(240);
    let simulation = settled(&scene);
    let outputs = simulation.outputs();
    assert_close("T top", outputs.tension, exact("T_top"), 6e-6);
    assert_close("H", outputs.force.x, exact("H"), 6e-6);
    assert_close("V top", -outputs.force.z, exact("V_top"), 6e-6);
    assert_close("H at the anchor", outputs.anchor_tension, exact("H"), 6e-6);
    let nodes = simulation.nodes();
    for k in 0..6 {
        let point = references(&format!("/a4_elastic_touchdown/points_s_x_y_T/{k}"));
        let node = nodes.iter().find(|node| (node.s - point[0]).abs() < 1e-6).expect("a node at each point");
        let place = Vector3::new(point[1], 0.0, point[2]);
        assert_small(&format!("place at s = {}, metres", node.s), (node.position - place).norm(), 3e-4);
        assert_close(&format!("T at s = {}", node.s), node.tension, point[3], 6e-6);
    }
}

/// The order of the static end tension in the element length: (case, EA, numbers of elements, lowest rate wanted). Measured 4.96 and
/// 5.74; 4.92 and 5.62 at large stretch, whose error is at rounding from 16 elements on.
const STATIC_ORDERS: [(&str, f64, &[usize], f64); 2] =
    [("a3_elastic_suspended", 3.0e7, &[8, 16, 32], 4.7), ("j_large_stretch", 5.0e4, &[2, 4, 8], 4.7)];

/// Source: closed forms of the elastic catenary; Hermite elements with consistent end forces converge much faster than their cubic.
#[test]
fn static_tension_converges_with_order_five_or_more() {
    for (case, ea, elements, wanted) in STATIC_ORDERS {
        let exact = reference(&format!("/{case}/T_top"));
        let error = |n: usize| (free_span(case, ea, n, Stretch::Exact).fairlead_force().norm() / exact - 1.0).abs();
        let errors: Vec<f64> = elements.iter().map(|n| error(*n)).collect();
        for pair in errors.windows(2) {
            let rate = (pair[0] / pair[1]).log2();
            println!("{case}: {:.2e} to {:.2e}, order {rate:.2}", pair[0], pair[1]);
            assert!(rate > wanted, "{case}: errors {errors:?}, order {rate}");
        }
    }
}

/// A clamped–free column along z, clamped at the fairlead (last node) at the origin at the origin; the free end is node 0.
fn column(ei: f64, ea: f64, elements: usize, load: Vector3<f64>) -> Rig {
    let mesh = uniform(Properties { ei, ..material(ea, 1.0, 0.0) }, 1.0, elements);
    let last = mesh.nodes() - 1;
    let holding = Holding::none().hold(last, &[X, Y, Z, 3, 4, 5]).hold_all(&mesh, &[Y, 4]).load(0, load);
    Rig::new(mesh, nothing(), holding)
}

/// A circular arc of total turn `angle` that leaves the clamp (s = 1, at the origin) along +x, bending towards +z.
fn arc(angle: f64) -> impl Fn(f64) -> (Vector3<f64>, Vector3<f64>) {
    move |s| {
        let a = angle * (1.0 - s);
        let place = Vector3::new(a.sin(), 0.0, 1.0 - a.cos()) / angle;
        (place, -Vector3::new(a.cos(), 0.0, a.sin()))
    }
}

/// Source: elastica, clamped–free column under a dead axial load (Timoshenko & Gere 1961; reference b1), tip rotations 20° to 176°.
/// EA l²/EI = 1e7 stands for inextensible. Measured at 50 elements: 1.6e-4 degrees and 2.4e-5 of the length (at 176°; 7e-6 up to 160°).
#[test]
fn elastica_takes_the_shapes_of_the_closed_form() {
    let critical = std::f64::consts::PI.powi(2) / 4.0;
    for k in 0..9 {
        let exact = |name: &str| reference(&format!("/b1_elastica_table/{k}/{name}"));
        let alpha = exact("alpha_deg").to_radians();
        let mut rig = column(1.0, 1.0e7, 50, Vector3::new(-critical * exact("P_over_Pc"), 0.0, 0.0));
        rig.place(arc(alpha * 1.02));
        rig.settle();
        let tip = rig.state.u.position(0);
        let slope = rig.state.u.slope(0);
        let turned = (-slope.z).atan2(-slope.x).to_degrees();
        let name = |what: &str| format!("{what} at {}°", exact("alpha_deg"));
        assert_small(&name("rotation, degrees"), turned - exact("alpha_deg"), 5e-4);
        assert_small(&name("along"), tip.x - exact("along_over_l"), 7e-5);
        assert_small(&name("lateral"), tip.z - exact("lateral_over_l"), 7e-6);
    }
}

/// Source: elastica for the two loads of the report's Table 3.2 (reference b2). Measured 2.4e-5 along, 2.1e-6
/// across.
#[test]
fn elastica_bends_as_far_as_the_load_says() {
    let critical = std::f64::consts::PI.powi(2) / 4.0;
    for k in 0..2 {
        let exact = |name: &str| reference(&format!("/b2_elastica_from_load/{k}/{name}"));
        let mut rig = column(1.0, 1.0e7, 50, Vector3::new(-critical * exact("P_over_Pc"), 0.0, 0.0));
        rig.place(arc(exact("alpha_deg").to_radians()));
        rig.settle();
        let tip = rig.state.u.position(0);
        assert_small("along", tip.x - exact("along_over_l"), 7e-5);
        assert_small("lateral", tip.z - exact("lateral_over_l"), 7e-6);
    }
}

/// Source: cantilever under a transverse dead tip load (Bisshopp & Drucker 1945; reference b3), deflections to 0.8 of the length.
/// Measured at 40 elements: 1.3e-5 of the length at the largest load.
#[test]
fn cantilever_bends_as_bisshopp_and_drucker_have_it() {
    for k in 0..4 {
        let exact = |name: &str| reference(&format!("/b3_cantilever_tip_load/{k}/{name}"));
        let mut rig = column(1.0, 1.0e7, 40, Vector3::new(0.0, 0.0, exact("PL2_over_EI")));
        rig.stretch(Vector3::new(1.0, 0.0, 0.0), Vector3::zeros());
        rig.settle();
        let (tip, slope) = (rig.state.u.position(0), rig.state.u.slope(0));
        assert_small("lateral", tip.z - exact("tip_lateral_over_L"), 4e-5);
        assert_small("along", tip.x - exact("tip_along_over_L"), 4e-5);
        assert_small("angle, degrees", (-slope.z).atan2(-slope.x).to_degrees() - exact("tip_angle_deg"), 1e-3);
        assert_close("shear at the clamp", rig.fairlead_force().z, exact("PL2_over_EI"), 1e-9);
    }
}

/// A cantilever whose EA jumps at midspan while EI does not: the slopes at the joint may differ in size, and the bending moment passes
/// it, so it bends like the uniform one (Bisshopp & Drucker, as above; both halves are near inextensible). Measured: 2e-5 of the length.
#[test]
fn a_jump_of_axial_stiffness_does_not_hinge_a_beam() {
    let exact = |name: &str| reference(&format!("/b3_cantilever_tip_load/1/{name}"));
    let half = |ea: f64| Properties { ei: 1.0, ..material(ea, 1.0, 0.0) };
    let mesh = Mesh::new(vec![half(1.0e7), half(2.0e7)], &[vec![0.025; 20], vec![0.025; 20]]);
    assert!(mesh.elements.iter().any(|element| element.is_joint()));
    let last = mesh.nodes() - 1;
    let force = Vector3::new(0.0, 0.0, exact("PL2_over_EI"));
    let holding = Holding::none().hold(last, &[X, Y, Z, 3, 4, 5]).load(0, force);
    let mut rig = Rig::new(mesh, nothing(), holding);
    rig.stretch(Vector3::new(1.0, 0.0, 0.0), Vector3::zeros());
    rig.settle();
    let tip = rig.state.u.position(0);
    assert_small("lateral", tip.z - exact("tip_lateral_over_L"), 6e-5);
    assert_small("along", tip.x - exact("tip_along_over_L"), 6e-5);
}

/// Source: pure bending. Turning the free end by 2π closes a rod of length L to a circle of radius L/2π, and the couple on the clamp is
/// 2π EI/L. The end is turned by prescribing its slope; its place is free.
/// Measured at 40 elements: gap 6e-7, diameter 4e-5, couple 8e-5.
#[test]
fn pure_bending_closes_a_rod_to_a_circle() {
    let tau = 2.0 * std::f64::consts::PI;
    let mesh = uniform(Properties { ei: 1.0, ..material(1.0e6, 1.0, 0.0) }, 1.0, 40);
    let last = mesh.nodes() - 1;
    let holding = Holding::none().hold(last, &[X, Y, Z, 3, 4, 5]).hold(0, &[3, 4, 5]).hold_all(&mesh, &[Y, 4]);
    let mut rig = Rig::new(mesh, nothing(), holding);
    rig.place(arc(0.95 * tau));
    rig.state.u.set_slope(0, &-Vector3::x());
    // There is neither weight nor tension that the unbalanced force could be compared with, so it is compared with EI/L².
    let balance = rig.balance();
    assert_small("unbalanced force", balance.residual, 1e-7);
    assert_small("gap", rig.state.u.position(0).norm(), 2e-6);
    assert_close("diameter", rig.at(0.5).norm(), 1.0 / std::f64::consts::PI, 1e-4);
    let mut residual = rig.state.u.clone();
    rig.line.residual(&motion(&rig.state), &mut residual);
    assert_close("couple on the clamp", residual.slope(last).z.abs(), tau, 3e-4);
}

/// Source: weight of what hangs below, T(s) = T₀ + w s and z(s) = s + (T₀ s + w s²/2)/EA. Cubic elements hold this exactly. What is left is
/// where statics stops: held at both ends at 2e-12, hanging free (its lowest element has no stiffness to speak of) within 1e-7 of its weight,
/// which is what statics aims at.
#[test]
fn vertical_line_hangs_in_its_own_weight() {
    let (length, weight, ea) = (100.0, 500.0, 1.0e7);
    let mesh = uniform(material(ea, 60.0, weight), length, 20);
    let last = mesh.nodes() - 1;
    let mut rig = Rig::new(mesh, nothing(), Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    // Taut: stretched by 1 %, T = EA·0.01 in the middle and ± w L/2 at the ends.
    rig.hang(Vector3::zeros(), Vector3::new(0.0, 0.0, 101.0));
    assert_close("T top", rig.fairlead_force().norm(), 0.01 * ea + 0.5 * weight * length, 5e-10);
    assert_close("T bottom", rig.node_forces()[0].norm(), 0.01 * ea - 0.5 * weight * length, 5e-10);
    let exact = |s: f64| s + ((0.01 * ea - 0.5 * weight * length) * s + 0.5 * weight * s * s) / ea;
    assert_small("place at a third", rig.at(length / 3.0).z - exact(length / 3.0), 1e-8);
    // Free at the lower end: T = w s, elongation w L²/2EA.
    let mesh = uniform(material(ea, 60.0, weight), length, 20);
    let mut rig = Rig::new(mesh, nothing(), Holding::none().hold(last, &[X, Y, Z]));
    rig.stretch(Vector3::zeros(), Vector3::new(0.0, 0.0, length));
    rig.settle();
    assert_close("weight", rig.fairlead_force().norm(), weight * length, 1e-7);
    assert_close("elongation", -rig.state.u.position(0).z, 0.5 * weight * length * length / ea, 1e-7);
}

/// Source: symmetry. A line of weight -w is the line of weight w upside down: the same equations with z negated, so the same numbers to
/// the last bit.
#[test]
fn buoyant_line_is_the_mirror_of_the_sinking_one() {
    let span = |weight: f64, drop: f64| {
        let mesh = uniform(material(3.0e7, 10.0, weight), 500.0, 20);
        let last = mesh.nodes() - 1;
        let mut rig = Rig::new(mesh, nothing(), Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
        rig.hang(Vector3::zeros(), Vector3::new(400.0, 0.0, drop));
        rig
    };
    let (sinking, floating) = (span(700.0, 250.0), span(-700.0, -250.0));
    let mirrored = |node: usize| {
        let (down, up) = (sinking.state.u.position(node), floating.state.u.position(node));
        (down - Vector3::new(up.x, up.y, -up.z)).norm()
    };
    assert_small("mirrored place", (0..=sinking.last()).map(mirrored).fold(0.0, f64::max), 0.0);
    let (down, up) = (sinking.fairlead_force(), floating.fairlead_force());
    assert_small("mirrored force", (down - Vector3::new(up.x, up.y, -up.z)).norm() / down.norm(), 0.0);
}

fn current(x: f64) -> Option<Current> {
    Some(Current::new(&[CurrentPoint { z: 0.0, velocity: [x, 0.0, 0.0] }]))
}

/// Source: neutral line across a current with normal drag (reference h3): tension is constant, the shape a catenary of parameter T/R
/// lying flat in the direction of the current. The first guess hangs down: statics has to find its way.
/// EA = 1e9 N stands for inextensible; its stretch makes the error: measured 5.6e-6.
#[test]
fn neutral_line_across_a_current_is_a_catenary_lying_down() {
    let case = "/h3_neutral_cable_uniform_current";
    let exact = |name: &str| reference(&format!("{case}/{name}"));
    let simulation = settled(&json!({
        "environment": {"depth": 500.0, "water_density": exact("given/rho"), "current": [{"z": 0.0, "velocity": [1, 0, 0]}]},
        "line_types": {"rope": {"ea": 1.0e9, "mass": 2.0, "diameter": 0.05, "submerged_weight": 0.0, "drag": {"normal": 1.2}}},
        "lines": [{"fairlead": [0, 50, -200], "anchor": [0, -50, -200], "sections": [{"type": "rope", "length": 120, "elements": 40}]}],
    }));
    let outputs = simulation.outputs();
    assert_close("T at the fairlead", outputs.tension, exact("T_constant"), 2e-5);
    assert_close("T at the anchor", outputs.anchor_tension, exact("T_constant"), 2e-5);
    let forward = outputs.force.x + outputs.anchor_force.x;
    assert_close("force of the current", forward, exact("resultant_downstream_force_total"), 2e-5);
    let sag = simulation.nodes().iter().map(|node| node.position.x).fold(0.0, f64::max);
    assert_close("sag", sag, exact("max_downstream_sag"), 2e-5);
    let tensions: Vec<f64> = simulation.nodes().iter().map(|node| node.tension).collect();
    assert_close("least T at a node", tensions.iter().copied().fold(f64::INFINITY, f64::min), exact("T_constant"), 2e-5);
    assert_close("largest T at a node", tensions.iter().copied().fold(0.0, f64::max), exact("T_constant"), 2e-5);
}

/// Source: towed line at its critical angle (reference h2): straight, w cos φ = R sin² φ, T = w s sin φ. The free end is node 0; the
/// water runs at -V past a ship at rest. Measured 5.5e-7, the stretch at EA = 1e9 N.
#[test]
fn towed_line_hangs_straight_at_the_critical_angle() {
    let case = "/h2_towed_critical_angle";
    let exact = |name: &str| reference(&format!("{case}/{name}"));
    let (length, weight) = (200.0, 10.0);
    let mesh = uniform(Properties { drag_normal: 0.5 * 1025.0 * 1.2 * 0.02, ..material(1.0e9, 2.0, weight) }, length, 20);
    let last = mesh.nodes() - 1;
    let around = Surroundings { current: current(-1.5), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none().hold(last, &[X, Y, Z]));
    rig.stretch(Vector3::new(-100.0, 0.0, -173.2), Vector3::zeros());
    rig.settle();
    let end = rig.state.u.position(0);
    assert_close("depth", -end.z, exact("depth_of_free_end"), 2e-6);
    assert_close("layback", -end.x, exact("layback"), 2e-6);
    assert_close("T top", rig.fairlead_force().norm(), exact("top_tension_normal_drag_only"), 2e-6);
    assert_close("angle", (end.z / end.x).atan().to_degrees(), exact("angle_below_horizontal_deg"), 2e-6);
}

/// Source: heavy line in a current with an end weight (reference h4; Pode's integrals with normal drag only). Measured at 20
/// elements 7e-7, and 7e-6 in the offset.
#[test]
fn heavy_line_with_an_end_weight_in_a_current_has_the_tension_of_pode() {
    let case = "/h4_heavy_cable_uniform_current_end_weight";
    let exact = |name: &str| reference(&format!("{case}/{name}"));
    let mesh = uniform(Properties { drag_normal: 0.5 * 1025.0 * 1.2 * 0.05, ..material(1.0e10, 5.0, 50.0) }, 200.0, 20);
    let last = mesh.nodes() - 1;
    let around = Surroundings { current: current(1.0), ..nothing() };
    let holding = Holding::none().hold(last, &[X, Y, Z]).load(0, Vector3::new(0.0, 0.0, -2000.0));
    let mut rig = Rig::new(mesh, around, holding);
    rig.stretch(Vector3::new(0.0, 0.0, -200.0), Vector3::zeros());
    rig.settle();
    let (end, force) = (rig.state.u.position(0), rig.fairlead_force());
    assert_close("T top", force.norm(), exact("T_top"), 2e-6);
    assert_close("H top", force.x, exact("H_top"), 2e-6);
    assert_close("offset", end.x, exact("horizontal_offset_of_end"), 2e-5);
    assert_close("depth", -end.z, exact("vertical_depth_of_end"), 2e-6);
}

const WINKLER: f64 = 5075.2591;

/// A line along x on a bed at z = 0 that reaches down to the rest of the line, ends held in x and y only, stretched to a tension.
fn lying(ei: f64, ea: f64, tension: f64, point_load: f64) -> Rig {
    let (length, elements) = (200.0, 1200);
    let half = Properties { ei, ..material(ea, 135.35, 1157.1590775) };
    // A hair of damping makes the halves different, so that the slope may jump under the load where nothing resists bending.
    let other = Properties { damping: if ei > 0.0 { 0.0 } else { 1e-9 }, ..half };
    let lengths = vec![length / elements as f64; elements / 2];
    let mesh = Mesh::new(vec![half, other], &[lengths.clone(), lengths]);
    let last = mesh.nodes() - 1;
    let around = Surroundings { ground: Some(bed(&mesh, 0.0, WINKLER, 0.0)), ..nothing() };
    let holding = Holding::none()
        .hold(0, &[X])
        .hold(last, &[X])
        .hold_all(&mesh, &[Y, 4])
        .load(elements / 2, Vector3::new(0.0, 0.0, -point_load));
    let mut rig = Rig::new(mesh, around, holding);
    let depth = Vector3::new(0.0, 0.0, -0.2);
    rig.stretch(depth, depth + Vector3::new(length * (1.0 + tension / ea), 0.0, 0.0));
    rig.settle();
    rig
}

/// Source: Winkler bed (reference i1): a line at rest sinks in by w/k. Measured 8e-13.
#[test]
fn line_at_rest_sinks_into_the_bed_by_its_weight_over_the_stiffness() {
    let rig = lying(0.0, 5.0e8, 1.0e6, 0.0);
    let heights = rig.state.u.component(Z);
    for height in [heights.iter().copied().fold(0.0, f64::min), heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)] {
        assert_close("penetration", -height, reference("/i1_lying/penetration"), 1e-10);
    }
}

/// Source: taut string on a Winkler bed under a point load (reference i2): deflection P/(2√(kT)), decay length √(T/k). T stands
/// for T/(1 + e), the tension per unstretched slope. The slope jumps under the load, so the line has two slopes there. Measured 2.4e-5: the
/// load adds a little tension.
#[test]
fn string_on_the_bed_yields_to_a_point_load() {
    let (tension, load) = (reference("/i2_string_on_winkler/given/T"), 1.0e3);
    let rig = lying(0.0, 1.0e10, tension, load);
    let rest = reference("/i1_lying/penetration");
    let per_slope = tension / (1.0 + tension / 1.0e10);
    let deflection = |s: f64| -rig.at(s).z - rest;
    // The reference is for 1e4 N.
    let exact = reference("/i2_string_on_winkler/deflection_under_point_load") * 0.1 * (tension / per_slope).sqrt();
    assert_close("deflection", deflection(100.0), exact, 7e-5);
    let decay = 10.0 / (deflection(95.0) / deflection(85.0)).ln();
    assert_close("decay length", decay, reference("/i2_string_on_winkler/decay_length"), 1e-3);
}

/// Source: beam on a Winkler bed under a point load, without and with tension (Hetényi 1946; reference i3). The load of the test is
/// a hundredth of the reference's, so that the line stays linear and on the bed. Measured 6e-5 in the deflections
/// (stretch), 2e-4 and 2.7e-3 in the moments, taken from the curvature, which converges with the square of the element length.
#[test]
fn beam_on_the_bed_yields_to_a_point_load() {
    let case = "/i3_beam_on_winkler_point_load";
    let exact = |name: &str| reference(&format!("{case}/{name}"));
    let rest = reference("/i1_lying/penetration");
    for (tension, deflection, moment) in [(0.0, "w0_T0", "M0_T0"), (exact("given/T"), "w0_with_T", "M0_with_T")] {
        let rig = lying(exact("given/EI"), 1.0e10, tension, 0.01 * exact("given/P"));
        assert_close(deflection, (-rig.at(100.0).z - rest) / 0.01, exact(deflection), 2e-4);
        // EI r″ at the load, from the end of the element beside it.
        let (u, n) = (&rig.state.u, Shape::at(1.0).scaled(200.0 / 1200.0).curvature);
        let curvature = u.position(599) * n[0] + u.slope(599) * n[1] + u.position(600) * n[2] + u.slope(600) * n[3];
        assert_close(moment, curvature.z * exact("given/EI") / 0.01, exact(moment), 8e-3);
    }
}

/// Sections of a line in which EA jumps by 20 and the weight by 3, from the anchor.
const PIECES: [Piece; 2] = [Piece { length: 300.0, weight: 900.0, ea: 4.0e8 }, Piece { length: 250.0, weight: 300.0, ea: 2.0e7 }];

fn two_sections(pieces: &[Piece; 2], elements: usize) -> Rig {
    let sections = pieces.iter().map(|p| material(p.ea, 100.0, p.weight)).collect();
    let lengths: Vec<Vec<f64>> = pieces.iter().map(|p| vec![p.length / elements as f64; elements]).collect();
    let mesh = Mesh::new(sections, &lengths);
    let last = mesh.nodes() - 1;
    let mut rig = Rig::new(mesh, nothing(), Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    rig.hang(Vector3::zeros(), Vector3::new(450.0, 0.0, 200.0));
    rig
}

/// Source: elastic catenary section by section, integrated in the test. EA jumps, so |r′| does; tension must not ripple, neither at the
/// nodes nor at the Gauss points. Measured at 60 elements per section: 2e-10 at ends and nodes, 3.1e-4 at the Gauss points, evenly along the
/// stiff section (it falls with the third power of the element length).
#[test]
fn tension_does_not_ripple_where_the_stiffness_jumps() {
    for (what, pieces) in [
        ("EA and w jump", PIECES),
        ("EA jumps", [PIECES[0], Piece { weight: 900.0, ..PIECES[1] }]),
        ("w jumps", [PIECES[0], Piece { ea: 4.0e8, ..PIECES[1] }]),
    ] {
        let exact = Hanging::spanning(&pieces, 450.0, 200.0);
        let rig = two_sections(&pieces, 60);
        let mesh = rig.line.mesh();
        assert_eq!(mesh.elements.iter().any(|e| e.is_joint()), pieces[0].ea != pieces[1].ea);
        assert_close(&format!("{what}: H"), -rig.fairlead_force().x, exact.horizontal, 1e-9);
        assert_close(&format!("{what}: T top"), rig.fairlead_force().norm(), exact.tension(&pieces, 550.0), 1e-9);
        let forces = rig.node_forces();
        let worst = (0..=rig.last())
            .map(|node| (forces[node].norm() / exact.tension(&pieces, mesh.node_arc_length(node)) - 1.0).abs())
            .fold(0.0, f64::max);
        assert_small(&format!("{what}: T at the nodes"), worst, 1e-9);
        let mut tensions = vec![0.0; 3 * mesh.elements.len()];
        rig.line.tensions(&rig.state.u, &rig.state.v, &mut tensions);
        let mut worst: f64 = 0.0;
        for (e, element) in mesh.elements.iter().enumerate().filter(|(_, element)| !element.is_joint()) {
            for (g, gauss) in GAUSS3.iter().enumerate() {
                let s = element.start + gauss.x * element.length;
                worst = worst.max((tensions[3 * e + g] / exact.tension(&pieces, s) - 1.0).abs());
            }
        }
        assert_small(&format!("{what}: T at the Gauss points"), worst, 1e-3);
    }
}

/// The chain of the built-in case, settled on its bed.
fn built_in_line(elements: usize, anchor: f64, stretch: Stretch) -> Rig {
    let mesh = uniform(chain(), 1200.0, elements);
    let last = mesh.nodes() - 1;
    let ground = bed(&mesh, -120.0, WINKLER, 1157.1590775 / WINKLER);
    let bounds = Bounds { bed: Some(ground.plane), surface: false };
    let around = Surroundings { stretch, ground: Some(ground), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    let anchor = Vector3::new(anchor, 0.0, -120.0);
    start::guess(rig.line.mesh(), &bounds, &anchor, &Vector3::zeros(), &mut rig.state.u);
    rig.settle();
    rig
}

/// Source: central differences of the fairlead force, settled anew 1 mm to each side; statics is good to 1e-7 of the weight (0.14 N),
/// of 8 N to 100 N of change. Measured 4e-6, 3e-9, 1.4e-5.
#[test]
fn fairlead_stiffness_is_the_change_of_the_force_with_the_place() {
    let mut rig = built_in_line(40, 1183.97, Stretch::Exact);
    let (start, last, d) = (rig.state.clone(), rig.last(), 1e-3);
    let stiffness = rig.newton.fairlead_stiffness(rig.line.as_ref(), &start).expect("a stiff line");
    for c in 0..3 {
        let mut force = |sign: f64| {
            rig.state = start.clone();
            let mut place = Vector3::zeros();
            place[c] = sign * d;
            rig.state.u.set_position(last, &place);
            rig.settle();
            rig.fairlead_force()
        };
        let slope = -(force(1.0) - force(-1.0)) / (2.0 * d);
        let column = stiffness.column(c).into_owned();
        assert_small(&format!("column {c} against differences"), (column - slope).norm() / column.norm(), 5e-5);
    }
}

/// Source: an independent implementation of the same element on 40 elements, law of the report, anchor at 1183.99198 m:
/// 99247.168, 23157.656, 8004.039 and lateral 1008.843 N/m. Measured 7e-6; x points towards the anchor here, so the mixed term is negative.
#[test]
fn fairlead_stiffness_of_the_built_in_line_is_that_of_an_independent_program() {
    let mut rig = built_in_line(40, 1183.99198, Stretch::Report);
    let stiffness = rig.newton.fairlead_stiffness(rig.line.as_ref(), &rig.state).expect("a stiff line");
    let exact = [(0, 0, 99247.168), (2, 0, -23157.656), (0, 2, -23157.656), (2, 2, 8004.039), (1, 1, 1008.843)];
    for (row, column, exact) in exact {
        assert_close(&format!("K[{row}][{column}]"), stiffness[(row, column)], exact, 2e-5);
    }
}

/// Source: weights. A vertical line through the water surface is heavier above it: the difference of the end tensions is the weight in
/// water of the wet part and the weight in air of the dry part, the boundary lying where z(s) = 0.
/// Measured 1.3e-8: the draught of the element awash is cut exactly.
#[test]
fn line_through_the_surface_carries_its_weight_in_air_above_it() {
    let (wet, dry, ea, length) = (500.0, 900.0, 1.0e7, 70.0);
    let properties = Properties { weight_in_air: dry, ..material(ea, 100.0, wet) };
    let mesh = uniform(properties, length, 7);
    let last = mesh.nodes() - 1;
    let around = Surroundings { surface: Some(Surface::new(&mesh)), ..nothing() };
    let mut rig = Rig::new(mesh, around, Holding::none().hold(0, &[X, Y, Z]).hold(last, &[X, Y, Z]));
    rig.hang(Vector3::new(0.0, 0.0, -47.0), Vector3::new(0.0, 0.0, 24.0));
    let bottom = rig.node_forces()[0].norm();
    let crossing = bisect(0.0, length, |s| -47.0 + s + (bottom * s + 0.5 * wet * s * s) / ea);
    let top = bottom + wet * crossing + dry * (length - crossing);
    assert_close("T top", rig.fairlead_force().norm(), top, 4e-8);
    // And the stretch fits: from the surface up, T grows by the weight in air.
    let at_surface = bottom + wet * crossing;
    let rest = length - crossing;
    assert_small("stretch, metres", rest + (at_surface * rest + 0.5 * dry * rest * rest) / ea - 24.0, 3e-8);
}

/// Source: balance of forces. At rest, what the line does to vessel, anchor and bed adds up to its weight; the push of the bed is
/// integrated here from the shape, with 2000 points per element. Measured 5e-9.
#[test]
fn forces_on_vessel_anchor_and_bed_add_up_to_the_weight() {
    let rig = built_in_line(40, 1183.97, Stretch::Exact);
    let onset = 1157.1590775 / WINKLER;
    let points = 80_000;
    let ds = 1200.0 / points as f64;
    let push: f64 = (0..points).map(|k| WINKLER * (-120.0 + onset - rig.at((k as f64 + 0.5) * ds).z).max(0.0) * ds).sum();
    let weight = 1157.1590775 * 1200.0;
    let sum = rig.fairlead_force() + rig.node_forces()[0] + Vector3::new(0.0, 0.0, -push);
    assert_small("vertical", (sum.z + weight) / weight, 2e-8);
    assert_small("along", sum.x / weight, 1e-9);
    assert_small("sideways", sum.y / weight, 1e-12);
}

/// Source: inextensible catenary (reference a1), EA 1e9 times the weight: what rounding of the positions leaves out of balance is 5 times
/// what is allowed to other lines. It counts as equilibrium, and the end tension is right to that.
#[test]
fn a_line_too_stiff_for_its_digits_is_in_equilibrium_to_rounding() {
    let mut rig = free_span("a1_inextensible_suspended", 1.0e13, 20, Stretch::Exact);
    let balance = rig.settle();
    let exact = reference("/a1_inextensible_suspended/T_top");
    assert_close("T top", rig.fairlead_force().norm(), exact, 1e-5);
    println!("allowed: {:.2e} of the weight, unbalanced: {:.2e}", balance.allowed / 1.0e4, balance.residual / 1.0e4);
    assert!((2e-6..2e-5).contains(&(balance.allowed / 1.0e4)), "{balance:?}");
}

/// Source: differences. When every unknown moves by a thousand times its rounding, in a random direction, no residual changes by more than a
/// thousand times its bound, and some by nearly as much. Measured 1.00.
#[test]
fn what_rounding_does_to_the_residual_is_bounded() {
    let rig = free_span("a1_inextensible_suspended", 1.0e11, 20, Stretch::Exact);
    let bound = rounding::bound(rig.line.as_ref(), &rig.state);
    let residual = |state: &State| {
        let mut residual = Field::new(state.u.nodes());
        rig.line.residual(&motion(state), &mut residual);
        residual
    };
    let before = residual(&rig.state);
    let (mut largest, mut seed, factor): (f64, u64, f64) = (0.0, 1, 1.0e3);
    for _ in 0..100 {
        let mut state = rig.state.clone();
        for x in state.u.data_mut() {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let sign = if seed >> 63 == 0 { 1.0 } else { -1.0 };
            *x += sign * factor * 0.5 * f64::EPSILON * *x;
        }
        let after = residual(&state);
        for c in 0..6 {
            for node in 0..state.u.nodes() {
                let allowed = bound.component(c)[node];
                if allowed > 0.0 {
                    largest = largest.max((after.component(c)[node] - before.component(c)[node]).abs() / (factor * allowed));
                }
            }
        }
    }
    println!("largest change {largest:.2} of the bound");
    assert!((0.9..=1.02).contains(&largest), "{largest}");
}

/// Source: definition. A weightless line 1.4 times as long as the way between its ends pulls at nothing: its tension is zero everywhere, to the
/// last digit, though it is as stiff as a chain.
#[test]
fn a_weightless_slack_line_pulls_at_nothing() {
    let simulation = settled(&json!({
        "environment": {"depth": 44.0, "surface": "none"},
        "line_types": {"rope": {"ea": 2.4e9, "mass": 27.0, "diameter": 0.07, "submerged_weight": 0.0}},
        "lines": [{"fairlead": [0, 0, 0], "anchor": [25.4, 0, -43.7], "sections": [{"type": "rope", "length": 70, "elements": 26}]}],
    }));
    assert_eq!((simulation.outputs().tension, simulation.outputs().anchor_tension), (0.0, 0.0));
    assert!(simulation.nodes().iter().all(|node| node.tension == 0.0));
}
