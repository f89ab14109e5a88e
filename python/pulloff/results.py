"""Results: columns as arrays, the document as a dict, a table and a figure in a notebook."""

from __future__ import annotations

import csv
import io
import json
import math
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Tuple

from . import _engine
from ._table import Result, Table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Flags = NDArray[np.bool_]
    Counts = NDArray[np.int64]
    Texts = NDArray[np.object_]
else:
    from ._numpy import np


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
    """U: the elastic energy minus γ times the contact area."""
    newton_iterations: Counts
    stable_displacement: Flags
    stable_force: Flags
    stable_chosen: Flags
    """Whether the state is stable under the problem's own control."""
    contact_stiffness: Floats
    """∂P/∂δ at fixed contact radius, a force per length."""
    tangent_stiffness: Floats
    """dP/dδ along the curve, a force per length; NaN at a limit point of displacement."""
    area_slope: Floats
    """dA/dδ along the curve, a length; NaN where it is infinite."""
    admissible: Flags
    """Whether the bodies stay apart outside the disc."""
    exact_approach: Floats
    """Only with ``theory=True``: δ of the exact solution at the same contact radius."""
    exact_force: Floats
    exact_energy: Floats
    exact_relative_difference: Floats
    """(P − exact P)/|exact P|."""

    def _title(self) -> str:
        return f"{self.row_count} points, smallest force {np.min(self.force):.6g}"

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


