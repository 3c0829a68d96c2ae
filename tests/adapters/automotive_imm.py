#!/usr/bin/env python3
"""An IMM of two extended Kalman filters as it is written for a car, in plain numpy.

    immaculate check -- python3 tests/adapters/automotive_imm.py

The state is [x, vx, y, vy, w]. One mode drives straight on and keeps the turn rate w, the other
turns with it. A radar sees range, bearing and range rate, a lidar sees the position, and the steps
have different lengths. Motions, measurements and their Jacobians are written by hand; the numbers
are those of the problem. Problems with anything else in them are skipped.

    --mistake NAME    a planted mistake, one of MISTAKES; may be repeated
"""

import argparse
import json
import math
import sys

import numpy as np

MISTAKES = """
    motion-jacobian-transposed motion-jacobian-at-the-prediction motion-jacobian-last-column-omitted
    measurement-jacobian-at-the-mixed-mean bearing-jacobian-negated motion-by-jacobian
    measurement-by-jacobian motion-of-the-first-step process-noise-of-the-first-step
    innovation-not-wrapped mixed-spread-omitted transition-transposed determinant-omitted
    covariance-not-updated combined-spread-omitted
""".split()

# ------------------------------------------------------------------------------ the motions


def stumpff(a):
    """sin(a)/a, (1 - cos a)/a^2 and (a - sin a)/a^3, by their series where a is small or zero."""
    if abs(a) > 1:
        return np.sin(a) / a, (1 - np.cos(a)) / a**2, (a - np.sin(a)) / a**3
    return [sum((-a * a) ** i / math.factorial(2 * i + k) for i in range(10)) for k in (1, 2, 3)]


def straight(state, T):
    """Constant velocity: the next state and its Jacobian."""
    jacobian = np.eye(5)
    jacobian[0, 1] = jacobian[2, 3] = T
    return jacobian @ state, jacobian


def turn(state, T):
    """A coordinated turn by the angle a = w T: the next state and its Jacobian."""
    _, vx, _, vy, w = state
    a = w * T
    c1, c2, c3 = stumpff(a)
    along, across = T * c1, T * a * c2  # sin(a)/w and (1 - cos a)/w
    sine, cosine = np.sin(a), np.cos(a)
    matrix = [
        [1, along, 0, -across, 0],
        [0, cosine, 0, -sine, 0],
        [0, across, 1, along, 0],
        [0, sine, 0, cosine, 0],
        [0, 0, 0, 0, 1],
    ]
    along_by_w, across_by_w = T**2 * a * (c3 - c2), T**2 * (c1 - c2)
    jacobian = np.array(matrix)
    jacobian[0, 4] = along_by_w * vx - across_by_w * vy
    jacobian[1, 4] = -T * (sine * vx + cosine * vy)
    jacobian[2, 4] = across_by_w * vx + along_by_w * vy
    jacobian[3, 4] = T * (cosine * vx - sine * vy)
    return np.array(matrix) @ state, jacobian


def process_noise(q, qw, T):
    """White acceleration along both axes, and a random walk of the turn rate."""
    noise = np.zeros((5, 5))
    noise[:2, :2] = noise[2:4, 2:4] = q * np.array([[T**3 / 3, T**2 / 2], [T**2 / 2, T]])
    noise[4, 4] = qw * T
    return noise


# ------------------------------------------------------------------------------ the sensors


def radar(state, place):
    """Range, bearing and range rate as seen from a place that may move, and their Jacobian."""
    dx, dy, ux, uy = state[[0, 2, 1, 3]] - place
    r = np.hypot(dx, dy)
    rate = (dx * ux + dy * uy) / r
    jacobian = [
        [dx / r, 0, dy / r, 0, 0],
        [-dy / r**2, 0, dx / r**2, 0, 0],
        [(ux - rate * dx / r) / r, dx / r, (uy - rate * dy / r) / r, dy / r, 0],
    ]
    return np.array([r, np.arctan2(dy, dx), rate]), np.array(jacobian)


def lidar(state, H):
    """Entries of the state as they are, and their Jacobian."""
    return H @ state, H


def wrapped(angle):
    """The same angle in (-pi, pi]."""
    return angle - 2 * math.pi * np.ceil((angle - math.pi) / (2 * math.pi))


# ------------------------------------------------------------------------------- the filter


