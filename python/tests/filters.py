"""Filters to be judged: an interacting multiple model filter of Kalman filters, one Kalman filter, and mistakes in them.

Neither shares a line with the crate. The equations are those of any textbook.
"""

import numpy as np


def predicted(x, P, F, Q, offset=None):
    return F @ x + (0 if offset is None else offset), F @ P @ F.T + Q


def updated(x, P, z, H, R):
    """Mean, covariance, and what the update goes through."""
    S = H @ P @ H.T + R
    K = P @ H.T @ np.linalg.inv(S)
    y = z - H @ x
    log_likelihood = -0.5 * (y @ np.linalg.solve(S, y) + np.linalg.slogdet(S)[1] + len(z) * np.log(2 * np.pi))
    between = {"predicted_measurement": H @ x, "innovation": y, "innovation_covariance": S, "cross_covariance": P @ H.T}
    return x + K @ y, P - K @ S @ K.T, {**between, "gain": K, "log_likelihood": log_likelihood}


def estimate(x, P):
    return {"mean": x, "covariance": P}


class Imm:
    """The whole cycle; it shows everything."""

    def __init__(self, problem):
        self.models = problem
        self.mu = problem.mode_probabilities
        self.estimates = list(zip(problem.means, problem.covariances))

    def change(self, step):
        self.models = step

    def mixture(self, weights, estimates):
        mean = sum(w * x for w, (x, _) in zip(weights, estimates))
        return mean, sum(w * (P + np.outer(x - mean, x - mean)) for w, (x, P) in zip(weights, estimates))

    mix = mixture

    def step(self, z):
        models, r = self.models, len(self.mu)
        c = models.transition.T @ self.mu
        # A mode that cannot be reached keeps its own estimate.
        weights = [models.transition[:, j] * self.mu / c[j] if c[j] > 0 else np.eye(r)[j] for j in range(r)]
        mixed = [self.mix(weight, self.estimates) for weight in weights]
        before = [predicted(x, P, mode.F, mode.Q, mode.offset) for (x, P), mode in zip(mixed, models.modes)]
        shown = [
            {"mixing_probabilities": w, "mixed": estimate(*m), "predicted": estimate(*p)}
            for w, m, p in zip(weights, mixed, before)
        ]
        after, mu = before, c
        if z is not None:
            results = [updated(x, P, z, models.H, models.R) for x, P in before]
            after = [(x, P) for x, P, _ in results]
            for mode, (_, _, between) in zip(shown, results):
                mode.update(between)
            logs = np.array([between["log_likelihood"] for _, _, between in results])
            mu = c * np.exp(logs - logs[c > 0].max())
            mu = mu / mu.sum()
        for mode, result in zip(shown, after):
            mode["updated"] = estimate(*result)
        self.mu, self.estimates = mu, after
        return {
            "predicted_mode_probabilities": c,
            "modes": shown,
            "combined_prediction": estimate(*self.mixture(c, before)),
            "mode_probabilities": mu,
            "combined": estimate(*self.mixture(mu, after)),
        }


class WithoutSpread(Imm):
    """The mixed covariances lack the spread of the means."""

    def mix(self, weights, estimates):
        mean, _ = self.mixture(weights, estimates)
        return mean, sum(w * P for w, (_, P) in zip(weights, estimates))


class Kalman:
    """One filter with columns, whose arrays are overwritten in place."""

    def __init__(self, problem):
        self.models = problem
        self.x, self.P = problem.means[0].reshape(-1, 1), problem.covariances[0]

    def change(self, step):
        self.models = step

    def predict(self):
        mode = self.models.modes[0]
        self.x[:, 0], self.P[:] = predicted(self.x[:, 0], self.P, mode.F, mode.Q, mode.offset)

    def update(self, z):
        x, P, _ = updated(self.x[:, 0], self.P, z, self.models.H, self.models.R)
        self.x[:, 0], self.P[:] = x, P


class WithoutNoise(Kalman):
    """The prediction forgets Q."""

    def predict(self):
        mode = self.models.modes[0]
        self.x[:, 0], self.P[:] = predicted(self.x[:, 0], self.P, mode.F, 0 * mode.Q, mode.offset)


#: An extended filter by formulas: the distance from a sensor beside the line, in steps of two lengths.
DISTANCE = {
    "format": "immaculate-problem/2",
    "id": "distance",
    "state": [["x", "m"], ["vx", "m/s"]],
    "parameters": {"T": 0.5, "q": 0.5},
    "f": ["x + T*vx", "vx - 0.1*sin(x)"],
    "Q": [["q*T^3/3", "q*T^2/2"], ["q*T^2/2", "q*T"]],
    "measurement": {"kind": "formulas", "z": ["distance"], "h": ["hypot(x, 3)"]},
    "R": [[0.01]],
    "filter": {"kind": "extended"},
    "initial": {"mean": [4, 1], "covariance": [[1, 0], [0, 1]]},
    "measurements": [{"step": 1, "z": [5.1]}, {"step": 2, "z": None, "T": 0.25}, {"step": 3, "z": [5.5], "R": [[0.04]]}],
}
