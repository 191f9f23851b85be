"""Exact solutions of consolidation, and verdicts on results, as arrays.

Everything is SI. A pressure is positive in compression, an effective stress in tension, a displacement upward, a
settlement downward. Depths ``zeta`` are relative to the height, 0 at the drained surface; heights ``y`` are measured from the base.
``T_v = c_v t/H**2`` with the drained ``c_v``.

Lists of numbers may be any iterables or numpy arrays. If numpy is installed, arrays are returned, otherwise nested lists of
the same shape. Nothing is computed in Python: every number is the one that the command ``oedometer`` prints.
"""

from __future__ import annotations

import json
import os
import tempfile
from array import array
from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional, Sequence, SupportsFloat, Tuple, Union

from . import _native
from .data import meaning as _meaning, written as _written

try:
    import numpy as _numpy
except ImportError:
    _numpy = None  # type: ignore[assignment]

__version__ = _native.__version__
__all__ = [
    "Convergence",
    "Exact",
    "Score",
    "Table",
    "assert_below",
    "assert_converges",
    "case",
    "convergence",
    "converges",
    "exact",
    "score",
    "score_files",
]

Numbers = Union[float, Sequence[float], Any]
"""A number, a sequence of numbers, or a numpy array."""


def _doubles(numbers: Numbers) -> Tuple[bytes, Tuple[int, ...]]:
    """The bytes of numbers as doubles, and their shape."""
    if _numpy is not None:
        try:
            whole = _numpy.ascontiguousarray(numbers, dtype=_numpy.float64)
        except (TypeError, OverflowError) as error:
            raise ValueError(f"these are not numbers: {error}") from None
        return whole.tobytes(), _numpy.shape(numbers)
    if isinstance(numbers, (int, float)):
        return array("d", [numbers]).tobytes(), ()
    rows = list(numbers)
    if rows and not isinstance(rows[0], (int, float)):
        lists = [list(row) for row in rows]
        if any(len(row) != len(lists[0]) for row in lists):
            raise ValueError("the rows of a list differ in length: its shape is [time][place]")
        return array("d", [number for row in lists for number in row]).tobytes(), (len(lists), len(lists[0]))
    return array("d", rows).tobytes(), (len(rows),)


def _shaped(data: bytes, shape: Tuple[int, ...]) -> Any:
    """Numbers from bytes, in a shape."""
    if _numpy is not None:
        whole = _numpy.frombuffer(data, dtype=_numpy.float64).reshape(shape)
        return whole if shape else float(whole)
    numbers = array("d")
    numbers.frombytes(data)
    if not shape:
        return numbers[0]
    for size in reversed(shape[1:]):
        numbers = [list(numbers[at : at + size]) for at in range(0, len(numbers), size)]
    return list(numbers)


def _inputs(given: Dict[str, Any]) -> List[Tuple[str, str]]:
    """Inputs of a case as a command line has them."""

    def text(value: Any) -> str:
        if isinstance(value, bool):
            return "true" if value else "false"
        # A whole number is given as such where one is needed, like `dimensions`.
        return value if isinstance(value, str) else repr(value if isinstance(value, int) else float(value))

    wrong = [name for name, value in given.items() if not isinstance(value, (str, SupportsFloat))]
    if wrong:
        raise ValueError(f"`{wrong[0]}` is not a number: {given[wrong[0]]!r}")
    return [(name, text(value)) for name, value in given.items()]


@dataclass(frozen=True)
class Exact:
    """An exact solution at times and depths.

    An index is omitted where a single number was given: ``exact("terzaghi", 0.1, 0.5).pressure`` is a number.
    """

    time: Any
    """Time, s: ``[time]``."""
    pressure: Any
    """Excess pore pressure, compression positive, Pa: ``[time][depth]``."""
    effective_stress: Any
    """Vertical effective stress, tension positive, Pa: ``[time][depth]``."""
    displacement: Any
    """Displacement, upward positive, m: ``[time][depth]``."""
    settlement: Any
    """Settlement of the surface, downward positive, m: ``[time]``."""
    degree_of_consolidation: Any
    """By settlement: ``[time]``."""
    tail_bound: Any
    """Bound on the truncation error of the pressure over the load: ``[time]``."""
    horizontal_displacement: Any
    """Displacement along a layer, m: ``[time][depth][x]``; ``None`` where no ``x`` is given."""
    height: float
    """Initial height, m."""
    load: float
    """Load on the surface, Pa."""


