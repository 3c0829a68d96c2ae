//! A Monte Carlo figure with its standard error.
//!
//! Two filters that saw the same noise can be distinguished by differences much smaller than the uncertainty of either figure.
//!
//! Runs are independent of each other, steps within a run are not: every standard error here comes from one number a run.

use crate::number::Real;
use serde::Serialize;

/// A figure and its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The figure.
    pub value: f64,
    /// Its standard error: the standard deviation that the figure would have over repetitions of all runs.
    pub standard_error: f64,
}

impl Estimate {
    /// How many standard errors the figure is away from a value; infinite or not a number when the standard error is zero.
    ///
    /// Example: 69 ± 0.5 and 70.
    ///
    /// ```
    /// use immaculate::statistics::Estimate;
    ///
    /// let estimate = Estimate { value: 69.0, standard_error: 0.5 };
    /// assert_eq!(estimate.distance_from(70.0), -2.0); // 1 m below, two standard errors
    /// ```
    pub fn distance_from(&self, value: f64) -> f64 {
        (self.value - value) / self.standard_error
    }
}

/// The mean of one number a run.
///
/// ```text
/// x̄ = (1/M) Σ xₘ,   SE² = Σ (xₘ − x̄)² / (M (M − 1))
/// ```
///
/// Source: the variance of a mean of M independent values is an M-th of theirs, which Σ (xₘ − x̄)² / (M − 1) estimates without bias.
///
/// Example: √((1 + 1)/(2 · 1)).
///
/// ```
/// use immaculate::statistics::estimate::mean;
///
/// let mean = mean(&[1.0, 3.0]);
/// assert_eq!((mean.value, mean.standard_error), (2.0, 1.0));
/// ```
pub fn mean(values: &[f64]) -> Estimate {
    let count = values.len() as f64;
    let value = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|x| (x - value) * (x - value)).sum();
    Estimate {
        value,
        standard_error: (squares / (count * (count - 1.0))).sqrt(),
    }
}

/// The root of the mean of one square a run: with the mean square over a run's steps the overall error of a filter, with the squared error
/// at one step RMSE(k).
///
/// ```text
/// A = √s̄,   SE(A) = SE(s̄) / (2A)
/// ```
///
/// Source: the delta method, dA/ds̄ = 1/(2A). Where every square is zero, A has no derivative and no spread either: SE(A) = 0.
///
/// Example: the mean of 1 and 7 is 4 ± 3, so its root is 2 ± 3/(2 · 2).
///
/// ```
/// use immaculate::statistics::estimate::root_mean_square;
///
/// let error = root_mean_square(&[1.0, 7.0]);
/// assert_eq!((error.value, error.standard_error), (2.0, 0.75));
/// ```
///
/// Evidence: `the_delta_method_gives_the_spread_of_repeated_experiments`,
/// `the_band_of_an_error_over_time_is_the_spread_of_repeated_experiments` (statistical),
/// `a_band_has_no_width_where_all_runs_agree` (exact).
pub fn root_mean_square(mean_squares: &[f64]) -> Estimate {
    let mean = mean(mean_squares);
    let value = mean.value.sqrt();
    Estimate {
        value,
        standard_error: if value == 0.0 {
            0.0
        } else {
            mean.standard_error / (2.0 * value)
        },
    }
}

/// The difference of two overall errors from the same runs, A − B.
///
/// ```text
/// SE(A − B) = SE of the mean of  aₘ/(2A) − bₘ/(2B)
/// ```
///
/// Source: the delta method, as in [`root_mean_square`].
///
/// Why: both filters saw the same truth and the same noise, so their errors are correlated and most of the chance cancels run by run.
///
/// Example: the second filter is always a little worse: the difference is certain, the figures are not.
///
/// ```
/// use immaculate::statistics::estimate::{paired_difference, root_mean_square};
///
/// let (good, bad) = ([4.0, 9.0, 2.0], [4.1, 9.1, 2.1]);
/// assert!(root_mean_square(&good).standard_error > 0.4);
/// assert!(paired_difference(&good, &bad).standard_error < 0.01);
/// ```
///
/// Evidence: `pairing_removes_the_noise_that_two_filters_share` (statistical).
pub fn paired_difference(a: &[f64], b: &[f64]) -> Estimate {
    let (root_a, root_b) = (root_mean_square(a).value, root_mean_square(b).value);
    let terms: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(a_m, b_m)| a_m / (2.0 * root_a) - b_m / (2.0 * root_b))
        .collect();
    Estimate {
        value: root_a - root_b,
        standard_error: mean(&terms).standard_error,
    }
}

