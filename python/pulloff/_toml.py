"""A dict as TOML, as far as the spec of a sweep needs it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from ._numpy import np
from .errors import SpecError


def written(document: Mapping[str, Any]) -> str:
    """The text of a document, a line for each key."""
    return "".join(f"{_key(key)} = {_value(value, str(key))}\n" for key, value in document.items())


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise SpecError(f"{key!r} is not a key: keys must be strings")
    return _text(key)


def _text(text: str) -> str:
    # TOML reads the escapes of JSON; it needs one more, which JSON does not write.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any, name: str) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(key)} = {_value(item, f'{name}.{key}')}" for key, item in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return f"[{', '.join(_value(item, name) for item in value)}]"
    raise SpecError(f"{name} is of the type {type(value).__name__}: a spec takes numbers, strings, lists and dicts")
