"""Notebooks are stored with what they show, and a change of that is noticed."""

import importlib.util
from pathlib import Path
from typing import Any

import nbformat
import pytest

FOLDER = Path(__file__).parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


@pytest.fixture(scope="module")
def run() -> Any:
    spec = importlib.util.spec_from_file_location("run", FOLDER / "run.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_stored_as_they_were_run(path: Path, run: Any) -> None:
    cells = nbformat.read(path, as_version=4).cells
    code = [cell for cell in cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    assert cells[0].cell_type == "markdown" and "\n\n" in cells[0].source
    pictures = [
        picture
        for cell in code
        for output in cell.outputs
        for kind, picture in output.get("data", {}).items()
        if kind.startswith("image/")
    ]
    assert pictures and max(map(len, pictures)) < 150_000
    assert "stderr" not in {output.get("name") for cell in code for output in cell.outputs}


def test_a_change_of_outputs_is_noticed(run: Any) -> None:
    assert run.alike("ε_t = -0.5, 2e-8 of 6", "ε_t = -0.50000000001, 2.0e-8 of 6")
    for other in ("ε_t = -0.5, 2e-8 of 7", "ε_t = 0.5, 2e-8 of 6", "e_t = -0.5, 2e-8 of 6", ""):
        assert not run.alike("ε_t = -0.5, 2e-8 of 6", other), other

    def notebook(*outputs: Any, tags: tuple[str, ...] = ()) -> Any:
        cell = nbformat.v4.new_code_cell(outputs=list(outputs), metadata={"tags": list(tags)})
        return nbformat.v4.new_notebook(cells=[nbformat.v4.new_markdown_cell("Text"), cell])

    def said(text: str) -> Any:
        return nbformat.v4.new_output("stream", name="stdout", text=text)

    def drawn(picture: str) -> Any:
        data = {"image/png": picture, "text/plain": "<Figure>"}
        return nbformat.v4.new_output("display_data", data=data)

    assert run.difference(notebook(said("6")), notebook(said("6"))) is None
    assert run.difference(notebook(drawn("a")), notebook(drawn("b"))) is None
    assert "cell 1" in run.difference(notebook(said("6")), notebook(said("7")))
    assert "cell 1" in run.difference(notebook(), notebook(drawn("a")))
    assert "cell 1" in run.difference(notebook(drawn("a")), notebook(said("6")))
    varies = notebook(said("6"), tags=("varies",))
    assert run.difference(varies, notebook(said("7"))) is None
    assert run.difference(varies, notebook()) is not None
