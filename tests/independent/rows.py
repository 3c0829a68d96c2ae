"""The rows of `spec/models.toml` against the models as they are written here: their worked examples, and their formulas.

An example must have every digit that is written. The formulas of a row are run at places drawn at random, with their slopes: they must give
what `models.py` and `noises.py` give, which share nothing with them.
"""

import random
import tomllib
from fractions import Fraction

from flint import arb, arb_mat, fmpq

from balls import column, raised, set_bits
from formulas import Curved, Scope, evaluate
from models import measurement, motion
from noises import noise

BITS = 256
SEED, PLACES = 20002, 3
AGREEMENT = arb(10) ** -40  # of the order of the numbers, which are below ten
EXACT = 28  # a result with fewer digits is the exact one


def check(path):
    """What is wrong with the rows: gives sentences, and how many results and places were compared."""
    wrong, results, places = [], 0, 0
    for row in tomllib.loads(path.read_text())["model"]:
        wrong += check_row(row)
        results += sum(len(example["result"]) for example in row["example"])
        places += PLACES
    return wrong, results, places


def check_row(row):
    """What is wrong with a row."""
    set_bits(BITS)
    wrong = []
    for example in row["example"]:
        wrong += wrong_results(row, example)
    for place in range(PLACES):
        if not agrees(row, random.Random(f"{SEED} {row['id']} {place}")):
            wrong.append(f"models.toml, {row['id']}: its formulas are another model")
    return wrong


def number(text):
    fraction = Fraction(text)
    return arb(fmpq(fraction.numerator, fraction.denominator))


def defaults(row):
    return {parameter["name"]: number(parameter["default"]) for parameter in row.get("parameters", []) if "default" in parameter}


def written_here(row, state, given):
    """The model as a function of the numbers of the state; a noise as the list of its entries."""
    if row["kind"] == "motion":
        return motion(row["id"], state, given, "keep")
    if row["kind"] == "measurement":
        return measurement(row["id"], state, given)[0]
    return lambda numbers: noise(row["id"], state, lambda name: dict(zip(state, numbers)).get(name) or given(name)).entries()


def wrong_results(row, example):
    """The results of an example that are not what is computed here."""
    state = [name for name, _ in example["state"]]
    numbers = [number(text) for _, text in example["state"]]
    pairs = example.get("parameters", []) + example.get("given", [])
    given = Scope({**defaults(row), **{name: number(text) for name, text in pairs}}, [])
    computed = written_here(row, state, given)(numbers)
    if len(computed) != len(example["result"]):
        return [f"models.toml, {row['id']}: {len(example['result'])} results where {len(computed)} are computed"]
    return [
        f"models.toml, {row['id']}: {text} where {ball.str(32)} is computed"
        for text, ball in zip(example["result"], computed)
        if not is_written(ball, text)
    ]


def is_written(ball, text):
    """Whether the digits are those of the number: of a long one the nearest, a short one is exact."""
    digits = text.lstrip("-").replace(".", "").lstrip("0")
    if len(digits) < EXACT:
        return ball.contains(number(text)) and ball.rad() < AGREEMENT
    behind = len(text.partition(".")[2])
    return abs(ball - number(text)) <= arb(10) ** -behind / 2


# ----------------------------------------------------------------------------------------------------------------- formulas


def agrees(row, draw):
    """Whether the formulas of a row, and their slopes, are those that are written here, at a place drawn at random."""
    axes = row.get("axes", [""])
    state = [named(name, axis) for axis in axes for name, *_ in row["state"]]
    numbers = [drawn(draw) for _ in state]
    names = ["T"] + [entry[0] for entry in row.get("inputs", [])] + [parameter["name"] for parameter in row.get("parameters", [])]
    known = {name: drawn(draw) for name in names}
    here = written_here(row, state, Scope(known, []))
    if row["kind"] == "noise":
        theirs = noise_of_row(row, state, axes, {**known, **dict(zip(state, numbers))})
        return near(arb_mat([here(numbers)]), arb_mat([theirs.entries()]))
    texts = [(named(name, axis), named(text, axis)) for axis in axes for name, text in row["formulas"]]
    if row["kind"] == "motion":
        texts.sort(key=lambda pair: state.index(pair[0]))

    def theirs(values):
        scope = Scope({**known, **dict(zip(state, values))}, row.get("definitions", []))
        return [evaluate(text, scope) for _, text in texts]

    place = column(numbers)
    here, theirs = Curved(here), Curved(theirs)
    return near(here.at(place), theirs.at(place)) and near(here.slopes(place), theirs.slopes(place))


def noise_of_row(row, state, axes, known):
    """Q of a row: given by its entries, or as G diag(q) Gᵀ; the axes know nothing of each other."""
    scope = Scope(known, row.get("definitions", []))
    if "Q" in row:
        block = arb_mat([[evaluate(text, scope) for text in line] for line in row["Q"]])
    else:
        enters = arb_mat([[evaluate(text, scope) for text in line] for line in row["G"]])
        variances = [evaluate(text, scope) for text in row["q"]]
        spread = arb_mat([[entry * variance for entry, variance in zip(line, variances)] for line in enters.table()])
        block = spread * enters.transpose()
    size = block.nrows()
    total = arb_mat(len(state), len(state))
    for offset in range(0, size * len(axes), size):
        for i in range(size):
            for j in range(size):
                total[offset + i, offset + j] = block[i, j]
    return total


def named(text, axis):
    return text.replace("@", axis)


def drawn(draw):
    """A number from ¼ to 1¼, of twelve bits, so that no angle leaves its quadrant's double and every sensor sees something."""
    return arb(draw.randrange(1024, 5120)) * raised(arb(2), -12)


def near(one, other):
    """Whether all entries agree, and are known well enough to tell."""
    if (one.nrows(), one.ncols()) != (other.nrows(), other.ncols()):
        return False
    return all(abs(difference) < AGREEMENT for difference in (one - other).entries())
