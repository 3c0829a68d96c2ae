"""Problems drawn at random, on which a program's certified doubles are proven: what no published case has is met here.

Named models and formulas, angles in the state, several sensors, filters that differ between modes, steps that differ in everything, missing
entries, modes that cannot be reached, modes with states of their own, fixed gains and conversions. The program is asked with
`trace --as python FILE`.
"""

import ast
import json
import os
import random
import shlex
import subprocess
import tempfile
from pathlib import Path

import check
import scenes
from balls import OPEN, WRONG, Undecided, judge
from compare import Tally, plain

SEED = 20003
FORMAT_POINT = 2.0**-200  # what is smaller than this part of its unit may be certified as zero


def main(count):
    """Draws a number of problems; returns the number of those in which something is not proven."""
    program = shlex.split(os.environ.get("IMMACULATE", "cargo run --quiet --release --locked --"))
    failures = numbers = 0
    with tempfile.TemporaryDirectory() as folder:
        for index in range(count):
            raw = problem(random.Random(f"{SEED} {index}"), f"drawn-{index}")
            file = Path(folder, "problem.json")
            file.write_text(json.dumps(raw))
            answer = subprocess.run([*program, "trace", "--as", "python", str(file)], capture_output=True, text=True, check=False)
            if answer.returncode:
                failures += check.complain(f"{raw['id']}: refused: {answer.stderr.strip()[-300:]}: {json.dumps(raw)}")
                continue
            tally = prove(raw, read(answer.stdout))
            numbers += sum(tally.counts.values())
            for verdict, place, text in tally.places[:3]:
                check.complain(f"{raw['id']}: {place} is {verdict}: {text}: {json.dumps(raw)}")
            failures += bool(tally.places)
            check.progress(f"{index + 1} problems drawn")
    check.progress("")
    print(f"{numbers} numbers of {count} drawn problems proven")
    return failures


def read(text):
    """The assignments `expected[STEP, …, NAME] = NUMBERS`."""
    found = {}
    for statement in ast.parse(text).body:
        target = statement.targets[0]
        if isinstance(target, ast.Subscript):
            found[ast.literal_eval(target.slice)] = ast.literal_eval(statement.value)
    return found


def prove(raw, expected):
    """Every number that the program printed."""
    for bits in check.BITS:
        tally = Tally()
        try:
            steps, units = check.computed(raw, bits)
        except Undecided as error:
            tally.add(WRONG, "steps", f"{bits} bits do not tell {error}")
            continue
        for (step, *mode, name), numbers in expected.items():
            values, unit = steps[step - 1], units[step - 1]
            if mode:
                values, unit = values["modes"][mode[0]], unit["modes"][mode[0]]
            compare(numbers, part(values, name), part(unit, name), (step, *mode, name), tally)
        printed = sum(len(flat(numbers)) for numbers in expected.values())
        if printed != sum(map(size, steps)):
            tally.add(WRONG, "all steps", f"{printed} numbers where {sum(map(size, steps))} are computed")
        if not tally.is_open():
            break
    return tally


def size(values):
    """How many numbers there are."""
    values = plain(values)
    if isinstance(values, dict):
        return sum(map(size, values.values()))
    if isinstance(values, list):
        return sum(map(size, values))
    return len(values.entries()) if hasattr(values, "entries") else 1


def part(values, name):
    for key in name.split("."):
        values = plain(values)[key]
    return values


def compare(numbers, values, units, place, tally):
    numbers, values, units = flat(numbers), flat(values), flat(units)
    if len(numbers) != len(values):
        tally.add(WRONG, place, f"has {len(numbers)} numbers where {len(values)} are computed")
        return
    for number, ball, unit in zip(numbers, values, units, strict=True):
        verdict = judge(ball, number, unit)
        if verdict in (WRONG, OPEN) and number == 0 and abs(ball) < FORMAT_POINT * unit:
            continue
        tally.add(verdict, place, f"{number!r} where {ball.str(20)} is computed")


def flat(values):
    """All numbers of a matrix or of nested lists."""
    if hasattr(values, "entries"):
        return values.entries()
    return [entry for value in values for entry in flat(value)] if isinstance(values, list) else [values]


# ------------------------------------------------------------------------------------------------------------- the problems


