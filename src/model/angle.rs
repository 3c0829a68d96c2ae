//! Angles: one policy, stated once.
//!
//! Every equation treats angles like this:
//!
//! - a bearing is atan2(y, x) in (−π, π], counter-clockwise from the x-axis;
//! - a difference of angles is wrapped to (−π, π] ([`wrap`]);
//! - bearings of cubature points are averaged as differences from the bearing of the centre point, since the mean of −179° and
//!   179° is 180° and not 0°.

use crate::number::Real;

/// The angle's equivalent in (−π, π].
///
/// Source: the bearing of liu2017 (31) is an angle: values that differ by a full turn are the same.
///
/// Angles here are differences of bearings, at most a few turns from zero; one turn is added or taken away at a time. An angle
/// whose order against ±π cannot be decided is undecided, and so is one of more than a thousand turns, which no difference of
/// bearings is.
///
/// Example: seven eighths of a turn to the left are one eighth to the right. Half a turn is +π, never −π.
///
/// ```
/// use immaculate::model::angle::wrap;
/// use std::f64::consts::PI;
///
/// assert_eq!(wrap(0.5), 0.5);
/// assert_eq!(wrap(1.75 * PI), -0.25 * PI);
/// assert_eq!(wrap(-PI), PI);
/// ```
///
/// Evidence: `a_wrapped_angle_is_in_the_half_open_turn_and_differs_by_whole_turns` (property).
pub fn wrap<T: Real>(angle: T) -> T {
    let pi = T::pi();
    let turn = pi.clone() + pi.clone();
    let mut wrapped = angle;
    for _ in 0..1000 {
        let above = wrapped.partial_cmp(&pi);
        let below = wrapped.partial_cmp(&-pi.clone());
        let (Some(above), Some(below)) = (above, below) else {
            return T::undecided();
        };
        if above.is_gt() {
            wrapped -= turn.clone();
        } else if below.is_le() {
            wrapped += turn.clone();
        } else {
            return wrapped;
        }
    }
    T::undecided()
}
