import functools

import numpy as np
import pytest

import pulloff

TEXT = """
[material]
effective_modulus = 1.0
work_of_adhesion = 0.004

[gap]
shape = "wavy-sphere"
radius_of_curvature = 1.0
amplitude = 0.0025
wavelength = 0.05

[path]
start_contact_radius = 0.3
"""


def test_every_shipped_preset_is_a_problem():
    names = pulloff.presets()
    assert "fig-9" in names and len(names) > 10
    for name, title in names.items():
        assert pulloff.Problem(name).title == title


def test_sources(tmp_path):
    problem = pulloff.Problem(TEXT)
    file = tmp_path / "mine.toml"
    file.write_text(TEXT)
    assert pulloff.Problem(file) == problem == pulloff.Problem(str(file))
    assert pulloff.Problem(problem.to_toml()) == problem
    assert problem["gap.amplitude"] == 0.0025
    assert hash(problem) == hash(pulloff.Problem(TEXT))
    with pytest.raises(pulloff.PresetError, match="did you mean fig-9"):
        pulloff.Problem("fig9")
    with pytest.raises(pulloff.PresetError, match="not a regular file"):
        pulloff.Problem(tmp_path)
    with pytest.raises(pulloff.PresetError, match="No such file"):
        pulloff.Problem("./none.toml")


def test_a_profile_beside_its_preset_is_read(tmp_path):
    r = np.linspace(0.0, 1.0, 40)
    rows = "\n".join(f"{x},{x * x / 2}" for x in r.tolist())
    (tmp_path / "scan.csv").write_text(f"r,h\n{rows}\n")
    text = "[material]\neffective_modulus=1\nwork_of_adhesion=0.01\n[gap]\nshape='profile'\nfile='scan.csv'\n[path]\nstart_contact_radius=0.4\n"
    (tmp_path / "p.toml").write_text(text)
    assert pulloff.Problem(tmp_path / "p.toml").unload().row_count == 1
    (tmp_path / "p.toml").write_text(text.replace("scan", "none"))
    with pytest.raises(pulloff.PresetError) as caught:
        pulloff.Problem(tmp_path / "p.toml")
    assert caught.value.key == "gap.file" and caught.value.line == 6


def test_changes_are_checked_as_a_whole(fig_9):
    changed = fig_9.replace({"gap.amplitude": 3e-3, "path.control": "force"})
    assert changed["gap.amplitude"] == 3e-3 and changed["path.control"] == "force"
    assert fig_9["gap.amplitude"] == 0.0025
    assert pulloff.Problem("fig-9", {"gap.amplitude": 3e-3, "path.control": "force"}) == changed
    assert fig_9.replace({"gap.amplitude": np.float64(1e-3)})["gap.amplitude"] == 1e-3
    assert fig_9.replace({"basis.rings": np.int64(50)})["basis.rings"] == 50
    assert fig_9.replace({"path.control": "stiffness=0.15"})["path.control"] == "stiffness=0.15"
    si = pulloff.Problem("fig-9-si")
    assert si.replace({"gap.amplitude": "3 um"})["gap.amplitude"] == 3e-6


@pytest.mark.parametrize(
    "changes, key, words",
    [
        ({"gap.amplitude": -1.0}, "gap.amplitude", "out of range"),
        ({"gap.amplitude": float("nan")}, "gap.amplitude", "gap.amplitude"),
        ({"gap.amplitude": True}, "gap.amplitude", "not bool"),
        ({"gap.amplitude": None}, "gap.amplitude", "not NoneType"),
        ({"gap.amplitude": [1.0]}, "gap.amplitude", "not list"),
        ({"gap.amplitud": 1.0}, None, "did you mean gap.amplitude"),
        ({"path.control": "sideways"}, "path.control", "sideways"),
        ({1: 1.0}, None, "strings"),
    ],
)
def test_refused_values_say_their_key(fig_9, changes, key, words):
    with pytest.raises(pulloff.PresetError, match=words) as caught:
        fig_9.replace(changes)
    assert caught.value.key == key
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, pulloff.Error)


