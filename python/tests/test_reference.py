"""Goal: problems, certified traces and rules come as arrays that say what the files say."""

import json

import numpy as np
import pytest
from filters import DISTANCE

import immaculate


def test_every_case_is_there_with_its_trace():
    problems = immaculate.cases()
    assert len(problems) > 150
    for problem in problems:
        steps = problem.steps
        trace = immaculate.trace(problem)
        assert [step["step"] for step in trace.steps] == [step.number for step in steps]
        for step, shown in zip(steps, trace.steps):
            assert shown["combined"]["mean"].shape == (problem.n,) and len(shown["modes"]) == problem.r
            assert step.R.shape == (step.m, step.m) and (step.z is None or step.z.shape == (step.m,))
            assert step.h(problem.means[0]).shape == (step.m,)
            if step.z is not None and "converted" not in problem.kinds:
                assert shown["modes"][0]["innovation"].shape == (step.m,)


def test_a_trace_is_a_unit_test():
    problem = next(problem for problem in immaculate.cases("kalman") if problem.r == 2)
    trace = immaculate.trace(problem)
    c = problem.transition.T @ problem.mode_probabilities
    expected, scale, noise = (part[0]["predicted_mode_probabilities"] for part in (trace.steps, trace.scale, trace.noise))
    assert np.max(np.abs(c - expected) / scale) < 100 * noise
    assert not np.max(np.abs(c + 1e-12 - expected) / scale) < 100 * noise


def test_cases_are_selected_by_kind_and_flag():
    assert all("cubature-5" in problem.kinds for problem in immaculate.cases("cubature-5"))
    flag = immaculate.cases("kalman")[0].flags[0]
    assert all(flag in problem.flags for problem in immaculate.cases(flag=flag))
    assert immaculate.cases("no-such-kind") == []


def test_formulas_are_evaluated_with_their_slopes():
    problem = immaculate.Problem.from_dict(DISTANCE)
    first, second, third = problem.steps
    x = np.array([4.0, 1.0])
    mode = first.modes[0]
    assert mode.F is None and first.H is None and (first.T, second.T) == (0.5, 0.25)
    assert np.allclose(mode.f(x), [4.5, 1 - 0.1 * np.sin(4)], rtol=1e-15)
    assert np.allclose(mode.f_jacobian(x), [[1, 0.5], [-0.1 * np.cos(4), 1]], rtol=1e-15)
    assert np.allclose(second.modes[0].f(x), [4.25, 1 - 0.1 * np.sin(4)], rtol=1e-15)
    assert np.allclose(mode.Q, [[0.5**4 / 3, 0.5**3 / 2], [0.5**3 / 2, 0.25]], rtol=1e-15)
    assert np.array_equal(first.h(x.reshape(-1, 1)), [5.0]) and np.allclose(first.h_jacobian(x), [[0.8, 0]], rtol=1e-15)
    assert (first.R, third.R) == ([[0.01]], [[0.04]])
    assert [step.changed for step in (first, second, third)] == [False, True, True]
    with pytest.raises(ValueError, match="the state has 2 entries, and 3 were given"):
        mode.f([1, 2, 3])


def test_an_own_problem_is_certified():
    trace = immaculate.trace(immaculate.Problem.from_dict(DISTANCE))
    assert np.allclose(trace.steps[0]["modes"][0]["predicted"]["mean"], [4.5, 1 - 0.1 * np.sin(4)], rtol=1e-15)


def test_a_problem_is_what_its_file_says(tmp_path):
    arrays = {**DISTANCE, "R": np.array([[0.01]])}
    problem = immaculate.Problem.from_dict(arrays)
    again = immaculate.Problem.from_dict(problem.to_dict())
    assert again.to_dict() == problem.to_dict() and "distance: extended; n = 2, r = 1, 3 steps" in repr(problem)
    path = tmp_path / "mine.json"
    path.write_text(json.dumps({**DISTANCE, "f": ["x + T*vz", "vx"]}))
    with pytest.raises(ValueError, match=r"mine.json: problem.f\[0\].*`vz` is not known here"):
        immaculate.Problem.from_file(path)


def test_what_is_written_into_a_problem_changes_no_other():
    problem = immaculate.Problem.from_dict(DISTANCE)
    problem.R[:] = 7
    problem.steps[0].R[:] = 7
    assert problem.steps[0].R == 0.01


@pytest.mark.parametrize("name", ["cubature-3", "cubature-5", "simplex-5", "gauss-hermite-3", "unscented"])
def test_a_rule_has_the_moments_of_a_gaussian(name):
    rule = immaculate.rule(name, 3)
    second = rule.points.T @ (rule.weights[:, None] * rule.points)
    assert np.isclose(rule.weights.sum(), 1) and np.allclose(second, np.eye(3)) and rule.degree >= 3


def test_an_unscented_rule_has_its_parameters():
    rule = immaculate.rule("unscented", 2, alpha=0.5, beta=2, kappa=1)
    lam = 0.25 * 3 - 2
    assert np.isclose(rule.weights[0], lam / (2 + lam))
    assert np.isclose(rule.covariance_weights[0], lam / (2 + lam) + 1 - 0.25 + 2)
    with pytest.raises(ValueError, match="parameters of the rule `unscented`"):
        immaculate.rule("cubature-3", 2, alpha=1)
