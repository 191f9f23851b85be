"""The plugin for pytest: after the tests, the errors of those that ``oedometer.converges`` made."""

from typing import Any


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Prints a line a test."""
    from .testing import shown

    if shown:
        terminalreporter.section("errors on finer meshes")
        for line in shown:
            terminalreporter.write_line(line)
