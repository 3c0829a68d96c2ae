"""Is your Kalman filter right and, if not, which equation is wrong?

    import immaculate

    verdict = immaculate.check(MyFilter, kinds=["kalman"])
    print(verdict)
    verdict.raise_if_wrong()

`MyFilter` is called with a `Problem` and makes a filter, which is then asked step by step: either `step(z)`, which returns a
dictionary of what it shows, or, for one filter without modes, `predict()` and `update(z)` with the attributes `x` and `P`. See `check`.
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
