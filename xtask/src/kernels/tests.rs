//! The committed PTX is that of the sources.

use super::header::Header;
use super::{PTX, sources};

#[test]
fn committed_ptx_was_made_from_the_sources() {
    let root = crate::repository();
    let text = std::fs::read_to_string(root.join(PTX)).expect("the PTX is committed");
    let header = Header::parse(&text).expect("the PTX has a header");
    let now = sources::hash(&root).expect("the sources can be read");
    assert_eq!(
        header.sources, now,
        "the kernels' sources have changed: run `cargo xtask kernels` and commit {PTX}"
    );
}

#[test]
fn header_round_trips() {
    let header = Header { sources: "ab12".into(), compiler: "rustc 1.2.3 (x)".into() };
    let text = header.with_body(".version 6.3\n");
    assert!(text.ends_with("\n.version 6.3\n"));
    assert_eq!(Header::parse(&text).expect("it has a header"), header);
    assert!(Header::parse(".version 6.3\n").is_err());
}
