"""FilterPy's extended filter for the functions of a problem."""

from typing import Any

import numpy as np
from filterpy import kalman

from immaculate import Problem


class Extended(kalman.ExtendedKalmanFilter):  # type: ignore[misc]
    """Its motion is f: `predict_x` is replaced, as its documentation says. Steps do not differ."""

    x: Any

    def __init__(self, problem: Problem, j: int):
        super().__init__(problem.n, problem.m)
        self.models, self.mode, self.difference = problem, problem.modes[j], wrapped(problem)

    def predict_x(self, u: Any = 0) -> None:
        self.F = self.mode.f_jacobian(self.x)
        self.x = self.mode.f(self.x).reshape(-1, 1)

    def update(self, z: Any) -> None:
        def measured(x: Any) -> Any:
            return self.models.h(x).reshape(-1, 1)

        super().update(z, self.models.h_jacobian, measured, residual=self.difference)


def wrapped(problem: Problem) -> Any:
    """The difference of two measurements, angles wrapped to (−π, π]."""

    def difference(a: Any, b: Any) -> Any:
        d = np.subtract(a, b)
        return np.where(problem.measured_angles.reshape(d.shape), np.pi - (np.pi - d) % (2 * np.pi), d)

    return difference
