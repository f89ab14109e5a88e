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
    assert found.parameters["material.effective_modulus"] == pytest.approx(MODULUS, rel=1e-5)
    assert found.parameters["material.work_of_adhesion"] == pytest.approx(GAMMA, rel=1e-5)
    assert found.problem["material.work_of_adhesion"] == found.parameters["material.work_of_adhesion"]
    # No row is apart: the baseline is fitted too.
    assert found.key.tolist() == [*free, "data.baseline"] and set(found.errors) == {*free, "data.baseline"}
    assert found.to_dict()["schema"] == 1 and found.to_dict()["determined"]
    file = tmp_path / "curve.csv"
    table = points()
    rows = zip(table["approach"].tolist(), table["force"].tolist())
    file.write_text("approach,force\n" + "".join(f"{x!r},{p!r}\n" for x, p in rows))
    assert afar.fit(file, free, sigma_x=1e-4, sigma_force=1e-5).parameters == found.parameters


SIGMA = dict(sigma_x=1e-4, sigma_force=1e-5)
FREE = ["material.effective_modulus", "material.work_of_adhesion"]


def test_points_from_everywhere(tmp_path):
    pandas = pytest.importorskip("pandas")
    afar = SPHERE.replace({"material.effective_modulus": 0.9, "material.work_of_adhesion": 0.006})
    wanted = afar.fit(points(), FREE, **SIGMA)
    frame = pandas.DataFrame(points())
    frame["note, with a comma"] = ["said \"so\", he"] * len(frame)
    frame["empty"] = None
    assert afar.fit(frame, FREE, **SIGMA).parameters == wanted.parameters
    assert afar.fit(frame[["note, with a comma", "force", "approach"]], FREE, **SIGMA).parameters == wanted.parameters
    renamed = frame.rename(columns={"approach": "way", "force": "pull"})
    assert afar.fit(renamed, FREE, columns="x=way,force=pull", **SIGMA).parameters == wanted.parameters
    assert afar.fit(renamed, FREE, columns="x=1,force=2", **SIGMA).parameters == wanted.parameters
    # A curve of ours, and the problem's own.
    curve = SPHERE.trace()
    assert afar.fit(curve, FREE, **SIGMA).parameters["material.work_of_adhesion"] == pytest.approx(GAMMA, rel=1e-5)
    frame[["approach", "force"]].to_csv(tmp_path / "curve.csv", index=False)
    text = afar.to_toml() + "[data]\nfile = 'curve.csv'\nfree = 'E*, gamma'\n"
    (tmp_path / "own.toml").write_text(text.replace("free = 'E*, gamma'", f"free = '{','.join(FREE)}'"))
    own = pulloff.Problem(tmp_path / "own.toml")
    assert own.fit(**SIGMA).parameters == wanted.parameters
    only = own.fit(free="material.work_of_adhesion", **SIGMA)
    assert list(only.parameters) == ["material.work_of_adhesion", "data.baseline"]


def test_units_stand_in_the_names_of_columns():
    si = SPHERE.replace({"units": "SI", "material.effective_modulus": "1.3 MPa", "material.work_of_adhesion": "50 mJ/m^2",
                         "gap.radius_of_curvature": "1 mm", "gap.wavelength": "50 um", "path.start_contact_radius": "0.3 mm"})
    curve = si.trace()
    bare = si.fit({"approach": curve.approach, "force": curve.force}, FREE, sigma_x=1e-9, sigma_force=1e-8)
    named = si.fit({"approach [um]": curve.approach * 1e6, "force [mN]": curve.force * 1e3}, FREE, sigma_x=1e-9, sigma_force=1e-8)
    assert bare.parameters["material.work_of_adhesion"] == pytest.approx(0.05, rel=1e-6)
    for key, value in bare.parameters.items():
        assert named.parameters[key] == pytest.approx(value, rel=1e-6)
    assert bare.unit.tolist() == ["Pa", "J/m2"] or bare.unit[0] == "Pa"


