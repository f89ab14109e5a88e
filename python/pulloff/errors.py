"""What can go wrong, each with the engine's own sentence.

Every exception of the package is an :class:`Error`, except :class:`Interrupted`, and can be passed between processes. Refused
values are a ``ValueError`` as well.
"""

from __future__ import annotations

from typing import Any, Dict, Optional, Sequence, Tuple, Type


def _rebuilt(kind: Type[BaseException], sentence: Tuple[Any, ...], attributes: Dict[str, Any]) -> BaseException:
    error = kind.__new__(kind)
    error.args = sentence
    error.__dict__.update(attributes)
    return error


class _Portable(BaseException):
    """An exception that comes out of another process as it went in: otherwise its keyword arguments would be lost, and a pool of
    processes would wait forever for one that cannot be read."""

    def __reduce__(self) -> Tuple[Any, ...]:
        return _rebuilt, (type(self), self.args, self.__dict__)


class Error(_Portable, Exception):
    """Anything that the engine refuses."""


class PresetError(Error, ValueError):
    """A preset or a value is refused.

    Attributes
    ----------
    key : str or None
        The key of the first mistake, such as ``"gap.amplitude"``.
    line : int or None
        Its line, if there is a text; the first line is 1.
    mistakes : sequence of (line, key, sentence)
        All mistakes that were found.
    """

    def __init__(
        self,
        sentence: str = "",
        *,
        key: Optional[str] = None,
        line: Optional[int] = None,
        mistakes: Sequence[Tuple[Optional[int], Optional[str], str]] = (),
    ) -> None:
        super().__init__(sentence)
        self.key = key
        self.line = line
        self.mistakes = tuple(mistakes)


class ArgumentError(Error, TypeError):
    """An argument of a type that the function does not take; the sentence names it."""


class SpecError(Error, ValueError):
    """The spec of a sweep is refused; ``line`` says where, in the text or in the TOML made from a dict."""

    def __init__(self, sentence: str = "", *, line: Optional[int] = None) -> None:
        super().__init__(sentence)
        self.line = line


class OutputError(Error, OSError):
    """Results of a sweep that cannot be begun, continued or written."""


class ComputationError(Error):
    """A valid problem that cannot be computed."""


class GapError(ComputationError):
    """A gap or a basis that cannot be resolved."""


class StartError(ComputationError):
    """There is no equilibrium at the start, or the end lies outside it."""


class UnstableStart(ComputationError):
    """The start is unstable and there is no stable state further out."""


class NoPath(ComputationError):
    """There is no path: no unloading, or no loop of loading and unloading."""


class MapError(ComputationError, ValueError):
    """There is no map over these axes."""


class PullError(ComputationError, ValueError):
    """There is no pull at a rate: no law of the edge, no rate, or an edge that cannot be followed."""


class DataError(Error, ValueError):
    """Measured points, or what is asked of them, are refused."""


class FitError(ComputationError):
    """A fit that gives no result."""


class _Unfinished(FitError):
    def __init__(self, sentence: str = "", *, result: Any = None) -> None:
        super().__init__(sentence)
        self.result = result


class NotDetermined(_Unfinished):
    """The points do not determine the values that were asked for; the sentence says which can only be determined together.

    ``result`` is the fit all the same: its values are one choice among many.
    """


class NotConverged(_Unfinished):
    """A fit that did not converge; ``result`` has the best values so far."""


class NoState(ComputationError, ValueError):
    """There is no equilibrium at the contact radius asked for, or a radius is out of range."""


class NotCertified(Error, ValueError):
    """A function that samples do not resolve: nothing is computed from it.

    Attributes
    ----------
    radius : float
        Where the curve through the samples misses the function most.
    difference : float
        By how much, in the unit of the gap.
    """

    def __init__(self, sentence: str = "", *, radius: float, difference: float) -> None:
        super().__init__(sentence)
        self.radius = radius
        self.difference = difference


class Cancelled(Error):
    """The computation was stopped; Ctrl-C raises ``KeyboardInterrupt`` instead."""


class Interrupted(_Portable, KeyboardInterrupt):
    """A sweep stopped by Ctrl-C, a ``KeyboardInterrupt``; ``result`` is a :class:`pulloff.Sweep` of the rows that are done."""

    def __init__(self, sentence: str = "", *, result: Any = None) -> None:
        super().__init__(sentence)
        self.result = result


class InternalError(Error, RuntimeError):
    """A fault of the engine itself."""
