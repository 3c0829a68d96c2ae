"""What is certified: the published cases, traces and rules."""

import json
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from immaculate import _immaculate
from immaculate._problem import Array, Problem


def cases(kind: Optional[str] = None, flag: Optional[str] = None) -> list[Problem]:
    """The published cases, those that a filter must reject left out; with `kind`, of those filters alone; with `flag`, of those marked so.

    Every one has its certified trace: `immaculate.trace(problem)` looks it up.
    """
    found = []
    for native, text in _immaculate.cases():
        if kind is not None and kind not in native.kinds():
            continue
        problem = Problem(native, text)
        if flag is None or flag in problem.flags:
            found.append(problem)
    return found


@dataclass(frozen=True)
class Trace:
    """A certified trace: every number is the double nearest to the exact value.

    steps  a list of dictionaries, one a step, with the keys of spec/formats.md; vectors are (n,) or (m,), matrices (n, n), (m, m) or
           (n, m), and `modes` is a list of r dictionaries
    scale  the same with the natural unit of every number
    noise  the same with one number a quantity: how far rounding in doubles moves it, in those units

    `np.max(np.abs(x - expected) / scale) < 100 * noise` is a unit test.
    """

    id: str
    steps: list[dict[str, Any]]
    scale: list[dict[str, Any]]
    noise: list[dict[str, Any]]


def trace(problem: Problem) -> Trace:
    """The certified trace of a problem: looked up for a published case, else computed, which for hundreds of steps takes minutes.

    Raises ValueError where it cannot be certified.
    """
    file = json.loads(problem._trace or problem._native.trace())
    return Trace(problem.id, *([_arrays(step) for step in file[part]] for part in ("steps", "scale", "noise")))


def _arrays(value: Any) -> Any:
    """Lists of numbers as arrays, in dictionaries and lists of them. What is beyond the doubles is null in JSON, and −∞."""
    if isinstance(value, dict):
        return {key: _arrays(inner) for key, inner in value.items()}
    if isinstance(value, list):
        if value and isinstance(value[0], dict):
            return [_arrays(inner) for inner in value]
        return np.array(value, dtype=float)
    return -np.inf if value is None else value


@dataclass(frozen=True)
class Rule:
    """A cubature rule for N(0, I): points (s, n), weights (s,), the weights for covariances (s,), and the degree to which all moments are
    exact, proven; None beyond ten dimensions, where it is not tried."""

    points: Array
    weights: Array
    covariance_weights: Array
    degree: Optional[int]


def rule(
    name: str, n: int, *, alpha: Optional[float] = None, beta: Optional[float] = None, kappa: Optional[float] = None
) -> Rule:
    """The rule of this name in n dimensions: "cubature-3", "cubature-5", "simplex-5", "gauss-hermite-2" to "-5", or "unscented" with α
    (default 1), β (0) and κ (3 − n)."""
    parameters = [None if value is None else repr(float(value)) for value in (alpha, beta, kappa)]
    read = json.loads(_immaculate.rule(name, n, parameters))
    points, weights, of_covariances = (np.array(read[key], dtype=float) for key in ("points", "weights", "covariance_weights"))
    return Rule(points, weights, of_covariances, read["degree"])
