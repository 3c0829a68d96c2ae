"""Named models of motions and of measurements, written from the literature; `spec/models.toml` has them as formulas and is not read here.

A motion takes the entries of the state by name, and what else is given, and gives the entries that it moves. Ways along an arc are written
as chords, which have no division by the turn rate: an arc of the length s that turns by a ends s · sin(a/2)/(a/2) away, in the direction of
its middle.
"""

from math import factorial

from flint import arb

from balls import raised
from formulas import Refused, atan2, bessel_1, cos, hypot, sin, sinc

DERIVATIVES = ("", "v", "a", "j")  # x, its velocity, acceleration and jerk


def taylor(order):
    """Each axis by itself: the entries of the state are derivatives of the position, and the last of them is constant."""

    def motion(x, given):
        moved = {}
        for axis in "xyz":
            chain = [f"{letter}{axis}" for letter in DERIVATIVES[: order + 1]]
            if not set(chain) <= set(x):
                continue
            for i, entry in enumerate(chain):
                terms = [x[higher] * raised(given("T"), k) * (arb(1) / factorial(k)) for k, higher in enumerate(chain[i:])]
                moved[entry] = sum(terms[1:], terms[0])
        return moved

    return motion


def singer(x, given):
    """Singer 1970: an acceleration that decays as e^(−αt). (1 − e^(−b))/b = ₁F₁(1; 2; −b), (b − 1 + e^(−b))/b² = ₁F₁(1; 3; −b)/2."""
    time, decay = given("T"), given("alpha") * given("T")
    to_velocity = time * (-decay).hypgeom([arb(1)], [arb(2)])
    to_position = time * time * (-decay).hypgeom([arb(1)], [arb(3)]) / 2
    moved = {}
    for axis in "xyz":
        if {axis, f"v{axis}", f"a{axis}"} <= set(x):
            acceleration = x[f"a{axis}"]
            moved[axis] = x[axis] + x[f"v{axis}"] * time + acceleration * to_position
            moved[f"v{axis}"] = x[f"v{axis}"] + acceleration * to_velocity
            moved[f"a{axis}"] = acceleration * (-decay).exp()
    return moved


def turn(x, rate, time):
    """zhu2016 (61): sin ωT/ω = T sinc ωT, and (1 − cos ωT)/ω = ωT²/2 · sinc²(ωT/2), as 1 − cos a = 2 sin²(a/2)."""
    angle = rate * time
    along = time * sinc(angle)
    across = time * (angle / 2) * sinc(angle / 2) * sinc(angle / 2)
    return {
        "x": x["x"] + along * x["vx"] - across * x["vy"],
        "vx": cos(angle) * x["vx"] - sin(angle) * x["vy"],
        "y": x["y"] + across * x["vx"] + along * x["vy"],
        "vy": sin(angle) * x["vx"] + cos(angle) * x["vy"],
    }


def turn_of_known_rate(x, given):
    return turn(x, given("w"), given("T"))


def turn_of_unknown_rate(x, given):
    return {**turn(x, x["w"], given("T")), "w": x["w"]}


def constant_turn_and_speed(x, given):
    """Schubert, Richter and Wanielik 2008, CTRV: a chord of the arc of the length vT."""
    half = x["w"] * given("T") / 2
    chord = x["v"] * given("T") * sinc(half)
    return {
        "x": x["x"] + chord * cos(x["heading"] + half),
        "y": x["y"] + chord * sin(x["heading"] + half),
        "v": x["v"],
        "heading": x["heading"] + 2 * half,
        "w": x["w"],
    }


def constant_turn_and_acceleration(x, given):
    """The same source, CTRA: ∫(v + aτ)(cos, sin)(ψ + ωτ)dτ, about the middle of the step: τ = T/2 + s.

    With v, ψ in the middle the integral of v cos(ψ + ωs) is the chord; that of as cos(ψ + ωs) is −a sin ψ ∫s sin ωs ds, and
    ∫s sin ωs ds from −T/2 to T/2 is 2(T/2)² j₁(ωT/2), j₁(x) = sin x/x² − cos x/x.
    """
    time = given("T")
    half = x["w"] * time / 2
    chord = (x["v"] + x["a"] * time / 2) * time * sinc(half)
    swing = x["a"] * (time * time / 2) * bessel_1(half)
    middle = x["heading"] + half
    return {
        "x": x["x"] + chord * cos(middle) - swing * sin(middle),
        "y": x["y"] + chord * sin(middle) + swing * cos(middle),
        "v": x["v"] + x["a"] * time,
        "heading": x["heading"] + 2 * half,
        "a": x["a"],
        "w": x["w"],
    }


