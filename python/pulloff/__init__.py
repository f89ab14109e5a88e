"""Adhesive contact of wavy and rough spheres: equilibrium curves, limit points, snaps, pull-off and losses.

>>> import pulloff
>>> problem = pulloff.Problem("fig-9", {"gap.amplitude": 3e-3})
>>> curve = problem.trace()
>>> curve.force.shape == curve.approach.shape
True
>>> problem.unload(control="force").kind[-1]
'last-contact'

Numbers are in the units of the problem: SI, or any consistent units if a problem is in reduced units. Long work lets
other threads run, shows a bar if tqdm is installed, and stops on Ctrl-C.
"""

from __future__ import annotations

import os
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from . import _engine
from ._afm import AfmCurve, read_afm
from ._arguments import checked, items, path, whole
from ._problem import PresetText, Problem
from ._progress import Progress, told
from ._table import Table
from ._toml import written
from .errors import (
    ArgumentError,
    Cancelled,
    ComputationError,
    DataError,
    Error,
    FitError,
    GapError,
    InternalError,
    Interrupted,
    MapError,
    NoPath,
    NoState,
    NotCertified,
    NotConverged,
    NotDetermined,
    OutputError,
    PresetError,
    PullError,
    SpecError,
    StartError,
    UnstableStart,
)
from .results import Fit, Map, Path, Pull, Speeds, Stability, Sweep, Together, Trace

__version__ = _engine.__version__

__all__ = [
    "AfmCurve",
    "ArgumentError",
    "Cancelled",
    "ComputationError",
    "DataError",
    "Error",
    "Fit",
    "FitError",
    "GapError",
    "InternalError",
    "Interrupted",
    "Map",
    "MapError",
    "NoPath",
    "NoState",
    "NotCertified",
    "NotConverged",
    "NotDetermined",
    "OutputError",
    "Path",
    "PresetError",
    "PullError",
    "PresetText",
    "Problem",
    "Quantity",
    "SpecError",
    "Pull",
    "Speeds",
    "Stability",
    "StartError",
    "Sweep",
    "Table",
    "Together",
    "Trace",
    "UnstableStart",
    "fit_together",
    "presets",
    "quantities",
    "read_afm",
    "merge",
    "sweep",
]


def presets() -> Dict[str, str]:
    """The presets that come with the package: name to title."""
    return _engine.presets()


class Quantity(NamedTuple):
    """What a sweep can compute for a problem."""

    name: str
    unit: str
    """The unit for SI problems."""
    meaning: str
    of_control: bool
    """Whether ``NAME_displacement`` and ``NAME_force`` are quantities too."""


def quantities() -> List[Quantity]:
    """What a sweep can compute."""
    return [Quantity(*row) for row in _engine.quantities()]


@checked
def fit_together(
    problems: Sequence[Problem],
    free: Union[str, Sequence[str], None] = None,
    *,
    robust: bool = True,
    scan: bool = True,
    progress: Progress = None,
) -> Together:
    """One law for several measured curves: the free values of material, gap, edge and path are common to all.

    Parameters
    ----------
    problems : sequence of Problem
        Two or more, each with its own measured curve in ``data.file`` and, if the edge has a speed, its own ``path.rate`` unless
        the times of the curve give it. The values of ``data.*`` are separate for each.
    free : sequence of str, optional
        The keys to fit; by default those of the first problem's ``data.free``.
    robust : bool
        Whether points far away count linearly, not squared.
    scan : bool
        Whether starts other than the problems' own values are tried.

    Raises
    ------
    NotDetermined
        The curves together do not determine the values; the sentence says which, and ``result`` is the fit.
    FitError, DataError
        The fit gives no result; the points, or what is asked of them, are refused.
    """
    problems = items("problems", problems, "a sequence of Problem")
    if not all(isinstance(problem, Problem) for problem in problems):
        raise ArgumentError("problems must be a sequence of Problem")
    natives = [problem._native for problem in problems]
    with told(progress, "fit") as tell:
        document, native, direction = _engine.fitted_together(natives, free, robust, scan, tell)
    first = problems[0]
    result = Together(document, first._of(native, first._source, first._base))
    if direction is not None:
        raise NotDetermined(direction, result=result)
    return result


