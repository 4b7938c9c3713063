//! `--set a.b=v`: changes to a scene before it is read.
//!
//! A place is keys and indices, `lines.0.fairlead.2` or `lines[0].fairlead[2]`; a key with a dot in it is written
//! `line_types["a.b"]`. The value is JSON where it can be, else a word: `run.duration=60`, `motion.kind=fixed`,
//! `lines[0].anchor=[900,0,-120]`. Objects on the way that are missing are made; `null` takes a key away, so that its default holds.
//! A new `kind` of motion or waves begins afresh: all keys of the old kind are dropped, those set beside it are kept.
//! For that the kinds are set first, all else in the order given.

use super::place::{Place, Step, shortened};
use crate::error::{Error, Problem};
use serde_json::{Map, Value};

/// Places longer than this lead nowhere in a scene.
const LONGEST: usize = 16;

/// One `--set`, read.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The place as typed.
    pub typed: String,
    steps: Vec<Step>,
    value: Value,
}

/// A setting and the place of the scene that it determines.
#[derive(Debug, Clone, PartialEq)]
pub struct Applied {
    /// The place as typed.
    pub typed: String,
    /// The place of the scene.
    pub place: Place,
}

/// Applies `--set` entries to a scene; `file` is for messages. Returns what each one did, in the order done.
pub fn apply(scene: &mut Value, sets: &[String], file: &str) -> Result<Vec<Applied>, Error> {
    let mut settings = sets.iter().map(|text| read(text, file)).collect::<Result<Vec<Setting>, Error>>()?;
    settings.sort_by_key(|setting| setting.steps.last() != Some(&Step::Key("kind".into())));
    let mut applied = Vec::new();
    for Setting { typed, steps, value } in settings {
        match put(scene, &steps, value) {
            Ok(place) => applied.push(Applied { typed, place }),
            Err(problem) => {
                return Err(Error::Set { file: file.into(), setting: typed, place: String::new(), problem: problem.into() });
            }
        }
    }
    Ok(applied)
}

/// Reads `place=value`.
fn read(text: &str, file: &str) -> Result<Setting, Error> {
    let typed = text.split_once('=').map_or(text, |(place, _)| place).trim();
    let setting = text.split_once('=').and_then(|(place, value)| {
        let value = serde_json::from_str(value).unwrap_or_else(|_| Value::String(value.trim().to_string()));
        Some(Setting { typed: shortened(typed), steps: steps(place.trim())?, value })
    });
    setting.ok_or_else(|| Error::Set {
        file: file.into(),
        setting: shortened(text),
        place: String::new(),
        problem: Problem::Setting.into(),
    })
}

/// The steps of a place as typed; `None` where it cannot be read.
fn steps(mut rest: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    while steps.len() < LONGEST {
        if let Some(bracket) = rest.strip_prefix("[\"") {
            let (key, behind) = bracket.split_once("\"]")?;
            steps.push(Step::Key(key.to_string()));
            rest = behind;
        } else if let Some(bracket) = rest.strip_prefix('[') {
            let (index, behind) = bracket.split_once(']')?;
            // An index that is no number is kept as a key: the list it is meant for knows how to say what is allowed.
            steps.push(index.parse().map_or_else(|_| Step::Key(index.to_string()), Step::Index));
            rest = behind;
        } else {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            let (key, behind) = rest.split_at(end);
            if key.is_empty() {
                return None;
            }
            steps.push(Step::Key(key.to_string()));
            rest = behind;
        }
        if rest.is_empty() {
            return Some(steps);
        }
        if let Some(behind) = rest.strip_prefix('.') {
            rest = behind;
            if rest.starts_with('[') {
                return None;
            }
        } else if !rest.starts_with('[') {
            return None;
        }
    }
    None
}

