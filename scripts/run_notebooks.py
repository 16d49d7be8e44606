#!/usr/bin/env python3
"""Runs the notebooks of docs/notebooks/ from beginning to end; an exception is an error.

    scripts/run_notebooks.py [--write] [NOTEBOOK...]

--write stores their output, without what they print on standard error. Needs nbclient, ipykernel and
the package `carom` with what the notebooks import.
"""

import argparse
import pathlib
import sys
import time

import nbformat
from nbclient import NotebookClient

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "docs/notebooks"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("notebooks", nargs="*", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    for path in arguments.notebooks or sorted(FOLDER.glob("*.ipynb")):
        began = time.monotonic()
        notebook = nbformat.read(path, 4)
        place = {"metadata": {"path": str(path.parent)}}
        NotebookClient(notebook, timeout=300, resources=place, kernel_name="python3").execute()
        cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
        figures = sum("image/png" in out.get("data", {}) for cell in cells for out in cell.outputs)
        if not figures:
            sys.exit(f"{path.name}: no figure")
        if arguments.write:
            for cell in cells:
                cell.metadata.pop("execution", None)
                cell.outputs = [out for out in cell.outputs if out.get("name") != "stderr"]
            nbformat.write(notebook, path)
        print(f"{path.name}: {figures} figures, {time.monotonic() - began:.1f} s")


if __name__ == "__main__":
    main()
