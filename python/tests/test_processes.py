"""Problems, results and exceptions copied, pickled, and sent to other processes and back."""

import copy
import inspect
import multiprocessing
import pickle

import numpy as np
import pytest

import pulloff

R = np.linspace(0.0, 1.0, 200)
OF = dict(effective_modulus=1.0, work_of_adhesion=0.004, start_contact_radius=0.3)
AMPLITUDES = [1e-3, 2e-3, 3e-3]


def problems():
    yield pulloff.Problem("fig-9")
    yield pulloff.Problem("fig-9-si", {"gap.amplitude": "3 um", "path.control": "stiffness=5 N/m"})
    yield pulloff.Problem.from_gap(R, R**2 / 2, **OF)
    yield pulloff.Problem.from_gap(
        R * 1e-3, R**2 / 2e3, units="SI", effective_modulus=1e6, work_of_adhesion=0.05, start_contact_radius=1e-4
    )
    # A profile and a measured curve that come with the package.
    yield from map(pulloff.Problem, [name for name in pulloff.presets() if name in ("profile", "fit")])


def results():
    fig_9 = pulloff.Problem("fig-9")
    curve = fig_9.trace(theory=True)
    yield curve
    yield fig_9.unload()
    yield fig_9.unload(admissibility=False)
    yield pulloff.Problem("fig-9-cycle").cycle(areas=False)
    yield fig_9.stability(samples=50)
    yield fig_9.map(("gap.amplitude", 1e-3, 2e-3), "force")
    yield fig_9.fit(curve, ["material.work_of_adhesion"], sigma_x=1e-4, sigma_force=1e-5)
    yield pulloff.sweep({"preset": fig_9, "axis": [{"key": "gap.amplitude", "values": AMPLITUDES}]})


def errors():
    yield pulloff.PresetError("a", key="k", line=3, mistakes=[(3, "k", "a")])
    yield pulloff.SpecError("a", line=3)
    yield pulloff.NotCertified("a", radius=0.1, difference=0.2)
    yield pulloff.NotDetermined("a", result={"b": 1})
    yield pulloff.Interrupted("a", result=[1])
    with_keywords = (pulloff.NotCertified,)
    for kind in vars(pulloff.errors).values():
        if inspect.isclass(kind) and issubclass(kind, BaseException) and kind not in with_keywords:
            yield kind("a sentence")


COPIES = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    **{f"pickle {n}": lambda x, n=n: pickle.loads(pickle.dumps(x, n)) for n in (2, pickle.HIGHEST_PROTOCOL)},
}


@pytest.mark.parametrize("way", COPIES)
def test_problems_are_copied(way):
    for problem in problems():
        again = COPIES[way](problem)
        assert again == problem and hash(again) == hash(problem) and repr(again) == repr(problem)
        assert again.to_toml() == problem.to_toml() and again.to_dict() == problem.to_dict()
        quick = dict(areas=False, admissibility=False)
        assert again.unload(**quick) == problem.unload(**quick)
        assert repr(again.replace({"title": "b"})) == repr(problem.replace({"title": "b"}))


@pytest.mark.parametrize("way", COPIES)
def test_results_are_copied(way):
    for result in results():
        again = COPIES[way](result)
        assert again == result and type(again) is type(result) and repr(again) == repr(result)
        assert list(again) == list(result) and again.to_dict() == result.to_dict()
        assert again._repr_html_() == result._repr_html_() and getattr(again, "warnings", 0) == getattr(result, "warnings", 0)
        for name in result:
            assert again[name].dtype == result[name].dtype
        # A copy of a copy.
        assert COPIES[way](again) == result
        if isinstance(result, pulloff.Fit):
            assert again.problem == result.problem and again.residuals == result.residuals


def test_a_copy_is_one_of_its_own():
    curve = pulloff.Problem("fig-9").trace()
    copied = copy.deepcopy(curve)
    copied.force[0] += 1.0
    assert curve.force[0] == curve.to_dict()["points"][0]["force"] and copied.force[0] != curve.force[0]


