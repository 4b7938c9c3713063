//! What a run over a random sea leaves behind, and runs over many seeds, as a user meets them.

mod support;

use moorline::report::rainflow::{Curve, Rainflow};
use serde_json::{Value, json};
use std::path::Path;
use std::process::{Output, Stdio};
use support::program::{command, directory, moorline, read};

/// The built-in chain held still in a sea, in two sections, with a T–N curve.
fn scene(directory: &Path) -> String {
    let mut scene: Value = serde_json::from_str(include_str!("../examples/lindahl-sjoberg.json")).expect("the built-in scene");
    scene["motion"] = json!({"kind": "fixed"});
    scene["environment"]["waves"] = json!({"kind": "jonswap", "hs": 6.0, "tp": 9.0, "components": 40});
    scene["line_types"]["chain"]["breaking_load"] = json!(5.0e6);
    scene["line_types"]["chain"]["fatigue"] = json!({"m": 3.0, "k": 316.0});
    scene["lines"][0]["sections"] = json!([{"type": "chain", "length": 300.0}, {"type": "chain", "length": 900.0}]);
    scene["run"] = json!({"duration": 400.0, "output_step": 0.2, "transient": 30.0});
    // The sea moves the tension by a thousandth: a coarser tolerance would let steps choose the largest.
    scene["solver"] = json!({"tolerance": 1e-3});
    let path = directory.join("sea.json");
    std::fs::write(&path, scene.to_string()).expect("a scene");
    path.display().to_string()
}

fn assert_done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

fn summary(directory: &Path) -> Value {
    serde_json::from_str(&read(&directory.join("summary.json"))).expect("a summary")
}

/// The columns of a table by name.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(path).expect("the table");
    let place = reader.headers().expect("a header").iter().position(|column| column == name).expect("the column");
    reader.records().map(|row| row.expect("a row")[place].parse().expect("a number")).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn close(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value - expected).abs() <= tolerance * expected.abs(), "{what}: {value} instead of {expected}");
}

/// The figures of the summary are those of the rows after the transient; the spectrum holds the variance, the cycles the damage.
#[test]
fn a_random_sea_leaves_figures_that_its_rows_bear_out() {
    let here = directory("figures");
    let output = moorline(&here, &["run", &scene(&here)]);
    assert_done(&output);
    let out = here.join("out");
    let line = &summary(&out)["lines"][0];
    let time = column(&out.join("timeseries.csv"), "time");
    for name in ["tension", "anchor_tension"] {
        let all = column(&out.join("timeseries.csv"), name);
        let rows: Vec<f64> = time.iter().zip(&all).filter(|(time, _)| **time >= 30.0).map(|(_, value)| *value).collect();
        let count = rows.len() as f64;
        let mean = rows.iter().sum::<f64>() / count;
        let moment = |power| rows.iter().map(|value| (value - mean).powi(power)).sum::<f64>() / count;
        let of = &line["statistics"][name];
        close(number(&of["mean"]), mean, 1.0e-9, name);
        close(number(&of["std"]), moment(2).sqrt(), 1.0e-9, name);
        close(number(&of["skewness"]), moment(3) / moment(2).powf(1.5), 1.0e-6, name);
        let max = rows.iter().copied().fold(f64::MIN, f64::max);
        assert_eq!(number(&of["max"]), max);
        let row = time.iter().position(|time| *time == number(&of["max_time"])).expect("the row of the largest");
        assert_eq!(all[row], max);
        assert!(number(&of["most_probable_maximum"]) > max, "three hours hold more than six minutes");
        let [low, high] = [0, 1].map(|end| number(&of["interval_90"][end]));
        assert!(low < number(&of["most_probable_maximum"]) && number(&of["most_probable_maximum"]) < high);
        assert!((5.0..14.0).contains(&number(&of["peak_period"])), "{of}");
        let density = column(&out.join("spectra.csv"), name);
        let frequency = column(&out.join("spectra.csv"), "frequency");
        // The window weighs the beginning and the end of so short a run less.
        close(density.iter().sum::<f64>() * frequency[1], moment(2), 0.25, "variance of the spectrum");
    }
    assert_eq!((number(&line["statistics"]["from"]), number(&line["statistics"]["to"])), (30.0, 400.0));

    let fatigue = line["fatigue"].as_array().expect("damage");
    let places: Vec<(u64, f64)> =
        fatigue.iter().map(|of| (of["section"].as_u64().expect("a section"), number(&of["s"]))).collect();
    assert_eq!(places, [(0, 0.0), (0, 300.0), (1, 300.0), (1, 1200.0)]);
    let curve = Curve { m: 3.0, k: 316.0, breaking_load: 5.0e6 };
    for (name, of) in [("tension", &fatigue[0]), ("anchor_tension", &fatigue[3])] {
        let mut rainflow = Rainflow::default();
        let all = column(&out.join("timeseries.csv"), name);
        time.iter().zip(&all).filter(|(time, _)| **time >= 30.0).for_each(|(_, value)| rainflow.push(*value));
        let damage = curve.damage(&rainflow.cycles());
        close(number(&of["damage"]), damage.damage, 1.0e-12, name);
        close(number(&of["cycles"]), damage.cycles, 1.0e-12, name);
        close(number(&of["damage_per_year"]), damage.damage * 365.25 * 86_400.0 / 370.0, 1.0e-12, name);
    }
    // Where the sections meet the tension is that of the line there: the same for both, and not unlike that at the ends.
    assert_eq!(fatigue[1]["damage"], fatigue[2]["damage"]);
    let damage: Vec<f64> = fatigue.iter().map(|of| number(&of["damage"])).collect();
    let (least, most) = (damage[0].min(damage[3]), damage[0].max(damage[3]));
    assert!(damage[1] > 0.2 * least && damage[1] < 2.0 * most, "{damage:?}");
    let [ranges, counts] = ["range", "count"].map(|name| column(&out.join("rainflow.csv"), name));
    let sum: f64 = ranges.iter().zip(counts).map(|(range, count)| count / curve.cycles_to_failure(*range)).sum();
    close(sum, damage.iter().sum(), 1.0e-9, "damage of the table of cycles");

    let page = read(&out.join("report.html"));
    for words in ["most probable of 3 h", "Worst event", "Exceedance of maxima", "Fatigue", "\"exceedance\":["] {
        assert!(page.contains(words), "{words} in the page");
    }
    assert!(page.len() < 700_000, "{} bytes", page.len());
    assert!(String::from_utf8_lossy(&output.stdout).contains("most probable of 3 h"));
}

