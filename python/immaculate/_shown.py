"""Reads the values that a filter shows in a step. Every value is copied at once, so that arrays may be overwritten later.

Anything unambiguous is accepted: lists and tuples, integers, a column (n, 1) or a row for a vector, a number for a 1 × 1 matrix, a
vector for a matrix with one row or column. Everything else is refused in a sentence with the place.
"""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any

import numpy as np

Shape = tuple[int, ...]


class Unreadable(Exception):
    """A shown value cannot be read, with the reason."""


class Reader:
    """Reads the values of one step of a problem.

    shapes     the quantities of a trace: name, whether each mode has its own, and shape
    modes      r
    precision  what the program declares
    """

    def __init__(self, shapes: list[tuple[str, bool, list[int]]], modes: int, precision: str):
        self._of_mode = {name: tuple(shape) for name, is_of_mode, shape in shapes if is_of_mode}
        self._of_all = {name: tuple(shape) for name, is_of_mode, shape in shapes if not is_of_mode}
        self._modes, self._precision = modes, precision

    def read(self, shown: Any) -> dict[str, Any]:
        """The step in the form of the protocol. With one mode, the mode's values may stand beside the rest."""
        if not isinstance(shown, Mapping):
            raise Unreadable(f"step(z) returned a {type(shown).__name__}; it is to return a dictionary of what it shows")
        answer: dict[str, Any] = {}
        for key, value in shown.items():
            if key == "modes":
                answer["modes"] = self._read_modes(value)
        beside = {}
        for key, value in shown.items():
            if key == "modes" or value is None:
                continue
            if _has(self._of_all, key):
                answer[key] = self._read_key(self._of_all, key, value, "")
            elif self._modes == 1 and _has(self._of_mode, key):
                beside[key] = self._read_key(self._of_mode, key, value, "")
            else:
                raise Unreadable(_unknown(key, [*self._of_all, "modes"], [*self._of_mode]))
        if beside:
            if "modes" in answer:
                raise Unreadable(f"`{next(iter(beside))}` stands beside `modes`; it belongs into modes[0]")
            answer["modes"] = [beside]
        return answer

    def _read_modes(self, value: Any) -> list[dict[str, Any]]:
        if not isinstance(value, (list, tuple)) or not all(isinstance(mode, Mapping) for mode in value):
            raise Unreadable("`modes` is not a list of dictionaries, one a mode")
        if len(value) != self._modes:
            raise Unreadable(f"`modes` has {len(value)} entries, and the problem has {self._modes} modes")
        modes = []
        for index, mode in enumerate(value):
            place = f"modes[{index}]."
            read = {}
            for key, inner in mode.items():
                if inner is None:
                    continue
                if not _has(self._of_mode, key):
                    raise Unreadable(place + _unknown(key, [*self._of_mode], [*self._of_all]))
                read[key] = self._read_key(self._of_mode, key, inner, place)
            modes.append(read)
        return modes

    def _read_key(self, known: dict[str, Shape], key: str, value: Any, place: str) -> Any:
        """A quantity, or the mean and covariance under one key."""
        if key in known:
            return self._read_numbers(value, known[key], place + key)
        if not isinstance(value, Mapping):
            raise Unreadable(f"{place}{key} is a {type(value).__name__}; it is to be a dictionary of mean and covariance")
        read = {}
        for inner, numbers in value.items():
            name = f"{key}.{inner}"
            if name not in known:
                raise Unreadable(place + _unknown(name, [*known], []))
            if numbers is not None:
                read[inner] = self._read_numbers(numbers, known[name], place + name)
        return read

    def _read_numbers(self, value: Any, shape: Shape, place: str) -> Any:
        """Numbers of this shape, as lists."""
        try:
            array = np.asarray(value)
            if array.dtype == object:
                array = array.astype(float)
        except (TypeError, ValueError):
            raise Unreadable(f"{place} is not an array of numbers; {_shape(shape)} is needed") from None
        if array.dtype.kind not in "fiu":
            raise Unreadable(f"{place} has entries of type {array.dtype}; real numbers are needed")
        if self._precision == "double" and array.dtype.kind == "f" and array.dtype.itemsize < 8:
            raise Unreadable(
                f'{place} is {array.dtype}; if your filter computes in single precision, say precision="single" to check()'
            )
        if [side for side in array.shape if side != 1] != [side for side in shape if side != 1]:
            transposed = "; it is the transpose" if array.shape == shape[::-1] else ""
            raise Unreadable(f"{place} has the shape {_shape(array.shape)}, and {_shape(shape)} is needed{transposed}")
        return array.astype(float).reshape(shape).tolist()


def _has(known: dict[str, Shape], key: Any) -> bool:
    """Whether a key names a quantity, or a mean and a covariance."""
    return key in known or any(name.startswith(f"{key}.") for name in known)


def _shape(shape: tuple[int, ...]) -> str:
    return "a number, ()" if shape == () else str(shape)


def _unknown(key: Any, known: list[str], elsewhere: list[str]) -> str:
    """The sentence for a key that does not exist there."""
    if _has(dict.fromkeys(elsewhere, ()), key):
        place = "belongs into `modes`, one a mode" if "modes" in known else "belongs to all modes together: it stands beside `modes`"
        return f"{key} {place}"
    outer = [name.split(".")[0] for name in known]
    near = get_close_matches(str(key), [*known, *outer], 1)
    return f"{key} is not a key of a trace" + (f"; the nearest is `{near[0]}`" if near else "")
