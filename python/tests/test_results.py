import json
import math
import os
import subprocess
import sys
import warnings
from collections.abc import Mapping

import numpy as np
import pytest

import pulloff


def test_columns_are_those_of_the_document(fig_9):
    curve = fig_9.trace()
    document = curve.to_dict()
    assert document["schema"] == 1 and len(document["points"]) == curve.row_count
    for name in ("force", "approach", "contact_radius", "energy"):
        array = getattr(curve, name)
        assert array.dtype == np.float64 and array.shape == (curve.row_count,)
        assert array.tolist() == [point[name] for point in document["points"]]
    assert curve.stable_chosen.dtype == np.bool_ and curve.step.dtype == np.int64
    assert curve.stable_force.tolist() == [point["stable"]["force"] for point in document["points"]]
    assert np.isnan(curve.tangent_stiffness).sum() == sum(
        point["tangent_stiffness"] is None for point in document["points"]
    )
    assert set(curve.columns) <= set(dir(curve))
    with pytest.raises(AttributeError):
        curve.nothing
    with pytest.raises(KeyError, match="contact_radius"):
        curve["nothing"]


def test_results_are_mappings(fig_9):
    curve = fig_9.trace()
    assert isinstance(curve, Mapping) and isinstance(curve, pulloff.Table)
    assert "force" in curve and "nothing" not in curve and 3 not in curve and None not in curve
    assert list(curve) == list(curve.keys()) == curve.columns and len(curve) == len(curve.columns)
    assert curve.get("nothing", 7) == 7 and all(values is curve[name] for name, values in curve.items())
    assert dict(curve)["force"] is curve.force and [len(values) for values in curve.values()] == [curve.row_count] * len(curve)
    assert {**curve}.keys() == curve.keys() and bool(curve)
    again = fig_9.trace()
    assert again == curve and not again != curve and again is not curve
    assert curve == dict(curve) and dict(curve).keys() == again.keys()
    assert curve != fig_9.replace({"gap.amplitude": 3e-3}).trace() and curve != fig_9.unload()
    assert curve != {**curve, "force": -curve.force} and curve != {"force": curve.force} and curve != 3
    # NaN and None are equal to themselves, as nobody would expect of floats alone.
    quick = dict(areas=False, admissibility=False)
    assert fig_9.unload(**quick) == fig_9.unload(**quick)
    with pytest.raises(TypeError):
        hash(curve)
    for wrong in (0, None, ["force"]):
        with pytest.raises(KeyError, match="no column is called"):
            curve[wrong]
    pandas = pytest.importorskip("pandas")
    assert list(pandas.DataFrame(dict(curve)).columns) == list(curve)


def test_the_exact_solution_stands_beside_a_trace(fig_9, tmp_path):
    exact = fig_9.replace({"basis.kind": "exact"}).trace(theory=True)
    assert {"exact_approach", "exact_force", "exact_energy", "exact_relative_difference"} <= set(exact)
    assert exact.force == pytest.approx(exact.exact_force, rel=1e-8, abs=1e-12)
    rings = fig_9.trace(theory=True)
    off = (rings.force - rings.exact_force) / np.abs(rings.exact_force)
    assert rings.exact_relative_difference == pytest.approx(off, rel=1e-9) and np.abs(off).max() > 1e-6
    assert "exact_force" not in fig_9.trace()


def test_the_documents_are_those_of_the_program(fig_9, tmp_path):
    program = os.environ.get("PULLOFF_PROGRAM")
    if program is None:
        pytest.skip("PULLOFF_PROGRAM does not say where the program is")
    for command, ours in [("trace", fig_9.trace()), ("unload", fig_9.unload())]:
        file = tmp_path / f"{command}.json"
        subprocess.run([program, command, "fig-9", "--format", "json", "-o", str(file)], check=True)
        assert ours.to_json() == file.read_text()
        csv = tmp_path / f"{command}.csv"
        subprocess.run([program, command, "fig-9", "-o", str(csv)], check=True)
        assert csv.read_text().splitlines()[0].split(",") == ours.columns


def test_unloading(fig_9):
    whole = fig_9.unload()
    assert whole.kind.tolist()[-1] == "last-contact" and set(whole.kind[:-1]) == {"snap"}
    assert whole.dissipated == pytest.approx(whole.dissipated_by_area, rel=1e-6)
    assert whole.totals["dissipated"] == pytest.approx(np.nansum(whole.dissipated), rel=1e-12)
    assert np.isnan(whole.after_force[-1]) and whole.admissible.dtype == np.bool_
    assert whole.largest_pull == whole.states.force.min() and whole.farthest == whole.states.approach.min()
    assert whole.totals["last_contact"]["force"] == whole.before_force[-1]
    quick = fig_9.unload(areas=False, admissibility=False)
    assert quick.before_force.tolist() == whole.before_force.tolist()
    assert quick.dissipated.tolist() == whole.dissipated.tolist()
    assert np.isnan(quick.dissipated_by_area).all() and quick.admissible.tolist() == [None] * quick.row_count
    force = fig_9.unload(control="force")
    assert force.to_dict()["control"] == "force" and np.isnan(force.dissipated[-1])
    assert fig_9.unload(control=0.15).to_dict()["control"] == {"stiffness": 0.15}