class Imm:
    """Modes of extended Kalman filters with one chain; a step returns all that it computes."""

    def __init__(self, problem, mistakes):
        self.wrong = mistakes
        self.motions = [MOTIONS[mode["motion"]["model"]] for mode in problem["modes"]]
        self.densities = [densities_of(problem, mode) for mode in problem["modes"]]
        self.chain = np.array(problem["transition"])  # chain[i, j] = P(mode j now | i before)
        if "transition-transposed" in self.wrong:
            self.chain = self.chain.T
        self.probabilities = np.array(problem["initial"]["mode_probabilities"])
        self.estimates = [
            {"mean": np.array(mode["mean"]), "covariance": np.array(mode["covariance"])}
            for mode in problem["initial"]["modes"]
        ]
        self.first_T = None

    def step(self, z, T, sensor, R):
        """One step of length T; z is what the sensor sees, None without a detection."""
        self.first_T = self.first_T or T
        predicted = probabilities = self.probabilities @ self.chain
        modes = [self.predict(j, predicted[j], T) for j in range(len(predicted))]
        if z is not None:
            for mode in modes:
                self.update(mode, z, sensor, R)
            logs = np.log(predicted) + [mode["log_likelihood"] for mode in modes]
            weights = np.exp(logs - np.max(logs))
            probabilities = weights / np.sum(weights)
        self.probabilities = probabilities
        self.estimates = [mode["updated"] for mode in modes]
        no_spread = "combined-spread-omitted" in self.wrong
        return {
            "predicted_mode_probabilities": predicted,
            "modes": modes,
            "combined_prediction": mixture(predicted, [mode["predicted"] for mode in modes]),
            "mode_probabilities": probabilities,
            "combined": mixture(probabilities, self.estimates, no_spread),
        }

    def predict(self, j, probability, T):
        """Mixes for mode j, and predicts by its motion and the Jacobian of that."""
        mixing = np.eye(len(self.estimates))[j]  # what cannot be reached keeps its own estimate
        if probability > 0:
            mixing = self.chain[:, j] * self.probabilities / probability
        mixed = mixture(mixing, self.estimates, "mixed-spread-omitted" in self.wrong)
        motion_T = self.first_T if "motion-of-the-first-step" in self.wrong else T
        noise_T = self.first_T if "process-noise-of-the-first-step" in self.wrong else T
        mean, F = self.motions[j](mixed["mean"], motion_T)
        if "motion-jacobian-at-the-prediction" in self.wrong:
            _, F = self.motions[j](mean, motion_T)
        if "motion-jacobian-last-column-omitted" in self.wrong:
            F[:4, 4] = 0
        if "motion-jacobian-transposed" in self.wrong:
            F = F.T
        if "motion-by-jacobian" in self.wrong:
            mean = F @ mixed["mean"]
        P = F @ mixed["covariance"] @ F.T + process_noise(*self.densities[j], noise_T)
        return {
            "mixing_probabilities": mixing,
            "mixed": mixed,
            "motion_jacobian": F,
            "predicted": {"mean": mean, "covariance": P},
            "updated": {"mean": mean, "covariance": P},  # until there is a measurement
        }

    def update(self, mode, z, sensor, R):
        """Adds to a mode what the measurement tells it."""
        x, P = mode["predicted"].values()
        measure, parameters = sensor
        expected, H = measure(x, parameters)
        if "measurement-jacobian-at-the-mixed-mean" in self.wrong:
            _, H = measure(mode["mixed"]["mean"], parameters)
        if "bearing-jacobian-negated" in self.wrong and measure is radar:
            H[1] = -H[1]
        if "measurement-by-jacobian" in self.wrong:
            expected = H @ x
        innovation = z - expected
        if "innovation-not-wrapped" not in self.wrong and measure is radar:
            innovation[1] = wrapped(innovation[1])
        cross = P @ H.T
        S = H @ cross + R
        gain = np.linalg.solve(S, cross.T).T
        nis = innovation @ np.linalg.solve(S, innovation)
        log_likelihood = -nis / 2 - len(z) * math.log(2 * math.pi) / 2
        if "determinant-omitted" not in self.wrong:
            log_likelihood -= np.linalg.slogdet(S)[1] / 2
        updated = P if "covariance-not-updated" in self.wrong else P - gain @ S @ gain.T
        mode.update(
            predicted_measurement=expected,
            innovation=innovation,
            measurement_jacobian=H,
            innovation_covariance=S,
            cross_covariance=cross,
            gain=gain,
            updated={"mean": x + gain @ innovation, "covariance": updated},
            log_likelihood=log_likelihood,
            nis=nis,
        )


def mixture(weights, estimates, spread_omitted=False):
    """The mean of a mixture, and its covariance with the spread of the means."""
    mean = sum(w * part["mean"] for w, part in zip(weights, estimates))
    covariance = np.zeros((5, 5))
    for w, part in zip(weights, estimates):
        spread = 0 if spread_omitted else np.outer(part["mean"] - mean, part["mean"] - mean)
        covariance += w * (part["covariance"] + spread)
    return {"mean": mean, "covariance": covariance}


