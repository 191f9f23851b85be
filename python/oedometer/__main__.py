"""``python -m oedometer`` is the command."""

from .command import main

main()
