//! The classifier as plain data for a model file.

use std::collections::BTreeSet;
use std::fmt;

use serde_json::{Value, json};

use super::asked;
use super::trees::{Forest, Node, Tree};
use super::{Group, Joint, around, view};

/// Why data are not a valid joint classifier.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointModelError {
    /// The invalid part, as members and indices: `second[12]`.
    pub at: String,
    pub what: &'static str,
}

impl fmt::Display for JointModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}; restore the file from a copy, or train it again", self.at, self.what)
    }
}

impl std::error::Error for JointModelError {}

fn refuse<T>(at: impl Into<String>, what: &'static str) -> Result<T, JointModelError> {
    Err(JointModelError { at: at.into(), what })
}

/// Limits on what a file can make the program allocate: real forests have a hundredth of it.
const MOST_TREES: usize = 10_000;
const MOST_NODES: usize = 50_000_000;

impl Joint {
    /// The classifier as data: the names of the features, their typical values, and each tree as a list
    /// of numbers, its nodes from the root down, 'yes' before 'no'. A question is the feature's index and
    /// the threshold; a leaf is -1 and the five counts of labels.
    pub fn to_value(&self) -> Value {
        json!({
            "features": names(),
            "typical": self.typical.iter().map(|&number| number_of(number)).collect::<Vec<_>>(),
            "without": self.left_out.iter().map(|&group| format!("{group:?}")).collect::<Vec<_>>(),
            "temperature": self.temperature,
            "first": trees_of(&self.first),
            "second": trees_of(&self.second),
        })
    }

    /// Reads the classifier from such data.
    ///
    /// # Errors
    /// When something is missing or invalid; the error says where.
    pub fn from_value(value: &Value) -> Result<Self, JointModelError> {
        let list = |name: &'static str| match value.get(name).and_then(Value::as_array) {
            Some(list) => Ok(list),
            None => refuse(name, "is missing or no list"),
        };
        let features = list("features")?;
        if !features.iter().map(Value::as_str).eq(names().into_iter().map(Some)) {
            return refuse("features", "are not those of this version of the program");
        }
        let typical: Vec<f32> = list("typical")?
            .iter()
            .filter_map(|number| number.as_f64().map(|number| number as f32).filter(|number| number.is_finite()))
            .collect();
        if typical.len() != features.len() {
            return refuse("typical", "does not hold a number for each feature");
        }
        let mut left_out = BTreeSet::new();
        for name in list("without")? {
            match Group::ALL.into_iter().find(|group| name.as_str() == Some(&format!("{group:?}"))) {
                Some(group) => left_out.insert(group),
                None => return refuse("without", "names an unknown group of features"),
            };
        }
        let temperature = value.get("temperature").and_then(Value::as_f64).unwrap_or_default();
        if !(temperature.is_finite() && temperature > 0.0) {
            return refuse("temperature", "is missing or no positive number");
        }
        let first = forest("first", list("first")?, view::FEATURES.len())?;
        let second = forest("second", list("second")?, features.len())?;
        Ok(Self { first, second, temperature, typical, left_out })
    }
}

fn names() -> Vec<&'static str> {
    view::FEATURES.iter().chain(around::FEATURES).map(|(_, name)| *name).collect()
}

/// The shortest decimal number that reads back as the same `f32`.
fn number_of(number: f32) -> f64 {
    number.to_string().parse().unwrap_or_else(|_| f64::from(number))
}

fn trees_of(forest: &Forest) -> Value {
    let tree = |tree: &Tree| -> Value {
        let mut numbers: Vec<Value> = Vec::new();
        for node in &tree.nodes {
            match node {
                Node::Question { feature, at_most, .. } => {
                    numbers.push(json!(feature));
                    numbers.push(json!(number_of(*at_most)));
                }
                Node::Leaf(counts) => {
                    numbers.push(json!(-1));
                    numbers.extend(counts.iter().map(|count| json!(count)));
                }
            }
        }
        Value::Array(numbers)
    };
    forest.trees().iter().map(tree).collect()
}

fn forest(name: &str, trees: &[Value], features: usize) -> Result<Forest, JointModelError> {
    if trees.is_empty() || trees.len() > MOST_TREES {
        return refuse(name, "has no trees, or more than can be meant");
    }
    let mut nodes = 0;
    let mut read = Vec::with_capacity(trees.len());
    for (index, numbers) in trees.iter().enumerate() {
        let at = || format!("{name}[{index}]");
        let Some(numbers) = numbers.as_array() else { return refuse(at(), "is no list of numbers") };
        let tree = tree(numbers, features).or_else(|what| refuse(at(), what))?;
        nodes += tree.nodes.len();
        if nodes > MOST_NODES || tree.nodes.len() > asked::MOST_NODES {
            return refuse(name, "is larger than can be meant");
        }
        read.push(tree);
    }
    Ok(Forest::new(read))
}

/// A tree from its numbers. Questions still waiting for their second child are on an explicit stack, so
/// that no tree is too deep.
fn tree(numbers: &[Value], features: usize) -> Result<Tree, &'static str> {
    const CUT: &str = "ends within a node, or holds what is no number";
    let mut numbers = numbers.iter();
    let mut nodes: Vec<Node> = Vec::new();
    let mut waiting: Vec<usize> = Vec::new();
    loop {
        let first = numbers.next().and_then(Value::as_i64).ok_or(CUT)?;
        if first >= 0 {
            let feature = usize::try_from(first).unwrap_or(usize::MAX);
            let at_most = numbers.next().and_then(Value::as_f64).ok_or(CUT)? as f32;
            if feature >= features || !at_most.is_finite() {
                return Err("asks about a feature that does not exist, or for no number");
            }
            waiting.push(nodes.len());
            nodes.push(Node::Question { feature, at_most, no: 0 });
            continue;
        }
        let mut counts = [0; 5];
        for count in &mut counts {
            let number = numbers.next().and_then(Value::as_u64).ok_or(CUT)?;
            *count = u32::try_from(number).map_err(|_| "counts more rooms than can be meant")?;
        }
        if counts.iter().all(|&count| count == 0) {
            return Err("has a leaf without rooms");
        }
        nodes.push(Node::Leaf(counts));
        let next = nodes.len();
        match waiting.pop() {
            Some(question) => {
                if let Node::Question { no, .. } = &mut nodes[question] {
                    *no = next;
                }
            }
            None if numbers.next().is_none() => return Ok(Tree { nodes }),
            None => return Err("goes on after its last leaf"),
        }
    }
}
