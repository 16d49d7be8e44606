"""``python -m carom export DIR --format parquet --out FILE``."""

from __future__ import annotations

import argparse
import sys

from . import __version__
from .errors import Error
from .export import FORMATS, export
from .run import open as open_run


def main() -> int:
    """Run the command; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m carom")
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("export", help="write the history of a run with units")
    command.add_argument("directory", help="the run directory")
    command.add_argument("--format", choices=FORMATS, required=True)
    command.add_argument("--out", help="the file to write (default: standard output)")
    arguments = parser.parse_args()
    try:
        export(open_run(arguments.directory), arguments.out, arguments.format)
    except (Error, ValueError, OSError, ImportError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 4 if isinstance(error, OSError) and not isinstance(error, FileExistsError) else 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
