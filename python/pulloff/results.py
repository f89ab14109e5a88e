"""Results: columns as arrays, the document as a dict, a table and a figure in a notebook."""

from __future__ import annotations

import html
import json
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Tuple

from . import _engine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Flags = NDArray[np.bool_]
    Counts = NDArray[np.int64]
    Texts = NDArray[np.object_]
else:
    from ._numpy import np

# So many rows of a table are shown in a notebook.
_SHOWN = 12


class Table:
    """Columns of one length by their names: ``table["force"]``, or ``table.force``."""

    def __init__(self, columns: Mapping[str, Any]) -> None:
        self._arrays: Dict[str, NDArray[Any]] = {
            # Texts, and what is not known, are objects; None is nothing.
            name: np.array(values, dtype=object) if isinstance(values, list) else values
            for name, values in columns.items()
        }

    @property
    def columns(self) -> List[str]:
        """The names of the columns, those of the program's CSV."""
        return list(self._arrays)

    def _column(self, name: str) -> NDArray[Any]:
        return self._arrays[name]

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The column of this name, shape (rows,)."""
        try:
            return self._column(name)
        except KeyError:
            raise KeyError(f"no column is called {name!r}; there is {', '.join(self.columns)}") from None

    def __getattr__(self, name: str) -> NDArray[Any]:
        if not name.startswith("_"):
            try:
                return self._column(name)
            except KeyError:
                pass
        raise AttributeError(f"{type(self).__name__} has no attribute {name!r}")

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(name for name in self.columns if name.isidentifier())]

    def __len__(self) -> int:
        """The number of rows."""
        return len(self._column(self.columns[0]))

    def to_pandas(self) -> Any:
        """All columns as a ``pandas.DataFrame``."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_pandas needs pandas: pip install pandas") from None
        return pandas.DataFrame({name: self._column(name) for name in self.columns})

    def _title(self) -> str:
        return f"{len(self)} rows"

    def __repr__(self) -> str:
        return f"<pulloff.{type(self).__name__}: {self._title()}>"

    def _repr_html_(self) -> str:
        rows = min(len(self), _SHOWN)
        head = "".join(f"<th>{html.escape(name)}</th>" for name in self.columns)
        cells = [[_cell(self._column(name)[row]) for name in self.columns] for row in range(rows)]
        body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in cells)
        more = f"<p>… {len(self) - rows} more rows</p>" if len(self) > rows else ""
        return (
            f"<div><p><b>{type(self).__name__}</b>: {html.escape(self._title())}</p>"
            f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}</div>"
        )


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return ""
    if isinstance(value, (float, np.floating)):
        return f"{value:.6g}"
    return html.escape(str(value))


class Result(Table):
    """What was computed of one problem: a document with rows. Numbers are in the units of the problem."""

    def __init__(self, document: _engine.Document) -> None:
        super().__init__({})
        self._document = document
        self._dict: Optional[Dict[str, Any]] = None

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
        """The whole document, of the very schema of the program's JSON; a new dict each time."""
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
        unit = self._said()["problem"]["units"].get(quantity)
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


class Trace(Result):
    """An equilibrium curve from its start inward; each column has the shape (points,)."""

    step: Counts
    contact_radius: Floats
    """s, a length."""
    approach: Floats
    """δ, a length."""
    force: Floats
    """P, negative where the bodies are pulled."""
    energy: Floats
    """U: the elastic energy less γ times the contact area."""
    newton_iterations: Counts
    stable_displacement: Flags
    stable_force: Flags
    stable_chosen: Flags
    """Whether the state is stable under the problem's own control."""
    contact_stiffness: Floats
    """∂P/∂δ at the contact radius held fast, a force per length."""
    tangent_stiffness: Floats
    """dP/dδ along the curve, a force per length; NaN at a limit point of displacement."""
    area_slope: Floats
    """dA/dδ along the curve, a length; NaN where it is infinite."""
    admissible: Flags
    """Whether the bodies stay apart outside the disc."""

    def _title(self) -> str:
        return f"{len(self)} points, smallest force {np.min(self.force):.6g}"

    def plot(self, ax: Any = None) -> Any:
        """Draws the force over the approach, unstable states thin and dashed, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        stable = self.stable_chosen
        (line,) = ax.plot(self.approach, np.where(stable, self.force, np.nan), label="stable")
        ax.plot(
            self.approach,
            np.where(stable, np.nan, self.force),
            linestyle="--",
            linewidth=0.8,
            color=line.get_color(),
            label="unstable",
        )
        ax.legend()
        return ax


class Unloading(Result):
    """A quasi-static unloading: its snaps and the pull-off, in order; each column has the shape (events,)."""

    kind: Texts
    """``snap`` or ``pull-off``."""
    control_value: Floats
    """δ, P, or Δ = δ + P/k at which it happens."""
    before_contact_radius: Floats
    before_approach: Floats
    before_force: Floats
    before_wave: Floats
    """The crest of the edge; NaN for a gap without waves."""
    after_contact_radius: Floats
    """NaN after a pull-off."""
    after_approach: Floats
    after_force: Floats
    after_wave: Floats
    dissipated: Floats
    """Energy lost; NaN where a dead load leaves no bound."""
    dissipated_by_area: Floats
    """The same by the area between curve and control line; NaN where it was not asked for."""
    reason: Texts
    admissible: NDArray[Any]
    """Whether limit point and landing are admissible; None where it was not asked for."""

    @property
    def min_force(self) -> float:
        """The smallest force on the path."""
        return float(self._said()["min_force"])

    @property
    def min_approach(self) -> float:
        """The smallest approach on the path."""
        return float(self._said()["min_approach"])

    @property
    def total_dissipated(self) -> float:
        """The sum of the losses that are defined."""
        return float(self._said()["total_dissipated"])

    def _title(self) -> str:
        return f"{len(self)} instabilities, smallest force {self.min_force:.6g}, lost {self.total_dissipated:.6g}"

    def plot(self, ax: Any = None) -> Any:
        """Draws every jump from limit point to landing over the approach, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        ax.plot(self.before_approach, self.before_force, "o", markersize=4, label="limit point")
        ax.plot(self.after_approach, self.after_force, "o", markersize=4, fillstyle="none", label="landing")
        for x, y, to_x, to_y in zip(
            self.before_approach, self.before_force, self.after_approach, self.after_force
        ):
            ax.plot([x, to_x], [y, to_y], color="gray", linewidth=0.8)
        ax.legend()
        return ax


