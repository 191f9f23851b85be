"""The module against numbers that were computed elsewhere, and against itself."""

import math
import random
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

import oedometer

numpy = pytest.importorskip("numpy")
ROOT = Path(__file__).resolve().parent.parent.parent


def isochrone(zeta, time_factor):
    """Terzaghi's series, incompressible water."""
    terms = ((2 * m + 1) * math.pi / 2 for m in range(200))
    return sum(2 / k * math.sin(k * zeta) * math.exp(-k * k * time_factor) for k in terms)


def test_exact_is_terzaghis_series_in_the_shape_that_was_asked_for():
    times, depths = [0.05, 0.2], numpy.linspace(0.0, 1.0, 5)
    found = oedometer.exact("terzaghi-incompressible", times, depths, load=3.0, height=2.0)
    assert found.pressure.shape == (2, 5) and found.settlement.shape == (2,)
    assert (found.height, found.load) == (2.0, 3.0)
    for at, time in enumerate(times):
        for place, depth in enumerate(depths):
            assert found.pressure[at, place] == pytest.approx(3.0 * isochrone(depth, time), abs=1e-12)
    one = oedometer.exact("terzaghi-incompressible", 0.05, 0.5)
    assert isinstance(one.pressure, float) and one.pressure == pytest.approx(isochrone(0.5, 0.05), abs=1e-12)
    # γ_w H²/(k E_oed)
    assert one.time == pytest.approx(0.05 * 9810 / (1e-4 * 1.2e6), rel=1e-12)
    softer = oedometer.exact("terzaghi-incompressible", 0.05, 0.5, youngs_modulus=5e5)
    assert softer.time == pytest.approx(2 * one.time) and softer.settlement == pytest.approx(2 * one.settlement)


def test_without_numpy_lists_have_the_same_shape(monkeypatch):
    arrays = oedometer.exact("terzaghi", [0.05, 0.2], [0.25, 0.5, 0.75])
    monkeypatch.setattr(oedometer, "_numpy", None)
    lists = oedometer.exact("terzaghi", (0.05, 0.2), [0.25, 0.5, 0.75])
    assert lists.pressure == arrays.pressure.tolist() and lists.time == arrays.time.tolist()
    assert isinstance(oedometer.exact("terzaghi", 0.05, 0.5).pressure, float)
    score = oedometer.score("terzaghi", time=lists.time, height=[0.75, 0.5, 0.25], pressure=lists.pressure)
    assert score.error("pressure", 0.05) < 1e-12
    with pytest.raises(ValueError, match="differ in length"):
        oedometer.score("terzaghi", time=[1.0, 2.0], height=[0.5], pressure=[[1.0], [1.0, 2.0]])


def test_a_score_is_what_the_result_is_off_by():
    depths = (numpy.arange(20) + 0.5) / 20
    found = oedometer.exact("terzaghi", [0.1, 0.2], depths, load=1000.0)
    given = dict(time=found.time, height=1 - depths, sample="centres", load=1000.0)
    clean = oedometer.score("terzaghi", pressure=found.pressure, settlement=found.settlement, **given)
    assert all(abs(row["value"]) < 1e-9 for row in clean.errors.rows() if row["reference"] == "terzaghi")
    assert clean.error("settlement", 0.1) == pytest.approx(0.0, abs=1e-9)
    off = oedometer.score("terzaghi", pressure=1.01 * found.pressure, **given)
    assert off.error("pressure", 0.1) == pytest.approx(0.01, rel=1e-6)
    wrong = oedometer.score("terzaghi", pressure=-found.pressure / 1000, **given)
    assert wrong.diagnosis, "kPa and the other sign are told"
    half = oedometer.score("terzaghi", pressure=found.pressure[:, :10], **{**given, "height": (1 - depths)[:10]})
    assert any("height-not-covered" in warning for warning in half.warnings)
    with pytest.raises(KeyError, match="T_v = 0.3"):
        off.error("pressure", 0.3)


