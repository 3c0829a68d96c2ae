"""`check`: runs a filter on problems and judges its values."""

import json
import os
import traceback
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Optional, Union

import numpy as np

from immaculate import _immaculate
from immaculate._problem import Problem, Step
from immaculate._shown import Reader, Unreadable
from immaculate._verdict import Verdict

#: Frames of this folder are not the author's.
_HERE = os.path.dirname(os.path.abspath(__file__))


class Skip(Exception):
    """Raised by a filter that cannot do a problem, with the reason."""


class Rejected(Exception):
    """Raised by a filter that rejects a problem, with `check(…, validates=True)`: the class of spec/formats.md, and the reason."""

    def __init__(self, reason_class: str, reason: str):
        super().__init__(reason)
        self.reason_class = reason_class


class _NotAFilter(TypeError):
    """The object given to `check` does not make a filter."""


def check(
    filter: Callable[[Problem], Any],
    *,
    kinds: Optional[Iterable[str]] = None,
    cases: Iterable[str] = (),
    flags: Iterable[str] = (),
    problems: Iterable[Union[Problem, Mapping[str, Any], str, os.PathLike[str]]] = (),
    precision: str = "double",
    conventions: Optional[Mapping[str, str]] = None,
    validates: bool = False,
    name: Optional[str] = None,
) -> Verdict:
    """Judges a filter: whether it is right and to how many digits, or which equation is wrong, at which step, and most likely why.

    filter       a class or function, called with a `Problem` for each case, that returns a filter at step 0. The filter has either

                 * `step(z)`, with z of shape (m,) or None at a missed detection. It returns a dictionary with any of the keys of a
                   trace, e.g. {"modes": [{"predicted": {"mean": …, "covariance": …}, "gain": …}, …], "combined": {…}}. With one mode,
                   the keys of the mode may stand beside the rest. A key that is absent or None is not shown.
                 * or, for a single filter, `predict()` and `update(z)` with the attributes `x` and `P`. These are read as `predicted`
                   after the first and as `updated` and `combined` after the second, which is not called at a missed detection.

                 `change(step)` is optional and may raise `Skip`. It is called with the `Step` before every step whose models differ
                 from the previous ones. Without it, problems whose steps differ are skipped.
    kinds        which filters it has: "kalman", "extended", "unscented", the name of a rule such as "cubature-3", "converted",
                 "fixed-gain", "fixed-gain-unmixed"; other cases are not asked. Default: all
    cases        ids, or beginnings of ids, of published cases. Default: all
    flags        a case must have one of these words
    problems     your own problems instead of the published cases: `Problem`, dictionaries, or paths of JSON files
    precision    "double" or "single"
    conventions  where yours differ from the cases', e.g. {"square_root": "symmetric"}
    validates    whether it rejects wrong problems by raising `Rejected`; it is then asked some. These have no attributes, only
                 `Problem.to_dict()`
    name         its name in the verdict

    An exception of the filter is its answer, with the traceback in the verdict, and the check continues; KeyboardInterrupt ends it.
    Raises ValueError if the check is impossible: a kind, a convention or a problem is wrong, or no case is left.
    """
    ready = {
        "name": name or getattr(filter, "__name__", type(filter).__name__),
        "precision": precision,
        "conventions": dict(conventions or {}),
        "kinds": None if kinds is None else _words("kinds", kinds),
        "formats": ["immaculate-problem/1", "immaculate-problem/2"],
        "validates": validates,
    }
    asked = _Asked(filter, ready)
    texts = [_text(problem) for problem in problems]
    selection = [_words("cases", cases), _words("flags", flags), []]
    text, report, is_empty = _immaculate.check(asked, texts, selection)
    return Verdict(text, json.loads(report), is_empty, asked.tracebacks)


def _words(name: str, words: Iterable[str]) -> list[str]:
    if isinstance(words, str):
        raise TypeError(f"{name} is a list of words: write [{words!r}]")
    return list(words)


def _text(problem: Union[Problem, Mapping[str, Any], str, os.PathLike[str]]) -> str:
    """A problem as JSON."""
    if isinstance(problem, Mapping):
        problem = Problem.from_dict(problem)
    elif not isinstance(problem, Problem):
        problem = Problem.from_file(Path(problem))
    return problem._native.json()


