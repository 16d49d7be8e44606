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
from concurrent.futures import ThreadPoolExecutor

import nbformat
from nbclient import NotebookClient

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "docs/notebooks"


def run(path, write):
    began = time.monotonic()
    notebook = nbformat.read(path, 4)
    place = {"metadata": {"path": str(path.parent)}}
    NotebookClient(notebook, timeout=300, resources=place, kernel_name="python3").execute()
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    figures = sum("image/png" in out.get("data", {}) for cell in cells for out in cell.outputs)
    if write:
        for cell in cells:
            cell.metadata.pop("execution", None)
            cell.outputs = [out for out in cell.outputs if out.get("name") != "stderr"]
        nbformat.write(notebook, path)
    return f"{path.name}: {figures} figures, {time.monotonic() - began:.1f} s", figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("notebooks", nargs="*", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    paths = arguments.notebooks or sorted(FOLDER.glob("*.ipynb"))
    # A notebook is a process of its own; two of them share the time of starting and plotting.
    with ThreadPoolExecutor(max_workers=2) as pool:
        for said, figures in pool.map(run, paths, [arguments.write] * len(paths)):
            print(said)
            if not figures:
                sys.exit(f"{said}: a figure is expected")


if __name__ == "__main__":
    main()
