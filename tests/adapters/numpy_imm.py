#!/usr/bin/env python3
"""A complete IMM filter in numpy, and the adapter through which `immaculate check` speaks with it.

    immaculate check -- python3 tests/adapters/numpy_imm.py

The first half is the adapter: the protocol, and the mapping between the problem's JSON and the
filter's arguments. To check a filter of your own, keep it and change the lines marked CHANGE HERE.
The second half is the filter, which knows nothing of the protocol.

Options, to see what the verdicts look like:

    --show everything|posteriors|combined    how much of a step is shown
    --form gain|joseph|inverse|information   other algebra for the same exact values
    --single                                 all arithmetic in single precision
    --convention KEY=VALUE                   another convention, declared (see spec/formats.md);
                                             there is no other unequal_dimensions, state_angle_mean
                                             and converted_covariance here
    --mistake NAME                           a planted mistake (numpy_mistakes.py); may be repeated
"""

import argparse
import json
import math
import sys
from dataclasses import dataclass, field, replace

import numpy as np

# --------------------------------------------------------------- the adapter: the protocol


def main():
    """Answers one message a line until `stop`."""
    options = parse_options()
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "start":
            reply = ready(message, options)
        elif message["type"] == "run":
            reply = run(message["problem"], options)
        else:
            break
        print(json.dumps(reply), flush=True)


def ready(message, options):
    """Says what is under test."""
    echo = message["echo"]
    return {
        "type": "ready",
        "name": (
            "numpy example"
            if not options.mistake
            else "numpy example with " + " and ".join(options.mistake)
        ),  # CHANGE HERE
        "precision": "single" if options.single else "double",
        "conventions": options.conventions,
        "formats": ["immaculate-problem/1", "immaculate-problem/2"],
        "kinds": [
            *["kalman", "extended", "unscented", "converted", *RULES],
            *["state-conversion", "continuous-chain", "gpb1", "unmixed"],
        ],
        "echo": (np.array(echo["matrix"]) @ np.array(echo["vector"])).tolist(),
    }


# ---------------------------------------------------------------- the adapter: the mapping


def run(problem, options):
    """Runs a problem as far as it goes."""
    answer = {"type": "answer", "id": problem["id"], "steps": []}
    reason = not_here(problem)
    if reason:
        return skipped(problem, reason)
    try:
        if problem["format"] == "immaculate-problem/1":
            check_problem(problem)
        arguments = arguments_of(problem, options)
    except Rejected as rejected:
        return {
            "type": "rejected",
            "id": problem["id"],
            "class": rejected.reason_class,
            "reason": str(rejected),
        }
    try:
        imm = filter_class(options)(**arguments)  # CHANGE HERE: make your filter
        for entry in problem["measurements"]:
            imm.given(**step_arguments(problem, entry, options))
            z = None if entry["z"] is None else np.array(entry["z"], float)
            if z is not None:
                z = z[~np.isnan(z)].astype(arguments["number"])
            step = imm.step(z)  # CHANGE HERE: one step of your filter
            answer["steps"].append(shown(entry["step"], step, options.show))
    except (np.linalg.LinAlgError, ValueError) as error:
        if options.form == "information" and "Singular" in str(error):
            return skipped(problem, "the information form needs covariances with an inverse")
        answer["error"] = f"step {len(answer['steps']) + 1}: {error}"
    return answer


def not_here(problem):
    """What the filter below does not have; None if it has everything."""
    if problem["filter"]["kind"] == "fixed-gain":
        return "there are no fixed gains here"
    if any("filter" in mode for mode in problem["modes"]):
        return "there is one filter for all modes here"
    if any("motion" in mode or isinstance(mode["Q"], dict) for mode in problem["modes"]):
        return "there are no named models here; formulas are"
    return None


def skipped(problem, reason):
    """No answer, and why."""
    return {"type": "skipped", "id": problem["id"], "reason": reason}


def arguments_of(problem, options):
    """The problem as the arguments of the filter below. CHANGE HERE: as the arguments of yours."""
    number = np.float32 if options.single else np.float64
    has_points = problem["filter"]["kind"] in ("cubature", "unscented")
    points = rule(problem["filter"], len(problem["state"])) if has_points else None
    return {
        "mode_probabilities": np.array(problem["initial"]["mode_probabilities"], number),
        "means": [np.array(estimate["mean"], number) for estimate in problem["initial"]["modes"]],
        "covariances": [
            np.array(estimate["covariance"], number) for estimate in problem["initial"]["modes"]
        ],
        "rule": points and tuple(part.astype(number) for part in points),
        "square_root": SQUARE_ROOTS[options.conventions.get("square_root", "cholesky-lower")],
        "interaction": problem.get("interaction", "imm"),
        "first_step": options.conventions.get("first_step", "mixed"),
        "has_two_pi": options.conventions.get("log_likelihood", "full") == "full",
        "linearises": problem["filter"]["kind"] == "extended",
        "number": number,
    }


