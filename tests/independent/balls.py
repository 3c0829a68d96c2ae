"""Real numbers as balls, and doubles that are proven to be the nearest ones.

A ball is a midpoint with a radius; python-flint's `arb` computes with balls so that the exact result is always inside. Nothing here
knows of filters. What a ball cannot decide is `Undecided`: the caller starts again with more bits.
"""

import math
import struct

from flint import arb, arb_mat, ctx, fmpq

# An enclosure of zero or of a tie that is narrower than this part of its unit counts as that point. spec/formats.md, "A trace", is content
# with 2⁻²⁰⁰; no published number needs so much.
POINT = arb(2) ** -1000
# A scale is rounded to three digits from a double that a few roundings led to; so near to the middle of two decimals either may stand.
ROUNDED_TWICE = arb(2) ** -50


class Undecided(Exception):
    """The enclosures are too wide for an answer."""


def set_bits(bits):
    """All balls from here on have midpoints of this many bits."""
    ctx.prec = bits


def exact(number):
    """The ball of radius zero around a double."""
    return arb(float(number))


def matrix(rows):
    """A matrix of doubles, exactly."""
    return arb_mat([[exact(entry) for entry in row] for row in rows])


def column(numbers):
    """A vector, as a matrix of one column."""
    return arb_mat(len(numbers), 1, list(numbers))


def zeros(rows, columns):
    return arb_mat(rows, columns)


def entries(vector):
    """The numbers of a matrix of one column."""
    return vector.entries()


def is_zero(ball):
    """Whether the ball is zero and nothing else; one that merely holds zero decides nothing."""
    if ball.is_zero():
        return True
    if ball.contains(0) or not ball.is_finite():
        raise Undecided("zero or not")
    return False


def raised(number, exponent):
    """An integer power, by multiplication: `**` of python-flint has no answer where the ball holds zero."""
    if exponent < 0:
        return 1 / raised(number, -exponent)
    product = arb(1)
    for _ in range(exponent):
        product *= number
    return product


def square(number):
    return number * number


def wrap(angle):
    """The angle in (-π, π] that differs by full turns."""
    turns = ((angle - arb.pi()) / (2 * arb.pi())).ceil().unique_fmpz()
    if turns is None:
        raise Undecided("on which side of the cut an angle is")
    return angle - 2 * arb.pi() * turns


def wrap_rows(vector, angles):
    """A vector of differences, those of angles wrapped."""
    return column([wrap(entry) if angle else entry for entry, angle in zip(entries(vector), angles)])


def root_of(covariance):
    """Lower Cholesky factor L, L Lᵀ = P. A row and column of zeros keeps zeros, as spec/formats.md says of what is known exactly."""
    size = covariance.nrows()
    lower = zeros(size, size)
    for j in range(size):
        if all(covariance[i, j].is_zero() for i in range(size)):
            continue
        pivot = covariance[j, j] - sum((square(lower[j, k]) for k in range(j)), arb(0))
        if not pivot > 0:
            raise Undecided("definite or not")
        lower[j, j] = pivot.sqrt()
        for i in range(j + 1, size):
            lower[i, j] = (covariance[i, j] - sum((lower[i, k] * lower[j, k] for k in range(j)), arb(0))) / lower[j, j]
    return lower


def solve(left, right):
    """X with left · X = right."""
    try:
        return left.solve(right)
    except ZeroDivisionError:
        raise Undecided("singular or not") from None


# ------------------------------------------------------------------------------------------------------- the nearest double

PROVEN, AS_POINT, WRONG, OPEN = "proven", "counts as a point", "wrong", "open"


def judge(ball, published, unit):
    """Whether the published double is the one nearest to every number of the ball.

    AS_POINT: the ball holds zero or a tie and is narrower than 2⁻¹⁰⁰⁰ of the unit.
    """
    if published is None:  # minus infinity, which JSON cannot say: below the least double by half a unit in its last place
        least = -(arb(2) ** 1024 - arb(2) ** 970)
        return PROVEN if ball < least else WRONG if ball > least else OPEN
    if not math.isfinite(published) or math.copysign(1, published) < 0 == published:
        return WRONG
    below, above = (half_way(published, math.nextafter(published, side)) for side in (-math.inf, math.inf))
    if below < ball < above:
        return PROVEN
    if ball < below or ball > above:
        return WRONG
    if not 2 * ball.rad() < POINT * unit:
        return OPEN
    if ball.contains(0):
        return AS_POINT if published == 0 else WRONG
    return AS_POINT if is_even(published) else WRONG


def half_way(one, other):
    return (exact(one) + exact(other)) / 2


def is_even(double):
    """Whether the last bit is zero: ties go there."""
    return struct.unpack("<Q", struct.pack("<d", double))[0] % 2 == 0


def judge_rounded(ball, published):
    """Whether the published decimal of three significant digits is the one nearest to the number, or to a double that is near it."""
    if published is None or not 0 < published < math.inf:
        return WRONG
    digits, exponent = three_digits(published)
    if published != float(f"{digits}e{exponent}"):
        return WRONG
    below, above = (half_way_decimal(digits, exponent, sign) for sign in (-1, 1))
    below, above = below * (1 - ROUNDED_TWICE), above * (1 + ROUNDED_TWICE)
    return PROVEN if below < ball < above else WRONG if ball < below or ball > above else OPEN


def three_digits(number):
    """The number as d · 10ᵉ with d from 100 to 999."""
    mantissa, exponent = f"{number:.2e}".split("e")
    return round(100 * float(mantissa)), int(exponent) - 2


def half_way_decimal(digits, exponent, sign):
    """The middle to a neighbour of three digits; below 100 the neighbours are ten times as near."""
    step = fmpq(1, 20) if digits == 100 and sign < 0 else fmpq(1, 2)
    return arb((digits + sign * step) * fmpq(10) ** exponent)
