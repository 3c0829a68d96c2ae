"""Goal: a right filter is right, a wrong one is wrong with a reason, and nothing that a filter does or shows upsets the check."""

import numpy as np
import pytest
from filters import DISTANCE, Imm, Kalman, WithoutNoise, WithoutSpread, predicted, updated

import immaculate

STEP = "step.n4-m2.two-modes"


def test_a_right_filter_is_right():
    verdict = immaculate.check(Imm, kinds=["kalman"])
    print(verdict)
    report = verdict.as_dict()
    assert not verdict.is_wrong and not verdict.is_empty
    assert sum(case["judged"] for case in report["cases"]) > 5000
    assert not [case for case in report["cases"] if case["verdict"] == "skipped"]
    verdict.raise_if_wrong()


def test_a_mistake_is_named_where_it_is():
    verdict = immaculate.check(WithoutSpread, kinds=["kalman"], cases=["step.n4-m2"])
    assert verdict.is_wrong
    assert "mixed.covariance" in str(verdict) and "mixed-spread-omitted" in str(verdict)
    with pytest.raises(immaculate.Wrong, match="mixed-spread-omitted"):
        verdict.raise_if_wrong()


def test_one_filter_with_predict_and_update_is_judged():
    problem = next(problem for problem in immaculate.cases("kalman") if problem.r == 1)
    right = immaculate.check(Kalman, cases=[problem.id], kinds=["kalman"])
    right.raise_if_wrong()
    assert right.as_dict()["cases"][0]["judged"] >= 6
    wrong = immaculate.check(WithoutNoise, cases=[problem.id], kinds=["kalman"])
    assert wrong.is_wrong and "predicted.covariance" in str(wrong)


def test_one_filter_is_right_in_every_problem_of_a_mode_alone():
    alone = [problem.of_mode(problem.r - 1) for problem in immaculate.cases("kalman")]
    cases = immaculate.check(Kalman, kinds=["kalman"], problems=alone).as_dict()["cases"]
    assert len(cases) >= 50 and {case["verdict"] for case in cases} == {"right"}
    wrong = immaculate.check(WithoutNoise, kinds=["kalman"], problems=alone)
    assert "process-noise-omitted" in str(wrong)


def test_every_mode_of_every_case_is_a_problem_alone():
    for problem in immaculate.cases():
        for j in range(problem.r):
            alone = problem.of_mode(j)
            assert alone.r == 1 and alone.modes[0].name == problem.modes[j].name
            assert np.array_equal(alone.means[0], problem.means[j]) and len(alone.steps) == len(problem.steps)


def test_one_filter_skips_problems_of_several_modes_and_nothing_judged_is_not_right():
    verdict = immaculate.check(Kalman, cases=[STEP])
    assert verdict.as_dict()["cases"][0]["verdict"] == "skipped"
    assert verdict.is_empty and not verdict.is_wrong
    with pytest.raises(immaculate.Wrong):
        verdict.raise_if_wrong()


def test_steps_that_differ_are_skipped_without_change():
    class Constant(Imm):
        change = None

    differing = next(problem for problem in immaculate.cases("kalman") if any(step.changed for step in problem.steps))
    case = immaculate.check(Constant, cases=[differing.id]).as_dict()["cases"][0]
    assert case["verdict"] == "skipped" and "change(step)" in case["reason"]
    immaculate.check(Imm, cases=[differing.id]).raise_if_wrong()


def reason(filter, **options):
    """What the verdict says of one case."""
    case = immaculate.check(filter, cases=[STEP], **options).as_dict()["cases"][0]
    assert case["wrong"]
    return case["reason"]


def showing(shown):
    """A filter that shows this and nothing else."""

    class Showing:
        def __init__(self, problem):
            pass

        def step(self, z):
            return shown

    return Showing


@pytest.mark.parametrize(
    ("shown", "sentence"),
    [
        ([1.0], "step(z) returned a list; it is to return a dictionary"),
        ({"combned": {}}, "combned is not a key of a trace; the nearest is `combined`"),
        ({"combined": np.zeros(4)}, "combined is a ndarray; it is to be a dictionary of mean and covariance"),
        ({"combined": {"mean": np.zeros((4, 4))}}, "combined.mean has the shape (4, 4), and (4,) is needed"),
        ({"combined": {"mean": [[1, 2], [3]]}}, "combined.mean is not an array of numbers"),
        ({"combined": {"mean": np.zeros(4, complex)}}, "combined.mean has entries of type complex128"),
        ({"combined": {"mean": np.zeros(4, np.float32)}}, 'say precision="single" to check()'),
        ({"mode_probabilities": np.zeros(3)}, "mode_probabilities has the shape (3,), and (2,) is needed"),
        ({"gain": np.zeros((4, 2))}, "gain belongs into `modes`"),
        ({"modes": [{}]}, "`modes` has 1 entries, and the problem has 2 modes"),
        ({"modes": [{}, {"gain": np.zeros((2, 4))}]}, "modes[1].gain has the shape (2, 4), and (4, 2) is needed; it is the transpose"),
        ({"modes": [{}, {"combined": {}}]}, "modes[1].combined belongs to all modes together"),
    ],
)
def test_what_cannot_be_read_is_told_in_a_sentence_with_the_place(shown, sentence):
    assert sentence in reason(showing(shown))
    assert reason(showing(shown)).startswith("step 1: ")