def step_arguments(problem, entry, options):
    """What may be another in each step: models, noises, chain. In format 1 it never is."""
    number = np.float32 if options.single else np.float64
    names, angles = names_and_angles(problem["state"])
    of_modes = [names_and_angles(mode.get("state", problem["state"])) for mode in problem["modes"]]
    others = {sensor["name"]: sensor for sensor in problem.get("sensors", [])}
    sensor = others[entry["sensor"]] if "sensor" in entry else problem
    parameters = {**sensor["measurement"], **({"H": entry["H"]} if "H" in entry else {})}
    known = dict(problem.get("parameters", {}))
    if "T" in entry:
        known["T"] = entry["T"]
    noise = np.array(entry.get("R", sensor["R"]), number)
    conversion = None
    if problem["filter"]["kind"] == "converted":
        conversion = Conversion.of(problem["filter"], parameters, noise)
        measurement = Measurement.of_position(parameters, len(names), number)
    else:
        angle_mean = options.conventions.get("angle_mean", "centre-point")
        formulas = Formulas(names, known, problem.get("let", []), parameters.get("h", []))
        measurement = Measurement.of(parameters, formulas, number, angle_mean)
    there = [row for row, value in enumerate(entry["z"] or []) if value is not None]
    if there and len(there) < len(noise):
        measurement, noise = measurement.only(there), noise[np.ix_(there, there)]
    motions, process_noises = [], []
    for j, mode in enumerate(problem["modes"]):
        of_mode, (own, _) = {**known, **mode.get("parameters", {})}, of_modes[j]
        definitions = problem.get("let", []) + mode.get("let", [])
        if "f" in mode and "F" not in entry:
            motions.append(Motion(formulas=Formulas(own, of_mode, definitions, mode["f"])))
        else:
            matrix = entry["F"][j] if "F" in entry else mode["F"]
            motions.append(Motion(matrix=np.array(matrix, number)))
        rows = entry["Q"][j] if "Q" in entry else noise_of(mode, own, of_mode, definitions)
        process_noises.append(np.array(rows, number))
    return {
        "motions": motions,
        "process_noises": process_noises,
        "measurement": measurement,
        "measurement_noise": noise,
        "conversion": conversion,
        **chain_of(problem, entry, known.get("T"), number),
        "angles": [*(own for _, own in of_modes), angles],
        "reads": reads_of(problem, [own for own, _ in of_modes], known, number),
    }


def chain_of(problem, entry, interval, number):
    """The chain of a step: a matrix, or rates or mean sojourn times with the length of the step."""
    matrix = entry.get("transition", problem.get("transition"))
    given = {key: problem.get(key) for key in ("rates", "sojourn_times", "jumps")}
    given = {key: None if value is None else np.array(value, number) for key, value in given.items()}
    chain = None if matrix is None else np.array(matrix, number)
    return {"chain": chain, **given, "interval": interval}


def names_and_angles(state):
    """The names of a state's entries, and which of them are angles."""
    entries = [entry if isinstance(entry, list) else [entry] for entry in state]
    return [entry[0] for entry in entries], np.array(["angle" in entry[2:] for entry in entries])


def reads_of(problem, names, known, number):
    """How each mode is read by each other one, and by the combined estimates, which are last."""
    modes = [mode["name"] for mode in problem["modes"]]
    n, reads = len(problem["state"]), {}
    for asked in problem.get("conversions", []):
        i, j = modes.index(asked["from"]), modes.index(asked["to"]) if "to" in asked else len(modes)
        matrix, texts = asked.get("matrix"), asked.get("formulas")
        formulas = texts and Formulas(names[i], known, problem.get("let", []), texts)
        function = Motion(matrix and np.array(matrix, number), formulas)
        reads[i, j] = function, np.array(asked.get("added", np.zeros((n, n))), number)
    return reads


def noise_of(mode, names, known, definitions):
    """Q, which may have formulas; they do not know the state."""
    n = len(names)
    texts = [str(value) for row in mode["Q"] for value in row]
    return Formulas(names, known, definitions, texts).of(np.full(n, np.nan)).reshape(n, n)


def shown(number, step, show):
    """A step of the filter as a step of the trace. CHANGE HERE: whatever your filter can show."""
    listed = {"step": number, "combined": estimate(step.combined)}
    if show != "combined":
        listed["mode_probabilities"] = step.mode_probabilities.tolist()
        listed["modes"] = [{"updated": estimate(mode.updated)} for mode in step.modes]
    if show == "everything":
        listed["predicted_mode_probabilities"] = step.predicted_mode_probabilities.tolist()
        listed["combined_prediction"] = estimate(step.combined_prediction)
        if step.converted_measurement is not None:
            listed["converted_measurement"] = step.converted_measurement.tolist()
            listed["converted_covariance"] = step.converted_covariance.tolist()
        for mode, values in zip(listed["modes"], step.modes):
            mode["mixing_probabilities"] = values.mixing_probabilities.tolist()
            mode["mixed"] = estimate(values.mixed)
            mode["predicted"] = estimate(values.predicted)
            names = ["motion_jacobian"] + (MEASURED if values.innovation is not None else [])
            for name in names:
                if getattr(values, name) is not None:
                    mode[name] = getattr(values, name).tolist()
    return listed


MEASURED = [
    "predicted_measurement",
    "innovation",
    "measurement_jacobian",
    "innovation_covariance",
    "cross_covariance",
    "gain",
    "log_likelihood",
    "nis",
]


def estimate(gaussian):
    """Mean and covariance as an object of lists."""
    mean, covariance = gaussian
    return {"mean": mean.tolist(), "covariance": covariance.tolist()}


# --------------------------------------------------- the filter: what it is given, checked


class Rejected(Exception):
    """A problem that must not be run."""

    def __init__(self, reason_class, reason):
        super().__init__(reason)
        self.reason_class = reason_class


def check_problem(problem):
    """Refuses what the filter cannot be given, in the classes of spec/formats.md."""
    n, m, r = len(problem["state"]), len(problem["R"]), len(problem["modes"])
    check_shapes(problem, n, m, r)
    for i, row in enumerate(problem["transition"]):
        check_probabilities(f"transition[{i}]", row)
    check_probabilities("initial.mode_probabilities", problem["initial"]["mode_probabilities"])
    for j, mode in enumerate(problem["modes"]):
        check_covariance(f"modes[{j}].Q", mode["Q"])
    check_covariance("R", problem["R"])
    for j, initial in enumerate(problem["initial"]["modes"]):
        check_covariance(f"initial.modes[{j}].covariance", initial["covariance"])
    check_names(problem, n)
    check_ranges_and_bearings(problem)


