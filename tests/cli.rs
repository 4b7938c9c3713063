//! The command as a user meets it: the program itself is started, and judged by its exit code, its words and its files.

mod support;

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use support::program::{command, directory, moorline, read};

const BUILT_IN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/lindahl-sjoberg.json");
const COLUMNS: &str = "time,fairlead_x,fairlead_y,fairlead_z,tension,force_x,force_y,force_z,anchor_tension,grounded_length";

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The command must end with this exit code and, on standard error, one message with all these words.
fn assert_fails(output: &Output, code: i32, words: &[&str]) {
    let message = err(output);
    assert_eq!(output.status.code(), Some(code), "exit code; the message was: {message}");
    assert!(message.starts_with("error: "), "no `error: ` in front: {message}");
    assert_eq!(message.matches("error: ").count(), 1, "more than one message: {message}");
    for word in words {
        assert!(message.contains(word), "{word:?} is missing: {message}");
    }
}

fn assert_done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", err(output));
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Header and rows of a table of numbers.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).expect("the table");
    let header = reader.headers().expect("a header").iter().map(str::to_string).collect();
    let number = |cell: &str| cell.parse().unwrap_or_else(|_| panic!("{cell:?} is no number"));
    let rows = reader.records().map(|row| row.expect("a row as long as the header").iter().map(number).collect());
    (header, rows.collect())
}

/// The built-in chain between three pairs of points.
fn three_lines(directory: &Path) -> String {
    let mut scene = json(&read(Path::new(BUILT_IN)));
    let line = |name: &str, fairlead: [f64; 3], anchor: [f64; 3]| serde_json::json!({"name": name, "fairlead": fairlead, "anchor": anchor, "sections": [{"type": "chain", "length": 1200.0}]});
    scene["lines"] = serde_json::json!([
        line("bow", [10.0, 0.0, 0.0], [1190.0, 0.0, -120.0]),
        line("port", [0.0, 10.0, 0.0], [0.0, 1180.0, -120.0]),
        line("stern", [-10.0, 0.0, 0.0], [-1170.0, 0.0, -120.0])
    ]);
    let path = directory.join("three.json");
    std::fs::write(&path, scene.to_string()).expect("a scene");
    path.display().to_string()
}

#[test]
fn help_names_every_command_and_the_exit_codes() {
    let output = moorline(&directory("help"), &["--help"]);
    assert_done(&output);
    for word in ["run", "statics", "check", "schema", "pack", "convert", "Exit codes", "3 no convergence"] {
        assert!(out(&output).contains(word), "{word} is missing: {}", out(&output));
    }
}

#[test]
fn mistakes_on_the_command_line_are_bad_input() {
    let here = directory("mistakes");
    assert_fails(&moorline(&here, &["statcs"]), 2, &["unrecognized subcommand", "statcs"]);
    assert_fails(&moorline(&here, &["statics"]), 2, &["<SCENE>"]);
    assert_fails(&moorline(&here, &["run", "--quite"]), 2, &["--quite", "--quiet"]);
    assert_fails(&moorline(&here, &["pack"]), 2, &["--output"]);
}

#[test]
fn schema_is_a_json_schema_of_the_scene() {
    let output = moorline(&directory("schema"), &["schema"]);
    assert_done(&output);
    let schema = json(&out(&output));
    for key in ["environment", "line_types", "lines", "motion", "run", "solver"] {
        assert!(schema["properties"][key].is_object(), "{key} is missing");
    }
}

#[test]
fn a_scene_that_is_not_there_is_named() {
    let here = directory("missing");
    for command in ["run", "statics", "check"] {
        assert_fails(&moorline(&here, &[command, "harbour.json"]), 2, &["harbour.json"]);
    }
    assert!(!here.join("out").exists(), "nothing is written for a scene that cannot be read");
}

#[test]
fn settings_that_make_no_scene_are_named_by_every_command() {
    let here = directory("settings");
    for command in ["run", "statics", "check"] {
        let with = |set| moorline(&here, &[command, BUILT_IN, "--set", set]);
        assert_fails(&with("environment.depht=100"), 2, &["depht"]);
        assert_fails(&with("run.duration"), 2, &["run.duration", "="]);
        assert_fails(&with("run.duration=-5"), 2, &["run.duration", "-5"]);
    }
    assert!(!here.join("out").exists(), "nothing is written for a bad scene");
}

