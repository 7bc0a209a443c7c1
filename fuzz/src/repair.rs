//! Valid scenes out of invalid ones.

use serde_json::Value;
use zrak_scene::desc::SceneDesc;
use zrak_scene::validate::{PathPart, Problem, validate};

/// How often it is tried again.
const TRIES: usize = 12;

/// Takes out of a scene what is wrong with it: the value that a problem points at, or, if the scene cannot do
/// without it, what it belongs to. Nothing if that does not lead to a valid scene.
pub fn repair(scene: &Value) -> Option<SceneDesc> {
    let mut scene = scene.clone();
    for _ in 0..TRIES {
        let desc: SceneDesc = serde_json::from_value(scene.clone()).ok()?;
        let problems = validate(&desc);
        if problems.is_empty() {
            return Some(desc);
        }
        // From the end, so that the indices of those before it stay what they are.
        let mut paths: Vec<&Problem> = problems.iter().collect();
        paths.sort_by_key(|problem| std::cmp::Reverse(key(problem)));
        for problem in paths {
            take_out(&mut scene, &problem.path.0);
        }
    }
    None
}

fn key(problem: &Problem) -> Vec<(usize, String)> {
    let part = |part: &PathPart| match part {
        PathPart::Index(i) => (*i, String::new()),
        PathPart::Key(key) => (0, key.clone()),
    };
    problem.path.0.iter().map(part).collect()
}

/// Removes the innermost thing on a path that can be missing.
fn take_out(scene: &mut Value, path: &[PathPart]) {
    for n in (1..=path.len()).rev() {
        let mut trial = scene.clone();
        if remove(&mut trial, &path[..n])
            && serde_json::from_value::<SceneDesc>(trial.clone()).is_ok()
        {
            *scene = trial;
            return;
        }
    }
}

fn remove(scene: &mut Value, path: &[PathPart]) -> bool {
    let Some((last, before)) = path.split_last() else { return false };
    let mut at = scene;
    for part in before {
        let next = match part {
            PathPart::Key(key) => at.get_mut(key.as_str()),
            PathPart::Index(i) => at.get_mut(*i),
        };
        match next {
            Some(next) => at = next,
            None => return false,
        }
    }
    match (last, at) {
        (PathPart::Key(key), Value::Object(table)) => table.remove(key.as_str()).is_some(),
        // An element of a colour or a point stays, so that what it belongs to is taken out.
        (PathPart::Index(i), Value::Array(array)) if *i < array.len() && !array[*i].is_number() => {
            array.remove(*i);
            true
        }
        _ => false,
    }
}
