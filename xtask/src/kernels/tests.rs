//! The committed PTX is that of the sources.

use super::header::Header;
use super::names::without_disambiguators;
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

#[test]
fn names_do_not_tell_where_the_repository_lies() {
    let here = ".func _RNvMs_NtNtCs6bRc8Qz7shU_9zrak_core5bxdfs7layered4eval(.param x) // Cs Cs_ Csx Csx_y";
    let there = here.replace("6bRc8Qz7shU", "iF0Fy7VMUpU");
    let clean = without_disambiguators(here);
    assert_eq!(clean, without_disambiguators(&there));
    assert_eq!(clean, here.replace("6bRc8Qz7shU", ""));
    let committed =
        std::fs::read_to_string(crate::repository().join(PTX)).expect("it is committed");
    assert_eq!(without_disambiguators(&committed), committed);
}