#[test]
fn an_output_directory_that_cannot_be_made_is_named() {
    let here = directory("unwritable");
    std::fs::write(here.join("file"), "not a directory").expect("a file");
    let output = moorline(&here, &["run", BUILT_IN, "-o", "file/results", "--set", "run.duration=1"]);
    assert_fails(&output, 2, &["results", "cannot be made", "-o DIR"]);
}

#[test]
fn run_leaves_the_tables_of_the_contract() {
    let here = directory("tables");
    let output =
        moorline(&here, &["run", BUILT_IN, "-o", "results/here", "--set", "run.duration=2", "--set", "run.output_step=0.05"]);
    assert_done(&output);
    let results = here.join("results/here");

    let (header, rows) = table(&results.join("timeseries.csv"));
    assert_eq!(header.join(","), COLUMNS);
    assert_eq!(rows.len(), 41);
    assert!(rows.iter().enumerate().all(|(row, cells)| cells[0] == (5 * row) as f64 / 100.0), "times are decimal multiples");

    let nodes = read(&results.join("nodes.csv"));
    assert!(nodes.starts_with("time,line,node,s,x,y,z,tension\n0.0,line,0,0.0,"), "{}", &nodes[..120]);
    let summary = json(&read(&results.join("summary.json")));
    let elements = summary["elements"].as_u64().expect("elements") as usize;
    assert_eq!(nodes.lines().count(), 1 + 41 * (elements + 1), "41 snapshots of all nodes");
    for words in ["static", "max", "min", "steps", "times real time", "report.html", "browser"] {
        assert!(out(&output).contains(words), "{words} is missing: {}", out(&output));
    }
}

#[test]
fn summary_has_the_keys_of_the_contract_and_the_statistics_of_the_rows() {
    let here = directory("summary");
    assert_done(&moorline(&here, &["run", BUILT_IN, "--set", "run.duration=20"]));
    let summary = json(&read(&here.join("out/summary.json")));
    for key in ["elements", "steps", "rejected_steps", "newton_iterations", "factorisations", "element_iterations"] {
        assert!(summary[key].is_u64(), "{key}: {}", summary[key]);
    }
    assert_eq!(summary["scheme"], "adams-moulton");
    assert!(summary["steps"].as_u64() >= Some(200), "steps land on the output times");
    for key in ["statics_seconds", "solver_seconds"] {
        assert!(summary[key].as_f64() > Some(0.0), "{key}: {}", summary[key]);
    }
    assert_eq!(summary["warnings"], serde_json::json!([]));
    assert_eq!(summary["completed"], true);
    assert_eq!(summary["tension"], summary["lines"][0]["tension"]);
    assert_eq!(summary["lines"][0]["name"], "line");

    let (header, rows) = table(&here.join("out/timeseries.csv"));
    let column = header.iter().position(|name| name == "tension").expect("tension");
    let tension: Vec<f64> = rows.iter().map(|row| row[column]).collect();
    let number = tension.len() as f64;
    let mean = tension.iter().sum::<f64>() / number;
    let std = (tension.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / number).sqrt();
    let max = tension.iter().copied().fold(f64::MIN, f64::max);
    let min = tension.iter().copied().fold(f64::MAX, f64::min);
    for (key, expected) in [("initial", tension[0]), ("max", max), ("min", min), ("mean", mean), ("std", std)] {
        let found = summary["tension"][key].as_f64().unwrap_or_else(|| panic!("{key}"));
        assert!((found - expected).abs() <= 1.0e-9 * max, "{key}: {found}, the rows give {expected}");
    }
    for (time, value) in [("max_time", max), ("min_time", min)] {
        let time = summary["tension"][time].as_f64().unwrap_or_else(|| panic!("{time}"));
        assert!(rows.iter().any(|row| row[0] == time && row[column] == value), "no row at t = {time} with {value}");
    }
}

