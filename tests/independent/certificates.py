"""Certificates of joint stability, proven again: spec/formats.md, "A certificate of joint stability".

Everything is computed in balls of 256 bits, from the noises or the damping roots on.
"""

import hashlib
import json
from fractions import Fraction

from flint import arb, arb_mat, fmpq

from balls import column, set_bits, solve

STEPS_OF_BISECTION = 200


class Unproven(Exception):
    """What a certificate claims and what does not follow."""


def demand(condition, sentence):
    if not condition:
        raise Unproven(sentence)


def prove(certificate):
    """Raises `Unproven` unless every claim of the certificate is proven; gives the number of inequalities."""
    set_bits(256)
    demand(certificate["format"] == "immaculate-certificate/1", "another format")
    demand(certificate["digest"] == digest(certificate), "the digest is another")
    matrices = closed_loops(certificate["filters"])
    proof = certificate["proof"]
    demand(set(proof) in ({"stable"}, {"unstable"}), "the proof is neither `stable` nor `unstable`")
    return prove_stable(proof["stable"], matrices) if "stable" in proof else prove_unstable(proof["unstable"], matrices)


def digest(certificate):
    """SHA-256 of filters and proof as compact JSON, one after the other."""
    parts = [json.dumps(certificate[key], separators=(",", ":"), ensure_ascii=False) for key in ("filters", "proof")]
    return hashlib.sha256("".join(parts).encode()).hexdigest()


def number(text):
    """A fraction or decimal in quotes, exactly."""
    fraction = Fraction(text)
    return arb(fmpq(fraction.numerator, fraction.denominator))


# --------------------------------------------------------------------------------------------------------------- the filters

MEASURED = arb_mat([[1, 0, 0]])
VELOCITY = arb_mat([[1, 1, 0], [0, 1, 0], [0, 0, 0]])  # derbez2000 (5), F, for t = 1
ACCELERATION = arb_mat([[1, 1, arb(1) / 2], [0, 1, 1], [0, 0, 1]])  # F + ΔF


def closed_loops(filters):
    """A = (I − K H) F of constant velocity, `v`, and constant acceleration, `a`, in scaled coordinates."""
    if "damping-roots" in filters:
        of_velocity, of_acceleration = [number(text) for text in filters["damping-roots"]]
        demand(0 < of_velocity < 1 and 0 < of_acceleration < 1, "a damping root is not between 0 and 1")
        gains = gain(of_velocity, False), gain(of_acceleration, True)
    else:
        gains = gains_of(filters["noises"])
    return {"v": after_update(gains[0]) * VELOCITY, "a": after_update(gains[1]) * ACCELERATION}


def after_update(gain):
    return identity() - gain * MEASURED


def identity():
    return arb_mat([[int(i == j) for j in range(3)] for i in range(3)])


def gain(root, accelerates):
    """K = [α, β, γ/2] with α = 1 − θ², β = 2(1 − θ)², γ = β²/α; constant velocity has no γ."""
    alpha, beta = 1 - root * root, 2 * (1 - root) * (1 - root)
    return column([alpha, beta, beta * beta / alpha / 2 if accelerates else arb(0)])


def gains_of(noises):
    """The gains of the steady state, by their tracking indices Λ = √(q/R) t²; that they are its gains is seen in its Riccati equation."""
    interval, variance = number(noises["interval"]), number(noises["measurement"])
    gains = []
    for name, accelerates in (("constant-velocity", False), ("constant-acceleration", True)):
        index = (number(noises[name]) / variance).sqrt() * interval * interval
        found = gain(damping_root(index, accelerates), accelerates)
        check_riccati(found, index, accelerates)
        gains.append(found)
    return gains


def damping_root(index, accelerates):
    """θ in (0, 1) with 2(1 − θ)² = Λθ, or 2(1 − θ)³ = Λθ(1 + θ): the left side falls, the right one grows."""

    def excess(root):
        rest = 1 - root
        return 2 * rest * rest * rest - index * root * (1 + root) if accelerates else 2 * rest * rest - index * root

    below, above = arb(0), arb(1)
    for _ in range(STEPS_OF_BISECTION):
        middle = (below + above) / 2
        at_middle = excess(middle)
        if at_middle > 0:
            below = middle
        elif at_middle < 0:
            above = middle
        else:
            break
    return below.union(above)


def check_riccati(gain, index, accelerates):
    """P = F (I − K H) P Fᵀ + Λ² G Gᵀ, which is linear in P for a given K, has K = P Hᵀ/(H P Hᵀ + 1) again."""
    motion = ACCELERATION if accelerates else VELOCITY
    noise = column([arb(1) / 2, arb(1), arb(int(accelerates))])
    noise = noise * noise.transpose() * (index * index)
    closed = motion * after_update(gain)
    cells = [(i, j) for i in range(3) for j in range(3)]
    system = arb_mat([[int((i, j) == (k, l)) - closed[i, k] * motion[j, l] for k, l in cells] for i, j in cells])
    predicted = arb_mat(3, 3, solve(system, column([noise[i, j] for i, j in cells])).entries())
    again = predicted * MEASURED.transpose() * (1 / (predicted[0, 0] + 1))
    for one, other in zip(again.entries(), gain.entries()):
        difference = one - other
        demand(difference.contains(0) and difference.rad() < arb(10) ** -20, "the gain is not that of the steady state")


# ---------------------------------------------------------------------------------------------------------------- the proofs


def prove_stable(proof, matrices):
    """Every node has an edge for either letter, and along every edge the form falls: P_u − Aᵀ P_w A is positive definite."""
    forms = [arb_mat([[number(text) for text in row] for row in form]) for form in proof["forms"]]
    for node, form in enumerate(forms):
        demand((form.nrows(), form.ncols()) == (3, 3), f"form {node} is not 3 × 3")
        demand(form.entries() == form.transpose().entries(), f"form {node} is not symmetric")
        demand(is_definite(form), f"form {node} is not positive definite")
        letters = {letter for start, letter, _ in proof["edges"] if start == node}
        demand(letters == {"v", "a"}, f"node {node} has no edge for a letter")
    demand(forms, "there is no form")
    for start, letter, end in proof["edges"]:
        demand(start in range(len(forms)) and end in range(len(forms)), f"the edge {start} {letter} {end} has no node")
        matrix = matrices[letter]
        falls = forms[start] - matrix.transpose() * forms[end] * matrix
        demand(is_definite(falls), f"the form does not fall along {start} {letter} {end}")
    return len(forms) + len(proof["edges"])


def is_definite(form):
    """Every leading principal minor is positive."""
    return all(arb_mat([row[:size] for row in form.table()[:size]]).det() > 0 for size in (1, 2, 3))


def prove_unstable(proof, matrices):
    """The product of the word's letters, the first acting first, has an eigenvalue of at least `radius`, which is above one."""
    radius = number(proof["radius"])
    demand(radius > 1, "the radius is not above one")
    demand(proof["word"] and set(proof["word"]) <= {"v", "a"}, "the word is not made of v and a")
    product = identity()
    for letter in proof["word"]:
        product = matrices[letter] * product
    demand(has_root_beyond(product.charpoly(), radius), "the spectral radius is not that great")
    return 1


def has_root_beyond(polynomial, radius):
    """A monic polynomial of degree three that is negative at r, or positive at −r, has a real root beyond."""
    return polynomial(radius) < 0 or polynomial(-radius) > 0
