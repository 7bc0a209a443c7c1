//! "Did you mean ...?": the nearest of some names to a misspelt one.

/// The candidate nearest to `name`, if one is near enough to be what was meant.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted: Vec<char> = name.to_lowercase().chars().take(MAX_CHARS).collect();
    candidates
        .into_iter()
        .map(|candidate| {
            let chars: Vec<char> = candidate.to_lowercase().chars().take(MAX_CHARS).collect();
            // Leaving off the end, such as `_deg`, is one slip.
            let is_beginning = wanted.len() >= 4 && chars.starts_with(&wanted);
            let distance = if is_beginning { 1 } else { distance(&wanted, &chars) };
            (distance, chars.len().max(wanted.len()), candidate)
        })
        // One slip in three letters is a slip; more is another word.
        .filter(|&(distance, len, _)| distance <= (len / 3).max(1) && distance < len)
        .min_by_key(|&(distance, ..)| distance)
        .map(|(_, _, candidate)| candidate)
}

/// `` `a`, `b` or `c` ``: one of these is expected.
pub(crate) fn list_any<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    list(names, "or")
}

/// `` `a`, `b` and `c` ``: these are all there are.
pub(crate) fn list_all<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    list(names, "and")
}

fn list<'a>(names: impl IntoIterator<Item = &'a str>, conjunction: &str) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => "nothing".to_owned(),
        [one] => one.clone(),
        [first @ .., last] if names.len() <= MAX_LISTED => {
            format!("{} {conjunction} {last}", first.join(", "))
        }
        _ => format!("{} and {} more", names[..MAX_LISTED].join(", "), names.len() - MAX_LISTED),
    }
}

/// Longer names are compared by their beginnings.
const MAX_CHARS: usize = 64;

/// More names than this are counted.
const MAX_LISTED: usize = 12;

/// Optimal string alignment distance (restricted Damerau-Levenshtein): insertions, deletions,
/// substitutions and swaps of neighbours.
fn distance(a: &[char], b: &[char]) -> usize {
    // Lines of the table of the distances of a[..i] and b[..j], j across.
    let mut rows = [vec![0; b.len() + 1], (0..=b.len()).collect::<Vec<_>>(), vec![0; b.len() + 1]];
    for i in 1..=a.len() {
        // rows[0], rows[1], rows[2]: lines i - 2, i - 1, i.
        rows[2][0] = i;
        for j in 1..=b.len() {
            let substitution = rows[1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = substitution.min(rows[1][j] + 1).min(rows[2][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[0][j - 2] + 1);
            }
            rows[2][j] = best;
        }
        rows.rotate_left(1);
    }
    rows[1][b.len()]
}

#[cfg(test)]
mod tests {
    use super::{closest, distance, list_all, list_any};

    #[test]
    fn distances() {
        for (a, b, expected) in [
            ("", "", 0),
            ("", "abc", 3),
            ("kitten", "sitting", 3),
            ("radus", "radius", 1),
            ("fianl", "final", 1),
        ] {
            let [a, b] = [a, b].map(|s| s.chars().collect::<Vec<_>>());
            assert_eq!([distance(&a, &b), distance(&b, &a)], [expected; 2]);
        }
    }

    #[test]
    fn only_near_names_are_suggested() {
        assert_eq!(closest("radus", ["center", "radius"]), Some("radius"));
        assert_eq!(closest("grond", ["ground", "round"]), Some("ground"));
        assert_eq!(closest("rotate_y", ["rotate", "rotate_y_deg"]), Some("rotate_y_deg"));
        assert_eq!(closest("x", ["y"]), None);
        assert_eq!(closest("teapot", ["sphere", "box"]), None);
    }

    #[test]
    fn lists_read_well() {
        assert_eq!(list_any(["a"]), "`a`");
        assert_eq!(list_any(["a", "b", "c"]), "`a`, `b` or `c`");
        assert_eq!(list_all(["a", "b"]), "`a` and `b`");
        assert!(list_all(["a"; 20]).ends_with("`a` and 8 more"));
    }
}
