//! What is wrong with bodies, points and what hangs on them is refused by place, with what is allowed.

use moorline::scene::read;
use serde_json::{Value, json};
use std::path::Path;

fn scene() -> Value {
    json!({
        "environment": {"depth": 100.0},
        "line_types": {"chain": {"ea": 5e8, "mass": 100.0, "diameter": 0.1}},
        "lines": [
            {"name": "bow", "fairlead": {"body": "ship", "at": [50, 0, -3]}, "anchor": [300, 0, -100], "sections": [{"type": "chain", "length": 300}]},
            {"name": "leg", "fairlead": {"point": "knot"}, "anchor": {"body": "buoy", "at": [1, 0, 0]}, "sections": [{"type": "chain", "length": 60}]},
            {"name": "foot", "fairlead": {"point": "knot"}, "anchor": [-100, 0, -100], "sections": [{"type": "chain", "length": 90}]}
        ],
        "bodies": [
            {"name": "ship", "motion": {"kind": "sinusoidal", "period": 10, "sine": [1, 0, 0, 0, 2, 0]}},
            {"name": "buoy", "position": [-20, 0, -1], "motion": {"kind": "free"}, "mass": 1e5, "inertia": [1e5, 1e5, 1e5], "volume": 150}
        ],
        "points": [{"name": "knot", "position": [-50, 0, -40], "mass": 10}]
    })
}

#[test]
fn the_scene_itself_is_good() {
    read::parse(&scene().to_string(), "net.json", Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn every_fault_is_named_with_its_place_and_what_is_allowed() {
    let faults: &[(&str, &[&str])] = &[
        ("lines[0].fairlead.body=\"shp\"", &["lines[0].fairlead.body", "did you mean `ship`"]),
        ("lines[1].fairlead.point=\"not\"", &["lines[1].fairlead.point", "no point of that name"]),
        ("lines[1].anchor={\"point\": \"knot\"}", &["lines[1].anchor", "both ends are on one place"]),
        ("lines[0].fairlead={\"body\": \"ship\"}", &["lines[0].fairlead", "the key `at` is missing"]),
        ("lines[0].fairlead={\"at\": [0, 0, 0]}", &["lines[0].fairlead", "the key `body` is missing"]),
        (
            "lines[0].fairlead={\"body\": \"ship\", \"point\": \"knot\", \"at\": [0, 0, 0]}",
            &["lines[0].fairlead", "unknown key `point`"],
        ),
        ("lines[0].fairlead=[1, 2]", &["lines[0].fairlead", "list of 2"]),
        ("lines[0].fairlead=\"ship\"", &["lines[0].fairlead", "\"ship\""]),
        ("lines[0].fairlead.at[0]=\"x\"", &["lines[0].fairlead.at[0]", "expected a number"]),
        ("bodies[1].name=\"ship\"", &["bodies[1].name", "bodies[0].name is called so already"]),
        ("points[0].name=\"bow\"", &["points[0].name", "lines[0].name is called so already"]),
        ("bodies[1].mass=0", &["bodies[1].mass", "needs a mass"]),
        ("bodies[1].mass=-5", &["bodies[1].mass", "-5"]),
        ("bodies[1].inertia=null", &["bodies[1].inertia", "Ixx"]),
        ("bodies[1].inertia=[1, 1, 3]", &["bodies[1].inertia", "no distribution of mass"]),
        ("bodies[1].inertia=[[1, 2, 0], [0, 1, 0], [0, 0, 1]]", &["bodies[1].inertia", "symmetric"]),
        (
            "bodies[1].damping=[[-1,0,0,0,0,0],[0,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]",
            &["bodies[1].damping", "semidefinite"],
        ),
        (
            "bodies[1].cylinders=[{\"from\": [0, 0, 0], \"to\": [0, 0, 0], \"diameter\": 2}]",
            &["bodies[1].cylinders[0].to", "ends must differ"],
        ),
        ("bodies[1].cylinders=[{\"from\": [0, 0, 0], \"to\": [0, 0, 1], \"diameter\": 0}]", &["bodies[1].cylinders[0].diameter"]),
        ("bodies[0].attitude_deg=[0, 95, 0]", &["bodies[0].attitude_deg[1]", "±89"]),
        ("bodies[0].motion.sine[4]=95", &["bodies[0].motion", "pitch of up to 95"]),
        ("bodies[0].motion.kind=\"drifting\"", &["bodies[0].motion", "drifting"]),
        ("bodies[0].motion.period=0", &["bodies[0].motion.period", "greater than 0"]),
        ("bodies[0].motion={\"kind\": \"file\", \"path\": \"no.csv\"}", &["no.csv"]),
        ("bodies[0].colour=\"red\"", &["bodies[0]", "unknown key `colour`"]),
        ("points[0].position=[0, 0, -120]", &["points[0].position", "below the seabed"]),
        (
            "points=[{\"name\": \"knot\", \"position\": [-50, 0, -40]}, {\"name\": \"lost\", \"position\": [0, 0, 0]}]",
            &["points[1].name", "without a line"],
        ),
        ("lines[1].constraints=[{\"s\": 0, \"stiffness\": [1, 1, 1]}]", &["lines[1].constraints", "hangs on \"knot\""]),
        (
            "lines[0].fairlead={\"body\": \"ship\", \"at\": [50, 0, -3], \"direction\": [0, 0, -1]}",
            &["lines[0].fairlead.direction", "give line_types.chain.ei"],
        ),
        (
            "lines[0].fairlead={\"body\": \"ship\", \"at\": [50, 0, -3], \"direction\": [0, 0, 0]}",
            &["lines[0].fairlead.direction", "not all may be 0"],
        ),
        (
            "lines[0].fairlead={\"body\": \"ship\", \"at\": [50, 0, -3], \"direction\": [0, 0, -1], \"stiffness\": -1}",
            &["lines[0].fairlead.stiffness", "-1", "or \"clamped\""],
        ),
        (
            "lines[0].fairlead={\"body\": \"ship\", \"at\": [50, 0, -3], \"direction\": [0, 0, -1], \"stiffness\": \"stiff\"}",
            &["lines[0].fairlead", "stiffness", "another value, expected a number or \"clamped\""],
        ),
        ("lines[0].fairlead={\"body\": \"ship\", \"at\": [50, 0, -3], \"stiffness\": 1e6}", &["lines[0].fairlead", "direction"]),
        ("lines[1].fairlead={\"point\": \"knot\", \"direction\": [0, 0, -1]}", &["lines[1].fairlead", "direction"]),
        ("solver.scheme=\"cable-1994\"", &["solver.scheme", "between coordinates alone"]),
        ("lines[2].anchor={\"body\": \"buoy\", \"at\": [0, 0, 0]}", &["lines[1]", "nothing holds"]),
    ];
    for (set, words) in faults {
        let outcome = read::parse(&scene().to_string(), "net.json", Path::new("."), &[(*set).to_owned()]);
        let error = outcome.err().unwrap_or_else(|| panic!("{set} passes")).to_string();
        for word in *words {
            assert!(error.contains(word), "{set}: {word:?} is not in {error:?}");
        }
    }
}
