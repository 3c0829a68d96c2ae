"""A problem of spec/formats.md as what a filter needs at each step.

Every number is the double nearest to its decimal, and exact from there on. A problem is read anew for every precision. What is wrong with a
problem that must be rejected is said in `validity.py`.
"""

from dataclasses import replace

from flint import arb, arb_mat

from balls import column, exact, matrix
from conversion import convert, entries_of
from filters import Estimate, Seen
from formulas import Affine, Curved, Scope, atan2, evaluate, hypot, rows_of
from models import measurement as named_measurement
from models import motion
from noises import noise
from states import added_of, composed, converted, map_of

MATRIX_FILTERS = ("kalman", "converted", "fixed-gain")


class Problem:
    """One problem at the present precision. Modes count from 0; `at` is an entry of `measurements`."""

    def __init__(self, raw):
        self.raw = raw
        self.state, self.angles = names_and_angles(raw["state"])
        own = [names_and_angles(mode.get("state", raw["state"])) for mode in raw["modes"]]
        self.states, self.angles_of = [names for names, _ in own], [angles for _, angles in own]
        self.filters = [{**mode.get("filter", raw["filter"])} for mode in raw["modes"]]
        for j, given in enumerate(raw["filter"].get("modes", [])):
            self.filters[j] |= {key: matrix(given[key]) for key in ("gain", "innovation_covariance")}
        for filter, mode in zip(self.filters, raw["modes"]):
            filter |= {"M": matrix(mode["M"])} if "M" in mode else {}
        initial = raw["initial"]
        self.probabilities = [exact(p) for p in initial["mode_probabilities"]]
        self.estimates = [estimate(mode) for mode in initial["modes"]]
        self.steps = raw["measurements"]

    def chain(self, at):
        """p_ij, row i: from mode i at k−1 to mode j at k."""
        if "transition" in at or "transition" in self.raw:
            return [[exact(p) for p in row] for row in at.get("transition", self.raw.get("transition"))]
        return self.chain_over(exact(at.get("T", self.raw.get("parameters", {}).get("T"))))

    def chain_over(self, interval):
        """e^(G T) by FLINT's exponential; the diagonal of G is minus the sum of its row."""
        raw, modes = self.raw, range(len(self.raw["modes"]))
        if "rates" in raw:
            rate = [[exact(g) for g in row] for row in raw["rates"]]
        else:
            rate = [[exact(p) / exact(tau) for p in row] for row, tau in zip(raw["jumps"], raw["sojourn_times"])]
        for i in modes:
            rate[i][i] = -sum((rate[i][j] for j in modes if j != i), arb(0))
        chain = (arb_mat(rate) * interval).exp()
        reached = {(i, j) for i in modes for j in modes if i == j or not rate[i][j].is_zero()}
        for _ in modes:
            reached |= {(i, j) for i, k in reached for l, j in reached if k == l}
        return [[chain[i, j] if (i, j) in reached else arb(0) for j in modes] for i in modes]

    def truth(self, at):
        """The true state at a step."""
        return column([exact(x) for x in at["truth"]])

    def scope(self, j, at):
        """What names stand for in mode j."""
        mode, raw = self.raw["modes"][j], self.raw
        numbers = {**raw.get("parameters", {}), **mode.get("parameters", {})}
        if "T" in at:
            numbers["T"] = at["T"]
        return Scope({name: exact(x) for name, x in numbers.items()}, raw.get("let", []) + mode.get("let", []))

    def scope_of(self, numbers):
        """What names stand for outside of the modes."""
        return Scope(numbers, self.raw.get("let", []))

    def conversion(self, from_mode, to, at):
        """How a mode is read by another, or by the combined estimates where `to` is none; nothing where both have one state."""
        names = [mode["name"] for mode in self.raw["modes"]]
        ends = (names[from_mode], None if to is None else names[to])
        for asked in self.raw.get("conversions", []):
            if (asked["from"], asked.get("to")) == ends:
                return map_of(self, asked, from_mode, at), added_of(asked, len(self.state))
        return None

    def read(self, estimates, to, at):
        """The estimates of all modes as they are read."""
        found = [self.conversion(i, to, at) for i in range(len(estimates))]
        return [converted(*way, estimate) if way else estimate for way, estimate in zip(found, estimates)]

    def seen_by(self, j, seen, at):
        """What mode j sees: the function of the common state, of its own."""
        way = self.conversion(j, None, at)
        return replace(seen, function=composed(seen.function, way[0])) if way else seen

    def motion(self, j, at):
        """x(k) = f(x(k−1)) of mode j."""
        mode = self.raw["modes"][j]
        if "F" in at:
            return Affine(matrix(at["F"][j]))
        if "F" in mode:
            return Affine(matrix(mode["F"]))
        if "f" in mode:
            function = self.of_formulas(mode["f"], self.scope(j, at), self.states[j])
        else:
            asked = mode["motion"]
            given = bound(self.scope(j, at), asked)
            function = Curved(motion(asked["model"], self.states[j], given, asked.get("others")))
        return function.as_affine(len(self.state)) if self.filters[j]["kind"] in MATRIX_FILTERS else function

    def of_formulas(self, texts, scope, state):
        """A formula for each entry, of the entries of a state."""

        def function(numbers):
            names = Scope({**scope.known, **dict(zip(state, numbers))}, scope.definitions)
            return [evaluate(text, names) for text in texts]

        return Curved(function)

    def noise(self, j, at):
        """Q of mode j: numbers, formulas among which numbers may stand, or a named model."""
        rows = at["Q"][j] if "Q" in at else self.raw["modes"][j]["Q"]
        scope = self.scope(j, at)
        if isinstance(rows, dict):
            return noise(rows["model"], self.states[j], bound(scope, rows))
        return arb_mat([[evaluate(x, scope) if isinstance(x, str) else exact(x) for x in row] for row in rows])

    def sensor(self, at):
        """The measurement and R that are meant at this step."""
        named = {sensor["name"]: sensor for sensor in self.raw.get("sensors", [])}
        sensor = named[at["sensor"]] if "sensor" in at else self.raw
        return sensor["measurement"], at.get("R", sensor["R"])

    def seen(self, at):
        """What is seen at a step, or nothing; and the converted measurement where the filter converts."""
        if at["z"] is None:
            return None, {}
        measurement, noise = self.sensor(at)
        rows = [row for row, entry in enumerate(at["z"]) if entry is not None]
        z = column([exact(at["z"][row]) for row in rows])
        noise = matrix([[noise[i][j] for j in rows] for i in rows])
        if self.raw["filter"]["kind"] == "converted" and measurement["kind"] == "range-bearing":
            return self.converted(measurement, z, noise)
        function, angles = self.measured(measurement, at)
        return Seen(rows_of(function, rows), noise, z, [angles[row] for row in rows], rows), {}

    def measured(self, measurement, at):
        """h, and which of its entries are angles."""
        if measurement["kind"] == "linear":
            rows = at.get("H", measurement["H"])
            return Affine(matrix(rows)), [False] * len(rows)
        if measurement["kind"] == "range-bearing":
            return of_sensor(measurement), [kind == "bearing" for kind in measurement["components"]]
        scope = self.scope_of({name: exact(x) for name, x in self.raw.get("parameters", {}).items()})
        if measurement["kind"] == "formulas":
            return self.of_formulas(measurement["h"], scope, self.state), [is_angle(entry) for entry in measurement["z"]]
        function, angles = named_measurement(measurement["model"], self.state, bound(SENSOR, measurement))
        return Curved(function), angles

    def converted(self, measurement, z, noise):
        """The position that range and bearing show: sustika2015 (20)-(26) and its kin."""
        polar = entries_of(measurement["components"], z, noise)
        position, covariance = convert(self.raw["filter"]["conversion"], *polar)
        position += matrix([[x] for x in measurement["sensor"]])
        pick = arb_mat([[int(entry == place) for entry in range(len(self.state))] for place in measurement["position"]])
        values = {"converted_measurement": position, "converted_covariance": covariance}
        return Seen(Affine(pick), covariance, position, [False, False]), values


