//! Nodes: where everything is.

use zrak_scene::lower::Transform;

use crate::buffers::element;
use crate::error::{Error, ErrorKind, Warnings};
use crate::json::{Node, Root};

/// A forest of nodes, without recursion: its depth is the file's choice.
pub(crate) struct Hierarchy {
    /// The map of each node from its own space to the world.
    pub(crate) world_from_node: Vec<Transform>,
    /// The nodes of the scene, parents first, in the order of the file.
    pub(crate) in_scene: Vec<usize>,
    /// The scene that was chosen, if the file has any.
    pub(crate) scene: Option<usize>,
}

/// The index of a scene, by its name or else by its number.
fn find_scene(root: &Root, wanted: &str) -> Result<usize, Error> {
    let by_name = root.scenes.iter().position(|scene| scene.name.as_deref() == Some(wanted));
    let by_number = || wanted.parse().ok().filter(|&i| i < root.scenes.len());
    by_name.or_else(by_number).ok_or_else(|| {
        let names = root.scenes.iter().take(20).map(|scene| scene.name.as_deref().unwrap_or("-"));
        let names: Vec<_> = names.map(|name| name.escape_debug().to_string()).collect();
        let n = root.scenes.len();
        let help = format!("name one of its {n}, or give its number from 0: {}", names.join(", "));
        let message = format!("there is no scene '{}' in the file", wanted.escape_debug());
        Error::new(ErrorKind::Invalid, "scenes", message, help)
    })
}

/// Looks at all nodes, and chooses a scene.
pub(crate) fn read(
    root: &Root,
    scene: Option<&str>,
    warnings: &mut Warnings,
) -> Result<Hierarchy, Error> {
    let nodes = &root.nodes;
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for (i, node) in nodes.iter().enumerate() {
        for (k, &child) in node.children.iter().enumerate() {
            let at = || format!("nodes[{i}].children[{k}]");
            element(nodes, "nodes", child, at())?;
            if let Some(other) = parents[child] {
                let message = format!("nodes[{child}] is already a child of nodes[{other}]");
                return Err(Error::invalid(at(), message));
            }
            parents[child] = Some(i);
        }
    }
    let roots: Vec<usize> = (0..nodes.len()).filter(|&i| parents[i].is_none()).collect();
    let order = walk(nodes, &roots);
    if order.len() < nodes.len() {
        // Every node has at most one parent, so what no root leads to goes round.
        let mut is_seen = vec![false; nodes.len()];
        order.iter().for_each(|&i| is_seen[i] = true);
        let i = is_seen.iter().position(|seen| !seen).unwrap_or(0);
        return Err(Error::invalid(format_args!("nodes[{i}]"), "the node is its own ancestor"));
    }
    let mut world_from_node = vec![Transform::IDENTITY; nodes.len()];
    for &i in &order {
        let local = local(&nodes[i], i, warnings)?;
        let outer = parents[i].map_or(Transform::IDENTITY, |parent| world_from_node[parent]);
        world_from_node[i] = local.then(&outer);
    }
    let chosen = match (scene, root.scene) {
        (Some(wanted), _) => Some(find_scene(root, wanted)?),
        (None, Some(index)) => {
            element(&root.scenes, "scenes", index, "scene")?;
            Some(index)
        }
        (None, None) => (!root.scenes.is_empty()).then_some(0),
    };
    let in_scene = match chosen {
        None => order,
        Some(index) => {
            let scene = &root.scenes[index];
            let mut is_seen = vec![false; nodes.len()];
            for (k, &node) in scene.nodes.iter().enumerate() {
                let at = || format!("scenes[{index}].nodes[{k}]");
                element(nodes, "nodes", node, at())?;
                if let Some(parent) = parents[node] {
                    let message = format!("nodes[{node}] is a child of nodes[{parent}]");
                    return Err(Error::invalid(at(), message));
                }
                if std::mem::replace(&mut is_seen[node], true) {
                    return Err(Error::invalid(at(), format!("nodes[{node}] is there twice")));
                }
            }
            walk(nodes, &scene.nodes)
        }
    };
    Ok(Hierarchy { world_from_node, in_scene, scene: chosen })
}

/// The nodes below and at `roots`, parents first. It ends, as no node has two parents.
fn walk(nodes: &[Node], roots: &[usize]) -> Vec<usize> {
    let mut order = Vec::new();
    let mut waiting: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(i) = waiting.pop() {
        order.push(i);
        waiting.extend(nodes[i].children.iter().rev());
    }
    order
}

/// The map of a node from its own space to its parent's.
fn local(node: &Node, i: usize, warnings: &mut Warnings) -> Result<Transform, Error> {
    let at = |key: &str| format!("nodes[{i}].{key}");
    let has_steps = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(m) = &node.matrix {
        if has_steps {
            warnings.note(at("matrix"), "the node has other transforms too, which are ignored");
        }
        if [m[3], m[7], m[11]].iter().any(|x| x.abs() > 1e-6) || (m[15] - 1.0).abs() > 1e-6 {
            return Err(Error::invalid(at("matrix"), "the last row is not 0, 0, 0, 1"));
        }
        let row = |r: usize| [m[r], m[4 + r], m[8 + r], m[12 + r]];
        return Ok(Transform { rows: [row(0), row(1), row(2)] });
    }
    let turn = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let [x, y, z] = node.translation.unwrap_or([0.0; 3]);
    of_steps([x, y, z], turn, node.scale.unwrap_or([1.0; 3]))
        .ok_or_else(|| Error::invalid(at("rotation"), "the quaternion has no length"))
}

/// The map that scales, turns by a quaternion (x, y, z, w) of any length but zero, and moves.
pub(crate) fn of_steps(t: [f64; 3], turn: [f64; 4], s: [f64; 3]) -> Option<Transform> {
    let largest = turn.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let q = turn.map(|x| x / largest);
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z, w] = q.map(|x| x / length);
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let row = |i: usize| [rows[i][0] * s[0], rows[i][1] * s[1], rows[i][2] * s[2], t[i]];
    Some(Transform { rows: [row(0), row(1), row(2)] })
}