def check_shapes(problem, n, m, r):
    """Every list has the length that it must have."""
    shapes = {"R": (problem["R"], (m, m)), "transition": (problem["transition"], (r, r))}
    shapes["initial.mode_probabilities"] = (problem["initial"]["mode_probabilities"], (r,))
    for j, mode in enumerate(problem["modes"]):
        shapes[f"modes[{j}].F"] = (mode["F"], (n, n))
        shapes[f"modes[{j}].Q"] = (mode["Q"], (n, n))
    for j, initial in enumerate(problem["initial"]["modes"]):
        shapes[f"initial.modes[{j}].mean"] = (initial["mean"], (n,))
        shapes[f"initial.modes[{j}].covariance"] = (initial["covariance"], (n, n))
    if problem["measurement"]["kind"] == "linear":
        shapes["measurement.H"] = (problem["measurement"]["H"], (m, n))
    for k, entry in enumerate(problem["measurements"]):
        if entry["step"] != k + 1:
            raise Rejected("shape", f"measurements[{k}].step is {entry['step']}, not {k + 1}")
        if entry["z"] is not None:
            shapes[f"measurements[{k}].z"] = (entry["z"], (m,))
    if r == 0 or len(problem["initial"]["modes"]) != r:
        raise Rejected(
            "shape", f"{r} modes and {len(problem['initial']['modes'])} initial estimates"
        )
    for place, (values, shape) in shapes.items():
        try:
            found = np.array(values, float)
        except ValueError as ragged:
            raise Rejected("shape", f"{place} has rows of different lengths") from ragged
        if found.shape != shape:
            raise Rejected("shape", f"{place} is {found.shape}, not {shape}")
        if not np.all(np.isfinite(found)):
            raise Rejected("not-finite", f"{place} has an entry that is not finite")


def check_probabilities(place, values):
    """None is negative, and they sum to one as well as decimals of 15 digits can."""
    if min(values) < 0 or abs(math.fsum(values) - 1) > 1e-15 * len(values) + 1e-16:
        raise Rejected("not-a-probability", f"{place} is {values}")


def check_covariance(place, rows):
    """Symmetric, and positive semidefinite."""
    matrix = np.array(rows, float)
    if not np.array_equal(matrix, matrix.T):
        raise Rejected("not-symmetric", f"{place} is not symmetric")
    # In units of its own diagonal, so that metres and radians count alike.
    deviations = np.sqrt(np.maximum(np.diag(matrix), 0))
    units = np.where(deviations > 0, deviations, 1)
    least = np.linalg.eigvalsh(matrix / np.outer(units, units))[0]
    if least < -1e-14 * len(matrix):
        raise Rejected(
            "not-positive-definite", f"{place} has the eigenvalue {least} in units of its diagonal"
        )


def check_names(problem, n):
    """Filter, measurement and conventions are known ones."""
    known = {
        "square_root": "cholesky-lower",
        "angle_mean": "centre-point",
        "first_step": "mixed",
        "log_likelihood": "full",
        "unequal_dimensions": "embedded",
        "converted_covariance": "at-measurement",
    }
    for key, value in problem["conventions"].items():
        if known.get(key) != value:
            raise Rejected("unknown", f"conventions.{key} is {value}")
    measurement = problem["measurement"]
    if measurement["kind"] not in ("linear", "range-bearing"):
        raise Rejected("unknown", f"measurement {measurement['kind']}")
    if measurement["kind"] == "range-bearing":
        if any(name not in ("range", "bearing") for name in measurement["components"]):
            raise Rejected("unknown", f"components {measurement['components']}")
        if (
            len(measurement["components"]) != len(problem["R"])
            or max(measurement["position"]) >= n
        ):
            raise Rejected("shape", "components or position do not fit")
    if problem["filter"]["kind"] == "kalman":
        if measurement["kind"] != "linear":
            raise Rejected("unknown", "the Kalman filter has linear measurements only")
    elif problem["filter"]["kind"] == "converted":
        check_conversion(problem)
    else:
        rule(problem["filter"], n)


def check_conversion(problem):
    """One range and one bearing, of independent noise, and a conversion that is known."""
    if problem["filter"]["conversion"] not in CONVERSIONS:
        raise Rejected("unknown", f"conversion {problem['filter']['conversion']}")
    if sorted(problem["measurement"].get("components", [])) != ["bearing", "range"]:
        raise Rejected("unknown", "what is converted is one range and one bearing")
    if problem["R"][0][1] != 0:
        raise Rejected("unknown", "a conversion knows no covariance of range and bearing")


def check_ranges_and_bearings(problem):
    """A range is not negative; a bearing beyond two turns is probably in degrees."""
    for k, entry in enumerate(problem["measurements"]):
        for name, value in zip(problem["measurement"].get("components", []), entry["z"] or []):
            if name == "range" and value < 0:
                raise Rejected("range", f"measurements[{k}].z has the range {value}")
            if name == "bearing" and abs(value) > 2 * math.pi:
                raise Rejected(
                    "angle", f"measurements[{k}].z has the bearing {value}: is it in degrees?"
                )


# ------------------------------------------------------ the filter: rules and measurements


RULES = ["cubature-3", "cubature-5", "simplex-5"]
RULES += [f"gauss-hermite-{nodes}" for nodes in (2, 3, 4, 5)]


