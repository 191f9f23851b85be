"""The module against numbers that were computed elsewhere, and against itself."""

import math
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

import oedometer

numpy = pytest.importorskip("numpy")


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
    assert all(abs(row["value"]) < 1e-9 for row in clean.errors if row["reference"] == "terzaghi")
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
        (lambda: oedometer.exact("terzagi", 0.1, 0.5), "no exact solution is called `terzagi`"),
        (lambda: oedometer.exact("terzaghi", 0.1, 1.5), "1.5"),
        (lambda: oedometer.exact("terzaghi", 0.1, 0.5, permeability=1.0), "no input .* is called `permeability`"),
        (lambda: oedometer.exact("terzaghi", 0.1, 0.5, porosity=1.5), "porosity"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[0.5], pressure=[[math.nan]]), "NaN"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[0.5, 0.6], pressure=[[1.0]]), r"\[time\]\[place\]"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[0.5]), "nothing is given"),
        (lambda: oedometer.score("terzaghi", time=[8.0], height=[7.0], pressure=[[1.0]]), "outside the column"),
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


def test_the_example_runs(capsys):
    runpy.run_path(str(Path(__file__).parent.parent / "examples" / "own_solver.py"))
    assert "asymptotic" in capsys.readouterr().out
