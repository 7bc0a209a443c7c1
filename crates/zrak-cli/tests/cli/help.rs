//! The help, the completions and the man pages.

use crate::harness::Folder;

const SUBCOMMANDS: [&str; 10] = [
    "render",
    "scenes",
    "convert",
    "info",
    "devices",
    "compare",
    "selftest",
    "bench",
    "completions",
    "man",
];

#[test]
fn help_lists_subcommands_and_exit_codes() {
    let folder = Folder::new();
    let help = folder.ok("--help").stdout;
    assert!(SUBCOMMANDS.iter().all(|name| help.contains(name)), "{help}");
    assert!(help.contains("Exit codes:\n  0    success"), "{help}");
    for code in ["1", "2", "3", "4", "5", "130"] {
        assert!(help.contains(&format!("\n  {code:<3}  ")), "{code} is not in {help}");
    }
    for name in SUBCOMMANDS {
        assert!(folder.ok(&format!("{name} --help")).stdout.contains("Usage: zrak"), "{name}");
    }
    let version = concat!("zrak ", env!("CARGO_PKG_VERSION"), "\n");
    assert_eq!(folder.ok("--version").stdout, version);
}

#[test]
fn completions_are_made_for_every_shell() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.ok(&format!("completions {shell}")).stdout;
        assert!(script.contains("selftest") && script.contains("max-depth"), "{shell}");
    }
    folder.fails("completions cmd", 2, &["bash"]);
}

#[test]
fn man_pages_are_printed_or_written() {
    let folder = Folder::new();
    let printed = folder.ok("man").stdout;
    assert!(printed.contains(".TH zrak 1") && printed.contains(".TH zrak-render 1"), "{printed}");
    folder.ok("man pages/man1");
    let page = |name: &str| String::from_utf8(folder.read(&format!("pages/man1/{name}"))).unwrap();
    assert!(page("zrak.1").contains("Exit codes"));
    for name in SUBCOMMANDS {
        assert!(page(&format!("zrak-{name}.1")).contains(&format!("zrak\\-{name}")), "{name}");
    }
    folder.write("file", "");
    folder.fails("man file", 4, &["cannot make the folder 'file'"]);
}
