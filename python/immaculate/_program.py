"""The command `immaculate`: the whole command line of the crate, in this process."""

import signal
import sys
from typing import NoReturn

from immaculate import _immaculate


def main() -> NoReturn:
    """Runs the command in the arguments, and ends with the exit status of the crate's program."""
    # No Python runs until the end, so that Python's own way to be interrupted would never be taken.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_immaculate.command_line(["immaculate", *sys.argv[1:]]))
