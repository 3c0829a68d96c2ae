//! The claims of sustika2015 that need no simulation: exact laws, the arithmetic of table 6, and operations.
//!
//! They test the paper's arguments for its two filters: how hard a Jacobian is, why range and bearing are not linear, what sigma points
//! preserve, where IMM-CMKF linearises after all, and the cost of one cycle of either filter.

use crate::filter::cubature;
use crate::model::conversion::{Conversion, converted_covariance, converted_position, in_the_plane};
use crate::model::{PolarComponent, Sensor};
use crate::number::{Dual, Enclosure, Field, Rational, RationalFunction, Real};
use crate::paper::operations::{CoastalRadar, Sums};
use crate::paper::specification::{Specification, sustika2015 as specification};
use crate::paper::verdict::{JudgedClaim, proven_by, proven_if, refuted_by};
use crate::rule::moment::wrong_moment_of_degree;
use crate::rule::unscented::{Parameters, unscented};
use crate::rule::{ExactRule, Rule};
use crate::statistics::estimate::figure;
use nalgebra::{Const, Matrix2, Matrix6, SMatrix, SVector, U2, U6, Vector2, Vector6};
use num_traits::Zero;
use std::fmt::Write;

/// Range and bearing from the origin of a state whose first two entries are the position — sustika2015 (3).
fn range_and_bearing<T: Real>(state: &Vector6<T>) -> Vector2<T> {
    polar().of(state)
}

/// The paper's radar.
fn polar<T: Real>() -> Sensor<T, U6, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 1],
        location: [T::zero(), T::zero()],
    }
}

/// A state at a position, with no motion.
fn at<T: Real>(x: &T, y: &T) -> Vector6<T> {
    let mut state = Vector6::zeros();
    (state[0], state[1]) = (x.clone(), y.clone());
    state
}

/// The bits within which numbers that no fraction gives are enclosed, and the greatest width of what must enclose zero.
const BITS: u32 = 192;
const WIDTH: f64 = 1e-40;

/// Positions, m: the paper's first one, one beside the cut of the bearing on either side, one near and one far.
const POSITIONS: [[f64; 2]; 5] = [
    [-1000.0, 1000.0],
    [-1500.0, 0.125],
    [-1500.0, -0.125],
    [0.5, -3.0],
    [60_000.0, 80_000.0],
];

/// The Jacobian of (3) from (3) itself: column by column, on dual numbers.
fn jacobian<T: Real>(state: &Vector6<T>) -> SMatrix<T, 2, 6> {
    let columns = [0, 1, 2, 3, 4, 5].map(|column| {
        let mut changing = state.map(Dual::constant);
        changing[column] = Dual::variable(state[column].clone());
        range_and_bearing(&changing).map(|part| part.slope().clone())
    });
    SMatrix::from_columns(&columns)
}

/// The Jacobian of (3) in closed form.
///
/// ```text
/// ⎡  x/r    y/r   0 0 0 0 ⎤
/// ⎣ −y/r²   x/r²  0 0 0 0 ⎦
/// ```
fn closed_jacobian<T: Real>(x: &T, y: &T) -> SMatrix<T, 2, 6> {
    let (x, y) = (|| x.clone(), || y.clone());
    let squared = x() * x() + y() * y();
    let range = squared.sqrt();
    let mut matrix = SMatrix::zeros();
    (matrix[(0, 0)], matrix[(0, 1)]) = (x() / range.clone(), y() / range);
    (matrix[(1, 0)], matrix[(1, 1)]) = (-y() / squared.clone(), x() / squared);
    matrix
}

/// Whether a number is known to be zero but for less than 10⁻⁴⁰.
pub fn vanishes(value: &Enclosure) -> bool {
    value.contains(&Rational::zero()) && value.width() < WIDTH
}

