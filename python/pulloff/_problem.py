"""A problem, and all that is computed from it."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Literal, Mapping, Optional, Sequence, Tuple, Union

from . import _engine
from ._arguments import checked, mapping, number, whole
from ._gap import column, plain, sampled
from ._points import Range, draws_of, free_part_of, points_of, range_of, skip_of
from ._progress import Progress, told
from .errors import ArgumentError, ComputationError, DataError, MapError, NotConverged, NotDetermined, OutputError, PresetError, PullError
from .results import Fit, Map, Path, Pull, Speeds, Stability, Trace

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray
else:
    from ._numpy import np

Value = Union[float, int, str]
Control = Union[str, float]
Axis = Union[Tuple[str, float, float], Tuple[str, float, float, str]]

class PresetText(str):
    """The text of a preset, with the contents of the files that it names: :class:`Problem` takes it without those files."""

    _held: Tuple[Any, Any] = (None, None)

    @classmethod
    def _of(cls, native: _engine.Problem) -> "PresetText":
        text, *held = native.state()
        made = cls(text)
        made._held = (held[0], held[1])
        return made

    @property
    def files(self) -> Dict[str, bytes]:
        """The files by the names that the text has for them, to be written beside it, without those that come with the
        package."""
        rows, points = self._held
        files = {}
        if rows is not None:
            name, _, radii, gaps, unit, _ = rows
            unit = f" [{unit}]" if unit and 'units = "SI"' in self else ""
            lines = (f"{r!r},{h!r}" for r, h in zip(radii.tolist(), gaps.tolist()))
            files[name] = "\n".join([f"r{unit},h{unit}", *lines, ""]).encode()
        if points is not None:
            files[points[0]] = points[2]
        return {name: content for name, content in files.items() if not name.startswith("shipped:")}


class Problem:
    """One problem of adhesive contact: two bodies, their gap, a loading device, a start. It never changes, so it can be a key of a
    dict; it can be pickled, and two are equal if all their values and data are.

    Parameters
    ----------
    source : str or path
        The name of a preset that comes with the package (see :func:`pulloff.presets`); a file: a path object, or a string
        with a ``/`` or ending in ``.toml``; or the text of a preset, more than one line, as :meth:`to_toml` gives it.
    changes : dict, optional
        Changed values by their keys, as ``{"gap.amplitude": 3e-3}``. A number is in SI or in reduced units, like all that a
        problem gives back. A string is read as the program's ``--set`` reads it: with its unit, as in
        ``{"gap.amplitude": "2 um"}``, and without one in the parameter's own unit, if it has one.

    Raises
    ------
    PresetError
        The source or a value is refused; ``key`` and ``line`` say which.
    """

    __slots__ = ("_base", "_native", "_source")
    _native: _engine.Problem
    _source: str
    """As ``repr`` shows it."""
    _base: Union[_engine.Problem, Dict[str, Value]]
    """The source itself, or its values."""

    def __init__(
        self, source: Union[str, "os.PathLike[str]"], changes: Optional[Mapping[str, Value]] = None
    ) -> None:
        said = "a text"
        if not isinstance(source, (str, os.PathLike)) or not isinstance(os.fspath(source), str):
            kind = type(source).__name__
            raise ArgumentError(f"source is of the type {kind}: it must be a name, a path, or the text of a preset")
        if not isinstance(source, str):
            native, said = _engine.Problem.of_file(os.fspath(source)), repr(os.fspath(source))
        elif isinstance(source, PresetText):
            native = _of_state(str(source), *source._held)
        elif "\n" in source:
            native = _engine.Problem.of_text(source)
        elif "/" in source or source.endswith(".toml"):
            native, said = _engine.Problem.of_file(source), repr(source)
        else:
            native, said = _engine.Problem.shipped(source), repr(str(source))
        self._base, self._source = native, said
        changes = {} if changes is None else mapping("changes", changes)
        self._native = native.replace(changes) if changes else native

    @classmethod
    def _of(
        cls, native: _engine.Problem, source: str, base: Union[_engine.Problem, Dict[str, Value], None] = None
    ) -> "Problem":
        problem = cls.__new__(cls)
        problem._native, problem._source, problem._base = native, source, native if base is None else base
        return problem

    @classmethod
    def _restored(cls, state: Tuple[Any, ...], source: str, base: Optional[Dict[str, Value]]) -> "Problem":
        return cls._of(_of_state(*state), source, base)

    def __reduce__(self) -> Tuple[Any, ...]:
        base = None if self._base is self._native else self._base_values()
        return type(self)._restored, (self._native.state(), self._source, base)

    def _base_values(self) -> Dict[str, Value]:
        return self._base if isinstance(self._base, dict) else self._base.values()

    def _changed(self) -> Dict[str, Value]:
        """The values that differ from those of the source."""
        if self._base is self._native:
            return {}
        before = self._base_values()
        return {key: value for key, value in self._native.values().items() if before.get(key) != value}

    @classmethod
    @checked
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
        """A problem with a gap of your own.

        Parameters
        ----------
        r : array, shape (n,), or float
            Radii from the axis, ascending, a length. With a function ``h``: the largest radius at which it is known.
        h : array, shape (n,), or function
            The gap between the undeformed bodies, a length. A function is called with an array of radii and returns as
            many gaps. It is sampled once, on a grid that is refined until a smooth curve through the samples reproduces the
            function between them; if that fails, the function is refused.
        effective_modulus, work_of_adhesion : float
            E* (Pa in SI) and γ (J/m² in SI).
        start_contact_radius : float
            The contact radius at the start.
        units : {"reduced", "SI"}
            ``"SI"``: every number is in SI units. ``"reduced"``: in any consistent units.
        tolerance : float
            How far the curve may miss the function between samples, as a share of the range of its values.
        changes : dict, optional
            As for :class:`Problem`.

        Raises
        ------
        NotCertified
            The samples do not resolve the function.
        PresetError
            The rows or a value are refused.
        """
        if callable(h):
            radii, gaps = sampled(h, number("r", r), tolerance)
        else:
            radii, gaps = column("r", r), column("h", h)
            if radii.shape != gaps.shape:
                raise PresetError(f"r has {radii.size} values and h has {gaps.size}: the numbers must be equal", key="gap.file")
        text = "\n".join(
            [
                f"units = {json.dumps(units)}",
                "[material]",
                f"effective_modulus = {effective_modulus!r}",
                f"work_of_adhesion = {work_of_adhesion!r}",
                "[gap]",
                'shape = "profile"',
                'file = "arrays"',
                "[path]",
                f"start_contact_radius = {start_contact_radius!r}",
            ]
        )
        native = _engine.Problem.of_rows(text, radii, gaps, units == "SI")
        return cls._of(native.replace(changes) if changes else native, "from_gap", native)

    @checked
    def replace(self, changes: Optional[Mapping[str, Value]] = None, **more: Value) -> "Problem":
        """The same problem with changed values, checked as a whole."""
        return self._of(self._native.replace({**(changes or {}), **mapping("changes", more)}), self._source, self._base)

    @property
    def title(self) -> str:
        """One line that says what the problem shows."""
        return self._native.title

    def to_dict(self) -> Dict[str, Value]:
        """Every key with its value, in SI or in reduced units."""
        return self._native.values()

    def to_toml(self) -> PresetText:
        """The text of a preset. It can be read back, ``Problem(problem.to_toml()) == problem``: arrays and measured curves
        travel with the text; :meth:`save` writes both to disk."""
        return PresetText._of(self._native)

    @checked
    def save(self, path: Union[str, "os.PathLike[str]"], *, overwrite: bool = False) -> None:
        """Writes the preset to a file, and beside it the gap and the measured curve that it needs: ``NAME.gap.csv`` and
        ``NAME.data.csv`` beside ``NAME.toml``. The program and :class:`Problem` can open it.

        Raises
        ------
        OutputError
            One of them exists and must not be overwritten, or cannot be written; then nothing is replaced.
        """
        if os.path.isdir(path):
            raise OutputError(f"{path} is a folder: path must name a file")
        stem = os.path.basename(path)
        stem = stem[: -len(".toml")] if stem.endswith(".toml") else stem
        native = self._native.named(f"{stem}.gap.csv", f"{stem}.data.csv")
        text = PresetText._of(native)
        folder = os.path.dirname(path)
        files = {os.path.join(folder, name): content for name, content in text.files.items()}
        _engine.write_files({**files, path: text.encode()}, overwrite)

    def __getitem__(self, key: str) -> Value:
        values = self._native.values()
        if key not in values:
            raise KeyError(f"{key!r} is not a key of this problem; there are {', '.join(values)}")
        return values[key]

    def __contains__(self, key: object) -> bool:
        return key in self._native.values()

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def keys(self) -> List[str]:
        """The keys of all values: ``dict(problem)`` is ``problem.to_dict()``."""
        return list(self._native.values())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Problem) and self._native.same(other._native)

    def __hash__(self) -> int:
        return hash(self._native.digest())

    def __repr__(self) -> str:
        changed = f", {changes!r}" if (changes := self._changed()) else ""
        if self._source.startswith(("'", '"')):
            return f"pulloff.Problem({self._source}{changed})"
        title = f": {self.title}" if self.title else ""
        return f"<pulloff.Problem of {self._source}{changed}{title}>"

    @checked
    def trace(self, *, theory: bool = False, progress: Progress = None) -> Trace:
        """The equilibrium curve from the start inward, by arc length.

        Parameters
        ----------
        theory : bool
            Whether to add the exact solution at the same contact radii, as ``exact_force`` and so on.

        Raises
        ------
        ComputationError
            The curve cannot be computed; :class:`StartError` if there is no equilibrium at the start.
        """
        with told(progress, "trace") as tell:
            return Trace(self._native.trace(theory, tell))

    @checked
    def unload(
        self,
        control: Optional[Control] = None,
        *,
        one_disc: bool = False,
        areas: bool = True,
        admissibility: bool = True,
        progress: Progress = None,
    ) -> Path:
        """The quasi-static unloading from the start until the bodies are apart, and what each event dissipates.

        Parameters
        ----------
        control : {"displacement", "force"} or float, optional
            What the loading device prescribes; a number is the stiffness of a spring, a force per length.
        one_disc : bool
            Whether only one disc of contact is followed, as with ``path.contact = "one-disc"``.
        areas, admissibility : bool
            Whether losses are computed in a second way, and whether states are found in which one disc alone would let the
            bodies overlap. Each takes longer than all the rest; without both it costs as much as a row of a sweep.
        """
        problem = _following(self._under(control), one_disc)
        with told(progress, "unload") as tell:
            return Path(problem.unload(areas, admissibility, tell))

    @checked
    def cycle(
        self,
        control: Optional[Control] = None,
        *,
        to_approach: Optional[float] = None,
        to_force: Optional[float] = None,
        to_radius: Optional[float] = None,
        to_control: Optional[float] = None,
        one_disc: bool = False,
        areas: bool = True,
        progress: Progress = None,
    ) -> Path:
        """The whole loop: from apart to the first touch, up to a turn and back until apart again, with rings of contact.

        Parameters
        ----------
        control : {"displacement", "force"} or float, optional
            As for :meth:`unload`.
        to_approach, to_force, to_radius : float, optional
            The loop turns round at the first stable state with at least this value; at most one of them or ``to_control``.
        to_control : float, optional
            The loop turns round at this value of what is controlled: an approach, a force, or the position of
            the spring's other end.
        one_disc, areas : bool
            As for :meth:`unload`.
        """
        turns = {
            "path.turn_approach": to_approach,
            "path.turn_force": to_force,
            "path.turn_contact_radius": to_radius,
        }
        given = {key: value for key, value in turns.items() if value is not None}
        named = [*given, *([] if to_control is None else ["to_control"])]
        if len(named) > 1:
            raise PresetError(f"a loop turns round once: give only one of {' and '.join(named)}", key=named[1])
        if to_control is not None and not abs(to_control) < float("inf"):
            raise PresetError(f"to_control = {to_control!r} is not a number at which a loop could turn round")
        problem = self._under(control)
        if given:
            problem = problem.replace(given)
        problem = _following(problem, one_disc)
        with told(progress, "cycle") as tell:
            return Path(problem.cycle(to_control, areas, tell))

    @checked
    def pull(
        self,
        rate: Union[float, Sequence[float], None] = None,
        *,
        control: Optional[Control] = None,
        hold_force: Union[float, Sequence[float]] = (),
        progress: Progress = None,
    ) -> Pull:
        """Pulls on one disc whose edge has a speed; ``edge.exponent`` must be set.

        Parameters
        ----------
        rate : float or sequence of float, optional
            The rate of what is controlled, above 0, in SI or reduced units: a speed, or a force per time. Without it,
            ``path.steps`` or ``path.rate`` of the problem says what is done.
        control : {"displacement", "force"} or float, optional
            As for :meth:`unload`.
        hold_force : float or sequence of float
            Dead loads, negative for a pull; ``failures`` of the result says how long each holds.
        """
        rates, loads = list(rate or ()), list(hold_force)  # type: ignore[arg-type]
        for value in rates:
            if not 0 < value < float("inf"):
                raise PullError(f"rate = {value} is out of range: it must be above 0")
        for value in loads:
            if not np.isfinite(value):
                raise PullError(f"hold_force = {value} is not a number")
        problem = self._under(control)
        with told(progress, "pull") as tell:
            return Pull(problem.pull(rates, loads, tell))

    @checked
    def stability(
        self, control: Optional[Control] = None, *, samples: int = 1501, progress: Progress = None
    ) -> Stability:
        """The law of stability: the work of adhesion at which each state is a limit point, over the contact radius.

        Parameters
        ----------
        control : {"displacement", "force"} or float, optional
            As for :meth:`unload`.
        samples : int
            The number of equally spaced radii from the end of the path to its start, 2 to 1000000; cusps and corners are added.
        """
        if not 2 <= samples <= 1_000_000:
            raise ComputationError(f"samples = {samples} is out of range: it must be from 2 to 1000000")
        problem = self._under(control)
        with told(progress, "stability") as tell:
            return Stability(problem.stability(samples, tell))

    @checked
    def map(
        self,
        x: Axis,
        y: Union[Axis, str] = "control",
        *,
        control: Optional[Control] = None,
        cells: Tuple[int, int] = (48, 36),
        progress: Progress = None,
    ) -> Map:
        """Where snaps begin, as lines in two numbers; or the limit points over one number.

        Parameters
        ----------
        x : (key, from, to) or (key, from, to, "log")
            A key of the problem, a group such as ``"groups.adhesion"``, or ``"compliance"``: 1/k from 0 (displacement) to
            ``math.inf`` (a dead load).
        y : the same, or {"control", "approach", "force"}
            Another number; or what to give of the limit points over x.
        control : {"displacement", "force"} or float, optional
            As for :meth:`unload`.
        cells : (columns, rows)
            The snaps are counted at the corners of this many cells, if both axes are numbers.
        """
        if isinstance(y, str) and y not in ("control", "approach", "force"):
            raise MapError(f"y = {y!r} is not known: it must be 'control', 'approach', 'force', or (key, from, to)")
        try:
            columns, rows = cells
        except (TypeError, ValueError) as error:
            raise ArgumentError(f"cells = {cells!r}: it must be (columns, rows)") from error
        columns, rows = whole("cells[0]", columns), whole("cells[1]", rows)
        if not (1 <= columns <= 1000 and 1 <= rows <= 1000):
            raise MapError(f"cells = {cells!r} is out of range: columns and rows must be from 1 to 1000")
        problem = self._under(control)
        ordinate, other = (y, None) if isinstance(y, str) else ("control", _axis(y))
        with told(progress, "map") as tell:
            return Map(problem.map(_axis(x), other, ordinate, columns, rows, tell))

    @checked
    def fit(
        self,
        data: Union[str, "os.PathLike[str]", Mapping[str, ArrayLike], Any, None] = None,
        free: Union[str, Sequence[str], None] = None,
        *,
        uncertain: Optional[Mapping[str, Union[float, str]]] = None,
        columns: Optional[str] = None,
        segment: Optional[str] = None,
        free_part: Union[Range, str, None] = None,
        signs: Optional[str] = None,
        skip: int = 0,
        x_range: Optional[Range] = None,
        force_range: Optional[Range] = None,
        model: Union[str, Sequence[str], None] = None,
        robust: bool = True,
        sigma_x: Optional[float] = None,
        sigma_force: Optional[float] = None,
        scan: bool = True,
        profile: bool = False,
        bootstrap: Optional[int] = None,
        seed: int = 1,
        poisson: Optional[float] = None,
        progress: Progress = None,
    ) -> Fit:
        """Fits the values of some keys to a measured curve, with their standard errors.

        Parameters
        ----------
        data : path, DataFrame or mapping of arrays, shape (points,), optional
            A file that the program's ``fit`` reads; or columns by their names, ``"force"`` with ``"approach"``,
            ``"position"`` (of the other end of a spring) or ``"contact radius"``, and ``"segment"`` if it is known; in the unit
            given in the name, as in ``"force [nN]"``, otherwise in SI or, if the problem is in reduced units, in those.
            Or what :func:`pulloff.read_afm` returns. By default the measured curve of the problem itself, ``data.file``.
        free : sequence of str, optional
            The keys to fit, and ``data.offset``, ``data.baseline``, ``data.tilt`` of the instrument; by default those of the
            problem's ``data.free``.
        uncertain : mapping, optional
            Values that are known with an error, as ``{"path.control.stiffness": "10 %", "gap.radius_of_curvature": 1e-6}``: they
            change as far as their standard deviations allow, which then count in the errors of the others; by default those of
            the problem's ``data.uncertain``.
        columns : str, optional
            What the columns are, if their names do not say it, as ``"x=1,force=2"`` or ``"position=Z,force=F"``.
        segment : {"approach", "retraction"}, optional
            The only branch that is used.
        free_part : (from, to) or "none", optional
            Which rows are apart, by x as it is in the data, in SI or reduced units; None leaves an end open. ``"none"`` if all
            rows are in contact; found automatically if not given.
        signs : str, optional
            Which way the columns run: ``"x=-,force=+"`` flips only the sign of x; found automatically if not given.
        skip : int
            The number of rows left out at the beginning.
        x_range, force_range : (from, to), optional
            Only rows in this range are used, with values as they are in the data; None leaves an end open.
        model : {"short-range", "dugdale", "rate"} or a sequence of them, optional
            How the adhesion acts: only at the edge of the contact; within a range, whose ``material.cohesive_strength`` is then
            free too; or growing with the speed of the edge, with the keys of ``edge`` free. By default ``material.adhesion`` of
            the problem. With several models the best fit is returned, and :attr:`Fit.models` says how the others compare.
        robust : bool
            Whether points far away count linearly instead of squared.
        sigma_x, sigma_force : float, optional
            Standard deviations; estimated if not given.
        scan : bool
            Whether starts other than the problem's own values are tried.
        profile : bool
            Whether 95 % intervals are computed from the profile of χ²; ``to_dict()`` has them.
        bootstrap, seed : int, optional
            The number of fits to sets of blocks of rows drawn at random, 10 to 100000; by default 200 below 40 degrees of
            freedom, otherwise none.
        poisson : float, optional
            Poisson's ratio of the soft body, -1 to 0.5: gives its E beside E*, as ``youngs_modulus``.

        Raises
        ------
        NotDetermined
            The points do not determine the values; the sentence says which, and ``result`` is the fit.
        NotConverged, FitError
            The fit did not converge, or gives no result.
        DataError
            The points, or what is asked of them, are refused.
        """
        for what, sigma in (("sigma_x", sigma_x), ("sigma_force", sigma_force)):
            if sigma is not None and not 0.0 < sigma < float("inf"):
                raise DataError(f"{what} = {sigma!r} is out of range: a standard deviation must be above 0")
        if poisson is not None and not -1.0 <= poisson <= 0.5:
            raise DataError(f"poisson = {poisson!r} is out of range: Poisson's ratio must be from -1 to 0.5")
        wanted = {
            "columns": columns,
            "segment": segment,
            "free_part": free_part_of(free_part),
            "signs": signs,
            "skip": skip_of(skip),
            "free": free,
            "uncertain": None if uncertain is None else ",".join(f"{key}={error}" for key, error in uncertain.items()),
            "models": model or [],
            "robust": robust,
            "sigma": (sigma_x, sigma_force),
            "x_range": range_of("x_range", x_range),
            "force_range": range_of("force_range", force_range),
            "scan": scan,
            "profile": profile,
            "bootstrap": draws_of(bootstrap, seed),
            "poisson": poisson,
        }
        points = None if data is None else points_of(data, self._native.values().get("units") == "SI")
        with told(progress, "fit") as tell:
            document, problem, ended, direction, residuals, models = _engine.fitted(self._native, points, wanted, tell)
        result = Fit(document, self._of(problem, self._source, self._base), residuals, models)
        if ended != "converged":
            raise NotConverged("the fit did not converge; result has the best values so far", result=result)
        if direction is not None:
            raise NotDetermined(direction, result=result)
        return result

    @checked
    def speeds(
        self,
        data: Union[str, "os.PathLike[str]", Mapping[str, ArrayLike], Any, None] = None,
        *,
        columns: Optional[str] = None,
        segment: Optional[str] = None,
        free_part: Union[Range, str, None] = None,
        signs: Optional[str] = None,
        skip: int = 0,
        of: Optional[Literal["force-radius", "approach-radius", "force-approach"]] = None,
        progress: Progress = None,
    ) -> Speeds:
        """The energy release rate at every measured row in contact, beside the speed of the edge.

        Parameters
        ----------
        data, columns, segment, free_part, signs, skip
            As for :meth:`fit`; the speed needs a column ``"time"``.
        of : {"force-radius", "approach-radius", "force-approach"}, optional
            What G is computed from; by default force and radius, or force and approach for points without contact radii.

        Raises
        ------
        DataError
            The points are refused, or none is in contact.
        """
        reading = (columns, segment, free_part_of(free_part), signs)
        points = None if data is None else points_of(data, self._native.values().get("units") == "SI")
        with told(progress, "speeds") as tell:
            return Speeds(_engine.speeds(self._native, points, reading, skip_of(skip), of, tell))

    @checked
    def pressure(self, s: float, r: ArrayLike) -> NDArray[np.float64]:
        """The contact pressure at the radii ``r`` in equilibrium at the contact radius ``s``, compression positive.

        It has the shape of ``r`` and is a stress: ``-inf`` at the edge, ``r`` equal to ``s`` to rounding, where adhesion makes
        it infinite, and 0 there without adhesion; NaN outside. It comes from the exact solution, whatever the basis of
        the problem.
        """
        return self._across(s, r)[1]

    @checked
    def gap(self, s: float, r: ArrayLike) -> NDArray[np.float64]:
        """The gap between the deformed bodies at the radii ``r`` in equilibrium at the contact radius ``s``.

        It has the shape of ``r`` and is a length: 0 inside the contact, NaN only where the undeformed gap is not known, beyond
        the last row of a profile, and negative where a crest would overlap. It comes from the
        exact solution, whatever the basis of the problem.
        """
        return self._across(s, r)[2]

    def _across(self, s: float, r: ArrayLike) -> Tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        radii = plain(r)
        flat = radii.reshape(-1)
        approach, pressure, gap = self._native.across(s, flat)
        return approach, pressure.reshape(radii.shape), gap.reshape(radii.shape)

    def _under(self, control: Optional[Control]) -> _engine.Problem:
        if control is None:
            return self._native
        given = control if isinstance(control, str) else f"stiffness={control!r}"
        return self._native.replace({"path.control": given})


def _following(problem: _engine.Problem, one_disc: bool) -> _engine.Problem:
    return problem.replace({"path.contact": "one-disc"}) if one_disc else problem


def _of_state(text: str, rows: Any, points: Any) -> _engine.Problem:
    if rows is not None:
        name, folder, radii, gaps, *more = rows
        rows = (name, folder, plain(radii), plain(gaps), *more)
    _engine.arrays_ready()
    return _engine.Problem.of_state(text, rows, points)


def _axis(axis: Axis) -> Tuple[str, float, float, bool]:
    words = "an axis must be (key, from, to) or (key, from, to, 'log')"
    if not isinstance(axis, Sequence) or not 3 <= len(axis) <= 4 or (len(axis) == 4 and axis[3] != "log"):
        raise MapError(f"{axis!r}: {words}")
    key, lo, hi = axis[:3]
    if not isinstance(key, str):
        raise MapError(f"{axis!r}: {words}")
    return key, number(f"the start of {key}", lo), number(f"the end of {key}", hi), len(axis) == 4
