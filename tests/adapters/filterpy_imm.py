#!/usr/bin/env python3
"""FilterPy's IMM under test: its own classes, as their documentation uses them.

    immaculate check -- python3 tests/adapters/filterpy_imm.py kalman
    immaculate check -- python3 tests/adapters/filterpy_imm.py extended
    immaculate check -- python3 tests/adapters/filterpy_imm.py unscented
    immaculate check -- python3 tests/adapters/filterpy_imm.py cubature-3

Nothing is computed here that FilterPy computes, and whatever its classes let a user see is shown.
Where a function must be supplied (the mean and the difference of measurements with a bearing) it
is the one of FilterPy's documentation; motions, measurements and their Jacobians of extended filters
are those of numpy_imm.py.

    problem             FilterPy
    one mode            the mode's filter alone
    several modes       kalman.IMMEstimator over the modes' filters
    kalman              kalman.KalmanFilter
    extended            kalman.ExtendedKalmanFilter, with predict_x overridden as its documentation
                        says; its functions are bound, since IMMEstimator calls update(z)
    unscented           kalman.UnscentedKalmanFilter; its points are JulierSigmaPoints where
                        alpha = 1 and beta = 0, MerweScaledSigmaPoints elsewhere
    cubature-3          kalman.CubatureKalmanFilter
    converted           not asked for: FilterPy converts no measurements
    no detection        update(None)
    another F, Q, R     set before the step, for extended filters alone; another transition likewise
    missing entries     z, h, H and R without their rows, for extended filters alone

The unscented filter averages bearings as vectors, which is declared; the cubature filter takes the
function for it and does not use it. So each has a verdict of its own.

With --transition-as-documented the transition matrix is as IMMEstimator's documentation describes
it, and not as its code reads it. With --as-it-is the extended filters of an IMM are
ExtendedKalmanFilter itself, of which IMMEstimator can call neither predict nor update.
"""

import json
import math
import sys
from types import SimpleNamespace

import filterpy
import numpy as np
from filterpy.kalman import (
    CubatureKalmanFilter,
    ExtendedKalmanFilter,
    IMMEstimator,
    JulierSigmaPoints,
    KalmanFilter,
    MerweScaledSigmaPoints,
    UnscentedKalmanFilter,
)

import numpy_imm

# ---------------------------------------------------------------------------- the protocol


def main():
    """Answers one message a line until `stop`."""
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "start":
            reply = ready(message["echo"])
        elif message["type"] == "run":
            reply = run(message["problem"])
        else:
            break
        print(json.dumps(reply), flush=True)


def ready(echo):
    """Says what is under test."""
    return {
        "type": "ready",
        "name": f"FilterPy {filterpy.__version__}",  # CHANGE HERE
        "conventions": {"angle_mean": "vector"} if "unscented" in sys.argv else {},
        "kinds": [kind for kind in KINDS if kind in sys.argv],
        "formats": ["immaculate-problem/1", "immaculate-problem/2"][: 1 + ("extended" in sys.argv)],
        "validates": False,
        "echo": np.dot(echo["matrix"], echo["vector"]).tolist(),
    }


KINDS = ("kalman", "extended", "unscented", "cubature-3")


def run(problem):
    """Runs a problem as far as it goes."""
    answer = {"type": "answer", "id": problem["id"], "steps": []}
    if any("motion" in mode for mode in problem["modes"]):
        return numpy_imm.skipped(problem, "there are no named models here; formulas are")
    if "conversions" in problem:
        return numpy_imm.skipped(problem, "all modes have one state here")
    try:
        filters = [filter_of(problem, j) for j in range(len(problem["modes"]))]  # CHANGE HERE
        imm = imm_of(problem, filters) if len(filters) > 1 else None
        for entry in problem["measurements"]:
            if "extended" in sys.argv:
                give_models(problem, entry, filters, imm)
            answer["steps"].append(step(entry, filters, imm))
    except Exception as error:  # whatever the library raises is its answer
        answer["error"] = f"step {len(answer['steps']) + 1}: {type(error).__name__}: {error}"
    return answer


# ----------------------------------------------------------------------------- the mapping


def step(entry, filters, imm):
    """One step of the library, and what it lets us see. CHANGE HERE."""
    shown = {"step": entry["step"], "modes": [{} for _ in filters]}
    z = None
    if entry["z"] is not None:
        there = [value for value in entry["z"] if value is not None]
        z = np.array(there).reshape(column(filters[0], -1))
    if imm is None:
        filters[0].predict()
        filters[0].update(z)
        shown["combined"] = estimate(filters[0].x_post, filters[0].P_post)
    else:
        shown["predicted_mode_probabilities"] = imm.cbar.tolist()
        for mode, weights in zip(shown["modes"], imm.omega.T):
            mode["mixing_probabilities"] = weights.tolist()
        imm.predict()
        shown["combined_prediction"] = estimate(imm.x_prior, imm.P_prior)
        imm.update(z)
        shown["mode_probabilities"] = imm.mu.tolist()
        shown["combined"] = estimate(imm.x_post, imm.P_post)
    for mode, kf in zip(shown["modes"], filters):
        mode["predicted"] = estimate(kf.x_prior, kf.P_prior)
        mode["updated"] = estimate(kf.x_post, kf.P_post)
        if isinstance(kf, Extended):
            mode["motion_jacobian"] = kf.F.tolist()
        if z is not None:
            mode["innovation"] = kf.y.tolist()
            mode["innovation_covariance"] = kf.S.tolist()
            mode["gain"] = kf.K.tolist()
            mode["log_likelihood"] = float(kf.log_likelihood)
    return shown


