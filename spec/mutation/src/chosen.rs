//! Which mutant is alive in this process. This file is copied into the instrumented crate.

use std::collections::HashSet;
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

const NONE: u32 = 0xFFFF_0000;
const UNKNOWN: u32 = 0xFFFF_0001;
const TRACED: u32 = 0xFFFF_0002;

static CHOSEN: AtomicU32 = AtomicU32::new(UNKNOWN);
static REACHED: Mutex<Option<HashSet<u32>>> = Mutex::new(None);

/// Which of the `count` mutants of a place is alive, from 1; 0 when none is.
#[inline]
pub fn site(first: u32, count: u32) -> u32 {
    let mut chosen = CHOSEN.load(Ordering::Relaxed);
    if chosen > NONE {
        chosen = look(first);
    }
    let number = chosen.wrapping_sub(first);
    if number < count { number + 1 } else { 0 }
}

/// Whether the only mutant of a place is alive.
#[inline]
pub fn is(id: u32) -> bool {
    site(id, 1) == 1
}

/// Reads from the environment which mutant is alive, or writes down that a place was reached.
#[cold]
#[inline(never)]
fn look(first: u32) -> u32 {
    if CHOSEN.load(Ordering::Relaxed) == UNKNOWN {
        let chosen = match std::env::var("MUTANT") {
            Ok(id) => id.parse().unwrap_or(NONE),
            Err(_) if std::env::var_os("MUTANT_TRACE").is_some() => TRACED,
            Err(_) => NONE,
        };
        CHOSEN.store(chosen, Ordering::Relaxed);
        if chosen != TRACED {
            return chosen;
        }
    }
    let Ok(mut reached) = REACHED.lock() else {
        return NONE;
    };
    if reached.get_or_insert_with(HashSet::new).insert(first)
        && let Some(path) = std::env::var_os("MUTANT_TRACE")
        && let Ok(mut file) = std::fs::OpenOptions::new().append(true).create(true).open(path)
    {
        let _ = file.write_all(&first.to_le_bytes());
    }
    NONE
}
