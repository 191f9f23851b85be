"""Exact solutions of consolidation, and verdicts on results, as arrays.

Everything is SI. A pressure is positive in compression, an effective stress in tension, a displacement upward, a
settlement downward. Depths ``zeta`` are over the height, 0 at the drained surface; heights ``y`` count from the base.
``T_v = c_v t/H**2`` with the drained ``c_v``.

Lists of numbers may be anything that iterates, or numpy arrays. Where numpy is installed, arrays come back, else nested
lists of the same shape. Nothing is computed in Python: every number is the one that the command ``oedometer`` prints.
"""

from __future__ import annotations

import json
from array import array
from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

from . import _native

try:
    import numpy as _numpy
except ImportError:
    _numpy = None  # type: ignore[assignment]

__version__ = _native.__version__
__all__ = [
    "Convergence",
    "Exact",
    "Score",
    "assert_converges",
    "convergence",
    "exact",
    "score",
]

Numbers = Union[float, Sequence[float], Any]
"""A number, a sequence of numbers, or a numpy array."""


def _doubles(numbers: Numbers) -> Tuple[bytes, Tuple[int, ...]]:
    """The bytes of numbers as doubles, and their shape."""
    if _numpy is not None:
        whole = _numpy.ascontiguousarray(numbers, dtype=_numpy.float64)
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
    if len(shape) == 1:
        return list(numbers)
    rows, columns = shape
    return [list(numbers[row * columns : (row + 1) * columns]) for row in range(rows)]


def _inputs(given: Dict[str, Any]) -> List[Tuple[str, str]]:
    """Inputs of a case as a command line has them."""

    def text(value: Any) -> str:
        if isinstance(value, bool):
            return "true" if value else "false"
        # A whole number is given as such where one is needed, like `dimensions`.
        return value if isinstance(value, str) else repr(value if isinstance(value, int) else float(value))

    return [(name, text(value)) for name, value in given.items()]


@dataclass(frozen=True)
class Exact:
    """An exact solution at times and depths.

    An index is left out where a single number was asked for: ``exact("terzaghi", 0.1, 0.5).pressure`` is a number.
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
    height: float
    """Initial height, m."""
    load: float
    """Load on the surface, Pa."""


def exact(scene: str, time_factor: Numbers, zeta: Numbers, **material: Union[float, str]) -> Exact:
    """An exact solution, like ``terzaghi``, ``xie-leo`` or ``dynamic-column``.

    ``time_factor`` and ``zeta`` are numbers or sequences; fields have the shape ``[time][depth]``. ``material`` takes the
    keys of study files: ``youngs_modulus`` (Pa), ``porosity``, ``hydraulic_conductivity`` (m/s), ``load`` (Pa), ``height``
    (m), … Of a layer the fields are those under the crest of its load.

    Raises ``ValueError`` with a sentence where a name or a value is refused.

    >>> exact("terzaghi", [0.05, 0.1], [0.5, 1.0]).pressure[1][0] < 1.0
    True
    """
    times, of_time = _doubles(time_factor)
    depths, of_depth = _doubles(zeta)
    found = dict(_native.exact(scene, times, depths, _inputs(material)))
    height, load = array("d", found.pop("scales"))
    per_time = {"time", "settlement", "degree_of_consolidation", "tail_bound"}
    fields = {
        name: _shaped(data, of_time if name in per_time else of_time + of_depth) for name, data in found.items()
    }
    return Exact(height=height, load=load, **fields)


@dataclass(frozen=True)
class Score:
    """A result held against the references of a scene."""

    errors: List[Dict[str, Any]]
    """A dictionary an error: ``time_factor``, ``quantity`` (pressure, effective_stress, displacement, settlement),
    ``sample``, ``norm`` (l1, l2, linf, relative), ``reference``, ``value`` (relative) and ``absolute`` (over the load, or
    over the final settlement)."""
    worst: List[Dict[str, Any]]
    """The place that carries most of each error: ``zeta``, ``computed``, ``exact``, ``share`` of the squared error."""
    warnings: List[str]
    """In what the result is not whole."""
    diagnosis: List[str]
    """What seems to be wrong with its numbers: units, signs, times."""
    reference: str
    """The scene's own reference."""

    def error(
        self,
        quantity: str,
        time_factor: float,
        norm: Optional[str] = None,
        reference: Optional[str] = None,
    ) -> float:
        """One error: ``l2`` of a field and ``relative`` of a settlement where no norm is named, against the scene's own
        reference, at the time nearest to ``time_factor`` within a thousandth. ``KeyError`` where there is none."""
        norm = norm or ("relative" if quantity == "settlement" else "l2")
        reference = reference or self.reference
        near = [
            row
            for row in self.errors
            if (row["quantity"], row["norm"], row["reference"]) == (quantity, norm, reference)
            and abs(row["time_factor"] - time_factor) <= 1e-3 * abs(time_factor)
        ]
        if not near:
            raise KeyError(f"no {norm} error of {quantity} at T_v = {time_factor} against {reference}")
        return min(near, key=lambda row: abs(row["time_factor"] - time_factor))["value"]


