"""``python -m oedometer`` is the command."""

from .command import main

if __name__ == "__main__":
    main()
