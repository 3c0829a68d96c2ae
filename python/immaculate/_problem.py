"""Problems as arrays: the inputs of a filter.

All arrays are doubles and your own: writing into them changes nothing else. n is the number of entries of the state, m that of the
measurement, r that of the modes. Units are those of the problem's `units`; angles are in radians.
"""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from immaculate import _immaculate

Array = NDArray[np.float64]


def _numbers(x: ArrayLike) -> list[float]:
    """A state as a flat list; a column is a vector."""
    return [float(entry) for entry in np.asarray(x, dtype=float).reshape(-1)]


def _optional(rows: Any) -> Optional[Array]:
    return None if rows is None else np.array(rows, dtype=float)


class Mode:
    """A mode of motion in a step: x(k) = f(x(k−1)) + w with w ~ N(0, Q).

    name    its name
    F       (n, n), where the motion is linear; else None
    offset  (n,), what is added to F x, where there is something; else None
    Q       (n, n), covariance of the noise
    """

    def __init__(self, native: _immaculate.Problem, step: int, index: int, entry: dict[str, Any]):
        self._native, self._at = native, (step, index)
        self.name: str = entry["name"]
        self.F: Optional[Array] = _optional(entry["F"])
        self.offset: Optional[Array] = _optional(entry["offset"])
        self.Q: Array = np.array(entry["Q"], dtype=float)

    def f(self, x: ArrayLike) -> Array:
        """f at the state x, (n,), by the crate's own formulas, also for linear motions."""
        return np.array(self._native.motion(*self._at, _numbers(x)))

    def f_jacobian(self, x: ArrayLike) -> Array:
        """∂f/∂x at the state x, (n, n): row i holds the derivatives of entry i."""
        return np.array(self._native.motion_jacobian(*self._at, _numbers(x)))


class Models:
    """The models of a step.

    modes            a list of r `Mode`
    transition       (r, r): [i, j] is P(mode j at k | mode i at k−1)
    H                (m, n), where the measurement is linear; else None
    R                (m, m), covariance of the measurement's noise
    measured         what the entries of z are, such as "range"; None where the problem does not say
    measured_angles  (m,), True where an entry of z is an angle: innovations are wrapped to (−π, π] there
    T                the length of the step, where the problem has one; else None
    sensor           the name of the sensor, where it is not the first; else None
    """

    def __init__(self, native: _immaculate.Problem, step: int):
        self._native, self._step = native, step
        self._read: dict[str, Any] = json.loads(native.models(step))
        models = self._read
        self.modes = [Mode(native, step, j, entry) for j, entry in enumerate(models["modes"])]
        self.transition: Array = np.array(models["transition"], dtype=float)
        self.H: Optional[Array] = _optional(models["H"])
        self.R: Array = np.array(models["R"], dtype=float)
        self.measured: list[Optional[str]] = models["measured"]
        self.measured_angles: NDArray[np.bool_] = np.array(models["measured_angles"], dtype=bool)
        self.T: Optional[float] = models["T"]
        self.sensor: Optional[str] = models["sensor"]

    @property
    def m(self) -> int:
        """The number of entries of the measurement."""
        return len(self.R)

    def h(self, x: ArrayLike) -> Array:
        """h at the state x, (m,), by the crate's own formulas, also for linear measurements."""
        return np.array(self._native.measurement(self._step, _numbers(x)))

    def h_jacobian(self, x: ArrayLike) -> Array:
        """∂h/∂x at the state x, (m, n): row i holds the derivatives of entry i."""
        return np.array(self._native.measurement_jacobian(self._step, _numbers(x)))


class Step(Models):
    """A step, with its models.

    number   k, counted from 1
    z        (m,), the measurement; None at a missed detection
    rows     which entries of the sensor's measurement are there; H, h and R have these rows alone
    changed  whether anything is another in this step than in the problem
    """

    def __init__(self, native: _immaculate.Problem, number: int):
        super().__init__(native, number)
        self.number = number
        self.z: Optional[Array] = _optional(self._read["z"])
        self.rows: list[int] = self._read["rows"]
        self.changed: bool = self._read["changed"]