@checked
def sweep(
    spec: Union[str, "os.PathLike[str]", Mapping[str, Any]],
    *,
    jobs: Optional[int] = None,
    out: Union[str, "os.PathLike[str]", None] = None,
    shard: Union[str, Tuple[int, int], None] = None,
    resume: bool = True,
    overwrite: bool = False,
    row_limit: Optional[float] = None,
    progress: Progress = None,
) -> Sweep:
    """Computes many problems on all cores.

    Parameters
    ----------
    spec : dict, path or str
        What the program's ``sweep`` takes: a dict with the keys of the TOML, whose ``preset`` may be a
        :class:`Problem`; a file; or its text, if it has more than one line.
    jobs : int, optional
        Threads, 1 to 1024; by default as many as there are cores.
    out : path, optional
        A file for the rows, the same that the program's ``sweep`` writes, with a file beside it that describes the sweep: the
        program can continue it, check it, join its shards and plot it.
    shard : (i, n) or "i/n", optional
        Only part i of n, i from 1 to n.
    resume : bool
        Whether to continue with the rows that ``out`` already has of this sweep; if not, an existing file is refused.
    overwrite : bool
        Whether an existing file is replaced.
    row_limit : float, optional
        A row is given up after this many seconds; its error says so.

    Returns
    -------
    Sweep
        Columns ``row``, the keys of the axes, the quantities and ``error``, each of the shape (rows,). A row that cannot be
        computed has NaN and its error; the others are computed all the same. An ensemble has a row for each point, with
        ``NAME.mean``, ``NAME.q50`` and the other statistics of every quantity; ``of_members`` has the members. A part of an
        ensemble has only members.

    Raises
    ------
    SpecError
        The spec is refused.
    OutputError
        ``out`` belongs to another sweep, or cannot be written.
    Interrupted
        Ctrl-C, a ``KeyboardInterrupt``; ``result`` is the :class:`Sweep` of the rows that are done, the
        first ones without a gap.
    """
    folder, problem = os.curdir, None
    if isinstance(spec, Mapping):
        given = dict(spec)
        if isinstance(given.get("preset"), Problem):
            problem = given["preset"]._native
            given["preset"] = "problem"
        text = written(given)
    elif isinstance(spec, str) and "\n" in spec:
        text = spec
    else:
        spec = path("spec", spec)
        folder = os.path.dirname(spec) or os.curdir
        try:
            text = _engine.read_file(spec).decode()
        except (DataError, UnicodeDecodeError) as error:
            where = "" if isinstance(error, DataError) else f"{os.fspath(spec)}: "
            raise SpecError(f"{where}{error}") from error
    if jobs is None:
        jobs = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not 1 <= jobs <= 1024:
        raise SpecError(f"jobs = {jobs} is out of range: it must be from 1 to 1024")
    if row_limit is not None and not 0.0 < row_limit < float("inf"):
        raise SpecError(f"row_limit = {row_limit!r} is out of range: it must be a time in seconds above 0")
    wanted = {
        "jobs": jobs,
        "shard": "/".join(str(whole("shard", n)) for n in items("shard", shard, "(i, n) or 'i/n'"))
        if not (shard is None or isinstance(shard, str))
        else shard,
        "row_limit": row_limit,
        "out": out,
        "resume": resume,
        "overwrite": overwrite,
    }
    with told(progress, "sweep") as tell:
        rows, statistics, interrupt = _engine.sweep(text, folder, problem, wanted, tell)
    swept = Sweep(rows[0], tuple(rows[1]))
    if statistics is not None:
        swept = Sweep(statistics[0], tuple(statistics[1]), of_members=swept)
    if interrupt is not None:
        kept = "" if out is None else f"; {os.fspath(out)} has them, and the same call continues from there"
        raise Interrupted(f"stopped with {swept.row_count} rows{kept}", result=swept) from interrupt
    return swept


@checked
def merge(
    parts: Iterable[Union[str, "os.PathLike[str]"]],
    out: Union[str, "os.PathLike[str]"],
    *,
    overwrite: bool = False,
) -> None:
    """Joins the parts of a sweep, each made with ``shard=(i, n)``, in any order: the result has the same bytes as a single run.

    ``sweep(spec, out=out)`` reads the whole, and computes nothing again.

    Raises
    ------
    OutputError
        A part is missing, duplicated, unfinished or from another sweep; ``out`` exists and ``overwrite`` is not set.
    """
    files = [path(f"parts[{at}]", part) for at, part in enumerate(items("parts", parts, "a list of files"))]
    for part in files:
        if os.path.exists(out) and os.path.exists(part) and os.path.samefile(part, out):
            raise OutputError(f"{os.fspath(out)} is also read, as a part: write to another file")
    _engine.merge(files, out, overwrite)