def rule(parameters, n):
    """Points (one a row), weights, and weights for covariances, for the standard Gaussian."""
    name = parameters.get("rule", parameters["kind"])
    if name == "unscented":
        return unscented(n, parameters["alpha"], parameters["beta"], parameters["kappa"])
    if name == "cubature-3":
        points, weights = cubature_3(n)
    elif name == "cubature-5":
        points, weights = cubature_5(n)
    elif name == "simplex-5" and n >= 2:
        points, weights = simplex_5(n)
    elif name in ("gauss-hermite-2", "gauss-hermite-3", "gauss-hermite-4", "gauss-hermite-5"):
        points, weights = gauss_hermite(n, int(name[-1]))
    else:
        raise Rejected("unknown", f"there is no rule {name} in {n} dimensions")
    return points, weights, weights


def both(points):
    """The points and their mirror images."""
    return np.vstack([points, -points])


def cubature_3(n):
    """2n points on the axes."""
    return both(math.sqrt(n) * np.eye(n)), np.full(2 * n, 1 / (2 * n))


def unscented(n, alpha, beta, kappa):
    """The centre and 2n points on the axes, with the covariance weight of the centre apart."""
    spread = alpha**2 * (n + kappa)
    if spread <= 0:
        raise Rejected("unknown", f"n + lambda is {spread}")
    points = np.vstack([np.zeros(n), both(math.sqrt(spread) * np.eye(n))])
    weights = np.full(2 * n + 1, 1 / (2 * spread))
    weights[0] = (spread - n) / spread
    covariance_weights = weights.copy()
    covariance_weights[0] += 1 - alpha**2 + beta
    return points, weights, covariance_weights


def cubature_5(n):
    """The centre, the axes, and the diagonals of the coordinate planes: degree five."""
    axes = np.eye(n)
    diagonals = [
        (axes[i] + sign * axes[k]) / math.sqrt(2)
        for i in range(n)
        for k in range(i + 1, n)
        for sign in (1, -1)
    ]
    diagonals = np.array(diagonals).reshape(-1, n)
    points = math.sqrt(n + 2) * np.vstack([np.zeros(n), both(axes), both(diagonals)])
    parts = [
        np.full(1, 2 / (n + 2)),
        np.full(2 * n, (4 - n) / (2 * (n + 2) ** 2)),
        np.full(2 * len(diagonals), 1 / (n + 2) ** 2),
    ]
    return points, np.concatenate(parts)


def simplex_5(n):
    """The centre, and a simplex's vertices and edges, and their mirror images: degree five."""
    vertices = np.zeros((n + 1, n))
    for j in range(1, n + 2):
        for m in range(1, min(j, n + 1)):
            vertices[j - 1, m - 1] = -math.sqrt((n + 1) / (n * (n - m + 2) * (n - m + 1)))
        if j <= n:
            vertices[j - 1, j - 1] = math.sqrt((n + 1) * (n - j + 1) / (n * (n - j + 2)))
    edges = np.array(
        [vertices[i] + vertices[k] for i in range(n + 1) for k in range(i + 1, n + 1)]
    )
    edges *= math.sqrt(n / (2 * (n - 1)))
    points = math.sqrt(n + 2) * np.vstack([np.zeros(n), both(vertices), both(edges)])
    scale = (n + 1) ** 2 * (n + 2) ** 2
    vertex, edge = (7 - n) * n**2 / (2 * scale), 2 * (n - 1) ** 2 / scale
    return points, np.concatenate(
        [
            np.full(1, 2 / (n + 2)),
            np.full(2 * len(vertices), vertex),
            np.full(2 * len(edges), edge),
        ]
    )


def gauss_hermite(n, nodes):
    """The product of n one-dimensional rules."""
    positions, weights = np.polynomial.hermite_e.hermegauss(nodes)
    weights = weights / math.sqrt(2 * math.pi)
    points = np.stack(np.meshgrid(*[positions] * n, indexing="ij"), axis=-1).reshape(-1, n)
    products = np.prod(np.stack(np.meshgrid(*[weights] * n, indexing="ij"), axis=-1), axis=-1)
    return points, products.reshape(-1)


def wrapped(angle):
    """The angle's equivalent in (-pi, pi]."""
    turns = np.ceil((angle - math.pi) / (2 * math.pi))
    return angle - 2 * math.pi * turns


def atan2(y, x):
    """The angle of (x, y), for complex numbers to first order in their imaginary parts."""
    slope = x.real * y.imag - y.real * x.imag
    angle = np.arctan2(y.real, x.real)
    return angle + 1j * slope / (x.real**2 + y.real**2) if np.iscomplexobj(y + x) else angle


def stumpff(k, t):
    """c_k(t), the sum over j of (-t)^j / (2j + k)!; far from zero, where it cancels, otherwise."""
    if abs(t) <= 9:
        return sum((-t) ** j / math.factorial(2 * j + k) for j in range(25))
    if k > 1:
        return (1 / math.factorial(k - 2) - stumpff(k - 2, t)) / t
    root = np.sqrt(t + 0j)
    value = np.cos(root) if k == 0 else np.sin(root) / root
    return value if np.iscomplexobj(t) else value.real


FUNCTIONS = {"__builtins__": {}, "pi": math.pi, "atan2": atan2, "ln": np.log}
FUNCTIONS |= {name: getattr(np, name) for name in ("sqrt", "exp", "sin", "cos", "tan")}
FUNCTIONS |= {"hypot": lambda x, y: np.sqrt(x * x + y * y)}
FUNCTIONS |= {f"c{k}": lambda t, k=k: stumpff(k, t) for k in range(10)}