/// A regular motion has no statistics, but damage: every period the same cycle.
#[test]
fn a_regular_motion_has_damage_and_no_statistics() {
    let here = directory("regular");
    let scene = scene(&here);
    let motion = r#"motion={"kind": "sinusoidal", "period": 10, "cosine": [1.5, 0, 0], "ramp": 20}"#;
    let sets = ["--set", "environment.waves=null", "--set", motion, "--set", "run.duration=300", "--set", "run.transient=100"];
    assert_done(&moorline(&here, &[&["run", &scene][..], &sets].concat()));
    let line = &summary(&here.join("out"))["lines"][0];
    assert_eq!(line.get("statistics"), None);
    let of = &line["fatigue"][0];
    let rows = column(&here.join("out/timeseries.csv"), "tension");
    let last = &rows[rows.len() - 51..];
    let range = last.iter().copied().fold(f64::MIN, f64::max) - last.iter().copied().fold(f64::MAX, f64::min);
    close(number(&of["largest_range"]), range, 5.0e-3, "range");
    // Twenty periods, of which each does 1/N; small cycles within a period add little.
    let one = (range / 5.0e6).powi(3) / 316.0;
    close(number(&of["damage"]), 20.0 * one, 0.03, "damage");
    assert!(!here.join("out/spectra.csv").exists() && here.join("out/rainflow.csv").exists());
}

