"""Stone Soup: its predictors and updaters, on models that are the problem's functions; the adapter recomputes nothing.

Kalman, extended, unscented and third-degree cubature filters, one at a time: Stone Soup has no interacting multiple model filter. It takes the
mean of angles by vectors: `immaculate.check(stonesoup.Filter, conventions=stonesoup.CONVENTIONS)`.
"""

import datetime
from typing import Any, Optional, Union

import numpy as np
from stonesoup.models.base import GaussianModel
from stonesoup.models.measurement import MeasurementModel
from stonesoup.models.transition import TransitionModel
from stonesoup.predictor import kalman as predictors
from stonesoup.types.angle import Bearing
from stonesoup.types.array import StateVector, StateVectors
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState
from stonesoup.updater import kalman as updaters

from immaculate import Problem, Skip
from immaculate._problem import Step

CONVENTIONS = {"angle_mean": "vector"}
PARTS = {"kalman": "Kalman", "extended": "ExtendedKalman", "unscented": "UnscentedKalman", "cubature-3": "CubatureKalman"}
TIME, SECOND = datetime.datetime(2000, 1, 1), datetime.timedelta(seconds=1)


def model(base: type, f: Any, jacobian: Any, noise: Any, shape: tuple[int, int], angles: Any) -> Any:
    """A model of Stone Soup from a function, its Jacobian and its noise; the angles of its result are bearings."""

    def function(self: Any, state: Any, noise: Any = False, **_: Any) -> Any:
        points = np.asarray(state.state_vector, dtype=float).T
        values = [column(f(point), angles) for point in points]
        return StateVectors(values) if len(values) > 1 else values[0]

    members = {
        "function": function,
        "jacobian": lambda self, state, **_: jacobian(np.asarray(state.state_vector, dtype=float).ravel()),
        "matrix": lambda self, **_: jacobian(np.zeros(shape[1])),
        "covar": lambda self, **_: np.array(noise),
        "ndim": property(lambda self: shape[0]),
        "ndim_state": property(lambda self: shape[1]),
        "ndim_meas": property(lambda self: shape[0]),
        "mapping": property(lambda self: range(shape[1])),
    }
    return type("Model", (base, GaussianModel), members)()


class Filter:
    """Stone Soup's filter for a problem, and the values that it exposes."""

    def __init__(self, problem: Problem):
        if problem.r > 1 or problem.kind not in PARTS:
            raise Skip(f"Stone Soup has no {problem.kind} filter for {problem.r} modes")
        self.part = PARTS[problem.kind]
        keys = ("alpha", "beta", "kappa")
        self.parameters = {key: value for key, value in problem.filters[0].items() if key in keys}
        self.state = GaussianState(problem.means[0].reshape(-1, 1), problem.covariances[0], TIME)  # type: ignore[index]
        self.change(problem)

    def change(self, models: Union[Problem, Step]) -> None:
        mode, n = models.modes[0], len(self.state.state_vector)
        if self.part == "Kalman" and mode.offset is not None:
            raise Skip("its linear predictor has no offset; an input is a control model there")
        motion = model(TransitionModel, mode.f, mode.f_jacobian, mode.Q, (n, n), np.zeros(n, bool))
        angles = self.angles = models.measured_angles
        self.sensor = model(MeasurementModel, models.h, models.h_jacobian, models.R, (len(angles), n), angles)
        self.predictor = getattr(predictors, f"{self.part}Predictor")(motion, **self.parameters)
        self.updater = getattr(updaters, f"{self.part}Updater")(self.sensor, **self.parameters)

    def step(self, z: Optional[Any]) -> dict[str, Any]:
        prediction = self.predictor.predict(self.state, timestamp=self.state.timestamp + SECOND)
        mode: dict[str, Any] = {"predicted": estimate(prediction)}
        self.state = prediction
        if z is not None:
            detection = Detection(column(z, self.angles), prediction.timestamp, measurement_model=self.sensor)
            seen = SingleHypothesis(prediction, detection)
            self.state = self.updater.update(seen)
            expected = seen.measurement_prediction
            mode.update(innovation_covariance=expected.covar, cross_covariance=expected.cross_covar)
            mode.update(predicted_measurement=np.asarray(expected.state_vector, dtype=float))
        mode["updated"] = estimate(self.state)
        return {"modes": [mode], "combined": mode["updated"]}


def column(values: Any, angles: Any) -> Any:
    return StateVector([Bearing(value) if is_angle else value for value, is_angle in zip(values, angles)])


def estimate(state: Any) -> dict[str, Any]:
    return {"mean": np.asarray(state.state_vector, dtype=float), "covariance": np.asarray(state.covar, dtype=float)}