def test_what_is_wrong_is_a_sentence():
    for call, told in [
        (lambda: oedometer.exact("terzagi", 0.1, 0.5), "there is no exact solution `terzagi`"),
        (lambda: oedometer.exact("terzaghi", 0.1, 1.5), "1.5"),
        (lambda: oedometer.exact("terzaghi", 0.1, 0.5, permeability=1.0), "has no input `permeability`"),
        (lambda: oedometer.exact("terzaghi", 0.1, 0.5, porosity=1.5), "porosity"),
        (lambda: oedometer.exact("terzaghi", 0.1, 0.5, load=[1.0]), r"`load` is not a number: \[1.0\]"),
        (lambda: oedometer.exact("terzaghi", 10**400, 0.5), "these are not numbers: int too large"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[0.5], pressure=[[math.nan]]), "NaN"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[0.5, 0.6], pressure=[[1.0]]), r"\[time\]\[place\]"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[0.5]), "there is nothing to score"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[7.0], pressure=[[1.0]]), "outside the column"),
        (lambda: oedometer.score("cosine-layer", time=[1.0], height=[0.5], pressure=[1.0]), "give `distance`"),
        (lambda: oedometer.convergence([0.1], [1.0, 2.0]), "1 sizes and 2 errors"),
    ]:
        with pytest.raises(ValueError, match=told):
            call()


def test_orders_classes_and_verdicts():
    sizes = numpy.array([0.1, 0.05, 0.025])
    found = oedometer.convergence(sizes, 4 * sizes**2)
    assert found.kind == "asymptotic" and found.order == pytest.approx(2.0)
    assert found.pair_orders == pytest.approx([2.0, 2.0])
    assert oedometer.convergence(sizes, 1 / sizes).kind == "divergent"
    oedometer.assert_converges(sizes, 4 * sizes**2, order=2.0, at=(0.1, 5e-2))
    for errors, demand, told in [
        (4 * sizes, dict(order=2.0), "order"),
        (8 * sizes**2, dict(order=2.0, at=(0.1, 5e-2)), "not below|above"),
        ([4e-2, math.nan, 2.5e-3], dict(order=2.0), ""),
        (1 / sizes, dict(order=2.0), "divergent"),
    ]:
        with pytest.raises(AssertionError, match=told or None):
            oedometer.assert_converges(sizes, errors, **demand)


def test_the_command_comes_with_the_wheel(tmp_path):
    def run(*words):
        return subprocess.run(
            [sys.executable, "-m", "oedometer", *words], capture_output=True, text=True, cwd=tmp_path
        )

    told = run("exact", "terzaghi", "--time-factor", "0.1", "--zeta", "0.5")
    assert told.returncode == 0, told.stderr
    ratio = float(told.stdout.splitlines()[1].split(",")[2])
    assert ratio == oedometer.exact("terzaghi", 0.1, 0.5).pressure
    assert run("exact", "terzagi").returncode == 2
    # The module is as old as the command that it brings.
    assert run("--version").stdout.split() == ["oedometer", oedometer.__version__]
    script = Path(sys.executable).parent / "oedometer"
    assert subprocess.run([script, "--version"], capture_output=True).returncode == 0


def test_errors_are_a_table_of_columns():
    found = oedometer.exact("terzaghi", [0.1, 0.2], [0.25, 0.5, 0.75])
    score = oedometer.score("terzaghi", time=found.time, height=[0.75, 0.5, 0.25], pressure=found.pressure)
    assert isinstance(score.errors["value"], numpy.ndarray)
    rows = score.errors.rows()
    assert rows[0]["quantity"] == "pressure" and len(rows) == len(score.errors["value"])
    pandas = pytest.importorskip("pandas")
    frame = score.errors.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame["norm"]) == [row["norm"] for row in rows]


def test_arrays_of_any_layout_are_read():
    found = oedometer.exact("terzaghi", [0.1, 0.2], [0.25, 0.5, 0.75])
    of = lambda pressure: oedometer.score(
        "terzaghi", time=found.time, height=[0.75, 0.5, 0.25], pressure=pressure
    ).error("pressure", 0.1)
    assert of(numpy.asfortranarray(found.pressure)) == of(found.pressure) < 1e-12
    assert of(numpy.repeat(found.pressure, 2, axis=1)[:, ::2]) < 1e-12
    assert of(found.pressure.astype(numpy.float32)) < 1e-6


