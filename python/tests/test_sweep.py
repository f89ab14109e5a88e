import os
import subprocess

import numpy as np
import pytest

import pulloff

AXIS = {"key": "gap.amplitude", "values": [1e-3, 2e-3, 3e-3]}


def test_rows_are_those_of_single_problems(fig_9):
    swept = pulloff.sweep(
        {"preset": "fig-9", "quantities": ["last_contact_force", "snaps", "last_contact_force_force"], "axis": [AXIS]}
    )
    assert swept.columns == ["row", "gap.amplitude", "last_contact_force", "snaps", "last_contact_force_force", "error"]
    assert swept.axes == ("gap.amplitude",)
    assert swept["gap.amplitude"].tolist() == AXIS["values"] and swept.row.tolist() == [0, 1, 2]
    assert swept.error.tolist() == [None] * 3
    for row, amplitude in enumerate(AXIS["values"]):
        problem = fig_9.replace({"gap.amplitude": amplitude})
        unloading = problem.unload()
        assert swept.last_contact_force[row] == unloading.before_force[-1]
        assert swept.snaps[row] == unloading.row_count - 1
        assert swept.last_contact_force_force[row] == problem.unload("force").before_force[-1]


def test_specs_from_everywhere(fig_9, tmp_path):
    text = "preset = 'fig-9'\nset = ['gap.wavelength=0.06']\n[[axis]]\nkey = 'gap.amplitude'\nvalues = [1e-3, 2e-3, 3e-3]\n"
    file = tmp_path / "spec.toml"
    file.write_text(text)
    (tmp_path / "mine.toml").write_text(fig_9.to_toml())
    wanted = pulloff.sweep(text).to_dict()
    wider = fig_9.replace({"gap.wavelength": 0.06})
    for spec in (
        file,
        str(file),
        {"preset": wider, "axis": [AXIS]},
        {"preset": fig_9, "set": ["gap.wavelength=0.06"], "axis": [AXIS]},
        {"preset": str(tmp_path / "mine.toml"), "set": ["gap.wavelength=0.06"], "axis": (AXIS,)},
    ):
        assert pulloff.sweep(spec, jobs=2).to_dict() == wanted


def test_jobs_change_nothing():
    spec = {
        "preset": "wavy-sphere",
        "random": {"draws": 20, "seed": 7},
        "axis": [{"key": "gap.amplitude", "distribution": {"log-uniform": [1e-4, 4e-3]}}],
    }
    one, four = pulloff.sweep(spec, jobs=1), pulloff.sweep(spec, jobs=4)
    assert one.to_dict() == four.to_dict() and one.row_count == 20


def test_a_row_that_cannot_be_computed_says_why():
    swept = pulloff.sweep(
        {"preset": "fig-9", "quantities": ["snaps"], "axis": [{"key": "path.end_contact_radius", "values": [0.1, 0.9]}]}
    )
    assert swept.error[0] is None and swept.snaps[0] > 0
    assert swept.error[1] and np.isnan(swept.snaps[1])


@pytest.mark.parametrize(
    "spec, words",
    [
        ({}, "preset is missing"),
        ({"preset": "fig-9"}, "axis is missing"),
        ({"preset": "fig-9", "axis": []}, "axis must be"),
        ({"preset": "fig9", "axis": [AXIS]}, "fig9"),
        ({"preset": "fig-9", "axis": [AXIS], "quantities": ["snap"]}, "did you mean snaps"),
        ({"preset": "fig-9", "axis": [{"key": "gap.amplitude", "values": [object()]}]}, "type object"),
        ({"preset": "fig-9", "axis": [AXIS], 3: 4}, "keys must be strings"),
        ({"preset": "fig-9", "axis": [{"key": "gap.amplitude", "values": [-1.0]}]}, "out of range"),
        ("none.toml", "No such file"),
    ],
)
def test_refused_specs(spec, words):
    with pytest.raises(pulloff.SpecError, match=words):
        pulloff.sweep(spec)