class Formulas:
    """Formulas of the entries of a state: Python but for `^`. Known names have numbers."""

    def __init__(self, names, known, definitions, texts):
        written = [text.replace("^", "**") for text in texts]
        self.names, self.known = names, known
        self.definitions = [(name, text.replace("^", "**")) for name, text in definitions]
        self.texts = written

    def of(self, state):
        """The values at a state."""
        values = {**self.known, **dict(zip(self.names, state))}
        for name, text in self.definitions:
            values[name] = eval(text, FUNCTIONS, values)
        return np.array([eval(text, FUNCTIONS, values) for text in self.texts])

    def jacobian(self, state):
        """The slopes, by a step along the imaginary axis: exact to rounding."""
        step = 1e-30
        columns = [self.of(state + 1j * step * unit).imag / step for unit in np.eye(len(state))]
        return np.stack(columns, axis=1).astype(state.dtype)


@dataclass
class Motion:
    """F x, or formulas."""

    matrix: np.ndarray = None
    formulas: Formulas = None

    def of(self, state):
        """The next state."""
        if self.matrix is not None:
            return self.matrix @ state
        return self.formulas.of(state).astype(state.dtype)

    def slope(self, state):
        """F, or the Jacobian."""
        return self.matrix if self.matrix is not None else self.formulas.jacobian(state)


@dataclass
class Measurement:
    """What the sensor sees: H x, ranges and bearings, or formulas."""

    number: type
    matrix: np.ndarray = None
    components: list = field(default_factory=list)
    position: list = None
    sensor: np.ndarray = None
    angle_mean: str = "centre-point"
    formulas: Formulas = None

    @staticmethod
    def of(parameters, formulas, number, angle_mean):
        """From the problem's object."""
        if parameters["kind"] == "linear":
            return Measurement(number, matrix=np.array(parameters["H"], number))
        if parameters["kind"] == "formulas":
            angles = ["bearing" if "angle" in entry[2:] else "number" for entry in parameters["z"]]
            return Measurement(number, None, angles, angle_mean=angle_mean, formulas=formulas)
        sensor = np.array(parameters["sensor"], number)
        return Measurement(
            number, None, parameters["components"], parameters["position"], sensor, angle_mean
        )

    def only(self, rows):
        """What is left of it where entries are missing."""
        matrix = None if self.matrix is None else self.matrix[rows]
        formulas = self.formulas
        if formulas is not None:
            texts = [formulas.texts[row] for row in rows]
            formulas = Formulas(formulas.names, formulas.known, formulas.definitions, texts)
        components = [self.components[row] for row in rows] if self.components else []
        return replace(self, matrix=matrix, components=components, formulas=formulas)

    def slope(self, state):
        """H, or the Jacobian."""
        if self.matrix is not None:
            return self.matrix
        if self.formulas is not None:
            return self.formulas.jacobian(state)
        dx, dy = state[self.position] - self.sensor
        square = dx**2 + dy**2
        radial, across = np.array([dx, dy]) / np.sqrt(square), np.array([-dy, dx]) / square
        rows = {"range": radial, "bearing": across}
        jacobian = np.zeros((len(self.components), len(state)), self.number)
        jacobian[:, self.position] = [rows[name] for name in self.components]
        return jacobian

    @staticmethod
    def of_position(parameters, n, number):
        """The position itself, which is what range and bearing are converted to."""
        return Measurement(number, matrix=np.eye(n, dtype=number)[parameters["position"]])

    def of_states(self, states):
        """The measurements of states, one a row."""
        if self.matrix is not None:
            return states @ self.matrix.T
        if self.formulas is not None:
            return np.stack([self.formulas.of(state) for state in states]).astype(self.number)
        dx, dy = (states[:, self.position] - self.sensor).T
        columns = {"range": np.sqrt(dx**2 + dy**2), "bearing": np.arctan2(dy, dx)}
        return np.stack([columns[name] for name in self.components], axis=1)

    def difference(self, a, b):
        """a - b, with its bearings wrapped."""
        difference = a - b
        for row, name in enumerate(self.components):
            if name == "bearing":
                difference[..., row] = wrapped(difference[..., row])
        return difference

    def mean(self, weights, values, centre):
        """The points' mean measurement; bearings as differences from that of the centre."""
        mean = weights @ values
        for row, name in enumerate(self.components):
            if name != "bearing":
                continue
            if self.angle_mean == "vector":
                mean[row] = np.arctan2(
                    weights @ np.sin(values[:, row]), weights @ np.cos(values[:, row])
                )
            else:
                mean[row] = centre[row] + weights @ wrapped(values[:, row] - centre[row])
        return mean


CONVERSIONS = ["standard", "additive", "multiplicative", "modified-unbiased"]


@dataclass
class Conversion:
    """How range and bearing become a position with a covariance."""

    name: str
    rows: list  # where range and bearing stand in z
    sensor: np.ndarray
    range_variance: np.floating
    bearing_variance: np.floating

    @staticmethod
    def of(parameters, measurement, noise):
        """From the problem's objects and the noise of range and bearing."""
        rows = [measurement["components"].index(name) for name in ("range", "bearing")]
        sensor = np.array(measurement["sensor"], noise.dtype)
        return Conversion(parameters["conversion"], rows, sensor, *np.diag(noise)[rows])

    def factor(self):
        """What the position is multiplied by, against the bias that a noisy bearing makes."""
        w = np.exp(-self.bearing_variance / 2)
        factors = {
            "standard": 1,
            "additive": 1 - (w**2 - w),
            "multiplicative": 1 / w,
            "modified-unbiased": w,
        }
        return factors[self.name]

    def variances(self, distance):
        """The variances of the position along and across the line of sight."""
        w = np.exp(-self.bearing_variance / 2)
        square, noise = distance**2, self.range_variance
        along, across = (1 + w**4) / 2 * (square + noise), (1 - w**4) / 2 * (square + noise)
        if self.name == "standard":
            return noise, square * self.bearing_variance
        if self.name == "multiplicative":
            return along + (w**-2 - 2) * square, across
        if self.name == "modified-unbiased":
            return along - w**2 * square, across
        return (
            (1 + w**8) / 2 * (square + 2 * noise) - w**2 * along,
            (1 - w**8) / 2 * (square + 2 * noise) - w**2 * across,
        )

    def position(self, z):
        """The sensor's place, and f r (cos, sin) from there."""
        distance, bearing = z[self.rows]
        direction = np.array([np.cos(bearing), np.sin(bearing)])
        return self.sensor + self.factor() * distance * direction

    def covariance(self, z):
        """The variances along and across the line of sight, turned into the plane."""
        distance, bearing = z[self.rows]
        cosine, sine = np.cos(bearing), np.sin(bearing)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        return turn @ np.diag(self.variances(distance)) @ turn.T