def bicycle(x, given):
    """Kong and others 2015: tan β = l_r tan δ/(l_f + l_r), ψ̇ = v sin β/l_r = v cos β tan δ/(l_f + l_r), constant inputs: an arc."""
    time, base = given("T"), given("front") + given("rear")
    slip = (given("rear") * given("steer").tan() / base).atan()
    length = time * (x["v"] + given("a") * time / 2)
    angle = length * (slip.cos() * given("steer").tan() / base)
    chord = length * sinc(angle / 2)
    middle = x["heading"] + slip + angle / 2
    return {
        "x": x["x"] + chord * cos(middle),
        "y": x["y"] + chord * sin(middle),
        "v": x["v"] + given("a") * time,
        "heading": x["heading"] + angle,
    }


MOTIONS = {
    "random-walk": taylor(0),
    "constant-velocity": taylor(1),
    "constant-acceleration": taylor(2),
    "constant-jerk": taylor(3),
    "singer": singer,
    "coordinated-turn": turn_of_known_rate,
    "coordinated-turn-unknown-rate": turn_of_unknown_rate,
    "constant-turn-rate-and-speed": constant_turn_and_speed,
    "constant-turn-rate-and-acceleration": constant_turn_and_acceleration,
    "bicycle": bicycle,
}


def motion(name, state, given, others):
    """The motion of all entries of the state, as a function of a list of numbers."""
    if name not in MOTIONS:
        raise Refused(f"the motion `{name}` is not written here: add it to models.py, from its source")

    def function(numbers):
        before = dict(zip(state, numbers))
        after = MOTIONS[name](before, given)
        if others is None and set(after) != set(state):
            raise Refused(f"`{name}` does not move every entry of the state, and `others` is not there")
        return [after.get(entry, before[entry] * (1 if others == "keep" else 0)) for entry in state]

    return function


# ------------------------------------------------------------------------------------------------------------- measurements


def away(x, given, axes="xy"):
    """Where the target is, seen from the sensor."""
    return [x[axis] - given(f"sensor_{axis}") for axis in axes]


def speed_away(x, given, axes="xy"):
    """How fast the distance grows: the velocity along the line of sight."""
    place = away(x, given, axes)
    velocity = [x[f"v{axis}"] - given(f"sensor_v{axis}") for axis in axes]
    products = [p * v for p, v in zip(place, velocity)]
    return sum(products[1:], products[0]) / length(place)


def length(place):
    return place[0] if len(place) == 1 else hypot(place[0], length(place[1:]))


def bearing(x, given):
    east, north = away(x, given)
    return atan2(north, east)


def elevation(x, given):
    return atan2(away(x, given, "z")[0], length(away(x, given)))


def speed_away_of_heading(x, given):
    east, north = away(x, given)
    return x["v"] * (east * cos(x["heading"]) + north * sin(x["heading"])) / hypot(east, north)


def range_(axes):
    return "range", lambda x, given: length(away(x, given, axes))


def rate(axes):
    return "range_rate", lambda x, given: speed_away(x, given, axes)


BEARING, AZIMUTH, ELEVATION = ("bearing", bearing), ("azimuth", bearing), ("elevation", elevation)
POSITION = [(axis, lambda x, given, axis=axis: x[axis]) for axis in "xyz"]
ANGLES = {"bearing", "azimuth", "elevation"}

MEASUREMENTS = {
    "position": POSITION,
    "position-and-range-rate": POSITION[:2] + [rate("xy")],
    "range": [range_("xy")],
    "bearing": [BEARING],
    "range-bearing": [range_("xy"), BEARING],
    "range-bearing-range-rate": [range_("xy"), BEARING, rate("xy")],
    "range-bearing-range-rate-of-heading": [range_("xy"), BEARING, ("range_rate", speed_away_of_heading)],
    "azimuth-elevation": [AZIMUTH, ELEVATION],
    "range-azimuth-elevation": [range_("xyz"), AZIMUTH, ELEVATION],
    "range-azimuth-elevation-range-rate": [range_("xyz"), AZIMUTH, ELEVATION, rate("xyz")],
}


def measurement(name, state, given):
    """A named measurement as a function of a list of numbers, and which of its entries are angles."""
    if name not in MEASUREMENTS:
        raise Refused(f"the measurement `{name}` is not written here: add it to models.py, from its source")
    parts = [(entry, part) for entry, part in MEASUREMENTS[name] if name != "position" or entry in state]

    def function(numbers):
        x = dict(zip(state, numbers))
        return [part(x, given) for _, part in parts]

    return function, [entry in ANGLES for entry, _ in parts]
