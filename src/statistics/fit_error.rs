//! The percentage fit error: the size of a path's error relative to the path itself.
//!
//! sustika2015 measures its filters by it, and leaves several readings of its formula open. The measure does not depend on the filter
//! alone: the norm of the true positions is the norm of their distances from the radar, so the same errors count for more near the radar.

/// Percentage fit error of a coordinate — sustika2015 (37)-(38).
///
/// ```text
/// PFE_x = 100 ‖x̂ − x‖ / ‖x‖,   ‖x‖² = Σₖ xₖ²
/// ```
///
/// | paper | here     | shape | meaning                                            |
/// |-------|----------|-------|----------------------------------------------------|
/// | x̂ − x | `errors` | steps | estimate less truth, m                             |
/// | x     | `truth`  | steps | the true coordinate, seen from the radar, m        |
///
/// Why: the ratio of two root mean squares over the same steps, and so without a unit. It is zero for perfect tracking and 100 for the
/// estimate 0. It is no property of errors alone: a radar that stands elsewhere divides the same errors by other numbers.
///
/// Example: ‖(3, −4)‖ = 5 beside ‖(30, 40)‖ = 50.
///
/// ```
/// use immaculate::statistics::fit_error::percentage_fit_error;
///
/// assert_eq!(percentage_fit_error(&[3.0, -4.0], &[30.0, 40.0]), 10.0);
/// ```
///
/// Errata: the formula is lost in the text; Raol (Multi-sensor data fusion with MATLAB, 2010, chapter 4) has this ratio of norms.
///
/// Evidence: `the_fit_error_is_zero_for_perfect_tracking_and_a_hundred_for_none`,
/// `the_fit_error_has_no_unit_and_depends_on_where_the_radar_stands` (property).
pub fn percentage_fit_error(errors: &[f64], truth: &[f64]) -> f64 {
    100.0 * norm(errors) / norm(truth)
}

/// How the fit errors of two coordinates become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FitForm {
    /// √(PFE_x² + PFE_y²).
    RootSumSquare,
    /// 100 ‖p̂ − p‖ / ‖p‖ of the positions p = (x, y): Raol's.
    JointNorm,
    /// √((PFE_x² + PFE_y²)/2).
    RootMeanSquare,
    /// (PFE_x + PFE_y)/2.
    Mean,
    /// PFE_x + PFE_y.
    Sum,
}

impl FitForm {
    /// All forms.
    pub const ALL: [Self; 5] = [
        Self::RootSumSquare,
        Self::JointNorm,
        Self::RootMeanSquare,
        Self::Mean,
        Self::Sum,
    ];
}

/// Percentage fit error of a position — sustika2015 (39).
///
/// ```text
/// PFE = √( PFE_x² + PFE_y² )
/// ```
///
/// | paper | here         | shape     | meaning                                                |
/// |-------|--------------|-----------|--------------------------------------------------------|
/// | x̂ − x | `errors[0]`  | steps     | estimate less truth, m; of y the second                 |
/// | x     | `truth[0]`   | steps     | the true coordinate, seen from the radar, m; of y the second |
///
/// Why: one number for both coordinates, of which a filter has to be good in both. The joint norm alone is a ratio of an error to a
/// distance; it lies between the two coordinates' own.
///
/// Example: one step: x is off by 3 of 10, y by 4 of 10, so 30 % and 40 %.
///
/// ```
/// use immaculate::statistics::fit_error::{FitForm, position_fit_error};
///
/// let of = |form| position_fit_error(form, [&[3.0], &[4.0]], [&[10.0], &[10.0]]);
/// assert_eq!(of(FitForm::RootSumSquare), 50.0);
/// assert_eq!(of(FitForm::Mean), 35.0);
/// assert_eq!(of(FitForm::Sum), 70.0);
/// // ‖(3, 4)‖/‖(10, 10)‖ = 5/√200, between the two; a few units of the last place.
/// assert!((of(FitForm::JointNorm) - 1250.0_f64.sqrt()).abs() < 1e-13);
/// ```
///
/// Errata: which combination is meant cannot be read any more; [`FitForm`] has the candidates.
///
/// Evidence: `the_forms_of_the_fit_error_are_ordered` (property).
pub fn position_fit_error(form: FitForm, errors: [&[f64]; 2], truth: [&[f64]; 2]) -> f64 {
    let of = |axis: usize| percentage_fit_error(errors[axis], truth[axis]);
    match form {
        FitForm::RootSumSquare => norm(&[of(0), of(1)]),
        // Both coordinates in one list.
        FitForm::JointNorm => percentage_fit_error(&errors.concat(), &truth.concat()),
        FitForm::RootMeanSquare => norm(&[of(0), of(1)]) / 2.0_f64.sqrt(),
        FitForm::Mean => f64::midpoint(of(0), of(1)),
        FitForm::Sum => of(0) + of(1),
    }
}

/// ‖x‖ = √(Σₖ xₖ²).
fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