def test_fields_over_distances():
    layer = oedometer.exact("cosine-layer", [0.1, 0.2], [0.25, 0.5], x=[0.0, 0.5])
    assert layer.pressure.shape == (2, 2, 2)
    crest = oedometer.exact("cosine-layer", [0.1, 0.2], [0.25, 0.5])
    assert layer.pressure[:, :, 0] == pytest.approx(crest.pressure, rel=1e-12)
    assert crest.horizontal_displacement is None
    slab = oedometer.exact("mandel", 0.1, x=[0.0, 1.0])
    assert slab.pressure[0] > 0.1 and abs(slab.pressure[1]) < 1e-12
    for call, told in [
        (lambda: oedometer.exact("terzaghi", 0.1, 0.5, x=0.5), "depends only on depth"),
        (lambda: oedometer.exact("mandel", 0.1, 0.5), "give `x`"),
        (lambda: oedometer.exact("mandel", 0.1, x=1.5), "got 1.5"),
        (lambda: oedometer.exact("terzaghi", 0.1), "give depths"),
    ]:
        with pytest.raises(ValueError, match=told):
            call()


def test_files_are_scored_as_the_command_scores_them(tmp_path):
    files = ROOT / "tests" / "foreign" / "ogs" / "col.pvd"
    (score,) = oedometer.score_files("terzaghi", files, preset="ogs")
    words = ["score", str(files), "--preset", "ogs", "--scene", "terzaghi", "--format", "csv"]
    told = subprocess.run([sys.executable, "-m", "oedometer", *words], capture_output=True, text=True)
    assert told.returncode == 0, told.stderr
    lines = [line.split(",") for line in told.stdout.splitlines()]
    values = [float(line[lines[0].index("value")]) for line in lines[1:]]
    assert values == score.errors["value"].tolist() and values
    for arguments, told in [
        (dict(files=files, preset="ogr"), "ogr"),
        (dict(files=tmp_path / "none.csv"), "none.csv"),
        (dict(files=files, preset="ogs", mapping=tmp_path / "none.toml"), "none.toml"),
        (dict(files=files, preset="ogs", time_step=-1.0), "-1"),
    ]:
        with pytest.raises(ValueError, match=told):
            oedometer.score_files("terzaghi", **arguments)


def test_assert_below_fails_on_errors_holes_and_nothing():
    depths = (numpy.arange(20) + 0.5) / 20
    found = oedometer.exact("terzaghi", [0.1], depths)
    of = lambda factor, places: oedometer.score(
        "terzaghi",
        time=found.time,
        height=(1 - depths)[places],
        pressure=factor * found.pressure[:, places],
        sample="centres",
    )
    whole = slice(None)
    oedometer.assert_below(0.02, of(1.01, whole))
    for result, quantity, told in [
        (of(1.03, whole), None, "pressure at T_v = 0.1: 3.000e-02 is not below 0.02"),
        (of(1.0, slice(10)), None, "height-not-covered"),
        (of(1.0, whole), "settlement", "no error of settlement"),
    ]:
        with pytest.raises(AssertionError, match=re.escape(told)):
            oedometer.assert_below(0.02, result, quantity)
    with pytest.raises(AssertionError):
        oedometer.assert_below(math.nan, of(1.01, whole))


def test_the_plugin_makes_tests_that_can_fail(pytester):
    pytester.makepyfile(
        """
        import numpy, oedometer, pytest

        @pytest.fixture
        def power():
            return 2

        def solved(cells, power):
            heights = (numpy.arange(cells) + 0.5) / cells
            exact = oedometer.exact("terzaghi", [0.1], 1 - heights)
            return dict(time=exact.time, height=heights, pressure=exact.pressure * (1 + 0.3 / cells**power))

        @oedometer.converges("terzaghi", cells=[10, 20, 40], order=2.0, at=(10, 5e-3), sample="centres")
        def test_second(cells, power):
            return solved(cells, power)

        @oedometer.converges("terzaghi", cells=[10, 20, 40], order=2.0, sample="centres")
        def test_first(cells):
            return solved(cells, 1)

        @oedometer.converges("terzaghi", cells=[10, 20, 40], order=2.0, at=(10, 1e-3), sample="centres")
        def test_large(cells):
            return solved(cells, 2)
        """
    )
    told = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    told.assert_outcomes(passed=1, failed=2)
    told.stdout.fnmatch_lines(["*errors on finer meshes*", "test_second: terzaghi, pressure: 10 cells 3.000e-03*"])