class Cycle(Result):
    """A whole loop of loading and unloading: its stable states in order, a row for each contact of each state; each column
    has the shape (contacts,)."""

    state: Counts
    piece: Counts
    """The stable stretch between two jumps."""
    direction: Texts
    """``loading`` or ``unloading``."""
    control_value: Floats
    approach: Floats
    force: Floats
    energy: Floats
    contact_area: Floats
    contact: Counts
    """Which contact of its state, from the axis outward."""
    inner_radius: Floats
    outer_radius: Floats

    @property
    def events(self) -> List[Dict[str, Any]]:
        """What happened, in order, as the program's JSON has it."""
        return list(self._said()["events"])

    @property
    def loop(self) -> Dict[str, Any]:
        """The sums: what was dissipated, the work of loading and of unloading."""
        return dict(self._said()["loop"])

    def _title(self) -> str:
        return f"{len(self.events)} events, lost {self.loop['dissipated']}"

    def plot(self, ax: Any = None) -> Any:
        """Draws loading and unloading, the force over the approach, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        first = self.contact == 0
        colors: Dict[str, Any] = {}
        for piece in np.unique(self.piece):
            rows = first & (self.piece == piece)
            way = str(self.direction[rows][0])
            (line,) = ax.plot(
                self.approach[rows],
                self.force[rows],
                color=colors.get(way),
                label=None if way in colors else way,
            )
            colors[way] = line.get_color()
        ax.legend()
        return ax


class Stability(Result):
    """The law of stability of one disc over the contact radius; each column has the shape (radii,), from the end of the path
    outward. A state is stable where the work of adhesion is less than the critical one."""

    kind: Texts
    """``sample``; ``minimum`` or ``maximum``, a cusp of the law under the device, where a pair of limit points is born;
    ``corner``, where the second derivative of the gap jumps."""
    contact_radius: Floats
    """A length."""
    critical_displacement: Floats
    """The work of adhesion at which the state is a limit point under fixed grips, an energy per area; NaN where the law is not
    known."""
    critical_force: Floats
    """The same under a dead load."""
    critical_chosen: Floats
    """The same under the device."""

    @property
    def work_of_adhesion(self) -> float:
        """That of the problem, an energy per area."""
        return float(self._said()["work_of_adhesion"])

    def _title(self) -> str:
        cusps = int(np.isin(self.kind, ("minimum", "maximum")).sum())
        return f"{len(self)} radii, {cusps} cusps"

    def plot(self, ax: Any = None) -> Any:
        """Draws the law with its cusps, and the adhesion of the problem, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        ax.plot(self.contact_radius, self.critical_chosen, label="limit points; stable below")
        cusps = np.isin(self.kind, ("minimum", "maximum"))
        ax.plot(self.contact_radius[cusps], self.critical_chosen[cusps], ".", label="cusps")
        ax.axhline(self.work_of_adhesion, color="gray", linewidth=0.8, label="adhesion")
        ax.set_xlabel(self._unit("length", "contact radius s"))
        ax.set_ylabel(self._unit("energy_per_area", "work of adhesion γ"))
        ax.legend()
        return ax