def problem(draw, id):
    """A problem of format 2."""
    scene = draw.choice(scenes.SCENES)
    count = draw.choice([1, 2, 2, 3])
    filter = scene.filter(draw)
    modes = [mode(draw, scene, f"mode {j}", filter) for j in range(count)]
    sensors = [sensor(draw, scene, filter) for _ in range(draw.choice([1, 1, 2]))]
    means = means_of(draw, scene, count)
    raw = {
        "format": "immaculate-problem/2",
        "id": id,
        "state": scene.state,
        "parameters": {"T": number(draw, 0.2, 1.2)},
        "modes": modes,
        **sensors[0],
        "sensors": [{"name": f"sensor {s}", **other} for s, other in enumerate(sensors[1:], 1)],
        "filter": filter,
        "transition": chain(draw, count),
        "initial": {
            "mode_probabilities": probabilities(draw, count),
            "modes": [{"mean": mean, "covariance": covariance(draw, scene.deviations)} for mean in means],
        },
        "measurements": [],
    }
    if filter["kind"] == "fixed-gain":
        with_given_gains(draw, raw, len(sensors[0]["R"]))
    for k in range(1, draw.randint(2, 5)):
        raw["measurements"].append(step(draw, scene, raw, k))
    if filter["kind"] != "fixed-gain" and count > 1 and draw.random() < 0.4:
        with_own_state(draw, raw, scene)
    if draw.random() < 0.2:
        with_rates(draw, raw, count)
    if filter["kind"] != "fixed-gain" and "conversions" not in raw and draw.random() < 0.4:
        raw["interaction"] = draw.choice(["imm", "gpb1", "unmixed"])
    return raw


def with_rates(draw, raw, count):
    """The chain by rates, or by sojourn times and jumps, of which some are zero."""
    del raw["transition"]
    if draw.random() < 0.5:
        rates = [[0 if i == j or draw.random() < 0.2 else draw.randint(1, 24) / 16 for j in range(count)] for i in range(count)]
        raw["rates"] = [[-sum(row) if i == j else rate for j, rate in enumerate(row)] for i, row in enumerate(rates)]
        return
    raw["sojourn_times"] = [number(draw, 0.3, 9) for _ in range(count)]
    raw["jumps"] = [[0.0] * count for _ in range(count)]
    for i in range(count if count > 1 else 0):
        others = [j for j in range(count) if j != i]
        parts = [draw.choice([0, 0.25, 0.5, 1])] if len(others) > 1 else []
        for j, part in zip(others, [*parts, 1 - sum(parts)]):
            raw["jumps"][i][j] = part


def with_own_state(draw, raw, scene):
    """One of the modes has a state of its own, not far from that of the others."""
    size, j = len(scene.state), draw.randrange(len(raw["modes"]))
    mode, own = raw["modes"][j], [f"u{i}" for i in range(size)]
    for key in ("f", "motion", "let", "parameters"):
        mode.pop(key, None)
    deviations = [deviation / 3 for deviation in scene.deviations]
    mode |= {"state": own, **scenes.by_matrix(size)(draw), "Q": covariance(draw, deviations)}
    names = [entry[0] for entry in scene.state]
    others = [other["name"] for other in raw["modes"] if other is not mode]
    kind = mode.get("filter", raw["filter"])["kind"]
    raw["conversions"] = [conversion(draw, own, {"from": mode["name"]}, kind in scenes.CURVED, deviations)]
    for other in others:
        raw["conversions"].append(conversion(draw, names, {"from": other, "to": mode["name"]}, True, deviations))
        raw["conversions"].append(conversion(draw, own, {"from": mode["name"], "to": other}, True, deviations))


def conversion(draw, names, ends, may_curve, deviations):
    """A matrix or formulas, near to the identity; sometimes something is added."""
    others = [names[(i + 1) % len(names)] for i in range(len(names))]
    if draw.random() < 0.4:
        found = scenes.by_matrix(len(names))(draw)["F"]
        ends = {**ends, "matrix": found}
    else:
        form = "{}*{} + {}*sin({})" if may_curve and draw.random() < 0.6 else "{}*{} + {}*{}"
        pairs = zip(names, others)
        ends = {**ends, "formulas": [form.format(number(draw, 0.8, 1.2), a, number(draw, 0.01, 0.2), b) for a, b in pairs]}
    return {**ends, "added": covariance(draw, deviations)} if draw.random() < 0.5 else ends


def number(draw, low, high):
    return round(draw.uniform(low, high), 3)


