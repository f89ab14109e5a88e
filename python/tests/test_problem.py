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
    assert len(pulloff.Problem(tmp_path / "p.toml").unload()) == 1
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
        ({1: 1.0}, None, "texts"),
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
    assert unloading.kind.tolist() == ["pull-off"]
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
    assert ours.kind.tolist() == exact.kind.tolist() and len(ours) > 3
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
