"""The self-test: what is wrong must be refused.

Published numbers are moved by one unit in the last place, both ways; files, traces, certificates and rows of named models are altered; and
equations of the checker itself are replaced by mistakes that people make. Each of these must be noticed, or the self-test fails.
"""

import copy
import hashlib
import json
import math
import random
import tempfile
import tomllib
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from pathlib import Path
from unittest.mock import patch

import certificates
import check
import drawn
import mistaken
import rows
from balls import WRONG, Undecided, judge, judge_rounded, set_bits, three_digits
from compare import Tally, leaves, plain

SEED = 20001
BITS = 2048  # enough for every short case, its zeros included
SHOWN = 40
ANSWERS = 12
KINDS = 4
LONG = 6  # the number of steps drawn from longer runs


def main():
    """Runs all parts; gives the exit status."""
    folder = check.FIXTURES / "cases"
    entries = json.loads((folder / "lock.json").read_text())["cases"]
    missed = moved_numbers(folder, entries) + altered_traces(folder, entries) + altered_files(folder, entries)
    missed += mistaken_equations(folder) + altered_certificates(check.FIXTURES / "certificates")
    set_bits(rows.BITS)
    missed += altered_models(check.FIXTURES.parent / "spec" / "models.toml") + altered_answers()
    for sentence in missed[:SHOWN]:
        print(f"NOT NOTICED  {sentence}")
    print("every mistake is noticed" if not missed else f"{len(missed)} mistakes are not noticed")
    return 1 if missed else 0


def load(folder, id):
    return [json.loads((folder / f"{id}.{kind}.json").read_text()) for kind in ("problem", "trace")]


def decided(raw, trace):
    """The values of a run with enough bits for its trace."""
    for bits in check.BITS:
        try:
            if not any(tally.is_open() for tally in check.attempt(raw, trace, bits)):
                return check.computed(raw, bits)
        except Undecided:
            pass
    raise ValueError("a trace that is not decided")


# ------------------------------------------------------------------------------------------------------- numbers and traces


def moved_numbers(folder, entries):
    """Every number of a step, one unit in the last place up and down, and every scale, two in its third digit; of long runs some steps."""
    return in_parallel(moved_in_a_case, folder, entries, "numbers moved by one in the last place")


def in_parallel(test, folder, entries, what):
    """Runs a test of one case on all of them; each gives how much it tried and what was not noticed."""
    missed, tried = [], 0
    with ProcessPoolExecutor(2) as pool:
        for count, unnoticed in pool.map(test, [folder] * len(entries), [entry["id"] for entry in entries]):
            tried += count
            missed += unnoticed
            check.progress(f"{tried} {what}")
    check.progress("")
    print(f"{tried} {what}")
    return missed


def moved_in_a_case(folder, id):
    raw, trace = load(folder, id)
    if "rejected" in trace:
        return 0, []
    steps, units = decided(raw, trace)
    drawn = random.Random(f"{SEED} {id}").sample(range(len(steps)), min(LONG, len(steps)))
    missed, moved = [], 0
    for section in ("steps", "scale"):
        for k in drawn:
            parts = trace[section][k], steps[k], units[k]
            for place, number, ball, unit in leaves(*parts, "", Tally()):
                for neighbour, verdict in neighbours(section, number, ball, unit):
                    moved += 1
                    if verdict != WRONG:
                        missed.append(f"{id} {section}[{k}].{place}: {neighbour} for {number}")
    return moved, missed


def neighbours(section, number, ball, unit):
    """The next numbers that could stand there, and what is said of them."""
    if section == "steps":
        for side in (-math.inf, math.inf):
            neighbour = math.nextafter(float(number), side)
            yield neighbour, judge(ball, neighbour, unit)
    else:
        for sign in (-1, 1):
            neighbour = next_decimal(number, sign)
            yield neighbour, judge_rounded(unit, neighbour)


def next_decimal(number, sign):
    """The second neighbour among the decimals of three digits: in the middle of two the first one is right, too."""
    digits, exponent = three_digits(number)
    if digits + 2 * sign < 100:
        return float(f"{998 + digits - 100}e{exponent - 1}")
    return float(f"{digits + 2 * sign}e{exponent}")


def altered_traces(folder, entries):
    """Some kinds of alteration in each short trace, at places drawn at random, through the whole comparison."""
    return in_parallel(altered_in_a_case, folder, entries, "traces altered")


def altered_in_a_case(folder, id):
    raw, trace = load(folder, id)
    if "rejected" in trace or len(trace["steps"]) > LONG:
        return 0, []
    draw, missed = random.Random(f"{SEED} {id}"), []
    steps, units = check.computed(raw, BITS)
    for what in draw.sample(sorted(ALTERATIONS), KINDS):
        other = copy.deepcopy(trace)
        ALTERATIONS[what](other, draw)
        if not is_refused(check.compared(other, steps, units)):
            missed.append(f"{id}: {what}")
    return KINDS, missed


