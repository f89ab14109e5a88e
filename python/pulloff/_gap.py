"""A gap of your own: arrays, or a function sampled until a smooth curve reproduces it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Tuple

from . import _engine
from .errors import NotCertified, PresetError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray
else:
    from ._numpy import np

# A function is sampled at so many radii at first and at most: as many as the engine takes as knots.
_SAMPLES = (65, 3841)


def plain(values: ArrayLike) -> NDArray[np.float64]:
    """An array as the engine takes it: a field of a record, or what came from another process, may be misaligned. Masked
    values become NaN."""
    if np.iscomplexobj(values):
        raise PresetError("complex numbers have no place here: give real ones")
    try:
        return np.require(unmasked(values), np.float64, ["C", "A"])
    except (TypeError, ValueError) as error:
        raise PresetError(f"{str(values)[:60]!r} is not an array of numbers") from error


def unmasked(values: Any) -> Any:
    """Numbers with NaN in place of what a mask hides; everything else as it is."""
    if isinstance(values, np.ma.MaskedArray) and values.dtype.kind in "iuf":
        return values.astype(float).filled(np.nan)
    return values


def column(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A column of a profile."""
    column = plain(values)
    if column.ndim != 1:
        raise PresetError(f"{name} has {column.ndim} dimensions: it must have one", key="gap.file")
    return column


def sampled(
    h: Callable[[NDArray[np.float64]], ArrayLike], radius: float, tolerance: float
) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Samples of a function out to ``radius``: enough of them to reproduce it in between."""
    if not (np.isfinite(radius) and radius > 0.0):
        raise PresetError(f"r = {radius!r} is out of range: the largest radius of a function must be above 0", key="gap.file")
    if not 0.0 < tolerance < 1.0:
        raise PresetError(f"tolerance = {tolerance!r} is out of range: it must be above 0 and below 1")

    def of(radii: NDArray[np.float64]) -> NDArray[np.float64]:
        # A copy: the function may write into it.
        gaps = plain(h(radii.copy()))
        if gaps.shape != radii.shape:
            raise PresetError(f"h returned the shape {gaps.shape} for radii of the shape {radii.shape}", key="gap.file")
        wrong = np.flatnonzero(~np.isfinite(gaps))
        if wrong.size:
            raise PresetError(f"h({radii[wrong[0]]!r}) is {gaps[wrong[0]]!r}, not a number", key="gap.file")
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
                f"r = {between[at]:.6g}, more than {allowed:.3g}; corners and finer waves need a formula or arrays",
                radius=float(between[at]),
                difference=float(missed[at]),
            )
        count = min(2 * count - 1, most)
