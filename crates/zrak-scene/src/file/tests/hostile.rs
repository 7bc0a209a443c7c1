use proptest::prelude::*;

use crate::builtin;
use crate::error::SceneErrorKind;
use crate::file::{parse, write_string};

#[test]
fn deep_nesting_is_an_error() {
    let deep = 100_000;
    let head = "format = 1\nname = ''\n";
    let group = "{ kind = 'group', objects = [";
    for text in [
        format!("{head}objects = {}", "[".repeat(deep)),
        format!("{head}objects = {}{}", "[".repeat(deep), "]".repeat(deep)),
        format!("{head}objects = [{}{}]", group.repeat(deep), "]}".repeat(deep)),
        format!("{head}x = {}", "{ a.b.c = ".repeat(deep)),
        format!("{head}a{} = 1", ".a".repeat(deep)),
        format!("{head}[a{}]", ".a".repeat(deep)),
        format!("{head}[[objects{}]]", ".objects".repeat(deep)),
    ] {
        let error = parse(&text, "deep.toml").unwrap_err();
        assert_eq!(error.kind(), SceneErrorKind::Syntax);
        assert!(error.to_string().contains("nested too deeply"), "{error}");
    }
}

/// Groups in groups, `depth` of them, as tables.
fn groups(depth: usize) -> String {
    let mut text = write_string(&(builtin::find("quads").unwrap().build)());
    text.truncate(text.find("[[objects]]").unwrap());
    for i in 1..=depth {
        text += &format!("[[{}]]\nkind = 'group'\n", vec!["objects"; i].join("."));
    }
    text + "objects = []\n"
}

#[test]
fn groups_nest_to_their_limit() {
    parse(&groups(64), "x").unwrap();
    for depth in [65, 66, 79] {
        let error = parse(&groups(depth), "x").unwrap_err();
        assert!(error.to_string().contains("groups are nested more than 64 deep"), "{error}");
    }
}

/// The exported built-in scenes, cut to a size that makes many trials possible.
fn exported() -> Vec<String> {
    builtin::all()
        .iter()
        .map(|builtin| {
            let mut scene = (builtin.build)();
            scene.objects.truncate(12);
            write_string(&scene)
        })
        .collect()
}

#[derive(Clone, Debug)]
enum Mutation {
    Flip { at: usize, bits: u8 },
    Insert { at: usize, text: String },
    Remove { at: usize, len: usize },
    Truncate { at: usize },
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let token = prop::sample::select(vec![
        "[",
        "]",
        "{",
        "}",
        "=",
        "\"",
        "'''",
        "\n",
        ".",
        "-",
        "nan",
        "inf",
        "1e999",
        "0x",
        "kind",
        "é",
        "\0",
        "\u{1b}[31m",
        "[[objects]]\n",
        "\r\n",
        "99999999999999999999999999999999999999999",
    ]);
    prop_oneof![
        (any::<usize>(), 1..=255_u8).prop_map(|(at, bits)| Mutation::Flip { at, bits }),
        (any::<usize>(), token)
            .prop_map(|(at, text)| Mutation::Insert { at, text: text.to_owned() }),
        (any::<usize>(), 1..20_usize).prop_map(|(at, len)| Mutation::Remove { at, len }),
        any::<usize>().prop_map(|at| Mutation::Truncate { at }),
    ]
}

fn mutate(bytes: &mut Vec<u8>, mutation: &Mutation) {
    let len = bytes.len().max(1);
    match mutation {
        Mutation::Flip { at, bits } => {
            if let Some(byte) = bytes.get_mut(at % len) {
                *byte ^= bits;
            }
        }
        Mutation::Insert { at, text } => {
            let at = at % len;
            bytes.splice(at..at, text.bytes());
        }
        Mutation::Remove { at, len: n } => {
            let at = at % len;
            bytes.drain(at..(at + n).min(bytes.len()));
        }
        Mutation::Truncate { at } => bytes.truncate(at % len),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn spoilt_scenes_do_not_panic(
        which in 0..builtin::all().len(),
        mutations in prop::collection::vec(mutation(), 1..4),
    ) {
        thread_local!(static EXPORTED: Vec<String> = exported());
        let mut bytes = EXPORTED.with(|exported| exported[which].clone().into_bytes());
        for mutation in &mutations {
            mutate(&mut bytes, mutation);
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Err(error) = parse(&text, "spoilt.toml") {
            let (plain, styled) = (error.to_string(), error.styled());
            prop_assert!(plain.starts_with("error: ") && !styled.is_empty());
            prop_assert!(!plain.contains('\u{1b}'), "{plain:?}");
        }
    }

    #[test]
    fn any_text_does_not_panic(text in "\\PC{0,200}") {
        if let Err(error) = parse(&text, &text) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}
