"""What is wrong with a problem, in the classes of spec/formats.md, "A trace". One fault is enough: the first that is met."""

import math
from fractions import Fraction

from flint import fmpq, fmpq_mat

FORMATS = ("immaculate-problem/1", "immaculate-problem/2")
NEEDED = {"format", "id", "state", "modes", "measurement", "R", "filter", "initial", "measurements"}
ALWAYS = {"about", "flags", "units", "conventions", "transition"}  # format 2 may leave them out
ADDED = {"parameters", "let", "sensors", "conversions", "interaction", "rates", "sojourn_times", "jumps"}  # format 2 may have them
OF_A_MODE = {"name", "F", "Q"}
ADDED_TO_A_MODE = {"f", "motion", "let", "parameters", "filter", "M", "state"}
OF_A_STEP = {"step", "z"}
ADDED_TO_A_STEP = {"sensor", "T", "F", "Q", "H", "R", "transition", "truth"}

RULES = {"cubature-3", "cubature-5", "simplex-5"} | {f"gauss-hermite-{order}" for order in (2, 3, 4, 5)}
FILTERS = {
    "kalman": set(),
    "extended": {"iterations"},
    "cubature": {"rule"},
    "unscented": {"alpha", "beta", "kappa"},
    "converted": {"conversion"},
    "fixed-gain": {"mixing", "modes"},
}
CHOICES = {
    "rule": RULES,
    "conversion": {"standard", "additive", "multiplicative", "modified-unbiased"},
    "mixing": {"mixed", "unmixed"},
}
MEASUREMENTS = {"linear", "range-bearing", "formulas", "model"}
CONVENTIONS = {
    "square_root": "cholesky-lower",
    "angle_mean": "centre-point",
    "first_step": "mixed",
    "log_likelihood": "full",
    "unequal_dimensions": "embedded",
    "state_angle_mean": "reference",
    "converted_covariance": "at-measurement",
}


class Rejected(Exception):
    """A problem that must be refused: its class, and the place."""

    def __init__(self, fault, place):
        super().__init__(f"{fault}: {place}")
        self.fault = fault


def demand(condition, fault, place):
    if not condition:
        raise Rejected(fault, place)


def check(raw):
    """Raises `Rejected` where the problem must be refused."""
    check_structure(raw)
    check_names(raw)
    size, modes = len(raw["state"]), len(raw["modes"])
    check_chain_of(raw, modes)
    check_probabilities(raw["initial"]["mode_probabilities"], modes, "initial.mode_probabilities")
    check_estimates(raw, size, modes)
    for j, mode in enumerate(raw["modes"]):
        if "F" in mode:
            check_matrix(mode["F"], size, size, f"modes[{j}].F")
        check_covariance(mode["Q"], size, f"modes[{j}].Q")
    check_sensor(raw, raw["measurement"], raw["R"])
    for sensor in raw.get("sensors", []):
        check_sensor(raw, sensor["measurement"], sensor["R"])
    check_shared_noise(raw, size)
    check_given(raw, size, modes)
    check_conversions(raw, size)
    check_interaction(raw)
    for k, at in enumerate(raw["measurements"]):
        check_step(raw, k, at, size, modes)


def check_structure(raw):
    """Keys: all that are needed, and no other."""
    demand(raw.get("format") in FORMATS, "format", "format")
    second = raw["format"] == FORMATS[1]
    needed = NEEDED if second else NEEDED | ALWAYS
    check_keys(raw, needed, ALWAYS | (ADDED if second else set()), "")
    for j, mode in enumerate(raw["modes"]):
        check_keys(mode, {"name", "Q"}, OF_A_MODE | (ADDED_TO_A_MODE if second else set()), f"modes[{j}]")
        demand(len({"F", "f", "motion"} & set(mode)) == 1, "format", f"modes[{j}]: one of F, f and motion")
    for k, at in enumerate(raw["measurements"]):
        check_keys(at, OF_A_STEP, ADDED_TO_A_STEP if second else set(), f"measurements[{k}]")
        demand(at["step"] == k + 1, "format", f"measurements[{k}].step")


def check_keys(found, needed, possible, place):
    demand(isinstance(found, dict) and needed <= set(found) <= needed | possible, "format", f"the keys of {place or 'the problem'}")


def check_names(raw):
    """Filters, rules, measurements and conventions that exist."""
    for filter in [raw["filter"]] + [mode["filter"] for mode in raw["modes"] if "filter" in mode]:
        demand(filter["kind"] in FILTERS, "unknown", "filter.kind")
        optional = {"iterations"}
        check_keys(filter, {"kind"} | FILTERS[filter["kind"]] - optional, FILTERS[filter["kind"]] & optional, "filter")
        for key, known in CHOICES.items():
            demand(filter.get(key) is None or filter[key] in known, "unknown", f"filter.{key}")
    for key, choice in raw.get("conventions", {}).items():
        demand(CONVENTIONS.get(key) == choice, "unknown", f"conventions.{key}")


