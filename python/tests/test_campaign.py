"""Calls that nobody should make, each with what must come of it: its exception, or an answer that is right.

Every tenth of them in the gate; PULLOFF_HOSTILE=1 and more runs them all.
"""

import collections
import copy
import math
import os
import pickle
import signal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import pulloff
from pulloff import DataError, MapError, NoState, NotCertified, OutputError, PresetError, Problem, SpecError

OF = dict(effective_modulus=1.0, work_of_adhesion=0.004, start_contact_radius=0.3)
R = np.linspace(0.0, 1.0, 50)
NAN, INF = float("nan"), float("inf")
QUICK = dict(areas=False, admissibility=False)
AXIS = {"key": "gap.amplitude", "values": [1e-3, 2e-3]}
GAMMA = ["material.work_of_adhesion"]
ANY = (pulloff.Error, TypeError, ValueError, OverflowError)


class Evil:
    """An object whose every question is answered by an exception."""

    def __getattr__(self, name):
        raise RuntimeError(name)

    def __fspath__(self):
        raise RuntimeError("path")

    def __float__(self):
        raise RuntimeError("float")

    def __index__(self):
        raise RuntimeError("index")

    def __str__(self):
        raise RuntimeError("str")


class Liar(dict):
    """A mapping that has other items each time."""

    def items(self):
        return [("gap.amplitude", -1.0), ("gap.amplitude", "x")]


def problem():
    return Problem("fig-9")


def curve():
    exact = problem().trace()
    return {"approach": exact.approach, "force": exact.force}


def loop(values):
    values.append(values)
    return values


def stays(made, key, value):
    """The problem is usable, and has this value."""
    return made[key] == value and made.unload(**QUICK).row_count > 0


