//! Names: those of the file as far as they are there and unique.

use std::collections::BTreeMap;

/// Longest name, in characters, that is kept.
const LENGTH_MAX: usize = 80;

/// The names that are taken.
#[derive(Debug, Default)]
pub(crate) struct Names {
    /// How often each name was asked for, or 0 for those that were made here.
    taken: BTreeMap<String, u32>,
}

impl Names {
    /// A name that no other has: `wanted`, cleaned of what does not belong into names, else `fallback`,
    /// with a number if need be.
    pub(crate) fn unique(&mut self, wanted: Option<&str>, fallback: &str) -> String {
        let base = wanted.map(clean).filter(|name| !name.is_empty());
        let base = base.unwrap_or_else(|| fallback.to_owned());
        if !self.taken.contains_key(&base) {
            self.taken.insert(base.clone(), 1);
            return base;
        }
        // The count only grows, so many equal names take no longer than different ones.
        loop {
            let n = self.taken.get_mut(&base).map_or(1, |n| {
                *n += 1;
                *n
            });
            let name = format!("{base} {n}");
            if !self.taken.contains_key(&name) {
                self.taken.insert(name.clone(), 1);
                return name;
            }
        }
    }
}

/// Without control characters and the separators of paths: meshes and pictures may become files.
fn clean(name: &str) -> String {
    let printable = |c: char| match c {
        '/' | '\\' | ':' => '_',
        c if c.is_control() => ' ',
        c => c,
    };
    let short: String = name.chars().take(LENGTH_MAX).map(printable).collect();
    short.trim().trim_start_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn names_are_unique_and_clean() {
        let mut names = Names::default();
        for (wanted, expected) in [
            (Some("a"), "a"),
            (Some("a"), "a 2"),
            (Some("a 3"), "a 3"),
            (Some("a"), "a 4"),
            (None, "mesh 0"),
            (Some("  \u{7}"), "mesh 0 2"),
            (Some("../b\\c:d"), "_b_c_d"),
        ] {
            assert_eq!(names.unique(wanted, "mesh 0"), expected);
        }
    }
}