def cholesky_upper(covariance):
    """U with P = U U', upper triangular."""
    return np.linalg.cholesky(covariance[::-1, ::-1])[::-1, ::-1]


def symmetric_root(covariance):
    """The symmetric root."""
    values, vectors = np.linalg.eigh(covariance)
    return (vectors * np.sqrt(values)) @ vectors.T


SQUARE_ROOTS = {
    "cholesky-lower": np.linalg.cholesky,
    "cholesky-upper": cholesky_upper,
    "symmetric": symmetric_root,
}


# ------------------------------------------------------------------- the filter: the cycle


@dataclass
class Mode:
    """What one mode computes in a step, in this order; estimates are (mean, covariance)."""

    index: int
    mixing_probabilities: np.ndarray = None
    mixed: tuple = None
    motion_jacobian: np.ndarray = None
    predicted: tuple = None
    predicted_measurement: np.ndarray = None
    innovation: np.ndarray = None
    measurement_jacobian: np.ndarray = None
    innovation_covariance: np.ndarray = None
    cross_covariance: np.ndarray = None
    gain: np.ndarray = None
    updated: tuple = None
    log_likelihood: np.floating = None
    nis: np.floating = None


@dataclass
class Step:
    """What all modes compute in one step."""

    modes: list
    predicted_mode_probabilities: np.ndarray = None
    combined_prediction: tuple = None
    converted_measurement: np.ndarray = None
    converted_covariance: np.ndarray = None
    mode_probabilities: np.ndarray = None
    combined: tuple = None