def fitted_rows(found):
    return sum(found.rows[way][part] for way in ("approach", "retraction") for part in ("contact", "free"))


def test_rows_are_mended_by_hand():
    whole = points()
    cut = {name: np.concatenate([[7.0, -3.0], values]) for name, values in whole.items()}
    mended = SPHERE.fit(cut, FREE, skip=2, **SIGMA)
    assert mended.parameters["material.work_of_adhesion"] == pytest.approx(GAMMA, rel=1e-4)
    assert fitted_rows(mended) == 60 and mended.problem.to_dict()["data.skip"] == 2
    flipped = {**whole, "approach": -whole["approach"]}
    turned = SPHERE.fit(flipped, FREE, signs="x=-,force=+", **SIGMA)
    assert turned.parameters == pytest.approx(SPHERE.fit(whole, FREE, signs="x=+,force=+", **SIGMA).parameters, rel=1e-6)
    none = SPHERE.fit(whole, FREE, free_part="none", **SIGMA)
    assert none.rows["approach"]["free"] + none.rows["retraction"]["free"] == 0
    for wrong in ({"signs": "x=-"}, {"signs": "up"}, {"skip": -1}, {"skip": 1.5}, {"free_part": (1.0, 0.0)},
                  {"free_part": "x"}, {"free_part": (90.0, 91.0)}):
        with pytest.raises((pulloff.DataError, pulloff.ArgumentError)):
            SPHERE.fit(whole, FREE, **wrong, **SIGMA)


def test_ranges_and_segments():
    whole = points()
    near = SPHERE.fit(whole, FREE, x_range=(None, 0.05), **SIGMA)
    assert near.residuals.x.max() <= 0.05 and fitted_rows(near) < len(whole["force"]) == fitted_rows(SPHERE.fit(whole, FREE, **SIGMA))
    # Forces of one sign do not tell the baseline from the work of adhesion.
    with pytest.raises(pulloff.NotDetermined):
        SPHERE.fit(whole, FREE, force_range=(0.0, None), **SIGMA)
    pulled = SPHERE.replace({"data.baseline": 0.0}).fit(whole, FREE, force_range=(0.0, None), **SIGMA)
    assert pulled.residuals.force.min() >= 0.0 and sum(pulled.rows[way]["dropped"] for way in ("approach", "retraction")) > 0
    both = {name: np.concatenate([values[::-1], values]) for name, values in whole.items()}
    both["segment"] = np.array(["approach"] * 60 + ["retraction"] * 60)
    both["force"][:60] += 1.0
    back = SPHERE.fit(both, FREE, segment="retraction", **SIGMA)
    assert set(back.residuals.segment) == {"retraction"}
    assert back.parameters["material.work_of_adhesion"] == pytest.approx(GAMMA, rel=1e-4)
    for wrong in ({"x_range": (1.0, 0.0)}, {"x_range": 3}, {"force_range": (np.nan, 1)}, {"x_range": "ab"}, {"segment": "up"},
                  {"poisson": 0.7}, {"sigma_x": 0.0}, {"seed": -1, "bootstrap": 20}, {"bootstrap": 3}):
        with pytest.raises(pulloff.DataError):
            SPHERE.fit(whole, FREE, **wrong)


def test_models_are_compared():
    afar = SPHERE.replace({"material.effective_modulus": 0.9, "material.work_of_adhesion": 0.006})
    noise = np.random.default_rng(3).normal(0.0, 2e-5, (2, 60))
    data = points()
    data = {"approach": data["approach"] + noise[0], "force": data["force"] + noise[1]}
    one = afar.fit(data, FREE, model="short-range")
    assert one.models is None and one.model == "short-range"
    both = afar.fit(data, FREE, model=["short-range", "dugdale"])
    assert both.models["best"] == "short-range" and both.parameters == one.parameters
    assert [fit["model"] for fit in both.models["fits"]] == ["short-range", "dugdale"]
    (pair,) = both.models["pairs"]
    assert pair["models"] == ["short-range", "dugdale"] and isinstance(pair["told_apart"], bool)
    for wrong in ("dmt", ["short-range", "dmt"]):
        with pytest.raises(pulloff.DataError, match="dmt.* is not one of short-range, dugdale"):
            afar.fit(data, FREE, model=wrong)