/// The mean logarithm of the ratio of two filters' overall errors in several groups of components, from the same runs.
///
/// ```text
/// λ = (1/G) Σ_g ln(A_g/B_g),   SE(λ) = SE of the mean of  (1/G) Σ_g [ a_gm/(2A_g²) − b_gm/(2B_g²) ]
/// ```
///
/// Source: the delta method, d ln A/ds̄ = 1/(2A²), as in [`root_mean_square`].
///
/// Why: metres and metres a second have no sum, but ratios of errors have no unit. exp λ is the geometric mean of the ratios: it
/// says how much better filter B is in all groups together. −λ is the answer to the question asked the other way round.
///
/// Example: twice the error in one group and the same in the other: √2 − 1 or 41 % more.
///
/// ```
/// use immaculate::statistics::estimate::paired_log_ratio;
///
/// let (a, b) = ([vec![4.0, 16.0], vec![1.0, 2.0]], [vec![1.0, 4.0], vec![1.0, 2.0]]);
/// let ratio = paired_log_ratio(&a, &b);
/// assert!((ratio.value - 0.5 * 2_f64.ln()).abs() < 1e-15);
/// assert!(ratio.standard_error < 1e-15); // in every run the same
/// ```
pub fn paired_log_ratio(a: &[Vec<f64>], b: &[Vec<f64>]) -> Estimate {
    let groups = a.len() as f64;
    let mut value = 0.0;
    let mut terms = vec![0.0; a.first().map_or(0, Vec::len)];
    for (a, b) in a.iter().zip(b) {
        let (square_a, square_b) = (mean(a).value, mean(b).value);
        value += Real::ln(&(square_a / square_b)) / (2.0 * groups);
        for (term, (a_m, b_m)) in terms.iter_mut().zip(a.iter().zip(b)) {
            *term += (a_m / square_a - b_m / square_b) / (2.0 * groups);
        }
    }
    Estimate {
        value,
        standard_error: mean(&terms).standard_error,
    }
}

/// A ratio, and how much it scatters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MedianRatio {
    /// The median.
    pub median: f64,
    /// Half the distance of the quartiles.
    pub scatter: f64,
}

impl std::fmt::Display for MedianRatio {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{:.2} ± {:.2}", self.median, self.scatter)
    }
}

/// The ratio of two times, measured in pairs: the median of aₘ/bₘ, and half the distance of its quartiles.
///
/// Source: order statistics.
///
/// Why: other work on the machine makes some runs much slower. That moves a mean but not a median, and it slows both runs of a pair alike.
///
/// Example: a takes twice the time; the last run of both was disturbed.
///
/// ```
/// use immaculate::statistics::estimate::median_ratio;
///
/// let ratio = median_ratio(&[2.0, 2.0, 2.0, 2.0, 90.0], &[1.0, 1.0, 1.0, 1.0, 9.0]).unwrap();
/// assert_eq!((ratio.median, ratio.scatter), (2.0, 0.0));
/// assert_eq!(median_ratio(&[], &[]), None);
/// ```
pub fn median_ratio(a: &[f64], b: &[f64]) -> Option<MedianRatio> {
    let mut ratios: Vec<f64> = a.iter().zip(b).map(|(a_m, b_m)| a_m / b_m).collect();
    let (lower, upper) = (quantile(&mut ratios, 0.25)?, quantile(&mut ratios, 0.75)?);
    Some(MedianRatio {
        median: quantile(&mut ratios, 0.5)?,
        scatter: (upper - lower) / 2.0,
    })
}

/// The value below which a part of the values lie, without interpolation; none where there are no values.
///
/// Source: order statistics.
///
/// Example: of five, the third is in the middle.
///
/// ```
/// use immaculate::statistics::estimate::quantile;
///
/// assert_eq!(quantile(&mut [5.0, 1.0, 4.0, 2.0, 3.0], 0.5), Some(3.0));
/// ```
pub fn quantile(values: &mut [f64], part: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the length"
    )]
    let place = (part * values.len().saturating_sub(1) as f64).round() as usize;
    values.get(place).copied()
}

/// A figure with four significant digits, or a dash where there is none.
pub fn figure(value: f64) -> String {
    // With i decimals, four digits are significant from LEAST[i] on.
    const LEAST: [f64; 8] = [1e3, 1e2, 1e1, 1.0, 1e-1, 1e-2, 1e-3, 1e-4];
    if !value.is_finite() {
        return "—".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    match LEAST.iter().position(|least| value.abs() >= *least) {
        Some(decimals) if value.abs() < 1e6 => format!("{value:.decimals$}"),
        _ => format!("{value:.2e}"),
    }
}
