"""A filter made of two functions:

    x, P = predict(x, P, f, F, Q)        f(x) -> (n,) and F(x) -> (n, n), its Jacobian; Q is (n, n)
    x, P = update(x, P, z, h, H, R)      h(x) -> (m,) and H(x) -> (m, n), its Jacobian; R is (m, m)

x is (n,), P (n, n) and z (m,). A linear filter calls F and H with any x. Without a detection `update` is not called.
"""

from collections.abc import Callable
from typing import Any, Optional, Union

from immaculate._check import Skip
from immaculate._problem import Array, Models, Problem, Step

Estimate = tuple[Array, Array]


def filter_of(predict: Callable[..., Estimate], update: Callable[..., Estimate]) -> Callable[[Problem], "Functions"]:
    """The two functions as a filter for `immaculate.check`."""

    def make(problem: Problem) -> "Functions":
        return Functions(problem, predict, update)

    make.__name__ = getattr(update, "__module__", "functions")
    return make


class Functions:
    """A filter with `predict()` and `update(z)` from two functions. Steps may differ."""

    def __init__(self, problem: Problem, predict: Callable[..., Estimate], update: Callable[..., Estimate]):
        if problem.covariances is None:
            raise Skip("there are no covariances")
        self._predict, self._update = predict, update
        self._models: Union[Models, Step] = problem
        self.x: Array = problem.means[0]
        self.P: Array = problem.covariances[0]

    def change(self, step: Step) -> None:
        self._models = step

    def predict(self) -> None:
        mode = self._models.modes[0]
        self.x, self.P = self._predict(self.x, self.P, mode.f, mode.f_jacobian, mode.Q)

    def update(self, z: Optional[Any]) -> None:
        models = self._models
        self.x, self.P = self._update(self.x, self.P, z, models.h, models.h_jacobian, models.R)
