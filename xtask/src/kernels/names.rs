//! Names of functions that do not depend on where the repository lies.

/// PTX whose mangled names lack their crates' disambiguators.
///
/// A function that is not inlined keeps its mangled name, in which a crate is `Cs` HASH `_` LENGTH NAME
/// (the v0 mangling of Rust, RFC 2603). The hash of a crate that is found by its path depends on that path,
/// so the bytes would differ from one clone to the next. No two crates of the kernels have the same name.
pub(super) fn without_disambiguators(ptx: &str) -> String {
    let mut pieces = ptx.split("Cs");
    let mut clean = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        clean.push_str("Cs");
        let after_hash = piece.trim_start_matches(|c: char| c.is_ascii_alphanumeric());
        let names_a_crate = after_hash.len() < piece.len()
            && after_hash
                .strip_prefix('_')
                .is_some_and(|name| name.starts_with(|c: char| c.is_ascii_digit()));
        clean.push_str(if names_a_crate { after_hash } else { piece });
    }
    clean
}
