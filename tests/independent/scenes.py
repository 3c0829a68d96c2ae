"""What problems are drawn from: states with the motions, noises, measurements and filters that fit them."""

from dataclasses import dataclass, field

from balls import column, entries, exact, set_bits
from reader import Problem

CURVED = ("extended", "unscented", "cubature")
RULES = ["cubature-3", "cubature-5", "simplex-5", "gauss-hermite-2", "gauss-hermite-3"]
CONVERSIONS = ["standard", "additive", "multiplicative", "modified-unbiased"]


def number(draw, low, high):
    return round(draw.uniform(low, high), 3)


@dataclass
class Scene:
    """A state: where its means lie, its deviations, and what moves and measures it."""

    state: list
    ranges: list
    deviations: list
    motions: list
    noises: list
    sensors: list
    kinds: list = field(default_factory=lambda: list(CURVED))

    def filter(self, draw):
        """A filter of a kind that fits."""
        kind = draw.choice(self.kinds)
        if kind == "unscented":
            return {"kind": kind, "alpha": draw.choice([1, 0.5, 0.01]), "beta": draw.choice([0, 2]), "kappa": draw.choice([-1, 0, 1])}
        if kind == "cubature":
            return {"kind": kind, "rule": draw.choice(RULES)}
        if kind == "converted":
            return {"kind": kind, "conversion": draw.choice(CONVERSIONS)}
        if kind == "fixed-gain":
            return {"kind": kind, "mixing": draw.choice(["mixed", "unmixed"])}
        return {"kind": kind}

    def sensors_of(self, filter):
        """The measurements that a filter can take."""
        if filter["kind"] == "converted":
            return [range_and_bearing]
        return [linear(len(self.state))] if filter["kind"] in ("kalman", "fixed-gain") else self.sensors

    def measured(self, raw, measurement, mean, draw):
        """Numbers near to the measurement of a mean: ranges positive, angles in any turn that is allowed."""
        set_bits(64)
        problem = Problem({**raw, "filter": {"kind": "extended"}})
        function, angles = problem.measured(measurement, {})
        kinds = measurement.get("components", [None] * len(angles))
        found = []
        for ball, angle, kind in zip(entries(function.at(column([exact(x) for x in mean]))), angles, kinds):
            near = float(ball.mid()) + draw.gauss(0, 0.1 if angle else 2)
            found.append(round(abs(near) if kind == "range" else near, 4))
        return found


# ----------------------------------------------------------------------------------------------------------------- sensors


def linear(size):
    def sensor(draw):
        rows = draw.choice([1, 2])
        return {"kind": "linear", "H": [[number(draw, -1, 1) for _ in range(size)] for _ in range(rows)]}, [2.0] * rows

    return sensor


def range_and_bearing(draw):
    """Both, in either order, from somewhere."""
    components = draw.sample(["range", "bearing"], 2)
    place = [number(draw, -9, 9), number(draw, -9, 9)]
    return polar(components, place)


def range_or_bearing(draw):
    return polar([draw.choice(["range", "bearing"])], [number(draw, -9, 9), number(draw, -9, 9)])


def polar(components, place):
    measurement = {"kind": "range-bearing", "components": components, "position": [0, 1], "sensor": place}
    return measurement, [2.0 if component == "range" else 0.05 for component in components]


def model(name, *deviations, moved=True):
    """A named measurement, from somewhere."""

    def sensor(draw):
        asked = {"kind": "model", "model": name}
        return (asked | {"parameters": {"sensor_x": number(draw, -9, 9)}} if moved else asked), list(deviations)

    return sensor


def formulas(z, h, deviations):
    return lambda draw: ({"kind": "formulas", "z": z, "h": h}, deviations)


AZIMUTH = formulas([["azimuth", "rad", "angle"], "distance"], ["atan2(y, x)", "sqrt(x^2 + y^2 + 1)"], [0.05, 2.0])
PLANE_SENSORS = [range_and_bearing, range_or_bearing, model("position", 2.0, 2.0, moved=False), model("range-bearing", 2.0, 0.05), AZIMUTH]
PLANE_SENSORS += [model("range", 2.0), model("bearing", 0.05)]
SPEED_SENSORS = [model("range-bearing-range-rate", 2.0, 0.05, 0.5), model("position-and-range-rate", 2.0, 2.0, 0.5)]

# ----------------------------------------------------------------------------------------------------------------- motions


def named(name, others=None, in_mode=(), **parameters):
    """A named motion; parameters and inputs are drawn between the bounds that are given."""

    def motion(draw):
        asked = {"model": name, **({"others": others} if others else {})}
        if parameters:
            asked["parameters"] = {key: number(draw, *bounds) for key, bounds in parameters.items()}
        return {"motion": asked} | ({"parameters": {key: number(draw, -0.4, 0.4) for key in in_mode}} if in_mode else {})

    return motion


def by_formulas(texts, let=()):
    return lambda draw: {"f": texts, "parameters": {"k": number(draw, 0.01, 0.3)}} | ({"let": [list(pair) for pair in let]} if let else {})


def by_matrix(size):
    return lambda draw: {"F": [[number(draw, -0.2, 0.2) + (i == j) for j in range(size)] for i in range(size)]}


