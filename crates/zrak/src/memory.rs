//! Whether a film fits the memory, asked before it is taken: running out of it ends a process
//! without a word.

use zrak_core::film::PixelSum;

use crate::{Error, ErrorKind};

/// Bytes that a render takes on the host for each pixel: two films (the finished passes and the
/// one under way) and the picture with its encoding.
const BYTES_PER_PIXEL: u64 = 2 * size_of::<PixelSum>() as u64 + 2 * 12;

/// Fails if a picture of this size cannot be rendered in the memory that is free.
pub(crate) fn check(width: u32, height: u32) -> Result<(), Error> {
    check_within(width, height, available_bytes())
}

fn check_within(width: u32, height: u32, available: Option<u64>) -> Result<(), Error> {
    let needed = u64::from(width) * u64::from(height) * BYTES_PER_PIXEL;
    match available {
        Some(available) if needed > available => {
            let gb = |bytes: u64| bytes as f64 / 1e9;
            let message = format!(
                "a picture of {width}x{height} pixels takes {:.1} GB of memory to render and {:.1} \
                 GB are free; render a smaller one",
                gb(needed),
                gb(available)
            );
            Err(Error::new(ErrorKind::OutOfMemory, message))
        }
        _ => Ok(()),
    }
}

/// Memory that can be taken without swapping, where the system says so.
fn available_bytes() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_large_a_film_is_refused() {
        assert!(check_within(1000, 1000, Some(1 << 30)).is_ok());
        assert!(check_within(u32::MAX, 65536, None).is_ok());
        let error = check_within(16384, 16384, Some(1 << 30)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::OutOfMemory);
        assert!(error.to_string().contains("40.8 GB of memory"), "{error}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn linux_says_how_much_is_free() {
        assert!(available_bytes().unwrap() > 0);
    }
}