/// "the calculating of the Jacobian matrix is always a very difficult and error-prone process".
pub fn difficult_jacobian() -> JudgedClaim {
    let agree_at = |[x, y]: &[f64; 2]| {
        let (x, y) = (Enclosure::exact(*x), Enclosure::exact(*y));
        let difference = jacobian(&at(&x, &y)) - closed_jacobian(&x, &y);
        difference.iter().all(vanishes)
    };
    let agreeing = Enclosure::with_precision(BITS, || POSITIONS.iter().filter(|position| agree_at(position)).count());
    let first = POSITIONS[0];
    let matrix = jacobian(&at(&first[0], &first[1]));
    let entries = matrix.iter().filter(|entry| **entry != 0.0).count();
    let at_the_radar = jacobian(&at(&0.0, &0.0));
    let has_none = at_the_radar.iter().any(|entry| !entry.is_decided());
    let evidence = format!(
        "The Jacobian of (3) is 2 × 6 with {entries} entries other than zero, [x, y]/r and [−y, x]/r². Dual numbers through the code of \
         (3) give it without a calculation; enclosures of {BITS} bits of its difference to the closed form hold zero and are narrower \
         than 10⁻⁴⁰ at {agreeing} of {} positions, on both sides of the cut of the bearing too. The closed form costs 8 operations, 1 \
         of them a root. {} Always difficult it is not; whether people err in it is no question of mathematics, and the paper runs no \
         extended Kalman filter.",
        POSITIONS.len(),
        if has_none {
            "At the radar itself there is none."
        } else {
            ""
        },
    );
    let comes_out = agreeing == POSITIONS.len();
    specification().judgement("sustika2015-difficult-jacobian", refuted_by(comes_out), evidence)
}

/// The two measured values of a position and of others on the line through it and the radar, X = (3, 4): at X, −X, the radar, 2X.
fn on_a_line(measurement: &Sensor<Enclosure, U6, U2>) -> [Vector2<Enclosure>; 4] {
    let state = at(&Enclosure::integer(3), &Enclosure::integer(4));
    [1, -1, 0, 2].map(|factor| measurement.of(&(&state * Enclosure::integer(factor))))
}

/// What HX would have, as far as a measurement has it: opposite first values at X and −X; with a constant too, their mean at the radar;
/// and twice the second value at 2X. None where that is not decided.
pub fn signs_of_linearity(measurement: &Sensor<Enclosure, U6, U2>) -> [Option<bool>; 3] {
    let differences = Enclosure::with_precision(BITS, || {
        let [here, opposite, nowhere, twice] = on_a_line(measurement);
        let two = || Enclosure::integer(2);
        let is_odd = &opposite[0] + &here[0];
        let is_affine = &opposite[0] + &here[0] - two() * &nowhere[0];
        let doubles = &twice[1] - two() * &here[1];
        [is_odd, is_affine, doubles]
    });
    differences.map(|difference| difference.is_decided().then(|| difference.contains(&Rational::zero())))
}

/// "Kalman filter can't be used without modification because Kalman filter only work on linear system".
pub fn kalman_needs_modification() -> JudgedClaim {
    let [here, opposite, nowhere, _] = Enclosure::with_precision(BITS, || on_a_line(&polar()));
    let signs = signs_of_linearity(&polar());
    let [_, _, bearing_doubles] = signs;
    let evidence = format!(
        "Exact: HX has opposite values at X and −X, and (3) the same range, {} m at (3, 4) and {} m at (−3, −4). Nor is there an H and a \
         constant: the mean of these two is then what is seen at the radar, {} m. {}, where HX would double. So there is no such H, and \
         the filter needs another measurement, (20)-(26), or another update, (27)-(36); nothing else of it has to change.",
        here[0].middle(),
        opposite[0].middle(),
        nowhere[0].middle(),
        if bearing_doubles == Some(false) {
            "The bearing of 2X is that of X"
        } else {
            "The bearing of 2X may be twice that of X"
        },
    );
    let verdict = proven_by(signs == [Some(false); 3]);
    specification().judgement("sustika2015-kalman-needs-modification", verdict, evidence)
}

/// Whether the points drawn from a mean and a covariance have these as their moments, for all of them: the mean and the square root of
/// the covariance, whichever, are unknown.
pub fn keeps_both_moments<const N: usize>(rule: &ExactRule) -> bool {
    let Ok(rule) = Rule::<RationalFunction, Const<N>>::from_exact(rule) else {
        return false;
    };
    let mean = SVector::<RationalFunction, N>::from_fn(|row, _| RationalFunction::unknown(&format!("m{row}")));
    let root =
        SMatrix::<RationalFunction, N, N>::from_fn(|row, column| RationalFunction::unknown(&format!("s{row}{column}")));
    let points: Vec<_> = rule
        .points
        .iter()
        .map(|point| cubature::point(&root, point, &mean))
        .collect();
    let no_noise = SMatrix::zeros();
    cubature::weighted_mean(&rule.weights, &points) == mean
        && cubature::weighted_covariance(&rule.covariance_weights, &points, &mean, &no_noise)
            == &root * root.transpose()
}

/// The greatest degree that is looked for.
const GREATEST_DEGREE: usize = 5;

