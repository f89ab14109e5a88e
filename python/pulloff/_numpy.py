"""numpy when it is first used: to import it takes several times as long as all the rest."""

from typing import Any


class _Numpy:
    def __getattr__(self, name: str) -> Any:
        import numpy

        value = getattr(numpy, name)
        # Found at once from now on.
        setattr(self, name, value)
        return value


np = _Numpy()
