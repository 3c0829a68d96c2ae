//! The known name that is nearest to one that is not known.
//!
//! An error suggests it. The specification alone, without the feature `oracle`, brings no measure of distance and suggests nothing.

/// The nearest of the known names, if one is near: so few letters are added, left out, changed or exchanged that two thirds stay.
///
/// Source: F. J. Damerau, A technique for computer detection and correction of spelling errors, 1964.
///
/// Example: one letter is missing, and nothing is like the other.
///
/// ```
/// use immaculate::model::nearest::nearest;
///
/// assert_eq!(nearest("headng", ["x", "heading"]), Some("heading".to_owned()));
/// assert_eq!(nearest("temperature", ["x", "heading"]), None);
/// ```
#[cfg(feature = "oracle")]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    // Long texts are no slips of a name, and take time.
    let length = name.chars().count();
    if length > 64 {
        return None;
    }
    let wanted = name.to_lowercase();
    let distance = |other: &str| strsim::damerau_levenshtein(&wanted, &other.to_lowercase());
    let with_distances = known.into_iter().map(|other| (distance(other), other));
    // Of equally near ones the one that is as long.
    let (distance, found) =
        with_distances.min_by_key(|(distance, other)| (*distance, other.len().abs_diff(name.len())))?;
    (distance <= (length / 3).max(1) && distance < length.max(2)).then(|| found.to_owned())
}

/// Without a measure of distance no name is near.
#[cfg(not(feature = "oracle"))]
pub fn nearest<'a>(_: &str, _: impl IntoIterator<Item = &'a str>) -> Option<String> {
    None
}
