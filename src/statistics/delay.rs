//! The delay until a filter notices a change of motion: a measure of how it "captures the change in time".

/// Steps from a change of motion until the probability of the true mode exceeds one half.
///
/// `true_modes[k]` and `probabilities[k]` are those of step k + 1. A change at which the motion of the step differs from the one before
/// has a delay of 0 when the probability is above one half at that very step, and none when the next change or the end comes first.
///
/// Source: both papers speak of quick switching, zhu2016 in its section 4 and liu2017 in its section 4.2, and neither says how it is
/// measured. One half is where the true mode becomes more likely than all others together.
///
/// Example: mode 1 holds from the third step on and is believed from the fourth.
///
/// ```
/// use immaculate::statistics::delay::detection_delays;
///
/// let modes = [0, 0, 1, 1, 1];
/// let probabilities = [[0.9, 0.1], [0.9, 0.1], [0.8, 0.2], [0.4, 0.6], [0.1, 0.9]];
/// let probabilities: Vec<Vec<f64>> = probabilities.iter().map(|p| p.to_vec()).collect();
/// assert_eq!(detection_delays(&modes, &probabilities), vec![Some(1)]);
/// ```
///
/// Evidence: `a_change_is_detected_when_its_mode_is_more_likely_than_not` (exact).
pub fn detection_delays(true_modes: &[usize], probabilities: &[Vec<f64>]) -> Vec<Option<usize>> {
    let changes: Vec<usize> = (1..true_modes.len())
        .filter(|&k| true_modes[k] != true_modes[k - 1])
        .collect();
    changes
        .iter()
        .enumerate()
        .map(|(change, &start)| {
            let end = changes.get(change + 1).copied().unwrap_or(true_modes.len());
            (start..end).position(|k| probabilities[k].get(true_modes[k]).is_some_and(|p| *p > 0.5))
        })
        .collect()
}