def test_no_input_ends_the_interpreter():
    numbers = [0.0, -1.0, math.nan, math.inf, 1e300, 1e-300, 0.5, [], [[0.5]], "x", None]
    draw = random.Random(1)
    names = ["terzaghi", "xie-leo", "mandel", "cosine-layer", "single-mode", "no-such"]
    refused = 0
    for _ in range(300):
        name, time, depth, value = (draw.choice(of) for of in (names, numbers, numbers, numbers))
        key = draw.choice(["load", "height", "porosity", "youngs_modulus"])
        try:
            oedometer.exact(name, time, depth, **{key: value} if isinstance(value, float) else {})
            oedometer.score("terzaghi", time=time, height=depth, pressure=value)
        except (ValueError, TypeError):
            refused += 1
    assert refused > 100


def test_the_examples_of_the_manual_run(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text(), re.S)
    assert len(blocks) >= 5
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), {})
    doctest = __import__("doctest")
    for module in (oedometer, oedometer.testing):
        assert doctest.testmod(module).failed == 0


def test_the_example_runs(capsys):
    runpy.run_path(str(Path(__file__).parent.parent / "examples" / "own_solver.py"))
    assert "asymptotic" in capsys.readouterr().out


def column(cells, error):
    """A column at cell centres with an error, as rows of a table in kPa: t, height, pore, settled."""
    depths = (numpy.arange(cells) + 0.5) / cells
    exact = oedometer.exact("terzaghi", [0.1, 0.2], depths, load=2e3)
    return {
        "t": numpy.repeat(exact.time, cells),
        "height": numpy.tile(1 - depths, 2),
        "pore": (1 + error) * exact.pressure.ravel() / 1e3,
        "moved": exact.displacement.ravel(),
    }


TOLD = {
    "columns": {"t": "t", "y": "height", "p": "pore", "u_y": "moved"},
    "units": {"time": "s", "length": "m", "stress": "kPa"},
    "sign": {"y": "up", "p": "compression-positive", "u_y": "up"},
    "sample": "centres",
}


def test_frames_and_datasets_are_read_as_the_table_that_they_are(tmp_path):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(column(20, 0.01))
    of = dict(mapping=TOLD, reference="terzaghi", load=2e3)
    score = oedometer.score("terzaghi", frame, **of)
    assert score.error("pressure", 0.2) == pytest.approx(0.01) and not score.warnings
    assert "1.01 ×" in score.diagnosis[0]
    # An index with names is part of the data, and a duration is in seconds.
    named = frame.assign(t=pandas.to_timedelta(frame["t"], unit="s")).set_index(["t", "height"])
    assert oedometer.score("terzaghi", named, **of).error("pressure", 0.2) == pytest.approx(0.01, rel=1e-6)
    file = tmp_path / "r.csv"
    frame.to_csv(file, index=False)
    (same,) = oedometer.score_files("terzaghi", file, **of)
    assert same.errors.rows() == score.errors.rows() and same.name == str(file)
    xarray = pytest.importorskip("xarray")
    dataset = xarray.Dataset.from_dataframe(frame.set_index(["t", "height"]))
    found = oedometer.score("terzaghi", dataset, **of)
    assert found.error("pressure", 0.2) == pytest.approx(score.error("pressure", 0.2), rel=1e-12)
    for wrong, words in [(3.0, "is no result"), (frame.drop(columns="pore"), "no column `pore`")]:
        with pytest.raises(ValueError, match=words):
            oedometer.score("terzaghi", wrong, **of)
    with pytest.raises(ValueError, match="give `time` and `height`"):
        oedometer.score("terzaghi", pressure=[1.0])


