import pytest

import pulloff


@pytest.fixture(scope="session")
def fig_9():
    return pulloff.Problem("fig-9")