def test_a_mistake_says_its_line_and_all_are_told():
    with pytest.raises(pulloff.PresetError) as caught:
        pulloff.Problem(TEXT.replace("0.0025", "-1").replace("wavelength = 0.05", "wavelength = 0"))
    assert caught.value.key == "gap.amplitude" and caught.value.line == 9
    assert [mistake[:2] for mistake in caught.value.mistakes] == [(9, "gap.amplitude"), (10, "gap.wavelength")]


def test_arrays_are_a_gap():
    r = np.linspace(0.0, 1.0, 400)
    of = dict(effective_modulus=1.0, work_of_adhesion=0.004, start_contact_radius=0.3)
    unloading = pulloff.Problem.from_gap(r, r**2 / 2, **of).unload()
    # JKR's smooth sphere under given approach lets go at δ = −¾ (π²γ²R/E*²)^(1/3).
    expected = -0.75 * (np.pi**2 * 0.004**2) ** (1 / 3)
    assert unloading.kind.tolist() == ["last-contact"]
    assert unloading.before_approach[0] == pytest.approx(expected, rel=1e-8)
    si = pulloff.Problem.from_gap(
        r * 1e-3, r**2 / 2 * 1e-3, effective_modulus=1e6, work_of_adhesion=0.05, start_contact_radius=1e-4, units="SI"
    )
    assert not any("names no unit" in note for note in si.trace().to_dict()["notes"])
    for rows in [(r[::-1], r**2), (r, r[:-1]), (r[:3], r[:3]), (r, np.full_like(r, np.nan)), (r[None], r[None])]:
        with pytest.raises(pulloff.PresetError):
            pulloff.Problem.from_gap(*rows, **of)


def test_a_function_is_certified_or_refused():
    of = dict(effective_modulus=1.0, work_of_adhesion=0.004, start_contact_radius=0.3)
    calls = []

    def wavy(r):
        calls.append(r.size)
        return r**2 / 2 + 0.0025 * (1 - np.cos(2 * np.pi * r / 0.05))

    problem = pulloff.Problem.from_gap(0.8, wavy, **of)
    formula = pulloff.Problem(TEXT, {"material.work_of_adhesion": 0.004})
    before = len(calls)
    ours, exact = problem.unload(), formula.unload()
    assert len(calls) == before, "it is sampled once"
    assert ours.kind.tolist() == exact.kind.tolist() and ours.row_count > 3
    assert ours.before_force == pytest.approx(exact.before_force, rel=1e-5)
    for refused in (lambda r: np.abs(r), lambda r: r**2 / 2 + 1e-3 * np.cos(2e4 * r)):
        with pytest.raises(pulloff.NotCertified) as caught:
            pulloff.Problem.from_gap(0.8, refused, **of)
        assert 0.0 <= caught.value.radius <= 0.8 and caught.value.difference > 0.0
    for wrong in (lambda r: r[:-1], lambda r: r * np.nan, lambda r: "text"):
        with pytest.raises(ValueError):
            pulloff.Problem.from_gap(0.8, wrong, **of)
    with pytest.raises(ZeroDivisionError):
        pulloff.Problem.from_gap(0.8, lambda r: 1 / 0, **of)


OF = dict(effective_modulus=1.0, work_of_adhesion=0.004, start_contact_radius=0.3)
R = np.linspace(0.0, 1.0, 200)


