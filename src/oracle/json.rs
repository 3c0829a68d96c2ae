//! JSON as other programs write it: words for what is not finite, and sentences about what is no JSON that show the place.

use serde_json::Value;

/// A text that is no JSON.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct NotJson {
    /// Why, with line and column, and what may be the cause.
    pub reason: String,
    /// The text around the place.
    pub around: String,
}

/// So much of a text is shown on either side of a place.
const AROUND: usize = 60;

/// Reads JSON in which NaN, Infinity and −Infinity may stand for numbers, as several writers have it.
///
/// # Errors
///
/// The reason, with line and column.
pub fn read_json(text: &str) -> Result<Value, NotJson> {
    let quoted = quote_not_finite(text.trim_end());
    serde_json::from_str(&quoted).map_err(|error| {
        let line = quoted.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
        // The column counts bytes, up to and with the one that cannot be read.
        let (before, after) = line.as_bytes().split_at(error.column().min(line.len()));
        let comma = if ends_with_decimal_comma(before) {
            "; is a number written with a decimal comma?"
        } else {
            ""
        };
        NotJson {
            reason: format!("{error}{comma}"),
            around: around(before, after),
        }
    })
}

/// Whether a text ends with a digit, a comma and digits.
fn ends_with_decimal_comma(text: &[u8]) -> bool {
    let number = text.trim_ascii_end();
    let digits = number.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    let rest = &number[..number.len() - digits];
    digits > 0 && matches!(rest, [.., digit, b','] if digit.is_ascii_digit())
}

/// The end of what stands before a place and the beginning of what stands behind it.
fn around(before: &[u8], after: &[u8]) -> String {
    let [before, after] = [before, after].map(String::from_utf8_lossy);
    let (letters, rest) = (before.chars().count(), after.chars().count());
    let [start, end] = [letters > AROUND, rest > AROUND].map(|is_cut| if is_cut { "…" } else { "" });
    let before: String = before.chars().skip(letters.saturating_sub(AROUND)).collect();
    let after: String = after.chars().take(AROUND).collect();
    format!("{start}{before}{after}{end}")
}

/// Whether a word is one that programs write for what is not finite.
pub(super) fn is_not_finite(word: &str) -> bool {
    let word = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
    ["nan", "inf", "infinity"].contains(&word.as_str())
}

/// Puts the words for what is not finite into quotes where they stand outside of strings.
pub(super) fn quote_not_finite(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len());
    let mut rest = text;
    let mut in_string = false;
    while let Some(character) = rest.chars().next() {
        if in_string && character == '\\' {
            let end = rest.char_indices().nth(2).map_or(rest.len(), |(end, _)| end);
            quoted.push_str(&rest[..end]);
            rest = &rest[end..];
            continue;
        }
        in_string ^= character == '"';
        let word_end = rest
            .find(|c: char| !c.is_ascii_alphabetic() && c != '-' && c != '+')
            .unwrap_or(rest.len());
        if word_end > 0 {
            // A word as a whole: a long one letter by letter would take for ever.
            let word = &rest[..word_end];
            let quote = if !in_string && is_not_finite(word) { "\"" } else { "" };
            quoted.extend([quote, word, quote]);
            rest = &rest[word_end..];
            continue;
        }
        quoted.push(character);
        rest = &rest[character.len_utf8()..];
    }
    quoted
}
