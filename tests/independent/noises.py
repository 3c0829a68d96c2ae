"""Named models of process noise, as what they are: an integral of white noise through the motion, or an acceleration of each step.

Noise that is white in time: Q = ∫ Φ(τ) L diag(q) Lᵀ Φ(τ)ᵀ dτ over the step, where Φ(τ) L says what a unit of noise has done after τ. The
integrals are enclosed numerically (FLINT's `acb.integral`); no closed form is used. Noise that is constant over a step: Q = G diag(q) Gᵀ.
"""

from math import factorial

from flint import acb, arb, arb_mat

from balls import zeros
from formulas import Refused
from models import DERIVATIVES



def white(response, densities, time):
    """∫ Σ_c q_c g_c(τ) g_c(τ)ᵀ dτ, where g_c is column c of the response."""
    size = len(response(acb(0)))
    rows = [[arb(0)] * size for _ in range(size)]
    for i in range(size):
        for j in range(size):
            for c, density in enumerate(densities):
                product = lambda tau, _analytic: response(tau)[i][c] * response(tau)[j][c]  # noqa: E731
                rows[i][j] += acb.integral(product, 0, time).real * density
    return arb_mat(rows)


def stepwise(columns, variances):
    """G diag(q) Gᵀ."""
    total = zeros(len(columns[0]), len(columns[0]))
    for entries, variance in zip(columns, variances):
        column = arb_mat([[entry] for entry in entries])
        total += column * column.transpose() * variance
    return total


def integrator(order):
    """A chain of integrators that white noise drives at its end: τ^k/k!, the highest first."""
    return lambda tau: [[tau**k / factorial(k)] for k in range(order, -1, -1)]


def white_chain(order):
    return lambda given: white(integrator(order), [given("q")], given("T"))


def step_of_derivative(order):
    """What a velocity (order 1), an acceleration (2) or a jerk (3) that is constant over a step has done to position and derivatives."""
    return lambda given: [given("T") ** k / factorial(k) for k in range(order, -1, -1)]


def step_chain(order, entries):
    return lambda given: stepwise([step_of_derivative(order)(given)[:entries]], [given("q")])


def singer(given):
    """The response to the noise of a decaying acceleration, itself integrals of e^(−αt); of a density 2ασ²."""
    alpha = given("alpha")

    def response(tau):
        decay = -alpha * tau
        to_velocity = tau * decay.hypgeom([acb(1)], [acb(2)])
        return [[tau * tau * decay.hypgeom([acb(1)], [acb(3)]) / 2], [to_velocity], [decay.exp()]]

    return white(response, [2 * alpha * given("variance")], given("T"))


def turning(given):
    """zhu2016 (61) applied to a unit of velocity along x and along y."""
    rate = given("w")

    def response(tau):
        angle = rate * tau
        along, across = tau * sinc(angle), tau * (angle / 2) * sinc(angle / 2) ** 2
        return [[along, -across], [angle.cos(), -angle.sin()], [across, along], [angle.sin(), angle.cos()]]

    return white(response, [given("q")] * 2, given("T"))


def sinc(angle):
    return (-angle * angle / 4).hypgeom([], [acb(3) / 2])


def bordered(matrix, corner):
    """One more entry, without covariance to the rest."""
    size = matrix.nrows()
    return arb_mat([row + [arb(0)] for row in matrix.table()] + [[arb(0)] * size + [corner]])


def in_the_plane(given):
    column = step_of_derivative(2)(given)[:2]
    nothing = [arb(0)] * 2
    return stepwise([column + nothing, nothing + column], [given("q")] * 2)


def along_the_heading(entries):
    """What is along the heading, and a turn: entries give each column by T and the heading's direction."""

    def noise(given):
        return stepwise(entries(given("T"), given("heading").cos(), given("heading").sin()), [given("q"), given("q_turn")])

    return noise


def of_speed(time, cosine, sine):
    way = time**2 / 2
    return [way * cosine, way * sine, time, arb(0), arb(0)], [arb(0)] * 3 + [way, time]


def of_acceleration(time, cosine, sine):
    way = time**3 / 6
    return [way * cosine, way * sine, time**2 / 2, arb(0), time, arb(0)], [arb(0)] * 3 + [time**2 / 2, arb(0), time]


# On each axis by itself: how many derivatives, and the noise. Then those of the plane, with their entries.
ON_AXES = {
    "random-walk-white-noise": (1, white_chain(0)),
    "random-walk-piecewise-noise": (1, step_chain(1, 1)),
    "constant-velocity-white-noise": (2, white_chain(1)),
    "constant-velocity-piecewise-noise": (2, step_chain(2, 2)),
    "constant-acceleration-white-noise": (3, white_chain(2)),
    "constant-acceleration-piecewise-noise": (3, step_chain(2, 3)),
    "constant-jerk-white-noise": (4, white_chain(3)),
    "constant-jerk-piecewise-noise": (4, step_chain(3, 4)),
    "singer-white-noise": (3, singer),
}
PLANE, RATE = ["x", "vx", "y", "vy"], ["x", "vx", "y", "vy", "w"]
IN_THE_PLANE = {
    "coordinated-turn-white-noise": (PLANE, turning),
    "coordinated-turn-piecewise-noise": (PLANE, in_the_plane),
    "coordinated-turn-unknown-rate-white-noise": (RATE, lambda given: bordered(turning(given), given("q_turn") * given("T"))),
    "coordinated-turn-unknown-rate-piecewise-noise": (RATE, lambda given: bordered(in_the_plane(given), given("q_turn") * given("T") ** 2)),
    "constant-turn-rate-and-speed-piecewise-noise": (["x", "y", "v", "heading", "w"], along_the_heading(of_speed)),
    "constant-turn-rate-and-acceleration-piecewise-noise": (["x", "y", "v", "heading", "a", "w"], along_the_heading(of_acceleration)),
}


def noise(name, state, given):
    """Q for all entries of the state: zero for those that the model does not have."""
    if name in ON_AXES:
        entries, of_an_axis = ON_AXES[name]
        chains = [[f"{letter}{axis}" for letter in DERIVATIVES[:entries]] for axis in "xyz"]
        blocks = [(chain, of_an_axis(given)) for chain in chains if set(chain) <= set(state)]
    elif name in IN_THE_PLANE:
        names, of_the_plane = IN_THE_PLANE[name]
        blocks = [(names, of_the_plane(given))]
    else:
        raise Refused(f"the noise `{name}` is not written here: add it to noises.py, from its source")
    total = zeros(len(state), len(state))
    for names, block in blocks:
        places = [state.index(entry) for entry in names]
        for i, row in zip(places, block.table()):
            for j, entry in zip(places, row):
                total[i, j] = entry
    return total
