//! Several files in one input.

use std::collections::BTreeMap;
use std::path::PathBuf;

/// What stands, at the beginning of a line, before the name of each file but the first.
const MARK: &[u8] = b"#file ";

/// The first file, and all files by name: it is called `first`, the others as the lines `#file NAME` say that they
/// stand under.
pub fn file_set(input: &[u8], first: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let (mut name, mut start, mut at) = (PathBuf::from(first), 0, 0);
    while let Some(line) = next_mark(input, at) {
        let end = input[line..].iter().position(|&b| b == b'\n').map_or(input.len(), |n| line + n);
        files.insert(name, input[start..line].to_vec());
        name = PathBuf::from(
            String::from_utf8_lossy(&input[line + MARK.len()..end]).trim().to_owned(),
        );
        start = (end + 1).min(input.len());
        at = start;
    }
    files.insert(name, input[start..].to_vec());
    files
}

/// Where the next mark stands.
fn next_mark(input: &[u8], from: usize) -> Option<usize> {
    let is_mark = |i: &usize| (*i == 0 || input[i - 1] == b'\n') && input[*i..].starts_with(MARK);
    (from..input.len()).find(is_mark)
}
