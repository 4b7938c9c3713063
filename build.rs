//! modelDescription.xml → the Rust enums and the table of the FMU's variables. Reads that one file, writes one into `OUT_DIR`.

use roxmltree::{Document, Node};
use std::error::Error;
use std::fmt::Write;
use std::{env, fs, path::Path};

const SOURCE: &str = "modelDescription/modelDescription.xml";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={SOURCE}");
    let text = fs::read_to_string(SOURCE).map_err(|error| format!("{SOURCE}: {error}"))?;
    let document = Document::parse(&text).map_err(|error| format!("{SOURCE}: {error}"))?;
    let mut code = String::new();
    for causality in ["input", "output", "local", "parameter"] {
        write_enum(&mut code, &document, causality)?;
    }
    write_table(&mut code, &document)?;
    write_lists(&mut code, &document)?;
    fs::write(Path::new(&env::var("OUT_DIR")?).join("variables.rs"), code)?;
    Ok(())
}

/// One enum per causality, so that a `match` over it must give every variable a meaning.
fn write_enum(code: &mut String, document: &Document, causality: &str) -> Result<(), Box<dyn Error>> {
    writeln!(code, "/// Variables of causality `{causality}`.")?;
    writeln!(code, "#[derive(Debug, Clone, Copy, PartialEq, Eq)]\npub enum {} {{", camel(causality))?;
    for variable in variables(document).filter(|variable| variable.attribute("causality") == Some(causality)) {
        let name = required(variable, "name")?;
        writeln!(code, "    /// `{name}`: {}.\n    {},", required(variable, "description")?, camel(name))?;
    }
    writeln!(code, "}}\n")?;
    Ok(())
}

/// The table: name, value reference, meaning, kind, limits and start value, in the order of the file.
fn write_table(code: &mut String, document: &Document) -> Result<(), Box<dyn Error>> {
    writeln!(code, "/// The variables of modelDescription.xml, in its order.\npub const DEFINITIONS: &[Definition] = &[")?;
    for variable in variables(document) {
        let name = required(variable, "name")?;
        let causality = camel(required(variable, "causality")?);
        let value = variable.children().find(Node::is_element).ok_or_else(|| format!("{SOURCE}: {name} has no type"))?;
        let declared = value.attribute("declaredType").and_then(|wanted| {
            let types = document.descendants().filter(|node| node.has_tag_name("SimpleType"));
            types.filter(|node| node.attribute("name") == Some(wanted)).find_map(|node| node.first_element_child())
        });
        let limit = |attribute: &str| value.attribute(attribute).or_else(|| declared?.attribute(attribute));
        let (kind, min, max) = match value.tag_name().name() {
            "Real" => ("Real", number(limit("min"), "f64::NEG_INFINITY")?, number(limit("max"), "f64::INFINITY")?),
            "Integer" => ("Integer", number(limit("min"), "f64::NEG_INFINITY")?, number(limit("max"), "f64::INFINITY")?),
            "Enumeration" => {
                let items = declared.map_or(0, |node| node.children().filter(Node::is_element).count());
                ("Integer", "1f64".to_owned(), format!("{items}f64"))
            }
            other => return Err(format!("{SOURCE}: {name}: variables of type {other} have no meaning here").into()),
        };
        writeln!(
            code,
            "    Definition {{ name: {name:?}, reference: {}, meaning: Meaning::{causality}({causality}::{}), kind: Kind::{kind}, min: {min}, max: {max}, start: {} }},",
            required(variable, "valueReference")?,
            camel(name),
            number(value.attribute("start"), "0.0f64")?,
        )?;
    }
    writeln!(code, "];\n")?;
    Ok(())
}

/// What else the program needs of the file: log categories and the default step.
fn write_lists(code: &mut String, document: &Document) -> Result<(), Box<dyn Error>> {
    let categories = document.descendants().filter(|node| node.has_tag_name("Category"));
    let categories = categories.map(|node| required(node, "name")).collect::<Result<Vec<_>, _>>()?;
    writeln!(code, "/// Names of the log categories.\npub const LOG_CATEGORIES: &[&str] = &{categories:?};\n")?;
    let experiment = document.descendants().find(|node| node.has_tag_name("DefaultExperiment"));
    let step = experiment.and_then(|node| node.attribute("stepSize"));
    writeln!(
        code,
        "/// Communication step of the default experiment [s].\npub const DEFAULT_STEP: f64 = {};",
        number(step, "0.1f64")?
    )?;
    Ok(())
}

fn variables<'a>(document: &'a Document) -> impl Iterator<Item = Node<'a, 'a>> {
    document.descendants().filter(|node| node.has_tag_name("ScalarVariable"))
}

fn required<'a>(node: Node<'a, '_>, attribute: &str) -> Result<&'a str, String> {
    node.attribute(attribute).ok_or_else(|| format!("{SOURCE}: <{}> without {attribute}", node.tag_name().name()))
}

/// A number of the file as a Rust literal.
fn number(text: Option<&str>, default: &str) -> Result<String, String> {
    match text {
        Some(text) => {
            text.parse::<f64>().map(|value| format!("{value:?}f64")).map_err(|error| format!("{SOURCE}: {text:?}: {error}"))
        }
        None => Ok(default.to_owned()),
    }
}

/// `line.added_mass.normal` → `LineAddedMassNormal`.
fn camel(name: &str) -> String {
    name.split(['.', '_'])
        .map(|part| part.chars().take(1).flat_map(char::to_uppercase).chain(part.chars().skip(1)).collect::<String>())
        .collect()
}