def check_estimates(raw, size, modes):
    """The estimates at step 0; those of fixed gains have no covariance."""
    demand(len(raw["initial"]["modes"]) == modes, "shape", "initial.modes")
    for j, estimate in enumerate(raw["initial"]["modes"]):
        check_numbers(estimate["mean"], size, f"initial.modes[{j}].mean")
        fixed = raw["filter"]["kind"] == "fixed-gain"
        demand(("covariance" in estimate) != fixed, "format", f"initial.modes[{j}].covariance")
        if not fixed:
            check_covariance(estimate["covariance"], size, f"initial.modes[{j}].covariance")


def check_sensor(raw, measurement, noise):
    """A measurement and its R belong together, and to the filter."""
    kind = measurement["kind"]
    demand(kind in MEASUREMENTS, "unknown", "measurement.kind")
    entries = len(noise if kind == "model" else measurement[{"linear": "H", "range-bearing": "components", "formulas": "h"}[kind]])
    filter = raw["filter"]["kind"]
    if kind == "linear":
        check_matrix(measurement["H"], entries, len(raw["state"]), "measurement.H")
    if kind == "range-bearing":
        demand(set(measurement["components"]) <= {"range", "bearing"}, "unknown", "measurement.components")
        demand(filter not in ("kalman", "fixed-gain"), "unknown", "range and bearing under a filter that needs a matrix")
        places = measurement["position"]
        demand(len(set(places)) == 2 and all(0 <= x < len(raw["state"]) for x in places), "shape", "measurement.position")
    check_covariance(noise, entries, "R")
    if filter == "converted" and kind == "range-bearing":
        demand(sorted(measurement["components"]) == ["bearing", "range"] and noise[0][1] == 0, "unknown", "what is converted")


def check_shared_noise(raw, size):
    """M goes with the noises, and with filters that have H. (That steps change Q or R is seen by the program alone.)"""
    for j, mode in enumerate(raw["modes"]):
        if "M" not in mode:
            continue
        place, filter = f"modes[{j}].M", mode.get("filter", raw["filter"])
        demand(filter["kind"] in ("kalman", "extended") and "iterations" not in filter, "unknown", place)
        demand(not raw.get("sensors"), "unknown", place)
        check_matrix(mode["M"], size, len(raw["R"]), place)
        if isinstance(mode["Q"], list) and not any(isinstance(entry, str) for row in mode["Q"] for entry in row):
            above = [q + m for q, m in zip(mode["Q"], mode["M"])]
            below = [[row[k] for row in mode["M"]] + r for k, r in enumerate(raw["R"])]
            demand(is_semidefinite(above + below), "not-positive-definite", place)


def check_conversions(raw, size):
    """One from each mode to each reader whose state is another, and no other; in the right shapes."""
    names = [mode["name"] for mode in raw["modes"]]
    states = {mode["name"]: described(mode.get("state", raw["state"])) for mode in raw["modes"]} | {None: described(raw["state"])}
    demand(all(len(state) == size for state in states.values()), "shape", "modes: state")
    needed = {(a, b) for a in names for b in [*names, None] if states[a] != states[b]}
    found = []
    for k, asked in enumerate(raw.get("conversions", [])):
        place = f"conversions[{k}]"
        check_keys(asked, {"from"}, {"to", "matrix", "formulas", "added"}, place)
        for end in (asked["from"], asked.get("to", names[0])):
            demand(end in names, "unknown", place)
            demand(names.count(end) == 1, "format", place)
        found.append((asked["from"], asked.get("to")))
        demand(("matrix" in asked) != ("formulas" in asked), "format", place)
        if "matrix" in asked:
            check_matrix(asked["matrix"], size, size, place)
        demand(len(asked.get("formulas", states[None])) == size, "shape", place)
        if "added" in asked:
            check_covariance(asked["added"], size, f"{place}.added")
    demand(len(set(found)) == len(found) and set(found) == needed, "format", "conversions")


def check_interaction(raw):
    """Where modes start from; fixed gains say it themselves, and modes with states of their own are mixed."""
    if "interaction" not in raw:
        return
    demand(raw["interaction"] in ("imm", "gpb1", "unmixed"), "format", "interaction")
    demand(raw["filter"]["kind"] != "fixed-gain", "unknown", "interaction")
    demand(raw["interaction"] == "imm" or not raw.get("conversions"), "unknown", "interaction")


def described(state):
    """Names, units and angles of a state."""
    return [tuple(entry) if isinstance(entry, list) else (entry,) for entry in state]


def check_given(raw, size, modes):
    """Gains and innovation covariances that are given: one a mode, and definite."""
    if raw["filter"]["kind"] != "fixed-gain":
        return
    given = raw["filter"]["modes"]
    demand(len(given) == modes, "shape", "filter.modes")
    for j, mode in enumerate(given):
        check_matrix(mode["gain"], size, len(raw["R"]), f"filter.modes[{j}].gain")
        covariance = mode["innovation_covariance"]
        check_covariance(covariance, len(raw["R"]), f"filter.modes[{j}].innovation_covariance")
        demand(exactly(covariance).det() > 0, "not-positive-definite", f"filter.modes[{j}].innovation_covariance")


