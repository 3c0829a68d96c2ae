//! Files: bounded reading, atomic writing, digests, and short quotations.
//!
//! Reading has a maximum length, so that no file and no endless pipe exhausts the memory. A file is written next to its destination first
//! and moved into place in one step once all of it is on the disk. A reader therefore sees the old file or the new one, even after an
//! interruption.

use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufRead, ErrorKind, Read, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

/// No file that is read may be longer, in bytes: 32 MiB. What JSON becomes in memory is up to 32 times as large.
pub const LONGEST_FILE: u64 = 1 << 25;

/// No line of the protocol may be longer, in bytes: 16 MiB, a hundred times the longest answer to a published case.
pub const LONGEST_LINE: u64 = 1 << 24;

/// The text of a file, if it is not longer than [`LONGEST_FILE`].
///
/// # Errors
///
/// As [`read_from`]; and when there is no such file, or it cannot be read.
pub fn read(path: &Path) -> io::Result<String> {
    read_from(File::open(path)?)
}

/// The text that a reader gives, if it is not longer than [`LONGEST_FILE`]; without the mark of byte order that it may start with.
///
/// # Errors
///
/// When it is longer or not UTF-8, or the reader fails.
pub fn read_from(reader: impl Read) -> io::Result<String> {
    let mut text = String::new();
    reader.take(LONGEST_FILE + 1).read_to_string(&mut text)?;
    if text.len() as u64 > LONGEST_FILE {
        return Err(too_long("is longer", LONGEST_FILE));
    }
    // Some editors mark their text as UTF-8.
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}

/// The next line with its end, if it is not longer than [`LONGEST_LINE`]; none after the last.
///
/// # Errors
///
/// When it is longer, or the reader fails.
pub fn read_line(reader: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let mut line = Vec::new();
    let length = reader.take(LONGEST_LINE + 1).read_until(b'\n', &mut line)?;
    if length as u64 > LONGEST_LINE {
        return Err(too_long("a line longer", LONGEST_LINE));
    }
    Ok((length > 0).then_some(line))
}

fn too_long(what: &str, bytes: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("{what} than {bytes} bytes"))
}

/// Writes a file whole or not at all: what was there stays until all is on the disk.
///
/// - The temporary file is `.immaculate-PROCESS-NUMBER.part` in the same directory. It is removed when it cannot be written; a process
///   that is killed leaves it, and it may be deleted.
/// - Behind a symbolic link the file that it leads to is replaced, and the link stays; a link that leads nowhere is replaced itself.
/// - Permissions of an old file are kept, a new one has the usual ones. A file that is read-only is not replaced. Hard links to an old
///   file keep the old content.
/// - What is no file, a device or a pipe, has no content to be kept, and is written to as it is.
///
/// # Errors
///
/// When the file cannot be written; then the old one is as it was.
pub fn write(path: &Path, content: &str) -> io::Result<()> {
    let path = &path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let old = fs::metadata(path).ok();
    match &old {
        Some(old) if old.is_dir() => return Err(ErrorKind::IsADirectory.into()),
        Some(old) if !old.is_file() => {
            return File::options().write(true).open(path)?.write_all(content.as_bytes());
        }
        Some(old) if old.permissions().readonly() => {
            return Err(io::Error::new(ErrorKind::PermissionDenied, "is read-only"));
        }
        _ => {}
    }
    let part = &path.with_file_name(temporary_name());
    let permissions = old.as_ref().map(fs::Metadata::permissions);
    write_new(part, content, permissions)
        .and_then(|()| fs::rename(part, path))
        .inspect_err(|_| {
            // What was written of it is of no use; where nothing was written there is nothing to remove.
            let _ = fs::remove_file(part);
        })
}

/// A name that no other file has while this process writes: of this process, and each time another.
fn temporary_name() -> String {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    format!(".immaculate-{}-{number}.part", std::process::id())
}

/// Writes a file down to the disk.
fn write_new(path: &Path, content: &str, permissions: Option<fs::Permissions>) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(content.as_bytes())?;
    if let Some(permissions) = permissions {
        file.set_permissions(permissions)?;
    }
    file.sync_all()
}

/// The SHA-256 digest of a text, in hexadecimal digits.
///
/// Example: the digest of nothing, as FIPS 180 has it.
///
/// ```
/// use immaculate::file::digest;
///
/// assert!(digest("").starts_with("e3b0c442"));
/// ```
pub fn digest(text: &str) -> String {
    let mut digits = String::new();
    for byte in Sha256::digest(text.as_bytes()) {
        // Writing to a string cannot fail.
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}

/// A text of bounded length: a longer one keeps its beginning and its end, with an ellipsis between them.
pub fn shortened(text: &str, kept: usize) -> String {
    if text.chars().nth(kept).is_none() {
        return text.to_owned();
    }
    let start = text.char_indices().nth(kept / 2).map_or(0, |(place, _)| place);
    let end = text.char_indices().rev().nth(kept / 2).map_or(0, |(place, _)| place);
    format!("{}…{}", &text[..start], &text[end..])
}