def test_cycle():
    loop = pulloff.Problem("fig-9-cycle").cycle()
    sums, states = loop.totals, loop.states
    assert sums["dissipated"] == pytest.approx(sums["work_of_loading"] + sums["work_of_unloading"], rel=1e-6)
    assert loop.kind[0] == "first-touch" and loop.number.tolist() == list(range(1, loop.row_count + 1))
    assert set(states.direction) == {"loading", "unloading"} and len(states.contacts) == states.row_count
    disc = np.array([len(contacts) == 1 and contacts[0][0] == 0 for contacts in states.contacts])
    assert states.held_stiffness[disc] == pytest.approx(2 * states.contact_radius[disc], rel=1e-12)
    assert loop.admissible.tolist() == [None] * loop.row_count
    alone = pulloff.Problem("fig-9-weak").cycle(one_disc=True, areas=False)
    assert False in alone.admissible.tolist() and alone.to_dict()["contact"] == "one-disc"
    with pytest.raises(pulloff.PresetError):
        pulloff.Problem("fig-9-cycle").cycle(to_force=1.0, to_radius=0.2)


def test_a_loop_turns_round_at_a_control_value():
    loop = pulloff.Problem("fig-9-cycle")
    turned = loop.cycle(to_control=0.03, areas=False)
    assert turned.to_dict()["turn"]["asked"] in (0.03, {"control": 0.03}) or turned.control.max() == pytest.approx(0.03, rel=1e-6)
    assert turned.control.max() == pytest.approx(loop.cycle(to_approach=0.03, areas=False).control.max(), rel=1e-6)
    force = loop.cycle("force", to_control=0.002, areas=False)
    assert force.control.max() == pytest.approx(0.002, rel=1e-6) and force.to_dict()["control"] == "force"
    for turns in ({"to_control": 0.03, "to_force": 1.0}, {"to_control": np.nan}, {"to_control": -np.inf}):
        with pytest.raises(pulloff.PresetError):
            loop.cycle(**turns)


def test_a_map_over_all_devices(fig_9):
    """From fixed grips to a dead load: the last column of a map over the compliance is force control."""
    devices = fig_9.map(("compliance", 0.0, math.inf), ("gap.amplitude", 1e-3, 3e-3), cells=(4, 3))
    counts = devices.counts
    assert counts["x"][0] == 0.0 and counts["x"][-1] == np.inf and np.isfinite(counts["x"][:-1]).all()
    for column, control in ((0, "displacement"), (-1, "force")):
        snaps = [
            fig_9.replace({"gap.amplitude": y, "basis.kind": "exact"}).unload(control).row_count - 1 for y in counts["y"].tolist()
        ]
        assert counts["snaps"][:, column].tolist() == snaps
    assert not np.isnan(devices.x).any()
    folds = fig_9.map(("compliance", 0.0, math.inf), "force")
    assert np.isinf(folds.x).any()
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    for drawn in (devices, folds):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            axes = drawn.plot()
            axes.figure.canvas.draw()
        labels = [label.get_text() for label in axes.get_xticklabels()]
        assert labels[0] == "0" and labels[-1] == "∞" and len(axes.lines) > 0
        ends = np.concatenate([line.get_xdata() for line in axes.lines])
        assert np.isfinite(ends).all() and ends.min() >= 0.0 and ends.max() <= 1.0
        if drawn is folds:
            assert ends.max() == 1.0
        matplotlib.pyplot.close("all")


