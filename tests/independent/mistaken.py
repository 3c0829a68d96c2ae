"""Equations of the checker with mistakes in them.

Each row: a name, the value in which it must be seen first, what is replaced, by what, and a case.
"""

from dataclasses import replace

from flint import arb, arb_mat

import conversion
import filters
import formulas
import imm
import models
import reader
import rules
import states
from balls import root_of, square, zeros
from filters import Estimate

RIGHT = {
    "chain": reader.Problem.chain,
    "chain over": reader.Problem.chain_over,
    "noise": reader.Problem.noise,
    "motion": reader.Problem.motion,
    "sensor": reader.Problem.sensor,
    "mixing": imm.mix_probabilities,
    "mixture": imm.mixture,
    "rule": rules.rule_of,
    "density": filters.log_density,
    "tangent": filters.tangent,
    "slopes": formulas.Curved.slopes,
    "update": filters.update,
    "given": filters.update_with_given_gain,
    "convert": conversion.convert,
    "seen": reader.Problem.seen,
    "atan2": formulas.atan2,
    "turn": models.turn,
    "converted": states.converted,
}


def transposed(rows):
    return [list(row) for row in zip(*rows)]


def chain_transposed(problem, at):
    return transposed(RIGHT["chain"](problem, at))


def chain_of_the_problem(problem, at):
    return RIGHT["chain"](problem, {})


def euler_step(problem, interval):
    """I + G T, from a time so short that e^(G T) is nearly that."""
    short = arb(2) ** -150
    chain = RIGHT["chain over"](problem, short)
    return [[(p - int(i == j)) / short * interval + int(i == j) for j, p in enumerate(row)] for i, row in enumerate(chain)]


def mixing_transposed(chain, probabilities):
    predicted, mixing = RIGHT["mixing"](chain, probabilities)
    return predicted, transposed(mixing)


def without_spread(weights, estimates, angles):
    mean = RIGHT["mixture"](weights, estimates, angles).mean
    covariance = zeros(len(angles), len(angles))
    for weight, estimate in zip(weights, estimates):
        covariance += estimate.covariance * weight
    return Estimate(mean, covariance)


def mixed_as_numbers(weights, estimates, angles):
    return RIGHT["mixture"](weights, estimates, [False] * len(angles))


def noise_twice(problem, j, at):
    return RIGHT["noise"](problem, j, at) * 2


def motion_of_the_problem(problem, j, at):
    return RIGHT["motion"](problem, j, {})


def noise_of_the_problem(problem, at):
    measurement, _ = RIGHT["sensor"](problem, at)
    return measurement, problem.raw["R"]


def rows_swapped(problem, at):
    """The second entry is taken for the first where one is missing."""
    if at["z"] is not None and None in at["z"]:
        at = {**at, "z": at["z"][::-1]}
    return RIGHT["seen"](problem, at)


def upper_root(covariance):
    """P = U Uᵀ: the lower factor of the matrix turned by half a turn."""
    size = covariance.nrows()
    turned = root_of(arb_mat([row[::-1] for row in covariance.table()[::-1]]))
    return arb_mat(size, size, turned.entries()[::-1])


def with_weight(change):
    """A rule whose last weights are changed."""

    def mistaken(filter, size):
        rule = RIGHT["rule"](filter, size)
        weights = change(rule.mean_weights, size)
        return replace(rule, mean_weights=weights, covariance_weights=weights)

    return mistaken


def as_printed_in_zhu2016(weights, size):
    """(13) with the factor two: the points along diagonals weigh twice as much."""
    return weights[: 1 + 2 * size] + [2 * weight for weight in weights[1 + 2 * size :]]


def as_printed_in_liu2017(weights, size):
    """(16) with n in the denominator of the last weight."""
    return weights[: 2 * size + 3] + [weight / size for weight in weights[2 * size + 3 :]]


def mean_weights_for_both(filter, size):
    rule = RIGHT["rule"](filter, size)
    return replace(rule, covariance_weights=rule.mean_weights)


def squared_norm(deviation, _covariance):
    return (deviation.transpose() * deviation)[0, 0]


def independent_noises(found, _seen, _shared):
    return found


def tangent_at_the_prediction(function, _at, estimate):
    return RIGHT["tangent"](function, estimate.mean, estimate)


def without_two_pi(deviation, covariance):
    return RIGHT["density"](deviation, covariance) + len(deviation.entries()) * (2 * arb.pi()).log() / 2


def without_determinant(deviation, covariance):
    return RIGHT["density"](deviation, covariance) + covariance.det().log() / 2


def slopes_transposed(function, x):
    jacobian = RIGHT["slopes"](function, x)
    return jacobian.transpose() if jacobian.nrows() == jacobian.ncols() else jacobian


def slopes_without_the_last(function, x):
    """The slope along the last entry is left out."""
    jacobian = RIGHT["slopes"](function, x)
    return arb_mat([row[:-1] + [arb(0)] for row in jacobian.table()])


def covariance_kept(filter, predicted, seen):
    updated, values = RIGHT["update"](filter, predicted, seen)
    return Estimate(updated.mean, predicted.covariance), values


def gain_of_nothing(given, predicted, seen):
    updated, values = RIGHT["given"](given, predicted, seen)
    return Estimate(predicted.mean, None), values


def predicted_probabilities(predicted, logarithms):
    return predicted


def other_sign(name, *polar):
    position, covariance = RIGHT["convert"](name, *polar)
    turned = arb_mat([[covariance[0, 0], -covariance[0, 1]], [-covariance[1, 0], covariance[1, 1]]])
    return position, turned