/// "sigma points, which capture the desired moments (mean and covariance) of distribution of a variable exactly".
pub fn exact_moments() -> JudgedClaim {
    let mut evidence = String::from(
        "Exact, points and weights of (27)-(29) in surds. For every mean and every covariance, whose square root is unknown, the points \
         have both:",
    );
    let mut holds = true;
    for n in [4, 6] {
        let parameters = [Parameters::for_gaussian(n), Parameters::of_kappa(Rational::zero())];
        for (lambda, parameters) in ["3 − n", "0"].into_iter().zip(parameters) {
            let Ok(rule) = unscented(n, &parameters) else {
                holds = false;
                continue;
            };
            let keeps = if n == 4 {
                keeps_both_moments::<4>(&rule)
            } else {
                keeps_both_moments::<6>(&rule)
            };
            holds &= keeps;
            let first_wrong =
                (0..=GREATEST_DEGREE).find_map(|degree| wrong_moment_of_degree(&rule, degree).map(|it| (degree, it)));
            let _ = write!(evidence, " n = {n}, λ = {lambda}: {}", if keeps { "yes" } else { "no" });
            if let Some((degree, wrong)) = first_wrong {
                let _ = write!(evidence, ", and of degree {degree} {wrong}");
            }
            evidence.push(';');
        }
    }
    evidence.push_str(
        " each sentence ends with the first moment that is wrong; degree three is right, as the points are symmetric. All that before (3) is \
         applied: range and bearing of the points have other moments than those of the variable.",
    );
    specification().judgement("sustika2015-exact-moments", proven_if(holds), evidence)
}

/// The least and the greatest ratio of two printed figures, each rounded in its last digit.
fn ratio_between(above: f64, below: f64) -> Option<[Rational; 2]> {
    let [above, below] = [above, below].map(printed_between);
    let ([least, greatest], [least_below, greatest_below]) = (above?, below?);
    Some([least / greatest_below, greatest / least_below])
}

/// What rounds to a printed figure: half of its last digit more or less.
fn printed_between(figure: f64) -> Option<[Rational; 2]> {
    let text = figure.to_string();
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let half = Rational::new(1, 2) * Rational::new(1, 10).pow(u32::try_from(decimals).ok()?);
    let value = Rational::from_decimal(&text)?;
    Some([value.clone() - half.clone(), value + half])
}

/// The published times: IMM-CMKF, IMM-UKF.
fn published_times(s: &Specification) -> [f64; 2] {
    let table = s.tables.iter().find(|table| table.number == 6);
    let values = table.and_then(|table| table.rows.first()).map(|row| &row.values[..]);
    values
        .and_then(|values| values.try_into().ok())
        .unwrap_or([f64::NAN; 2])
}

/// The ratio that the paper gives in words, and what is about it: what rounds to it.
const PRINTED_RATIO: f64 = 3.7;

/// "The execution time for IMM-UKF is about 3.7 times more than IMM-CMKF."
pub fn execution_time() -> JudgedClaim {
    let s = specification();
    let [converted, unscented] = published_times(s);
    let ratio = ratio_between(unscented, converted).zip(printed_between(PRINTED_RATIO));
    let is_printed = ratio
        .as_ref()
        .is_some_and(|([least, greatest], [from, to])| from <= least && greatest <= to);
    let mut evidence = match ratio {
        Some(([least, greatest], _)) => format!(
            "Table 6: {unscented} s over {converted} s is between {} and {}, whatever was rounded.",
            figure(least.to_f64()),
            figure(greatest.to_f64()),
        ),
        None => "Table 6 has no such figures.".to_owned(),
    };
    evidence.push_str(
        " Operations of a cycle in six dimensions, IMM-CMKF, IMM-UKF as in (14), (15), (27)-(36), and IMM-UKF with points for the \
         prediction too:",
    );
    let mut is_simpler = true;
    for (sums, words) in Sums::ALL
        .into_iter()
        .zip(["every matrix full and every sum from nothing", "every matrix full"])
    {
        let totals = CoastalRadar::ALL.map(|filter| filter.operations(sums));
        is_simpler &= totals[0] < totals[1];
        let _ = write!(
            evidence,
            " {words}: {totals:?}, ratios {} and {};",
            figure(totals[1] as f64 / totals[0] as f64),
            figure(totals[2] as f64 / totals[0] as f64),
        );
    }
    let functions = CoastalRadar::ALL.map(|filter| {
        let [roots, functions] = filter.roots_and_functions();
        format!("{roots} roots with {functions} of exp, ln, sin, cos, atan2")
    });
    let _ = write!(evidence, " among them {};", functions.join(" and "));
    let _ = write!(
        evidence,
        " By operations IMM-CMKF is the simpler one under {} convention. The paper's times are of two programs that it does not print.",
        if is_simpler { "every" } else { "not every" },
    );
    s.judgement(
        "sustika2015-execution-time",
        proven_if(is_printed && is_simpler),
        evidence,
    )
}

