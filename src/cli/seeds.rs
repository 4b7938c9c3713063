//! `moorline run SCENE --seeds 1:20`: the same scene in one random sea after another, on all cores; each is what it would be alone

use crate::cli::arguments::RunArguments;
use crate::cli::console::{self, on_terminal};
use crate::cli::interrupt::Interrupt;
use crate::cli::progress::Progress;
use crate::cli::run;
use crate::cli::stop::Stop;
use crate::error::Error;
use crate::report::record::Record;
use crate::report::schedule::Schedule;
use crate::report::seeds::{self, Asked, Line, Seed, Unfinished};
use crate::report::tables;
use crate::report::units::{ForceUnit, count, sim_time};
use crate::scene::read::Loaded;
use crate::solve::fleet;
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Most seeds of one run: each leaves a directory.
const MOST: u64 = 1000;

/// How the run of one seed went.
type Outcome = Result<Option<Seed>, Error>;

/// Runs every seed into a directory of its own, and leaves one summary beside them, also where some fail or the user stops it half way.
pub fn run(arguments: &RunArguments, seeds: &str) -> Result<(), Stop> {
    let loaded = arguments.load()?;
    let seeds = wanted(&loaded, seeds)?;
    let quiet = arguments.options.quiet;
    if !quiet {
        loaded.warnings.iter().for_each(|warning| console::warning(warning));
    }
    let directory = &arguments.options.output;
    let summary = run::made(directory)?.join("summary.json");
    // Where this fails, writing the new file says why.
    let _ = std::fs::remove_file(&summary);

    let interrupt = Interrupt::watch();
    let stop = || interrupt.came();
    let progress = Progress::of_seeds(seeds.len(), Schedule::new(&loaded.scene.run).rows(), quiet);
    let (next, outcomes) = (AtomicUsize::new(0), Mutex::new(Vec::<(usize, Outcome)>::new()));
    let lock = || outcomes.lock().unwrap_or_else(PoisonError::into_inner);
    let work = || {
        while !stop() {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(seed) = seeds.get(number) else { break };
            let own = of_seed(&loaded, *seed);
            let place = directory.join(format!("seed-{seed}"));
            let outcome = run::into_directory(&own, &place, arguments.options.vtk, progress.part(), &stop);
            let outcome = outcome.and_then(|(record, _)| match &record.ended_by {
                Some(error) => Err(error.clone()),
                None => Ok(Seed::of(*seed, &record)),
            });
            let mut outcomes = lock();
            outcomes.push((number, outcome));
            progress.show_seeds(outcomes.len(), seeds.len());
        }
    };
    std::thread::scope(|scope| (0..fleet::threads(seeds.len())).for_each(|_| drop(scope.spawn(work))));
    drop(progress);
    let mut outcomes = std::mem::take(&mut *lock());
    outcomes.sort_by_key(|(number, _)| *number);

    let begun: Vec<usize> = outcomes.iter().map(|(number, _)| *number).collect();
    let not_begun = (0..seeds.len()).filter(|number| !begun.contains(number)).map(|number| seeds[number]).collect();
    let (mut done, mut unfinished, mut first) = (Vec::new(), Vec::new(), None);
    for (number, outcome) in outcomes {
        match outcome {
            Ok(seed) => done.extend(seed),
            Err(error) => {
                unfinished.push(Unfinished { seed: seeds[number], error: error.to_string() });
                first.get_or_insert((seeds[number], error));
            }
        }
    }
    let number = done.len();
    let asked = Asked { scene: &loaded.scene, file: &loaded.file, warnings: &loaded.warnings, unfinished, not_begun };
    let all = seeds::summary(asked, &done);
    tables::write(&summary, &(serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"))?;
    if !quiet {
        let warnings = done.iter().flat_map(|of| of.warnings.iter().map(|warning| format!("seed {}: {warning}", of.seed)));
        warnings.for_each(|warning| console::warning(&warning));
        console::print(&printed(&loaded, number, &all.lines, &summary.display().to_string()))?;
    }
    match first {
        Some((seed, error)) => Err(Error::Seed { done: number, of: seeds.len(), seed, error: Box::new(error) }.into()),
        // Stopped between one seed and the next.
        None if number < seeds.len() && stop() => Err(Error::Interrupted { time: loaded.scene.run.end() }.into()),
        None => Ok(()),
    }
}

/// The scene with a seed of its own.
fn of_seed(loaded: &Loaded, seed: u64) -> Loaded {
    let mut own = loaded.clone();
    own.scene.environment.waves.iter_mut().for_each(|seas| {
        seas.set_seed(seed);
    });
    own
}

/// The seeds in `1:20` or `3,7,9`, for a scene that has a random sea.
fn wanted(loaded: &Loaded, text: &str) -> Result<Vec<u64>, Error> {
    let refuse = |value: &str, allowed: &str| -> Error {
        let (file, place) = (loaded.file.clone(), "--seeds".to_owned());
        Error::Value { file, place, value: value.to_owned(), allowed: allowed.to_owned() }
    };
    if !loaded.scene.environment.waves.clone().is_some_and(|mut seas| seas.set_seed(0)) {
        let allowed = "the scene has no random sea, so all seeds are the same; give `environment.waves` a spectrum, such as the kind \
                       \"jonswap\"";
        return Err(refuse(text, allowed));
    }
    let run = &loaded.scene.run;
    let record = Record::new(&loaded.scene, &loaded.file, Vec::new(), 0.0);
    if !(record.statistics_from + run.output_step <= run.end()) {
        let (file, place, value) = (loaded.file.clone(), "run.duration".to_owned(), format!("{} s", run.duration));
        let transient = sim_time(record.statistics_from - run.start);
        let allowed = format!("the first {transient} s are the ramp and do not count (`run.transient`); run longer");
        return Err(Error::Value { file, place, value, allowed });
    }
    const FORM: &str = "write seeds as 1:20, from the first to the last, or as 3,7,9: whole numbers from 0";
    let mut seeds: Vec<u64> = Vec::new();
    for part in text.split(',') {
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| refuse(&format!("\"{part}\""), FORM));
        let (first, last) = match part.split_once(':') {
            Some((first, last)) => (number(first)?, number(last)?),
            None => (number(part)?, number(part)?),
        };
        if last < first {
            return Err(refuse(part, "a range goes up: the smaller seed stands first, as in 1:20"));
        }
        if last - first >= MOST || seeds.len() as u64 + (last - first) >= MOST {
            return Err(refuse(part, &format!("at most {MOST} seeds are run at a time")));
        }
        if let Some(twice) = (first..=last).find(|seed| seeds.contains(seed)) {
            return Err(refuse(text, &format!("seed {twice} stands twice; give each once")));
        }
        seeds.extend(first..=last);
    }
    Ok(seeds)
}

/// What is printed when all seeds are over.
fn printed(loaded: &Loaded, done: usize, lines: &[Line], summary: &str) -> String {
    let mut text = String::new();
    let duration = sim_time(loaded.scene.run.duration);
    let _ = writeln!(text, "{}: {} of {duration} s each\n", on_terminal(&loaded.file), count(done, "seed"));
    let known: Vec<_> = lines.iter().filter_map(|line| Some((on_terminal(line.name), line.tension.as_ref()?))).collect();
    let unit = ForceUnit::for_largest(known.iter().map(|(_, of)| of.max).fold(0.0, f64::max));
    let width = known.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0).max("fairlead".len());
    if !known.is_empty() {
        let _ = writeln!(
            text,
            "  {:<width$}{:>14}{:>14}{:>14}{:>9}{:>22}",
            "fairlead", "mean of max", "std of max", "largest", "of seed", "most probable of 3 h"
        );
    }
    for (name, of) in known {
        let _ = writeln!(
            text,
            "  {name:<width$}{:>14}{:>14}{:>14}{:>9}{:>22}",
            unit.show(of.mean_of_max),
            unit.show(of.std_of_max),
            unit.show(of.max),
            of.max_seed,
            of.extreme.most_probable_maximum.map_or("–".to_owned(), |value| unit.show(value)),
        );
    }
    let _ = writeln!(text, "\n  {summary}  over the seeds; each has its own files in seed-N beside it");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEA: &str = r#"environment.waves={"kind": "jonswap", "hs": 3, "tp": 9}"#;

    fn of(text: &str, sets: &[&str]) -> Result<Vec<u64>, String> {
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        let loaded = crate::scene::read::built_in(&sets).expect("a scene");
        wanted(&loaded, text).map_err(|error| {
            assert_eq!(error.exit_code(), 2);
            error.to_string()
        })
    }

    #[test]
    fn seeds_are_ranges_and_lists() {
        assert_eq!(of("1:4", &[SEA]), Ok(vec![1, 2, 3, 4]));
        assert_eq!(of("3, 7,9", &[SEA]), Ok(vec![3, 7, 9]));
        assert_eq!(of("0", &[SEA]), Ok(vec![0]));
        assert_eq!(of("5:5,1:2", &[SEA]), Ok(vec![5, 1, 2]));
        assert_eq!(of("1:1000", &[SEA]).map(|seeds| seeds.len()), Ok(1000));
        assert_eq!(of("18446744073709551615", &[SEA]), Ok(vec![u64::MAX]));
    }

    #[test]
    fn bad_seeds_are_named_with_what_is_allowed() {
        for (text, words) in [
            ("", ["--seeds: \"\" is not allowed", "1:20"]),
            (",", ["--seeds: \"\"", "3,7,9"]),
            ("1,", ["--seeds: \"\"", "3,7,9"]),
            ("5:1", ["--seeds: 5:1", "a range goes up"]),
            ("1:", ["--seeds: \"1:\"", "from the first to the last"]),
            ("-3", ["--seeds: \"-3\"", "whole numbers from 0"]),
            ("1.5", ["--seeds: \"1.5\"", "whole numbers"]),
            ("1:2:3", ["--seeds: \"1:2:3\"", "1:20"]),
            ("3,1:5", ["--seeds: 3,1:5", "seed 3 stands twice"]),
            ("1:1001", ["--seeds: 1:1001", "at most 1000"]),
            ("1:600,2000:2600", ["--seeds: 2000:2600", "at most 1000"]),
            ("0:18446744073709551615", ["--seeds: 0:18446744073709551615", "at most 1000"]),
        ] {
            let message = of(text, &[SEA]).expect_err(text);
            words.iter().for_each(|word| assert!(message.contains(word), "{text}: {message}"));
        }
        let message = of("1:3", &[SEA, "run.duration=8"]).expect_err("nothing counts");
        assert!(message.contains("run.duration: 8 s") && message.contains("first 48.75 s are the ramp"), "{message}");
        for sets in [&[][..], &[r#"environment.waves={"kind": "regular", "amplitude": 1, "period": 9}"#]] {
            let message = of("1:3", sets).expect_err("no random sea");
            assert!(message.contains("--seeds: 1:3") && message.contains("no random sea"), "{message}");
        }
    }
}