/// Puts a value at a place; returns the place that is determined by it, with lists and objects told apart.
fn put(scene: &mut Value, steps: &[Step], value: Value) -> Result<Place, Problem> {
    let mut here = Place::default();
    let mut container = scene;
    for (number, step) in steps.iter().enumerate() {
        let last = number + 1 == steps.len();
        if container.is_null() {
            let entry = match step {
                Step::Index(index) => Some(index.to_string()),
                Step::Key(key) => key.parse::<usize>().ok().map(|index| index.to_string()),
            };
            if let Some(index) = entry {
                return Err(Problem::Index { place: here.to_string(), index, length: 0 });
            }
            *container = Value::Object(Map::new());
        }
        match container {
            Value::Array(list) => {
                let index = index(step, list.len(), &here)?;
                here = here.with(Step::Index(index));
                container = &mut list[index];
            }
            Value::Object(object) => {
                let key = match step {
                    Step::Key(key) => key.clone(),
                    Step::Index(index) => index.to_string(),
                };
                let place = here.member(&key);
                if last && key == "kind" && object.get(&key) != Some(&value) {
                    object.clear();
                    object.insert(key, value);
                    return Ok(here);
                }
                if last && value.is_null() {
                    object.remove(&key);
                    return Ok(place);
                }
                here = place;
                container = object.entry(key).or_insert(Value::Null);
            }
            scalar => return Err(Problem::Inside { place: here.to_string(), found: shortened(&scalar.to_string()) }),
        }
    }
    *container = value;
    Ok(here)
}

/// The index that a step means in a list at `place`.
fn index(step: &Step, length: usize, place: &Place) -> Result<usize, Problem> {
    let (index, typed) = match step {
        Step::Index(index) => (Some(*index), index.to_string()),
        Step::Key(key) => (key.parse().ok(), key.clone()),
    };
    let wrong = || Problem::Index { place: place.to_string(), index: shortened(&typed), length };
    index.filter(|index| *index < length).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn set(scene: Value, sets: &[&str]) -> Result<Value, Error> {
        let mut scene = scene;
        let sets: Vec<String> = sets.iter().map(|text| text.to_string()).collect();
        apply(&mut scene, &sets, "test").map(|_| scene)
    }

    #[test]
    fn both_ways_of_writing_an_index_reach_the_same_place() {
        let scene = json!({"lines": [{"fairlead": [0, 0, 0]}]});
        let expected = json!({"lines": [{"fairlead": [0, 0, 1.5]}]});
        assert_eq!(set(scene.clone(), &["lines.0.fairlead.2=1.5"]), Ok(expected.clone()));
        assert_eq!(set(scene, &["lines[0].fairlead[2]=1.5"]), Ok(expected));
    }

    #[test]
    fn values_are_json_or_words_and_null_takes_a_key_away() {
        let changed = set(json!({"a": 1}), &["b.c=[1,2]", "d=word", "e=1e3", "a=null", r#"t["x.y"].z=true"#]);
        assert_eq!(changed, Ok(json!({"b": {"c": [1, 2]}, "d": "word", "e": 1e3, "t": {"x.y": {"z": true}}})));
    }

    #[test]
    fn a_new_kind_begins_afresh_wherever_it_stands_among_the_settings() {
        let scene = json!({"motion": {"kind": "sinusoidal", "period": 15}});
        assert_eq!(set(scene.clone(), &["motion.kind=fixed"]), Ok(json!({"motion": {"kind": "fixed"}})));
        assert_eq!(
            set(scene.clone(), &["motion.path=a.csv", "motion.kind=file"]),
            Ok(json!({"motion": {"kind": "file", "path": "a.csv"}}))
        );
        assert_eq!(set(scene.clone(), &["motion.kind=sinusoidal"]), Ok(scene));
    }

    #[test]
    fn places_that_cannot_be_read_are_refused() {
        let long = format!("{}a=1", "a.".repeat(100_000));
        for text in ["", "=1", "a", "a.=1", ".a=1", "a..b=1", "a[0=1", "a[0]b=1", "a.[0]=1", &long] {
            assert!(matches!(set(json!({}), &[text]), Err(Error::Set { problem, .. }) if *problem == Problem::Setting), "{text}");
        }
    }
}
