"""My filter under test: immaculate check -- python3 my_filter.py

MyFilter is a correct textbook interacting multiple model filter with Kalman filters. Replace it with your own: Immaculate sees only the parts
marked CHANGE HERE. It needs numpy.
"""

import json
import sys

import numpy as np

NAME = "my filter"  # CHANGE HERE
KINDS = ["kalman"]  # CHANGE HERE: which filters it has; `immaculate cases list` names them


class Skip(Exception):
    """Raised for a problem that the filter cannot do."""


class MyFilter:
    """CHANGE HERE: your filter, made from a problem."""

    def __init__(self, problem):
        # A single filter says here: if len(problem["modes"]) > 1: raise Skip("there is one mode only")
        self.F = [np.array(mode["F"], float) for mode in problem["modes"]]
        self.Q = [np.array(mode["Q"], float) for mode in problem["modes"]]
        self.H = np.array(problem["measurement"]["H"], float)
        self.R = np.array(problem["R"], float)
        self.transition = np.array(problem["transition"], float)  # transition[i, j]: from mode i to mode j
        self.x = [np.array(mode["mean"], float) for mode in problem["initial"]["modes"]]
        self.P = [np.array(mode["covariance"], float) for mode in problem["initial"]["modes"]]
        self.mu = np.array(problem["initial"]["mode_probabilities"], float)

    def step(self, z):
        """CHANGE HERE: one step of your filter; z is None without a detection.

        It returns your filter's values, from shown["combined"] alone to everything. The more it shows, the closer the verdict gets to the
        wrong line.
        """
        shown = {"modes": []}
        modes = range(len(self.F))
        c = self.transition.T @ self.mu
        shown["predicted_mode_probabilities"] = c
        x, P, log_likelihoods = [], [], np.zeros(len(c))

        for j in modes:  # mix
            # A mode that no mode leads to keeps its own estimate.
            weights = self.transition[:, j] * self.mu / c[j] if c[j] > 0 else np.eye(len(c))[j]
            mean, covariance = mixture(weights, self.x, self.P)
            shown["modes"].append({"mixing_probabilities": weights, "mixed": estimate(mean, covariance)})
            x.append(mean)
            P.append(covariance)

        for j in modes:  # predict
            x[j], P[j] = self.F[j] @ x[j], self.F[j] @ P[j] @ self.F[j].T + self.Q[j]
            shown["modes"][j]["predicted"] = estimate(x[j], P[j])
        shown["combined_prediction"] = estimate(*mixture(c, x, P))

        for j in modes:  # update
            if z is not None:
                innovation = z - self.H @ x[j]
                cross = P[j] @ self.H.T
                S = self.H @ cross + self.R
                gain = np.linalg.solve(S, cross.T).T
                log_likelihoods[j] = log_density(innovation, S)
                shown["modes"][j].update(
                    predicted_measurement=self.H @ x[j],
                    innovation=innovation,
                    innovation_covariance=S,
                    cross_covariance=cross,
                    gain=gain,
                    log_likelihood=log_likelihoods[j],
                    nis=innovation @ np.linalg.solve(S, innovation),
                )
                x[j] = x[j] + gain @ innovation
                P[j] = P[j] - gain @ S @ gain.T
                P[j] = (P[j] + P[j].T) / 2  # what is not symmetric is rounding, and would grow
            shown["modes"][j]["updated"] = estimate(x[j], P[j])

        # Weigh: in logarithms, for likelihoods may all be zero as doubles.
        self.x, self.P, self.mu = x, P, c
        if z is not None:
            weights = np.where(c > 0, c * np.exp(log_likelihoods - log_likelihoods[c > 0].max()), 0)
            self.mu = weights / weights.sum()
        shown["mode_probabilities"] = self.mu
        shown["combined"] = estimate(*mixture(self.mu, x, P))
        return shown


def mixture(weights, means, covariances):
    """Mean and covariance of a mixture, the spread of its means included."""
    mean = sum(w * m for w, m in zip(weights, means))
    return mean, sum(w * (C + np.outer(m - mean, m - mean)) for w, m, C in zip(weights, means, covariances))


def log_density(residual, covariance):
    """The logarithm of the Gaussian density."""
    _, log_determinant = np.linalg.slogdet(2 * np.pi * covariance)
    return -(residual @ np.linalg.solve(covariance, residual) + log_determinant) / 2


def estimate(mean, covariance):
    return {"mean": mean, "covariance": covariance}


# The rest talks to Immaculate and can stay as it is.


def main():
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "start":
            echo = np.array(message["echo"]["matrix"]) @ message["echo"]["vector"]
            reply = {"type": "ready", "name": NAME, "kinds": KINDS, "validates": False, "echo": echo}
        elif message["type"] == "run":
            reply = run(message["problem"])
        else:
            return
        print(json.dumps(reply, default=lambda value: value.tolist()), flush=True)


def run(problem):
    reply = {"type": "answer", "id": problem["id"], "steps": []}
    place = ""
    try:
        mine = MyFilter(problem)
        for entry in problem["measurements"]:
            place = f"step {entry['step']}: "
            z = None if entry["z"] is None else np.array(entry["z"], float)
            reply["steps"].append({"step": entry["step"], **mine.step(z)})
    except Skip as reason:
        return {"type": "skipped", "id": problem["id"], "reason": str(reason)}
    except Exception as error:
        reply["error"] = f"{place}{type(error).__name__}: {error}"
    return reply


if __name__ == "__main__":
    main()