def mode(draw, scene, name, filter):
    """A motion, its noise, and sometimes a filter of its own."""
    found = {"name": name, **draw.choice(scene.motions)(draw)}
    found["Q"] = noise(draw, scene)
    if filter["kind"] in scenes.CURVED and draw.random() < 0.3:
        found["filter"] = scene.filter(draw)
    return found


def noise(draw, scene):
    """A named model, numbers, or formulas."""
    if scene.noises and draw.random() < 0.5:
        name, parameters = draw.choice(scene.noises)
        return {"model": name, "parameters": {key: number(draw, 0.1, 2) for key in parameters}}
    rows = covariance(draw, [deviation / 3 for deviation in scene.deviations])
    return rows if draw.random() < 0.5 else [[f"T*{entry}" for entry in row] for row in rows]


def sensor(draw, scene, filter):
    """A measurement and its noise."""
    measurement, deviations = draw.choice(scene.sensors_of(filter))(draw)
    rows = covariance(draw, deviations)
    if filter["kind"] == "converted":
        rows[0][1] = rows[1][0] = 0.0
    return {"measurement": measurement, "R": rows}


def means_of(draw, scene, count):
    """Estimates near to one another, angles perhaps in another turn."""
    first = [number(draw, low, high) for low, high in scene.ranges]
    means = [first]
    for _ in range(count - 1):
        mean = [round(x + draw.gauss(0, deviation), 3) for x, deviation in zip(first, scene.deviations)]
        for i, entry in enumerate(scene.state):
            if entry[2:]:
                mean[i] = round(mean[i] + draw.choice([0, 6.283, -6.283]), 3)
        means.append(mean)
    return means


def covariance(draw, deviations):
    """L Lᵀ of a lower factor with small entries, rounded: definite all the same."""
    size = len(deviations)
    factor = [[draw.uniform(-0.4, 0.4) if k < i else float(k == i) for k in range(size)] for i in range(size)]
    rows = [[0.0] * size for _ in range(size)]
    for i in range(size):
        for j in range(i + 1):
            product = sum(a * b for a, b in zip(factor[i], factor[j])) * deviations[i] * deviations[j]
            rows[i][j] = rows[j][i] = float(f"{product:.6g}")
    return rows


def probabilities(draw, count):
    """Probabilities, sometimes of zero."""
    choices = {1: [[1.0]], 2: [[0.7, 0.3], [1.0, 0.0]], 3: [[0.6, 0.3, 0.1], [0.5, 0.5, 0.0], [1.0, 0.0, 0.0]]}
    return draw.sample(found := draw.choice(choices[count]), len(found))


def chain(draw, count):
    return [probabilities(draw, count) for _ in range(count)]


def with_given_gains(draw, raw, entries):
    """Gains and innovation covariances in place of the estimates' covariances."""
    size = len(raw["state"])
    gains = [[[number(draw, -0.5, 0.6) for _ in range(entries)] for _ in range(size)] for _ in raw["modes"]]
    raw["filter"]["modes"] = [{"gain": gain, "innovation_covariance": covariance(draw, [3.0] * entries)} for gain in gains]
    raw["sensors"] = []
    for estimate in raw["initial"]["modes"]:
        del estimate["covariance"]


def step(draw, scene, raw, k):
    """What is measured near to where the first mode started, and what is another in this step."""
    count, kind = len(raw["modes"]), raw["filter"]["kind"]
    used = draw.choice([raw, *raw["sensors"]])
    at = {"step": k, **({} if used is raw else {"sensor": used["name"]})}
    numbers = scene.measured(raw, used["measurement"], raw["initial"]["modes"][0]["mean"], draw)
    if len(numbers) > 1 and kind not in ("converted", "fixed-gain") and draw.random() < 0.2:
        numbers[draw.randrange(len(numbers))] = None
    at["z"] = None if draw.random() < 0.15 else numbers
    if draw.random() < 0.4:
        at["T"] = number(draw, 0.1, 1.5)
    if draw.random() < 0.2:
        at["transition"] = chain(draw, count)
    if draw.random() < 0.2 and kind != "converted":
        at["R"] = covariance(draw, [2 * row[i] ** 0.5 for i, row in enumerate(used["R"])])
    if draw.random() < 0.2:
        at["Q"] = [covariance(draw, [deviation / 4 for deviation in scene.deviations]) for _ in range(count)]
    if draw.random() < 0.15:
        at["F"] = [scenes.by_matrix(len(raw["state"]))(draw)["F"] for _ in range(count)]
    return at
