"""The filters inside: how a Gaussian goes through a function, and the update with a measurement.

A filter's kind is one choice: how mean, covariance and cross-covariance of g(x) are found. The rest is the same for all.
"""

from dataclasses import dataclass
from itertools import cycle

from flint import arb, arb_mat

from balls import column, entries, root_of, solve, wrap, wrap_rows
from formulas import Affine
from rules import rule_of


@dataclass
class Estimate:
    """Mean and covariance; filters with fixed gains have no covariance."""

    mean: arb_mat
    covariance: arb_mat | None


@dataclass
class Moments:
    """Mean and covariance of g(x) without noise, its covariance with x, and the Jacobian where it was used."""

    mean: arb_mat
    covariance: arb_mat
    cross: arb_mat
    jacobian: arb_mat | None = None


def moments(filter, function, estimate, angles):
    """The moments of g(x) for x ~ N(mean, covariance); `angles` says which entries of g(x) are angles."""
    if filter["kind"] in ("kalman", "converted"):
        return by_matrix(function, estimate)
    if filter["kind"] == "extended":
        return by_slopes(function, estimate)
    return by_points(rule_of(filter, estimate.mean.nrows()), function, estimate, angles)


def by_matrix(function, estimate):
    """sustika2015 (14), (15) and (16), (17): E[Ax + b], A P Aᵀ, P Aᵀ."""
    if not isinstance(function, Affine):
        raise TypeError("a Kalman filter needs a matrix")
    cross = estimate.covariance * function.matrix.transpose()
    return Moments(function.at(estimate.mean), function.matrix * cross, cross)


def by_slopes(function, estimate):
    """The extended filter: the mean through the function, the covariance through its Jacobian at the mean."""
    jacobian = function.slopes(estimate.mean)
    cross = estimate.covariance * jacobian.transpose()
    return Moments(function.at(estimate.mean), jacobian * cross, cross, jacobian)


def by_points(rule, function, estimate, angles):
    """liu2017 (14), (17), (18), (19), which is zhu2016 (21)-(50) centred: weighted sums over S ξ + x̂.

    Angles are averaged as differences from the angle of the mean.
    """
    deviations = root_of(estimate.covariance) * rule.points
    images = through(function, deviations, estimate.mean)
    if any(angles):
        images = turned_to(images, function.at(estimate.mean), angles)
    mean = images * column(rule.mean_weights)
    spread = minus(images, mean)
    if any(angles):
        spread = arb_mat([[wrap(x) for x in row] if angle else row for row, angle in zip(spread.table(), angles)])
    weighted = scaled_columns(spread, rule.covariance_weights).transpose()
    return Moments(mean, spread * weighted, deviations * weighted)


def through(function, deviations, mean):
    """The images of the points mean + deviation, as columns."""
    if isinstance(function, Affine):
        return plus(function.matrix * deviations, function.at(mean))
    points = plus(deviations, mean).transpose().table()
    return arb_mat([entries(function.at(column(point))) for point in points]).transpose()


def turned_to(images, centre, angles):
    """The angles of the points in the turn of the centre's."""
    rows = zip(images.table(), entries(centre), angles)
    return arb_mat([[c + wrap(x - c) for x in row] if angle else row for row, c, angle in rows])


def plus(matrix, vector):
    return arb_mat([[x + v for x in row] for row, v in zip(matrix.table(), entries(vector))])


def minus(matrix, vector):
    return plus(matrix, -vector)


def scaled_columns(matrix, weights):
    scaled = [x * weight for x, weight in zip(matrix.entries(), cycle(weights))]
    return arb_mat(matrix.nrows(), matrix.ncols(), scaled)


# --------------------------------------------------------------------------------------------------------------- the update


@dataclass
class Seen:
    """A measurement of this step: its function of the state, noise, numbers, and which of them are angles."""

    function: object
    noise: arb_mat
    z: arb_mat
    angles: list
    rows: list | None = None  # which entries of the sensor's measurement these are


def update(filter, predicted, seen):
    """liu2017 (19)-(21), with the exponent −½ of a density: what a mode computes from a measurement, and its new estimate."""
    found = moments(filter, seen.function, predicted, seen.angles)
    for _ in range(1, filter.get("iterations", 1)):
        found = tangent(seen.function, corrected(found, predicted, seen), predicted)
    if "M" in filter:
        found = with_correlated_noises(found, seen, filter["M"])
    innovation = wrap_rows(seen.z - found.mean, seen.angles)
    covariance = found.covariance + seen.noise
    gain = solve(covariance.transpose(), found.cross.transpose()).transpose()
    updated = Estimate(predicted.mean + gain * innovation, predicted.covariance - gain * covariance * gain.transpose())
    values = {
        "predicted_measurement": found.mean,
        "innovation": innovation,
        "innovation_covariance": covariance,
        "cross_covariance": found.cross,
        "gain": gain,
        "log_likelihood": log_density(innovation, covariance),
        "nis": squared_distance(innovation, covariance),
    }
    if filter["kind"] == "extended":
        values["measurement_jacobian"] = found.jacobian
    return updated, values


def with_correlated_noises(found, seen, shared):
    """Simon 2006, section 7.1: E[(x − x̂⁻)vᵀ] is M = E[w vᵀ], so that C has M, and S has H M and its transpose."""
    shared = arb_mat([[row[k] for k in seen.rows] for row in shared.table()])
    slopes = seen.function.matrix if found.jacobian is None else found.jacobian
    both = slopes * shared
    return Moments(found.mean, found.covariance + both + both.transpose(), found.cross + shared, found.jacobian)


def corrected(found, predicted, seen):
    """The updated mean with these moments of the measurement: the next iterate of the iterated extended filter."""
    innovation = wrap_rows(seen.z - found.mean, seen.angles)
    return predicted.mean + found.cross * solve(found.covariance + seen.noise, innovation)


def tangent(function, at, estimate):
    """Bar-Shalom, Li and Kirubarajan 2001, section 10.5.2: the moments by the slopes at another state, h(x) + H(x̂⁻ − x)."""
    jacobian = function.slopes(at)
    cross = estimate.covariance * jacobian.transpose()
    return Moments(function.at(at) + jacobian * (estimate.mean - at), jacobian * cross, cross, jacobian)


def update_with_given_gain(given, predicted, seen):
    """derbez2000 section 3: gain and innovation covariance are inputs."""
    expected = seen.function.at(predicted.mean)
    innovation = seen.z - expected
    updated = Estimate(predicted.mean + given["gain"] * innovation, None)
    return updated, {
        "predicted_measurement": expected,
        "innovation": innovation,
        "innovation_covariance": given["innovation_covariance"],
        "gain": given["gain"],
        "log_likelihood": log_density(innovation, given["innovation_covariance"]),
        "nis": squared_distance(innovation, given["innovation_covariance"]),
    }


def log_density(deviation, covariance):
    """ln N(ν; 0, S) = −½(νᵀS⁻¹ν + ln|S| + m ln 2π): zhu2016 (57) and liu2017 (21) with their errata."""
    square = squared_distance(deviation, covariance)
    return -(square + covariance.det().log() + len(entries(deviation)) * (2 * arb.pi()).log()) / 2


def squared_distance(deviation, covariance):
    """νᵀS⁻¹ν: Bar-Shalom, Li and Kirubarajan 2001, section 5.4."""
    return (deviation.transpose() * solve(covariance, deviation))[0, 0]