class Path(Result):
    """What happens as the device moves, in an unloading or a whole loop: the events in order; each column has the shape
    (events,)."""

    number: Counts
    """The number of the event on the path, from 1."""
    kind: Texts
    """``jump-in``, ``first-touch``, ``touch``, ``merge``, ``snap-in``, ``snap``, ``last-contact``, ``snap-off``, ``split``, ``vanish``, ``turn`` or ``depin``."""
    direction: Texts
    """``loading`` or ``unloading``."""
    control: Floats
    """δ, P, or Δ = δ + P/k at the event."""
    radius: Floats
    """Where a crest touches, contacts merge or split, one vanishes, or a held edge begins to move, a length; otherwise NaN."""
    before_contact_radius: Floats
    """The outermost edge, a length; NaN while the bodies are apart, as for all columns that begin with ``before_``."""
    before_approach: Floats
    before_force: Floats
    before_wave: Floats
    """The crest at the edge; NaN for a gap without waves."""
    before_rings: Floats
    """The number of rings of contact, not counting the disc."""
    before_area: Floats
    before_energy: Floats
    after_contact_radius: Floats
    """NaN once the bodies are apart, as for all columns that begin with ``after_``."""
    after_approach: Floats
    after_force: Floats
    after_wave: Floats
    after_rings: Floats
    after_area: Floats
    after_energy: Floats
    dissipated: Floats
    """Energy lost; NaN where a dead load leaves no bound."""
    dissipated_by_area: Floats
    """The same from the area between curve and control line; NaN where it was not requested."""
    admissible: NDArray[Any]
    """With one disc: whether the states before and after are admissible; None where it was not requested."""

    @property
    def largest_pull(self) -> float:
        """The smallest force on the path, negative where the bodies stick; NaN where it ends before anything pulls."""
        state = self.totals["largest_pull"]
        return math.nan if state is None else float(state["force"])

    @property
    def farthest(self) -> float:
        """The smallest approach on the path."""
        return float(self.totals["farthest"]["approach"])

    @property
    def events(self) -> List[Dict[str, Any]]:
        """The events in order, as in the program's JSON."""
        return list(self._said()["events"])

    @property
    def totals(self) -> Dict[str, Any]:
        """The sums and the states at the extremes: ``largest_pull``, ``farthest``, ``last_contact``, ``dissipated``,
        ``work_of_loading`` and so on, as in the program's JSON."""
        return dict(self._said()["totals"])

    @property
    def states(self) -> Table:
        """The stable states in order; each column has the shape (states,). ``contacts`` is a list of [inner, outer] for each
        state, from the axis outward; a disc is [0, s]. With adhesion with a range there is also ``zone_radius``, the outer edge of
        the zone of tension."""
        states = self._said()["states"]
        arrays: Dict[str, Any] = {}
        for name in ("piece", "direction", "control", "approach", "force", "contact_radius", "held_stiffness", "area", "energy"):
            values = [state[name] for state in states]
            arrays[name] = np.array(values, dtype=object if name == "direction" else None)
        contacts = np.empty(len(states), dtype=object)
        contacts[:] = [state["contacts"] for state in states]
        if any("zone_radius" in state for state in states):
            arrays["zone_radius"] = np.array([state.get("zone_radius", np.nan) for state in states])
        return Table({**arrays, "contacts": contacts})

    def _title(self) -> str:
        return f"{self.row_count} events, largest pull {self.largest_pull:.6g}, lost {self.totals['dissipated']}"

    def plot(self, ax: Any = None) -> Any:
        """Draws the stable stretches and the jumps, the force over the approach, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        states = self.states
        colors: Dict[str, Any] = {}
        for piece in np.unique(states["piece"]):
            rows = states["piece"] == piece
            way = str(states["direction"][rows][0])
            (line,) = ax.plot(
                states["approach"][rows],
                states["force"][rows],
                color=colors.get(way),
                label=None if way in colors else way,
            )
            colors[way] = line.get_color()
        for x, y, to_x, to_y in zip(
            self.before_approach, self.before_force, self.after_approach, self.after_force
        ):
            ax.plot([x, to_x], [y, to_y], color="gray", linewidth=0.8)
        ax.legend()
        return ax


class Pull(Result):
    """Pulls at a rate, a row for each; each column has the shape (rates,). If only dead loads were requested, the columns are
    ``force`` and ``time``."""

    rate: Floats
    """The rate of the control; NaN where ``path.steps`` says what is done."""
    peak_time: Floats
    peak_contact_radius: Floats
    peak_approach: Floats
    peak_force: Floats
    """The largest pull, as the least force on the way."""
    tension_peaks: Counts
    snaps: Counts
    last_contact_time: Floats
    """The time at which the bodies come apart; NaN where they do not."""
    last_contact_control: Floats
    dissipated: Floats
    """What the edge dissipates, an energy; NaN where a dead load falls without end."""
    top_edge_speed: Floats
    balance: Floats
    """The error in the balance of work and energy, over the work."""

    @property
    def runs(self) -> List[Dict[str, Any]]:
        """The pulls with their snaps and tension peaks, as in the document."""
        return list(self._said()["runs"])

    @property
    def failures(self) -> List[Dict[str, Any]]:
        """Dead loads with the time for which each holds; ``None`` if it holds indefinitely."""
        return list(self._said()["failures"])

    def _title(self) -> str:
        return f"{len(self.runs)} pulls, {len(self.failures)} dead loads"

    def plot(self, ax: Any = None) -> Any:
        """Draws the largest pull over the rate, or the time to failure over the dead load, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        if "rate" not in self:
            ax.semilogy(self["force"], self["time"], ".-")
            ax.set_xlabel(self._unit("force", "dead load P"))
            ax.set_ylabel("time to failure")
            return ax
        ax.loglog(self.rate, -self.peak_force, ".-")
        ax.set_xlabel("rate")
        ax.set_ylabel(self._unit("force", "largest pull −P"))
        return ax


