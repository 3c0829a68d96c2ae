"""Named models, written from the literature as integrals of the motion; `spec/models.toml` is not read.

A motion takes the entries of the state and the parameters by name, and gives the entries after the step. What spec/models.toml writes with
Stumpff functions is written here with sin x/x.
"""

from formulas import Refused, cos, sin, sinc


def constant_velocity(x, given):
    """liu2017 (26), for each axis whose velocity is in the state."""
    moved = {}
    for axis in "xyz":
        if f"v{axis}" in x:
            moved[axis] = x[axis] + given("T") * x[f"v{axis}"]
            moved[f"v{axis}"] = x[f"v{axis}"]
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


MOTIONS = {
    "constant-velocity": constant_velocity,
    "coordinated-turn": turn_of_known_rate,
    "coordinated-turn-unknown-rate": turn_of_unknown_rate,
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
