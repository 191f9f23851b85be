"""The command ``oedometer``."""

import signal
import sys

from . import _native


def main() -> None:
    """Runs the command line that this process was called with, and ends with its exit code."""
    # Python would wait with an interruption until the command is done.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    sys.exit(_native.main(["oedometer", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