def test_exceptions_come_back_as_they_went():
    for error in errors():
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error) and vars(again) == vars(error)
        again = copy.copy(error)
        assert type(again) is type(error) and vars(again) == vars(error)


def lost_at_force(problem):
    return problem.unload("force", areas=False, admissibility=False)


def fails(how):
    if how == "NotCertified":
        pulloff.Problem.from_gap(0.8, np.abs, tolerance=1e-9, **OF)
    if how == "PresetError":
        pulloff.Problem("fig-9", {"gap.amplitude": -1.0})
    if how == "NotDetermined":
        # Of a smooth sphere R and E* cannot be told apart.
        s = np.linspace(0.4, 0.2, 60)
        points = {
            "approach": s**2 - np.sqrt(2 * np.pi * 0.004 * s),
            "force": 4 / 3 * s**3 - np.sqrt(8 * np.pi * 0.004 * s**3),
        }
        sphere = pulloff.Problem("fig-9", {"gap.amplitude": 0.0, "path.start_contact_radius": 0.4, "basis.kind": "exact"})
        free = ["material.effective_modulus", "material.work_of_adhesion", "gap.radius_of_curvature"]
        sphere.fit(points, free, sigma_x=1e-4, sigma_force=1e-5)
    raise AssertionError(how)


FAILURES = ["NotCertified", "PresetError", "NotDetermined"]


def check(run, get):
    """`run` sends a call to another process, `get` gives what came of it."""
    ours = [pulloff.Problem("fig-9", {"gap.amplitude": amplitude}) for amplitude in AMPLITUDES]
    ours.append(pulloff.Problem.from_gap(R, R**2 / 2, **OF))
    theirs = [get(run(lost_at_force, problem)) for problem in ours]
    assert theirs == [lost_at_force(problem) for problem in ours]
    for how in FAILURES:
        with pytest.raises(getattr(pulloff, how)) as caught:
            get(run(fails, how))
        if how == "NotCertified":
            assert 0.0 <= caught.value.radius <= 0.8
        if how == "PresetError":
            assert caught.value.key == "gap.amplitude"
        if how == "NotDetermined":
            assert caught.value.result.problem["gap.shape"] == "wavy-sphere"


@pytest.mark.parametrize("start", ["spawn", "fork", "forkserver"])
def test_multiprocessing(start):
    with multiprocessing.get_context(start).Pool(2) as pool:
        check(lambda call, argument: pool.apply_async(call, (argument,)), lambda told: told.get(timeout=120))
        sums = pool.map(lost_at_force, [pulloff.Problem("fig-9", {"gap.amplitude": a}) for a in AMPLITUDES])
        assert [len(each.kind) for each in sums] == [
            len(lost_at_force(pulloff.Problem("fig-9", {"gap.amplitude": a})).kind) for a in AMPLITUDES
        ]


def test_joblib():
    joblib = pytest.importorskip("joblib", reason="LEFT OUT: joblib is not installed, so nothing was sent through it")
    with joblib.parallel_config(backend="loky", n_jobs=2):
        one = lambda call, argument: joblib.Parallel()([joblib.delayed(call)(argument)] * 2)[1]  # noqa: E731
        check(lambda call, argument: (call, argument), lambda told: one(*told))


def test_joblib_knows_a_problem_again(tmp_path):
    joblib = pytest.importorskip("joblib", reason="LEFT OUT: joblib is not installed, so nothing was kept by it")
    memory = joblib.Memory(tmp_path, verbose=0)
    kept = memory.cache(lost_at_force)
    for problem in problems():
        assert kept(problem) == lost_at_force(problem) == kept(copy.deepcopy(problem))


def test_dask():
    distributed = pytest.importorskip(
        "distributed", reason="LEFT OUT: dask.distributed is not installed, so nothing was sent to a cluster"
    )
    import dask

    with dask.config.set({"distributed.worker.daemon": False}):
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with distributed.Client(cluster) as client:
                check(lambda call, argument: client.submit(call, argument, pure=False), lambda told: told.result(120))
