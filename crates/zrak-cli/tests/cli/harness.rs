//! Running `zrak` in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A folder in which `zrak` runs.
pub(crate) struct Folder(TempDir);

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names of all files, hidden ones too.
    pub(crate) fn list(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// `zrak` with arguments that are separated by spaces, before it runs. It sees no GPU, so that
    /// it says the same on every machine.
    pub(crate) fn command(&self, args: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_zrak"));
        prepare(&mut command, self.0.path());
        command.args(args.split_whitespace());
        command
    }

    /// A shell script in which `zrak` is the program.
    pub(crate) fn shell(&self, script: &str) -> Ended {
        let mut command = Command::new("sh");
        prepare(&mut command, self.0.path());
        let script = format!("zrak() {{ \"$ZRAK\" \"$@\"; }}\n{script}");
        command.env("ZRAK", env!("CARGO_BIN_EXE_zrak")).args(["-c", &script]);
        ended(command.output().unwrap())
    }

    pub(crate) fn run(&self, args: &str) -> Ended {
        ended(self.command(args).output().unwrap())
    }

    /// Runs `zrak` and expects success.
    pub(crate) fn ok(&self, args: &str) -> Ended {
        let ended = self.run(args);
        assert_eq!(ended.code, Some(0), "zrak {args}: {ended:?}");
        ended
    }

    /// Runs `zrak` and expects an exit code, words in its message, and no panic.
    pub(crate) fn fails(&self, args: &str, code: i32, words: &[&str]) -> Ended {
        let ended = self.run(args);
        ended.check(code, words);
        ended
    }
}

impl Ended {
    /// Expects an exit code, words on stderr, and no panic.
    pub(crate) fn check(&self, code: i32, words: &[&str]) {
        assert_eq!(self.code, Some(code), "{self:?}");
        for word in words {
            assert!(self.stderr.contains(word), "'{word}' is not in: {}", self.stderr);
        }
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
    }

    /// The line of JSON on stdout.
    pub(crate) fn json(&self) -> serde_json::Value {
        assert_eq!(self.stdout.matches('\n').count(), 1, "{self:?}");
        serde_json::from_str(&self.stdout).unwrap()
    }
}

fn prepare(command: &mut Command, folder: &Path) {
    command.current_dir(folder).env("CUDA_VISIBLE_DEVICES", "").stdin(Stdio::null());
}

pub(crate) fn ended(output: Output) -> Ended {
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}
