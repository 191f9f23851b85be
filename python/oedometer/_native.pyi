from typing import List, Optional, Sequence, Tuple

__all__ = ["__version__", "case", "convergence", "exact", "main", "score", "score_files", "verdict"]
__version__: str

def exact(
    solution: str, time_factors: bytes, depths: bytes, x: bytes, inputs: Sequence[Tuple[str, str]]
) -> List[Tuple[str, bytes]]: ...
def score(
    scene: str,
    lists: Sequence[bytes],
    sample: str,
    reference: Optional[str],
    inputs: Sequence[Tuple[str, str]],
) -> str: ...
def score_files(
    scene: str,
    files: Sequence[str],
    meaning: Tuple[Optional[str], Optional[str], Optional[str], Optional[float], Sequence[int]],
    reference: Optional[str],
    inputs: Sequence[Tuple[str, str]],
) -> str: ...
def case(scene: str, cells: int, time_factors: bytes, inputs: Sequence[Tuple[str, str]]) -> str: ...
def convergence(sizes: bytes, errors: bytes, formal_order: Optional[float]) -> str: ...
def verdict(
    sizes: bytes,
    errors: bytes,
    order: Optional[Tuple[float, float, float]],
    at: Optional[Tuple[float, float]],
    class_: Optional[str],
) -> Tuple[bool, str]: ...
def main(words: Sequence[str]) -> int: ...
