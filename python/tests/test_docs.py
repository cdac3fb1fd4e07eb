"""What is public says what it is, and the stubs say the same."""

import ast
import inspect
import json
import re
from pathlib import Path

import pytest

import vibrissa
from vibrissa import _core

NOTEBOOKS = Path(__file__).parents[1] / "notebooks"
STUBS = Path(vibrissa.__file__).with_name("_core.pyi")


def documented():
    """Each class, function and property of the stubs with its docstring, and the thing itself."""
    for node in ast.parse(STUBS.read_text()).body:
        thing = getattr(_core, getattr(node, "name", "_"), None)
        if isinstance(node, ast.FunctionDef):
            yield node.name, ast.get_docstring(node), thing
        if not isinstance(node, ast.ClassDef):
            continue
        yield node.name, ast.get_docstring(node), thing
        follows = [*node.body[1:], None]
        for inner, after in zip(node.body, follows):
            if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("__"):
                name = f"{node.name}.{inner.name}"
                yield name, ast.get_docstring(inner), getattr(thing, inner.name)
            elif isinstance(inner, ast.AnnAssign) and node.name != "SceneError":
                is_text = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
                text = inspect.cleandoc(after.value.value) if is_text else None
                yield f"{node.name}.{inner.target.id}", text, getattr(thing, inner.target.id)


def test_stubs_have_the_docstrings_of_what_is_there():
    found = list(documented())
    assert len(found) > 40
    for name, stub, thing in found:
        assert thing.__doc__, name
        assert stub == inspect.getdoc(thing), name


@pytest.mark.parametrize("path", sorted(NOTEBOOKS.glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebooks_are_committed_with_what_they_show(path):
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    # Each was executed, in order and with no fault: `notebooks/execute.py --keep`.
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert "error" not in [output["output_type"] for output in outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)


def test_the_first_notebook_shows_what_it_gives():
    # A model that was trained again changes them all: `notebooks/execute.py --keep`.
    cells = json.loads((NOTEBOOKS / "1-look.ipynb").read_text())["cells"]
    first = next(cell for cell in cells if cell["cell_type"] == "code")
    shown = re.findall(r"0\.\d+", "".join(first["outputs"][0]["data"]["text/plain"]))
    sim = vibrissa.Sim("textures", seed=7)
    sim.run(every=20)
    assert sim.decisions["posterior"][: len(shown)].tolist() == pytest.approx(list(map(float, shown)))


@pytest.mark.parametrize("fields", [vibrissa.Share, vibrissa.Evaluation, vibrissa.Why])
def test_fields_say_what_they_are(fields):
    # Python's own has the fields alone.
    assert not fields.__doc__.startswith(f"{fields.__name__}(")
    for name in fields._fields:
        text = getattr(fields, name).__doc__
        assert text and not text.startswith("Alias"), name


def test_what_is_public_is_documented():
    for name in vibrissa.__all__:
        thing = getattr(vibrissa, name)
        assert name in ("SCENES", "__version__") or inspect.getdoc(thing), name