/// J R Jᵀ with the Jacobian J of (20), (21), for every range and bearing: from the conversion itself on dual numbers, whose cosine c and
/// sine s are given with their derivatives −s and c.
fn first_order_covariance() -> Matrix2<RationalFunction> {
    let [r, c, s, range_variance, bearing_variance] = ["r", "c", "s", "v", "w"].map(RationalFunction::unknown);
    let constant = |value: &RationalFunction| Dual::constant(value.clone());
    let position = |range, cosine, sine| converted_position::<Dual<RationalFunction>>(&range, &cosine, &sine);
    let by_range = position(Dual::variable(r.clone()), constant(&c), constant(&s));
    let by_bearing = position(constant(&r), Dual::new(c.clone(), -s.clone()), Dual::new(s, c));
    let [by_range, by_bearing] = [by_range, by_bearing].map(|moved| moved.map(|part| part.slope().clone()));
    let jacobian = Matrix2::from_columns(&[by_range, by_bearing]);
    let noise = Matrix2::from_diagonal(&Vector2::new(range_variance, bearing_variance));
    &jacobian * noise * jacobian.transpose()
}

/// The covariance of a conversion with the same unknowns, and e^(−σ_θ²/2) for one more.
fn conversion_covariance(conversion: Conversion) -> Matrix2<RationalFunction> {
    let [r, c, s, range_variance, bearing_variance, attenuation] =
        ["r", "c", "s", "v", "w", "e"].map(RationalFunction::unknown);
    let squared_range = r.clone() * r;
    in_the_plane(
        &conversion.variances(&squared_range, &range_variance, &bearing_variance, &attenuation),
        &c,
        &s,
    )
}

/// "There is no linearization step on this filtering process."
pub fn no_linearisation() -> JudgedClaim {
    let [r, c, s, v, w] = ["r", "c", "s", "v", "w"].map(RationalFunction::unknown);
    let propagated = first_order_covariance();
    let is_linearised = converted_covariance(&r, &c, &s, &v, &w) == propagated;
    let others: Vec<&str> = Conversion::ALL
        .into_iter()
        .filter(|conversion| conversion_covariance(*conversion) != propagated)
        .map(Conversion::name)
        .collect();
    let range_at_the_radar = unscented_range_at_the_radar();
    let evidence = format!(
        "Symbolic, for every range, bearing, σ_r and σ_θ: J R Jᵀ with the Jacobian of (20), (21), which dual numbers give, {} the \
         covariance (24)-(26). The step of the Kalman filter is linear because the linearisation is in its noise. {} of the other \
         conversions are not J R Jᵀ: {}. (27)-(36) hold no derivative: for a target about the radar, 1 m uncertain in either direction, \
         where (3) has none, the points of λ = 3 − n see a range of {} m on average; the truth is √(π/2) = 1.253 m, and a linearisation \
         sees nothing. {}",
        if is_linearised { "is" } else { "is not" },
        others.len(),
        others.join(", "),
        figure(range_at_the_radar),
        if is_linearised {
            "So the words fit IMM-UKF, the slower one, and not IMM-CMKF, and are no reason for the times of table 6."
        } else {
            "So neither filter linearises, and that is no reason for the times of table 6."
        },
    );
    specification().judgement("sustika2015-no-linearisation", proven_if(!is_linearised), evidence)
}

/// The mean range (31) of a target about the radar with the unit covariance, by the points of λ = 3 − n in six dimensions.
fn unscented_range_at_the_radar() -> f64 {
    let Some(rule) = unscented(6, &Parameters::for_gaussian(6))
        .ok()
        .and_then(|rule| Rule::from_exact(&rule).ok())
    else {
        return f64::NAN;
    };
    let centre = Vector6::zeros();
    let point = |of: &Vector6<f64>| range_and_bearing(&cubature::point(&Matrix6::identity(), of, &centre));
    let values: Vec<_> = rule.points.iter().map(point).collect();
    polar().mean(&rule.weights, &values, &range_and_bearing(&centre))[0]
}
