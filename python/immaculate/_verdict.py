"""The verdict on a filter."""

from html import escape
from typing import Any

#: Of that many cases the table shows a row each.
ROWS = 300


class Wrong(AssertionError):
    """A filter is wrong, or nothing was judged; the text is the verdict."""


class Verdict:
    """The verdict: a text when printed, a table in a notebook.

    is_wrong     whether anything is wrong
    is_empty     whether nothing could be judged at all
    is_complete  whether every situation of such filters was judged and is right
    tracebacks   what the filter raised, by the id of the case, as Python would print it
    """

    def __init__(self, text: str, report: dict[str, Any], is_empty: bool, tracebacks: dict[str, str]):
        self._text, self._report, self.is_empty, self.tracebacks = text, report, is_empty, tracebacks

    @property
    def is_wrong(self) -> bool:
        return bool(self._report["wrong"])

    @property
    def is_complete(self) -> bool:
        return bool(self._report["complete"])

    def as_dict(self) -> dict[str, Any]:
        """The verdict as data, as `immaculate check --json` prints it."""
        return self._report

    def raise_if_wrong(self) -> None:
        """Raises `Wrong` with the text if anything is wrong or nothing could be judged."""
        if self.is_wrong or self.is_empty:
            raise Wrong("\n" + str(self))

    def __str__(self) -> str:
        return self._text + self._raised()

    __repr__ = __str__

    def _raised(self) -> str:
        """Each traceback once, with the cases in which it was raised."""
        cases: dict[str, list[str]] = {}
        for case, traceback in self.tracebacks.items():
            cases.setdefault(traceback, []).append(case)
        parts = []
        for traceback, ids in list(cases.items())[:3]:
            others = f" and {len(ids) - 1} more" if len(ids) > 1 else ""
            parts.append(f"\nRAISED  in {ids[0]}{others}\n" + "".join(f"  {line}\n" for line in traceback.splitlines()))
        if len(cases) > 3:
            parts.append(f"\n  and {len(cases) - 3} more; see `tracebacks`\n")
        return "".join(parts)

    def _repr_html_(self) -> str:
        """A table of the cases, wrong ones first, and the text."""
        cases = sorted(self._report["cases"], key=lambda case: not case["wrong"])
        word = "wrong" if self.is_wrong else "nothing was judged" if self.is_empty else "right in what was judged"
        rows = []
        for case in cases[:ROWS]:
            digits = "" if case["digits"] is None else f"{case['digits']:.1f}"
            weight = ' style="font-weight:bold"' if case["wrong"] else ""
            cells = [case["id"], case["verdict"], f"{case['judged']} of {case['of']}", digits, case["reason"] or ""]
            rows.append(f"<tr{weight}>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in cells) + "</tr>")
        head = "".join(f"<th>{name}</th>" for name in ("case", "verdict", "judged", "digits", "reason"))
        return (
            f"<div><p><b>{escape(self._report['name'])}</b>: {word}</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(rows)}</tbody></table>"
            f"<details><summary>the verdict as text</summary><pre>{escape(str(self))}</pre></details></div>"
        )
