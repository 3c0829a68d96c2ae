"""Certified data: the published cases, traces and rules."""

import json
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from immaculate import _immaculate
from immaculate._problem import Array, Problem


def cases(kind: Optional[str] = None, flag: Optional[str] = None) -> list[Problem]:
    """The published cases, without those that a filter must reject; `kind` and `flag` select cases for one filter or with one flag.

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

    steps  a list of dictionaries, one per step, with the keys of spec/formats.md; vectors are (n,) or (m,), matrices (n, n), (m, m) or
           (n, m), and `modes` is a list of r dictionaries
    scale  the same with the scale of every number
    noise  the same with one number per quantity: how far rounding in doubles moves it, in units of its scale

    `np.max(np.abs(x - expected) / scale) < 100 * noise` is a unit test.
    """

    id: str
    steps: list[dict[str, Any]]
    scale: list[dict[str, Any]]
    noise: list[dict[str, Any]]


def trace(problem: Problem) -> Trace:
    """The certified trace of a problem: looked up for a published case, otherwise computed, which takes minutes for hundreds of steps.

    Raises ValueError if it cannot be certified.
    """
    file = json.loads(problem._trace or problem._native.trace())
    return Trace(problem.id, *([_arrays(step) for step in file[part]] for part in ("steps", "scale", "noise")))


def _arrays(value: Any) -> Any:
    """Lists of numbers as arrays, in dictionaries and lists of them. A null in JSON is a logarithm below the doubles, −∞."""
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
    proven exact; None above ten dimensions, where it is not tried."""

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