def score(
    scene: str,
    *,
    time: Numbers,
    height: Numbers,
    pressure: Optional[Numbers] = None,
    effective_stress: Optional[Numbers] = None,
    displacement: Optional[Numbers] = None,
    settlement: Optional[Numbers] = None,
    volume: Optional[Numbers] = None,
    distance: Optional[Numbers] = None,
    horizontal_displacement: Optional[Numbers] = None,
    sample: str = "points",
    reference: Optional[str] = None,
    **material: Union[float, str],
) -> Score:
    """Holds a result against the references of a scene, or against one of them.

    ``time`` (s): ``[time]``. ``height``: *initial* heights over the base (m), ``[place]``, and where places are in a plane
    ``distance`` (m) from the crest of the load. ``pressure`` and ``effective_stress`` (Pa), ``displacement`` and
    ``horizontal_displacement`` (m): ``[time][place]``, or ``[place]`` of a single time. ``settlement`` (m): ``[time]``.
    ``volume``: weights, ``[place]``; all alike where left out. ``sample`` names the kind of places: points, centres or
    nodes. ``material`` as in :func:`exact`.

    Raises ``ValueError`` where shapes do not fit, a number is not finite, or the scene refuses.
    """
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
    found = json.loads(_native.score(scene, data, sample, reference, _inputs(material)))
    return Score(
        errors=found["errors"],
        worst=found["worst"],
        warnings=[f"{one['name']}: {one['sentence']}" for one in found["warnings"]],
        diagnosis=found["diagnosis"],
        reference=found["errors"][0]["reference"] if found["errors"] else "",
    )


@dataclass(frozen=True)
class Convergence:
    """How a series of errors behaves under refinement."""

    kind: str
    """Class: asymptotic, pre-asymptotic, floor-limited, oscillatory, divergent, superconvergent, exact, contaminated,
    locked or not-evaluable."""
    order: Optional[float]
    """Order on the finest three levels, where the class gives it a meaning."""
    reason: str
    """A sentence with the numbers that decided."""
    advice: Optional[str]
    """What to change, where there is something to say."""
    floor: Optional[float]
    """Height of the floor of a floor-limited series, in the unit of the errors."""
    sizes: List[float] = field(repr=False)
    """Sizes from coarse to fine."""
    errors: List[float] = field(repr=False)
    """Absolute errors at them."""
    pair_orders: List[Optional[float]] = field(repr=False)
    """Orders between neighbours, one fewer than levels."""


def convergence(sizes: Numbers, errors: Numbers, formal_order: Optional[float] = None) -> Convergence:
    """Class and order of ``errors`` over the ``sizes`` of their levels (``[level]`` each, in any order).

    Signed errors of a single number, like a settlement, are told from norms by their signs. ``formal_order`` is the order
    that the method should have, where that is known.

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


def assert_converges(
    sizes: Numbers,
    errors: Numbers,
    order: Optional[float] = None,
    *,
    minus: float = 0.1,
    plus: float = 0.1,
    at: Optional[Tuple[float, float]] = None,
    kind: Optional[str] = None,
) -> None:
    """For tests: raises ``AssertionError`` with the sentence of the verdict where a series is not as demanded.

    ``order`` is a band from ``order - minus`` to ``order + plus`` on the finest three levels, of a series that is
    asymptotic; ``at`` a size and the bound on the error there, for a doubled error constant keeps the order; ``kind`` the
    class, where another than ``asymptotic`` is expected. NaN, a missing level or a negative order never pass.

    >>> assert_converges([0.1, 0.05, 0.025], [4e-2, 1e-2, 2.5e-3], order=2.0, at=(0.1, 5e-2))
    """
    __tracebackhide__ = True
    band = None if order is None else (float(order), float(minus), float(plus))
    bound = None if at is None else (float(at[0]), float(at[1]))
    passes, reason = _native.verdict(_doubles(sizes)[0], _doubles(errors)[0], band, bound, kind)
    if not passes:
        raise AssertionError(reason)