def test_map(fig_9):
    folds = fig_9.map(("gap.amplitude", 1e-3, 3e-3), "approach")
    assert set(folds.kind) <= {"fold", "cusp", "landing"} and folds.counts is None
    # At the amplitude of the problem the folds are its limit points.
    document = fig_9.replace({"basis.kind": "exact"}).trace().to_dict()
    limits = [at["approach"] for at in document["limit_points"] if at["control"] == "displacement"]
    near = folds.y[np.abs(folds.x - fig_9["gap.amplitude"]) < 2e-5]
    assert all(np.min(np.abs(near - limit)) < 1e-3 for limit in limits)
    counted = fig_9.map(("gap.amplitude", 1e-3, 3e-3), ("path.start_contact_radius", 0.3, 0.4), cells=(4, 3))
    assert counted.counts["snaps"].shape == (4, 5) and counted.counts["x"].shape == (5,)
    snaps = [
        fig_9.replace({"gap.amplitude": x, "basis.kind": "exact", "path.start_contact_radius": counted.counts["y"][0]}).unload().row_count - 1
        for x in counted.counts["x"].tolist()
    ]
    assert counted.counts["snaps"][0].tolist() == snaps
    for x, y in [(("gap.amplitud", 0, 1), "force"), (("gap.shape", 0, 1), "force"), (("gap.amplitude", 2, 1), "force"),
                 (("gap.amplitude", 0, 1), "sideways"), (("gap.amplitude", 0), "force")]:
        with pytest.raises(pulloff.MapError):
            fig_9.map(x, y)


def test_stability(fig_9):
    law = fig_9.stability(control="force", samples=500)
    assert (np.diff(law.contact_radius) >= 0.0).all() and law.row_count == 500 + (law.kind != "sample").sum()
    assert law.contact_radius[-1] == pytest.approx(fig_9["path.start_contact_radius"]) and law.critical_force.dtype == np.float64
    assert law.critical_chosen.tolist() == law.critical_force.tolist()
    assert law.work_of_adhesion == fig_9["material.work_of_adhesion"]
    # Where the waves are low, minima and maxima alternate, each beyond its neighbours.
    low = fig_9.replace({"gap.amplitude": 2e-4}).stability(control="force", samples=500)
    cusps = np.flatnonzero(low.kind != "sample")
    assert len(cusps) > 8 and (low.kind[cusps[1:]] != low.kind[cusps[:-1]]).all()
    for at in cusps:
        beside = low.critical_chosen[[at - 1, at + 1]] - low.critical_chosen[at]
        assert (beside > 0.0).all() if low.kind[at] == "minimum" else (beside < 0.0).all()
    # The line of the adhesion cuts the law at the limit points.
    exact = fig_9.replace({"basis.kind": "exact"})
    limits = [at for at in exact.trace().to_dict()["limit_points"] if at["control"] == "force"]
    fine = exact.stability(control="force", samples=20001)
    signs = np.sign(fine.critical_chosen - fine.work_of_adhesion)
    crossings = fine.contact_radius[1:][signs[1:] * signs[:-1] < 0.0]
    assert sorted(at["contact_radius"] for at in limits) == pytest.approx(crossings.tolist(), abs=1e-4)
    assert any("exact equation" in warning for warning in law.warnings) and fine.to_dict()["schema"] == 1
    for samples in (1, 10_000_001):
        with pytest.raises(pulloff.ComputationError):
            fig_9.stability(samples=samples)


def test_the_stability_of_the_smooth_sphere_is_that_of_jkr():
    modulus = 1.7
    sphere = pulloff.Problem(
        f"[material]\neffective_modulus={modulus}\nwork_of_adhesion=0.004\n[gap]\nshape='wavy-sphere'\n"
        "radius_of_curvature=1\namplitude=0\nwavelength=0.05\n[path]\nstart_contact_radius=0.3\n"
    )
    law = sphere.stability(0.4, samples=50)
    s = law.contact_radius
    assert set(law.kind) == {"sample"} and law.row_count == 50
    known = ~np.isnan(law.critical_displacement)
    assert known.sum() > 40
    fixed = (8 * modulus / np.pi * s**3)[known]
    x = 2 * modulus * s[known] / 0.4
    assert law.critical_displacement[known] == pytest.approx(fixed, rel=1e-9)
    assert law.critical_force[known] == pytest.approx(fixed / 9, rel=1e-9)
    assert law.critical_chosen[known] == pytest.approx(fixed * ((1 + x) / (1 + 3 * x)) ** 2, rel=1e-9)


def test_a_state_of_the_smooth_sphere_is_that_of_jkr():
    gamma, s = 0.004, 0.2
    sphere = pulloff.Problem(
        f"[material]\neffective_modulus=1\nwork_of_adhesion={gamma}\n[gap]\nshape='wavy-sphere'\nradius_of_curvature=1\n"
        "amplitude=0\nwavelength=0.05\n[path]\nstart_contact_radius=0.3\n"
    )
    r = np.linspace(0.0, 0.19, 20).reshape(4, 5)
    t, tension = np.sqrt(s**2 - r**2), np.sqrt(2 * np.pi * gamma * s)
    assert sphere.pressure(s, r) == pytest.approx((2 * t - tension / t) / np.pi, rel=1e-9, abs=1e-12)
    assert (sphere.gap(s, r) == 0.0).all()
    r = np.linspace(s, 0.4, 20)
    angle, t = np.arcsin(s / r), np.sqrt(r**2 - s**2)
    expected = r**2 / 2 + ((2 * s**2 - r**2) * angle + s * t) / np.pi - 2 / np.pi * tension * angle - (s**2 - tension)
    assert sphere.gap(s, r) == pytest.approx(expected, abs=1e-12)
    assert np.isnan(sphere.pressure(s, r[1:])).all()
    for s, r in [(-1.0, 0.1), (np.nan, 0.1), (0.1, -1.0), (0.1, np.inf)]:
        with pytest.raises(pulloff.NoState):
            sphere.pressure(s, r)