def test_quantities_are_listed():
    names = [quantity.name for quantity in pulloff.quantities()]
    assert {"last_contact_force", "snaps", "cycle_loss"} <= set(names)
    assert pulloff.quantities()[0].of_control
    with pytest.raises(pulloff.SpecError, match="jobs"):
        pulloff.sweep({"preset": "fig-9", "axis": [AXIS]}, jobs=0)


SPEC = {
    "preset": "fig-9",
    "quantities": ["last_contact_force", "snaps"],
    "axis": [
        {"key": "gap.amplitude", "linear": {"from": 1e-3, "to": 3e-3, "count": 5}},
        {"key": "path.end_contact_radius", "values": [0.1, 0.9]},
    ],
}


def test_rows_go_to_the_file_of_the_program(tmp_path):
    wanted = pulloff.sweep(SPEC)
    assert any(wanted.error) and not all(wanted.error)
    out = tmp_path / "rows.csv"
    assert pulloff.sweep(SPEC, out=out) == wanted
    before = out.read_bytes()
    assert before.count(b"\n") == 11 and (tmp_path / "rows.csv.spec.toml").exists()
    # Nothing is computed twice, and a torn line is cut off.
    assert pulloff.sweep(SPEC, out=out) == wanted and out.read_bytes() == before
    out.write_bytes(before[: len(before) // 2])
    assert pulloff.sweep(SPEC, out=str(out), jobs=2) == wanted and out.read_bytes() == before
    other = {**SPEC, "quantities": ["snaps"]}
    with pytest.raises(pulloff.OutputError, match="another sweep.*overwrite=True replaces"):
        pulloff.sweep(other, out=out)
    with pytest.raises(pulloff.OutputError, match="resume=True continues it, overwrite=True replaces it"):
        pulloff.sweep(SPEC, out=out, resume=False)
    assert out.read_bytes() == before
    assert pulloff.sweep(other, out=out, overwrite=True).columns == [c for c in wanted if c != "last_contact_force"]
    assert pulloff.sweep(SPEC, out=tmp_path / "new.csv", resume=False) == wanted
    for refused in (tmp_path, tmp_path / "none" / "x.csv", "-", "/dev/null", "\x00"):
        with pytest.raises((pulloff.OutputError, ValueError)):
            pulloff.sweep(SPEC, out=refused)


def test_shards_make_the_whole(tmp_path):
    whole = pulloff.sweep(SPEC)
    parts = [pulloff.sweep(SPEC, shard=(i, 3)) for i in (1, 2, 3)]
    rows = sorted((int(row), repr(part["last_contact_force"][at])) for part in parts for at, row in enumerate(part.row))
    assert rows == [(int(row), repr(force)) for row, force in zip(whole.row, whole.last_contact_force)]
    assert parts[1].row.tolist() == [1, 4, 7] and parts[1]["gap.amplitude"][0] == whole["gap.amplitude"][1]
    for i, part in enumerate(parts, 1):
        assert pulloff.sweep(SPEC, out=tmp_path / f"{i}.csv", shard=f"{i}/3") == part
    with pytest.raises(pulloff.OutputError, match="shard 1/3, not 2/3"):
        pulloff.sweep(SPEC, out=tmp_path / "1.csv", shard=(2, 3))
    program = os.environ.get("PULLOFF_PROGRAM")
    if program is not None:
        files = [str(tmp_path / f"{i}.csv") for i in (1, 2, 3)]
        subprocess.run([program, "sweep", "merge", *files, "-o", str(tmp_path / "all.csv")], check=True)
        assert pulloff.sweep(SPEC, out=tmp_path / "all.csv") == whole
    for shard in ((0, 3), (4, 3), "3", "a/b", (1, 2, 3)):
        with pytest.raises(pulloff.SpecError, match="shard"):
            pulloff.sweep(SPEC, shard=shard)


def test_a_row_is_given_up_when_its_time_is():
    slow = {"preset": "fig-9-cycle", "quantities": ["cycle_loss"], "axis": [{"key": "gap.amplitude", "values": [2e-3]}]}
    swept = pulloff.sweep(slow, row_limit=1e-6)
    assert "row limit" in swept.error[0] and np.isnan(swept.cycle_loss[0])
    for limit in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(pulloff.SpecError, match="row_limit"):
            pulloff.sweep(slow, row_limit=limit)


def test_a_sweep_is_a_mapping():
    swept = pulloff.sweep(SPEC)
    assert list(swept) == ["row", "gap.amplitude", "path.end_contact_radius", "last_contact_force", "snaps", "error"]
    assert "snaps" in swept and len(swept) == 6 and swept.row_count == 10 and dict(swept)["snaps"] is swept.snaps
    assert swept == pulloff.sweep(SPEC, jobs=2) and swept != pulloff.sweep(SPEC, shard=(1, 2))


ENSEMBLE = {
    "preset": "random-waves",
    "set": ["gap.count=6", "path.start_contact_radius=0.45", "gap.rms=0.0003"],
    "quantities": ["last_contact_force", "snaps"],
    "ensemble": {"members": 10, "seed": 7},
    "axis": [{"key": "material.work_of_adhesion", "values": [0.003, 0.004]}],
}


def test_an_ensemble_is_a_loop_over_its_surfaces():
    swept = pulloff.sweep(ENSEMBLE)
    members = swept.of_members
    assert swept.axes == ("material.work_of_adhesion",) and swept.row_count == 2 and members.row_count == 20
    seeds = members["gap.seed"].reshape(10, 2)
    assert (seeds[:, 0] == seeds[:, 1]).all() and len(set(seeds[:, 0])) == 10
    problem = pulloff.Problem(
        "random-waves", {"gap.count": 6, "path.start_contact_radius": 0.45, "gap.rms": 0.0003}
    )
    for point, adhesion in enumerate((0.003, 0.004)):
        forces = []
        for seed in seeds[:, 0]:
            one = problem.replace({"gap.seed": int(seed), "material.work_of_adhesion": adhesion})
            forces.append(one.unload(areas=False, admissibility=False, one_disc=True).before_force[-1])
        at = {name: swept[f"last_contact_force.{name}"][point] for name in ("mean", "sd", "q05", "q50", "q95")}
        assert at["mean"] == pytest.approx(np.mean(forces), rel=1e-12)
        assert at["sd"] == pytest.approx(np.std(forces, ddof=1), rel=1e-9)
        quantiles = np.quantile(forces, [0.05, 0.5, 0.95])
        assert [at["q05"], at["q50"], at["q95"]] == pytest.approx(quantiles, rel=1e-12)
    assert swept["members"].tolist() == [10, 10] and swept["refused"].tolist() == [0, 0]
    assert swept == pulloff.sweep(ENSEMBLE, jobs=2) and members != pulloff.sweep(ENSEMBLE, shard=(1, 2))


def test_parts_of_an_ensemble_are_joined(tmp_path):
    whole = pulloff.sweep(ENSEMBLE, out=tmp_path / "whole.csv")
    assert whole == pulloff.sweep(ENSEMBLE)
    parts = [tmp_path / f"{i}.csv" for i in (1, 2)]
    for i, part in enumerate(parts, 1):
        assert pulloff.sweep(ENSEMBLE, out=part, shard=(i, 2)).of_members is None
    pulloff.merge(parts, tmp_path / "all.csv")
    for ending in (".csv", ".csv.spec.toml", ".members.csv", ".members.csv.spec.toml"):
        assert (tmp_path / f"all{ending}").read_bytes() == (tmp_path / f"whole{ending}").read_bytes()
    assert pulloff.sweep(ENSEMBLE, out=tmp_path / "all.csv") == whole
    with pytest.raises(pulloff.OutputError, match="already exists"):
        pulloff.merge(parts, tmp_path / "all.csv")
    with pytest.raises(pulloff.OutputError, match="also read"):
        pulloff.merge([tmp_path / "all.csv"], tmp_path / "all.csv", overwrite=True)
    with pytest.raises(TypeError, match="list of files"):
        pulloff.merge(str(parts[0]), tmp_path / "one.csv")