def test_what_a_fit_has():
    found = SPHERE.fit(points(), FREE, poisson=0.5, **SIGMA)
    beside = found.residuals
    assert {"row", "segment", "part", "x", "force", "residual", "outlier"} <= set(beside)
    assert beside.row_count == fitted_rows(found) == 60 and beside.outlier.dtype == np.bool_ and np.abs(beside.residual).max() < 1.0
    assert beside.x.tolist() == points()["approach"].tolist()
    assert found.chi_squared == found.to_dict()["chi_squared"] and found.determined is True
    assert found.youngs_modulus[0] == pytest.approx(0.75 * MODULUS, rel=1e-4)
    assert "material.work_of_adhesion" in found.parameters and "value" in found and dict(found)["value"] is found.value
    with pytest.raises(AttributeError):
        found.nothing
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = found.plot()
    drawn, line = axes.lines[0].get_xydata(), axes.lines[-1].get_xydata()
    assert len(drawn) == 60 and found.plot(axes) is axes and "approach" in axes.get_xlabel()
    # The points lie on the line.
    order = np.argsort(line[:, 0])
    upper = drawn[drawn[:, 0] > 0.0]
    on = np.interp(upper[:, 0], line[order, 0], line[order, 1])
    assert np.abs(on - upper[:, 1]).max() < 1e-2 * np.ptp(drawn[:, 1])
    matplotlib.pyplot.close("all")


def test_a_spring_is_drawn_over_its_position():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    k, soft = 0.5, SPHERE.replace({"path.control": "stiffness=0.5"})
    table = points()
    position = table["approach"] + table["force"] / k + 0.01
    found = soft.fit({"position": position, "force": table["force"]}, ["material.work_of_adhesion", "data.offset"], **SIGMA)
    assert found.parameters["data.offset"] == pytest.approx(0.01, abs=1e-5)
    axes = found.plot()
    drawn, line = axes.lines[0].get_xydata(), axes.lines[-1].get_xydata()
    assert axes.get_xlabel().startswith("position")
    expected = table["approach"] + table["force"] / k
    assert drawn[:, 0] == pytest.approx(expected, abs=1e-5)
    # Within half a step of the line; without P/k it would be ten times as far.
    assert np.min(np.hypot(*(line - drawn[10]).T)) < 1e-2
    matplotlib.pyplot.close("all")


def test_sentences_name_the_arguments_of_python():
    zero = pulloff.Problem("wavy-sphere", {"gap.amplitude": 0.0})
    said = []
    for problem, data, arguments in [
        (SPHERE, points(), dict(free=[])),
        (SPHERE, None, dict(free=FREE)),
        (SPHERE, points(), dict(free=["nothing"])),
        (zero, points(), dict(free=["gap.amplitude"])),
        (SPHERE, points(), dict(free=[*FREE, "material.closing_work_of_adhesion"])),
        (SPHERE, {"a": [1.0] * 9, "b": [2.0] * 9}, dict(free=FREE)),
        (SPHERE, points(), dict(free=FREE, columns="nothing")),
        (SPHERE, points(), dict(free=FREE, columns="x=7,force=2")),
    ]:
        with pytest.raises(pulloff.DataError) as caught:
            problem.fit(data, **arguments)
        said.append(str(caught.value))
    assert not any("--" in sentence for sentence in said), said
    for sentence, word in zip(said, ["free=[", "data", "free key nothing", "first guess", "both an approach and a retraction", "columns"]):
        assert word in sentence, said
    assert "--" not in "".join(SPHERE.fit(points(), FREE, **SIGMA).warnings)


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
        (3.0, ["material.work_of_adhesion"]),
        (["approach", "force"], ["material.work_of_adhesion"]),
        ({"approach": [None] * 9, "force": ["x"] * 9}, ["material.work_of_adhesion"]),
        ({"approach": [np.nan] * 9, "force": [1.0] * 9}, ["material.work_of_adhesion"]),
    ],
)
def test_refused_data(data, free):
    with pytest.raises(pulloff.DataError):
        SPHERE.fit(data, free)


