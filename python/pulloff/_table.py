"""Columns by name, and a document with such columns: what every result is."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Union

from . import _engine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
else:
    from ._numpy import np

# The most rows of a table shown in a notebook.
_SHOWN = 12


class Table(Mapping):  # type: ignore[type-arg]
    """Columns of equal length by name, a mapping: ``table["force"]``, ``"force" in table``, ``list(table)``, ``dict(table)``;
    also ``table.force``. ``len(table)`` is the number of columns, ``table.row_count`` the number of rows."""

    def __init__(self, columns: "Mapping[str, Any]") -> None:
        self._arrays: Dict[str, NDArray[Any]] = {
            # Strings, and what is not known, are objects; None means missing.
            name: np.array(values, dtype=object) if isinstance(values, list) else values
            for name, values in columns.items()
        }

    @property
    def columns(self) -> List[str]:
        """The names of the columns, those of the program's CSV."""
        return list(self._arrays)

    @property
    def row_count(self) -> int:
        """The number of rows."""
        return len(self._column(self.columns[0])) if self.columns else 0

    def _column(self, name: str) -> NDArray[Any]:
        return self._arrays[name]

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The column of this name, shape (rows,)."""
        try:
            return self._column(name)
        except (KeyError, TypeError):
            raise KeyError(f"no column is called {name!r}; there are {', '.join(self.columns)}") from None

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        """The number of columns."""
        return len(self.columns)

    def __eq__(self, other: object) -> bool:
        """Whether both have the same columns with the same values; NaN is equal to NaN."""
        if not isinstance(other, Mapping):
            return NotImplemented
        if isinstance(other, Table) and type(self) is not type(other):
            return False
        return set(self) == set(other) and all(_same(self[name], other[name]) for name in self)

    # As every mapping that is compared by its values.
    __hash__ = None  # type: ignore[assignment]

    def __getattr__(self, name: str) -> NDArray[Any]:
        if not name.startswith("_"):
            try:
                return self._column(name)
            except KeyError:
                pass
        raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(name for name in self.columns if name.isidentifier())]

    def to_pandas(self) -> Any:
        """All columns as a ``pandas.DataFrame``."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_pandas needs pandas: pip install pandas") from None
        return pandas.DataFrame({name: self._column(name) for name in self.columns})

    def _title(self) -> str:
        return f"{self.row_count} rows"

    def __repr__(self) -> str:
        return f"<pulloff.{type(self).__name__}: {self._title()}>"

    def _repr_html_(self) -> str:
        rows = min(self.row_count, _SHOWN)
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.columns)
        cells = [[_cell(self._column(name)[row]) for name in self.columns] for row in range(rows)]
        body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in cells)
        more = f"<p>… {self.row_count - rows} more rows</p>" if self.row_count > rows else ""
        return (
            f"<div><p><b>{type(self).__name__}</b>: {html.escape(self._title())}</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}</div>"
        )


def _same(ours: Any, theirs: Any) -> bool:
    a, b = np.asarray(ours), np.asarray(theirs)
    if a.shape != b.shape:
        return False
    same = a == b
    if a.dtype.kind == b.dtype.kind == "f":
        same |= np.isnan(a) & np.isnan(b)
    return bool(np.all(same))


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return ""
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    return html.escape(str(value))


class _Kept:
    """A document without the engine, as it travels from one process to another."""

    def __init__(self, document: Union[_engine.Document, "_Kept"]) -> None:
        self._json = document.json()
        self._warnings = document.warnings()
        self._columns = {name: document.column(name) for name in document.columns()}

    def json(self) -> str:
        return self._json

    def columns(self) -> List[str]:
        return list(self._columns)

    def warnings(self) -> List[str]:
        return list(self._warnings)

    def column(self, name: str) -> Any:
        return self._columns[name]


class Result(Table):
    """What was computed from one problem: a document with rows. Numbers are in the units of the problem. It can be pickled and
    copied, and two are equal if their documents are."""

    def __init__(self, document: Union[_engine.Document, _Kept]) -> None:
        super().__init__({})
        self._document = document
        self._dict: Optional[Dict[str, Any]] = None

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_document": _Kept(self._document), "_arrays": {}, "_dict": None}

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Result):
            return type(self) is type(other) and self.to_json() == other.to_json()
        return super().__eq__(other)

    __hash__ = None

    @property
    def columns(self) -> List[str]:
        """The names of the columns, those of the program's CSV."""
        return self._document.columns()

    def _column(self, name: str) -> NDArray[Any]:
        if name not in self._arrays:
            values = self._document.column(name)
            if isinstance(values, list):
                values = np.array(values, dtype=object)
            self._arrays[name] = values
        return self._arrays[name]

    @property
    def warnings(self) -> List[str]:
        """What to be careful about, in sentences."""
        return self._document.warnings()

    def to_dict(self) -> Dict[str, Any]:
        """The whole document, in the schema of the program's JSON; a new dict each time."""
        return dict(json.loads(self._document.json()))

    def to_json(self) -> str:
        """The same as text, as the program writes it."""
        return self._document.json()

    def _said(self) -> Dict[str, Any]:
        if self._dict is None:
            self._dict = self.to_dict()
        return self._dict

    def _repr_html_(self) -> str:
        warned = "".join(f"<p>⚠ {html.escape(warning)}</p>" for warning in self.warnings)
        return super()._repr_html_() + warned

    def _unit(self, quantity: str, symbol: str) -> str:
        unit = self._said()["units"].get(quantity)
        return f"{symbol} ({unit})" if unit else symbol

    def _axes(self, ax: Any) -> Any:
        if ax is None:
            try:
                import matplotlib.pyplot as plt
            except ImportError:
                raise ImportError("plot needs matplotlib: pip install matplotlib") from None
            ax = plt.figure().add_subplot()
        ax.set_xlabel(self._unit("length", "approach δ"))
        ax.set_ylabel(self._unit("force", "force P"))
        return ax
