"""FilterPy: its own classes, used as its documentation shows. The adapter recomputes nothing.

KalmanFilter, ExtendedKalmanFilter, UnscentedKalmanFilter; for several modes IMMEstimator, which has no Jacobians and so no extended ones.
"""

from typing import Any, Optional

from filterpy import kalman

from immaculate import Problem, Skip
from immaculate.adapters.filterpy_extended import Extended, wrapped


def estimate(kf: Any, when: str) -> dict[str, Any]:
    return {"mean": getattr(kf, f"x_{when}"), "covariance": getattr(kf, f"P_{when}")}


class Filter:
    """FilterPy's filter for a problem, and the values that it exposes."""

    def __init__(self, problem: Problem):
        if problem.kind not in ("kalman", "extended", "unscented") or (problem.r > 1 and problem.kind == "extended"):
            raise Skip(f"FilterPy has no {problem.kind} filter for {problem.r} modes")
        self.filters = [filter_of(problem, j) for j in range(problem.r)]
        self.imm = kalman.IMMEstimator(self.filters, problem.mode_probabilities, problem.transition) if problem.r > 1 else None

    def step(self, z: Optional[Any]) -> dict[str, Any]:
        imm = self.imm
        modes: list[dict[str, Any]] = [{} for _ in self.filters]
        shown: dict[str, Any] = {"modes": modes}
        if imm:
            shown["predicted_mode_probabilities"] = imm.cbar.copy()
            modes[:] = [{"mixing_probabilities": weights} for weights in imm.omega.T.copy()]
        last = imm or self.filters[0]
        last.predict()
        last.update(z if z is None or self.filters[0].x.ndim == 1 else z.reshape(-1, 1))
        for mode, kf in zip(modes, self.filters):
            mode.update(predicted=estimate(kf, "prior"), updated=estimate(kf, "post"))
            if z is not None:
                mode.update(innovation=kf.y, innovation_covariance=kf.S, gain=kf.K, log_likelihood=kf.log_likelihood)
        if imm:
            shown.update(combined_prediction=estimate(imm, "prior"), mode_probabilities=imm.mu)
        return {**shown, "combined": estimate(last, "post")}


def filter_of(problem: Problem, j: int) -> Any:
    """The filter of a mode."""
    n, m, mode = problem.n, problem.m, problem.modes[j]
    if problem.kind == "kalman":
        kf = kalman.KalmanFilter(n, m)
        kf.F, kf.H = mode.F, problem.H
    elif problem.kind == "extended":
        kf = Extended(problem, j)
    else:
        parameters = {key: value for key, value in problem.filters[j].items() if key != "kind"}
        points = kalman.MerweScaledSigmaPoints(n, **parameters)
        functions = {"hx": problem.h, "fx": lambda x, dt: mode.f(x), "residual_z": wrapped(problem)}
        kf = kalman.UnscentedKalmanFilter(n, m, dt=1.0, points=points, **functions)
    kf.x = problem.means[j].reshape(kf.x.shape)  # a column but for the unscented filter
    kf.P, kf.Q, kf.R = problem.covariances[j], mode.Q, problem.R  # type: ignore[index]
    return kf