class Imm:
    """The interacting multiple model filter: modes of Kalman filters or of filters with points."""

    def __init__(
        self,
        mode_probabilities,
        means,
        covariances,
        rule=None,
        square_root=np.linalg.cholesky,
        interaction="imm",
        first_step="mixed",
        has_two_pi=True,
        linearises=False,
        number=np.float64,
    ):
        self.mode_probabilities = mode_probabilities
        self.estimates = list(zip(means, covariances))
        self.rule = rule  # points, weights, covariance weights; None for filters without points
        self.square_root = square_root
        self.interaction = interaction  # imm, gpb1 or unmixed
        self.mixes = first_step == "mixed"
        self.predicts = first_step != "predicted"
        self.has_two_pi = has_two_pi
        self.linearises = linearises  # whether F and H are Jacobians, which are shown
        self.number = number

    def given(
        self,
        motions,
        process_noises,
        measurement,
        measurement_noise,
        conversion,
        chain,
        rates,
        sojourn_times,
        jumps,
        interval,
        angles,
        reads,
    ):
        """The models of the next step."""
        self.angles = angles  # which entries of the state are, of each mode and of all together
        self.reads = reads  # how mode i is read by mode j, where their states differ
        self.motions = motions  # one a mode
        self.process_noises = process_noises  # Q, one a mode
        self.measurement = measurement
        self.measurement_noise = measurement_noise  # R
        self.conversion = conversion  # of ranges and bearings to positions; None: as measured
        if chain is None:
            chain = self.chain_over(
                self.rates_of(sojourn_times, jumps) if rates is None else rates, interval
            )
        self.chain = chain  # chain[i, j] = P(mode j now | mode i before)

    def rates_of(self, sojourn_times, jumps):
        """A mode that lasts for tau on average is left at the rate 1/tau."""
        return jumps / sojourn_times[:, None] - np.diag(1 / sojourn_times)

    def chain_over(self, rates, interval):
        """exp(G T): the first terms for a small part of the step, squared again and again."""
        size = float(np.abs(rates).max() * interval)
        halvings = max(0, math.ceil(math.log2(size)) + 4) if size > 0 else 0
        step = rates * self.number(interval / 2**halvings)
        chain = term = np.eye(len(rates), dtype=self.number)
        for k in range(1, 20):
            term = term @ step / self.number(k)
            chain = chain + term
        for _ in range(halvings):
            chain = chain @ chain
            chain /= chain.sum(axis=1, keepdims=True)
        return chain

    def step(self, z):
        """One step with a measurement, or without a detection when z is None."""
        now = Step([Mode(j) for j in range(len(self.estimates))])
        now.predicted_mode_probabilities = (
            self.predicted_mode_probabilities() if self.mixes else self.mode_probabilities
        )
        for mode in now.modes:
            mode.mixing_probabilities = self.mixing_probabilities(
                mode, now.predicted_mode_probabilities
            )
            mode.mixed = self.mixed(mode)
            mode.predicted = self.predicted(mode)
        now.combined_prediction = self.combined_prediction(now)
        if z is not None and self.conversion is not None:
            now.converted_measurement = self.converted_measurement(z)
            now.converted_covariance = self.converted_covariance(z)
            z, self.measurement_noise = now.converted_measurement, now.converted_covariance
        for mode in now.modes:
            mean, covariance = mode.predicted
            if z is not None:
                self.measure(mode)
                mode.innovation = self.innovation(mode, z)
                mode.gain = self.gain(mode)
                mean, covariance = self.updated(mode)
            angles = self.angles[mode.index]
            mode.updated = np.where(angles, wrapped(mean), mean), covariance
            if z is not None:
                mode.log_likelihood = self.log_likelihood(mode)
                mode.nis = self.nis(mode)
        now.mode_probabilities = (
            self.undetected_probabilities(now) if z is None else self.updated_probabilities(now)
        )
        now.combined = self.combined(now)
        self.estimates = [mode.updated for mode in now.modes]
        self.mode_probabilities = now.mode_probabilities
        self.mixes = self.predicts = True
        return now

    def predicted_mode_probabilities(self):
        """c_j = sum over i of p_ij mu_i."""
        return self.mode_probabilities @ self.chain

    def mixing_probabilities(self, mode, predicted):
        """mu_i|j = p_ij mu_i / c_j; a mode that cannot be reached keeps its own estimate.

        In GPB1 every mode starts from the combined estimate: mu_i|j = mu_i.
        """
        if self.mixes and self.interaction == "gpb1":
            return self.mode_probabilities
        if not self.mixes or self.interaction == "unmixed" or predicted[mode.index] == 0:
            return np.eye(len(predicted), dtype=self.number)[mode.index]
        return self.chain[:, mode.index] * self.mode_probabilities / predicted[mode.index]

    def mixed(self, mode):
        """What the mode's prediction starts from."""
        estimates = self.read(self.estimates, mode.index)
        return mixture(mode.mixing_probabilities, estimates, self.angles[mode.index])

    def read(self, estimates, reader):
        """The estimates of all modes in the state of a mode, or, after the last, the common one."""
        converted = []
        for i, (mean, covariance) in enumerate(estimates):
            if (i, reader) in self.reads:
                mean, covariance = self.converted(*self.reads[i, reader], mean, covariance)
            converted.append((mean, covariance))
        return converted

    def converted(self, function, added, mean, covariance):
        """c(x) and C P C' + A, C the slopes of c at x."""
        slope = function.slope(mean)
        return function.of(mean), slope @ covariance @ slope.T + added

    def measured(self, mode, states):
        """What the sensor sees of states of a mode, one a row."""
        if (mode.index, len(self.motions)) in self.reads:
            function, _ = self.reads[mode.index, len(self.motions)]
            states = np.stack([function.of(state) for state in states])
        return self.measurement.of_states(states)

    def measured_slope(self, mode, state):
        """H, or the Jacobian, by the state of the mode."""
        if (mode.index, len(self.motions)) not in self.reads:
            return self.measurement.slope(state)
        function, _ = self.reads[mode.index, len(self.motions)]
        return self.measurement.slope(function.of(state)) @ function.slope(state)

    def predicted(self, mode):
        """f(x) and F P F' + Q, or the same by points."""
        mean, covariance = mode.mixed
        motion, noise = self.motions[mode.index], self.process_noises[mode.index]
        if self.rule is None:
            slope = motion.slope(mean)
            mode.motion_jacobian = slope if self.linearises else None
            if not self.predicts:
                return mode.mixed
            return motion.of(mean), slope @ covariance @ slope.T + noise
        if not self.predicts:
            return mode.mixed
        _, weights, covariance_weights = self.rule
        points = np.stack([motion.of(point) for point in self.points(mode.mixed)])
        angles = self.angles[mode.index]
        points = in_turn_of(motion.of(mean), points, angles)
        predicted = weights @ points
        deviations = np.where(angles, wrapped(points - predicted), points - predicted)
        return predicted, (deviations.T * covariance_weights) @ deviations + noise

    def points(self, estimate):
        """The rule's points about an estimate, one a row."""
        mean, covariance = estimate
        return mean + self.rule[0] @ self.root(covariance).T

    def root(self, covariance):
        """A square root. An entry without variance has a row of zeros in both."""
        varying = np.any(covariance != 0, axis=1)
        block = np.ix_(varying, varying)
        root = np.zeros_like(covariance)
        root[block] = self.square_root(covariance[block])
        return root

    def converted_measurement(self, z):
        """Range and bearing as a position."""
        return self.conversion.position(z)

    def converted_covariance(self, z):
        """The noise of that position, R of this step."""
        return self.conversion.covariance(z)

    def measure(self, mode):
        """Predicted measurement, its covariance S, and its covariance C with the state."""
        mean, covariance = mode.predicted
        noise = self.measurement_noise
        if self.rule is None:
            matrix = self.measured_slope(mode, mean)
            mode.measurement_jacobian = matrix if self.linearises else None
            mode.predicted_measurement = self.measured(mode, mean[None, :])[0]
            mode.cross_covariance = covariance @ matrix.T
            mode.innovation_covariance = matrix @ mode.cross_covariance + noise
            return
        _, weights, covariance_weights = self.rule
        points = self.measured_points(mode)
        values = self.measured(mode, points)
        centre = self.measured(mode, mean[None, :])[0]
        mode.predicted_measurement = self.measurement.mean(weights, values, centre)
        deviations = self.measurement.difference(values, mode.predicted_measurement)
        mode.innovation_covariance = (deviations.T * covariance_weights) @ deviations + noise
        mode.cross_covariance = ((points - mean).T * covariance_weights) @ deviations

    def measured_points(self, mode):
        """The points to be measured: drawn afresh, since the propagated ones lack Q."""
        return self.points(mode.predicted)

    def innovation(self, mode, z):
        """z minus the predicted measurement."""
        return self.measurement.difference(z, mode.predicted_measurement)

    def gain(self, mode):
        """K = C S^-1."""
        return np.linalg.solve(mode.innovation_covariance, mode.cross_covariance.T).T

    def updated(self, mode):
        """The mode's estimate after the measurement."""
        mean, covariance = mode.predicted
        return (
            mean + mode.gain @ mode.innovation,
            covariance - mode.gain @ mode.innovation_covariance @ mode.gain.T,
        )

    def log_likelihood(self, mode):
        """ln N(innovation; 0, S)."""
        s, residual = mode.innovation_covariance, mode.innovation
        _, log_determinant = np.linalg.slogdet(s)
        return -(residual @ np.linalg.solve(s, residual) + log_determinant) / 2 - self.two_pi(mode)

    def nis(self, mode):
        """The innovation squared, in units of S."""
        return mode.innovation @ np.linalg.solve(mode.innovation_covariance, mode.innovation)

    def two_pi(self, mode):
        """(m/2) ln 2 pi, unless the convention is to leave it out."""
        return len(mode.innovation) * math.log(2 * math.pi) / 2 if self.has_two_pi else 0.0

    def updated_probabilities(self, now):
        """Bayes' rule, with likelihoods relative to the greatest: none of them underflows."""
        predicted = now.predicted_mode_probabilities
        logs = np.array([mode.log_likelihood for mode in now.modes], self.number)
        weights = predicted * np.exp(
            np.where(predicted > 0, logs - np.max(logs[predicted > 0]), 0)
        )
        return weights / np.sum(weights)

    def undetected_probabilities(self, now):
        """Without a detection the probabilities follow the chain."""
        return now.predicted_mode_probabilities

    def combined_prediction(self, now):
        """The estimate before the measurement, for output."""
        estimates = self.read([mode.predicted for mode in now.modes], len(now.modes))
        return mixture(now.predicted_mode_probabilities, estimates, self.angles[-1])

    def combined(self, now):
        """The estimate after the measurement, for output."""
        estimates = self.read([mode.updated for mode in now.modes], len(now.modes))
        return mixture(now.mode_probabilities, estimates, self.angles[-1])