def test_columns_lists_and_absent_values_are_accepted():
    class Columns(Imm):
        def step(self, z):
            shown = super().step(z)
            combined = shown["combined"]
            shown["combined"] = {"mean": combined["mean"].reshape(-1, 1), "covariance": combined["covariance"].tolist()}
            shown["combined_prediction"] = None
            return shown

    verdict = immaculate.check(Columns, cases=[STEP])
    verdict.raise_if_wrong()
    assert "combined_prediction.mean" in verdict.as_dict()["never_shown"]


def test_single_precision_is_judged_as_such():
    class Single(Imm):
        def __init__(self, problem):
            super().__init__(problem)
            self.mu = self.mu.astype(np.float32)
            self.estimates = [(x.astype(np.float32), P.astype(np.float32)) for x, P in self.estimates]
            for mode in problem.modes:
                mode.F, mode.Q = mode.F.astype(np.float32), mode.Q.astype(np.float32)
            problem.transition, problem.H = problem.transition.astype(np.float32), problem.H.astype(np.float32)
            problem.R = problem.R.astype(np.float32)

        def step(self, z):
            return super().step(z.astype(np.float32))

    assert immaculate.check(Single, cases=[STEP]).is_wrong
    immaculate.check(Single, cases=[STEP], precision="single").raise_if_wrong()


def test_what_a_filter_raises_is_shown_as_its_author_sees_it_and_the_check_goes_on():
    class Raising(Imm):
        def step(self, z):
            return {"combined": self.nowhere}

    verdict = immaculate.check(Raising, cases=["step.n4-m2"])
    assert len(verdict.as_dict()["cases"]) == 2
    assert "AttributeError: 'Raising' object has no attribute 'nowhere'" in verdict.as_dict()["cases"][0]["reason"]
    assert "test_check.py" in verdict.tracebacks[STEP] and "_check.py\", line" not in verdict.tracebacks[STEP].replace("test_check.py", "")
    assert str(verdict).count('return {"combined": self.nowhere}') == 1


def test_an_interruption_ends_the_check():
    asked = []

    class Interrupted(Imm):
        def step(self, z):
            asked.append(z)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        immaculate.check(Interrupted, kinds=["kalman"])
    assert len(asked) == 1


def test_what_is_no_filter_is_refused_at_once():
    with pytest.raises(TypeError, match=r"makes a list; a filter has step\(z\)"):
        immaculate.check(lambda problem: [], kinds=["kalman"])


def test_a_request_that_cannot_be_met_is_told_in_a_sentence():
    with pytest.raises(ValueError, match="the nearest is `kalman`"):
        immaculate.check(Imm, kinds=["kalmann"])
    with pytest.raises(ValueError, match="no case matches the selection"):
        immaculate.check(Imm, cases=["no-such-case"])
    with pytest.raises(TypeError, match=r"write \['kalman'\]"):
        immaculate.check(Imm, kinds="kalman")


def test_a_filter_that_checks_its_input_is_asked_what_must_be_rejected():
    def refusing(problem):
        raise immaculate.Rejected("shape", f"{problem.to_dict()['id']} has a list of a wrong size")

    report = immaculate.check(refusing, cases=["rejected.shape"], validates=True).as_dict()
    assert report["cases"] and not report["wrong"]
    assert immaculate.check(Imm, cases=["rejected.shape"], validates=True).is_wrong


def test_own_problems_are_certified_and_judged():
    from immaculate.adapters.functions import filter_of

    def predict(x, P, f, F, Q):
        return f(x), predicted(x, P, F(x), Q)[1]

    def update(x, P, z, h, H, R):
        moved, P, _ = updated(np.zeros_like(x), P, z - h(x), H(x), R)
        return x + moved, P

    verdict = immaculate.check(filter_of(predict, update), problems=[DISTANCE])
    verdict.raise_if_wrong()
    assert verdict.as_dict()["cases"][0]["certified_steps"] == 3

    wrong = immaculate.check(filter_of(lambda x, P, f, F, Q: (F(x) @ x, predicted(x, P, F(x), Q)[1]), update), problems=[DISTANCE])
    assert "predicted.mean" in str(wrong) and wrong.is_wrong


def test_a_verdict_in_a_notebook_is_escaped():
    verdict = immaculate.check(WithoutSpread, cases=[STEP], name="<b>mine</b>")
    page = verdict._repr_html_()
    assert "&lt;b&gt;mine" in page and "<b>mine" not in page and "<script" not in page
    assert page.count("<tr") == 2 and repr(verdict) == str(verdict)
