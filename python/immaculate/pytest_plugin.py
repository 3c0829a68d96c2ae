"""The published cases as tests of a filter, one per case:

    pytest --immaculate my_filters.py:MyFilter --immaculate-kind kalman

Options of the check are in the README; problems of your own are given with --immaculate-problem FILE.
"""

import importlib.util
import sys
from pathlib import Path
from typing import Any, Optional

import pytest

from immaculate import Problem, Verdict, cases, check


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("immaculate", "a filter, judged case by case")
    group.addoption("--immaculate", metavar="FILE.py:NAME", help="the class or function that makes the filter")
    group.addoption(
        "--immaculate-kind", action="append", metavar="KIND", help="a kind of filter that it has; may be repeated"
    )
    group.addoption(
        "--immaculate-problem", action="append", default=[], metavar="FILE", help="a problem file of your own, in place of the cases"
    )
    group.addoption("--immaculate-precision", default="double", choices=("double", "single"), help="that of the filter")


def pytest_collection_modifyitems(session: pytest.Session, config: pytest.Config, items: list[pytest.Item]) -> None:
    place = config.getoption("--immaculate")
    if not place:
        return
    filter = load(place)
    kinds = config.getoption("--immaculate-kind")
    problems = [Problem.from_file(path) for path in config.getoption("--immaculate-problem")]
    options = {"precision": config.getoption("--immaculate-precision"), "kinds": kinds}
    for problem in problems or cases():
        if problems or kinds is None or set(problem.kinds) <= set(kinds):
            is_own = {"problems": [problem]} if problems else {"cases": [problem.id]}
            name = f"{place.rpartition(':')[2]}[{problem.id}]"
            items.append(Case.from_parent(session, name=name, arguments={**options, **is_own}, filter=filter, case=problem.id))


def load(place: str) -> Any:
    """The object of a `FILE.py:NAME`."""
    file, colon, name = place.rpartition(":")
    path = Path(file)
    if not colon or not path.is_file():
        raise pytest.UsageError(f"--immaculate {place}: write FILE.py:NAME, with a file that is there")
    specification = importlib.util.spec_from_file_location(path.stem, path)
    assert specification and specification.loader
    module = importlib.util.module_from_spec(specification)
    sys.modules.setdefault(path.stem, module)
    specification.loader.exec_module(module)
    if not hasattr(module, name):
        raise pytest.UsageError(f"--immaculate {place}: {file} has no {name}")
    return getattr(module, name)


class Failed(Exception):
    """A filter is wrong in a case."""


class Case(pytest.Item):
    """A case as a test."""

    def __init__(self, *, arguments: dict[str, Any], filter: Any, case: str, **kwargs: Any):
        super().__init__(**kwargs)
        self._arguments, self._filter, self._case = arguments, filter, case

    def runtest(self) -> None:
        verdict = check(self._filter, **self._arguments)
        case = next(case for case in verdict.as_dict()["cases"] if case["id"] == self._case)
        if case["wrong"] and verdict.is_wrong:
            raise Failed(message(case, verdict))
        if case["verdict"] == "skipped":
            pytest.skip(case["reason"])

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        return str(excinfo.value) if isinstance(excinfo.value, Failed) else super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, Optional[int], str]:
        return self.path, None, self.name


def message(case: dict[str, Any], verdict: Verdict) -> str:
    """Why a case is wrong: equation, step, mode, shown and expected values, and the most likely cause."""
    lines = [f"{case['id']}: {case['verdict']}" + (f", {case['reason']}" if case["reason"] else "")]
    faults = [value for value in case["not_simply_right"] if value["finding"] in ("fault", "not finite")]
    for fault in faults[:3]:
        mode = "" if fault["mode"] is None else f", mode {fault['mode']}"
        lines.append(f"  {fault['quantity']} at step {fault['step']}{mode}  —  {fault['equation']}")
        own = fault["own"]
        if own:
            lines.append(f"    entry {own['entry']} is {own['shown']!r}, and should be {own['expected']!r} by the values before it")
    if len(faults) > 3:
        lines.append(f"  and {len(faults) - 3} more")
    lines += [f"  most likely: {cause}" for cause in causes(verdict.as_dict()["diagnosis"])]
    lines += [f"  {line}" for line in verdict.tracebacks.get(case["id"], "").splitlines()]
    return "\n".join(lines)


def causes(diagnosis: Any) -> list[str]:
    """The sentences of a diagnosis, wherever they stand in it."""
    if isinstance(diagnosis, dict) and "about" in diagnosis:
        return [f"{diagnosis['about']} ({diagnosis['id']})"]
    inner = diagnosis.values() if isinstance(diagnosis, dict) else diagnosis if isinstance(diagnosis, list) else []
    return [cause for part in inner for cause in causes(part)]