# What is called, and its exceptions or what must hold of its answer.
CALLS = [
    # Sources of a problem.
    (lambda: Problem(""), PresetError),
    (lambda: Problem("\n"), PresetError),
    (lambda: Problem("\n" * 100_000), PresetError),
    (lambda: Problem("a\n" * 10), PresetError),
    (lambda: Problem("[" * 10_000 + "\n"), PresetError),
    (lambda: Problem("x = " + "[" * 5_000 + "\n"), PresetError),
    (lambda: Problem("fig-9\x00"), PresetError),
    (lambda: Problem("FIG-9"), PresetError),
    (lambda: Problem(" fig-9 "), PresetError),
    (lambda: Problem("../fig-9"), PresetError),
    (lambda: Problem("/"), PresetError),
    (lambda: Problem("/dev/zero"), PresetError),
    (lambda: Problem("/proc/self/mem"), ANY),
    (lambda: Problem(Path(".")), PresetError),
    (lambda: Problem(b"fig-9"), ANY),
    (lambda: Problem(3), TypeError),
    (lambda: Problem(None), TypeError),
    (lambda: Problem(Evil()), RuntimeError),
    (lambda: Problem(problem()), TypeError),
    (lambda: Problem("\ud800\n"), ANY),
    (lambda: Problem("\ud800"), ANY),
    (lambda: Problem("é" * 100_000), PresetError),
    (lambda: Problem(problem().to_toml().replace("0.0025", "1e999")), PresetError),
    (lambda: Problem(problem().to_toml() * 2), PresetError),
    (lambda: Problem(problem().to_toml().replace("\n", "\r\n")), lambda made: made == problem()),
    # Changes.
    (lambda: Problem("fig-9", {}), lambda made: made == problem()),
    (lambda: Problem("fig-9", []), lambda made: made == problem()),
    (lambda: Problem("fig-9", "ab"), ANY),
    (lambda: Problem("fig-9", {1: 2}), PresetError),
    (lambda: Problem("fig-9", {"gap.amplitude": True}), PresetError),
    (lambda: Problem("fig-9", {"gap.amplitude": 1j}), PresetError),
    (lambda: Problem("fig-9", {"gap.amplitude": Evil()}), (RuntimeError, PresetError)),
    (lambda: Problem("fig-9", {"gap.amplitude": np.array([1e-3])}), ANY),
    (lambda: Problem("fig-9", {"gap.amplitude": Fraction(1, 500)}), lambda made: stays(made, "gap.amplitude", 0.002)),
    (lambda: Problem("fig-9", {"gap.amplitude": np.float32(0.001)}), lambda made: made["gap.amplitude"] == float(np.float32(0.001))),
    (lambda: Problem("fig-9", {"gap.amplitude": 10**400}), PresetError),
    (lambda: Problem("fig-9", {"gap.amplitude": -0.0}), lambda made: made["gap.amplitude"] == 0.0),
    (lambda: Problem("fig-9", {"gap.amplitude": 5e-324}), PresetError),
    (lambda: Problem("fig-9", {"basis.kind": "rings", "basis.rings": 2**63}), PresetError),
    (lambda: Problem("fig-9", {"basis.kind": "rings", "basis.rings": 20.5}), PresetError),
    (lambda: Problem("fig-9", {"path.control": "stiffness=-1"}), PresetError),
    (lambda: Problem("fig-9", {"path.control": "stiffness"}), PresetError),
    (lambda: Problem("fig-9", {"gap.file": "/dev/zero"}), PresetError),
    (lambda: Problem("fig-9", {"gap.shape": "profile"}), lambda made: made.unload(**QUICK).row_count > 0),
    (lambda: Problem("fig-9", {"gap.shape": "formula", "gap.formula": "(" * 10_000}), PresetError),
    (lambda: Problem("fig-9", {"gap.shape": "formula", "gap.formula": "r^r^r^r"}).unload(**QUICK), ANY),
    (lambda: Problem("fig-9", {"gap.shape": "formula", "gap.formula": "1/r"}), PresetError),
    (lambda: Problem("fig-9", {"title": "\n[gap]\nshape='cone'"}), (lambda made: pickle.loads(pickle.dumps(made)) == made, PresetError)),
    (lambda: problem().replace(Liar()), (PresetError, lambda made: made == problem())),
    (lambda: problem().replace(nothing=3), PresetError),
    (lambda: problem().replace({"gap.amplitude": "3 parsec"}), PresetError),
    (lambda: problem()["nothing"], KeyError),
    (lambda: problem()[3], KeyError),
    (lambda: problem()[[]], TypeError),
    (lambda: setattr(problem(), "title", "x"), AttributeError),
    (lambda: problem().__setattr__("anything", 3), AttributeError),
    (lambda: {problem(): 1, Problem("fig-9"): 2}, lambda made: list(made.values()) == [2]),
    (lambda: problem() == Evil(), lambda made: made is False),
    (lambda: problem() < problem(), TypeError),
    (lambda: list(problem()), lambda made: made == list(problem().to_dict()) and dict(problem()) == problem().to_dict()),
    (lambda: "gap.amplitude" in problem(), lambda made: made and 0 not in problem() and "nothing" not in problem()),
    # Gaps of one's own.
    (lambda: Problem.from_gap([], [], **OF), PresetError),
    (lambda: Problem.from_gap(R, R**2, **{**OF, "work_of_adhesion": NAN}), PresetError),
    (lambda: Problem.from_gap(R, R**2, **{**OF, "effective_modulus": "x"}), ANY),
    (lambda: Problem.from_gap(R, R**2, units="miles", **OF), PresetError),
    (lambda: Problem.from_gap(R, R**2, units="SI\"\n[gap]", **OF), PresetError),
    (lambda: Problem.from_gap(R, R**2, changes={"gap.file": "none.csv"}, **OF), PresetError),
    (lambda: Problem.from_gap(R + INF, R**2, **OF), PresetError),
    (lambda: Problem.from_gap(R, R * NAN, **OF), PresetError),
    (lambda: Problem.from_gap(np.zeros(50), R, **OF), PresetError),
    (lambda: Problem.from_gap(R - 0.5, R**2, **OF), PresetError),
    (lambda: Problem.from_gap(R, [None] * 50, **OF), ANY),
    (lambda: Problem.from_gap(R, ["a"] * 50, **OF), ValueError),
    (lambda: Problem.from_gap(R, R**2 * 1e300, **OF).unload(**QUICK), ANY),
    (lambda: Problem.from_gap(R, -(R**2), **OF).unload(**QUICK), ANY),
    (lambda: Problem.from_gap(R[::2], (R**2 / 2)[::2], **OF), lambda made: made.trace().row_count > 0),
    (lambda: Problem.from_gap(np.asfortranarray(np.stack([R, R]).T)[:, 0], R**2 / 2, **OF), lambda made: made.trace().row_count > 0),
    (lambda: Problem.from_gap(0.8, lambda r: r[:, None] ** 2, **OF), PresetError),
    (lambda: Problem.from_gap(0.8, lambda r: None, **OF), ANY),
    (lambda: Problem.from_gap(0.8, lambda r: (r.fill(1.0), r**2)[1], **OF), lambda made: made == Problem.from_gap(0.8, np.ones_like, **OF)),
    (lambda: Problem.from_gap(0.8, lambda r: (r.__imul__(r), r / 2)[1], **OF), lambda made: made == Problem.from_gap(0.8, lambda r: r * r / 2, **OF)),
    (lambda: Problem.from_gap(0.8, lambda r: np.random.default_rng(1).random(r.size), **OF), NotCertified),
    (lambda: Problem.from_gap(0.8, lambda r: r**2, tolerance=0.0, **OF), PresetError),
    (lambda: Problem.from_gap(NAN, lambda r: r**2, **OF), PresetError),
    (lambda: Problem.from_gap([1.0, 2.0], lambda r: r**2, **OF), TypeError),
    # What is computed.
    (lambda: problem().unload(True), PresetError),
    (lambda: problem().unload(NAN), PresetError),
    (lambda: problem().unload(-1.0), PresetError),
    (lambda: problem().unload(0.0, **QUICK), (PresetError, lambda made: made == problem().unload("force", **QUICK))),
    (lambda: problem().unload(INF, **QUICK), (PresetError, lambda made: made == problem().unload("displacement", **QUICK))),
    (lambda: problem().unload("sideways"), PresetError),
    (lambda: problem().unload(["force"]), TypeError),
    (lambda: problem().unload(areas="no", admissibility=False), TypeError),
    (lambda: problem().trace(progress=3), (TypeError, lambda made: made == problem().trace())),
    (lambda: problem().trace(progress=lambda: None), TypeError),
    (lambda: problem().stability(samples=2.5), TypeError),
    (lambda: problem().stability(samples=True), pulloff.ComputationError),
    (lambda: problem().stability(samples=2**70), pulloff.ComputationError),
    (lambda: problem().stability(samples=2), lambda made: made.row_count >= 2),
    (lambda: Problem("fig-9-cycle").cycle(to_control="far"), ValueError),
    (lambda: Problem("fig-9-cycle").cycle(to_control=-1e300), (pulloff.Error, lambda made: made.row_count > 0)),
    (lambda: Problem("fig-9-cycle").cycle(to_radius=-1.0), PresetError),
    (lambda: Problem("fig-9-cycle").cycle(to_force=1e300), pulloff.Error),
    # States.
    (lambda: problem().pressure(0.0, 0.0), NoState),
    (lambda: problem().pressure(0.3, -0.0), lambda made: made.shape == () and np.isfinite(made)),
    (lambda: problem().pressure(0.3, []), lambda made: made.shape == (0,)),
    (lambda: problem().pressure(0.3, np.zeros((0, 3))), lambda made: made.shape == (0, 3)),
    (lambda: problem().pressure(0.3, [NAN]), NoState),
    (lambda: problem().pressure(0.3, ["a"]), ValueError),
    (lambda: problem().pressure(0.3, 1j), TypeError),
    (lambda: problem().pressure([0.3], 0.1), (TypeError, lambda made: np.isfinite(made))),
    (lambda: problem().pressure(5e-324, 0.0), NoState),
    (lambda: problem().pressure(1e-30, 0.0), np.isfinite),
    (lambda: problem().gap(1e300, 1e301), ANY),
    (lambda: problem().gap(0.3, [0.2, 0.3, 1e300]), lambda made: made[:2].tolist() == [0.0, 0.0] and not math.isnan(made[2])),
    (lambda: problem().gap(0.3, [0.4, 1e9]), lambda made: made[0] == problem().gap(0.3, 0.4) and made[1] > 1e17),
    (lambda: problem().gap(0.3, np.ma.masked_array([0.4, 0.5], [True, False])), lambda made: np.isfinite(made).all()),
    # Maps.
    (lambda: problem().map("compliance"), MapError),
    (lambda: problem().map(("compliance", -1.0, 1.0)), ANY),
    (lambda: problem().map(("gap.amplitude", 0.0, INF)), MapError),
    (lambda: problem().map(("gap.amplitude", 0.0, 1e-3, "log")), MapError),
    (lambda: problem().map(("gap.amplitude", 1e-3, NAN)), MapError),
    (lambda: problem().map((3, 0.0, 1.0)), MapError),
    (lambda: problem().map(("gap.amplitude", 1e-3, 2e-3), ("gap.amplitude", 1e-3, 2e-3)), ANY),
    (lambda: problem().map(("gap.amplitude", 1e-3, 2e-3), cells=(0, 1)), MapError),
    (lambda: problem().map(("gap.amplitude", 1e-3, 2e-3), cells=(2.5, 1)), TypeError),
    (lambda: problem().map(("gap.amplitude", 1e-3, 2e-3), cells="ab"), TypeError),
    (lambda: problem().map(None), (MapError, TypeError)),
    # Results.
    (lambda: problem().trace()["force", "approach"], KeyError),
    (lambda: problem().trace()[:3], KeyError),
    (lambda: problem().trace() == Evil(), lambda made: made is False),
    (lambda: problem().trace().__getattr__("_arrays_"), AttributeError),
    (lambda: copy.copy(pulloff.Trace.__new__(pulloff.Trace)), ANY + (AttributeError,)),
    (lambda: collections.ChainMap(problem().trace(), {})["force"].size, lambda made: made > 0),
    (lambda: problem().trace().plot(ax=3), AttributeError),
    # Sweeps.
    (lambda: pulloff.sweep(None), TypeError),
    (lambda: pulloff.sweep(""), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, jobs=1.5), TypeError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, jobs=10**30), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": loop([])}), (SpecError, RecursionError)),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS], "set": ["gap.amplitude=1"]}), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [{**AXIS, "values": []}]}), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [{**AXIS, "values": [NAN]}]}), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [{"key": "gap.amplitude", "linear": {"from": 0, "to": 1e-3, "count": 10**15}}]}), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, shard=(2, 2)), lambda made: made.row.tolist() == [1]),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, shard=(3, 3)), lambda made: made.row_count == 0 and len(made) == len(made.columns)),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, shard="1/0"), SpecError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, out=""), ANY),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, out=3), TypeError),
    (lambda: pulloff.sweep({"preset": problem(), "axis": [AXIS]}, row_limit="1s"), TypeError),
    # Fits.
    (lambda: problem().fit(), DataError),
    (lambda: problem().fit(curve(), 3), TypeError),
    (lambda: problem().fit(curve(), [3]), TypeError),
    (lambda: problem().fit(Evil(), GAMMA), (RuntimeError, DataError)),
    (lambda: problem().fit({"force": [1.0] * 20, "approach": [INF] * 20}, GAMMA), DataError),
    (lambda: problem().fit({"force,x": [1.0] * 20, "approach\n": list(range(20))}, GAMMA), DataError),
    (lambda: problem().fit({3: [1.0] * 20, "approach": list(range(20))}, GAMMA), DataError),
    (lambda: problem().fit({"force": np.zeros(20), "approach": np.zeros(20)}, GAMMA), pulloff.Error),
    (lambda: problem().fit(curve(), GAMMA, bootstrap=10.5), TypeError),
    (lambda: problem().fit(curve(), GAMMA, x_range=(5.0, 6.0)), DataError),
    (lambda: problem().fit("/dev/zero", GAMMA), DataError),
    # Files.
    (lambda: problem().save("/dev/null"), OutputError),
    (lambda: problem().save("/proc/x.toml"), OutputError),
    (lambda: problem().save(3), TypeError),
]
ALL = "PULLOFF_HOSTILE" in os.environ


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def hangs(*_):
        raise AssertionError("it hangs")

    before = signal.signal(signal.SIGALRM, hangs)
    signal.alarm(300)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def test_there_are_enough():
    assert len(CALLS) >= 150


@pytest.mark.parametrize("number", range(0, len(CALLS), 1 if ALL else 10))
def test_the_call(number):
    call, wanted = CALLS[number]
    wanted = wanted if isinstance(wanted, tuple) else (wanted,)
    kinds = tuple(kind for kind in wanted if isinstance(kind, type))
    try:
        answer = call()
    except Exception as error:
        # PanicException is no Exception: it ends the test by itself.
        assert isinstance(error, kinds) and not isinstance(error, pulloff.InternalError), repr(error)
        assert str(error) != "" and "--" not in str(error), error
        return
    holds = [check(answer) for check in wanted if not isinstance(check, type)]
    assert holds and all(holds), answer