class Map(Result):
    """Lines in two numbers on which the number of snaps changes, or the limit points over one number; each column has the
    shape (points,)."""

    line: Floats
    """The number of the point's line, from 1; NaN where it is on none."""
    kind: Texts
    """``fold``, ``cusp``, ``swallowtail``, ``landing`` or ``start``."""
    crest: Floats
    contact_radius: Floats
    x: Floats
    """The number on the x axis; NaN where it is infinite."""
    y: Floats
    control_value: Floats
    stable: Texts
    changes: NDArray[Any]
    """Of a line of a map, whether the number of snaps differs on its two sides."""

    @property
    def counts(self) -> Optional[Dict[str, NDArray[np.float64]]]:
        """The snaps at the corners of the cells: ``x``, shape (columns + 1,), ``y``, shape (rows + 1,), and ``snaps``, shape
        (rows + 1, columns + 1); NaN where there is no path. None for limit points."""
        counts = self._said()["counts"]
        return counts and {name: np.array(values, dtype=float) for name, values in counts.items()}

    def _title(self) -> str:
        said = self._said()
        return f"{said['y']['key']} over {said['x']['key']}, {len(self)} points"

    def plot(self, ax: Any = None) -> Any:
        """Draws the lines, over the number of snaps where it was counted, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        said, counts = self._said(), self.counts
        if counts is not None:
            drawn = ax.pcolormesh(counts["x"], counts["y"], counts["snaps"], shading="nearest", cmap="Blues")
            ax.figure.colorbar(drawn, label="snaps")
        for number in np.unique(self.line[~np.isnan(self.line)]):
            rows = (self.line == number) & (self.kind != "swallowtail")
            ax.plot(self.x[rows], self.y[rows], color="black", linewidth=0.8)
        for axis, name in ((said["x"], "x"), (said["y"], "y")):
            getattr(ax, f"set_{name}label")(axis["key"])
            if axis["logarithmic"]:
                getattr(ax, f"set_{name}scale")("log")
        return ax


class Fit(Result):
    """A problem fitted to a measured curve; each column has the shape (values,)."""

    key: Texts
    value: Floats
    """In SI or, where the problem is in reduced units, in those."""
    standard_error: Floats
    """NaN where it is not determined. It holds only where :attr:`verdict` is ``"describes"``."""
    start: Floats
    unit: Texts

    problem: Any
    """The :class:`pulloff.Problem` with the fitted values."""

    def __init__(self, document: _engine.Document, problem: Any) -> None:
        super().__init__(document)
        self.problem = problem

    @property
    def values(self) -> Dict[str, float]:
        """The fitted values by their keys."""
        return dict(zip(self.key.tolist(), self.value.tolist()))

    @property
    def errors(self) -> Dict[str, float]:
        """Their standard errors, which hold only where :attr:`verdict` is ``"describes"``."""
        return dict(zip(self.key.tolist(), self.standard_error.tolist()))

    @property
    def intervals(self) -> Dict[str, Optional[List[float]]]:
        """Their 95 % intervals by Student's t; None where they are not determined, or the model does not describe the points."""
        return {of["key"]: of["interval"] if of["error_holds"] else None for of in self._said()["parameters"]}

    @property
    def verdict(self) -> str:
        """``"describes"``, ``"does-not-describe"``, ``"not-determined"`` or ``"not-converged"``."""
        return str(self._said()["verdict"])

    @property
    def reasons(self) -> List[Dict[str, Any]]:
        """What speaks against the fit: ``kind``, ``sentence`` and ``value`` each."""
        return list(self._said()["reasons"])

    @property
    def notes(self) -> List[str]:
        """What was found, assumed and held, in sentences."""
        return list(self._said()["notes"])

    def _title(self) -> str:
        said = self._said()
        return f"{said['points']} points, chi squared per point {said['chi_squared']:.4g}, {said['verdict']}"


class Sweep(Table):
    """Many problems: the axes' values, the quantities and the error of each row; each column has the shape (rows,)."""

    row: Counts
    error: Texts
    """Why a row has not all of its quantities; None where it has."""

    def __init__(self, columns: Mapping[str, Any], axes: Tuple[str, ...]) -> None:
        super().__init__(columns)
        self.axes = axes
        """The keys of the axes, which are names of columns: ``sweep["gap.amplitude"]``."""

    def to_dict(self) -> Dict[str, List[Any]]:
        """All columns as lists."""
        return {name: self._column(name).tolist() for name in self.columns}

    def _title(self) -> str:
        wrong = sum(error is not None for error in self.error)
        return f"{len(self)} rows, {wrong} with an error"

    def plot(self, quantity: Optional[str] = None, ax: Any = None) -> Any:
        """Draws a quantity, the first where none is named, over the first axis, and returns the axes of matplotlib."""
        if quantity is None:
            quantity = self.columns[1 + len(self.axes)]
        if ax is None:
            try:
                import matplotlib.pyplot as plt
            except ImportError:
                raise ImportError("plot needs matplotlib: pip install matplotlib") from None
            ax = plt.figure().add_subplot()
        ax.plot(self[self.axes[0]], self[quantity], ".-" if len(self.axes) == 1 else ".")
        ax.set_xlabel(self.axes[0])
        ax.set_ylabel(quantity)
        return ax
