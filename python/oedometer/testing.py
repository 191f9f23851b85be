"""Assertions and a decorator for tests, in the manner of ``numpy.testing``.

Each raises ``AssertionError`` with the sentence of the verdict; a number that is not one never passes.
"""

from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

from . import Numbers, Score, _doubles, _native, case, score

__all__ = ["assert_below", "assert_converges", "converges"]

shown: List[str] = []
"""What the decorated tests of this session found, a line each; the plugin for pytest prints them."""


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
    """Raise unless errors behave as demanded under refinement.

    Parameters
    ----------
    sizes, errors : array_like
        ``[level]`` each, in any order.
    order : float, optional
        Expected order on the finest three levels, of a series that is asymptotic.
    minus, plus : float
        How far below and above it the order may lie.
    at : (float, float), optional
        A size and the bound on the error there: a doubled error constant keeps the order.
    kind : str, optional
        The class, where another than ``asymptotic`` is expected.

    Examples
    --------
    >>> assert_converges([0.1, 0.05, 0.025], [4e-2, 1e-2, 2.5e-3], order=2.0, at=(0.1, 5e-2))
    """
    __tracebackhide__ = True
    band = None if order is None else (float(order), float(minus), float(plus))
    bound = None if at is None else (float(at[0]), float(at[1]))
    passes, reason = _native.verdict(_doubles(sizes)[0], _doubles(errors)[0], band, bound, kind)
    if not passes:
        raise AssertionError(reason)


def assert_below(
    bound: float, result: Score, quantity: Optional[str] = None, *, reference: Optional[str] = None
) -> None:
    """Raise unless a score is complete and its errors are below a bound, at every time.

    Parameters
    ----------
    bound : float
        Bound on the relative error: L2 of a field, ``relative`` of a settlement.
    result : Score
        From :func:`score` or :func:`score_files`.
    quantity : str, optional
        The one quantity that is judged; all where left out.
    reference : str, optional
        A reference other than the problem's own.
    """
    __tracebackhide__ = True
    reference = reference or result.reference
    judged = [
        row
        for row in result.errors.rows()
        if row["norm"] in ("l2", "relative") and row["reference"] == reference and quantity in (None, row["quantity"])
    ]
    wrong = [
        f"{row['quantity']} at T_v = {row['time_factor']:.4g}: {abs(row['value']):.3e} is not below {bound:g}"
        for row in judged
        if not abs(row["value"]) < bound
    ]
    if not judged:
        wrong.append(f"there is no error of {quantity or 'any quantity'} against {reference}")
    if wrong or result.warnings:
        raise AssertionError("\n".join([*result.diagnosis, *wrong, *result.warnings]))


def converges(
    scene: str,
    cells: Sequence[int],
    *,
    order: Optional[float] = None,
    minus: float = 0.2,
    plus: float = 0.2,
    at: Optional[Tuple[int, float]] = None,
    kind: Optional[str] = None,
    quantity: str = "pressure",
    time_factor: Optional[float] = None,
    sample: str = "points",
    reference: Optional[str] = None,
    **material: Union[float, str],
) -> Callable[[Callable[..., Any]], Callable[..., None]]:
    """Make a test of a function that solves a benchmark problem on a number of cells.

    The function takes ``cells``, and any fixtures of pytest, and returns the keyword arguments of :func:`score` as a
    dictionary. Where it takes ``case`` too, that is the case of these cells as :func:`oedometer.case` has it: geometry, load,
    soil and times in s. The test solves on each mesh, scores, and demands a complete result and the order, as
    :func:`assert_converges`. Sizes are in heights of the column.

    Parameters
    ----------
    scene, sample, reference, **material
        As in :func:`score`.
    cells : sequence of int
        Cells over the height, three meshes at least for an order.
    order, minus, plus, kind
        As in :func:`assert_converges`.
    at : (int, float), optional
        A number of cells and the bound on the error there.
    quantity : str
        What is judged.
    time_factor : float, optional
        When; the first time of the coarsest mesh where left out.
    """
    if at is not None and at[0] not in cells:
        raise ValueError(f"`at` names {at[0]} cells, which are not among {list(cells)}")

    def decorate(solve: Callable[..., Any]) -> Callable[..., None]:
        wanted = inspect.signature(solve)
        if "cells" not in wanted.parameters:
            raise TypeError(f"`{solve.__name__}` must take `cells`, the number of cells over the height")

        @functools.wraps(solve)
        def test(*args: Any, **fixtures: Any) -> None:
            __tracebackhide__ = True
            errors = []
            when = time_factor
            for level in cells:
                if "case" in wanted.parameters:
                    fixtures["case"] = case(scene, level, time_factor, **material)
                given = solve(*args, cells=level, **fixtures)
                found = score(scene, sample=sample, reference=reference, **material, **given)
                if found.warnings:
                    raise AssertionError("\n".join([f"{level} cells:", *found.diagnosis, *found.warnings]))
                when = found.errors.rows()[0]["time_factor"] if when is None else when
                errors.append(found.error(quantity, when))
            shown.append(f"{solve.__name__}: {scene}, {quantity}: " + ", ".join(
                f"{level} cells {error:.3e}" for level, error in zip(cells, errors)
            ))
            bound = None if at is None else (1.0 / at[0], at[1])
            sizes = [1.0 / level for level in cells]
            assert_converges(sizes, errors, order, minus=minus, plus=plus, at=bound, kind=kind)

        kept = [one for name, one in wanted.parameters.items() if name not in ("cells", "case")]
        test.__signature__ = wanted.replace(parameters=kept)  # type: ignore[attr-defined]
        return test

    return decorate