#[test]
fn a_rerun_gives_the_same_rows() {
    let here = directory("rerun");
    for out in ["a", "b"] {
        assert_done(&moorline(&here, &["run", BUILT_IN, "-o", out, "--set", "run.duration=5"]));
    }
    for file in ["timeseries.csv", "nodes.csv"] {
        assert_eq!(read(&here.join("a").join(file)), read(&here.join("b").join(file)), "{file}");
    }
}

#[test]
fn several_lines_stand_side_by_side_under_their_names() {
    let here = directory("several");
    let scene = three_lines(&here);
    let output = moorline(&here, &["run", &scene, "--set", "run.duration=1"]);
    assert_done(&output);
    let (header, rows) = table(&here.join("out/timeseries.csv"));
    let columns: Vec<&str> = COLUMNS.split(',').skip(1).collect();
    let expected: Vec<String> =
        ["bow", "port", "stern"].iter().flat_map(|line| columns.iter().map(move |column| format!("{line}.{column}"))).collect();
    assert_eq!(header[0], "time");
    assert_eq!(header[1..], expected);
    assert_eq!(rows.len(), 11);

    let summary = json(&read(&here.join("out/summary.json")));
    assert!(summary.get("tension").is_none(), "of several lines none is the tension");
    let lines = summary["lines"].as_array().expect("lines");
    assert_eq!(lines.iter().map(|line| &line["name"]).collect::<Vec<_>>(), ["bow", "port", "stern"]);
    let sum: u64 = lines.iter().map(|line| line["steps"].as_u64().expect("steps")).sum();
    assert_eq!(summary["steps"].as_u64(), Some(sum));
    assert_eq!(lines[1]["tension"]["initial"].as_f64(), Some(rows[0][1 + 9 + 3]), "port.tension");
    assert!(out(&output).contains("stern"));
}

/// The rows of `timeseries.csv` as text, each line's own part of them: what is written for a scene of that line alone, header included.
fn rows_by_line(directory: &Path) -> Vec<Vec<String>> {
    let columns = COLUMNS.split(',').count() - 1;
    let text = read(&directory.join("timeseries.csv"));
    let rows: Vec<Vec<&str>> = text.lines().map(|row| row.split(',').collect()).collect();
    let part = |row: &Vec<&str>, line: usize| {
        let cells = row[1 + line * columns..1 + (line + 1) * columns].iter();
        std::iter::once(row[0])
            .chain(cells.map(|cell| cell.rsplit_once("_line.").map_or(*cell, |(_, column)| column)))
            .collect::<Vec<_>>()
            .join(",")
    };
    (0..(rows[0].len() - 1) / columns).map(|line| rows.iter().map(|row| part(row, line)).collect()).collect()
}

/// The rows of a line in `nodes.csv`.
fn nodes_of(directory: &Path, name: &str) -> Vec<String> {
    let text = read(&directory.join("nodes.csv"));
    text.lines().filter(|row| row.split(',').nth(1) == Some(name)).map(str::to_string).collect()
}

/// Runs a scene whole and each of its lines alone; returns what they said and left, whole first.
fn together_and_alone(here: &Path, scene: &Value, sets: &[&str]) -> Vec<(Output, Value)> {
    let lines = scene["lines"].as_array().expect("lines");
    let alone = lines.iter().map(|line| serde_json::json!([line]));
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    let run = |(number, lines): (usize, Value)| {
        let (file, out) = (format!("{number}.json"), number.to_string());
        let mut scene = scene.clone();
        scene["lines"] = lines;
        std::fs::write(here.join(&file), scene.to_string()).expect("a scene");
        let arguments = [&["run", &file, "-o", &out, "--quiet"], sets.as_slice()].concat();
        let output = moorline(here, &arguments);
        (output, json(&read(&here.join(&out).join("summary.json"))))
    };
    std::iter::once(scene["lines"].clone()).chain(alone).enumerate().map(run).collect()
}

