"""numpy, imported when it is first used: importing it takes several times as long as all the rest."""

from typing import Any

from ._engine import arrays_ready


class _Numpy:
    def __getattr__(self, name: str) -> Any:
        arrays_ready()
        import numpy

        value = getattr(numpy, name)
        # Found at once from now on.
        setattr(self, name, value)
        return value


np = _Numpy()
