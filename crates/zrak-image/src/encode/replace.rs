//! Replacing a file whole or not at all.
//!
//! The new content goes to `.NAME.PID.part` in the same folder, is synced to the disk, and takes
//! the place of `NAME` by a rename, which is atomic. Whatever fails on the way, the partial file
//! is removed and the old one is as it was.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::{Error, ErrorKind, Format};

/// Puts `bytes` into the file at `path`, replacing what was there whole or not at all.
///
/// A symbolic link stays: the file that it leads to is replaced.
pub fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    replace_file_with(path, |file| file.write_all(bytes))
}

/// Fails if [`write`](crate::write()) to `path` would: to be called before a long render.
///
/// Checks that the extension names a format, that `path` is or may become a file, and that its
/// folder exists and takes a new file, which is created and removed.
pub fn check_writable(path: &Path) -> Result<(), Error> {
    Format::from_path(path)?;
    check_replaceable(path)
}

/// Fails if [`replace_file`] to `path` would: [`check_writable`] for files that are no pictures.
pub fn check_replaceable(path: &Path) -> Result<(), Error> {
    let target = Target::resolve(path)?;
    File::create(&target.part)
        .and_then(|_| fs::remove_file(&target.part))
        .map_err(|cause| write_error(path, &cause))
}

/// [`replace_file`] with the content written by `write_content`.
pub fn replace_file_with(
    path: &Path,
    write_content: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), Error> {
    let target = Target::resolve(path)?;
    let written = File::create(&target.part).and_then(|mut file| {
        write_content(&mut file)?;
        file.sync_all()?;
        // Windows renames only closed files.
        drop(file);
        fs::rename(&target.part, &target.file)
    });
    if let Err(cause) = written {
        // The write's own error is the one to report; there may also be nothing to remove.
        let _ = fs::remove_file(&target.part);
        return Err(write_error(path, &cause));
    }
    // Sync the folder, so that the rename survives a power cut too. Not every file system can,
    // and the content is safe by now.
    #[cfg(unix)]
    let _ = File::open(&target.folder).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Where the bytes of a path go.
struct Target {
    file: PathBuf,
    part: PathBuf,
    #[cfg_attr(not(unix), allow(dead_code))]
    folder: PathBuf,
}

impl Target {
    fn resolve(path: &Path) -> Result<Self, Error> {
        // Follow links of an existing file: a rename would replace the link itself.
        let file = match fs::metadata(path) {
            Ok(metadata) if !metadata.is_file() => {
                let what = if metadata.is_dir() { "a folder" } else { "not a regular file" };
                return Err(Error::new(
                    ErrorKind::NotAFile,
                    format!(
                        "cannot write '{}': it is {what}; give the path of a file",
                        path.display()
                    ),
                ));
            }
            Ok(_) => fs::canonicalize(path).map_err(|cause| write_error(path, &cause))?,
            Err(_) => path.to_owned(),
        };
        let Some(name) = file.file_name() else {
            return Err(Error::new(
                ErrorKind::NotAFile,
                format!("cannot write '{}': it has no file name; add one", path.display()),
            ));
        };
        let mut part_name = std::ffi::OsString::from(".");
        part_name.push(name);
        part_name.push(format!(".{}.part", std::process::id()));
        let folder = match file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        Ok(Self { part: file.with_file_name(part_name), file, folder })
    }
}

fn write_error(path: &Path, cause: &io::Error) -> Error {
    let advice = match cause.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => "create its folder first",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that you may write to"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space or choose another disk; the file there before is unchanged"
        }
        _ => "choose another place; the file there before is unchanged",
    };
    Error::io("write", path, cause, advice)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names of all that is in a folder.
    fn list(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn content_is_replaced_and_nothing_else_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        replace_file(&path, b"one").unwrap();
        replace_file(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(list(folder.path()), ["a.pfm"]);
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_part() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        fs::write(&path, b"old").unwrap();
        let error = replace_file_with(&path, |file| {
            file.write_all(b"half of the new")?;
            Err(io::ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        let text = error.to_string();
        assert!(text.contains("a.pfm") && text.contains("no storage space"), "{text}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(list(folder.path()), ["a.pfm"]);
    }

    /// The device on which every write fails as on a full disk stands in for the partial file.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_reported_in_the_systems_words() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pfm");
        fs::write(&path, b"old").unwrap();
        let part = Target::resolve(&path).unwrap().part;
        std::os::unix::fs::symlink("/dev/full", &part).unwrap();
        let error = replace_file(&path, b"new").unwrap_err();
        assert!(error.to_string().contains("No space left on device"), "{error}");
        assert!(error.to_string().contains("free some space"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(list(folder.path()), ["a.pfm"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file.pfm"), folder.path().join("link.pfm"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink("file.pfm", &link).unwrap();
        replace_file(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");
    }

    #[test]
    fn a_long_render_is_refused_a_place_it_could_not_write_to() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub.png")).unwrap();
        fs::write(folder.path().join("file"), b"").unwrap();
        for (name, kind, words) in [
            ("a.png", None, ""),
            ("a.gif", Some(ErrorKind::UnknownFormat), ".png, .jpg"),
            ("sub.png", Some(ErrorKind::NotAFile), "it is a folder"),
            ("none/a.png", Some(ErrorKind::Io), "create its folder first"),
            ("file/a.png", Some(ErrorKind::Io), "create its folder first"),
        ] {
            let result = check_writable(&folder.path().join(name));
            assert_eq!(result.as_ref().err().map(Error::kind), kind, "{name}");
            if let Err(error) = result {
                let text = error.to_string();
                assert!(text.contains(name) && text.contains(words), "{text}");
            }
        }
        assert_eq!(list(folder.path()), ["file", "sub.png"]);
    }
}