/// Five lines of unequal length, ends, mesh and cost from one point of a vessel, to all sides.
fn five_lines() -> Value {
    let mut scene = json(&read(Path::new(BUILT_IN)));
    scene["line_types"]["rope"] = serde_json::json!({"ea": 3.0e7, "mass": 20.0, "diameter": 0.12, "damping": 0.05});
    let line = |name: &str, anchor: [f64; 2], kind: &str, length: f64| {
        serde_json::json!({"name": format!("{name}_line"), "fairlead": [0.0, 0.0, 0.0], "anchor": [anchor[0], anchor[1], -120.0],
            "sections": [{"type": kind, "length": length}]})
    };
    scene["lines"] = serde_json::json!([
        line("bow", [1183.97, 0.0], "chain", 1200.0),
        line("port", [0.0, 700.0], "rope", 720.0),
        line("stern", [-770.0, 0.0], "chain", 800.0),
        line("star", [0.0, -1250.0], "chain", 1270.0),
        line("spring", [500.0, 500.0], "rope", 760.0)
    ]);
    scene
}

/// Lines that share a scene know nothing of each other: to the byte, each one's rows are those of a scene with it alone. That holds on any
/// number of cores, since a line alone has one thread.
#[test]
fn of_several_lines_each_is_what_it_is_alone() {
    let here = directory("together");
    let runs = together_and_alone(&here, &five_lines(), &["run.duration=20", "motion.ramp=10"]);
    let together = rows_by_line(&here.join("0"));
    assert_eq!((together.len(), together[0].len()), (5, 202));
    for (number, line) in together.iter().enumerate() {
        let (alone, name) = (here.join((number + 1).to_string()), runs[0].1["lines"][number]["name"].as_str().expect("a name"));
        assert_done(&runs[number + 1].0);
        assert_eq!(line, &rows_by_line(&alone)[0], "{name}");
        assert_eq!(nodes_of(&here.join("0"), name), nodes_of(&alone, name), "{name}");
        assert_eq!(runs[0].1["lines"][number], runs[number + 1].1["lines"][0], "{name}");
    }
}

/// The vessel surges a kilometre ahead: the line to the stern is the first that cannot follow. Its error ends the run, and what was
/// done before is there, of all lines.
#[test]
fn of_several_lines_one_that_fails_ends_the_run_and_all_keep_their_rows() {
    let here = directory("one-fails");
    let runs = together_and_alone(
        &here,
        &five_lines(),
        &["motion.sine=[1000,0,0]", "motion.period=60", "motion.ramp=10", "run.duration=15"],
    );
    let (failed, summary) = &runs[0];
    assert_fails(failed, 3, &["line \"stern_line\"", "t = ", "s = "]);
    assert_eq!(summary["error"], runs[3].1["error"], "the line's own error");
    assert_eq!(summary["end_time"], runs[3].1["end_time"]);
    assert_eq!(summary["lines"][2], runs[3].1["lines"][0]);
    let together = rows_by_line(&here.join("0"));
    let last = summary["end_time"].as_f64().expect("a time");
    for (number, line) in together.iter().enumerate() {
        let (alone, name) = (here.join((number + 1).to_string()), summary["lines"][number]["name"].as_str().expect("a name"));
        let rows = &rows_by_line(&alone)[0];
        assert_eq!(line[..], rows[..line.len()], "{name}");
        assert!(rows.len() > line.len() || number == 2, "{name} goes on longer alone");
        let nodes = nodes_of(&here.join("0"), name);
        assert!(nodes.last().is_some_and(|row| row.starts_with(&format!("{last:?},"))), "{name} has a snapshot of the end");
    }
}

#[test]
fn quiet_prints_nothing() {
    let here = directory("quiet");
    let output = moorline(&here, &["--quiet", "--set", "run.duration=1"]);
    assert_done(&output);
    assert_eq!((out(&output), err(&output)), (String::new(), String::new()));
    assert!(here.join("out/summary.json").exists());
}

#[test]
fn bare_moorline_runs_the_built_in_case_and_leaves_a_page_that_asks_nobody() {
    let here = directory("bare");
    assert_done(&moorline(&here, &[]));
    let (_, rows) = table(&here.join("out/timeseries.csv"));
    assert_eq!(rows.len(), 1201);
    assert_eq!(rows[1200][0], 120.0);
    let page = read(&here.join("out/report.html"));
    assert!(page.contains("Lindahl &amp; Sjöberg (1983) as run by Ma &amp; Webster (1994)"));
    for address in ["http://", "https://", "src=", "@import", "url("] {
        assert!(!page.contains(address), "{address} in the page");
    }
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
}