class Problem(Models):
    """A problem: models, the estimate at step 0, and measurements. Its models hold in every step that does not replace them.

    id, about, flags    its name, what it is for, and that in words of a list
    n, r                entries of the state, and modes
    state, units        (n) names and units of the state's entries
    angles              (n,), True where an entry of the state is an angle
    filter, filters     the filter as in the file, `{"kind": "unscented", "alpha": …}`, and that of each mode
    kinds               the kinds of its filters: "kalman", "extended", "unscented", a rule such as "cubature-3", …
    mode_probabilities  (r,), at step 0
    means, covariances  (r, n) and (r, n, n), the posterior of each mode at step 0; no covariances (None) with fixed gains
    conventions         what the papers leave open, by name
    """

    def __init__(self, native: _immaculate.Problem, trace: Optional[str] = None):
        super().__init__(native, 0)
        self._trace = trace
        file: dict[str, Any] = json.loads(native.json())
        self._file = file
        self.id: str = file["id"]
        self.about: str = file["about"]
        self.flags: list[str] = file["flags"]
        names = [[entry] if isinstance(entry, str) else entry for entry in file["state"]]
        self.state: list[str] = [name[0] for name in names]
        self.units: list[str] = file["units"] or ["".join(name[1:2]) for name in names]
        self.n, self.r = len(self.state), len(self.modes)
        self.angles: NDArray[np.bool_] = np.array(native.angles(), dtype=bool)
        self.filter: dict[str, Any] = file["filter"]
        self.filters = [mode.get("filter", self.filter) for mode in file["modes"]]
        self.kinds: list[str] = native.kinds()
        self.conventions: dict[str, str] = file["conventions"]
        initial = file["initial"]
        self.mode_probabilities: Array = np.array(initial["mode_probabilities"], dtype=float)
        self.means: Array = np.array([mode["mean"] for mode in initial["modes"]], dtype=float)
        covariances = [mode.get("covariance") for mode in initial["modes"]]
        self.covariances: Optional[Array] = None if None in covariances else np.array(covariances, dtype=float)

    @property
    def steps(self) -> list[Step]:
        """The steps, as new objects each time."""
        return [Step(self._native, k + 1) for k in range(len(self._file["measurements"]))]

    @property
    def kind(self) -> str:
        """The kind of its filter, if all modes have the same kind."""
        if len(self.kinds) != 1:
            raise ValueError(f"{self.id}: the modes have filters of several kinds: {', '.join(self.kinds)}; see `filters`")
        return self.kinds[0]

    @classmethod
    def from_dict(cls, file: Mapping[str, Any]) -> "Problem":
        """A problem from its file as a dictionary, see spec/formats.md; arrays may stand for lists.

        Raises ValueError with the place of what is wrong.
        """
        return cls(_immaculate.Problem.read(json.dumps(file, default=_plain)))

    @classmethod
    def from_file(cls, path: Union[str, os.PathLike[str]]) -> "Problem":
        """A problem from a JSON file. Raises ValueError with the file and the place of an error."""
        try:
            return cls(_immaculate.Problem.read(Path(path).read_text(encoding="utf-8-sig")))
        except ValueError as error:
            raise ValueError(f"{os.fspath(path)}: {error}") from None

    def to_dict(self) -> dict[str, Any]:
        """The file as a dictionary, in the long form."""
        file: dict[str, Any] = json.loads(self._native.json())
        return file

    def of_mode(self, j: int) -> "Problem":
        """The problem with mode j only and all measurements, for a single filter.

        Its id is ID.mode-J; it is not published, and `check(…, problems=[…])` certifies it first.
        """
        file = self.to_dict()
        file.update(id=f"{self.id}.mode-{j}", modes=[file["modes"][j]], transition=[[1.0]])
        for key in ("rates", "sojourn_times", "jumps", "interaction"):  # of several modes
            file.pop(key, None)
        file["initial"] = {"mode_probabilities": [1.0], "modes": [file["initial"]["modes"][j]]}
        own = [one for one in file.pop("conversions", []) if one["from"] == file["modes"][0]["name"] and "to" not in one]
        file.update({"conversions": own} if own else {})  # the combined estimates of one mode are its own, in the common state
        file["conventions"].pop("unequal_dimensions", None)  # of modes that lack entries of the state which others have
        if "modes" in file["filter"]:
            file["filter"]["modes"] = [file["filter"]["modes"][j]]
        for entry in file["measurements"]:
            entry.pop("transition", None)
            entry.update({key: [entry[key][j]] for key in ("F", "Q") if key in entry})
        return Problem.from_dict(file)

    def __repr__(self) -> str:
        kinds = ", ".join(self.kinds)
        return f"<immaculate.Problem {self.id}: {kinds}; n = {self.n}, r = {self.r}, {len(self._file['measurements'])} steps>"


def _plain(value: Any) -> Any:
    """An array or a numpy number as plain JSON."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"a {type(value).__name__} cannot stand in a problem")