class _Asked:
    """The program under test, as the extension calls it."""

    def __init__(self, make: Callable[[Problem], Any], ready: dict[str, Any]):
        self._make, self._ready = make, ready
        self.tracebacks: dict[str, str] = {}

    def ready(self) -> str:
        """Its introduction."""
        return json.dumps({"type": "ready", **self._ready})

    def run(self, native: _immaculate.Problem) -> str:
        """Its answer to a problem."""
        file = json.loads(native.json())
        answer: dict[str, Any] = {"type": "answer", "id": file["id"], "steps": []}
        try:
            self._run(_problem(native), answer["steps"])
        except Skip as skip:
            answer = {"type": "skipped", "id": file["id"], "reason": str(skip)}
        except Rejected as rejected:
            answer = {"type": "rejected", "id": file["id"], "class": rejected.reason_class, "reason": str(rejected)}
        except _NotAFilter:
            raise
        except Unreadable as sentence:
            answer["error"] = f"step {len(answer['steps']) + 1}: {sentence}"
        except Exception as error:
            self.tracebacks[file["id"]] = _traceback(error)
            answer["error"] = f"step {len(answer['steps']) + 1}: {_sentence(error)}"
        return json.dumps(answer)

    def _run(self, problem: Problem, answered: list[dict[str, Any]]) -> None:
        """Runs a problem as far as it goes."""
        made = self._make(problem)
        steps = problem.steps
        step_of = _step_of(made, problem)
        change = getattr(made, "change", None)
        if change is None and any(step.changed for step in steps):
            raise Skip("its steps differ, and the filter has no change(step)")
        was_changed = False
        for step in steps:
            if change is not None and (step.changed or was_changed):
                change(step)
            was_changed = step.changed
            reader = Reader(problem._native.shapes(step.number), problem.r, self._ready["precision"])
            z = None if step.z is None else step.z.copy()
            answered.append({"step": step.number, **step_of(z, reader)})


def _problem(native: _immaculate.Problem) -> Problem:
    """The problem; for one that must be rejected, only its file."""
    try:
        return Problem(native)
    except ValueError:
        problem = Problem.__new__(Problem)
        problem._native = native
        return problem


def _step_of(made: Any, problem: Problem) -> Callable[[Any, Reader], dict[str, Any]]:
    """How a filter does a step, and the values that it shows."""
    if callable(getattr(made, "step", None)):
        return lambda z, reader: reader.read(made.step(z))
    if all(callable(getattr(made, verb, None)) for verb in ("predict", "update")) and hasattr(made, "x"):
        if problem.r > 1:
            raise Skip("it is one filter, and the problem has several modes")
        return lambda z, reader: _predict_and_update(made, z, reader)
    raise _NotAFilter(
        f"check() was given something that makes a {type(made).__name__}; a filter has step(z), or predict() and update(z) with the "
        "attributes x and P"
    )


def _predict_and_update(made: Any, z: Optional[np.ndarray[Any, Any]], reader: Reader) -> dict[str, Any]:
    """A step of a single filter. Values are read at once, because the update may overwrite them."""
    made.predict()
    shown = reader.read({"predicted": {"mean": made.x, "covariance": getattr(made, "P", None)}})
    if z is not None:
        made.update(z)
    estimate = {"mean": made.x, "covariance": getattr(made, "P", None)}
    after = reader.read({"updated": estimate, "combined": estimate})
    shown["modes"][0].update(after.pop("modes")[0])
    return {**shown, **after}


def _traceback(error: BaseException) -> str:
    """The traceback as the author would see it: from the author's first line on."""
    return "".join(traceback.format_exception(type(error), error, _authors(error.__traceback__)))


def _sentence(error: BaseException) -> str:
    """The exception and its place, in a line."""
    frames = traceback.extract_tb(_authors(error.__traceback__))
    where = f" ({os.path.basename(frames[-1].filename)}, line {frames[-1].lineno}, in {frames[-1].name})" if frames else ""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said[:200]}{where}"


def _authors(frames: Optional[TracebackType]) -> Optional[TracebackType]:
    """A traceback without its first frames, which belong to this package."""
    while frames is not None and os.path.dirname(os.path.abspath(frames.tb_frame.f_code.co_filename)) == _HERE:
        frames = frames.tb_next
    return frames