#[test]
fn a_run_that_fails_half_way_leaves_what_it_had() {
    let here = directory("fails");
    // A drive-off: from t = 2 s on, the fairlead leaves at 90 m/s. At t = 42 s it would be 2418 m away, where the line of 1200 m ends.
    std::fs::write(here.join("drive-off.csv"), "t,x,y,z\n0,0,0,0\n2,0,0,0\n42,3600,0,0\n").expect("a motion");
    std::fs::copy(BUILT_IN, here.join("scene.json")).expect("a scene");
    let motion = r#"motion={"kind": "file", "path": "drive-off.csv"}"#;
    let output = moorline(&here, &["run", "scene.json", "--quiet", "--set", motion, "--set", "run.duration=42"]);
    assert_fails(&output, 3, &["line \"line\"", "t = ", "s = ", "fairlead", "more than twice the 1200.0 m of line"]);
    let (_, rows) = table(&here.join("out/timeseries.csv"));
    assert!(rows.len() > 300 && rows.len() < 421, "{} rows", rows.len());
    let summary = json(&read(&here.join("out/summary.json")));
    assert_eq!(summary["completed"], false);
    assert!(err(&output).contains(summary["error"].as_str().expect("the error")));
    assert_eq!(summary["end_time"].as_f64(), Some(rows[rows.len() - 1][0]));
    assert_eq!(summary["rows"].as_u64(), Some(rows.len() as u64));
    assert!(read(&here.join("out/report.html")).contains("role=\"alert\""));
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_complete_rows_summary_and_page() {
    let here = directory("ctrl-c");
    let several = three_lines(&here);
    for scene in [BUILT_IN, &several] {
        let arguments = ["run", scene, "--set", "run.duration=1000000", "--set", "run.output_step=0.1"];
        let _ = std::fs::remove_dir_all(here.join("out"));
        let run = command(&here, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
        let rows = here.join("out/timeseries.csv");
        let patience = std::time::Instant::now();
        while std::fs::read_to_string(&rows).map_or(0, |text| text.lines().count()) < 20 {
            assert!(patience.elapsed().as_secs() < 60, "no rows after a minute");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let kill = Command::new("kill").args(["-INT", &run.id().to_string()]).status().expect("kill");
        assert!(kill.success());
        let output = run.wait_with_output().expect("the program ends");
        assert!(read(&rows).ends_with('\n'), "the last row is complete");
        let (header, rows) = table(&rows);
        let last = rows[rows.len() - 1][0];
        assert_fails(&output, 130, &[&format!("stopped by the user at t = {last} s")]);
        assert!(rows.iter().all(|row| row.len() == header.len()));
        assert!(read(&here.join("out/nodes.csv")).lines().last().is_some_and(|row| row.starts_with(&format!("{last:?},"))));
        let summary = json(&read(&here.join("out/summary.json")));
        assert_eq!(summary["completed"], false);
        assert_eq!(summary["rows"].as_u64(), Some(rows.len() as u64));
        assert!(read(&here.join("out/report.html")).contains("stopped by the user"));
    }
}

#[test]
fn statics_prints_the_json_of_the_contract() {
    let here = directory("statics");
    let output = moorline(&here, &["statics", BUILT_IN, "--json"]);
    assert_done(&output);
    let statics = json(&out(&output));
    assert_eq!(statics["converged"], true);
    assert!(statics["iterations"].is_u64() && statics["residual"].is_number());
    let line = &statics["lines"][0];
    assert_eq!(line["name"], "line");
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{value} is no number"));
    let vector = |value: &Value| [number(&value[0]), number(&value[1]), number(&value[2])];
    let magnitude = |value: &Value| vector(value).iter().map(|component| component * component).sum::<f64>().sqrt();
    for (tension, force) in [("tension", "force"), ("anchor_tension", "anchor_force")] {
        let (tension, force) = (number(&line[tension]), magnitude(&line[force]));
        assert!((tension - force).abs() <= 1.0e-9 * tension, "{tension} against |force| = {force}");
    }
    assert!(number(&line["grounded_length"]) > 0.0);
    assert!(
        vector(&line["force"])[0] > 0.0 && vector(&line["force"])[2] < 0.0,
        "the line pulls the vessel down and to its anchor"
    );
    let nodes = line["nodes"].as_array().expect("nodes");
    assert_eq!((number(&nodes[0]["s"]), number(&nodes[nodes.len() - 1]["s"])), (0.0, 1200.0));
    for node in nodes {
        assert!((magnitude(&node["tangent"]) - 1.0).abs() < 1.0e-9, "a unit vector: {}", node["tangent"]);
        assert!(number(&node["tension"]) > 0.0 && node["position"].as_array().map(Vec::len) == Some(3));
    }
}

#[test]
fn run_starts_from_what_statics_prints() {
    let here = directory("start");
    let statics = json(&out(&moorline(&here, &["statics", BUILT_IN, "--json"])));
    assert_done(&moorline(&here, &["run", BUILT_IN, "--set", "run.duration=0"]));
    let (_, rows) = table(&here.join("out/timeseries.csv"));
    assert_eq!(rows.len(), 1);
    assert_eq!(statics["lines"][0]["tension"].as_f64(), Some(rows[0][4]));
}

#[test]
fn statics_prints_a_table_for_people() {
    let output = moorline(&directory("statics-table"), &["statics", BUILT_IN]);
    assert_done(&output);
    for words in
        ["Static equilibrium", "Line \"line\"", "fairlead", "anchor", "touchdown at s = ", "on the bed", "[kN]", "1200.000"]
    {
        assert!(out(&output).contains(words), "{words} is missing: {}", out(&output));
    }
}

#[test]
fn check_says_what_is_on_what_is_skipped_the_mesh_and_the_cost() {
    let here = directory("check");
    let output = moorline(&here, &["check", BUILT_IN]);
    assert_done(&output);
    for words in ["good scene", "Line \"line\": 1200 m", "on   ", "skip ", "mesh: ", "Cost: 1201 rows"] {
        assert!(out(&output).contains(words), "{words} is missing: {}", out(&output));
    }
    assert_eq!(std::fs::read_dir(&here).expect("the directory").count(), 0, "check writes nothing");
}

#[test]
fn check_gives_the_figures_of_the_sea_and_says_what_breaks() {
    let here = directory("check-sea");
    let sea = |waves: &str| {
        let output = moorline(&here, &["check", BUILT_IN, "--set", &format!("environment.waves={waves}")]);
        assert_done(&output);
        out(&output)
    };
    let calm = moorline(&here, &["check", BUILT_IN]);
    assert!(!out(&calm).contains("Sea: "), "{}", out(&calm));
    let alone = sea(r#"{"kind": "regular", "amplitude": 2, "period": 8}"#);
    // L = g T²/2π = 99.89 m in deep water.
    assert!(alone.contains("Sea: H 4.000 m, T 8.00 s; a wave of T is 99.9 m long, steepness H/L 0.0400"), "{alone}");
    let mild = sea(r#"{"kind": "pierson-moskowitz", "hs": 3, "tp": 9, "cut_off": 0.3}"#);
    assert!(mild.contains("Sea: Hs 2.9") && mild.contains("(cut-off)") && !mild.contains("breaks"), "{mild}");
    let steep = sea(r#"{"kind": "jonswap", "hs": 9, "tp": 8}"#);
    assert!(steep.contains("warning: a sea of this period breaks beyond a steepness of 0.0"), "{steep}");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let here = directory("pipe");
    for arguments in [&["schema"][..], &["statics", BUILT_IN], &["statics", BUILT_IN, "--json"]] {
        let mut child =
            command(&here, arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("the program ends");
        assert_eq!((output.status.code(), err(&output)), (Some(0), String::new()), "{arguments:?}");
    }
}

fn example(name: &str) -> String {
    format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn statics_tells_of_bodies_and_points() {
    let here = directory("bodies");
    let output = moorline(&here, &["statics", &example("calm-buoy.json"), "--json"]);
    assert_done(&output);
    let found = json(&out(&output));
    let buoy = &found["bodies"][0];
    assert_eq!(buoy["name"], "buoy");
    for key in ["position", "attitude_deg", "force", "moment"] {
        assert_eq!(buoy[key].as_array().map(Vec::len), Some(3), "{key}");
    }
    assert_eq!(buoy["stiffness"].as_array().map(Vec::len), Some(6));
    let output = moorline(&here, &["statics", &example("crowfoot.json"), "--json"]);
    assert_eq!(json(&out(&output))["points"].as_array().map(Vec::len), Some(3));
}

#[test]
fn the_columns_of_bodies_and_points_follow_those_of_the_lines() {
    let here = directory("body-columns");
    assert_done(&moorline(&here, &["run", &example("wave-energy-floats.json"), "--set", "run.duration=2", "-q"]));
    let (names, rows) = table(&here.join("out/timeseries.csv"));
    let at = |name: &str| names.iter().position(|own| own == name).unwrap_or_else(|| panic!("{name} is missing: {names:?}"));
    let sum: f64 = ["a", "b", "c"].iter().map(|leg| rows[7][at(&format!("upper {leg}.force_z"))]).sum();
    assert!((rows[7][at("device.force_z")] / sum - 1.0).abs() < 1e-12);
    for name in ["device.x", "device.yaw", "device.moment_z", "float a.x", "float c.z"] {
        at(name);
    }
}

#[test]
fn offsets_write_the_restoring_curve() {
    let here = directory("offsets");
    let scene = example("semi-submersible.json");
    assert_done(&moorline(&here, &["statics", &scene, "--offsets", "platform.x=-10:10:5"]));
    let (names, rows) = table(&here.join("out/offsets.csv"));
    assert_eq!((names.len(), rows.len()), (10, 5));
    // At rest as statics, and aside as statics of a scene put there.
    let aside = moorline(
        &here,
        &["statics", &scene, "--json", "--set", "bodies[0].position=[10,0,0]", "--set", "bodies[0].motion={\"kind\": \"fixed\"}"],
    );
    let force = &json(&out(&aside))["bodies"][0]["force"];
    assert!((rows[4][1] / force[0].as_f64().unwrap_or(0.0) - 1.0).abs() < 1e-3, "{:?} {force}", rows[4]);
    assert!(here.join("out/offsets.html").is_file());
    for (asked, words) in [
        ("platfrom.x=-1:1:1", "did you mean `platform`"),
        ("platform.q=-1:1:1", "vessel.x=-20:20:1"),
        ("platform.x=1:-1:1", "the step is positive"),
        ("platform.x=1:2", "vessel.x=-20:20:1"),
    ] {
        assert_fails(&moorline(&here, &["statics", &scene, "--offsets", asked]), 2, &[words]);
    }
}

#[test]
fn fit_finds_the_length_of_a_pretension() {
    let here = directory("fit");
    let scene = example("semi-submersible.json");
    let change = ["--change", "lines[0].sections[0].length"];
    let fit = |until: &str| moorline(&here, &["fit", &scene, change[0], change[1], "--until", until, "-o", "fitted.json"]);
    assert_done(&fit("line1.tension=1.3e6"));
    let found = json(&out(&moorline(&here, &["statics", "fitted.json", "--json"])));
    let tension = found["lines"][0]["tension"].as_f64().unwrap_or(0.0);
    assert!((tension / 1.3e6 - 1.0).abs() < 1e-6, "{tension}");
    assert_fails(&fit("line1.tension=1e12"), 2, &["no value of", "the nearest is", "--range"]);
    assert_fails(&fit("line1.tensoin=1e6"), 2, &["did you mean `tension`"]);
    assert_fails(&fit("lime1.tension=1e6"), 2, &["did you mean `line1`"]);
    assert_fails(&fit("line1.tension"), 2, &["bow.tension=1.2e6"]);
    let nowhere = moorline(&here, &["fit", &scene, "--change", "lines[0].name", "--until", "line1.tension=1e6"]);
    assert_fails(&nowhere, 2, &["name a number of the scene"]);
    // A value that two places give: a line is as taut short as it is heavy, and one of them is taken with a word on it.
    let twice = moorline(
        &here,
        &[
            "fit",
            &scene,
            "--change",
            "bodies[0].position[1]",
            "--until",
            "line2.tension=1.2e6",
            "--range",
            "-60:60",
            "-o",
            "twice.json",
        ],
    );
    assert_done(&twice);
    assert!(here.join("twice.json").is_file());
}
