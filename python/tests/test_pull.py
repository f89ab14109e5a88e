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
    pytest.importorskip("matplotlib")
    assert held.plot().get_ylabel() == "time to failure"


def test_what_is_missing_is_said():
    problem = pulloff.Problem("wavy-sphere")
    with pytest.raises(pulloff.PullError, match="edge.exponent"):
        problem.pull(1.0)
    with pytest.raises(pulloff.PullError, match="no rate"):
        problem.replace({"edge.exponent": 0.5}).pull()
    with pytest.raises(pulloff.PullError, match="above 0"):
        problem.replace({"edge.exponent": 0.5}).pull(-1.0)


def test_speeds_of_a_made_edge():
    problem = pulloff.Problem(
        "lens",
        {
            "material.effective_modulus": "1 MPa",
            "gap.radius_of_curvature": "1 mm",
            "path.control": "displacement",
            "data.baseline": 0.0,
        },
    )
    s = 1.2e-4 - 5e-7 * np.arange(60)
    opening = np.sqrt(2 * np.pi * 0.05 * s / 1e6)
    approach = s**2 / 1e-3 - opening
    force = 2e6 * (approach * s - s**3 / 3e-3)
    points = {"time": np.arange(60.0), "contact radius": s, "force": force}
    found = problem.speeds(points)
    assert found.row_count == 60
    assert np.allclose(found.energy_release_rate, 0.05, rtol=1e-6)
    assert np.allclose(found.speed, 5e-7, rtol=1e-6)
    assert found.to_dict()["from"] == "force and contact radius"
    assert found.segment.tolist() == ["retraction"] * 60
    assert found.row.tolist() == list(range(1, 61)) and found.window.dtype.kind == "i"
    hidden = np.ma.array(force, mask=np.arange(60) == 30)
    assert problem.speeds({**points, "force": hidden}).row_count == 59
    with pytest.raises(pulloff.DataError, match="no approach"):
        problem.speeds(points, of="approach-radius")
    with pytest.raises(pulloff.DataError, match="is not one of force-radius"):
        problem.speeds(points, of="radius")
    with pytest.raises(pulloff.DataError, match="no measured curve"):
        pulloff.Problem("wavy-sphere").speeds()
