#!/usr/bin/env python3
"""Proves every certified number of `fixtures/` again, in ball arithmetic, with nothing of the crate, and compares the named models.

    python3 tests/independent/check.py                      all cases, certificates and named models
    python3 tests/independent/check.py --case ID ID …       these cases
    python3 tests/independent/check.py --self-test          whether it would notice a mistake
    python3 tests/independent/check.py --drawn 40           problems drawn at random, certified by the program

The exit status is 1 where something is not proven; each such place is printed.
"""

import argparse
import hashlib
import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import certificates
import rows
import validity
from balls import AS_POINT, PROVEN, WRONG, Undecided, set_bits
from compare import Tally, compare_noise, compare_scale, compare_values
from formulas import Refused
from imm import run
from reader import Problem
from units import units_of

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
BITS = (256, 512, 1024, 2048, 4096, 8192)


@dataclass
class Report:
    """What was found out about one case."""

    id: str
    files: Tally = field(default_factory=Tally)
    values: Tally = field(default_factory=Tally)
    scales: Tally = field(default_factory=Tally)
    noises: Tally = field(default_factory=Tally)
    rejected: bool = False
    bits: int = 0

    def places(self):
        return self.files.places + self.values.places + self.scales.places + self.noises.places


def check_case(folder, entry):
    """One case: its two files against lock.json, and then what they say."""
    report = Report(entry["id"])
    problem, trace = (read(folder, entry, kind, report) for kind in ("problem", "trace"))
    if problem is None or trace is None:
        return report
    if problem.get("id") != report.id or trace.get("id") != report.id or trace.get("format") != "immaculate-trace/1":
        report.files.add(WRONG, "id", "the files do not belong together, or are of another format")
    if "rejected" in trace:
        check_rejection(problem, trace["rejected"], report)
    elif set(trace) != {"format", "id", "steps", "scale", "noise"}:
        report.files.add(WRONG, "trace", f"has the keys {', '.join(trace)}")
    else:
        check_numbers(problem, trace, report)
    return report


def read(folder, entry, kind, report):
    """A file of the case as JSON, if it is the one that lock.json means."""
    try:
        content = (folder / f"{report.id}.{kind}.json").read_bytes()
    except OSError as error:
        report.files.add(WRONG, kind, str(error))
        return None
    if hashlib.sha256(content).hexdigest() != entry[kind]:
        report.files.add(WRONG, kind, "the SHA-256 is not that of lock.json")
    try:
        return json.loads(content, object_pairs_hook=without_repetition, parse_constant=no_constant)
    except ValueError as error:
        report.files.add(WRONG, kind, str(error))
        return None


def without_repetition(pairs):
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key stands twice")
    return found


def no_constant(name):
    raise ValueError(f"{name} is no JSON")


def check_rejection(problem, rejected, report):
    """The problem is refused here, too, and in the same class."""
    report.rejected = True
    found = None
    try:
        validity.check(problem)
    except validity.Rejected as error:
        found = error.fault
    if found != rejected["class"]:
        report.files.add(WRONG, "rejected", f"is {found or 'no fault'} here and {rejected['class']} there")


def check_numbers(problem, trace, report):
    """Runs the problem with more and more bits until every number is decided."""
    try:
        validity.check(problem)
    except validity.Rejected as error:
        report.files.add(WRONG, "problem", f"is refused here: {error}")
        return
    for report.bits in BITS:
        try:
            report.values, report.scales, report.noises = attempt(problem, trace, report.bits)
        except Undecided as error:
            report.values = Tally()
            report.values.add(WRONG, "steps", f"{report.bits} bits do not tell {error}")
        except Refused as error:
            report.files.add(WRONG, "problem", f"cannot be run here: {error}")
            return
        else:
            if not report.values.is_open() and not report.scales.is_open():
                return


def attempt(raw, trace, bits):
    """The three sections of a trace against a run with a number of bits."""
    return compared(trace, *computed(raw, bits))


def compared(trace, steps, units):
    """The verdicts on values, scales and noises."""
    if '"nis"' not in json.dumps(trace["steps"]):
        steps = [published_before_nis(step) for step in steps]
    values, scales, noises = Tally(), Tally(), Tally()
    compare_values(trace["steps"], steps, units, values)
    compare_scale(trace["scale"], steps, units, scales)
    compare_noise(trace["noise"], steps, noises)
    return values, scales, noises


