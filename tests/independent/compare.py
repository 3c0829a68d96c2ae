"""A published trace against the values that were computed: every number, and nothing missing or too much."""

from flint import arb, arb_mat

from balls import AS_POINT, OPEN, PROVEN, WRONG, judge, judge_rounded
from filters import Estimate


class Tally:
    """How many numbers have which verdict, and the places of those that are not proven."""

    def __init__(self):
        self.counts = {PROVEN: 0, AS_POINT: 0}
        self.places = []

    def add(self, verdict, place, text):
        if verdict in self.counts:
            self.counts[verdict] += 1
        else:
            self.places.append((verdict, place, text))

    def is_open(self):
        """Whether more bits may decide something."""
        return any(verdict == OPEN for verdict, _, _ in self.places)


def plain(value):
    """Matrices as lists: a matrix of one column is a vector."""
    if isinstance(value, Estimate):
        value = {"mean": value.mean, "covariance": value.covariance}
    if isinstance(value, dict):
        return {name: plain(part) for name, part in value.items() if part is not None}
    return value


def leaves(published, values, units, place, tally):
    """Walks published numbers and computed ones side by side: yields the place, the number, the ball and its unit."""
    values = plain(values)
    if isinstance(values, dict):
        if not isinstance(published, dict) or set(published) - {"step"} != set(values):
            tally.add(WRONG, place, f"has {names(published)} where {names(values)} are computed")
            return
        for name in published:
            if name != "step":
                yield from leaves(published[name], values[name], units[name], f"{place}.{name}" if place else name, tally)
    elif isinstance(values, (list, arb_mat)):
        values = listed(values, units)
        if not isinstance(published, list) or len(published) != len(values):
            tally.add(WRONG, place, f"is no list of {len(values)}")
            return
        for i, parts in enumerate(zip(published, values, units, strict=True)):
            yield from leaves(*parts, f"{place}[{i}]", tally)
    else:
        yield place, published, values, units


def listed(values, units):
    """A matrix as a list of rows, or of numbers where the units are a list of numbers."""
    if not isinstance(values, arb_mat):
        return values
    return values.entries() if isinstance(units[0], arb) else values.table()


def names(values):
    return ", ".join(sorted(values)) if isinstance(values, dict) else "no object"


def compare_values(published, values, units, tally):
    """Every number of `steps`."""
    each(published, values, units, tally, "steps", lambda number, ball, unit: judge(ball, None if number is None else float(number), unit))


def compare_scale(published, values, units, tally):
    """Every number of `scale`: the unit, rounded to three significant digits."""
    each(published, values, units, tally, "scale", lambda number, _ball, unit: judge_rounded(unit, number))


def each(published, values, units, tally, section, verdict_of):
    """Walks all steps of a section and judges every number."""
    if not isinstance(published, list) or len(published) != len(values):
        tally.add(WRONG, section, f"has not {len(values)} steps")
        return
    for k, (step, value, unit) in enumerate(zip(published, values, units, strict=True)):
        if step.get("step") != k + 1:
            tally.add(WRONG, f"{section}[{k}]", "is not the next step")
        for place, number, ball, its_unit in leaves(step, value, unit, "", tally):
            is_number = number is None or type(number) in (int, float)
            verdict = verdict_of(number, ball, its_unit) if is_number else WRONG
            text = "" if verdict in tally.counts else f"{number!r} where {ball.str(20)} is computed, in units of {its_unit.str(3)}"
            tally.add(verdict, f"{section}[{k}].{place}", text)


# The least and the greatest rounding noise that can be meant: half the last place of a number near its unit, and a loss of every digit.
LEAST_NOISE, GREATEST_NOISE = 2.0**-54, 1.0


def compare_noise(published, values, tally):
    """Every quantity has one positive number; it is a measurement, of which only the size can be judged."""
    if not isinstance(published, list) or len(published) != len(values):
        tally.add(WRONG, "noise", f"has not {len(values)} steps")
        return
    for k, (step, value) in enumerate(zip(published, values)):
        for place, noise in noises(step, value, f"noise[{k}]", tally):
            plausible = isinstance(noise, float) and LEAST_NOISE <= noise <= GREATEST_NOISE
            tally.add(PROVEN if plausible else WRONG, place, f"{noise!r} is no rounding noise")


def noises(published, values, place, tally):
    """As `leaves`, with one number a quantity."""
    values = plain(values)
    if isinstance(values, dict):
        if not isinstance(published, dict) or set(published) - {"step"} != set(values):
            tally.add(WRONG, place, f"has {names(published)} where {names(values)} are computed")
            return
        for name, part in values.items():
            yield from noises(published[name], part, f"{place}.{name}", tally)
    elif isinstance(values, list) and isinstance(values[0], dict):
        if not isinstance(published, list) or len(published) != len(values):
            tally.add(WRONG, place, f"is no list of {len(values)}")
            return
        for i, (one, part) in enumerate(zip(published, values)):
            yield from noises(one, part, f"{place}[{i}]", tally)
    else:
        yield place, published
