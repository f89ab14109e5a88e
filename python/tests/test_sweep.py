import numpy as np
import pytest

import pulloff

AXIS = {"key": "gap.amplitude", "values": [1e-3, 2e-3, 3e-3]}


def test_rows_are_those_of_single_problems(fig_9):
    swept = pulloff.sweep(
        {"preset": "fig-9", "quantities": ["pull_off_force", "snaps", "pull_off_force_force"], "axis": [AXIS]}
    )
    assert swept.columns == ["row", "gap.amplitude", "pull_off_force", "snaps", "pull_off_force_force", "error"]
    assert swept.axes == ("gap.amplitude",)
    assert swept["gap.amplitude"].tolist() == AXIS["values"] and swept.row.tolist() == [0, 1, 2]
    assert swept.error.tolist() == [None] * 3
    for row, amplitude in enumerate(AXIS["values"]):
        problem = fig_9.replace({"gap.amplitude": amplitude})
        unloading = problem.unload()
        assert swept.pull_off_force[row] == unloading.before_force[-1]
        assert swept.snaps[row] == len(unloading) - 1
        assert swept.pull_off_force_force[row] == problem.unload("force").before_force[-1]


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
    assert one.to_dict() == four.to_dict() and len(one) == 20


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
        ({"preset": "fig-9", "axis": [AXIS], 3: 4}, "keys are texts"),
        ({"preset": "fig-9", "axis": [{"key": "gap.amplitude", "values": [-1.0]}]}, "out of range"),
        ("none.toml", "No such file"),
    ],
)
def test_refused_specs(spec, words):
    with pytest.raises(pulloff.SpecError, match=words):
        pulloff.sweep(spec)


def test_quantities_are_listed():
    names = [quantity.name for quantity in pulloff.quantities()]
    assert {"pull_off_force", "snaps", "cycle_loss"} <= set(names)
    assert pulloff.quantities()[0].of_control
    with pytest.raises(pulloff.SpecError, match="jobs"):
        pulloff.sweep({"preset": "fig-9", "axis": [AXIS]}, jobs=0)