def published_before_nis(step):
    """Older cases do not have it, in any step."""
    modes = [{name: value for name, value in mode.items() if name != "nis"} for mode in step["modes"]]
    return {**step, "modes": modes}


def computed(raw, bits):
    """The values of all steps and their units."""
    set_bits(bits)
    problem = Problem(raw)
    steps = run(problem)
    given = problem.filters if raw["filter"]["kind"] == "fixed-gain" else None
    return steps, [units_of(step, given) for step in steps]


# ------------------------------------------------------------------------------------------------------------- all together


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", action="extend", nargs="+", metavar="ID", help="only these cases")
    parser.add_argument("--self-test", action="store_true", help="whether mistakes would be noticed")
    parser.add_argument("--drawn", type=int, metavar="N", help="check N problems drawn at random, certified by the program IMMACULATE")
    options = parser.parse_args()
    if options.self_test:
        import mistakes

        return mistakes.main()
    if options.drawn:
        import drawn

        return 1 if drawn.main(options.drawn) else 0
    start = time.monotonic()
    failures = check_cases(FIXTURES / "cases", options.case)
    if not options.case:
        failures += check_certificates(FIXTURES / "certificates")
        failures += check_models(FIXTURES.parent / "spec" / "models.toml")
    print(f"{time.monotonic() - start:.0f} s; {failures or 'nothing'} not proven")
    return 1 if failures else 0


def check_cases(folder, wanted):
    """All cases of lock.json, or those that are wanted; gives the number of places that are not proven."""
    entries = json.loads((folder / "lock.json").read_text())["cases"]
    failures = 0
    if wanted:
        for id in sorted(set(wanted) - {entry["id"] for entry in entries}):
            failures += complain(f"{id}: lock.json has no such case")
        entries = [entry for entry in entries if entry["id"] in wanted]
    else:
        expected = {f"{entry['id']}.{kind}.json" for entry in entries for kind in ("problem", "trace")} | {"lock.json"}
        for name in sorted({path.name for path in folder.iterdir()} ^ expected):
            failures += complain(f"{name}: lock.json and the folder do not agree on it")
    reports = []
    with ProcessPoolExecutor(2) as pool:
        for report in pool.map(check_case, [folder] * len(entries), entries):
            reports.append(report)
            progress(f"{len(reports)} of {len(entries)}: {report.id}")
            for verdict, place, text in report.places():
                failures += complain(f"{report.id}: {place} is {verdict}: {text}")
    summarise(reports)
    return failures


def complain(sentence):
    print(f"NOT PROVEN  {sentence}")
    return 1


def progress(text):
    """One line that is written over, where somebody looks at it."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)


def summarise(reports):
    progress("")
    values = count(reports, "values", PROVEN)
    points = count(reports, "values", AS_POINT)
    scales, noises = (count(reports, section, PROVEN) for section in ("scales", "noises"))
    rejected, bits = sum(report.rejected for report in reports), max((report.bits for report in reports), default=0)
    print(f"{len(reports)} cases: {values + points} numbers proven to be the nearest doubles,")
    print(f"  {points} of them as zeros or ties that a ball narrower than 2^-1000 holds; at most {bits} bits;")
    print(f"  {scales} scales proven, {noises} noises of a plausible size, {rejected} problems rejected in their class")


def count(reports, section, verdict):
    return sum(getattr(report, section).counts[verdict] for report in reports)


def check_certificates(folder):
    """Every certificate of the folder; gives the number of those that are not proven."""
    failures = proven = inequalities = 0
    for path in sorted(folder.glob("*.json")):
        try:
            inequalities += certificates.prove(json.loads(path.read_text()))
            proven += 1
        except certificates.Unproven as error:
            failures += complain(f"{path.name}: {error}")
    print(f"{proven} certificates proven, {inequalities} inequalities")
    return failures


def check_models(path):
    """Every named model; gives the number of what is wrong."""
    wrong, results, places = rows.check(path)
    print(f"{results} results of worked examples of named models proven, their formulas compared with their slopes at {places} places")
    return sum(complain(sentence) for sentence in wrong)


if __name__ == "__main__":
    sys.exit(main())
