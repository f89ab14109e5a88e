import numpy as np
import pytest

import pulloff

GAMMA, MODULUS = 0.004, 1.3
SPHERE = pulloff.Problem(
    f"[material]\neffective_modulus={MODULUS}\nwork_of_adhesion={GAMMA}\n[gap]\nshape='wavy-sphere'\nradius_of_curvature=1\n"
    "amplitude=0\nwavelength=0.05\n[path]\nstart_contact_radius=0.4\n"
)


def points(radii=np.linspace(0.4, 0.2, 60)):
    """JKR's curve: (δ, P) by the contact radius."""
    s = np.asarray(radii)
    delta = s**2 - np.sqrt(2 * np.pi * GAMMA * s / MODULUS)
    force = 4 / 3 * MODULUS * s**3 - np.sqrt(8 * np.pi * GAMMA * MODULUS * s**3)
    return {"approach": delta, "force": force}


def test_the_truth_is_found_from_afar(tmp_path):
    afar = SPHERE.replace({"material.effective_modulus": 0.7, "material.work_of_adhesion": 0.01})
    free = ["material.effective_modulus", "material.work_of_adhesion"]
    found = afar.fit(points(), free, sigma_x=1e-4, sigma_force=1e-5)
    assert found.values["material.effective_modulus"] == pytest.approx(MODULUS, rel=1e-5)
    assert found.values["material.work_of_adhesion"] == pytest.approx(GAMMA, rel=1e-5)
    assert found.problem["material.work_of_adhesion"] == found.values["material.work_of_adhesion"]
    assert found.key.tolist() == free and set(found.errors) == set(free)
    assert found.to_dict()["schema"] == 1 and found.to_dict()["determined"]
    file = tmp_path / "curve.csv"
    table = points()
    rows = zip(table["approach"].tolist(), table["force"].tolist())
    file.write_text("approach,force\n" + "".join(f"{x!r},{p!r}\n" for x, p in rows))
    assert afar.fit(file, free, sigma_x=1e-4, sigma_force=1e-5).values == found.values


def test_what_is_not_determined_is_said():
    free = ["material.effective_modulus", "material.work_of_adhesion", "gap.radius_of_curvature"]
    with pytest.raises(pulloff.NotDetermined) as caught:
        SPHERE.fit(points(), free, sigma_x=1e-4, sigma_force=1e-5)
    assert "only" in str(caught.value) and np.isnan(caught.value.result.standard_error).any()


@pytest.mark.parametrize(
    "data, free",
    [
        ({}, ["material.work_of_adhesion"]),
        ({"approach": [1.0, 2.0], "force": [1.0]}, ["material.work_of_adhesion"]),
        ({"approach": [[1.0]], "force": [[1.0]]}, ["material.work_of_adhesion"]),
        ({"approach": [0.1, 0.2], "force": [0.1, 0.2]}, ["material.work_of_adhesion"]),
        (points(), []),
        (points(), ["gap.shape"]),
        (points(), ["nothing"]),
        ("none.csv", ["material.work_of_adhesion"]),
        ("\x00", ["material.work_of_adhesion"]),
    ],
)
def test_refused_data(data, free):
    with pytest.raises(pulloff.DataError):
        SPHERE.fit(data, free)