def standard_for_all(name, *polar):
    return RIGHT["convert"]("standard", *polar)


def not_wrapped(vector, angles):
    return vector


def not_turned(images, centre, angles):
    return images


def by_the_chain(problem, mixing, probabilities):
    return mixing


def always_mixed(j, size):
    return [arb(1) / size for _ in range(size)]


def turn_to_the_right(x, rate, time):
    return RIGHT["turn"](x, -rate, time)


def slope_of_the_square(y, x):
    """atan2 with the slope of a quotient that forgets the range's square."""
    angle = RIGHT["atan2"](y, x)
    if not isinstance(angle, formulas.Dual):
        return angle
    scale = square(x.value) + square(y.value)
    return formulas.Dual(angle.value, [slope * scale for slope in angle.slopes])


def as_it_stands(function, added, estimate):
    return estimate


def only_the_mean(function, added, estimate):
    return Estimate(function.at(estimate.mean), estimate.covariance + added)


def nothing_added(function, added, estimate):
    return RIGHT["converted"](function, zeros(added.nrows(), added.ncols()), estimate)


EQUATIONS = [
    ("the chain transposed", "predicted_mode_probabilities", "reader.Problem.chain", chain_transposed, "chain.not-stationary"),
    ("the chain of another step", "predicted_mode_probabilities", "reader.Problem.chain", chain_of_the_problem, "steps.changing"),
    ("an Euler step of the chain", "predicted_mode_probabilities", "reader.Problem.chain_over", euler_step, "sojourns.extended"),
    ("mixing probabilities transposed", "mixing_probabilities", "imm.mix_probabilities", mixing_transposed, "mixing.three-modes"),
    ("no spread of the means", "combined_prediction.covariance", "imm.mixture", without_spread, "combination.three-modes"),
    ("angles of the state mixed as numbers", "mixed.mean", "imm.mixture", mixed_as_numbers, "heading.extended"),
    ("process noise twice", "predicted.covariance", "reader.Problem.noise", noise_twice, "update.kalman"),
    ("the motion of another step", "predicted.mean", "reader.Problem.motion", motion_of_the_problem, "steps.changing"),
    ("the noise of another sensor", "innovation_covariance", "reader.Problem.sensor", noise_of_the_problem, "changing.extended"),
    ("a missing entry for another", "predicted_measurement", "reader.Problem.seen", rows_swapped, "missing.kalman"),
    ("the upper root", "predicted_measurement", "filters.root_of", upper_root, "convention.square-root"),
    ("the weight of zhu2016 (13)", "predicted.mean", "filters.rule_of", with_weight(as_printed_in_zhu2016), "rule.cubature-5.n2"),
    ("the weight of liu2017 (16)", "predicted.mean", "filters.rule_of", with_weight(as_printed_in_liu2017), "rule.simplex-5.n4"),
    ("one weight of the centre", "innovation_covariance", "filters.rule_of", mean_weights_for_both, "rule.unscented-scaled.n2"),
    ("the error in units of the file", "nees", "imm.squared_distance", squared_norm, "consistency.kalman"),
    ("noises taken for independent", "innovation_covariance", "filters.with_correlated_noises", independent_noises, "correlated.kalman"),
    ("linearised at the prediction", "predicted_measurement", "filters.tangent", tangent_at_the_prediction, "extended.iterated.one-mode"),
    ("no 2π", "log_likelihood", "filters.log_density", without_two_pi, "likelihood.generic"),
    ("no determinant", "log_likelihood", "filters.log_density", without_determinant, "likelihood.generic"),
    ("the Jacobian transposed", "predicted.covariance", "formulas.Curved.slopes", slopes_transposed, "heading.extended"),
    ("the Jacobian without its last column", "predicted.covariance", "formulas.Curved.slopes", slopes_without_the_last, "extended.turn"),
    ("the slope of the bearing", "measurement_jacobian", "reader.atan2", slope_of_the_square, "extended.generic"),
    ("the turn to the other side", "predicted.mean", "models.turn", turn_to_the_right, "cubature-3.turn"),
    ("the covariance not updated", "updated.covariance", "imm.update", covariance_kept, "update.cubature-3"),
    ("the gain not used", "updated.mean", "imm.update_with_given_gain", gain_of_nothing, "step.fixed-gain"),
    ("unmixed estimates mixed", "mixing_probabilities", "imm.unit", always_mixed, "step.fixed-gain-unmixed"),
    ("the common start mixed by the chain", "mixing_probabilities", "imm.weights_of_the_start", by_the_chain, "gpb1.kalman"),
    ("an unreachable mode mixed", "mixing_probabilities", "imm.unit", always_mixed, "chain.unreachable"),
    ("probabilities not updated", "mode_probabilities", "imm.weigh", predicted_probabilities, "likelihood.generic"),
    ("the converted covariance of other sign", "innovation_covariance", "reader.convert", other_sign, "converted.generic"),
    ("the standard conversion for another", "innovation", "reader.convert", standard_for_all, "converted.additive"),
    ("the innovation not wrapped", "innovation", "filters.wrap_rows", not_wrapped, "wrap.innovation"),
    ("estimates mixed unconverted", "mixed.mean", "reader.converted", as_it_stands, "states.extended"),
    ("a conversion without its Jacobian", "mixed.covariance", "reader.converted", only_the_mean, "states.extended"),
    ("a conversion that adds nothing", "mixed.covariance", "reader.converted", nothing_added, "states.kalman"),
    ("bearings of points not turned", "predicted_measurement", "filters.turned_to", not_turned, "wrap.counter-clockwise"),
]