def test_what_is_known_with_an_error_is_in_the_errors():
    problem = pulloff.Problem("lens")
    held = problem.fit(free=["E*", "gamma", "data.offset"])
    given = {"gap.radius_of_curvature": "3 %"}
    known = problem.fit(free=["E*", "gamma", "data.offset"], uncertain=given)
    for key in ("material.effective_modulus", "material.work_of_adhesion"):
        assert known.errors[key] > 1.2 * held.errors[key]
    [prior] = known.to_dict()["priors"]
    assert prior["key"] == "gap.radius_of_curvature"
    assert prior["standard_error"] == pytest.approx(0.03 * prior["value"])
    with pytest.raises(pulloff.DataError, match="did you mean gap.radius_of_curvature"):
        problem.fit(free=["E*"], uncertain={"gap.radius_of_curvatre": "3 %"})


def test_one_law_for_two_curves():
    lens = pulloff.Problem("lens")
    free = ["E*", "gamma", "data.offset"]
    branches = [lens.replace({"data.segment": segment}) for segment in ("approach", "retraction")]
    alone = [branch.fit(free=free) for branch in branches]
    both = pulloff.fit_together(branches, free)
    assert both.collapse["collapses"] and both.verdict == "describes"
    assert set(both.parameters) == {"material.effective_modulus", "material.work_of_adhesion"}
    for key, value in both.parameters.items():
        least = min(fit.errors[key] for fit in alone)
        assert both.errors[key] < least
        for fit in alone:
            assert abs(value - fit.parameters[key]) < 4.0 * fit.errors[key]
    assert [run["fit"]["verdict"] for run in both.runs] == ["describes"] * 2
    assert [run["alone_verdict"] for run in both.runs] == [fit.verdict for fit in alone]
    assert both.problem["material.work_of_adhesion"] == pytest.approx(both.parameters["material.work_of_adhesion"])
    with pytest.raises(pulloff.DataError, match="two problems or more"):
        pulloff.fit_together([lens], free)
    with pytest.raises(pulloff.DataError, match="given twice"):
        pulloff.fit_together([lens, lens], free)
    with pytest.raises(pulloff.DataError, match="reduced units"):
        pulloff.fit_together([lens, SPHERE], free)


def test_a_column_has_the_unit_of_its_name_as_in_a_file(tmp_path):
    si = "units = 'SI'\n[material]\neffective_modulus=%r\nwork_of_adhesion=%r\n[gap]\nshape='sphere'\nradius_of_curvature=0.01\n"
    truth = pulloff.Problem(si % (1e6, 1e-3) + "[path]\nstart_contact_radius=1.2e-4\n").trace()
    guess = pulloff.Problem(si % (1.2e6, 8e-4) + "[path]\nstart_contact_radius=2e-4\n")
    for head, x in (("approach [in]", truth.approach), ("radius [in]", truth.contact_radius), ("approach, in", truth.approach)):
        columns = {head: x / 0.0254, "force [uN]": truth.force * 1e6}
        found = guess.fit(columns, FREE).parameters
        assert found["material.effective_modulus"] == pytest.approx(1e6, rel=1e-4), head
    with pytest.raises(pulloff.DataError, match="unit"):
        guess.fit({"approach [s]": truth.approach, "force": truth.force}, FREE)