def test_problems_are_equal_where_all_their_data_are():
    ours = [
        pulloff.Problem.from_gap(R, R**2 / 2, **OF),
        pulloff.Problem.from_gap(R, R**2 / 3, **OF),
        pulloff.Problem.from_gap(R, np.where(R == R[100], R**2 / 2 + 1e-9, R**2 / 2), **OF),
        pulloff.Problem.from_gap(R[:-1], R[:-1] ** 2 / 2, **OF),
        pulloff.Problem.from_gap(0.8, lambda r: r**2 / 2, **OF),
    ]
    for i, a in enumerate(ours):
        for j, b in enumerate(ours):
            assert (a == b) == (i == j) and (hash(a) == hash(b)) == (i == j)
    again = pulloff.Problem.from_gap(R.copy(), R**2 / 2, **OF)
    assert again == ours[0] and hash(again) == hash(ours[0]) and {again: 1}[ours[0]] == 1
    assert ours[0] != "text" and ours[0] != ours[0].to_toml()
    calls = []

    @functools.lru_cache
    def pull_off(problem):
        calls.append(problem)
        return problem.unload("force", areas=False, admissibility=False).before_force[-1]

    forces = [pull_off(problem) for problem in (ours[0], ours[1], again)]
    assert forces[0] != forces[1] and forces[2] == forces[0] and len(calls) == 2
    # 1.5 π γ R of a sphere.
    assert forces[:2] == pytest.approx([-1.5 * np.pi * 0.004, -1.5 * np.pi * 0.004 * 1.5], rel=1e-4)


def test_problems_with_other_curves_are_others(tmp_path):
    rows = "\n".join(f"{0.01 * i},{0.001 * i}" for i in range(20))
    made = []
    for name, more in (("a.csv", ""), ("b.csv", ""), ("c.csv", "\n0.5,0.9")):
        (tmp_path / name).write_text(f"approach,force\n{rows}{more}\n")
        (tmp_path / "p.toml").write_text(TEXT + f"[data]\nfile = '{name}'\n")
        made.append(pulloff.Problem(tmp_path / "p.toml"))
    # The same points from another file are the same.
    assert made[0] == made[1] and hash(made[0]) == hash(made[1])
    assert made[2] != made[0] and hash(made[2]) != hash(made[0])


def test_every_problem_opens_again_from_its_text(tmp_path, monkeypatch):
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "scan.csv").write_text("r [um], h [nm]\n" + "\n".join(f"{x},{x * x}" for x in range(40)))
    preset = TEXT[: TEXT.index("[gap]")].replace("\n", "\nunits = 'SI'\n", 1) + (
        "[gap]\nshape = 'profile'\nfile = 'scan.csv'\n[path]\nstart_contact_radius = '15 um'\n"
    )
    (tmp_path / "data" / "p.toml").write_text(preset.replace("= 1.0", "= '1 MPa'"))
    every = [pulloff.Problem(name) for name in pulloff.presets()]
    every += [
        pulloff.Problem(tmp_path / "data" / "p.toml"),
        pulloff.Problem.from_gap(R, R**2 / 2, **OF),
        pulloff.Problem.from_gap(R * 1e-3, R**2 / 2e3, units="SI", **{**OF, "start_contact_radius": 3e-4}),
    ]
    monkeypatch.chdir(tmp_path)
    for number, problem in enumerate(every):
        text = problem.to_toml()
        assert pulloff.Problem(text) == problem, problem
        file = tmp_path / "saved" / f"n{number}.toml"
        file.parent.mkdir(exist_ok=True)
        problem.save(file)
        assert pulloff.Problem(file) == problem, problem
        with pytest.raises(pulloff.OutputError, match="overwrite=True replaces it"):
            problem.save(file)
        problem.save(file, overwrite=True)
        assert pulloff.Problem(str(file)) == problem
        # By hand: the files under the names that the text has for them.
        folder = tmp_path / f"by-hand-{number}"
        folder.mkdir()
        for name, content in text.files.items():
            (folder / name).write_bytes(content)
        (folder / "p.toml").write_text(text)
        assert pulloff.Problem(folder / "p.toml") == problem
    arrays = every[-2]
    assert list(arrays.to_toml().files) == ["arrays"] and (tmp_path / "saved").exists()
    with pytest.raises(pulloff.OutputError):
        arrays.save(tmp_path / "no folder" / "x.toml")