def test_meshes_are_read_at_their_times():
    meshio = pytest.importorskip("meshio")
    heights = numpy.linspace(0, 1, 11)
    exact = oedometer.exact("terzaghi", [0.1, 0.2], 1 - heights)
    points = numpy.array([[x, y, 0.0] for y in heights for x in (0.0, 0.1)])
    quads = numpy.array([[2 * j, 2 * j + 1, 2 * j + 3, 2 * j + 2] for j in range(10)])

    def mesh(at):
        pressure = numpy.repeat(exact.pressure[at], 2)
        moved = numpy.column_stack([0 * pressure, numpy.repeat(exact.displacement[at], 2), 0 * pressure])
        return meshio.Mesh(points, [("quad", quads)], point_data={"pressure": pressure, "displacement": moved})

    score = oedometer.score("terzaghi", [(exact.time[at], mesh(at)) for at in (0, 1)], reference="terzaghi")
    assert sorted(set(numpy.round(score.errors["time_factor"], 9))) == [0.1, 0.2]
    assert max(abs(score.errors["value"])) < 1e-6 and not score.diagnosis


def test_meshes_have_orders_and_classes_and_a_wrong_permeability_its_name():
    pandas = pytest.importorskip("pandas")
    levels = [10, 20, 40]
    frames = [pandas.DataFrame(column(cells, 3.0 / cells**2)) for cells in levels]
    scores = oedometer.score_files("terzaghi", frames, mapping=TOLD, cells=levels, reference="terzaghi", load=2e3)
    (pressure, *_) = [
        row for row in scores[0].series.rows() if (row["quantity"], row["norm"]) == ("pressure", "l2")
    ]
    assert pressure["cells"] == levels and pressure["class"] == "asymptotic" and abs(pressure["order"] - 2) < 0.01
    with pytest.raises(ValueError, match="`cells` has 2 numbers for 3 results"):
        oedometer.score_files("terzaghi", frames, mapping=TOLD, cells=[10, 20], load=2e3)
    fast = oedometer.exact("terzaghi", [0.15, 0.3], 1 - numpy.linspace(0, 1, 21))
    late = oedometer.score(
        "terzaghi", time=fast.time / 1.5, height=numpy.linspace(0, 1, 21), pressure=fast.pressure,
        displacement=fast.displacement, sample="nodes", reference="terzaghi",
    )
    assert len(late.diagnosis) == 1 and "1.5 × the time" in late.diagnosis[0] and "E_oed" not in late.diagnosis[0]
    with pytest.raises(AssertionError, match="^each of your p"):
        oedometer.assert_below(0.01, late)


def test_a_slab_has_x_along_the_drained_direction():
    x = numpy.linspace(0, 1, 11)
    exact = oedometer.exact("mandel", [0.05, 0.2], x=x, load=50.0)
    score = oedometer.score("mandel", time=exact.time, distance=x, pressure=exact.pressure, load=50.0, sample="nodes")
    assert max(abs(score.errors["value"])) < 1e-9
    with pytest.raises(ValueError, match="from the middle of the slab"):
        oedometer.score("mandel", time=exact.time, height=x, pressure=exact.pressure)


def test_a_test_gets_the_case_that_it_solves():
    found = oedometer.case("terzaghi", 10, [0.1, 0.2], load=1000.0)
    assert found["cells"] == 10 and found["column"]["load"] == 1000.0
    assert numpy.allclose(found["times"], oedometer.exact("terzaghi", [0.1, 0.2], 0.5).time)

    @oedometer.converges("terzaghi", cells=[10, 20, 40], order=2.0, sample="centres", reference="terzaghi", load=1000.0)
    def test_solver(cells, case):
        assert case["cells"] == cells
        depths = (numpy.arange(cells) + 0.5) / cells
        exact = oedometer.exact("terzaghi", case["time_factors"], depths, load=case["column"]["load"])
        return {"time": case["times"], "height": 1 - depths, "pressure": exact.pressure * (1 + 0.3 / cells**2)}

    test_solver()