def exact(
    scene: str,
    time_factor: Numbers,
    zeta: Optional[Numbers] = None,
    *,
    x: Optional[Numbers] = None,
    **material: Union[float, str],
) -> Exact:
    """Evaluate an exact solution, like ``terzaghi``, ``xie-leo`` or ``cosine-layer``.

    Parameters
    ----------
    scene : str
        Name of the solution; ``oedometer list`` shows them.
    time_factor : array_like
        Time factors ``T_v``, 0 at the undrained start.
    zeta : array_like
        Depths over the height, 0 at the drained surface. Fields have the shape ``[time][depth]``.
    x : array_like, optional
        Distances from the crest of a layer's load, relative to its length: fields are then ``[time][depth][x]``; without it
        they are those under the crest. For ``mandel`` distances from the middle over the half width, without ``zeta``.
    **material
        Keys of study files: ``youngs_modulus`` (Pa), ``hydraulic_conductivity`` (m/s), ``load`` (Pa), ``height`` (m), …

    Raises
    ------
    ValueError
        If a name or a value is refused, with the reason.

    Examples
    --------
    >>> bool(exact("terzaghi", [0.05, 0.1], [0.5, 1.0]).pressure[1][0] < 1.0)
    True
    """
    empty: Tuple[bytes, Tuple[int, ...]] = (b"", ())
    times, of_time = _doubles(time_factor)
    depths, of_depth = empty if zeta is None else _doubles(zeta)
    distances, of_distance = empty if x is None else _doubles(x)
    if x is not None and not distances:
        raise ValueError("`x` is empty: give at least one distance, or leave it out")
    if zeta is None and x is None:
        raise ValueError("give depths `zeta`, or of `mandel` distances `x`")
    found = dict(_native.exact(scene, times, depths, distances, _inputs(material)))
    height, load = array("d", found.pop("scales"))
    across = found.pop("horizontal_displacement")
    per_time = {"time", "settlement", "degree_of_consolidation", "tail_bound"}
    of_fields = of_time + of_depth + of_distance
    fields = {name: _shaped(data, of_time if name in per_time else of_fields) for name, data in found.items()}
    horizontal = _shaped(across, of_fields) if across else None
    return Exact(height=height, load=load, horizontal_displacement=horizontal, **fields)