def test_repr_says_what_was_changed(fig_9, tmp_path):
    assert repr(fig_9) == "pulloff.Problem('fig-9')"
    changed = fig_9.replace({"gap.amplitude": 3e-3}).replace({"path.control": "force"})
    assert repr(changed) == "pulloff.Problem('fig-9', {'gap.amplitude': 0.003, 'path.control': 'force'})"
    assert eval(repr(changed)) == changed
    assert repr(changed.replace({"gap.amplitude": 0.0025, "path.control": "displacement"})) == repr(fig_9)
    fig_9.save(tmp_path / "mine.toml")
    mine = pulloff.Problem(tmp_path / "mine.toml", {"gap.amplitude": 1e-3})
    assert eval(repr(mine)) == mine and "mine.toml" in repr(mine)
    arrays = pulloff.Problem.from_gap(R, R**2 / 2, **OF).replace({"material.work_of_adhesion": 0.01})
    assert "from_gap" in repr(arrays) and "{'material.work_of_adhesion': 0.01}" in repr(arrays)
    assert "a text" in repr(pulloff.Problem(TEXT)) and "{" not in repr(pulloff.Problem(TEXT))


def test_arrays_of_any_make_are_taken():
    wanted = pulloff.Problem.from_gap(R, R**2 / 2, **OF)
    record = np.zeros(R.size, dtype=np.dtype([("flag", "i1"), ("r", "f8"), ("h", "f8")]))
    record["r"], record["h"] = R, R**2 / 2
    assert not record["r"].flags.aligned
    other = np.stack([R, R**2 / 2])
    for r, h in [
        (record["r"], record["h"]),
        (np.asfortranarray(other)[0], other.T[:, 1]),
        (R.astype(">f8"), (R**2 / 2).astype(">f8")),
        (R.tolist(), tuple((R**2 / 2).tolist())),
        (R[::-1][::-1], np.ma.masked_array(R**2 / 2)),
    ]:
        assert pulloff.Problem.from_gap(r, h, **OF) == wanted
    pressure = wanted.pressure(0.2, record["r"])
    assert np.array_equal(pressure, wanted.pressure(0.2, R), equal_nan=True)


def test_arguments_are_refused_by_their_names():
    problem = pulloff.Problem("wavy-sphere")
    for call, name in [
        (lambda: problem.unload(one_disc="no"), "one_disc"),
        (lambda: problem.trace(theory=1), "theory"),
        (lambda: problem.unload(control=np.True_), "control"),
        (lambda: problem.cycle(to_force=True), "to_force"),
        (lambda: problem.pull(rate=True), "rate"),
        (lambda: problem.pull(hold_force=-1e-3 + 1j), "hold_force"),
        (lambda: problem.stability(samples=2.5), "samples"),
        (lambda: problem.map(("gap.amplitude", 1e-3, 2e-3), cells=(4.5, 4)), "cells"),
        (lambda: problem.pressure("x", [0.1]), "s ="),
        (lambda: problem.fit({}, free=1), "free"),
        (lambda: problem.fit({}, uncertain="x"), "uncertain"),
        (lambda: problem.save(""), "path"),
        (lambda: problem.replace("x"), "changes"),
        (lambda: pulloff.Problem(b"x"), "source"),
        (lambda: pulloff.sweep({"preset": problem}, resume=None), "resume"),
        (lambda: pulloff.fit_together("x"), "problems"),
    ]:
        with pytest.raises(pulloff.ArgumentError, match=name):
            call()
    with pytest.raises(pulloff.PresetError, match="gap.amplitude"):
        problem.replace({"gap.amplitude": np.True_})


def test_a_text_is_read_in_the_unit_of_its_parameter():
    text = (
        "units = 'SI'\n[material]\neffective_modulus=1e6\nwork_of_adhesion=0.05\n[gap]\nshape='formula'\n"
        "formula='r^2/(2*R)+A*(1-cos(2*pi*r/L))'\n[gap.parameters]\nA={value=50,unit='nm'}\nR={value=1,unit='mm'}\n"
        "L={value=20,unit='um'}\n[path]\nstart_contact_radius=8e-5\n"
    )
    problem = pulloff.Problem(text)
    assert problem.replace({"gap.parameters.A": "60"})["gap.parameters.A"] == pytest.approx(60e-9)
    assert problem.replace({"gap.parameters.A": "60 nm"})["gap.parameters.A"] == pytest.approx(60e-9)
    # Numbers go out and in alike.
    assert problem.replace({"gap.parameters.A": problem["gap.parameters.A"]}) == problem
