"""Modes with states of their own: how an estimate of one is read by another, or by the combined estimates.

Granström, Willett and Bar-Shalom 2015 for a matrix; for any function to first order, as the extended filter does (spec/formats.md).
"""

from balls import exact, matrix, zeros
from filters import Estimate
from formulas import Affine, Curved


def converted(function, added, estimate):
    """c(x̂) and C P Cᵀ + A, with C the slopes of c at x̂."""
    slopes = function.slopes(estimate.mean)
    return Estimate(function.at(estimate.mean), slopes * estimate.covariance * slopes.transpose() + added)


def composed(outer, inner):
    """x ↦ h(c(x))."""
    if isinstance(outer, Affine) and isinstance(inner, Affine):
        return Affine(outer.matrix * inner.matrix, outer.at(inner.offset))
    first, second = on_numbers(inner), on_numbers(outer)
    return Curved(lambda numbers: second(first(numbers)))


def on_numbers(function):
    """A function as one of a list of numbers."""
    if isinstance(function, Curved):
        return function.function
    rows, offsets = function.matrix.table(), function.offset.entries()
    return lambda numbers: [sum((x * number for x, number in zip(row, numbers)), b) for row, b in zip(rows, offsets)]


def added_of(asked, size):
    """A, which is zero where nothing is said."""
    return matrix(asked["added"]) if "added" in asked else zeros(size, size)


def map_of(problem, asked, from_mode, at):
    """c, a matrix or formulas in the names of the mode that is read."""
    if "matrix" in asked:
        return Affine(matrix(asked["matrix"]))
    raw = problem.raw
    numbers = {name: exact(x) for name, x in raw.get("parameters", {}).items()}
    if "T" in at:
        numbers["T"] = exact(at["T"])
    function = problem.of_formulas(asked["formulas"], problem.scope_of(numbers), problem.states[from_mode])
    needs_matrix = problem.filters[from_mode]["kind"] in ("kalman", "converted") and "to" not in asked
    return function.as_affine(len(problem.state)) if needs_matrix else function
