import builtins
import sys

import numpy as np
import pytest

import pulloff

afmformats = pytest.importorskip("afmformats")

#: In SI: a bead of 5 µm on rubber, on a cantilever.
RADIUS, MODULUS, GAMMA, STIFFNESS = 5e-6, 1.6e6, 60e-3, 0.5
SPHERE = f"""
units = "SI"
[material]
effective_modulus = "{MODULUS} Pa"
work_of_adhesion = "{GAMMA} J/m^2"
[gap]
shape = "sphere"
radius_of_curvature = "{RADIUS} m"
"""
FREE = ["material.effective_modulus", "material.work_of_adhesion", "data.offset"]


def jkr():
    """A loop over the way of the piezo: force in N, position in m, whether it goes apart."""
    s = np.linspace(3e-6, 0.8e-6, 300)
    delta = s**2 / RADIUS - np.sqrt(2 * np.pi * GAMMA * s / MODULUS)
    force = 4 / 3 * MODULUS * s**3 / RADIUS - np.sqrt(8 * np.pi * GAMMA * MODULUS * s**3)
    way = delta + force / STIFFNESS
    # Until the cantilever snaps off, and some way behind; on the way down from where the undeformed bodies touch.
    last = np.argmin(way)
    touching = np.flatnonzero((way > 0) & (np.arange(way.size) < last))[::-1]
    apart = way[last] - np.linspace(1e-8, 1e-6, 100)
    down = np.linspace(apart.min(), -1e-9, 100)
    position = np.concatenate([down, way[touching], way[: last + 1], apart])
    pull = np.concatenate([np.zeros(down.size), force[touching], force[: last + 1], np.zeros(apart.size)])
    return pull, position, np.arange(position.size) >= down.size + touching.size


@pytest.fixture
def file(tmp_path):
    """An HDF5 file of one curve, or of several, as afmformats writes them."""

    def written(curves=1):
        h5py = pytest.importorskip("h5py")
        force, position, back = jkr()
        path = tmp_path / "curve.h5"
        with h5py.File(path, "w") as out:
            for enum in range(curves):
                metadata = {
                    "path": path,
                    "enum": enum,
                    "imaging mode": "force-distance",
                    "spring constant": STIFFNESS,
                    "point count": force.size,
                }
                data = {"force": force, "height (measured)": -position, "segment": back}
                curve = afmformats.AFMForceDistance(data, metadata)
                curve.export_data(out, fmt="hdf5", metadata=True)
        return path

    return written


def test_a_file_of_a_microscope_gives_what_it_was_made_of(file):
    path = file()
    with pytest.raises(pulloff.DataError, match="read_afm"):
        pulloff.Problem(SPHERE).fit(path, FREE)
    curve = pulloff.read_afm(path)
    force, position, _ = jkr()
    assert np.array_equal(curve["force"], force) and np.array_equal(curve["position"], -position)
    assert np.array_equal(curve["segment"] == "retraction", jkr()[2])
    assert curve.settings == {"spring constant": STIFFNESS} and curve.metadata["point count"] == force.size
    start = pulloff.Problem(SPHERE).replace({"material.effective_modulus": 3 * MODULUS})
    found = start.fit(curve, FREE, sigma_x=1e-10, sigma_force=1e-9)
    assert found.problem["path.control.stiffness"] == STIFFNESS
    assert found.parameters["material.effective_modulus"] == pytest.approx(MODULUS, rel=1e-3)
    assert found.parameters["material.work_of_adhesion"] == pytest.approx(GAMMA, rel=1e-3)


def test_what_contradicts_the_problem_is_refused_with_both(file):
    path = file()
    stiff = pulloff.Problem(SPHERE + '[path]\ncontrol = {stiffness = "0.6 N/m"}\n')
    with pytest.raises(pulloff.DataError, match="0.5 N/m, and path.control.stiffness is 0.6 N/m"):
        stiff.fit(pulloff.read_afm(path), FREE)
    tip = pulloff.read_afm(path, metadata={"tip radius": 6e-6})
    with pytest.raises(pulloff.DataError, match="6 um, and gap.radius_of_curvature is 5 um"):
        pulloff.Problem(SPHERE).fit(tip, FREE)
    with pytest.raises(pulloff.DataError, match="SI"):
        pulloff.Problem("fig-9").fit(tip, FREE)


def test_a_map_wants_an_index_and_bad_files_are_refused(file, tmp_path):
    path = file(3)
    with pytest.raises(pulloff.DataError, match="3 curves: choose one with index=0 to 2"):
        pulloff.read_afm(path)
    assert pulloff.read_afm(path, 2).metadata["enum"] == 2
    for index in (-1, 3):
        with pytest.raises(pulloff.DataError, match="from 0 to 2"):
            pulloff.read_afm(path, index)
    broken = tmp_path / "broken.jpk-force"
    broken.write_bytes(b"PK\x03\x04 and no more")
    for bad in (broken, tmp_path / "none.ibw", tmp_path):
        with pytest.raises(pulloff.DataError):
            pulloff.read_afm(bad)


def test_the_package_to_install_is_named(monkeypatch):
    usual = builtins.__import__

    def without(name, *rest, **more):
        if name.startswith("afmformats"):
            raise ImportError(name)
        return usual(name, *rest, **more)

    for name in [name for name in sys.modules if name.startswith("afmformats")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match="pip install afmformats"):
        pulloff.read_afm("curve.ibw")
