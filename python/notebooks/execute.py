"""Executes every notebook beside it, in a folder that is thrown away: `cargo xtask nightly`.

With ``--keep`` what they show is written into them: before a commit that changes it."""

import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def main(keeps: bool) -> None:
    for path in sorted(Path(__file__).parent.glob("*.ipynb")):
        notebook = nbformat.read(path, as_version=4)
        with tempfile.TemporaryDirectory() as folder:
            resources = {"metadata": {"path": folder}}
            client = NotebookClient(notebook, resources=resources, timeout=600, record_timing=False)
            client.execute()
        if keeps:
            nbformat.write(notebook, path)
        print(f"{path.name}: {len(notebook.cells)} cells")


if __name__ == "__main__":
    main("--keep" in sys.argv[1:])
