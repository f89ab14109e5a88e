"""Force curves of atomic force microscopes in vendor formats, read by afmformats."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, Mapping, Optional, Union

from .errors import DataError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
else:
    from ._numpy import np

#: The branches by afmformats' numbers in a force-distance curve.
_SEGMENTS = ("approach", "retraction")


class AfmCurve(Dict[str, Any]):
    """A force curve as :meth:`pulloff.Problem.fit` takes it.

    A dict of arrays of shape (points,): ``"force"`` in N, ``"position"`` in m (the travel of the piezo, behind the cantilever) or
    ``"approach"`` in m where the file has only the travel of the tip, and ``"segment"``, ``"approach"`` or ``"retraction"``.

    Attributes
    ----------
    metadata : dict
        What the file states of the measurement, as afmformats has it, in SI.
    settings : dict
        What a fit compares with the problem: ``"spring constant"`` in N/m and ``"tip radius"`` in m, where they are known.
    """

    def __init__(self, *columns: Any, **more: Any) -> None:
        super().__init__(*columns, **more)
        self.metadata: Dict[str, Any] = {}
        self.settings: Dict[str, float] = {}


def read_afm(
    path: Union[str, "os.PathLike[str]"],
    index: Optional[int] = None,
    *,
    metadata: Optional[Mapping[str, Any]] = None,
) -> AfmCurve:
    """A force curve from a file in the format of its instrument: ``.jpk-force``, ``.jpk-force-map``, ``.ibw``, ``.h5`` and others.

    The files are read by afmformats, which is installed separately: ``pip install afmformats``. Text files need no afmformats:
    ``Problem.fit(path)`` reads them.

    Parameters
    ----------
    path : path
        The file; its extension gives the format.
    index : int, optional
        Which curve, from 0; needed where there are several, as in a map.
    metadata : mapping, optional
        What the file lacks or states wrongly, by the keys of afmformats in SI, as ``{"spring constant": 0.04}``; and
        ``"tip radius"`` in m.

    Returns
    -------
    AfmCurve
        For ``Problem.fit``. Its spring constant becomes that of a problem that has none; where the problem has another stiffness
        or another radius of the tip, the fit is refused with both values.

    Raises
    ------
    ImportError
        afmformats is not installed.
    DataError
        The file cannot be read, has no force, or has several curves and no ``index`` is given.

    Examples
    --------
    >>> curve = pulloff.read_afm("curve.jpk-force")  # doctest: +SKIP
    >>> problem.fit(curve, ["E*", "gamma", "data.offset"])  # doctest: +SKIP
    """
    try:
        import afmformats
        import afmformats.errors
    except ImportError as error:
        raise ImportError("read_afm needs the package afmformats: pip install afmformats") from error
    name = os.fspath(path)
    given = dict(metadata or {})
    radius = given.pop("tip radius", None)
    refused = (
        Exception,
        # Those of afmformats are no Exceptions.
        afmformats.errors.AFMFileFormatError,
        afmformats.errors.MissingMetaDataError,
    )
    if not os.path.isfile(name):
        raise DataError(f"{name}: there is no such file")
    try:
        curves = afmformats.load_data(name, meta_override=given, modality="force-distance")
    except refused as error:
        missing = ", ".join(getattr(error, "meta_keys", ()))
        way = f"; give metadata={{...}} with {missing}" if missing else ""
        raise DataError(f"{name}: afmformats cannot read it: {error}{way}") from error
    if not curves:
        raise DataError(f"{name}: it has no force-distance curve")
    if index is None and len(curves) > 1:
        raise DataError(f"{name}: it has {len(curves)} curves: choose one with index=0 to {len(curves) - 1}")
    if index is not None and not 0 <= index < len(curves):
        raise DataError(f"{name}: index = {index} is out of range: it must be from 0 to {len(curves) - 1}")
    try:
        return _curve(name, curves[index or 0], given, radius)
    except refused as error:
        if isinstance(error, DataError):
            raise
        raise DataError(f"{name}: afmformats cannot read it: {error}") from error


def _curve(name: str, of: Any, given: Mapping[str, Any], radius: Optional[float]) -> AfmCurve:
    """The columns of a dataset of afmformats, in SI."""
    metadata = {key: value for key, value in of.metadata.items() if not callable(value)}
    metadata.update(given)
    columns = set(of.columns)
    if "force" not in columns:
        there = ", ".join(sorted(columns))
        raise DataError(f"{name}: it has no force, only {there}: calibrate it with metadata={{\"spring constant\": ...}}")
    # What Optics11's files call height (measured) here is the indentation, with its sign turned.
    is_chiaro = "Chiaro" in str(metadata.get("format", ""))
    ways = [("height (measured)", "position"), ("height (piezo)", "position"), ("tip position", "approach")]
    way = next(((column, role) for column, role in ways if column in columns and not (is_chiaro and column == ways[0][0])), None)
    if way is None:
        raise DataError(f"{name}: it has no height, only {', '.join(sorted(columns))}")
    curve = AfmCurve()
    curve["force"] = np.array(of["force"], dtype=float)
    curve[way[1]] = np.array(of[way[0]], dtype=float)
    if "segment" in columns:
        segments = np.asarray(of["segment"]).astype(int)
        unknown = sorted(set(segments.tolist()) - {0, 1})
        if unknown:
            raise DataError(f"{name}: the segments {unknown} are neither approach nor retraction")
        curve["segment"] = np.array(_SEGMENTS)[segments]
    known = {"spring constant": metadata.get("spring constant"), "tip radius": radius}
    settings = {key: float(value) for key, value in known.items() if value is not None}
    for key, value in settings.items():
        if not 0.0 < value < float("inf"):
            raise DataError(f"{name}: {key} = {value!r} is out of range: it must be above 0")
    curve.metadata, curve.settings = metadata, settings
    return curve
