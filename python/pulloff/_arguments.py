"""The arguments of public functions, checked by their annotations: a wrong one is refused by its name before anything is computed."""

from __future__ import annotations

import os
from functools import wraps
from operator import index
from typing import Any, Callable, Dict, List, Mapping, Optional, TypeVar, Union, cast

from .errors import ArgumentError

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _refused(name: str, value: Any, wanted: str) -> ArgumentError:
    return ArgumentError(f"{name} = {_shown(value)} is of the type {type(value).__name__}: it must be {wanted}")


def _shown(value: Any) -> str:
    """A value in a message: long ones are cut."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else f"{text[:57]}..."


def _is_truth(value: Any) -> bool:
    # That of numpy has one of these names, by the version.
    return isinstance(value, bool) or type(value).__module__ == "numpy" and type(value).__name__ in ("bool", "bool_")


def truth(name: str, value: Any) -> bool:
    """True or False: everything else has a truth value too, and hardly the one that was meant."""
    if not _is_truth(value):
        raise _refused(name, value, "True or False")
    return bool(value)


def number(name: str, value: Any, wanted: str = "a number") -> float:
    """A real number: no text, no truth value, no array."""
    is_complex = isinstance(value, complex) or getattr(getattr(value, "dtype", None), "kind", "") == "c"
    if _is_truth(value) or is_complex or isinstance(value, (str, bytes)) or getattr(value, "shape", ()) != ():
        raise _refused(name, value, wanted)
    try:
        return float(value)
    except OverflowError as error:
        raise ArgumentError(f"{name} is out of range: it must be at most 1e308") from error
    except (TypeError, ValueError) as error:
        raise _refused(name, value, wanted) from error


def whole(name: str, value: Any) -> int:
    """A whole number."""
    if _is_truth(value):
        raise _refused(name, value, "a whole number")
    try:
        return index(value)
    except TypeError as error:
        raise _refused(name, value, "a whole number") from error


def text(name: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise _refused(name, value, "a string")
    return value


def texts(name: str, value: Any) -> List[str]:
    """A text, or several."""
    if isinstance(value, str):
        return [value]
    try:
        return [text(name, item) for item in value]
    except (TypeError, ArgumentError) as error:
        raise _refused(name, value, "a string, or a sequence of strings") from error


def numbers(name: str, value: Any) -> List[float]:
    """A number, or several."""
    if isinstance(value, (str, bytes, Mapping)) or getattr(value, "ndim", 1) > 1:
        raise _refused(name, value, "a number, or a sequence of numbers")
    if not hasattr(value, "__iter__") or getattr(value, "shape", None) == ():
        return [number(name, value)]
    return [number(f"{name}[{at}]", item) for at, item in enumerate(value)]


def path(name: str, value: Any) -> str:
    """The name of a file."""
    if isinstance(value, (str, os.PathLike)):
        value = os.fspath(value)
    if not isinstance(value, str):
        raise _refused(name, value, "a string or a path")
    if not value:
        raise ArgumentError(f"{name} is empty: it must name a file")
    return value


def control(name: str, value: Any) -> Union[str, float]:
    """What the loading device prescribes."""
    return value if isinstance(value, str) else number(name, value, "'displacement', 'force' or a stiffness")


def mapping(name: str, value: Any) -> Dict[Any, Any]:
    """Values by their keys; a path is the name of a file."""
    if not isinstance(value, Mapping) and not hasattr(value, "keys"):
        raise _refused(name, value, "a dict")
    return {key: os.fspath(item) if isinstance(item, os.PathLike) else item for key, item in dict(value).items()}


def items(name: str, value: Any, wanted: str) -> List[Any]:
    """The items of a sequence."""
    if isinstance(value, (str, bytes, Mapping)) or not hasattr(value, "__iter__"):
        raise _refused(name, value, wanted)
    return list(value)


_Check = Callable[[str, Any], Any]


def _optional(check: _Check) -> _Check:
    return lambda name, value: None if value is None else check(name, value)


#: What each annotation stands for.
_KINDS: Dict[str, _Check] = {
    "bool": truth,
    "float": number,
    "Optional[float]": _optional(number),
    "int": whole,
    "Optional[int]": _optional(whole),
    "str": text,
    "Optional[str]": _optional(text),
    "Union[str, Sequence[str], None]": _optional(texts),
    "Union[float, Sequence[float]]": numbers,
    "Union[float, Sequence[float], None]": _optional(numbers),
    "Union[str, 'os.PathLike[str]']": path,
    "Union[str, 'os.PathLike[str]', None]": _optional(path),
    "Optional[Control]": _optional(control),
    "Optional[Mapping[str, Value]]": _optional(mapping),
    "Optional[Mapping[str, Union[float, str]]]": _optional(mapping),
}


def _check_of(annotation: str) -> Optional[_Check]:
    # A choice is made among the words by the engine, which names them.
    return _optional(text) if annotation.startswith("Optional[Literal[") else _KINDS.get(annotation.replace('"', "'"))


def checked(function: _Function) -> _Function:
    """``function``, whose arguments are first checked, and taken, as its annotations say."""
    annotated = {name: _check_of(kind) for name, kind in function.__annotations__.items() if name != "return"}
    kinds = {name: check for name, check in annotated.items() if check is not None}
    places = function.__code__.co_varnames[: function.__code__.co_argcount]

    @wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        def take(name: Optional[str], value: Any) -> Any:
            return kinds[name](name, value) if name in kinds else value

        # Too many are passed on, and refused there.
        names = (*places, *[None] * (len(given) - len(places)))
        return function(
            *(take(name, value) for name, value in zip(names, given)),
            **{name: take(name, value) for name, value in named.items()},
        )

    return cast(_Function, call)
