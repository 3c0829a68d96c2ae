//! Progress on standard error, for work that takes more than a moment.
//!
//! A bar is drawn only on a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of a given length and template.
pub fn bar(length: usize, template: &str) -> ProgressBar {
    ProgressBar::new(length as u64).with_style(style(template))
}

/// How a bar looks: `{wide_bar}`, `{pos}` of `{len}`, `{elapsed}`, `{eta}`, `{msg}`.
pub fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
