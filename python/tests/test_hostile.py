"""Whatever Python hands over, an exception comes back and never the end of the interpreter."""

import os
import random

import numpy as np

import pulloff

# PULLOFF_HOSTILE=100000 for a long run.
CALLS = int(os.environ.get("PULLOFF_HOSTILE", "1000"))

VALUES = [
    0, -1, 1, 2**63, -(2**80), 1e308, -1e-308, 0.0, -0.0, float("nan"), float("inf"), True, None, "", "x", "\x00", "\ud800",
    "1e400", "5 um", "force", "stiffness=0", "r^2/2", "(" * 500, "é" * 300, [], {}, object(), b"bytes", 1j, np.nan,
    np.float32(0.1), np.int8(3), np.array(1.0), np.array([1.0, 2.0]), 0.003, 1e-3, 20, 0.3,
]
KEYS = [
    "gap.amplitude", "gap.wavelength", "gap.radius_of_curvature", "gap.shape", "gap.formula", "gap.file", "basis.kind",
    "basis.rings", "path.control", "path.start_contact_radius", "path.start_force", "path.end_contact_radius", "units",
    "material.work_of_adhesion", "material.effective_modulus", "title", "format", "", "gap", "nothing", "\x00", "\ud800", 7,
]


def test_hostile_calls():
    rng = random.Random(1)
    problems = [pulloff.Problem("fig-9", {"basis.rings": 20}), pulloff.Problem("cone"), pulloff.Problem("wavy-sphere")]
    refused = 0
    for _ in range(CALLS):
        problem, value, key = rng.choice(problems), rng.choice(VALUES), rng.choice(KEYS)
        other = rng.choice(VALUES)
        call = rng.choice(
            [
                lambda: pulloff.Problem(value),
                lambda: pulloff.Problem("fig-9", value),
                lambda: problem.replace({key: value}),
                lambda: problem.replace({key: value, rng.choice(KEYS): other}),
                lambda: problem.replace(value),
                lambda: problem.pressure(value, other),
                lambda: problem.gap(value, other),
                lambda: problem.unload(value, areas=False, admissibility=False),
                lambda: problem.stability(value, samples=other),
                lambda: problem[key],
                lambda: pulloff.sweep(value),
                lambda: pulloff.sweep({"preset": problem, "axis": [{"key": key, "values": [value, other]}]}, jobs=1),
                lambda: pulloff.sweep({"preset": problem, str(key): value, "axis": other}, jobs=1),
                lambda: pulloff.Problem.from_gap(
                    value, other, effective_modulus=1.0, work_of_adhesion=0.01, start_contact_radius=0.3
                ),
                lambda: pulloff.Problem.from_gap(
                    [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8], np.linspace(0, 1, 9) ** 2, effective_modulus=value,
                    work_of_adhesion=0.01, start_contact_radius=other,
                ),
            ]
        )
        try:
            call()
        except Exception as error:  # noqa: BLE001
            assert not isinstance(error, pulloff.InternalError), error
            refused += 1
    assert refused > CALLS // 3