def check_step(raw, k, at, size, modes):
    """What is measured, and what is another in this step."""
    place = f"measurements[{k}]"
    sensors = {None: raw} | {sensor["name"]: sensor for sensor in raw.get("sensors", [])}
    demand(at.get("sensor") in sensors, "unknown", f"{place}.sensor")
    sensor = sensors[at.get("sensor")]
    if "transition" in at:
        check_chain(at["transition"], modes, f"{place}.transition")
    for key in ("F", "Q"):
        demand(len(at.get(key, raw["modes"])) == modes, "shape", f"{place}.{key}")
    for matrix in at.get("F", []):
        check_matrix(matrix, size, size, f"{place}.F")
    for matrix in at.get("Q", []):
        check_covariance(matrix, size, f"{place}.Q")
    if "R" in at:
        check_covariance(at["R"], len(sensor["R"]), f"{place}.R")
    if "truth" in at:
        demand(raw["filter"]["kind"] != "fixed-gain", "format", f"{place}.truth")
        check_numbers(at["truth"], size, f"{place}.truth")
    if at["z"] is None:
        return
    demand(len(at["z"]) == len(sensor["R"]), "shape", f"{place}.z")
    for entry, component in zip(at["z"], sensor["measurement"].get("components", [None] * len(at["z"]))):
        demand(entry is None or math.isfinite(entry), "not-finite", f"{place}.z")
        demand(entry is None or component != "range" or entry >= 0, "range", f"{place}.z")
        demand(entry is None or component != "bearing" or abs(entry) <= 2 * math.pi, "angle", f"{place}.z")


def check_chain_of(raw, modes):
    """A matrix, rates whose rows sum to zero, or sojourn times with jumps: one of them, and the length of every step if it is needed."""
    said = [key for key in ("transition", "rates", "sojourn_times") if key in raw]
    demand(len(said) == 1 and ("jumps" in raw) == (said == ["sojourn_times"]), "format", "the chain")
    if "transition" in raw:
        return check_chain(raw["transition"], modes, "transition")
    for k, at in enumerate(raw["measurements"]):
        has_length = "T" in at or "T" in raw.get("parameters", {})
        demand("transition" in at or has_length, "format", f"measurements[{k}].T")
    rows = raw.get("rates", raw.get("jumps"))
    check_matrix(rows, modes, modes, "the chain")
    for i, row in enumerate(rows):
        demand(all(value >= 0 for j, value in enumerate(row) if j != i), "not-a-probability", f"the chain, row {i}")
    if "rates" in raw:
        for i, row in enumerate(rows):
            most = Fraction(modes, 10**15) * max(abs(Fraction(rate)) for rate in row)
            demand(abs(sum(Fraction(rate) for rate in row)) <= most, "not-a-probability", f"rates[{i}]")
        return None
    check_numbers(raw["sojourn_times"], modes, "sojourn_times")
    demand(all(time > 0 for time in raw["sojourn_times"]), "range", "sojourn_times")
    for i, row in enumerate(rows):
        demand(row[i] == 0, "not-a-probability", f"jumps[{i}]")
        if modes > 1:
            check_probabilities(row, modes, f"jumps[{i}]")
    return None


def check_chain(chain, modes, place):
    demand(len(chain) == modes, "shape", place)
    for i, row in enumerate(chain):
        check_probabilities(row, modes, f"{place}[{i}]")


def check_probabilities(values, count, place):
    """Not negative, and summing to one: within 10⁻¹⁵ an entry."""
    check_numbers(values, count, place)
    demand(all(value >= 0 for value in values), "not-a-probability", place)
    excess = abs(sum(Fraction(value) for value in values) - 1)
    demand(excess <= Fraction(count, 10**15), "not-a-probability", f"{place}, which sums to {float(sum(values))}")


def check_numbers(values, count, place):
    demand(isinstance(values, list) and len(values) == count, "shape", place)
    demand(all(math.isfinite(value) for value in values), "not-finite", place)


def check_matrix(rows, height, width, place):
    demand(len(rows) == height, "shape", place)
    for row in rows:
        check_numbers(row, width, place)


def check_covariance(rows, size, place):
    """Symmetric, and positive semidefinite but for rounding; what is given by formulas or a model is seen when it is used."""
    if not isinstance(rows, list) or any(isinstance(entry, str) for row in rows for entry in row):
        return
    check_matrix(rows, size, size, place)
    demand(all(rows[i][j] == rows[j][i] for i in range(size) for j in range(i)), "not-symmetric", place)
    demand(is_semidefinite(rows), "not-positive-definite", place)


def is_semidefinite(rows):
    """No eigenvalue of P + n 2⁻⁵⁰ diag(P) is negative: det(λ − P) then has coefficients of alternating signs. Exact."""
    size = len(rows)
    matrix = exactly(rows)
    for i in range(size):
        matrix[i, i] *= 1 + fmpq(size, 2**50)
    coefficients = matrix.charpoly().coeffs()
    return all(c * (-1) ** (size - k) >= 0 for k, c in enumerate(coefficients))


def exactly(rows):
    """A matrix of doubles as fractions."""
    return fmpq_mat([[fmpq(*Fraction(entry).as_integer_ratio()) for entry in row] for row in rows])