def is_refused(tallies):
    return any(verdict == WRONG for tally in tallies for verdict, _, _ in tally.places)


def one_number(section, change):
    """An alteration of one number of a section."""

    def alter(trace, draw):
        holder, key = draw.choice(list(numbers(trace[section])))
        holder[key] = change(holder[key])

    return alter


def numbers(tree):
    """Every place of a tree that holds a number, but for the steps' own."""
    for key, part in tree.items() if isinstance(tree, dict) else enumerate(tree):
        if isinstance(part, (dict, list)):
            yield from numbers(part)
        elif key != "step":
            yield tree, key


def without_a_key(trace, draw):
    step = draw.choice(trace["steps"])
    holder = draw.choice([step, *step["modes"]])
    del holder[draw.choice(sorted(set(holder) - {"step"}))]


def with_a_key(trace, draw):
    draw.choice(draw.choice(trace["steps"])["modes"])["skewness"] = 0.0


def without_an_entry(trace, draw):
    draw.choice(trace["steps"])["mode_probabilities"].pop()


ALTERATIONS = {
    "a value, by one in the last place": one_number("steps", lambda x: math.nextafter(x, math.inf)),
    "a value of null": one_number("steps", lambda x: None),
    "a value of infinity": one_number("steps", lambda x: math.inf),
    "a scale of zero": one_number("scale", lambda x: 0.0),
    "a noise that is negative": one_number("noise", lambda x: -x),
    "a noise that is nothing": one_number("noise", lambda x: math.nan),
    "a value that is missing": without_a_key,
    "a value too many": with_a_key,
    "a mode too few": without_an_entry,
    "a step too few": lambda trace, draw: trace["steps"].pop(),
    "a scale of a step too few": lambda trace, draw: trace["scale"].pop(),
    "a noise of a step too few": lambda trace, draw: trace["noise"].pop(),
    "another order of the steps": lambda trace, draw: trace["steps"][0].update(step=2),
}


def altered_files(folder, entries):
    """A file that is not the one of lock.json, and a rejected problem in which nothing is wrong."""
    missed = []
    with tempfile.TemporaryDirectory() as other:
        entry = entries[0]
        for kind in ("problem", "trace"):
            for name in ("problem", "trace"):
                content = (folder / f"{entry['id']}.{name}.json").read_bytes()
                Path(other, f"{entry['id']}.{name}.json").write_bytes(content + b" " if name == kind else content)
            if len(check.check_case(Path(other), entry).places()) != 1:
                missed.append(f"{entry['id']}: a blank at the end of the {kind}")
        sound, _ = load(folder, entry["id"])
        claim = {"format": "immaculate-trace/1", "id": entry["id"], "rejected": {"class": "shape", "reason": ""}}
        lock = {"id": entry["id"]}
        for name, content in (("problem", sound), ("trace", claim)):
            written = json.dumps(content).encode()
            Path(other, f"{entry['id']}.{name}.json").write_bytes(written)
            lock[name] = hashlib.sha256(written).hexdigest()
        if len(check.check_case(Path(other), lock).places()) != 1:
            missed.append(f"{entry['id']}: a sound problem that is said to be rejected")
    return missed


# --------------------------------------------------------------------------------------------------------- mistaken equations


def mistaken_equations(folder):
    """Each mistake makes the checker refuse a case that it proves without it, first in the value where the mistake is made."""
    missed = []
    for name, value, target, replacement, id in mistaken.EQUATIONS:
        raw, trace = load(folder, id)
        if any(tally.places for tally in check.attempt(raw, trace, BITS)):
            missed.append(f"{name}: {id} is not proven without it")
        with patch(target, replacement):
            places = check.attempt(raw, trace, BITS)[0].places
        if not (places and places[0][0] == WRONG and f".{value}" in places[0][1]):
            missed.append(f"{name} in {id}: {places[0] if places else 'proven'}")
    print(f"{len(mistaken.EQUATIONS)} equations replaced by mistakes")
    return missed


# --------------------------------------------------------------------------------------------------------------- certificates


def altered_certificates(folder):
    """What does not follow is refused, with a digest that belongs to it; and another digest is."""
    missed, altered = [], 0
    for path in sorted(folder.glob("*.json")):
        certificate = json.loads(path.read_text())
        for what, alter in CERTIFICATE_ALTERATIONS.items():
            other = copy.deepcopy(certificate)
            if not alter(other):
                continue
            altered += 1
            if what != "another digest":
                other["digest"] = certificates.digest(other)
            try:
                certificates.prove(other)
                missed.append(f"{path.name}: {what}")
            except certificates.Unproven:
                pass
    print(f"{altered} certificates altered")
    return missed


def in_stable(alter):
    """An alteration of certificates of stability alone."""

    def guarded(certificate):
        if "stable" not in certificate["proof"]:
            return False
        alter(certificate["proof"]["stable"])
        return True

    return guarded


