"""Adhesive contact of wavy and rough spheres: equilibrium curves, limit points, snaps, pull-off and losses.

>>> import pulloff
>>> problem = pulloff.Problem("fig-9", {"gap.amplitude": 3e-3})
>>> curve = problem.trace()
>>> curve.force.shape == curve.approach.shape
True
>>> problem.unload(control="force").kind[-1]
'pull-off'

Numbers are in the units of the problem: SI, or any consistent units where a problem is in reduced units. Long work lets
other threads run, shows a bar where tqdm is installed, and ends on Ctrl-C.
"""

from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Union

from . import _engine
from ._problem import Problem
from ._progress import Progress, told
from ._toml import written
from .errors import (
    Cancelled,
    ComputationError,
    DataError,
    Error,
    FitError,
    GapError,
    InternalError,
    MapError,
    NoLoop,
    NoState,
    NotCertified,
    NotConverged,
    NotDetermined,
    PresetError,
    SpecError,
    StartError,
    UnstableStart,
)
from .results import Cycle, Fit, Map, Stability, Sweep, Table, Trace, Unloading

__version__ = _engine.__version__

__all__ = [
    "Cancelled",
    "ComputationError",
    "Cycle",
    "DataError",
    "Error",
    "Fit",
    "FitError",
    "GapError",
    "InternalError",
    "Map",
    "MapError",
    "NoLoop",
    "NoState",
    "NotCertified",
    "NotConverged",
    "NotDetermined",
    "PresetError",
    "Problem",
    "Quantity",
    "SpecError",
    "Stability",
    "StartError",
    "Sweep",
    "Table",
    "Trace",
    "Unloading",
    "UnstableStart",
    "presets",
    "quantities",
    "sweep",
]


def presets() -> Dict[str, str]:
    """The presets that come with the package: name to title."""
    return _engine.presets()


class Quantity(NamedTuple):
    """What a sweep can compute of a problem."""

    name: str
    unit: str
    """That of SI problems."""
    meaning: str
    of_control: bool
    """Whether ``NAME_displacement`` and ``NAME_force`` are quantities as well."""


def quantities() -> List[Quantity]:
    """What a sweep can compute."""
    return [Quantity(*row) for row in _engine.quantities()]


def sweep(
    spec: Union[str, "os.PathLike[str]", Mapping[str, Any]],
    *,
    jobs: Optional[int] = None,
    progress: Progress = None,
) -> Sweep:
    """Computes many problems on all cores.

    Parameters
    ----------
    spec : dict, path or str
        What the program's ``sweep`` takes: a dict with the keys of the TOML, whose ``preset`` may be a
        :class:`Problem`; a file; or its text, of more than one line.
    jobs : int, optional
        Threads, 1 to 1024; as many as cores where none is given.

    Returns
    -------
    Sweep
        Columns ``row``, the keys of the axes, the quantities and ``error``, each of the shape (rows,). A row that cannot be
        computed has NaN and its error; the others are computed all the same.

    Raises
    ------
    SpecError
        The spec is refused.
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
        folder = os.path.dirname(os.fspath(spec)) or os.curdir
        try:
            with open(spec, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise SpecError(f"{os.fspath(spec)}: {error}") from error
    if jobs is None:
        jobs = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not 1 <= jobs <= 1024:
        raise SpecError(f"jobs = {jobs} is out of range: it must be from 1 to 1024")
    with told(progress, "sweep") as tell:
        columns, axes = _engine.sweep(text, folder, problem, jobs, tell)
    return Sweep(columns, tuple(axes))
