//! The tokens of a formula: words, numbers and signs, each with its place.
//!
//! Any other character is refused.

use super::error::Fault;
use super::name::{is_name_part, printable};
use std::fmt;

/// A piece of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Token<'a> {
    /// Digits with perhaps a point and a power of ten.
    Number(&'a str),
    /// Letters, digits and underscores.
    Word(&'a str),
    /// One of `+ - * / ^ ( ) ,`.
    Sign(char),
    /// After the last character.
    End,
}

impl fmt::Display for Token<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(text) | Self::Word(text) => write!(formatter, "`{text}`"),
            Self::Sign(sign) => write!(formatter, "`{sign}`"),
            Self::End => write!(formatter, "the end"),
        }
    }
}

/// The signs that stand for themselves, and those that stand for another.
const SIGNS: [(char, char); 15] = [
    ('+', '+'),
    ('-', '-'),
    ('*', '*'),
    ('/', '/'),
    ('^', '^'),
    ('(', '('),
    (')', ')'),
    (',', ','),
    ('\u{2212}', '-'),
    ('\u{b7}', '*'),
    ('\u{d7}', '*'),
    ('\u{22c5}', '*'),
    ('\u{f7}', '/'),
    ('\u{2215}', '/'),
    ('\u{2013}', '-'),
];

/// What to write instead of a character.
const ADVICE: [(&str, &str); 7] = [
    ("[]{}", "; components are named, and parentheses are round"),
    ("=", "; a formula is what stands after the `=`"),
    ("<>?:&|!~", "; formulas have no branches"),
    ("\u{3c0}", "; write `pi`"),
    ("\u{221a}", "; write `sqrt(…)`"),
    ("\u{b2}\u{b3}\u{b9}\u{2070}", "; write a power as `^2`"),
    (";\n\r", "; one formula stands alone"),
];

/// The next piece of a text: the piece, and where it starts and ends in bytes.
pub(super) fn next(text: &str, from: usize) -> Result<(Token<'_>, usize, usize), (usize, Fault)> {
    let rest = &text[from..];
    let start = from + rest.len() - rest.trim_start_matches([' ', '\t', '\n', '\r']).len();
    let rest = &text[start..];
    let Some(first) = rest.chars().next() else {
        return Ok((Token::End, start, start));
    };
    if rest.starts_with("**") {
        return Ok((Token::Sign('^'), start, start + 2));
    }
    if let Some((_, sign)) = SIGNS.iter().find(|(written, _)| *written == first) {
        return Ok((Token::Sign(*sign), start, start + first.len_utf8()));
    }
    if first.is_ascii_digit() || first == '.' {
        let end = start + number_length(rest);
        return Ok((Token::Number(&text[start..end]), start, end));
    }
    if is_name_part(first) {
        let length = rest.find(|c| !is_name_part(c)).unwrap_or(rest.len());
        return Ok((Token::Word(&rest[..length]), start, start + length));
    }
    let advice = ADVICE.iter().find(|(characters, _)| characters.contains(first));
    let advice = match advice {
        Some((_, advice)) => advice,
        None if first.is_alphabetic() => "; names have Latin letters without accents",
        None => "",
    };
    let found = printable(&first.to_string());
    Err((start, Fault::Character { found, advice }))
}

/// The length of the number at the start of a text: digits, a point among them, and a power of ten if digits follow its `e`.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut length = digits(0);
    if text[length..].starts_with('.') {
        length += 1;
        length += digits(length);
    }
    if text[length..].starts_with(['e', 'E']) {
        let sign = usize::from(text[length + 1..].starts_with(['+', '-']));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}
