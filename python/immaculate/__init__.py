"""Is your Kalman filter right? If not, which equation is wrong?

    import immaculate

    verdict = immaculate.check(MyFilter, kinds=["kalman"])
    print(verdict)
    verdict.raise_if_wrong()

`MyFilter` is called with a `Problem` and returns a filter, which then runs step by step: either through `step(z)`, which returns a
dictionary of values, or, for a single filter, through `predict()` and `update(z)` with the attributes `x` and `P`. See `check`.
"""

from immaculate._check import Rejected, Skip, check
from immaculate._problem import Mode, Models, Problem, Step
from immaculate._reference import Rule, Trace, cases, rule, trace
from immaculate._verdict import Verdict, Wrong

__all__ = [
    "Mode",
    "Models",
    "Problem",
    "Rejected",
    "Rule",
    "Skip",
    "Step",
    "Trace",
    "Verdict",
    "Wrong",
    "cases",
    "check",
    "rule",
    "trace",
]
