//! Root mean square errors: the two averages behind every error table, over the runs at one step and over the steps.

/// Root-mean-square error over the runs at one step — zhu2016 (64), liu2017 (33).
///
/// ```text
/// RMSE(k) = √( (1/M) Σₘ |x̂ₘ(k) − x(k)|² )
/// ```
///
/// | paper   | here             | shape | meaning                                                                |
/// |---------|------------------|-------|------------------------------------------------------------------------|
/// | M       | the list's length |      | number of runs                                                          |
/// | x̂ − x   | `squared_errors` | M     | squared error of each run at step k: of one component, or of several summed |
///
/// Why: the sample's estimate of √E|x̂ − x|².
///
/// Example: three runs, errors 3, 5 and √8: (9 + 25 + 8)/3 = 14.
///
/// ```
/// use immaculate::statistics::rmse::root_mean_square;
///
/// assert_eq!(root_mean_square(&[9.0, 25.0, 8.0]), 14.0_f64.sqrt());
/// ```
///
/// Errata: zhu2016 (64) uses n and k both as summation indices and as their limits and averages over the time so far inside the
/// average over runs, which is a running average and not an error at step k.
///
/// Evidence: `printed_rmse_is_not_the_root_mean_square_over_runs` (exact).
pub fn root_mean_square(squared_errors: &[f64]) -> f64 {
    (squared_errors.iter().sum::<f64>() / squared_errors.len() as f64).sqrt()
}

/// Accumulated root-mean-square error — liu2017 (34).
///
/// ```text
/// ARMSE = √( (1/N) Σₖ RMSE²(k) )
/// ```
///
/// | paper   | here    | shape | meaning                     |
/// |---------|---------|-------|-----------------------------|
/// | RMSE(k) | `rmses` | N     | [`root_mean_square`] at k   |
///
/// Why: the root of the mean square over runs and steps alike; a long run of small errors does not hide a short one of large ones, as
/// the plain mean of RMSE(k) would.
///
/// Example: (9 + 16)/4 = 25/4; the plain mean is 7/4.
///
/// ```
/// use immaculate::statistics::rmse::accumulated;
///
/// assert_eq!(accumulated(&[3.0, 4.0, 0.0, 0.0]), 2.5);
/// ```
///
/// Evidence: `the_accumulated_error_is_the_root_mean_square_over_runs_and_steps` (property).
pub fn accumulated(rmses: &[f64]) -> f64 {
    (rmses.iter().map(|rmse| rmse * rmse).sum::<f64>() / rmses.len() as f64).sqrt()
}

/// zhu2016 (64) as printed, read as it stands: at step k the mean over runs of the mean square over the time so far, under one root.
///
/// `squared_errors[m][t]` is the squared error of run m at step t + 1.
///
/// Example: two runs with squared errors of 8 at step 1 and 0 at step 2: at step 2 there is no error, and the printed form still has 8/2.
///
/// ```
/// use immaculate::statistics::rmse::{as_printed_in_zhu2016, root_mean_square};
///
/// let runs = [vec![8.0, 0.0], vec![8.0, 0.0]];
/// assert_eq!(root_mean_square(&[runs[0][1], runs[1][1]]), 0.0);
/// assert_eq!(as_printed_in_zhu2016(&runs, 2), 2.0);
/// ```
pub fn as_printed_in_zhu2016(squared_errors: &[Vec<f64>], step: usize) -> f64 {
    let running_mean = |run: &Vec<f64>| run[..step].iter().sum::<f64>() / step as f64;
    let sum: f64 = squared_errors.iter().map(running_mean).sum();
    (sum / squared_errors.len() as f64).sqrt()
}