def test_far_radii_cost_the_near_ones_nothing(fig_9):
    near = [0.31, 0.4, 0.9]
    gaps = fig_9.gap(0.3, [*near, 1e9])
    assert gaps[:3].tolist() == fig_9.gap(0.3, near).tolist() and np.isfinite(gaps).all()
    # Far out the bodies have their own shape, shifted by δ.
    assert gaps[3] == pytest.approx(1e18 / 2, rel=1e-9)
    r = np.linspace(0.0, 1.0, 60)
    measured = pulloff.Problem.from_gap(r, r**2 / 2, effective_modulus=1.0, work_of_adhesion=0.004, start_contact_radius=0.3)
    gaps = measured.gap(0.2, [0.1, 0.3, 0.5, 1.0, 1.5])
    assert gaps[0] == 0.0 and (gaps[1:4] > 0.0).all() and np.isnan(gaps[4])
    assert fig_9.gap(0.3, [0.4, 1e9])[0] == fig_9.gap(0.3, 0.4) == fig_9.gap(0.3, [0.301, 0.4])[1]
    for s in (1e9, 1e30, 1e31):
        with pytest.raises((pulloff.GapError, pulloff.NoState)):
            fig_9.gap(s, 2e30)


def test_the_edge_pulls_with_all_its_might(fig_9):
    si = pulloff.Problem("fig-9-si")
    for problem, s in ((fig_9, 0.3), (fig_9, 0.1234567), (si, 0.3 * si["gap.radius_of_curvature"])):
        r = np.linspace(0.0, s, 11)
        rounded = [s, np.nextafter(s, 0.0), np.nextafter(s, 1.0), s * (1 - 3e-16), 3 * (s / 3), r[-1]]
        assert (problem.pressure(s, rounded) == -np.inf).all()
        inside = problem.pressure(s, s * (1.0 - np.array([1e-3, 1e-6, 1e-9, 1e-12])))
        assert np.isfinite(inside).all() and (np.diff(inside) < 0.0).all()
        # −√(γE*/(π(s − r))) towards the edge.
        gamma, modulus = problem["material.work_of_adhesion"], problem["material.effective_modulus"]
        assert inside[-1] == pytest.approx(-np.sqrt(gamma * modulus / (np.pi * 1e-12 * s)), rel=1e-3)
        assert np.isnan(problem.pressure(s, 1.001 * s))
    hertz = fig_9.replace({"gap.amplitude": 0.0, "material.work_of_adhesion": 0.0})
    assert hertz.pressure(0.3, 0.3) == 0.0


def test_units_are_kept():
    si = pulloff.Problem("fig-9-si")
    reduced = pulloff.Problem("fig-9")
    scale = si["gap.radius_of_curvature"]
    s, r = 0.3, np.array([0.1, 0.2])
    stress = si["material.effective_modulus"] / reduced["material.effective_modulus"]
    assert si.pressure(s * scale, r * scale) == pytest.approx(reduced.pressure(s, r) * stress, rel=1e-9)


def test_notebook_and_optional_packages(fig_9):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    sweep = pulloff.sweep({"preset": fig_9, "axis": [{"key": "gap.amplitude", "values": [1e-3, 2e-3]}]})
    for result in (fig_9.trace(), fig_9.unload(), pulloff.Problem("fig-9-cycle").cycle(areas=False), fig_9.stability(), sweep):
        page = result._repr_html_()
        assert page.count("<tr>") == min(result.row_count, 12) + 1 and "<script" not in page
        axes = result.plot()
        assert axes.lines and axes.get_xlabel() and axes.get_ylabel()
        assert result.plot(ax=axes) is axes
        matplotlib.pyplot.close("all")
    pandas = pytest.importorskip("pandas")
    frame = fig_9.trace().to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == fig_9.trace().columns
    assert json.loads(json.dumps(sweep.to_dict()))["row"] == [0, 1]


def test_import_is_light():
    code = "import sys, pulloff; print([m for m in ('numpy', 'pandas', 'matplotlib', 'tqdm') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