def estimate(mean, covariance):
    """Mean and covariance as an object of lists."""
    return {"mean": mean.tolist(), "covariance": covariance.tolist()}


def column(kf, length):
    """The shape of a vector: the unscented filter has flat ones, the others columns."""
    return (length,) if isinstance(kf, UnscentedKalmanFilter) else (length, 1)


def imm_of(problem, filters):
    """The IMM over the modes' filters.

    Its documentation has M[i, j] from j to i; its code has it from i to j, and that is used.
    """
    transition = np.array(problem["transition"])
    if "--transition-as-documented" in sys.argv:
        transition = transition.T
    return IMMEstimator(filters, problem["initial"]["mode_probabilities"], transition)


class Extended(ExtendedKalmanFilter):
    """ExtendedKalmanFilter with the functions of its models."""

    def predict_x(self, u=0):
        mean = self.x[:, 0]
        self.F = self.motion.slope(mean)
        self.x = self.motion.of(mean)[:, None]

    def update(self, z):
        measurement = self.measurement
        super().update(
            z,
            HJacobian=lambda x: measurement.slope(x[:, 0]),
            Hx=lambda x: measurement.of_states(x.T).T,
            residual=lambda a, b: measurement.difference(a[:, 0], b[:, 0])[:, None],
        )


def give_models(problem, entry, filters, imm):
    """The models of a step."""
    options = SimpleNamespace(single=False, conventions={})
    models = numpy_imm.step_arguments(problem, entry, options)
    for j, kf in enumerate(filters):
        kf.motion, kf.measurement = models["motions"][j], models["measurement"]
        kf.Q, kf.R = models["process_noises"][j], models["measurement_noise"]
    if imm is not None:
        imm.M = models["chain"]


def filter_of(problem, j):
    """The filter of a mode, by the problem's kind."""
    mode, initial = problem["modes"][j], problem["initial"]["modes"][j]
    n, m = len(problem["state"]), len(problem["R"])
    kind = problem["filter"]["kind"]
    if kind == "extended":
        several = len(problem["modes"]) > 1
        bare = "--as-it-is" in sys.argv and several
        kf = (ExtendedKalmanFilter if bare else Extended)(dim_x=n, dim_z=m)
    elif kind == "kalman":
        kf = KalmanFilter(dim_x=n, dim_z=m)
        kf.F = np.array(mode["F"])
        kf.H = np.array(problem["measurement"]["H"])
    else:
        transition = np.array(mode["F"])
        functions = functions_of(problem["measurement"])
        functions.update(dim_x=n, dim_z=m, dt=1.0, fx=lambda x, dt: transition @ x)
        if kind == "unscented":
            kf = UnscentedKalmanFilter(points=points_of(problem["filter"], n), **functions)
        else:
            kf = CubatureKalmanFilter(**functions)
    if kind != "extended":  # it is given its noises in every step
        kf.Q = np.array(mode["Q"])
        kf.R = np.array(problem["R"])
    kf.x = np.array(initial["mean"], dtype=float).reshape(column(kf, n))
    kf.P = np.array(initial["covariance"], dtype=float)
    return kf


def points_of(parameters, n):
    """The points of the unscented filter."""
    alpha, beta, kappa = parameters["alpha"], parameters["beta"], parameters["kappa"]
    if alpha == 1 and beta == 0:
        return JulierSigmaPoints(n, kappa=kappa)
    return MerweScaledSigmaPoints(n, alpha=alpha, beta=beta, kappa=kappa)


def functions_of(measurement):
    """hx, and the mean and difference of bearings as FilterPy's documentation has them."""
    if measurement["kind"] == "linear":
        matrix = np.array(measurement["H"])
        return {"hx": lambda x: matrix @ x}
    components, position, sensor = (
        measurement["components"],
        measurement["position"],
        measurement["sensor"],
    )

    def hx(x):
        dx, dy = x[position[0]] - sensor[0], x[position[1]] - sensor[1]
        values = {"range": math.sqrt(dx**2 + dy**2), "bearing": math.atan2(dy, dx)}
        return np.array([values[name] for name in components])

    def z_mean(sigmas, weights):
        mean = np.zeros(len(components))
        for row, name in enumerate(components):
            if name == "range":
                mean[row] = np.dot(weights, sigmas[:, row])
            else:
                sum_sin = np.dot(weights, np.sin(sigmas[:, row]))
                sum_cos = np.dot(weights, np.cos(sigmas[:, row]))
                mean[row] = math.atan2(sum_sin, sum_cos)
        return mean

    def residual_z(a, b):
        y = np.subtract(a, b)
        for row, name in enumerate(components):
            if name == "bearing":
                y[row] = (y[row] + math.pi) % (2 * math.pi) - math.pi
        return y

    return {"hx": hx, "z_mean_fn": z_mean, "residual_z": residual_z}


if __name__ == "__main__":
    np.seterr(all="ignore")
    main()