class Speeds(Result):
    """The energy release rate of measured rows beside the speed of their edge; each column has the shape (rows,)."""

    time: Floats
    """In seconds, or in reduced units; NaN if no column gives it."""
    contact_radius: Floats
    """s, measured or from force and approach."""
    speed: Floats
    """−ds/dt, positive where the contact recedes; NaN without times."""
    energy_release_rate: Floats
    """G, negative where the edge is pressed."""
    error: Floats
    """The standard deviation of G, from the noise of the columns."""
    speed_error: Floats
    window: Floats
    """The number of rows from which the speed is found."""
    segment: Texts
    row: Counts
    """The number among the rows read, from 1."""

    def _title(self) -> str:
        return f"{self.row_count} rows in contact"

    def plot(self, ax: Any = None) -> Any:
        """Draws G over the speed where the contact recedes, and returns the axes of matplotlib."""
        ax = self._axes(ax)
        recedes = self.speed > 0
        ax.loglog(self.speed[recedes], self.energy_release_rate[recedes], ".")
        ax.set_xlabel("speed of the edge −ds/dt")
        ax.set_ylabel(self._unit("energy_per_area", "energy release rate G"))
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
        """The work of adhesion of the problem, an energy per area."""
        return float(self._said()["work_of_adhesion"])

    def _title(self) -> str:
        cusps = int(np.isin(self.kind, ("minimum", "maximum")).sum())
        return f"{self.row_count} radii, {cusps} cusps"

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
    """``fold``, ``cusp``, ``swallowtail``, ``landing``, ``start`` or ``change``."""
    crest: Floats
    contact_radius: Floats
    x: Floats
    """The number on the x axis; ``inf`` for the compliance of a dead load."""
    y: Floats
    control: Floats
    stable: Texts
    changes: NDArray[Any]
    """For a line of a map, whether the number of snaps differs on its two sides."""

    @property
    def counts(self) -> Optional[Dict[str, NDArray[np.float64]]]:
        """The snaps at the corners of the cells: ``x``, shape (columns + 1,), ``y``, shape (rows + 1,), and ``snaps``, shape
        (rows + 1, columns + 1); NaN where there is no path. None for limit points."""
        counts = self._said()["counts"]
        return counts and {
            name: self._with_end(name, np.array(values, dtype=float)) for name, values in counts.items()
        }

    def _column(self, name: str) -> NDArray[Any]:
        if name not in self._arrays and name in ("x", "y"):
            self._arrays[name] = self._with_end(name, super()._column(name).copy())
        return super()._column(name)

    def _middle(self, name: str) -> Optional[float]:
        """The value in the middle of an axis that goes to infinity."""
        axis = self._said().get(name)
        return axis["middle"] if isinstance(axis, dict) else None

    def _with_end(self, name: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values of an axis; JSON cannot write infinity."""
        if self._middle(name) is not None:
            values[np.isnan(values)] = np.inf
        return values

    def _drawn(self, name: str, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where values are drawn on an axis: at c/(c + c₀) if it goes to infinity, with c₀ in the middle."""
        middle = self._middle(name)
        if middle is None:
            return values
        end = np.isinf(values)
        return np.where(end, 1.0, values / (np.where(end, 0.0, values) + middle))

    def _title(self) -> str:
        said = self._said()
        return f"{said['y']['key']} over {said['x']['key']}, {self.row_count} points"

    def plot(self, ax: Any = None) -> Any:
        """Draws the lines, over the number of snaps if it was counted, and returns the axes of matplotlib. An axis of
        compliances that goes to infinity has equal steps in c/(c + c₀)."""
        ax = self._axes(ax)
        said, counts = self._said(), self.counts
        if counts is not None:
            drawn = ax.pcolormesh(self._drawn("x", counts["x"]), self._drawn("y", counts["y"]), counts["snaps"], shading="nearest", cmap="Blues")
            ax.figure.colorbar(drawn, label="snaps")
        for number in np.unique(self.line[~np.isnan(self.line)]):
            rows = (self.line == number) & (self.kind != "swallowtail")
            ax.plot(self._drawn("x", self.x[rows]), self._drawn("y", self.y[rows]), color="black", linewidth=0.8)
        for axis, name in ((said["x"], "x"), (said["y"], "y")):
            if axis["middle"] is not None:
                shares = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
                labels = [f"{axis['middle'] * share / (1.0 - share):.3g}" for share in shares[:-1]] + ["∞"]
                getattr(ax, f"set_{name}ticks")(shares, labels)
            getattr(ax, f"set_{name}label")(axis["key"])
            if axis["logarithmic"]:
                getattr(ax, f"set_{name}scale")("log")
        return ax


class _Fitted(Result):
    """Fitted values; each column has the shape (values,)."""

    key: Texts
    value: Floats
    """In SI or, if the problem is in reduced units, in those."""
    standard_error: Floats
    """NaN where it is not determined. It holds only if :attr:`verdict` is ``"describes"``."""
    start: Floats
    unit: Texts

    problem: Any
    """The :class:`pulloff.Problem` with the fitted values."""

    def __init__(self, document: _engine.Document, problem: Any) -> None:
        super().__init__(document)
        self.problem = problem

    def __getattr__(self, name: str) -> Any:
        # Whatever else the document has: chi_squared, correlations, sigma.
        if not name.startswith("_") and name not in self.columns:
            said = self._said()
            if name in said:
                return said[name]
        return super().__getattr__(name)

    @property
    def parameters(self) -> Dict[str, float]:
        """The fitted values by their keys."""
        return dict(zip(self.key.tolist(), self.value.tolist()))

    @property
    def errors(self) -> Dict[str, float]:
        """Their standard errors, which hold only if :attr:`verdict` is ``"describes"``."""
        return dict(zip(self.key.tolist(), self.standard_error.tolist()))

    @property
    def verdict(self) -> str:
        """``"describes"``, ``"does-not-describe"``, ``"not-determined"`` or ``"not-converged"``."""
        return str(self._said()["verdict"])

    def __eq__(self, other: object) -> bool:
        return super().__eq__(other) and (not isinstance(other, _Fitted) or self.problem == other.problem)

    __hash__ = None


class Together(_Fitted):
    """One law fitted to several measured curves."""

    @property
    def collapse(self) -> Dict[str, Any]:
        """Whether the curves follow one law: ``collapses``, None where a fit has not come to its end, ``chi_squared``,
        ``values``, ``chance`` and ``sentence``."""
        return dict(self._said()["collapse"])

    @property
    def runs(self) -> List[Dict[str, Any]]:
        """Each curve: its ``fit`` under the one law, as in :class:`Fit`, and the values that it has ``alone``."""
        return list(self._said()["runs"])

    def _title(self) -> str:
        return f"{len(self.runs)} curves, {self.verdict}: {self.collapse['sentence']}"


class Fit(_Fitted):
    """A problem fitted to a measured curve."""

    models: Optional[Dict[str, Any]]
    """If several models were fitted: ``best``, the ``fits`` of all, ``pairs`` of the best and each other with what tells them apart,
    and ``refused``, those that could not be fitted. Otherwise None."""

    def __init__(self, document: _engine.Document, problem: Any, points: str, models: Optional[str] = None) -> None:
        super().__init__(document, problem)
        self.models = None if models is None else json.loads(models)
        self._points = points

    @property
    def rows(self) -> Dict[str, Any]:
        """The number of rows by branch, ``"approach"`` and ``"retraction"``, and part: ``"contact"``, ``"free"``, within the
        ``"jump"``, and ``"dropped"``; and those of ``"pause"``."""
        return dict(self._said()["rows"])

    @property
    def residuals(self) -> Table:
        """The points beside the fit: ``row``, ``line`` of the file, ``segment``, ``part``, ``x``, ``force``, ``residual`` in standard deviations, ``outlier``,
        each of the shape (points,). x and the force are in SI or reduced units, with their signs corrected."""
        return Table(_columns_of(self._points))

    @property
    def intervals(self) -> Dict[str, Optional[List[float]]]:
        """Their 95 % intervals from Student's t; None where they are not determined, or the model does not describe the points."""
        return {of["key"]: of["interval"] if of["error_holds"] else None for of in self._said()["parameters"]}

    @property
    def reasons(self) -> List[Dict[str, Any]]:
        """What speaks against the fit: each with ``kind``, ``sentence`` and ``value``."""
        return list(self._said()["reasons"])

    @property
    def notes(self) -> List[str]:
        """What was found, assumed and held fixed, in sentences."""
        return list(self._said()["notes"])

    def plot(self, ax: Any = None) -> Any:
        """Draws the points and the fitted curve, the force over x without offset and baseline, and returns the axes of
        matplotlib."""
        ax = self._axes(ax)
        values, points, curve = self.problem.to_dict(), self.residuals, self.problem.trace(progress=False)
        abscissa = self._said()["abscissa"]
        line = {"contact radius": curve.contact_radius}.get(abscissa, curve.approach)
        control = values["path.control"]
        if abscissa == "position" and isinstance(control, str) and control.startswith("stiffness="):
            line = curve.approach + curve.force / float(control.partition("=")[2])
        offset = 0.0 if abscissa == "contact radius" else values.get("data.offset", 0.0)
        x = points.x - offset
        force = points.force - values.get("data.baseline", 0.0) - values.get("data.tilt", 0.0) * points.x
        for part, rows in (("in contact", points.part == "contact"), ("apart", points.part != "contact")):
            if rows.any():
                ax.plot(x[rows], force[rows], ".", markersize=3, label=part)
        ax.plot(line, curve.force, color="black", linewidth=0.8, label="fit")
        ax.set_xlabel(self._unit("length", abscissa))
        ax.legend()
        return ax

    def _unit(self, quantity: str, symbol: str) -> str:
        unit = {"length": "m", "force": "N"}[quantity] if self.problem.to_dict().get("units") == "SI" else None
        return f"{symbol} ({unit})" if unit else symbol

    def _title(self) -> str:
        said = self._said()
        fitted = sum(said["rows"][branch][part] for branch in ("approach", "retraction") for part in ("contact", "free"))
        return f"{fitted} points, chi squared per degree of freedom {said['chi_squared']:.4g}, {said['verdict']}"


def _columns_of(text: str) -> Dict[str, Any]:
    """The columns of a CSV of the engine: numbers, flags or strings."""
    names, *rows = csv.reader(io.StringIO(text))
    columns: Dict[str, Any] = {}
    for name, cells in zip(names, zip(*rows) if rows else ((),) * len(names)):
        if cells and set(cells) <= {"true", "false"}:
            columns[name] = np.array([cell == "true" for cell in cells])
            continue
        for kind in (np.int64, np.float64):
            try:
                columns[name] = np.array(cells, dtype=str).astype(kind)
                break
            except ValueError:
                pass
        else:
            columns[name] = list(cells)
    return columns


class Sweep(Table):
    """Many problems: the axes' values, the quantities and the error of each row; each column has the shape (rows,)."""

    row: Counts
    error: Texts
    """Why some quantities of a row are missing; otherwise None."""

    def __init__(
        self, columns: Mapping[str, Any], axes: Tuple[str, ...], of_members: Optional["Sweep"] = None
    ) -> None:
        super().__init__(columns)
        self.axes = axes
        """The keys of the axes, which are names of columns: ``sweep["gap.amplitude"]``."""
        self.of_members = of_members
        """For an ensemble, whose rows are statistics: a row for each member at each point. Otherwise None."""

    def to_dict(self) -> Dict[str, List[Any]]:
        """All columns as lists."""
        return {name: self._column(name).tolist() for name in self.columns}

    def _title(self) -> str:
        wrong = sum(error is not None for error in self.error)
        return f"{self.row_count} rows, {wrong} with an error"

    def plot(self, quantity: Optional[str] = None, ax: Any = None) -> Any:
        """Draws a quantity, by default the first, over the first axis, and returns the axes of matplotlib.

        For an ensemble it is the median, with areas that hold 50 and 90 % of the members; without an axis, the distribution of
        its members. Over two axes or more, colours show the quantity on the first two.
        """
        if quantity is None:
            quantity = self.columns[1 + len(self.axes)]
            if self.of_members is not None:
                quantity = quantity.rpartition(".")[0]
        if ax is None:
            try:
                import matplotlib.pyplot as plt
            except ImportError:
                raise ImportError("plot needs matplotlib: pip install matplotlib") from None
            ax = plt.figure().add_subplot()
        if not self.axes:
            values = self[quantity] if self.of_members is None else self.of_members[quantity]
            ax.hist(values[np.isfinite(values)], bins="auto")
            ax.set_xlabel(quantity)
            ax.set_ylabel("members")
            return ax
        if len(self.axes) > 1:
            shown = quantity if quantity in self else f"{quantity}.q50"
            drawn = ax.scatter(self[self.axes[0]], self[self.axes[1]], c=self[shown], marker="s")
            ax.figure.colorbar(drawn, label=shown)
            ax.set_xlabel(self.axes[0])
            ax.set_ylabel(self.axes[1])
            return ax
        along, drawn = self[self.axes[0]], quantity
        if self.of_members is not None and f"{quantity}.q50" in self:
            drawn = f"{quantity}.q50"
            for low, high in (("q05", "q95"), ("q25", "q75")):
                ax.fill_between(along, self[f"{quantity}.{low}"], self[f"{quantity}.{high}"], alpha=0.3, color="tab:blue")
        ax.plot(along, self[drawn], ".-")
        ax.set_xlabel(self.axes[0])
        ax.set_ylabel(quantity)
        return ax
