//! Covariances that are not symmetric: rounding that grows from step to step, and matrices of which one triangle is shown.
//!
//! A form that keeps symmetry in exact arithmetic alone adds an antisymmetric rounding error A in every step. The prediction carries it on,
//! F A Fᵀ. The update P⁻ − K S Kᵀ leaves it as it is, so that it grows with F; (I − K H) P⁻ shrinks it, (I − K H) A (I − K H)ᵀ. Each
//! equation is right on the values before it; what is wrong is that nobody makes P symmetric.

use super::evidence::Answered;
use super::judge::{LIMIT, Place};
use super::observation::Observation;
use super::run::Triangle;
use super::subject::Precision;
use super::verdict::CaseReport;
use crate::imm::Quantity;

/// The covariance whose asymmetry grows most, and the cases in which one's does.
///
/// It grows where it is rounding at the first step and more than rounding at another, [`LIMIT`] times the noise each. Where an equation is
/// wrong while P is still symmetric, that is the cause, and the symmetry is lost because of it.
pub(super) fn lost(answered: &[Answered], cases: &[CaseReport], precision: Precision) -> Option<Observation> {
    let mut found: Vec<(&Answered, Loss)> = answered
        .iter()
        .filter_map(|of| Some((of, greatest_loss(of, precision)?)))
        .filter(|(of, loss)| cases[of.index].first_fault().is_none_or(|step| step > loss.first.0))
        .collect();
    found.sort_by(|(_, a), (_, b)| b.most.1.total_cmp(&a.most.1));
    let ids = found.iter().map(|(of, _)| of.problem.id.clone()).collect();
    let (_, worst) = found.into_iter().next()?;
    Some(Observation::SymmetryLost {
        ids,
        covariance: worst.covariance,
        first: worst.first,
        most: worst.most,
    })
}

/// How the asymmetry of a covariance grows: steps, and max |P − Pᵀ| in units.
struct Loss {
    covariance: (Quantity, usize),
    first: (usize, f64),
    most: (usize, f64),
}

fn greatest_loss(of: &Answered, precision: Precision) -> Option<Loss> {
    let modes = 0..of.shown.dimensions.r;
    let all = covariances().flat_map(|quantity| modes.clone().map(move |mode| (quantity, mode)));
    let losses = all.filter_map(|covariance| loss(of, covariance, precision));
    losses.max_by(|a, b| a.most.1.total_cmp(&b.most.1))
}

/// The covariances.
fn covariances() -> impl Iterator<Item = Quantity> {
    Quantity::ALL.into_iter().filter(|quantity| quantity.is_covariance())
}

/// How the asymmetry of one covariance grows, if it does.
fn loss(of: &Answered, covariance: (Quantity, usize), precision: Precision) -> Option<Loss> {
    let steps = 1..=of.shown.dimensions.steps();
    let shown = steps.filter_map(|step| {
        let (asymmetry, noise) = asymmetry(of, (step, covariance.0, covariance.1))?;
        let is_rounding = asymmetry <= LIMIT * noise.max(precision.unit_roundoff());
        Some((step, asymmetry, is_rounding))
    });
    let shown: Vec<(usize, f64, bool)> = shown.collect();
    let (first, most) = (shown.first()?, shown.iter().max_by(|a, b| a.1.total_cmp(&b.1))?);
    (first.2 && !most.2).then_some(Loss {
        covariance,
        first: (first.0, first.1),
        most: (most.0, most.1),
    })
}

/// max |P − Pᵀ| of a shown covariance and the rounding noise of the right one, in units; none where it is not shown or not finite.
fn asymmetry(of: &Answered, place: Place) -> Option<(f64, f64)> {
    let (step, quantity, mode) = place;
    let values = of.shown.finite(step, quantity, mode)?;
    let [noise, scale] = [&of.reference.noise, &of.reference.scale].map(|trace| trace.get(step, quantity, mode));
    let (noise, scale) = (noise?, scale?);
    let side = of.shown.dimensions.shape(step, quantity).0;
    let (mut most, mut rounding) = (0.0_f64, 0.0_f64);
    for index in 0..values.len() {
        let mirrored = index % side * side + index / side;
        most = most.max((values[index] - values[mirrored]).abs() / scale[index]);
        rounding = rounding.max(noise[index] / scale[index]);
    }
    Some((most, rounding))
}

/// The covariances of which one triangle is shown, and zeros in place of the other.
pub(super) fn halved(answered: &[Answered]) -> Option<Observation> {
    [Triangle::Upper, Triangle::Lower].into_iter().find_map(|triangle| {
        let quantities: Vec<Quantity> = covariances()
            .filter(|quantity| is_halved(answered, *quantity, triangle))
            .collect();
        (!quantities.is_empty()).then_some(Observation::OneTriangle { triangle, quantities })
    })
}

/// Whether a covariance is zero beside a triangle wherever it is shown, and should be something else in places where the triangle is.
fn is_halved(answered: &[Answered], quantity: Quantity, triangle: Triangle) -> bool {
    let mut has_half = false;
    for of in answered {
        for (step, own, mode) in of.shown.all_places().filter(|place| place.1 == quantity) {
            let Some(values) = of.shown.get(step, own, mode) else {
                continue;
            };
            let certified = of.reference.trace.get(step, own, mode);
            let side = of.shown.dimensions.shape(step, quantity).0;
            for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
                let is_beside = match triangle {
                    Triangle::Upper => row > column,
                    Triangle::Lower => row < column,
                };
                let (here, there) = (row * side + column, column * side + row);
                if is_beside && values[here] != 0.0 {
                    return false;
                }
                let should_be = certified.map_or(0.0, |certified| certified[here]);
                has_half |= is_beside && values[there] != 0.0 && should_be != 0.0;
            }
        }
    }
    has_half
}