# ------------------------------------------------------------------------------ the adapter

MOTIONS = {"constant-velocity": straight, "coordinated-turn-unknown-rate": turn}
KNOWN_MOTIONS = [
    {"model": "constant-velocity", "others": "keep"},
    {"model": "coordinated-turn-unknown-rate"},
]
KNOWN_CONVENTIONS = {"first_step": "mixed", "log_likelihood": "full"}
KNOWN_NOISE = [
    ["q*T^3/3", "q*T^2/2", "0.0", "0.0", "0.0"],
    ["q*T^2/2", "q*T", "0.0", "0.0", "0.0"],
    ["0.0", "0.0", "q*T^3/3", "q*T^2/2", "0.0"],
    ["0.0", "0.0", "q*T^2/2", "q*T", "0.0"],
    ["0.0", "0.0", "0.0", "0.0", "qw*T"],
]


def main():
    """Answers one message a line until `stop`."""
    parser = argparse.ArgumentParser(description="an automotive IMM under test")
    parser.add_argument("--mistake", action="append", default=[], choices=MISTAKES)
    mistakes = parser.parse_args().mistake
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "start":
            reply = ready(message["echo"], mistakes)
        elif message["type"] == "run":
            reply = run(message["problem"], mistakes)
        else:
            break
        print(json.dumps(reply, default=lambda value: value.tolist()), flush=True)


def ready(echo, mistakes):
    """Says what is under test."""
    return {
        "type": "ready",
        "name": "automotive example" + (" with " + " and ".join(mistakes) if mistakes else ""),
        "kinds": ["extended"],
        "formats": ["immaculate-problem/1", "immaculate-problem/2"],
        "validates": False,
        "echo": np.array(echo["matrix"]) @ np.array(echo["vector"]),
    }


def run(problem, mistakes):
    """Runs a problem as far as it goes."""
    reason = unknown(problem)
    if reason:
        return {"type": "skipped", "id": problem["id"], "reason": reason}
    sensors = {None: (sensor_of(problem["measurement"]), problem["R"])}
    for further in problem.get("sensors", []):
        sensors[further["name"]] = sensor_of(further["measurement"]), further["R"]
    imm = Imm(problem, mistakes)
    answer = {"type": "answer", "id": problem["id"], "steps": []}
    try:
        for entry in problem["measurements"]:
            sensor, R = sensors[entry.get("sensor")]
            T = entry["T"] if "T" in entry else problem["parameters"]["T"]
            step = imm.step(entry["z"], T, sensor, np.array(entry.get("R", R)))
            answer["steps"].append({"step": entry["step"], **step})
    except np.linalg.LinAlgError as error:
        answer["error"] = f"step {entry['step']}: {error}"
    return answer


def densities_of(problem, mode):
    """q and qw of a mode, its own or the problem's."""
    parameters = {**problem.get("parameters", {}), **mode.get("parameters", {})}
    return parameters.get("q"), parameters.get("qw")


def sensor_of(measurement):
    """A sensor: its function, and what that takes beside the state."""
    if measurement["kind"] == "linear":
        return lidar, np.array(measurement["H"])
    names = ("sensor_x", "sensor_y", "sensor_vx", "sensor_vy")
    return radar, np.array([measurement.get("parameters", {}).get(name, 0) for name in names])


def unknown(problem):
    """What a problem has that is not known here, or None."""
    names = [entry if isinstance(entry, str) else entry[0] for entry in problem["state"]]
    modes = problem["modes"]
    seen = [sensor["measurement"] for sensor in [problem, *problem.get("sensors", [])]]
    known = {
        "another state": names == ["x", "vx", "y", "vy", "w"],
        "another motion": all(mode.get("motion") in KNOWN_MOTIONS for mode in modes),
        "another Q": all(
            mode["Q"] == KNOWN_NOISE and None not in densities_of(problem, mode) for mode in modes
        ),
        "another measurement": all(
            "H" in one or one.get("model") == "range-bearing-range-rate" for one in seen
        ),
        "steps with matrices of their own": all(
            set(entry) <= {"step", "z", "T", "sensor", "R"} for entry in problem["measurements"]
        ),
        "another convention": KNOWN_CONVENTIONS.items() <= problem["conventions"].items(),
    }
    return next((reason for reason, is_known in known.items() if not is_known), None)


if __name__ == "__main__":
    np.seterr(all="ignore")  # a filter with a mistake may run away
    main()