SENSOR = Scope({f"sensor_{entry}": arb(0) for entry in ("x", "y", "z", "vx", "vy", "vz")}, [])  # where nothing else is said


def bound(scope, asked):
    """The scope with the parameters that a named model is given."""
    return Scope({**scope.known, **{name: exact(x) for name, x in asked.get("parameters", {}).items()}}, scope.definitions)


def names_and_angles(state):
    """The names of a state, and which of its entries are angles."""
    entries = [entry if isinstance(entry, list) else [entry] for entry in state]
    return [entry[0] for entry in entries], [is_angle(entry) for entry in entries]


def is_angle(entry):
    return isinstance(entry, list) and entry[2:] == ["angle"]


def estimate(mode):
    covariance = matrix(mode["covariance"]) if "covariance" in mode else None
    return Estimate(column([exact(x) for x in mode["mean"]]), covariance)


def of_sensor(measurement):
    """sustika2015 (3) and liu2017 (31) with atan2: range and bearing from where the sensor stands, in the order of `components`."""
    x, y = measurement["position"]
    place = [exact(number) for number in measurement["sensor"]]

    def function(numbers):
        east, north = numbers[x] - place[0], numbers[y] - place[1]
        return [hypot(east, north) if kind == "range" else atan2(north, east) for kind in measurement["components"]]

    return Curved(function)
