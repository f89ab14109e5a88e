"""Progress of long computations: a bar if tqdm is installed, or a function of the caller."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from typing import Callable, Iterator, Optional, Union

from .errors import ArgumentError

Progress = Union[None, bool, Callable[[float], object]]
"""``None``: a bar if tqdm is installed and the work takes longer than a second; ``True`` and ``False``: a bar always or never;
a function is called with the fraction done, 0 to 1, a few times a second, and stops the computation by raising an exception."""

# What takes less shows no bar.
_PATIENCE = 1.0


@contextmanager
def told(progress: Progress, what: str) -> Iterator[Optional[Callable[[float], object]]]:
    """The function to which the engine reports its progress."""
    if callable(progress):
        yield progress
        return
    if not (progress is None or isinstance(progress, bool)):
        raise ArgumentError(f"progress = {progress!r}: it must be True, False, None or a function")
    if progress is False:
        yield None
        return
    try:
        # It warns of widgets that are not installed, and then does without.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from tqdm.auto import tqdm
    except ImportError:
        if progress:
            raise ImportError("progress=True needs tqdm: pip install tqdm, or give a function") from None
        yield None
        return
    form = "{desc} {percentage:3.0f} %|{bar}| {elapsed}"
    with tqdm(
        total=1.0, desc=what, leave=False, bar_format=form, delay=0.0 if progress else _PATIENCE
    ) as bar:

        def tell(share: float) -> None:
            bar.n = max(bar.n, min(share, 1.0))
            bar.refresh() if progress else bar.update(0.0)

        yield tell
