"""Data frames, datasets and meshes as files that the program reads.

A frame is scored as the CSV that it would be, a mesh as its VTU, so that columns, units and signs mean the same as in files.
"""

from __future__ import annotations

import json
import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

Path = Union[str, "os.PathLike[str]"]


def is_path(one: Any) -> bool:
    """Whether it is the name of a file."""
    return isinstance(one, (str, os.PathLike))


def toml(table: Mapping[str, Any], path: Tuple[str, ...] = ()) -> str:
    """The text of a mapping that is given as a dictionary."""
    lines: List[str] = []
    inner: List[str] = []
    for key, value in table.items():
        name = json.dumps(str(key), ensure_ascii=False)
        if isinstance(value, Mapping):
            inner.append(toml(value, (*path, name)))
        else:
            lines.append(f"{name} = {_value(value)}")
    head = [f"[{'.'.join(path)}]"] if path else []
    return "\n".join([*head, *lines, *inner]) + "\n"


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        whole = value if isinstance(value, (list, tuple)) else value.tolist()
        if not isinstance(whole, (list, tuple)):
            return _value(whole)
        return "[" + ", ".join(_value(one) for one in whole) + "]"
    if isinstance(value, int):
        return str(value)
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise ValueError(f"`{value!r}` in the mapping is neither a word, a number, a list nor a table") from None


def written(data: Any, folder: str) -> Tuple[List[str], List[float]]:
    """The names of the files of data, written into a folder where they are no files yet, and the times of meshes, s."""
    whole = list(data) if isinstance(data, (list, tuple)) and not _is_timed(data) else [data]
    times: List[float] = []
    files = []
    for number, one in enumerate(whole):
        time, one = (one[0], one[1]) if _is_timed(one) else (None, one)
        if is_path(one) and time is None:
            files.append(os.fspath(one))
        elif hasattr(one, "point_data") and hasattr(one, "points"):
            name = os.path.join(folder, f"mesh_{number}.vtu")
            one.write(name, file_format="vtu")
            files.append(name)
            times.extend([] if time is None else [float(time)])
        elif (frame := _frame(one)) is not None and time is None:
            name = os.path.join(folder, f"data_{number}.csv")
            frame.to_csv(name, index=False)
            files.append(name)
        else:
            raise ValueError(
                f"`{type(one).__name__}` is no result: give files, a pandas.DataFrame, an xarray.Dataset, a meshio.Mesh, or "
                "a list of (time in s, meshio.Mesh)"
            )
    if times and len(times) != len(files):
        raise ValueError("some meshes have a time and others have none: give (time in s, mesh) for each")
    return files, times


def _is_timed(one: Any) -> bool:
    """Whether it is a pair of a time and a mesh."""
    return isinstance(one, tuple) and len(one) == 2 and hasattr(one[1], "point_data") and not is_path(one[0])


def _frame(one: Any) -> Optional[Any]:
    """A data frame, of a dataset its table; durations are seconds."""
    if hasattr(one, "to_dataframe"):
        named = one if hasattr(one, "data_vars") or getattr(one, "name", None) else one.rename("p")
        one = named.to_dataframe().reset_index()
    if not (hasattr(one, "to_csv") and hasattr(one, "columns")):
        return None
    # An index with names is part of the data.
    frame = one.reset_index() if any(name is not None for name in one.index.names) else one
    durations = {
        name: frame[name].dt.total_seconds() for name in frame.columns if str(frame[name].dtype).startswith("timedelta")
    }
    return frame.assign(**durations)


def meaning(
    preset: Optional[str],
    mapping: Union[Path, Mapping[str, Any], None],
    times: Sequence[float],
) -> Tuple[Optional[str], Optional[str], Optional[str]]:
    """Preset, mapping file and text of a mapping, with the times of meshes."""
    if not times:
        if isinstance(mapping, Mapping):
            return preset, None, toml(mapping)
        return preset, None if mapping is None else os.fspath(mapping), None
    if mapping is not None and not isinstance(mapping, Mapping):
        raise ValueError("meshes with times take a mapping as a dictionary, and not as a file")
    own: Dict[str, Any] = dict(mapping or {})
    own["time"] = {**own.get("time", {}), "list": list(times)}
    return preset or (None if mapping else "meshio"), None, toml(own)