def in_turn_of(reference, vectors, angles):
    """The same vectors, their angles within half a turn of the reference's."""
    return np.where(angles, reference + wrapped(vectors - reference), vectors)


def mixture(weights, estimates, angles):
    """Mean and covariance of a mixture: the covariances and the spread of the means.

    Angles are averaged in the turn of the first estimate's.
    """
    first = estimates[0][0]
    mean = sum(weight * in_turn_of(first, x, angles) for weight, (x, _) in zip(weights, estimates))
    away = [np.where(angles, wrapped(x - mean), x - mean) for x, _ in estimates]
    covariance = sum(
        weight * (p + np.outer(d, d)) for weight, (_, p), d in zip(weights, estimates, away)
    )
    return mean, covariance


# ------------------------------------------------- other algebra for the same exact values


class Joseph(Imm):
    """(I - K H) P (I - K H)' + K R K', which stays positive definite for any gain."""

    def updated(self, mode):
        mean, covariance = mode.predicted
        gain, cross = mode.gain, mode.cross_covariance
        if self.rule is None:
            matrix = self.measured_slope(mode, mean)
            rest = np.eye(len(mean), dtype=self.number) - gain @ matrix
            covariance = rest @ covariance @ rest.T + gain @ self.measurement_noise @ gain.T
        else:
            covariance = (
                covariance
                - gain @ cross.T
                - cross @ gain.T
                + gain @ mode.innovation_covariance @ gain.T
            )
        return mean + gain @ mode.innovation, covariance


class Inverse(Imm):
    """S^-1 formed and multiplied, as in many programs."""

    def gain(self, mode):
        return mode.cross_covariance @ np.linalg.inv(mode.innovation_covariance)

    def log_likelihood(self, mode):
        inverse = np.linalg.inv(mode.innovation_covariance)
        square = mode.innovation @ inverse @ mode.innovation
        return -(square + np.log(np.linalg.det(mode.innovation_covariance))) / 2 - self.two_pi(
            mode
        )


class Information(Imm):
    """P = (P^-1 + H' R^-1 H)^-1; with points, the H and R of the linear regression over them."""

    def updated(self, mode):
        mean, covariance = mode.predicted
        inverse = np.linalg.inv(covariance)
        matrix, noise = self.measured_slope(mode, mean), self.measurement_noise
        if self.rule is not None:
            matrix = mode.cross_covariance.T @ inverse
            noise = mode.innovation_covariance - matrix @ mode.cross_covariance
        updated = np.linalg.inv(inverse + matrix.T @ np.linalg.inv(noise) @ matrix)
        return mean + updated @ matrix.T @ np.linalg.inv(noise) @ mode.innovation, updated


FORMS = {"gain": Imm, "joseph": Joseph, "inverse": Inverse, "information": Information}


# ------------------------------------------------------------------------ the command line


def parse_options():
    """What the head of this file lists."""
    parser = argparse.ArgumentParser(description="an IMM filter in numpy under test")
    parser.add_argument(
        "--show", choices=["everything", "posteriors", "combined"], default="everything"
    )
    parser.add_argument("--form", choices=FORMS, default="gain")
    parser.add_argument("--single", action="store_true")
    parser.add_argument("--convention", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--mistake", action="append", default=[], metavar="NAME")
    options = parser.parse_args()
    options.conventions = dict(pair.split("=", 1) for pair in options.convention)
    return options


def filter_class(options):
    """The filter in the form that is asked for, with its planted mistakes."""
    if not options.mistake:
        return FORMS[options.form]
    from numpy_mistakes import MISTAKES

    return type(
        "Mistaken", (*(MISTAKES[name] for name in options.mistake), FORMS[options.form]), {}
    )


if __name__ == "__main__":
    np.seterr(divide="ignore", invalid="ignore", over="ignore", under="ignore")
    main()