/// Every seed leaves what it leaves alone, to the last byte of its tables, and the summary is over all of them.
#[test]
fn each_seed_is_what_it_is_alone() {
    let here = directory("seeds");
    let scene = scene(&here);
    let short = ["--set", "run.duration=150"];
    let output = moorline(&here, &[&["run", &scene, "-o", "all", "--seeds", "7,2:4"][..], &short].concat());
    assert_done(&output);
    let all = summary(&here.join("all"));
    assert_eq!((&all["completed"], &all["seeds"]), (&json!(true), &json!([7, 2, 3, 4])));
    let line = &all["lines"][0];
    let mut counted = 0;
    for (place, seed) in [7, 2, 3, 4].into_iter().enumerate() {
        let of_seed = format!("environment.waves.seed={seed}");
        assert_done(&moorline(&here, &[&["run", &scene, "-o", "alone", "--set", &of_seed][..], &short].concat()));
        let own = here.join(format!("all/seed-{seed}"));
        for file in ["timeseries.csv", "nodes.csv", "spectra.csv", "rainflow.csv"] {
            assert!(read(&own.join(file)) == read(&here.join("alone").join(file)), "{file} of seed {seed}");
        }
        let alone = summary(&here.join("alone"));
        assert_eq!(summary(&own)["lines"][0]["statistics"], alone["lines"][0]["statistics"], "seed {seed}");
        for end in ["tension", "anchor_tension"] {
            assert_eq!(line[end]["max_by_seed"][place], alone["lines"][0]["statistics"][end]["max"], "seed {seed}");
        }
        counted += alone["lines"][0]["statistics"]["tension"]["maxima"].as_u64().expect("a number of maxima");
    }
    let of = &line["tension"];
    assert_eq!(of["maxima"].as_u64(), Some(counted), "the maxima of all seeds");
    let maxima: Vec<f64> = of["max_by_seed"].as_array().expect("maxima").iter().map(number).collect();
    let mean = maxima.iter().sum::<f64>() / 4.0;
    close(number(&of["mean_of_max"]), mean, 1.0e-12, "mean of the maxima");
    let spread = (maxima.iter().map(|max| (max - mean).powi(2)).sum::<f64>() / 3.0).sqrt();
    close(number(&of["std_of_max"]), spread, 1.0e-9, "their standard deviation");
    let largest = maxima.iter().copied().fold(f64::MIN, f64::max);
    assert_eq!(number(&of["max"]), largest);
    let place = maxima.iter().position(|max| *max == largest).expect("the largest");
    assert_eq!(of["max_seed"], all["seeds"][place]);
    assert!(number(&of["most_probable_maximum"]) > mean);
    // Damage adds up over the seeds.
    let damage =
        [7, 2, 3, 4].map(|seed| number(&summary(&here.join(format!("all/seed-{seed}")))["lines"][0]["fatigue"][0]["damage"]));
    close(number(&line["fatigue"][0]["damage"]), damage.iter().sum(), 1.0e-12, "damage");
    close(number(&line["fatigue"][0]["duration"]), 480.0, 1.0e-12, "duration");
    assert!(maxima.windows(2).all(|pair| pair[0] != pair[1]), "each seed is a sea of its own: {maxima:?}");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(printed.contains("4 seeds of 150 s each") && printed.contains("mean of max"), "{printed}");
}

/// One seed that cannot leave its files does not keep the others from theirs.
#[test]
fn a_seed_that_fails_leaves_the_others_their_results() {
    let here = directory("one-fails");
    std::fs::create_dir(here.join("all")).expect("a directory");
    std::fs::write(here.join("all/seed-2"), "in the way").expect("a file");
    let scene = scene(&here);
    let output = moorline(&here, &["run", &scene, "-o", "all", "--seeds", "1:3", "--set", "run.duration=60"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("error: 2 of 3 seeds are done; seed 2: ") && message.contains("seed-2"), "{message}");
    let all = summary(&here.join("all"));
    assert_eq!((&all["completed"], &all["seeds"]), (&json!(false), &json!([1, 3])));
    assert_eq!(all["unfinished"][0]["seed"], 2);
    assert!(here.join("all/seed-3/report.html").exists());
    for (seeds, sets, words) in [
        ("3:1", "run.duration=60", ["--seeds: 3:1 is not allowed", "a range goes up"]),
        ("1:3", "environment.waves=null", ["--seeds: 1:3 is not allowed", "no random sea"]),
    ] {
        let output = moorline(&here, &["run", &scene, "--seeds", seeds, "--set", sets]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{message}");
        words.iter().for_each(|word| assert!(message.contains(word), "{message}"));
    }
}

/// Ctrl-C leaves whole tables of the seeds at hand, and a summary over what is done.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_what_is_done() {
    let here = directory("ctrl-c");
    let scene = scene(&here);
    let arguments = ["run", &scene, "--seeds", "1:40", "--set", "run.duration=100000", "--set", "run.output_step=0.1"];
    let run = command(&here, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let rows = here.join("out/seed-1/timeseries.csv");
    let patience = std::time::Instant::now();
    while std::fs::read_to_string(&rows).map_or(0, |text| text.lines().count()) < 20 {
        assert!(patience.elapsed().as_secs() < 60, "no rows after a minute");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let kill = std::process::Command::new("kill").args(["-INT", &run.id().to_string()]).status().expect("kill");
    assert!(kill.success());
    let output = run.wait_with_output().expect("the program ends");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("0 of 40 seeds are done; seed 1: stopped by the user"), "{message}");
    assert!(read(&rows).ends_with('\n'), "the last row is complete");
    let all = summary(&here.join("out"));
    assert_eq!((&all["completed"], &all["seeds"]), (&json!(false), &json!([])));
    let [unfinished, not_begun] = ["unfinished", "not_begun"].map(|key| all[key].as_array().expect("a list").len());
    assert_eq!(unfinished + not_begun, 40);
    for of in all["unfinished"].as_array().expect("a list") {
        let own = here.join(format!("out/seed-{}", of["seed"]));
        assert_eq!(summary(&own)["completed"], false);
        assert!(read(&own.join("report.html")).contains("stopped by the user"));
    }
}
