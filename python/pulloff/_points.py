"""What is asked of a fit, as the engine takes it: points as the text of a table, ranges, draws."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Tuple, Union

from . import _engine
from ._afm import AfmCurve
from ._arguments import number, path
from ._gap import unmasked
from .errors import DataError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
else:
    from ._numpy import np

Range = Tuple[Optional[float], Optional[float]]


def points_of(data: Any, in_si: bool) -> Tuple[str, bytes]:
    """The name and the text of the table that the engine reads."""
    # What an instrument states, and that columns without a unit are in SI.
    stated = {}
    if isinstance(data, AfmCurve):
        if not in_si:
            raise DataError("the curve is in SI, but the problem is in reduced units: set units = 'SI'")
        stated = dict(data.settings)
    if isinstance(data, Mapping):
        columns = dict(data)
    elif hasattr(data, "columns") and hasattr(data, "__getitem__"):
        columns = {name: data[name] for name in data.columns}
    elif isinstance(data, (str, os.PathLike)):
        name = path("data", data)
        return name, _engine.read_file(name)
    else:
        raise DataError(f"data is of the type {type(data).__name__}: it must be a file, a DataFrame or a dict of columns")
    arrays = {str(name): np.asarray(unmasked(values)) for name, values in columns.items()}
    lengths = {array.size for array in arrays.values() if array.ndim == 1}
    if len(lengths) != 1 or any(array.ndim != 1 for array in arrays.values()):
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise DataError(f"the columns must be one-dimensional and equally long: {shapes or 'there are none'}")
    header = ",".join(_bare(name) for name in arrays)
    remarks = ["# BEGIN METADATA", f"# {json.dumps(stated)}", "# END METADATA"] if in_si else []
    cells = [_cells(array) for array in arrays.values()]
    rows = (",".join(row) for row in zip(*cells))
    return "data", "\n".join([*remarks, header, *rows, ""]).encode(errors="replace")


def _bare(text: str) -> str:
    """A text without what separates cells and lines."""
    return " ".join(text.translate(dict.fromkeys(map(ord, ',;"\t\r\n'), " ")).split())


def _cells(array: NDArray[Any]) -> Sequence[str]:
    """The cells of a column: numbers with every digit, else texts."""
    if array.dtype.kind in "iufb":
        return [repr(x) for x in array.tolist()]
    return [repr(float(x)) if isinstance(x, (int, float, np.number)) else _bare(str(x)) or "-" for x in array.tolist()]


def range_of(name: str, given: Optional[Range]) -> Optional[Tuple[float, float]]:
    if given is None:
        return None
    try:
        lo, hi = given
        lo, hi = (float("-inf") if lo is None else number(name, lo)), (float("inf") if hi is None else number(name, hi))
    except (TypeError, ValueError) as error:
        raise DataError(f"{name} = {given!r}: a range must be (from, to)") from error
    if not lo < hi:
        raise DataError(f"{name} = {given!r} is empty: a range must be (from, to), from below to")
    return lo, hi


def free_part_of(given: Union[Range, str, None]) -> Optional[str]:
    """The rows that are apart, as ``data.free_part`` writes them."""
    if given is None or isinstance(given, str):
        return given
    lo, hi = range_of("free_part", given) or (float("-inf"), float("inf"))
    return "x=" + "..".join("" if np.isinf(end) else repr(end) for end in (lo, hi))


def skip_of(skip: int) -> int:
    if not 0 <= skip <= 1_000_000:
        raise DataError(f"skip = {skip} is out of range: it must be from 0 to 1000000")
    return skip


def draws_of(bootstrap: Optional[int], seed: int) -> Optional[Tuple[int, int]]:
    if bootstrap is None:
        return None
    if not 10 <= bootstrap <= 100_000:
        raise DataError(f"bootstrap = {bootstrap} is out of range: it must be from 10 to 100000")
    if not 0 <= seed < 2**64:
        raise DataError(f"seed = {seed} is out of range: it must be from 0 to 2**64 - 1")
    return bootstrap, seed
