"""Goal: the pytest plugin, the adapters and the command do what the README says."""

import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from filters import DISTANCE

import immaculate

pytest_plugins = ["pytester"]

HERE = Path(__file__).parent


def test_each_case_is_a_test_that_says_why_it_fails(pytester):
    run = ("--immaculate-kind", "kalman", "-k", "step.n4-m2 or step.n2", "-p", "no:cacheprovider")
    right = pytester.runpytest("--immaculate", f"{HERE / 'filters.py'}:Imm", *run)
    assert right.ret == 0 and right.parseoutcomes()["passed"] >= 2
    wrong = pytester.runpytest("--immaculate", f"{HERE / 'filters.py'}:WithoutSpread", *run)
    assert wrong.ret == 1
    text = wrong.stdout.str()
    for part in ("mixed.covariance at step 1, mode 0", "zhu2016 (56)", "and should be", "most likely:", "mixed-spread-omitted"):
        assert part in text, part
    assert "Traceback" not in text


def test_the_plugin_refuses_what_is_not_there(pytester):
    assert pytester.runpytest("--immaculate", "nowhere.py:Imm").ret == pytest.ExitCode.USAGE_ERROR
    assert pytester.runpytest("--immaculate", f"{HERE / 'filters.py'}:Nothing").ret == pytest.ExitCode.USAGE_ERROR


def test_pytest_without_the_option_is_as_ever(pytester):
    pytester.makepyfile("def test_one(): pass")
    assert pytester.runpytest().parseoutcomes() == {"passed": 1}


def test_filterpy_is_judged_as_in_the_table_of_the_readme():
    filterpy = pytest.importorskip("immaculate.adapters.filterpy")
    alone = next(problem for problem in immaculate.cases("kalman") if problem.r == 1 and not any(s.changed for s in problem.steps))
    immaculate.check(filterpy.Filter, cases=[alone.id]).raise_if_wrong()
    verdict = immaculate.check(filterpy.Filter, cases=["combination.turned-over"])
    assert faults_of(verdict) == {"combined_prediction.mean", "combined_prediction.covariance"}


def test_filterpy_has_extended_and_unscented_filters():
    filterpy = pytest.importorskip("immaculate.adapters.filterpy")
    own = {**DISTANCE, "measurements": [{"step": 1, "z": [5.1]}, {"step": 2, "z": [5.5]}]}
    immaculate.check(filterpy.Filter, problems=[own]).raise_if_wrong()
    unscented = {**own, "filter": {"kind": "unscented", "alpha": 0.5, "beta": 2, "kappa": 1}}
    immaculate.check(filterpy.Filter, problems=[unscented]).raise_if_wrong()


def faults_of(verdict):
    cases = verdict.as_dict()["cases"]
    return {value["quantity"] for case in cases for value in case["not_simply_right"] if value["finding"] == "fault"}


def test_stone_soup_is_judged_as_in_the_table_of_the_readme():
    stonesoup = pytest.importorskip("immaculate.adapters.stonesoup")

    def check(kind, *ids):
        problems = [problem.of_mode(0) for problem in immaculate.cases(kind) if not ids or problem.id in ids]
        return immaculate.check(stonesoup.Filter, kinds=[kind], problems=problems, conventions=stonesoup.CONVENTIONS)

    check("kalman", "update.kalman", "missing.kalman", "singular.updated").raise_if_wrong()
    check("extended").raise_if_wrong()
    check("unscented", "rule.unscented.n4", "wrap.unscented").raise_if_wrong()
    assert faults_of(check("cubature-3", "rule.cubature-3.n2")) == {"innovation_covariance", "cross_covariance"}
    assert "predicted.covariance" in faults_of(check("unscented", "unscented.unequal"))


def command(*arguments):
    done = subprocess.run([sys.executable, "-m", "immaculate", *arguments], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def test_the_command_line_is_that_of_the_crate():
    assert command("--version") == (0, f"immaculate {version('immaculate')}\n", "")
    status, text, _ = command("rule", "cubature-3", "-n", "2")
    assert status == 0 and "cubature-3" in text
    assert command("cases", "lisst")[0] == 2
    program = (sys.executable, "-m", "immaculate", "answer", "--plant", "innovation-reversed")
    status, text, _ = command("check", "--case", "step.n4-m2", "--", *program)
    assert status == 1 and "innovation-reversed" in text