ANGLE = ["heading", "rad", "angle"]
TURN = by_formulas(
    ["x + T*(c1(t)*vx - a*c2(t)*vy)", "y + T*(a*c2(t)*vx + c1(t)*vy)", "cos(a)*vx - sin(a)*vy", "sin(a)*vx + cos(a)*vy", "w"],
    [("a", "w*T"), ("t", "a*a")],
)
SCENES = [
    Scene(
        [["x", "m"], ["y", "m"], ["vx", "m/s"], ["vy", "m/s"]],
        [(20, 60), (-60, 60), (-9, 9), (-9, 9)],
        [3.0, 3.0, 1.0, 1.0],
        [
            named("constant-velocity"),
            named("coordinated-turn", w=(-0.5, 0.5)),
            named("random-walk", "keep"),
            by_formulas(["x + T*vx - k*vx*T^2", "y + T*vy", "vx*exp(-k*T)", "vy*c0(k) + T*k"]),
            by_formulas(["x + T*vx", "y + T*vy", "vx + g*T", "vy - g*cos(y/20)*T"], [("g", "k*sin(x/30)")]),
            by_matrix(4),
        ],
        [
            ("constant-velocity-white-noise", ["q"]),
            ("constant-velocity-piecewise-noise", ["q"]),
            ("coordinated-turn-white-noise", ["q", "w"]),
        ],
        PLANE_SENSORS + SPEED_SENSORS + [linear(4)],
    ),
    Scene(
        [["x", "m"], ["y", "m"], ["vx", "m/s"], ["vy", "m/s"], ["w", "rad/s"]],
        [(-60, -20), (-6, 6), (-9, 9), (-9, 9), (-0.4, 0.4)],
        [3.0, 3.0, 1.0, 1.0, 0.1],
        [named("constant-velocity", "keep"), named("coordinated-turn-unknown-rate"), TURN],
        [("coordinated-turn-unknown-rate-piecewise-noise", ["q", "q_turn"])],
        PLANE_SENSORS + SPEED_SENSORS,
    ),
    Scene(
        [["x", "m"], ["y", "m"], ["v", "m/s"], ANGLE, ["w", "rad/s"]],
        [(-60, -20), (-6, 6), (3, 9), (2.9, 3.3), (-0.4, 0.4)],
        [3.0, 3.0, 1.0, 0.2, 0.1],
        [
            named("constant-turn-rate-and-speed"),
            by_formulas(["x + T*v*cos(heading)", "y + T*v*sin(heading)", "v - k*T", "heading + T*w", "w"]),
        ],
        [],
        PLANE_SENSORS + [model("range-bearing-range-rate-of-heading", 2.0, 0.05, 0.5), linear(5)],
    ),
    Scene(
        [["x", "m"], ["y", "m"], ["v", "m/s"], ANGLE, ["a", "m/s^2"], ["w", "rad/s"]],
        [(-60, -20), (-6, 6), (3, 9), (-3.2, -2.9), (-1, 1), (-0.4, 0.4)],
        [3.0, 3.0, 1.0, 0.2, 0.3, 0.1],
        [named("constant-turn-rate-and-acceleration"), named("constant-turn-rate-and-speed", "keep")],
        [],
        PLANE_SENSORS,
    ),
    Scene(
        [["x", "m"], ["y", "m"], ["v", "m/s"], ANGLE],
        [(-60, -20), (-6, 6), (3, 9), (2.9, 3.3)],
        [3.0, 3.0, 1.0, 0.2],
        [named("bicycle", in_mode=("steer", "a"), front=(1, 2), rear=(1, 2))],
        [],
        PLANE_SENSORS + [model("range-bearing-range-rate-of-heading", 2.0, 0.05, 0.5)],
    ),
    Scene(
        ["x", "vx", "ax"],
        [(20, 60), (-9, 9), (-2, 2)],
        [3.0, 1.0, 0.5],
        [
            named("constant-acceleration"),
            named("singer", alpha=(0.05, 0.8)),
            named("constant-velocity", "keep"),
            by_formulas(["x + T*vx", "vx - T*k*vx^2/10", "ax/(1 + T^2)"]),
        ],
        [
            ("constant-acceleration-white-noise", ["q"]),
            ("constant-acceleration-piecewise-noise", ["q"]),
            ("singer-white-noise", ["alpha", "variance"]),
        ],
        [model("position", 2.0, moved=False), formulas(["d", "e"], ["hypot(x, 3)", "ln(x + 200)*sin(vx/9) + tan(ax/9)"], [0.5, 0.1])],
    ),
    Scene(
        ["x", "y", "z"],
        [(20, 60), (-30, 30), (5, 20)],
        [3.0, 2.0, 2.0],
        [named("random-walk"), by_formulas(["x*cos(k) - y*sin(k)", "x*sin(k) + y*cos(k)", "z + T"])],
        [("random-walk-white-noise", ["q"]), ("random-walk-piecewise-noise", ["q"])],
        [
            model("azimuth-elevation", 0.05, 0.05),
            model("range-azimuth-elevation", 2.0, 0.05, 0.05),
            model("position", 2.0, 2.0, 2.0, moved=False),
        ],
    ),
    Scene(
        ["x", "y", "u"],
        [(20, 60), (-30, 30), (-5, 5)],
        [3.0, 2.0, 1.0],
        [by_matrix(3), by_formulas(["x + T*u + k", "y - k*u", "u*(1 - k) + k^2"])],
        [],
        [],
        ["kalman", "converted", "fixed-gain"],
    ),
]