def in_unstable(key, text):
    def guarded(certificate):
        if "unstable" not in certificate["proof"]:
            return False
        certificate["proof"]["unstable"][key] = text
        return True

    return guarded


def another_digest(certificate):
    certificate["digest"] = certificate["digest"][::-1]
    return True


def other_filters(certificate):
    """Filters for which the same proof does not hold: undamped ones, or ones that are alike."""
    certificate["filters"] = {"damping-roots": ["1/1000", "999/1000"] if "stable" in certificate["proof"] else ["1/2", "1/2"]}
    return True


UNIT_FORM = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]
CERTIFICATE_ALTERATIONS = {
    "another digest": another_digest,
    "other filters": other_filters,
    "a form that is negative": in_stable(lambda proof: proof["forms"][0][0].__setitem__(0, "-1")),
    "a form that is not symmetric": in_stable(lambda proof: proof["forms"][0][0].__setitem__(1, "1/3")),
    "a form that does not fall": in_stable(lambda proof: proof["forms"].__setitem__(0, UNIT_FORM)),
    "an edge too few": in_stable(lambda proof: proof["edges"].pop()),
    "an edge to nowhere": in_stable(lambda proof: proof["edges"][0].__setitem__(2, 7)),
    "no form and no edge": in_stable(lambda proof: proof.update(forms=[], edges=[])),
    "a greater radius": in_unstable("radius", "3/2"),
    "a radius of one": in_unstable("radius", "1"),
    "a word that is stable": in_unstable("word", "v"),
    "the empty word": in_unstable("word", ""),
}


# -------------------------------------------------------------------------------------------------------------- named models


def altered_models(path):
    """One digit of each result of an example, and each formula a little greater."""
    missed, altered = [], 0
    for row in tomllib.loads(path.read_text())["model"]:
        for what, is_noticed in alterations_of_row(row):
            altered += 1
            if not is_noticed:
                missed.append(f"models.toml, {row['id']}: {what}")
    print(f"{altered} results and formulas of named models altered")
    return missed


def alterations_of_row(row):
    """What is altered, and whether it is noticed."""
    for example in row["example"]:
        for i, text in enumerate(example["result"]):
            other = copy.deepcopy(example)
            other["result"][i] = text[:-1] + ("1" if text[-1] != "1" else "2")
            yield f"result {text}", rows.wrong_results(row, other)
    for key in ("formulas", "Q", "G"):
        for i, line in enumerate(row.get(key, [])):
            for j in range(1 if key == "formulas" else 0, len(line)):
                other = copy.deepcopy(row)
                other[key][i][j] = f"{line[j]} + T/1000"
                yield f"{key} {line[j]}", not rows.agrees(other, random.Random(SEED))


# ------------------------------------------------------------------------------------------------------------ drawn problems


def altered_answers():
    """A program's answer to a drawn problem is proven, and no longer when one of its numbers is moved or left out."""
    missed = []
    for index in range(ANSWERS):
        draw = random.Random(f"{SEED} {index}")
        raw = drawn.problem(draw, f"drawn-{index}")
        answer = answer_of(check.computed(raw, BITS)[0])
        if drawn.prove(raw, answer).places:
            missed.append(f"drawn-{index}: an answer that is right is refused")
        key = draw.choice(sorted(answer, key=str))
        numbers_of_one = drawn.flat(answer[key])
        place = draw.randrange(len(numbers_of_one))
        moved = [math.nextafter(x, math.inf) if i == place else x for i, x in enumerate(numbers_of_one)]
        for what, other in (("moved", {**answer, key: moved}), ("left out", {k: x for k, x in answer.items() if k != key})):
            if not drawn.prove(raw, other).places:
                missed.append(f"drawn-{index}: {key} {what}")
    print(f"{ANSWERS} answers to drawn problems altered")
    return missed


def answer_of(steps):
    """What a right program prints of these values."""
    answer = {}
    for k, step in enumerate(steps, 1):
        for j, mode in enumerate(step["modes"]):
            answer |= {(k, j, name): x for name, x in quantities(mode)}
        answer |= {(k, name): x for name, x in quantities({name: x for name, x in step.items() if name != "modes"})}
    return answer


def quantities(values):
    """Every quantity by its name, with a dot where it is nested."""
    for name, value in plain(values).items():
        value = plain(value)
        if isinstance(value, dict):
            yield from ((f"{name}.{inner}", x) for inner, x in quantities(value))
        else:
            yield name, [nearest(ball) for ball in drawn.flat(value)]


def nearest(ball):
    """The double nearest to the middle, of which the last bits are noise: a tie is one again with fewer. Zero has no sign."""
    middle = ball.mid().fmpq()
    few_bits = 2 ** (3 * BITS // 4)
    return float(Fraction(round(Fraction(int(middle.p), int(middle.q)) * few_bits), few_bits)) + 0.0