class Table(Dict[str, Any]):
    """Columns by name: arrays if numpy is installed, otherwise lists.

    ``table["value"]`` is a column, ``len(table.rows())`` the number of rows, ``table.to_pandas()`` a data frame.
    """

    @classmethod
    def _of(cls, rows: List[Dict[str, Any]]) -> "Table":
        names = list(dict.fromkeys(name for row in rows for name in row))
        columns = {name: [row.get(name) for row in rows] for name in names}
        if _numpy is not None:
            # Lists of a row, as the errors of its meshes, stay lists.
            nested = {name for name, column in columns.items() if any(isinstance(one, list) for one in column)}
            return cls({name: column if name in nested else _numpy.array(column) for name, column in columns.items()})
        return cls(columns)

    def rows(self) -> List[Dict[str, Any]]:
        """The rows, each as a dictionary."""
        plain = [list(column) if isinstance(column, list) else column.tolist() for column in self.values()]
        return [dict(zip(self, row)) for row in zip(*plain)]

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame`` with these columns."""
        import pandas

        return pandas.DataFrame(dict(self))


@dataclass(frozen=True)
class Score:
    """A result compared with the references of a benchmark problem."""

    errors: Table
    """One row per error: ``time_factor``, ``quantity`` (pressure, effective_stress, displacement, settlement),
    ``sample``, ``norm`` (l1, l2, linf, relative), ``reference``, ``value`` (relative) and ``absolute`` (over the load, or
    over the final settlement)."""
    worst: Table
    """The place with the largest part of each error: ``zeta``, ``computed``, ``exact``, ``share`` of the squared error."""
    warnings: List[str]
    """What the result lacks."""
    diagnosis: List[str]
    """What seems to be wrong with its numbers: units, signs, times."""
    reference: str
    """The reference of the problem itself."""
    name: str = ""
    """The files, if it was read from files."""
    series: Table = field(default_factory=Table)
    """For results on several meshes, one row per measure: ``time_factor``, ``quantity``, ``sample``, ``norm``, ``reference``,
    the ``cells`` of the meshes with their ``errors``, ``order``, ``class`` and ``reason``."""
    not_judged: List[str] = field(default_factory=list)
    """What could not be judged: the settlement, nodes at the surface or the base."""

    def error(
        self,
        quantity: str,
        time_factor: float,
        norm: Optional[str] = None,
        reference: Optional[str] = None,
    ) -> float:
        """One error: by default ``l2`` of a field and ``relative`` of a settlement, against the problem's own
        reference, at the time nearest to ``time_factor`` within a thousandth. Raises ``KeyError`` if there is none."""
        norm = norm or ("relative" if quantity == "settlement" else "l2")
        reference = reference or self.reference
        near = [
            row
            for row in self.errors.rows()
            if (row["quantity"], row["norm"], row["reference"]) == (quantity, norm, reference)
            and abs(row["time_factor"] - time_factor) <= 1e-3 * abs(time_factor)
        ]
        if not near:
            raise KeyError(f"no {norm} error of {quantity} at T_v = {time_factor} against {reference}")
        return min(near, key=lambda row: abs(row["time_factor"] - time_factor))["value"]


def score(
    scene: str,
    data: Any = None,
    *,
    time: Optional[Numbers] = None,
    height: Optional[Numbers] = None,
    pressure: Optional[Numbers] = None,
    effective_stress: Optional[Numbers] = None,
    displacement: Optional[Numbers] = None,
    settlement: Optional[Numbers] = None,
    volume: Optional[Numbers] = None,
    distance: Optional[Numbers] = None,
    horizontal_displacement: Optional[Numbers] = None,
    sample: str = "points",
    mapping: Union[Mapping[str, Any], str, "os.PathLike[str]", None] = None,
    reference: Optional[str] = None,
    **material: Union[float, str],
) -> Score:
    """Compare a result with the references of a benchmark problem, or with one of them.

    Parameters
    ----------
    scene : str
        Benchmark problem, like ``terzaghi``.
    data : pandas.DataFrame, xarray.Dataset, meshio.Mesh or sequence of (time, meshio.Mesh), optional
        The result as a whole, instead of the arrays below: its columns or arrays are read as those of a file, and
        ``mapping`` says what they mean, as in :func:`score_files`.
    time, height : array_like
        Times (s) ``[time]``, and *initial* heights above the base (m) ``[place]``. For ``mandel`` heights are the places
        across, which may be omitted.
    pressure, effective_stress : array_like, optional
        Pa, ``[time][place]``, or ``[place]`` for a single time; compression and tension positive.
    displacement, horizontal_displacement : array_like, optional
        m, ``[time][place]``, positive upward and away from the crest.
    settlement : array_like, optional
        m, ``[time]``, positive downward.
    volume : array_like, optional
        Weights ``[place]``; equal by default.
    distance : array_like, optional
        m from the crest of the load ``[place]``, if places are in a plane; for ``mandel`` from the middle of the slab to
        its drained side.
    sample : {"points", "centres", "nodes"}
        The kind of places.
    reference : str, optional
        The only reference to compare with.
    **material
        As in :func:`exact`.

    Raises
    ------
    ValueError
        If shapes do not match, a number is not finite, or the problem refuses an input.
    """
    if data is not None:
        found = score_files(scene, data, mapping=mapping, reference=reference, **material)
        if len(found) != 1:
            raise ValueError(f"the data hold {len(found)} results: score them with `score_files`")
        return found[0]
    if mapping is not None:
        raise ValueError("`mapping` says what `data` mean: arrays are in SI already")
    if height is None and distance is not None:
        height = [0.0] * (len(_doubles(distance)[0]) // 8)
    if time is None or height is None:
        raise ValueError("give `time` and `height`, or the result as a whole as `data`")
    lists = (
        time,
        height,
        distance,
        volume,
        pressure,
        effective_stress,
        displacement,
        horizontal_displacement,
        settlement,
    )
    data = [b"" if one is None else _doubles(one)[0] for one in lists]
    return _score(json.loads(_native.score(scene, data, sample, reference, _inputs(material))))


def case(
    scene: str, cells: int, time_factor: Optional[Numbers] = None, **material: Union[float, str]
) -> Dict[str, Any]:
    """What a solver must solve, as in the ``case.json`` of attached solvers: geometry, load, soil, times in s, a time step.

    Parameters
    ----------
    scene : str
        Benchmark problem, like ``terzaghi``.
    cells : int
        Cells over the height.
    time_factor : array_like, optional
        Outputs as time factors; by default those of the problem.
    **material
        As in :func:`exact`.

    Examples
    --------
    >>> case("terzaghi", 10, [0.1, 0.2], load=1000.0)["column"]["load"]
    1000.0
    """
    times = b"" if time_factor is None else _doubles(time_factor)[0]
    return json.loads(_native.case(scene, cells, times, _inputs(material)))


def score_files(
    scene: str,
    files: Any,
    *,
    preset: Optional[str] = None,
    mapping: Union[Mapping[str, Any], str, "os.PathLike[str]", None] = None,
    time_step: Optional[float] = None,
    cells: Optional[Sequence[int]] = None,
    reference: Optional[str] = None,
    **material: Union[float, str],
) -> List[Score]:
    """Compare files of another program with the references of a benchmark problem: one score per mesh.

    Parameters
    ----------
    scene : str
        Benchmark problem, like ``terzaghi``.
    files : path, pandas.DataFrame, xarray.Dataset, meshio.Mesh, or sequence of these
        CSV, VTU, PVD, legacy VTK, NPZ, HDF5 or XDMF; patterns with ``*`` and ``?`` are expanded. A frame counts as the CSV
        that it would be, a mesh as its VTU; meshes at several times are pairs ``(time in s, mesh)``.
    preset : str, optional
        The program that wrote them, like ``ogs``: what its arrays mean.
    mapping : dict or path, optional
        A mapping as a dictionary of its tables, or its file, which overrides the preset key by key:
        ``{"columns": {"p": "pore"}, "units": {"stress": "kPa"}}``.
    time_step : float, optional
        Seconds from one numbered step to the next, if file names contain a step number.
    cells : sequence of int, optional
        Cells over the height of each result, if the files do not show them: each table is then a separate result, and
        ``series`` of each score has orders and classes over the meshes.
    reference, **material
        As in :func:`score`.

    Raises
    ------
    ValueError
        If a file cannot be read or does not match, with its name.
    """
    inputs = _inputs(material)
    counts = [int(count) for count in cells] if cells is not None else []
    with tempfile.TemporaryDirectory() as folder:
        paths, times = _written(files, folder)
        given = (*_meaning(preset, mapping, times), time_step, counts)
        found = json.loads(_native.score_files(scene, paths, given, reference, inputs))
        # Data that came in no file have no name but their place.
        return [_score(one, name.replace(folder + os.sep, "")) for name, one in found]


def _score(found: Dict[str, Any], name: str = "") -> Score:
    """A score from its JSON."""
    return Score(
        name=name,
        errors=Table._of(found["errors"]),
        worst=Table._of(found["worst"]),
        warnings=[f"{one['name']}: {one['sentence']}" for one in found["warnings"]],
        diagnosis=found["diagnosis"],
        series=Table._of(found.get("series", [])),
        not_judged=[one["sentence"] for one in found.get("not_judged", [])],
        reference=found["errors"][0]["reference"] if found["errors"] else "",
    )


@dataclass(frozen=True)
class Convergence:
    """How a series of errors behaves under refinement."""

    kind: str
    """Class: asymptotic, pre-asymptotic, floor-limited, oscillatory, divergent, superconvergent, exact, contaminated,
    locked or not-evaluable."""
    order: Optional[float]
    """Order on the finest three levels, if the class gives it a meaning."""
    reason: str
    """A sentence with the numbers that decided."""
    advice: Optional[str]
    """What to change, if anything."""
    floor: Optional[float]
    """Height of the plateau of a floor-limited series, in the unit of the errors."""
    sizes: List[float] = field(repr=False)
    """Sizes from coarse to fine."""
    errors: List[float] = field(repr=False)
    """Absolute errors at them."""
    pair_orders: List[Optional[float]] = field(repr=False)
    """Orders between neighbours, one fewer than levels."""


def convergence(sizes: Numbers, errors: Numbers, formal_order: Optional[float] = None) -> Convergence:
    """Class and order of ``errors`` over the ``sizes`` of their levels (``[level]`` each, in any order).

    Signed errors of a single number, like a settlement, are distinguished from norms by their signs. ``formal_order`` is the
    order that the method should have, if known.

    >>> convergence([0.1, 0.05, 0.025], [4e-2, 1e-2, 2.5e-3]).kind
    'asymptotic'
    """
    found = json.loads(_native.convergence(_doubles(sizes)[0], _doubles(errors)[0], formal_order))
    classified = found["classification"]
    floor = classified.get("floor")
    return Convergence(
        kind=classified["class"],
        order=classified.get("order"),
        reason=classified["reason"],
        advice=classified.get("advice"),
        floor=floor["value"] if floor else None,
        sizes=found["sizes"],
        errors=found["errors"],
        pair_orders=found["pair_orders"],
    )


from .testing import assert_below, assert_converges, converges  # noqa: E402
