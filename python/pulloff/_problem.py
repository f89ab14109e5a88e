"""A problem, and all that is computed of it."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Mapping, Optional, Sequence, Tuple, Union

from . import _engine
from ._progress import Progress, told
from .errors import ComputationError, DataError, MapError, NotCertified, NotConverged, NotDetermined, PresetError
from .results import Cycle, Fit, Map, Stability, Trace, Unloading

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray
else:
    from ._numpy import np

Value = Union[float, int, str]
Control = Union[str, float]
Axis = Union[Tuple[str, float, float], Tuple[str, float, float, str]]

# A function is sampled at so many radii at first and at most: as many as the engine takes as knots.
_SAMPLES = (65, 3841)


class Problem:
    """One problem of adhesive contact: two bodies, their gap, a loading device, a start. It never changes.

    Parameters
    ----------
    source : str or path
        The name of a preset that comes with the package (see :func:`pulloff.presets`); a file: a path object, or a text
        with a ``/`` or ending in ``.toml``; or the text of a preset, of more than one line.
    changes : dict, optional
        Other values by their keys, as ``{"gap.amplitude": 3e-3}``. A text is read as the program's ``--set`` reads it, with
        its unit where the problem has units: ``{"gap.amplitude": "2 um"}``.

    Raises
    ------
    PresetError
        The source or a value is refused; ``key`` and ``line`` say which.
    """

    __slots__ = ("_native",)
    _native: _engine.Problem

    def __init__(
        self, source: Union[str, "os.PathLike[str]"], changes: Optional[Mapping[str, Value]] = None
    ) -> None:
        if not isinstance(source, str):
            native = _engine.Problem.of_file(os.fspath(source))
        elif "\n" in source:
            native = _engine.Problem.of_text(source)
        elif "/" in source or source.endswith(".toml"):
            native = _engine.Problem.of_file(source)
        else:
            native = _engine.Problem.shipped(source)
        self._native = native.replace(dict(changes)) if changes else native

    @classmethod
    def _of(cls, native: _engine.Problem) -> "Problem":
        problem = cls.__new__(cls)
        problem._native = native
        return problem

    @classmethod
    def from_gap(
        cls,
        r: ArrayLike,
        h: Union[ArrayLike, Callable[[NDArray[np.float64]], ArrayLike]],
        *,
        effective_modulus: float,
        work_of_adhesion: float,
        start_contact_radius: float,
        units: str = "reduced",
        tolerance: float = 1e-6,
        changes: Optional[Mapping[str, Value]] = None,
    ) -> "Problem":
        """A gap of one's own.

        Parameters
        ----------
        r : array, shape (n,), or float
            Radii from the axis, ascending, a length. With a function ``h``: the largest radius at which it is known.
        h : array, shape (n,), or function
            The gap between the undeformed bodies, a length. A function is called with an array of radii and returns as
            many gaps. It is sampled once, on a grid that is refined until a smooth curve through the samples gives the
            function back between them; where that is not reached it is refused.
        effective_modulus, work_of_adhesion : float
            E* (Pa in SI) and γ (J/m² in SI).
        start_contact_radius : float
            The contact radius at the start.
        units : {"reduced", "SI"}
            ``"SI"``: every number is in SI units. ``"reduced"``: in any consistent units.
        tolerance : float
            How far the curve may miss the function between samples, as a share of the range of its values.
        changes : dict, optional
            As of :class:`Problem`.

        Raises
        ------
        NotCertified
            The samples do not resolve the function.
        PresetError
            The rows or a value are refused.
        """
        if callable(h):
            radii, gaps = _sampled(h, float(np.asarray(r, dtype=float)), tolerance)
        else:
            radii, gaps = _column("r", r), _column("h", h)
            if radii.shape != gaps.shape:
                raise PresetError(f"r has {radii.size} values and h has {gaps.size}: they must be as many", key="gap.file")
        text = "\n".join(
            [
                f"units = {json.dumps(str(units))}",
                "[material]",
                f"effective_modulus = {float(effective_modulus)!r}",
                f"work_of_adhesion = {float(work_of_adhesion)!r}",
                "[gap]",
                'shape = "profile"',
                'file = "arrays"',
                "[path]",
                f"start_contact_radius = {float(start_contact_radius)!r}",
            ]
        )
        native = _engine.Problem.of_rows(text, radii, gaps)
        return cls._of(native.replace(dict(changes)) if changes else native)

    def replace(self, changes: Optional[Mapping[str, Value]] = None, **more: Value) -> "Problem":
        """The same problem with other values, checked as a whole."""
        return self._of(self._native.replace({**(changes or {}), **more}))

    @property
    def title(self) -> str:
        """One line that says what it shows."""
        return self._native.title

    def to_dict(self) -> Dict[str, Value]:
        """Every key with its value, in SI or in reduced units."""
        return self._native.values()

    def to_toml(self) -> str:
        """As the text of a preset."""
        return self._native.to_toml()

    def __getitem__(self, key: str) -> Value:
        values = self._native.values()
        if key not in values:
            raise KeyError(f"{key!r} is no key of this problem; there is {', '.join(values)}")
        return values[key]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Problem) and self.to_toml() == other.to_toml()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def __repr__(self) -> str:
        return f"<pulloff.Problem: {self.title or self['gap.shape']}>"

    def trace(self, *, progress: Progress = None) -> Trace:
        """The equilibrium curve from the start inward, by arc length.

        Raises
        ------
        ComputationError
            It cannot be computed; :class:`StartError` where there is no equilibrium at the start.
        """
        with told(progress, "trace") as tell:
            return Trace(self._native.trace(tell))

    def unload(
        self,
        control: Optional[Control] = None,
        *,
        areas: bool = True,
        admissibility: bool = True,
        progress: Progress = None,
    ) -> Unloading:
        """The quasi-static unloading from the start: its snaps and the pull-off, and what each dissipates.

        Parameters
        ----------
        control : {"displacement", "force"} or float, optional
            What the loading device prescribes; a number is the stiffness of a spring, a force per length.
        areas, admissibility : bool
            Whether losses are computed in a second way, and whether it is checked that the bodies stay apart outside the
            disc. Each takes longer than all the rest; without both it costs what a row of a sweep costs.
        """
        problem = self._under(control)
        with told(progress, "unload") as tell:
            return Unloading(problem.unload(areas, admissibility, tell))

    def cycle(
        self,
        control: Optional[Control] = None,
        *,
        to_approach: Optional[float] = None,
        to_force: Optional[float] = None,
        to_radius: Optional[float] = None,
        areas: bool = True,
        progress: Progress = None,
    ) -> Cycle:
        """The whole loop: from apart to the first touch, up to a turn and back until apart, with rings of contact.

        Parameters
        ----------
        control : {"displacement", "force"} or float, optional
            As of :meth:`unload`.
        to_approach, to_force, to_radius : float, optional
            It turns round at the first stable state with at least this much; one of them at most.
        areas : bool
            Whether losses are computed in a second way.
        """
        turns = {
            "path.turn_approach": to_approach,
            "path.turn_force": to_force,
            "path.turn_contact_radius": to_radius,
        }
        given = {key: value for key, value in turns.items() if value is not None}
        if len(given) > 1:
            raise PresetError(f"a loop turns round once: {' and '.join(given)} are too many", key=list(given)[1])
        problem = self._under(control)
        if given:
            problem = problem.replace(given)
        with told(progress, "cycle") as tell:
            return Cycle(problem.cycle(areas, tell))

    def stability(
        self, control: Optional[Control] = None, *, samples: int = 1501, progress: Progress = None
    ) -> Stability:
        """The law of stability: the work of adhesion at which each state is a limit point, over the contact radius.

        Parameters
        ----------
        control : {"displacement", "force"} or float, optional
            As of :meth:`unload`.
        samples : int
            Radii of equal distance from the end of the path to its start, 2 to 1000000; cusps and corners come between them.
        """
        if not 2 <= samples <= 1_000_000:
            raise ComputationError(f"samples = {samples} is out of range: it must be from 2 to 1000000")
        problem = self._under(control)
        with told(progress, "stability") as tell:
            return Stability(problem.stability(int(samples), tell))

    def map(
        self,
        x: Axis,
        y: Union[Axis, str] = "control",
        *,
        control: Optional[Control] = None,
        cells: Tuple[int, int] = (48, 36),
        progress: Progress = None,
    ) -> Map:
        """Where snaps begin, as lines in two numbers, or the limit points over one.

        Parameters
        ----------
        x : (key, from, to) or (key, from, to, "log")
            A key of the problem, a group as ``"groups.adhesion"``, or ``"compliance"``, which is 1/k from 0 (displacement) to
            ``math.inf`` (a dead load).
        y : the same, or {"control", "approach", "force"}
            Another number; or, of the limit points over x, what is wanted of them.
        control : {"displacement", "force"} or float, optional
            As of :meth:`unload`.
        cells : (columns, rows)
            At the corners of how many cells the snaps are counted, where both axes are numbers.
        """
        if isinstance(y, str) and y not in ("control", "approach", "force"):
            raise MapError(f"y = {y!r} is not known: it must be 'control', 'approach', 'force', or (key, from, to)")
        columns, rows = (int(count) for count in cells)
        if not (1 <= columns <= 1000 and 1 <= rows <= 1000):
            raise MapError(f"cells = {cells!r} is out of range: from 1 to 1000 columns and rows")
        problem = self._under(control)
        ordinate, other = (y, None) if isinstance(y, str) else ("control", _axis(y))
        with told(progress, "map") as tell:
            return Map(problem.map(_axis(x), other, ordinate, columns, rows, tell))

    def fit(
        self,
        data: Union[str, "os.PathLike[str]", Mapping[str, ArrayLike]],
        free: Sequence[str],
        *,
        columns: Optional[str] = None,
        separate: bool = False,
        robust: bool = True,
        sigma_x: Optional[float] = None,
        sigma_force: Optional[float] = None,
        scan: bool = True,
        profile: bool = False,
        bootstrap: Optional[int] = None,
        seed: int = 1,
        progress: Progress = None,
    ) -> Fit:
        """The values of some keys that a measured curve gives, with their standard errors.

        Parameters
        ----------
        data : path or dict of arrays, shape (points,)
            A file that the program's ``fit`` reads; or columns by their names, ``"force"`` with ``"approach"``,
            ``"position"`` (of the other end of a spring) or ``"contact radius"``, and ``"segment"`` where it is known; in SI or,
            where the problem is in reduced units, in those.
        free : sequence of str
            The keys to fit, and ``data.offset``, ``data.baseline``, ``data.tilt`` of the instrument.
        columns : str, optional
            What the columns of a file are where its header does not say it, as ``"x=1,force=2"``.
        separate : bool
            Whether approach and retraction have a work of adhesion each.
        robust : bool
            Whether points far away count linearly, not squared.
        sigma_x, sigma_force : float, optional
            Standard deviations; found where they are not given.
        scan : bool
            Whether starts other than the problem's own values are tried.
        profile : bool
            Whether 95 % intervals are found by the profile of χ²; ``to_dict()`` has them.
        bootstrap, seed : int, optional
            Fits to so many sets of blocks of rows drawn at random, 10 to 100000.

        Raises
        ------
        NotDetermined
            The points do not determine the values; the sentence says which, and ``result`` is the fit.
        NotConverged, FitError
            It did not come to its end, or to nothing.
        DataError
            The points, or what is asked of them, are refused.
        """
        if isinstance(data, Mapping):
            name, text = "data", _points(data, self._native.values().get("units") == "SI")
        else:
            name = os.fspath(data)
            try:
                with open(data, "rb") as file:
                    text = file.read()
            except (OSError, ValueError) as error:
                raise DataError(f"{name}: {error}") from error
        if bootstrap is not None and not 10 <= bootstrap <= 100_000:
            raise DataError(f"bootstrap = {bootstrap} is out of range: it must be from 10 to 100000")
        for what, sigma in (("sigma_x", sigma_x), ("sigma_force", sigma_force)):
            if sigma is not None and not 0.0 < sigma < float("inf"):
                raise DataError(f"{what} = {sigma!r} is out of range: a standard deviation is above 0")
        if isinstance(free, str):
            free = [free]
        drawn = None if bootstrap is None else (int(bootstrap), int(seed))
        with told(progress, "fit") as tell:
            document, problem, ended, direction = _engine.fitted(
                self._native,
                name,
                text,
                columns,
                list(free),
                separate,
                robust,
                (sigma_x, sigma_force),
                scan,
                profile,
                drawn,
                tell,
            )
        result = Fit(document, self._of(problem))
        if ended != "converged":
            raise NotConverged("the fit did not converge; result has the best values so far", result=result)
        if direction is not None:
            raise NotDetermined(direction, result=result)
        return result

    def pressure(self, s: float, r: ArrayLike) -> NDArray[np.float64]:
        """The contact pressure at the radii ``r`` in equilibrium at the contact radius ``s``, compression positive.

        It has the shape of ``r`` and is a stress. NaN at the edge, where adhesion makes it infinite, and outside. By the
        exact solution, whatever the basis of the problem.
        """
        return self._across(s, r)[1]

    def gap(self, s: float, r: ArrayLike) -> NDArray[np.float64]:
        """The gap between the deformed bodies at the radii ``r`` in equilibrium at the contact radius ``s``.

        It has the shape of ``r`` and is a length: 0 inside the contact, NaN beyond what is known of the bodies, negative
        where a crest would overlap. By the exact solution, whatever the basis of the problem.
        """
        return self._across(s, r)[2]

    def _across(self, s: float, r: ArrayLike) -> Tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        radii = np.asarray(r, dtype=float)
        flat = np.ascontiguousarray(radii).reshape(-1)
        approach, pressure, gap = self._native.across(float(s), flat)
        return approach, pressure.reshape(radii.shape), gap.reshape(radii.shape)

    def _under(self, control: Optional[Control]) -> _engine.Problem:
        if control is None:
            return self._native
        given = control if isinstance(control, str) else f"stiffness={float(control)!r}"
        return self._native.replace({"path.control": given})


def _points(data: Mapping[str, ArrayLike], in_si: bool) -> bytes:
    """Columns as the table that the engine reads."""
    units = {"force": " [N]", "segment": ""} if in_si else {}
    columns = {str(name).replace("_", " "): np.asarray(values) for name, values in data.items()}
    lengths = {column.size for column in columns.values() if column.ndim == 1}
    if len(lengths) != 1 or any(column.ndim != 1 for column in columns.values()):
        shapes = ", ".join(f"{name} {column.shape}" for name, column in columns.items())
        raise DataError(f"the columns must have one dimension and one length: {shapes or 'there are none'}")
    header = ",".join(name + units.get(name, " [m]" if in_si else "") for name in columns)
    lists = [column.tolist() for column in columns.values()]
    rows = (",".join(x if isinstance(x, str) else repr(x) for x in row) for row in zip(*lists))
    return "\n".join([header, *rows, ""]).encode()


def _axis(axis: Axis) -> Tuple[str, float, float, bool]:
    words = "an axis is (key, from, to) or (key, from, to, 'log')"
    if isinstance(axis, str) or not 3 <= len(axis) <= 4 or (len(axis) == 4 and axis[3] != "log"):
        raise MapError(f"{axis!r}: {words}")
    key, lo, hi = axis[:3]
    if not isinstance(key, str):
        raise MapError(f"{axis!r}: {words}")
    return key, float(lo), float(hi), len(axis) == 4


def _column(name: str, values: ArrayLike) -> NDArray[np.float64]:
    column = np.ascontiguousarray(values, dtype=float)
    if column.ndim != 1:
        raise PresetError(f"{name} has {column.ndim} dimensions: it must have one", key="gap.file")
    return column


def _sampled(
    h: Callable[[NDArray[np.float64]], ArrayLike], radius: float, tolerance: float
) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Samples of a function out to ``radius``: as many as give it back between them."""
    if not (np.isfinite(radius) and radius > 0.0):
        raise PresetError(f"r = {radius!r} is out of range: a function is known to a radius above 0", key="gap.file")
    if not 0.0 < tolerance < 1.0:
        raise PresetError(f"tolerance = {tolerance!r} is out of range: it must be above 0 and below 1")

    def of(radii: NDArray[np.float64]) -> NDArray[np.float64]:
        gaps = np.asarray(h(radii), dtype=float)
        if gaps.shape != radii.shape:
            raise PresetError(f"h returned the shape {gaps.shape} for radii of the shape {radii.shape}", key="gap.file")
        wrong = np.flatnonzero(~np.isfinite(gaps))
        if wrong.size:
            raise PresetError(f"h({radii[wrong[0]]!r}) is {gaps[wrong[0]]!r}, no number", key="gap.file")
        return gaps

    count, most = _SAMPLES
    while True:
        radii = np.linspace(0.0, radius, count)
        gaps = of(radii)
        # Two radii between each pair, the second where no finer grid has one: what waves at a grid's own rate is seen too.
        share = np.array([0.5, 0.381966])
        between = (radii[:-1, None] + share * np.diff(radii)[:, None]).reshape(-1)
        truth = of(between) - gaps[0]
        missed = np.abs(np.asarray(_engine.between(radii, gaps, between)) - truth)
        allowed = tolerance * float(np.ptp(gaps))
        if missed.max() <= allowed:
            return radii, gaps
        if count >= most:
            at = int(missed.argmax())
            raise NotCertified(
                f"the gap is not resolved: a smooth curve through {count} samples misses it by {missed[at]:.3g} at "
                f"r = {between[at]:.6g}, more than {allowed:.3g}; a corner or a finer wave needs a formula, or arrays",
                radius=float(between[at]),
                difference=float(missed[at]),
            )
        count = min(2 * count - 1, most)
