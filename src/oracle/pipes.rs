//! What a process writes: its output line by line, and its last words.
//!
//! Each of these reads to the end of a pipe in a thread of its own.

use crate::file::read_line;
use std::io::{BufReader, ErrorKind, Read};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex};

/// So much of what a program writes to standard error is kept for a report.
const STDERR_KEPT: usize = 1000;

/// What the reading thread found.
pub(super) enum Line {
    Text(String),
    TooLong,
    NotText,
}

/// Counts the bytes that arrive.
struct Counting<R> {
    pipe: R,
    count: Arc<AtomicUsize>,
}

impl<R: Read> Read for Counting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.pipe.read(buffer)?;
        self.count.fetch_add(count, Ordering::Relaxed);
        Ok(count)
    }
}

/// Sends each line; `unfinished` counts the bytes that are in none yet.
pub(super) fn read_lines(pipe: impl Read, lines: &SyncSender<Line>, unfinished: &Arc<AtomicUsize>) {
    let count = Arc::clone(unfinished);
    let mut reader = BufReader::new(Counting { pipe, count });
    loop {
        let line = match read_line(&mut reader) {
            Ok(Some(bytes)) => {
                unfinished.fetch_sub(bytes.len(), Ordering::Relaxed);
                String::from_utf8(bytes).map_or_else(|error| not_text(error.as_bytes()), Line::Text)
            }
            Err(error) if error.kind() == ErrorKind::FileTooLarge => Line::TooLong,
            Ok(None) | Err(_) => return,
        };
        if lines.send(line).is_err() {
            return;
        }
    }
}

/// A line that is not UTF-8: a message that cannot be read, or a line that is passed over in any encoding.
fn not_text(bytes: &[u8]) -> Line {
    if bytes.trim_ascii_start().starts_with(b"{") {
        Line::NotText
    } else {
        Line::Text(String::from_utf8_lossy(bytes).into_owned())
    }
}

/// Keeps the last part of what a program writes to standard error.
pub(super) fn keep_last(mut pipe: impl Read, kept: &Mutex<String>) {
    let mut buffer = [0; 4096];
    while let Ok(count @ 1..) = pipe.read(&mut buffer) {
        let Ok(mut kept) = kept.lock() else { return };
        kept.push_str(&String::from_utf8_lossy(&buffer[..count]));
        if kept.len() > STDERR_KEPT {
            let mut start = kept.len() - STDERR_KEPT;
            while !kept.is_char_boundary(start) {
                start += 1;
            }
            kept.drain(..start);
        }
    }
}
