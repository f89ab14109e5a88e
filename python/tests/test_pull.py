"""Pulls at a rate."""

import math

import numpy as np
import pytest

import pulloff


def test_pulls_are_rows_and_a_document():
    problem = pulloff.Problem("wavy-sphere", {"edge.exponent": 0.5, "path.start_contact_radius": 0.5})
    pulled = problem.pull([1e-2, 1.0])
    critical = pulled.to_dict()["problem"]["critical_force"]
    assert np.allclose(-pulled.peak_force / critical, [1.64877, 2.72997], rtol=1e-5)
    assert list(pulled.tension_peaks) == [7, 6]
    assert (pulled.balance < 1e-9).all()
    assert len(pulled.runs[0]["tension_peaks"]) == 7
    assert pulled.failures == []


def test_dead_loads_are_borne_or_not():
    problem = pulloff.Problem("fig-3-jkr", {"edge.exponent": 0.5})
    critical = problem.pull(1.0).to_dict()["problem"]["critical_force"]
    held = problem.pull(hold_force=[-0.9 * critical, -1.1 * critical])
    assert held.failures[0]["time"] is None
    assert 0 < held.failures[1]["time"] < math.inf
    assert held.row_count == 2


def test_what_is_missing_is_said():
    problem = pulloff.Problem("wavy-sphere")
    with pytest.raises(pulloff.PullError, match="edge.exponent"):
        problem.pull(1.0)
    with pytest.raises(pulloff.PullError, match="no rate"):
        problem.replace({"edge.exponent": 0.5}).pull()
    with pytest.raises(pulloff.PullError, match="above 0"):
        problem.replace({"edge.exponent": 0.5}).pull(-1.0)
