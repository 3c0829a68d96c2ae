"""Points and weights that stand for a Gaussian with mean zero and unit covariance.

Each rule gives directions with their weights; what is shared by a rule's points is written once. The equations are those of the papers
with their errata (EQUATION numbers below), or of the primary source where the papers do not print the rule.
"""

from dataclasses import dataclass
from functools import cache
from itertools import combinations, product

from flint import arb, arb_mat, ctx


@dataclass
class Rule:
    """Points as the columns of a matrix, weights for means and for covariances."""

    points: arb_mat
    mean_weights: list
    covariance_weights: list


def rule_of(filter, size):
    """The rule that a filter asks for, for a state of a given size, at the present precision."""
    if filter["kind"] == "unscented":
        return unscented(size, filter["alpha"], filter["beta"], filter["kappa"], ctx.prec)
    return cubature(filter["rule"], size, ctx.prec)


@cache
def cubature(name, size, _bits):
    """A rule whose weights are the same for means and covariances."""
    weighted = {
        "cubature-3": third_degree,
        "cubature-5": fifth_degree,
        "simplex-5": simplex,
        **{f"gauss-hermite-{order}": lambda size, order=order: gauss_hermite(size, order) for order in (2, 3, 4, 5)},
    }[name](size)
    weights = [weight for weight, _ in weighted]
    return Rule(as_columns([point for _, point in weighted]), weights, weights)


@cache
def unscented(size, alpha, beta, kappa, _bits):
    """Julier and Uhlmann 1995, scaled 2002: λ = α²(n + κ) − n, points 0 and ±√(n + λ) eᵢ; sustika2015 (27)-(33) with α = 1, β = 0.

    w₀ = λ/(n + λ), the others 1/(2(n + λ)); for covariances 1 − α² + β is added to w₀.
    """
    n, alpha, beta, kappa = arb(size), arb(alpha), arb(beta), arb(kappa)
    spread = alpha**2 * (n + kappa)
    centre = 1 - n / spread
    others = [1 / (2 * spread)] * (2 * size)
    points = [[arb(0)] * size] + both_ways(scaled(spread.sqrt(), axes(size)))
    return Rule(as_columns(points), [centre] + others, [centre + 1 - alpha**2 + beta] + others)


def third_degree(size):
    """Arasaratnam and Haykin 2009: ±√n eᵢ, each 1/(2n)."""
    return [(arb(1) / (2 * size), point) for point in both_ways(scaled(arb(size).sqrt(), axes(size)))]


def fifth_degree(size):
    """zhu2016 (2)-(13), the weight of (13) without its factor two: Jia, Xin and Cheng 2013."""
    n = arb(size)
    far = (n + 2).sqrt()
    half = (arb(1) / 2).sqrt()
    diagonals = []
    for j, l in combinations(range(size), 2):
        for sign in (1, -1):
            direction = [arb(0)] * size
            direction[j], direction[l] = half, sign * half
            diagonals.append(direction)
    return (
        [(2 / (n + 2), [arb(0)] * size)]
        + [((4 - n) / (2 * (n + 2) ** 2), point) for point in both_ways(scaled(far, axes(size)))]
        + [(1 / (n + 2) ** 2, point) for point in both_ways(scaled(far, diagonals))]
    )


def simplex(size):
    """liu2017 (6), (7), (15), (16), the last weight of (16) without the n in its denominator: Wang, Feng and Tse 2014."""
    n = arb(size)
    far = (n + 2).sqrt()
    corners = [simplex_corner(size, j) for j in range(1, size + 2)]
    edges = [
        [(n / (2 * (n - 1))).sqrt() * (one + other) for one, other in zip(*pair)] for pair in combinations(corners, 2)
    ]
    shared = (n + 1) ** 2 * (n + 2) ** 2
    return (
        [(2 / (n + 2), [arb(0)] * size)]
        + [((7 - n) * n**2 / (2 * shared), point) for point in both_ways(scaled(far, corners))]
        + [(2 * (n - 1) ** 2 / shared, point) for point in both_ways(scaled(far, edges))]
    )


def simplex_corner(size, j):
    """liu2017 (7): the corner a_j of a regular simplex, counted from 1."""
    n = arb(size)
    corner = []
    for m in range(1, size + 1):
        if m < j:
            corner.append(-((n + 1) / (n * (n - m + 2) * (n - m + 1))).sqrt())
        elif m == j:
            corner.append(((n + 1) * (n - j + 1) / (n * (n - j + 2))).sqrt())
        else:
            corner.append(arb(0))
    return corner


def gauss_hermite(size, order):
    """Every combination of the nodes of one axis; weights multiply. Nodes: the roots of He_q; weights q!/(q He_(q−1))² there."""
    axis = [(node_weight(order, node), node) for node in hermite_roots(order)]
    weighted = []
    for choice in product(axis, repeat=size):
        weight = arb(1)
        for one, _ in choice:
            weight *= one
        weighted.append((weight, [node for _, node in choice]))
    return weighted


def hermite_roots(order):
    """He₂ = x² − 1, He₃ = x³ − 3x, He₄ = x⁴ − 6x² + 3, He₅ = x⁵ − 10x³ + 15x."""
    six, ten = arb(6).sqrt(), arb(10).sqrt()
    positive = {2: [arb(1)], 3: [arb(3).sqrt()], 4: [(3 - six).sqrt(), (3 + six).sqrt()], 5: [(5 - ten).sqrt(), (5 + ten).sqrt()]}[order]
    return positive + [-root for root in positive] + ([arb(0)] if order % 2 else [])


def node_weight(order, node):
    """q!/(q He_(q−1)(x))², by He_(k+1) = x He_k − k He_(k−1)."""
    last, this, factorial = arb(1), node, order
    for k in range(1, order - 1):
        last, this = this, node * this - k * last
        factorial *= k + 1
    return arb(factorial) / (order * this) ** 2


def axes(size):
    return [[arb(int(i == j)) for j in range(size)] for i in range(size)]


def scaled(length, directions):
    return [[length * entry for entry in direction] for direction in directions]


def both_ways(points):
    return points + [[-entry for entry in point] for point in points]


def as_columns(points):
    return arb_mat(points).transpose()
